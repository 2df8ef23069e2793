# SPDX-License-Identifier: GPL-3.0-or-later
"""Loads the native library, or explains why it can't be loaded. On Windows it loads a copy, so that the library's file can
be replaced while it is in use.

The worker imports this module, too, and must start fast. So it uses the standard library only, and imports most of that
inside functions.
"""

from __future__ import annotations

import ctypes
import os
import struct
import sys
from pathlib import Path

FILE_NAMES = {"linux": "libpartwheel.so", "windows": "partwheel.dll", "macos": "libpartwheel.dylib"}
SYSTEM = {"win32": "windows", "darwin": "macos"}.get(sys.platform, "linux")
DISPLAY_NAMES = {"linux": "Linux", "windows": "Windows", "macos": "macOS", "x64": "x64", "arm64": "ARM"}
MACHINES = {"x86_64": "x64", "amd64": "x64", "aarch64": "arm64", "arm64": "arm64"}
# Machine codes in the headers of executable files.
ELF_MACHINES = {62: "x64", 183: "arm64"}
PE_MACHINES = {0x8664: "x64", 0xAA64: "arm64"}
MACH_O_MACHINES = {0x1000007: "x64", 0x100000C: "arm64"}


def open_library(path: str | Path) -> ctypes.CDLL:
    """Loads the library. Raises OSError; str() says what to do, and __cause__ is the loader's own error."""
    try:
        if is_truncated(path):
            raise OSError(f"{path}: the file is cut short")
        return _open_copy(path) if SYSTEM == "windows" else ctypes.CDLL(str(path))
    except OSError as error:
        raise OSError(explain_error(path, str(error), getattr(error, "winerror", None))) from error


def _open_copy(path: str | Path) -> ctypes.CDLL:
    copy = temporary_copy(path)
    try:
        return ctypes.CDLL(str(copy))
    except OSError:
        if copy == path:
            raise
        return ctypes.CDLL(str(path))  # a policy may forbid libraries in %TEMP%


def temporary_copy(path: str | Path) -> Path:
    """Copies the library into the temporary directory; returns the path of the copy, or of the file if that fails.

    Windows locks the file of a library that is in use: without a copy, Blender could not update or remove the
    add-on."""
    import contextlib
    import hashlib
    import tempfile

    path, directory = Path(path), Path(tempfile.gettempdir()) / "partwheel"
    try:
        data = path.read_bytes()
        copy = directory / f"{hashlib.sha256(data).hexdigest()[:16]}-{path.name}"
        directory.mkdir(exist_ok=True)
        for old_copy in directory.glob(f"*-{path.name}"):
            if old_copy != copy:
                with contextlib.suppress(OSError):  # another program uses it; a later call removes it
                    old_copy.unlink()
        if not copy.is_file() or copy.read_bytes() != data:
            partial = copy.with_suffix(f".{os.getpid()}")
            partial.write_bytes(data)
            partial.replace(copy)
        return copy
    except OSError:
        return path  # then the add-on works, but can't be updated while it is in use


def current_platform() -> str:
    """The platform of this process, as in the names of packages, such as "linux-x64"."""
    import platform
    import sysconfig

    # On Windows, platform.machine() may be the computer's architecture rather than that of an emulated process.
    machine = sysconfig.get_platform().rpartition("-")[2] if SYSTEM == "windows" else platform.machine()
    return f"{SYSTEM}-{MACHINES.get(machine.lower(), machine.lower())}"


def library_platform(path: str | Path) -> str | None:
    """The platform of a library, from its file header; None if it is not a library for a supported platform."""
    try:
        with open(path, "rb") as file:
            head = file.read(4096)
        if head.startswith(b"\x7fELF"):
            return f"linux-{ELF_MACHINES[struct.unpack_from('<H', head, 18)[0]]}"
        if head.startswith(b"MZ"):
            start, = struct.unpack_from("<I", head, 60)
            if head[start:start + 4] == b"PE\0\0":
                return f"windows-{PE_MACHINES[struct.unpack_from('<H', head, start + 4)[0]]}"
        if head.startswith(b"\xcf\xfa\xed\xfe"):
            return f"macos-{MACH_O_MACHINES[struct.unpack_from('<I', head, 4)[0]]}"
    except (OSError, struct.error, KeyError):
        pass
    return None


def is_truncated(path: str | Path) -> bool:
    """Whether an ELF file ends before the end of its section table, which is its last part. Linux would load such a file
    and crash with a bus error. The loaders of other systems check this."""
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


def explain_error(path: str | Path, message: str, code: int | None) -> str:
    """Why the library can't be loaded, and what to do. message : the loader's; code : the error code of Windows"""
    path = Path(path)
    install = f"Install Partwheel for {display_name(current_platform())} ({current_platform()})"
    if not path.is_file():
        for name in FILE_NAMES.values():  # the library of another platform
            if path.with_name(name).is_file():
                return _wrong_platform(library_platform(path.with_name(name)), install)
        return (f"Partwheel's native library is missing: there is no {path}. The installation was interrupted, or a "
                f"virus scanner removed the file. {install} again, and allow the file if you are asked. In a source tree, "
                "run scripts/build.")
    platform = library_platform(path)
    if platform and platform != current_platform():
        return _wrong_platform(platform, install)
    if not platform or code == 193 or "too short" in message or "cut short" in message:
        return f"Partwheel's native library is damaged: {path}. {install} again."
    if "GLIBC" in message:
        return ("This Linux is too old for Partwheel's native library: it needs glibc 2.28 or newer, as Blender 4.2 "
                "does. Update the system, or build the library on it (scripts/build).")
    if SYSTEM == "macos" and any(word in message for word in ("signature", "policy", "quarantine", "verif", "permitted")):
        return (f"macOS does not let Partwheel's native library be loaded: {path}. Allow it in System Settings > "
                f"Privacy & Security, or in Terminal: xattr -d com.apple.quarantine '{path}'. Then restart Blender.")
    if code in (5, 225, 1260, 4551):  # access denied, virus, group policy, application control
        return (f"Windows, or a virus scanner, does not let Partwheel's native library be loaded: {path}. Allow this "
                "file there, or ask your administrator. Then restart Blender.")
    if code == 126 or "Could not find module" in message:
        return ("A part of Windows that Partwheel's native library needs is missing: the Universal C Runtime. Windows "
                "Update installs it. Then restart Blender.")
    return f"Partwheel's native library can't be loaded: {message}. {install} again."


def display_name(platform: str) -> str:
    """The name of a platform in messages: "Linux x64" for "linux-x64"."""
    return " ".join(DISPLAY_NAMES.get(word, word) for word in platform.split("-"))


def _wrong_platform(platform: str | None, install: str) -> str:
    name = display_name(platform) if platform else "another platform"
    return f"This is Partwheel for {name}, but it runs on {display_name(current_platform())}. {install}."
