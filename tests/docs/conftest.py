# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tests of the recipes share."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = os.environ.get("PARTWHEEL_PACKAGES", str(ROOT / "native" / "python"))
sys.path.insert(0, PACKAGES)


@pytest.fixture
def command(tmp_path):
    """Runs a command of a recipe in a folder of its own: what it printed."""
    def run(*words):
        environment = {**os.environ, "PYTHONPATH": PACKAGES, "HOME": str(tmp_path / "home"), "LC_ALL": "C.UTF-8"}
        result = subprocess.run(list(map(str, words)), cwd=tmp_path, env=environment, capture_output=True, text=True)
        assert result.returncode == 0, result.stdout + result.stderr
        return result.stdout
    return run
