# SPDX-License-Identifier: GPL-3.0-or-later
"""Compiles the library that goes wrong on purpose (faults.c) around the real one. Linux only."""

import contextlib
import re
import subprocess
from pathlib import Path

HERE = Path(__file__).resolve().parent


def compiled(source, target, *options, real=None):
    """A shared library from one C file: its path. real: another that it is linked with, and which stands for all that it
    has not itself."""
    if real:
        real, beside = Path(real).resolve(), Path(target).parent
        headers = subprocess.run(["objdump", "-p", real], capture_output=True, text=True, check=True).stdout
        (beside / re.search(r"SONAME +(\S+)", headers)[1]).symlink_to(real)  # the name that it will be looked up by
        options = [*options, "-Wl,--no-as-needed", real, f"-Wl,-rpath,{beside}"]
    subprocess.run(["cc", "-shared", "-fPIC", "-O1", "-Wall", "-Werror", "-pthread", "-o", target, source, *options],
                   check=True)
    return str(target)


def entry(real, library, directory):
    """The path of a program in this directory that is the worker's, the real one, but uses this library, also where
    PARTWHEEL_LIBRARY names another, as for the sanitizers."""
    real, path = Path(real).resolve(), Path(directory) / "entry.py"
    path.write_text("import os, runpy, sys\nos.environ.pop('PARTWHEEL_LIBRARY', None)\n"
                    f"sys.path.insert(0, {str(real.parents[1])!r})\nimport library\n"
                    f"library.LIBRARY = {str(library)!r}\nrunpy.run_path({str(real)!r}, run_name='__main__')\n")
    return path


def harmed(process):
    """Whether a worker has come to its harm, and is still there."""
    with contextlib.suppress(OSError):  # it, or a thread of it, is no more
        return any(thread.read_text() == "harmed\n" for thread in Path(f"/proc/{process}/task").glob("*/comm"))
    return False


def library(real, directory):
    """The path of a library in this directory that is the real one, save for what faults.c says."""
    return compiled(HERE / "faults.c", Path(directory) / "libfaults.so", f"-I{HERE.parents[1]}/native/include", "-ldl",
                    real=real)
