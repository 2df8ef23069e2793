# SPDX-License-Identifier: GPL-3.0-or-later
"""python3 -m partwheel: exit codes, the report in words and in JSON, in processes of their own."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import PACKAGES
from partwheel import Hierarchy

STAGES = ["surface", "repair", "tetrahedra", "cluster", "dendrogram", "hierarchy"]


def run(*arguments, python=(sys.executable,), **environment):
    return subprocess.run(
        [*python, "-m", "partwheel", *map(str, arguments)], capture_output=True, text=True, timeout=1800,
        env={**os.environ, "PYTHONPATH": PACKAGES, **environment},
    )


@pytest.fixture
def hand(meshes_directory):
    return meshes_directory / "hand.off"


def test_json_of_a_build(hand, tmp_path, build_shape):
    saved = tmp_path / "hand.partwheel"
    result = run("build", hand, "--json", "-o", saved)
    assert result.returncode == 0, result.stderr
    report = json.loads(result.stdout)
    _, h = build_shape("hand.off")
    assert report["error"] is None
    assert (report["faces"], report["tets"], report["components"]) == (2390, len(h.tetrahedra), 1)
    assert list(report["seconds"]) == STAGES and all(seconds > 0 for seconds in report["seconds"].values())
    assert 10 * 2**20 < report["peak_memory_bytes"] < 2**30
    assert saved.read_bytes() == h.save()


@pytest.mark.skipif(sys.platform != "linux", reason="other systems don't begin with the caller's")
def test_the_peak_is_the_programs_own(tmp_path):
    """Whatever the process held that called it."""
    caller = tmp_path / "caller.py"
    caller.write_text("import subprocess, sys\nheld = bytearray(b'1') * 2**30\nsubprocess.run(sys.argv[1:])\n")
    model = Path(__file__).parents[2] / "build" / "deps" / "meshes" / "hand.off"
    process = subprocess.run([sys.executable, caller, sys.executable, "-m", "partwheel", "build", model, "--json"],
                          capture_output=True, text=True, env={**os.environ, "PYTHONPATH": PACKAGES})
    assert json.loads(process.stdout)["peak_memory_bytes"] < 2**30


def test_words_of_a_build(hand):
    result = run("build", hand)
    assert result.returncode == 0 and result.stderr == ""
    assert "2390 faces" in result.stdout and all(stage in result.stdout for stage in STAGES)


def test_quality(hand):
    plain, finer = (json.loads(run("build", hand, "--json", *options).stdout) for options in ([], ["--quality", "1.4"]))
    assert plain["added_vertices"] == 0 and finer["added_vertices"] > 0 and finer["tets"] > plain["tets"]


def test_named_errors(meshes_directory, tmp_path):
    result = run("build", meshes_directory / "open_cube.off", "--json", "--fill-methods", "exact", "-o", tmp_path / "none")
    report = json.loads(result.stdout)
    assert result.returncode == 1 and report["error"]["name"] == "open" and report["tets"] is None
    assert report["seconds"]["surface"] > 0 and report["error"]["message"].endswith(".")
    assert not (tmp_path / "none").exists()
    result = run("build", meshes_directory / "open_cube.off", "--fill-methods", "exact")
    assert result.returncode == 1 and "open" in result.stderr and result.stdout == ""


def test_fill_methods(meshes_directory):
    cube = meshes_directory / "open_cube.off"
    for fill_methods, expected in ((), "repaired"), (("--fill-methods", "exact,points"), "points"):
        report = json.loads(run("build", cube, "--json", *fill_methods).stdout)
        assert report["error"] is None and report["fill_method"] == expected and report["notes"].endswith(".")
        assert report["deviation"] == 0 if expected == "repaired" else report["deviation"] < 0.02
    words = run("build", cube).stdout
    assert "repaired" in words and "1 hole filled" in words


def test_open_surfaces(meshes_directory):
    plane = meshes_directory / "plane.off"
    refused = run("build", plane, "--json", "--no-open-surfaces")
    assert refused.returncode == 1 and json.loads(refused.stdout)["error"]["name"] == "not solid"
    report = json.loads(run("build", plane, "--json").stdout)
    assert report["error"] is None and report["fill_method"] == "sheet" and "thin" in report["notes"]


def test_a_file_that_is_no_mesh(tmp_path):
    for name, content in (("a.off", "not a mesh"), ("b.off", "OFF\n8 6 0\n0 0 0\n"), ("c.stl", "x"), ("d.xyz", "1 2 3"),
                          ("e.off", ""), ("f.off", "OFF\n1 1 0\n0 0 0\n4 0 1 2 3\n"), ("g.ply", "ply\n")):
        (tmp_path / name).write_text(content)
        result = run("build", tmp_path / name, "--json")
        assert result.returncode == 1, (name, result.stderr)
        assert json.loads(result.stdout)["error"]["name"] == "mesh file"


@pytest.mark.parametrize("arguments", [[], ["build"], ["grow", "x.off"], ["build", "x.off", "--json=yes"],
                                       ["build", "x.off", "--quality", "high"],
                                       ["build", "x.off", "--fill-methods", "exact,best"], ["build", "missing.off"],
                                       ["build", "/"]])
def test_wrong_usage(arguments):
    assert run(*arguments).returncode == 2


def test_an_output_that_can_not_be_written(hand, tmp_path):
    assert run("build", hand, "-o", tmp_path / "missing" / "hand.partwheel").returncode == 2


def test_without_trimesh_a_clear_sentence(meshes_directory, tmp_path):
    (tmp_path / "trimesh.py").write_text("raise ImportError('none here')")
    path = os.pathsep.join([str(tmp_path), PACKAGES])
    result = run("build", meshes_directory / "sphere.stl", PYTHONPATH=path)
    assert result.returncode == 1 and 'pip install "partwheel[meshes]"' in result.stderr and "Traceback" not in result.stderr
    assert run("build", meshes_directory / "hand.off", PYTHONPATH=path).returncode == 0


def test_without_the_library_a_clear_sentence(hand, tmp_path):
    copy = tmp_path / "partwheel"
    shutil.copytree(Path(PACKAGES) / "partwheel", copy, ignore=shutil.ignore_patterns("libpartwheel*", "__pycache__"))
    alone = {"PYTHONPATH": str(tmp_path), "PARTWHEEL_LIBRARY": ""}
    result = run("build", hand, **alone)
    assert result.returncode == 1 and "is missing" in result.stderr and "Traceback" not in result.stderr
    (copy / "libpartwheel.so").write_bytes(b"not a library")
    assert run("build", hand, **alone).returncode == 1


def test_what_was_saved_loads_again(hand, tmp_path):
    saved = tmp_path / "hand.partwheel"
    assert run("build", hand, "-o", saved).returncode == 0
    assert np.array_equal(np.sort(Hierarchy.load(saved.read_bytes()).order), np.arange(2390))
