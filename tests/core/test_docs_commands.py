# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the commands of partwheel that README and docs show."""

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


def commands(pattern):
    """(page, command) of all code in the pages that starts with this pattern. A line of code ends at two spaces or a #."""
    matches = set()
    for page in PAGES:
        text = re.sub(r" \\\n +", " ", page.read_text())
        lines = [re.split(r" {2,}|; |\s+#", line.strip())[0] for line in re.findall(r"^    (.+)$", text, re.M)]
        matches |= {(page.relative_to(ROOT).as_posix(), command) for command in lines + re.findall(r"`([^`\n]+)`", text)
                  if re.match(pattern, command)}
    return sorted(matches)


PARTWHEEL = commands(r"partwheel [a-z]")
WHOLE = [entry for entry in PARTWHEEL if re.search(r" -o |report \w+$", entry[1])]


@pytest.mark.parametrize("page, command", PARTWHEEL)
def test_documented_options_exist(page, command, capsys):
    words = shlex.split(re.sub(r"\$\w+", "1", command))[1:]
    if (page, command) in WHOLE:
        parse(words)  # exits if it does not know a word
    with pytest.raises(SystemExit):
        parse([words[0], "--help"])
    help_text = capsys.readouterr().out
    assert all(re.search(rf"{word}(?![\w-])", help_text) for word in words if word.startswith("--")), help_text


@pytest.mark.skipif(not PLAIN, reason="Other tests run the same code with sanitizers.")
def test_commands_of_partwheel_run(meshes_directory, tmp_path):
    """They run one after the other in one folder, which has the models that they name."""
    trimesh = pytest.importorskip("trimesh")
    for package in ("manifold3d", "lxml", "PIL", "embreex"):
        pytest.importorskip(package)
    hand = trimesh.load(meshes_directory / "hand.off")
    for name in ("model.obj", "model.glb", "chair.obj", "figure.obj", "models/model.stl"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        hand.export(tmp_path / name)
    (tmp_path / "FILE").write_text("\n".join(map(str, (hand.triangles_center[:, 0] > hand.centroid[0]).astype(int))))
    (tmp_path / "robot.urdf").write_text("""<robot name="robot"><link name="base"><collision><geometry>
        <mesh filename="model.obj"/></geometry></collision></link></robot>""")
    ran = set()
    # Reports come after the commands whose results they need.
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
