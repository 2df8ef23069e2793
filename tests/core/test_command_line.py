# SPDX-License-Identifier: GPL-3.0-or-later
"""python3 -m partwheel: exit codes, the report in words and in JSON, in processes of their own."""

import json
import os
import shutil
import signal
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
def test_the_reported_peak_memory_excludes_the_caller(tmp_path):
    """Whatever the process held that called it."""
    caller = tmp_path / "caller.py"
    caller.write_text("import subprocess, sys\nheld = bytearray(b'1') * 2**30\nsubprocess.run(sys.argv[1:])\n")
    model = Path(__file__).parents[2] / "build" / "deps" / "meshes" / "hand.off"
    process = subprocess.run([sys.executable, caller, sys.executable, "-m", "partwheel", "build", model, "--json"],
                          capture_output=True, text=True, env={**os.environ, "PYTHONPATH": PACKAGES})
    assert json.loads(process.stdout)["peak_memory_bytes"] < 2**30


def test_named_errors(meshes_directory, tmp_path):
    result = run("build", meshes_directory / "open_cube.off", "--json", "--fill-methods", "exact", "-o", tmp_path / "none")
    report = json.loads(result.stdout)
    assert result.returncode == 1 and report["error"]["name"] == "open" and report["tets"] is None
    assert report["seconds"]["surface"] > 0 and report["error"]["message"].endswith(".")
    assert not (tmp_path / "none").exists()
    result = run("build", meshes_directory / "open_cube.off", "--fill-methods", "exact")
    assert result.returncode == 1 and "open" in result.stderr and result.stdout == ""


@pytest.mark.parametrize("name, text", [
    ("triangle.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 2 99\n"),
    ("quad.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n4 0 2 -1 3\n"),
    ("far.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 99\n")])
def test_faces_of_missing_vertices_are_named(name, text, tmp_path):
    """Also before marks are read."""
    (tmp_path / name).write_text(text)
    done = run("build", tmp_path / name, "-o", tmp_path / "out")
    assert done.returncode == 1 and "refers to a vertex that does not exist" in done.stderr, done.stderr
    assert "Traceback" not in done.stderr and "face " in done.stderr


def test_without_the_library_a_clear_sentence(hand, tmp_path):
    copy = tmp_path / "partwheel"
    shutil.copytree(Path(PACKAGES) / "partwheel", copy, ignore=shutil.ignore_patterns("libpartwheel*", "__pycache__"))
    alone = {"PYTHONPATH": str(tmp_path), "PARTWHEEL_LIBRARY": ""}
    result = run("build", hand, **alone)
    assert result.returncode == 1 and "is missing" in result.stderr and "Traceback" not in result.stderr
    (copy / "libpartwheel.so").write_bytes(b"not a library")
    assert run("build", hand, **alone).returncode == 1


def test_a_saved_hierarchy_loads(hand, tmp_path):
    saved = tmp_path / "hand.partwheel"
    assert run("build", hand, "-o", saved).returncode == 0
    assert np.array_equal(np.sort(Hierarchy.load(saved.read_bytes()).order), np.arange(2390))


@pytest.mark.skipif(os.name == "nt", reason="a pipe breaks in another way there")
@pytest.mark.parametrize("arguments", [
    ["build", "hand.off"], ["build", "hand.off", "--json"], ["parts", "hand.off", "-o", "parts"],
    ["parts", "textured.obj", "-o", "parts", "--formats", "stl"],  # prints before the work that the texture is dropped
    ["batch", "hand.off", "-o", "results"], ["--help"]], ids=" ".join)
def test_ends_quietly_when_nothing_reads_the_output(arguments, hand, tmp_path):
    """As tools of Unix do: partwheel build hand.off | head"""
    shutil.copy(hand, tmp_path)
    (tmp_path / "textured.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\n"
                                           "f 1/1 3/1 2/1\nf 1/1 2/1 4/1\nf 1/1 4/1 3/1\nf 2/1 3/1 4/1\n")
    reader, writer = os.pipe()
    os.close(reader)
    result = subprocess.run([sys.executable, "-m", "partwheel", *arguments], stdout=writer, stderr=subprocess.PIPE, text=True,
                            cwd=tmp_path, timeout=1800, env={**os.environ, "PYTHONPATH": PACKAGES})
    os.close(writer)
    assert "Traceback" not in result.stderr and "pipe" not in result.stderr
    assert result.returncode == 128 + signal.SIGPIPE
    assert (tmp_path / "parts").exists() == ("hand.off" in arguments and "parts" in arguments)  # written before the report
