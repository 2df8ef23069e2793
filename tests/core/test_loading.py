# SPDX-License-Identifier: GPL-3.0-or-later
"""Why the native library can't be loaded, in words; and a copy that is loaded in its place where a file in use is locked."""

import shutil
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

import partwheel
import pytest
from conftest import PACKAGES
from partwheel import library, loading


def head_of(platform):
    """The first bytes of a library for a platform, as its formats are specified."""
    system, machine = platform.split("-")
    arm = machine == "arm64"
    if system == "linux":
        return b"\x7fELF\2\1\1".ljust(16, b"\0") + struct.pack("<HHI", 3, 183 if arm else 62, 1) + bytes(200)
    if system == "windows":
        return b"MZ".ljust(60, b"\0") + struct.pack("<I", 128) + bytes(64) + b"PE\0\0" + \
            struct.pack("<H", 0xAA64 if arm else 0x8664) + bytes(200)
    return struct.pack("<III", 0xFEEDFACF, 0x100000C if arm else 0x1000007, 0) + bytes(200)


def refusal(path, monkeypatch):
    monkeypatch.delenv("PARTWHEEL_LIBRARY", raising=False)
    monkeypatch.setattr(library, "LIBRARY", Path(path))
    with pytest.raises(partwheel.LibraryError) as refused:
        library.load.__wrapped__()
    assert str(refused.value.__cause__), "the loader's own words are lost"
    return str(refused.value)


@pytest.mark.parametrize("platform", [f"{system}-{machine}" for system in loading.FILE_NAMES
                                      for machine in ("x64", "arm64")])
def test_every_platform_is_recognized_from_the_library(platform, tmp_path):
    path = tmp_path / "library"
    path.write_bytes(head_of(platform))
    assert loading.library_platform(path) == platform
    path.write_bytes(head_of(platform)[:6])
    assert loading.library_platform(path) is None


def test_a_damaged_library_is_reported(tmp_path, monkeypatch):
    """Also one that is cut short anywhere, which Linux would load and die of. Wine takes one that lacks less than a block
    of a PE file, and fills it up with the zeros that are there."""
    path = tmp_path / library.LIBRARY.name
    sound = Path(library.load()._name).read_bytes()
    for data in (b"", b"no library at all", *(sound[:len(sound) * part // 8] for part in range(8)), sound[:-512]):
        path.write_bytes(data)
        message = refusal(path, monkeypatch)
        assert "is damaged" in message and str(path) in message and "Install" in message


def test_a_loaded_copy_does_not_lock_the_file(tmp_path, monkeypatch):
    """What is loaded on Windows is a copy: the installed file is not mapped, earlier copies go, the same one stays."""
    monkeypatch.setattr(tempfile, "gettempdir", lambda: str(tmp_path))
    installed = tmp_path / "installed" / library.LIBRARY.name
    installed.parent.mkdir()
    shutil.copy(library.load()._name, installed)
    earlier = tmp_path / "partwheel" / f"0123-{installed.name}"
    earlier.parent.mkdir()
    earlier.write_bytes(b"of an earlier version")
    copy = loading.temporary_copy(installed)
    assert copy.read_bytes() == installed.read_bytes() and not earlier.exists()
    time_of_copy = copy.stat().st_mtime_ns
    assert loading.temporary_copy(installed) == copy and copy.stat().st_mtime_ns == time_of_copy
    copy.write_bytes(b"planted")
    assert loading.temporary_copy(installed).read_bytes() == installed.read_bytes()
    assert [path.name for path in copy.parent.iterdir()] == [copy.name]


@pytest.mark.parametrize("blocked", [("copy",), ("copy", "installed")])
def test_the_installed_file_is_loaded_where_a_policy_blocks_the_copy(blocked, tmp_path, monkeypatch):
    """As with a policy against libraries in %TEMP%. If both are blocked, the message names the installed file."""
    installed = tmp_path / "installed" / loading.FILE_NAMES["windows"]
    installed.parent.mkdir()
    installed.write_bytes(head_of("windows-x64"))
    monkeypatch.setattr(tempfile, "gettempdir", lambda: str(tmp_path))
    monkeypatch.setattr(loading, "SYSTEM", "windows")
    monkeypatch.setattr(loading, "current_platform", lambda: "windows-x64")
    tried = []

    def load(path):
        tried.append("installed" if Path(path) == installed else "copy")
        if tried[-1] in blocked:
            error = OSError("[WinError 4551] An Application Control policy has blocked this file")
            error.winerror = 4551
            raise error
        return path

    monkeypatch.setattr(loading.ctypes, "CDLL", load)
    if "installed" in blocked:
        with pytest.raises(OSError, match="does not let Partwheel's native library be loaded") as refused:
            loading.open_library(installed)
        assert str(installed) in str(refused.value)
    else:
        assert loading.open_library(installed) == str(installed)
    assert tried == ["copy", "installed"]


def test_the_worker_loads_the_library_from_its_folder():
    """A bare Python finds the binding, as worker/process.py has it."""
    code = "import sys; sys.path.insert(0, sys.argv[1]); import library; print(library.load().pw_version().decode())"
    process = subprocess.run([sys.executable, "-I", "-S", "-c", code, str(Path(PACKAGES) / "partwheel")],
                          capture_output=True, text=True)
    assert process.stdout.strip() == library.VERSION, process.stderr
