# SPDX-License-Identifier: GPL-3.0-or-later
"""The wheel, as a stranger installs it: into an empty environment, with what it needs from PyPI."""

import json
import os
import subprocess
import venv
from pathlib import Path

import pytest
from conftest import ROOT

pytestmark = pytest.mark.skipif("PARTWHEEL_LIBRARY" in os.environ, reason="it is the release that is packed")


def test_it_is_installed_and_builds(tmp_path, meshes_directory):
    (wheel,) = (ROOT / "build" / "package").glob("partwheel-*-py3-none-manylinux_*.whl")  # made by scripts/package
    venv.create(tmp_path / "venv", with_pip=True)
    programs = tmp_path / "venv" / "bin"
    clean = {"HOME": str(tmp_path), "PATH": f"{programs}:/usr/bin:/bin"}

    def run(*command):
        process = subprocess.run(command, cwd=tmp_path, env=clean, capture_output=True, text=True)
        assert process.returncode == 0, process.stdout + process.stderr
        return process.stdout

    run(programs / "python", "-m", "pip", "install", "--disable-pip-version-check", str(wheel))
    location = run(programs / "python", "-c", "import partwheel; print(partwheel.__file__, partwheel.version())")
    assert location.startswith(str(tmp_path / "venv"))
    assert Path(location.split()[0]).with_name("py.typed").is_file()  # type checkers read the annotations
    report = json.loads(run(programs / "partwheel", "build", meshes_directory / "armadillo.off", "--json"))
    assert report["faces"] == int((meshes_directory / "armadillo.off").read_text().split()[2])
    stl = meshes_directory / "pig.stl"
    refused = subprocess.run([programs / "partwheel", "build", stl], env=clean, capture_output=True, text=True)
    assert refused.returncode == 1 and 'pip install "partwheel[meshes]"' in refused.stderr
    run(programs / "python", "-m", "pip", "install", "--disable-pip-version-check", f"{wheel}[meshes]")
    assert json.loads(run(programs / "partwheel", "build", stl, "--json"))["faces"] > 0
    output = run(programs / "python", "-m", "pip", "show", "--verbose", "partwheel")
    assert f"Version: {location.split()[1]}\n" in output and "Requires: numpy\n" in output
