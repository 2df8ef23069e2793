# SPDX-License-Identifier: GPL-3.0-or-later
"""The workflow files of public CI, as actionlint reads them: expressions, what jobs need of each other, shell commands."""

import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
ACTIONLINT = ROOT / "build" / "venv" / "workflows" / "bin" / "actionlint"
WORKFLOWS = sorted((ROOT / ".github" / "workflows").glob("*.yml"))


def complaints(*paths):
    process = subprocess.run([ACTIONLINT, "-no-color", *paths], capture_output=True, text=True, cwd=ROOT)
    return process.stdout + process.stderr


def test_nothing_to_complain_of():
    assert WORKFLOWS and complaints(*WORKFLOWS) == ""


@pytest.mark.parametrize("right, wrong, expected", [
    ("needs: packages", "needs: parcels", "parcels"),
    ("matrix.system", "matrix.machine", 'property "machine" is not defined'),
])
def test_mistakes_are_seen(right, wrong, expected, tmp_path):
    text = (ROOT / ".github/workflows/check.yml").read_text()
    assert right in text
    path = tmp_path / "check.yml"
    path.write_text(text.replace(right, wrong))
    assert expected in complaints(path)
