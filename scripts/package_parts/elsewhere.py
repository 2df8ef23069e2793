"""Tests packages on the platform that they are for, which needs nothing but Python 3.11: the wheel in a new environment with
the core tests that need no compiler, and the extension in Blender as a Python module. CI runs this on Windows and macOS.

    python scripts/package_parts/elsewhere.py build/ship

The tests read models from build/deps/meshes.
"""

import os
import pathlib
import subprocess
import sys
import tempfile
import venv

from platforms import ROOT, TAGS
from loading import current_platform

CORE = ("hierarchy", "loading", "rays", "older_formats", "wheel")
BLENDER = "4.5"


def main(ship):
    platform = current_platform()
    (wheel,) = ship.glob(f"partwheel-*-py3-none-{TAGS[platform]}.whl")
    (extension,) = ship.glob(f"partwheel-*-{platform}.zip")
    print(f"{platform}: {wheel.name}, {extension.name}", flush=True)
    with tempfile.TemporaryDirectory() as directory:
        python = create_environment(directory, "core", f"{wheel}[meshes]", "scipy", "pytest")
        packages = run(python, "-c", "import partwheel; print(partwheel.__path__[0])").parent
        run(python, "-m", "pytest", "-p", "no:cacheprovider", *(ROOT / f"tests/core/test_{name}.py" for name in CORE),
            PARTWHEEL_PACKAGES=str(packages), is_shown=True)
        if platform == "windows-arm64":
            print("There is no Blender for this platform as a Python module.")
            return
        python = create_environment(directory, "blender", f"bpy=={BLENDER}.*", "numpy")
        run(python, ROOT / "tests/addon/run.py", "--", extension, pathlib.Path(directory) / "result.json", is_shown=True,
            HOME=directory, APPDATA=directory)


def create_environment(directory, name, *packages):
    """Creates an environment with these packages; returns its Python."""
    folder = pathlib.Path(directory) / name
    venv.create(folder, with_pip=True)
    python = folder / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    run(python, "-m", "pip", "install", "--disable-pip-version-check", *packages, is_shown=True)
    return python


def run(*command, is_shown=False, **environment):
    """Runs a command with additional environment variables; returns its output as a path. Exits if it fails."""
    process = subprocess.run(list(map(str, command)), cwd=ROOT, env={**os.environ, **environment}, text=True,
                             stdout=None if is_shown else subprocess.PIPE)
    if process.returncode:
        sys.exit(f"This failed: {' '.join(map(str, command))}")
    return pathlib.Path((process.stdout or "").strip())


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]).resolve())
