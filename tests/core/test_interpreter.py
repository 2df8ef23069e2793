# SPDX-License-Identifier: GPL-3.0-or-later
"""Which Python runs the worker: one that runs, whatever is on the PATH; and where there is none, an error that says
what to do about it."""

import contextlib
import errno
import os
import shlex
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import shapes
from conftest import PACKAGES, ROOT
from partwheel import Hierarchy
from partwheel.worker import interpreter
from partwheel.worker.exit_status import describe_exit
from partwheel.worker import Job, WorkerError

REAL = sys.executable
FAILS = "exit 127"
HANGS = "exec sleep 1000"
RUNS = f'exec {shlex.quote(REAL)} "$@"'
ONLY_PROBED = f'case "$*" in *ctypes*) {RUNS};; esac; exit 3'  # does what a probe asks, and no work
UNLIMITED = {"memory_limit": 0}
pytestmark = pytest.mark.skipif(os.name != "posix", reason="the shims are scripts of a shell")


@pytest.fixture
def shim(tmp_path):
    """shim("name", FAILS): a program that first writes its process's number into name.log. Gives its path."""
    def make(name, does):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"#!/bin/sh\necho $$ >> {shlex.quote(str(path))}.log\n{does}\n")
        path.chmod(0o755)
        return str(path)
    return make


def calls(path):
    """The processes' numbers of all its runs so far."""
    with contextlib.suppress(FileNotFoundError):
        return [int(line) for line in Path(f"{path}.log").read_text().split()]
    return []


@pytest.fixture
def pythons(monkeypatch, tmp_path):
    """pythons(executable, brought=None): this is all that is found from now on."""
    monkeypatch.setattr(interpreter, "_working", {})

    def find(executable, bundled=None):
        prefix = tmp_path / "prefix"
        (prefix / "bin").mkdir(parents=True, exist_ok=True)
        if bundled:
            (prefix / "bin" / "python3").symlink_to(bundled)
        monkeypatch.setattr(sys, "prefix", str(prefix))
        monkeypatch.setattr(sys, "executable", executable)
    return find


def builds(**options):
    shape = shapes.cube()
    job = Job(*shape, **UNLIMITED, **options)
    return job.result().save() == Hierarchy.build(*shape).save() and job.failures == []


def refusal(**options):
    job = Job(*shapes.cube(), **UNLIMITED, **options)
    with pytest.raises(WorkerError) as failed:
        job.result()
    assert failed.value.name == "worker" and job.failures == [failed.value]  # and the next fill method was not tried
    assert "preferences" in str(failed.value) and str(failed.value).endswith(".")
    return str(failed.value)


def test_interpreters_are_tried_in_order(monkeypatch, tmp_path):
    monkeypatch.setattr(sys, "prefix", str(tmp_path))
    monkeypatch.setattr(sys, "executable", "/somewhere/python")
    assert interpreter.candidates() == ("/somewhere/python",)
    bundled = f"python{sys.version_info.major}.{sys.version_info.minor}"
    for name in (f"bin/{bundled}", "bin/python.exe", "python.exe"):  # Linux and macOS, Windows, Windows
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        path.touch()
        assert interpreter.candidates("/wanted/python") == ("/wanted/python", str(path), "/somewhere/python")
        path.unlink()


def test_a_missing_python_is_reported(pythons, shim, monkeypatch):
    for executable in (None, ""):
        pythons(executable)
        assert "no Python" in refusal()
    pythons("/nowhere/python")
    assert f"/nowhere/python can't be started ({os.strerror(errno.ENOENT)})" in refusal()
    fails, hangs = shim("fails", FAILS), shim("hangs", HANGS)
    pythons(fails)
    assert f"{fails} ended without an answer (exit code 127)" in refusal()
    monkeypatch.setattr(interpreter, "NEXT_PROBE_SECONDS", 0)
    monkeypatch.setattr(interpreter, "TIMEOUT_SECONDS", 0)
    pythons(hangs)
    assert f"{hangs} did not answer" in refusal(python=fails)


def test_a_python_that_fails_to_start_the_worker_is_reported(pythons, shim):
    """It is not what is wrong with the mesh; and the next build looks again."""
    bad = shim("bad", ONLY_PROBED)
    pythons(bad)
    assert "exit code 3" in refusal() and len(calls(bad)) == 2
    shim("bad", RUNS)
    assert builds() and len(calls(bad)) == 4


@pytest.mark.parametrize("does", [FAILS, HANGS])
def test_a_hostile_path(shim, does):
    """As in Debian's Blender, whose sys.executable is what the PATH has, a version manager's shim for instance."""
    python = shim("bin/python3", does)
    script = ("import sys, numpy; print(sys.executable)\n"
              "from partwheel.worker import Job\n"
              "import shapes\n"
              "print(len(Job(*shapes.cube(), memory_limit=0).result().order))")
    path = os.pathsep.join([PACKAGES, str(ROOT / "tests" / "core"), str(Path(np.__file__).parents[1])])
    run = subprocess.run(["python3", "-c", script], executable=os.path.realpath(REAL), text=True, capture_output=True,
                         env={**os.environ, "PATH": str(Path(python).parent), "PYTHONPATH": path})
    assert run.stdout.split() == [python, "6"], run.stderr


@pytest.mark.parametrize(("code", "words"), [
    (3221225477, "crashed (access violation, 0xC0000005)"), (0xC00000FD, "stack overflow"),
    (0xC0000374, "heap corruption"), (0xC0000409, "abort"), (0xC0000135, "a library is missing"),
    (0xC000013A, "was interrupted"), (0xC0001234, "crashed (NTSTATUS, 0xC0001234)"),
    (3, "ended without an answer (exit code 3)"), (-11, "crashed (SIGSEGV)"), (-9, "was killed (SIGKILL"),
])
def test_exit_statuses_are_described(code, words):
    assert words in str(describe_exit(code))
