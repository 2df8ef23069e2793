# SPDX-License-Identifier: GPL-3.0-or-later
"""What .pre-commit-config.yaml has run before a commit, run on all files; and that each tool sees a mistake of its kind."""

import os
import re
import subprocess

import pytest
from conftest import PLAIN, ROOT

CONFIGURATION = ROOT / ".pre-commit-config.yaml"
MISTAKES = {
    "ruff": ("x.py", "import os\n"),
    "shellcheck": ("x.sh", "#!/bin/sh\nrm $1\n"),
    "actionlint": (".github/workflows/x.yml", "on: push\njobs:\n  x:\n    runs-on: ${{ matrix.machine }}\n    steps: [run: x]\n"),
    "cffconvert": ("CITATION.cff", "cff-version: 1.2.0\ntitle: Partwheel\n"),
    "check-merge-conflict": ("x.txt", "<<<<<<< HEAD\nx\n=======\ny\n>>>>>>> main\n"),
    "trailing-whitespace": ("x.txt", "x \n"),
}

pytestmark = pytest.mark.skipif(not PLAIN, reason="it is about sources, not about what runs")


def hooks(folder, *arguments):
    """What pre-commit says of all files of a repository, with its exit code."""
    environment = {name: value for name, value in os.environ.items() if not name.startswith("GIT_")}
    environment |= {"GIT_CONFIG_COUNT": "1", "GIT_CONFIG_KEY_0": "safe.directory", "GIT_CONFIG_VALUE_0": "*",  # of any owner
                    "PRE_COMMIT_HOME": str(ROOT / "build" / "deps" / "hooks")}
    done = subprocess.run([ROOT / "build/venv/hooks/bin/pre-commit", "run", *arguments, "--all-files", "--color", "never",
                           "--config", CONFIGURATION],
                          cwd=folder, capture_output=True, text=True, env=environment)
    return done.returncode, done.stdout + done.stderr


def test_nothing_to_complain_of():
    code, said = hooks(ROOT)
    assert code == 0 and said.count("Passed") == len(MISTAKES), said


def test_each_has_a_mistake_to_see():
    assert set(re.findall(r"- id: (.+)", CONFIGURATION.read_text())) == set(MISTAKES)


@pytest.mark.parametrize("hook", MISTAKES)
def test_mistakes_are_seen(hook, tmp_path):
    name, text = MISTAKES[hook]
    (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
    (tmp_path / name).write_text(text)
    subprocess.run("git init -q && git add -A", shell=True, cwd=tmp_path, check=True)
    code, said = hooks(tmp_path, hook)
    assert code == 1 and "Failed" in said, said
