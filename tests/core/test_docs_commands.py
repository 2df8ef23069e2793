# SPDX-License-Identifier: GPL-3.0-or-later
"""The commands that README and docs name: those of partwheel are run as they stand, of all others scripts, options,
tiers, presets, tests and what is read from the environment are there."""

import json
import os
import re
import shlex
import shutil
import subprocess
import sys

import pytest
from conftest import PACKAGES, PLAIN, ROOT
from partwheel.__main__ import parse
from test_docs import PAGES

ELSEWHERE = re.compile(r"s3://|/data/")  # needs other machines
SETTINGS = r"""(PARTWHEEL_\w+=("[^"]*"|\S+) )*"""
TIERS = (ROOT / "scripts" / "test_tiers.py").read_text()
# What the words behind a script are looked for in, if not in the script itself.
OPTIONS = {"scripts/test": TIERS, "scripts/build": (ROOT / "CMakePresets.json").read_text()}


def commands(begin):
    """(page, command) of the pages' lines of code, as far as two spaces or a #, and of code within the text, that begin so."""
    matches = set()
    for page in PAGES:
        text = re.sub(r" \\\n +", " ", page.read_text())
        lines = [re.split(r" {2,}|; |\s+#", line.strip())[0] for line in re.findall(r"^    (.+)$", text, re.M)]
        matches |= {(page.relative_to(ROOT).as_posix(), command) for command in lines + re.findall(r"`([^`\n]+)`", text)
                  if re.match(begin, command)}
    return sorted(matches)


PARTWHEEL = commands(r"partwheel [a-z]")
WHOLE = [entry for entry in PARTWHEEL if re.search(r" -o |report \w+$", entry[1])]


@pytest.mark.parametrize("page, command", PARTWHEEL)
def test_options_of_partwheel_are_there(page, command, capsys):
    words = shlex.split(re.sub(r"\$\w+", "1", command))[1:]
    if (page, command) in WHOLE:
        parse(words)  # ends the program if it does not know a word
    with pytest.raises(SystemExit):
        parse([words[0], "--help"])
    help_text = capsys.readouterr().out
    assert all(re.search(rf"{word}(?![\w-])", help_text) for word in words if word.startswith("--")), help_text


@pytest.mark.skipif(not PLAIN, reason="The sanitizers' run has no more to find here: other tests build.")
def test_commands_of_partwheel_run(meshes_directory, tmp_path):
    """One after the other in one folder, each on a model of the name that it gives."""
    trimesh = pytest.importorskip("trimesh")
    for package in ("manifold3d", "lxml", "PIL", "embreex"):
        pytest.importorskip(package)
    hand = trimesh.load(meshes_directory / "hand.off")
    for name in ("model.obj", "model.glb", "chair.obj", "models/model.stl"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        hand.export(tmp_path / name)
    ran = set()
    # What makes results comes before what reports them.
    for command in sorted({text for _, text in WHOLE if not ELSEWHERE.search(text)}, key=lambda text: " report " in text):
        words = shlex.split(command)[1:]
        if "OUT" in words:
            continue
        result = subprocess.run([sys.executable, "-m", "partwheel", *words], cwd=tmp_path, capture_output=True, text=True,
                                env={**os.environ, "PYTHONPATH": PACKAGES})
        assert result.returncode == 0, (command, result.stderr)
        if "-o" in words:
            output = tmp_path / words[words.index("-o") + 1]
            assert output.is_file() or list(output.iterdir()), command
            ran.add(words[0])
            if output.name != "results":
                (shutil.rmtree if output.is_dir() else os.remove)(output)
    assert ran == {"build", "parts", "convex", "batch"} and (tmp_path / "results" / "report.html").exists()


@pytest.mark.parametrize("page, command", commands(SETTINGS + r"(scripts|tests/quality)/(?!partwheel.js)[a-z]"))
def test_words_behind_a_script_are_known_to_it(page, command):
    words = [word for word in shlex.split(command) if not re.match(r"PARTWHEEL_", word)]
    text = OPTIONS.get(words[0], "") + (ROOT / words[0]).read_text()
    for word in words[1:]:
        if re.match(r"[a-z-]", word) and word != "default=OUT":
            assert re.search(rf"(?<![\w-]){re.escape(word)}(?![\w-])", text), word


@pytest.mark.parametrize("page, command", commands(SETTINGS + r"\S*python -m pytest"))
def test_tests_that_are_named_are_there(page, command):
    words = shlex.split(command)
    word = words[words.index("-k") + 1]
    folder = ROOT / next(argument for argument in words if argument.startswith("tests/"))
    assert any(re.search(rf"^def test_\w*{word}|\b{word}\w*\.py", path.name + "\n" + path.read_text(), re.M)
               or word in path.name for path in folder.glob("test_*.py")), word


@pytest.mark.parametrize("page, command", commands("ctest "))
def test_presets_of_native_tests_and_their_names_are_there(page, command):
    words = shlex.split(command)
    presets = json.loads((ROOT / "CMakePresets.json").read_text())["testPresets"]
    assert words[words.index("--preset") + 1] in {preset["name"] for preset in presets}
    assert list((ROOT / "tests" / "native").glob(f"*{words[words.index('-R') + 1]}*_test.cpp"))


def test_what_the_environment_says_is_read():
    mentioned = {name for page in PAGES for name in re.findall(r"\bPARTWHEEL_[A-Z]+", page.read_text())}
    read = "".join(path.read_text(errors="replace") for folder in ("scripts", "tests") for path in (ROOT / folder).rglob("*")
                   if path.is_file() and path.suffix in ("", ".sh", ".py") and path.name != "test_docs_commands.py")
    assert len(mentioned) > 10 and {name for name in mentioned if name not in read} == set()
