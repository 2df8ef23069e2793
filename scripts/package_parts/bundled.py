"""The package that the add-on contains besides our own: manifold3d, which prepares parts for a 3D printer. From PyPI."""

import subprocess
import sys

from platforms import ROOT, TAGS

NAME, VERSION = "manifold3d", "3.5.4"
FOLDER = ROOT / "build" / "deps" / f"{NAME}-{VERSION}"
# The Pythons of Blender 4.2 and later: 3.11 and 3.13, and those of distributions. Blender doesn't install an extension that has
# wheels for other Pythons only.
EXTENSION = "3.11", "3.12", "3.13", "3.14"
LEGACY = "3.10", "3.11", "3.12"  # of Blender 3.4 to 4.0; of 4.1, and of Debian's 3.4; of Ubuntu's 4.0


def wheels(platform, pythons):
    """The paths of the wheels for a platform, downloaded unless they are there. Windows on ARM has none for Python 3.10, and
    no Blender with it."""
    return [_wheel(platform, python) for python in pythons if (platform, python) != ("windows-arm64", "3.10")]


def _wheel(platform, python):
    folder = FOLDER / platform / python
    if not list(folder.glob("*.whl")):
        command = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--only-binary", ":all:", "--dest", folder,
                   "--platform", TAGS[platform], "--python-version", python, f"{NAME}=={VERSION}"]
        subprocess.run(command, check=True)
    (wheel,) = folder.glob("*.whl")
    return wheel
