# SPDX-License-Identifier: GPL-3.0-or-later
"""The native library's file: loaded so that it can be replaced meanwhile, or in words why it can't be loaded.

Also imported by the worker's bare Python, which is to start fast: the standard library alone, and most of it where it is
needed.
"""

import ctypes
import os
import struct
import sys
from pathlib import Path

FILE_NAMES = {"linux": "libpartwheel.so", "windows": "partwheel.dll", "macos": "libpartwheel.dylib"}
SYSTEM = {"win32": "windows", "darwin": "macos"}.get(sys.platform, "linux")
PEOPLE_SAY = {"linux": "Linux", "windows": "Windows", "macos": "macOS", "x64": "x64", "arm64": "ARM"}
MACHINES = {"x86_64": "x64", "amd64": "x64", "aarch64": "arm64", "arm64": "arm64"}
# The machine's number in the head of an ELF, PE and Mach-O file.
ELF, PE, MACH = {62: "x64", 183: "arm64"}, {0x8664: "x64", 0xAA64: "arm64"}, {0x1000007: "x64", 0x100000C: "arm64"}


def open_library(path):
    """A ctypes.CDLL. Raises OSError: str() is sentences a user can act on, its cause has the loader's own words."""
    try:
        if cut_short(path):
            raise OSError(f"{path}: the file is cut short")
        return _open_copy(path) if SYSTEM == "windows" else ctypes.CDLL(str(path))
    except OSError as error:
        raise OSError(why(path, str(error), getattr(error, "winerror", None))) from error


def _open_copy(path):
    copy = replaceable(path)
    try:
        return ctypes.CDLL(str(copy))
    except OSError:
        if copy == path:
            raise
        return ctypes.CDLL(str(path))  # a policy may forbid libraries in %TEMP%; better in use than not at all


def replaceable(path):
    """A copy of the file in the system's directory for such. On Windows a library that is in use can be neither
    replaced nor removed, so Blender could not update or remove the add-on, and would leave half of it."""
    import hashlib
    import tempfile

    path, directory = Path(path), Path(tempfile.gettempdir()) / "partwheel"
    try:
        data = path.read_bytes()
        copy = directory / f"{hashlib.sha256(data).hexdigest()[:16]}-{path.name}"
        directory.mkdir(exist_ok=True)
        for other in directory.glob(f"*-{path.name}"):
            if other != copy:
                _removed(other)
        if not copy.is_file() or copy.read_bytes() != data:
            partial = copy.with_suffix(f".{os.getpid()}")
            partial.write_bytes(data)
            partial.replace(copy)
        return copy
    except OSError:
        return path  # better in use than not at all


def _removed(path):
    try:
        path.unlink()
    except OSError:
        pass  # another program has it in use: it goes another time


def here():
    """The platform of this process, as packages are named after: linux-x64."""
    import platform
    import sysconfig

    # On Windows platform.machine() may tell the computer's, not that of a program which is translated for it.
    machine = sysconfig.get_platform().rpartition("-")[2] if SYSTEM == "windows" else platform.machine()
    return f"{SYSTEM}-{MACHINES.get(machine.lower(), machine.lower())}"


def made_for(path):
    """The platform that a library is for, from its head; None if it is no library for any that Partwheel is made for."""
    try:
        with open(path, "rb") as file:
            head = file.read(4096)
        if head.startswith(b"\x7fELF"):
            return f"linux-{ELF[struct.unpack_from('<H', head, 18)[0]]}"
        if head.startswith(b"MZ"):
            pe = struct.unpack_from("<I", head, 60)[0]
            return f"windows-{PE[struct.unpack_from('<H', head, pe + 4)[0]]}" if head[pe:pe + 4] == b"PE\0\0" else None
        if head.startswith(b"\xcf\xfa\xed\xfe"):
            return f"macos-{MACH[struct.unpack_from('<I', head, 4)[0]]}"
    except (OSError, struct.error, KeyError):
        pass
    return None


def cut_short(path):
    """Whether an ELF file, whose table of sections is its end, lacks that: Linux would load it, and end the program by a
    bus error. The loaders of other systems look for themselves."""
    try:
        with open(path, "rb") as file:
            head = file.read(64)
            if not head.startswith(b"\x7fELF\2"):
                return False
            table, = struct.unpack_from("<Q", head, 40)
            size, count = struct.unpack_from("<HH", head, 58)
            return table + size * count > file.seek(0, os.SEEK_END)
    except (OSError, struct.error):
        return False


def why(path, words, code=None):
    """Sentences: why the library can't be loaded, and what to do. words, code: the loader's, and Windows' number."""
    path = Path(path)
    anew = f"Install the Partwheel that is made for {in_words(here())} ({here()})"
    if not path.is_file():
        others = [name for name in FILE_NAMES.values() if path.with_name(name).is_file()]
        if others:
            return _of_other_platform(made_for(path.with_name(others[0])), anew)
        return (f"Partwheel's native library is missing: there is no {path}. Its installation was cut short, or a "
                f"virus scanner has taken it away. {anew} again, and allow the file if you are asked. From the sources, "
                "scripts/build makes it.")
    found = made_for(path)
    if found and found != here():
        return _of_other_platform(found, anew)
    if not found or code == 193 or "too short" in words or "cut short" in words:
        return f"Partwheel's native library is damaged: {path}. {anew} again."
    if "GLIBC" in words:
        return ("This Linux is too old for Partwheel's native library: it needs glibc 2.28 or newer, as Blender 4.2 "
                "does. Update the system, or build the library on it (scripts/build).")
    if SYSTEM == "macos" and any(word in words for word in ("signature", "policy", "quarantine", "verif", "permitted")):
        return (f"macOS does not let Partwheel's native library be loaded: {path}. Allow it in System Settings > "
                f"Privacy & Security, or in Terminal: xattr -d com.apple.quarantine '{path}'. Then restart Blender.")
    if code in (5, 225, 1260, 4551):  # access denied, a virus suspected, blocked by a policy, by application control
        return (f"Windows, or a virus scanner, does not let Partwheel's native library be loaded: {path}. Allow this "
                "file there, or ask whoever looks after this computer. Then restart Blender.")
    if code == 126 or "Could not find module" in words:
        return ("A part of Windows that Partwheel's native library needs is missing: the Universal C Runtime. Windows "
                "Update installs it. Then restart Blender.")
    return f"Partwheel's native library can't be loaded: {words}. {anew} again."


def in_words(name):
    """For people: "Linux x64"."""
    return " ".join(PEOPLE_SAY.get(word, word) for word in name.split("-"))


def _of_other_platform(found, anew):
    what = in_words(found) if found else "another platform"
    return f"This is Partwheel for {what}, but it runs on {in_words(here())}. {anew}."
