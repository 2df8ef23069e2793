# SPDX-License-Identifier: GPL-3.0-or-later
"""The commands that README and docs name: those of partwheel are run as they stand, of all others scripts, options,
tiers, presets, tests and what is read from the environment are there."""

import json
import re
import shlex
import shutil
import subprocess
import sys

import pytest
from conftest import PACKAGES, ROOT
from partwheel.__main__ import parse
from test_docs import PAGES

ELSEWHERE = re.compile(r"s3://|/data/")  # needs other machines
TIERS = (ROOT / "scripts" / "test_tiers.py").read_text()
# What the words behind a script are looked for in, if not in the script itself.
OPTIONS = {"scripts/test": TIERS, "scripts/build": (ROOT / "CMakePresets.json").read_text()}


def commands(begin):
    """(page, command) of the pages' lines of code, and of code within the text, that begin so."""
    found = []
    for page in PAGES:
        text = re.sub(r" \\\n +", " ", page.read_text())
        lines = [line.strip() for line in re.findall(r"^    (.+)$", text, re.M)] + re.findall(r"`([^`\n]+)`", text)
        # Two spaces part a command from what is said about it, and a semicolon from the next one.
        for line in lines:
            for each in re.split(r" {2,}|; ", line):
                each = re.sub(r"^(and|or|then) ", "", each).split(" | ")[0]
                each = re.sub(r"( #|: | alone).*", "", each)
                if re.match(begin, each):
                    found.append((page.relative_to(ROOT).as_posix(), each))
    return sorted(set(found))


PARTWHEEL = [each for each in commands(r"partwheel [a-z]") if "IN..." not in each[1]]


@pytest.mark.parametrize("page, command", PARTWHEEL)
def test_options_of_partwheel_are_there(page, command):
    parse(shlex.split(command)[1:])  # ends the program if it does not know a word


def test_commands_of_partwheel_run(meshes_directory, tmp_path):
    """One after the other in one folder, on a model of the name that each gives."""
    trimesh = pytest.importorskip("trimesh")
    pytest.importorskip("manifold3d")
    hand = trimesh.load(meshes_directory / "hand.off")
    (tmp_path / "models").mkdir()
    for name in ("model.obj", "model.glb", "chair.obj", "model.off", "models/model.stl"):
        hand.export(tmp_path / name)
    ran = set()
    # What makes results comes before what reports them.
    for command in sorted({each for _, each in PARTWHEEL}, key=lambda each: each.startswith("partwheel report")):
        words = shlex.split(command)[1:]
        if ELSEWHERE.search(command) or not re.search(r"model|chair|results", command) or "MODEL" in command:
            continue
        before = set(tmp_path.rglob("*"))
        result = subprocess.run([sys.executable, "-m", "partwheel", *words], cwd=tmp_path, capture_output=True, text=True,
                                env=environment())
        assert result.returncode == 0, (command, result.stderr)
        if "-o" in words:
            assert set(tmp_path.rglob("*")) - before, command
            out = tmp_path / words[words.index("-o") + 1]
            (shutil.rmtree if out.is_dir() and words[0] != "batch" else lambda path: None)(out)
        ran.add(words[0])
    assert ran == {"build", "parts", "convex", "batch", "report"}
    assert (tmp_path / "results" / "report.html").exists()


def environment():
    import os
    return {**os.environ, "PYTHONPATH": PACKAGES}


@pytest.mark.parametrize("page, command", commands(r"(PARTWHEEL_\S+ )*(scripts/|tests/quality/)[a-z]"))
def test_words_behind_a_script_are_known_to_it(page, command):
    words = [word for word in shlex.split(command) if not re.match(r"PARTWHEEL_", word)]
    text = OPTIONS.get(words[0], "") + (ROOT / words[0]).read_text()
    for word in words[1:]:
        if re.match(r"[a-z-]", word) and word != "default=OUT":
            assert re.search(rf"(?<![\w-]){re.escape(word)}(?![\w-])", text), word


@pytest.mark.parametrize("page, command", commands(r"(PARTWHEEL_\S+ )*\S*python -m pytest"))
def test_tests_that_are_named_are_there(page, command):
    words = shlex.split(command)
    word = words[words.index("-k") + 1]
    folder = ROOT / next(each for each in words if each.startswith("tests/"))
    assert any(re.search(rf"^def test_\w*{word}|\b{word}\w*\.py", path.name + "\n" + path.read_text(), re.M)
               or word in path.name for path in folder.glob("test_*.py")), word


@pytest.mark.parametrize("page, command", commands("ctest "))
def test_presets_of_native_tests_and_their_names_are_there(page, command):
    words = shlex.split(command)
    presets = json.loads((ROOT / "CMakePresets.json").read_text())["testPresets"]
    assert words[words.index("--preset") + 1] in {preset["name"] for preset in presets}
    assert list((ROOT / "tests" / "native").glob(f"*{words[words.index('-R') + 1]}*_test.cpp"))


def test_what_the_environment_says_is_read():
    told = {name for page in PAGES for name in re.findall(r"\bPARTWHEEL_[A-Z]+", page.read_text())}
    read = "".join(path.read_text(errors="replace") for folder in ("scripts", "tests") for path in (ROOT / folder).rglob("*")
                   if path.is_file() and path.suffix in ("", ".sh", ".py") and path.name != "test_docs_commands.py")
    assert len(told) > 10 and {name for name in told if name not in read} == set()
