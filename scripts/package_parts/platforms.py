"""The shipped platforms, by their names in Blender, CMakePresets.json and cmake/cross/zig.cmake."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "native/python/partwheel"))

from loading import FILE_NAMES, MACHINES  # noqa: E402

# Name -> platform tag of the wheel; the oldest supported systems are glibc 2.28 and macOS 11.
TAGS = {
    "linux-x64": "manylinux_2_28_x86_64", "linux-arm64": "manylinux_2_28_aarch64",
    "windows-x64": "win_amd64", "windows-arm64": "win_arm64",
    "macos-x64": "macosx_11_0_x86_64", "macos-arm64": "macosx_11_0_arm64",
}
SYSTEMS = {"manylinux": "linux", "linux": "linux", "win": "windows", "macosx": "macos"}


def library_of(platform):
    """The file name of the native library."""
    return FILE_NAMES[platform.split("-")[0]]


def platform_of(wheel):
    """The platform of a wheel, from its file name."""
    tag = pathlib.Path(wheel).stem.rsplit("-", 1)[1]
    system, machine = re.fullmatch(r"([a-z]+)[0-9_]*_(x86_64|[a-z0-9]+)", tag).groups()
    return f"{SYSTEMS[system]}-{MACHINES.get(machine, machine)}"
