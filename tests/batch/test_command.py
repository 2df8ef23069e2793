# SPDX-License-Identifier: GPL-3.0-or-later
"""partwheel batch in a process of its own: what it makes, hostile files, kills at any time, Ctrl-C, limits, Blender."""

import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from conftest import HAND, command, environment, hostile, reports, results, run, zip_bomb
from partwheel import Hierarchy

from partwheel import meshes
from partwheel.batch import slot
from partwheel.batch.run import BatchOptions, BatchRun

# More models and kills, by the hour: PARTWHEEL_KILLS=20 PARTWHEEL_MODELS=FOLDER
KILLS = int(os.environ.get("PARTWHEEL_KILLS", 4))
MORE = list(Path(os.environ["PARTWHEEL_MODELS"]).iterdir()) if os.environ.get("PARTWHEEL_MODELS") else []
SETTINGS = {"outputs": ["hierarchy"], "build": {"mode": "learned"}, "parts": 0, "hulls": 0, "max_vertices": 0, "preview": 0}
LINUX = pytest.mark.skipif(sys.platform != "linux", reason="limits of memory are kept on Linux only")


def test_every_result_of_a_model_is_written(tmp_path):
    trimesh = pytest.importorskip("trimesh")
    from PIL import Image

    totals = run(HAND, "-o", tmp_path, "--make", "hierarchy,cut,objects,colliders,preview", "--hulls", 7,
                 "--max-vertices", 40)
    assert totals["built"] == 1 and totals["failed"] == {}
    report = reports(tmp_path)[str(HAND)]
    place = tmp_path / "models" / report["key"][:2] / report["key"]
    files = {"hierarchy.partwheel", "cut.json", "objects.glb", "colliders.obj", "preview.png"}
    assert set(report["files"]) == files == {path.name for path in place.iterdir()} - {"model.json"}
    assert report["error"] is None and report["fill_method"] == "exact" and report["faces"] == 2390
    assert 0 < report["processor_seconds"]
    assert {"read", "build", "tetrahedra", "cut", "preview"} <= set(report["seconds"])

    mesh = meshes.read(HAND)
    built = Hierarchy.build(mesh.vertices, mesh.triangles)
    assert (place / "hierarchy.partwheel").read_bytes() == built.save()
    labels = np.array(json.loads((place / "cut.json").read_text())["labels"])
    assert np.array_equal(np.unique(labels, return_counts=True)[1],
                          np.unique(built.face_labels(built.cut_automatic()), return_counts=True)[1])
    lines = [line.split() for line in (place / "colliders.obj").read_text().splitlines()]
    points = np.array([line[1:] for line in lines if line[0] == "v"], float)
    pieces = "".join(line[0] for line in lines).split("o")[1:]
    corners = np.array([line[1:] for line in lines if line[0] == "f"], int) - 1
    ends = np.cumsum([piece.count("f") for piece in pieces])
    hulls = [trimesh.Trimesh(points, triangles) for triangles in np.split(corners, ends[:-1])]
    assert [line[1] for line in lines if line[0] == "o"] == [f"UCX_{number:02}" for number in range(7)]
    assert len(hulls) == report["hulls"] == 7 and all(hull.is_convex and hull.is_watertight for hull in hulls)
    assert max(len(np.unique(hull.faces)) for hull in hulls) == 40
    assert built.summary.volume < sum(hull.volume for hull in hulls) < built.summary.hull_volume
    objects = trimesh.load(place / "objects.glb", force="scene")
    assert len(objects.geometry) == report["parts"] > 3
    picture = np.asarray(Image.open(place / "preview.png"))
    assert picture.shape == (192, 192, 3)
    colors = np.unique(picture.reshape(-1, 3), axis=0)
    assert (picture[[0, -1]] == 255).all() and 0.1 < (picture < 255).any(axis=2).mean() < 0.9 and len(colors) > 50


def test_hostile_files_fail_by_name_and_alone(boxes, tmp_path):
    folder = tmp_path / "hostile"
    folder.mkdir()
    expected = hostile(folder)
    totals = run(boxes, folder, "-o", tmp_path / "out", "--make", "hierarchy", "--cpu-limit", 60, code=1)
    report_of = reports(tmp_path / "out")
    assert {path: report_of[path]["error"]["name"] for path in expected} == expected
    assert all(report_of[path]["error"] is None for path in map(str, boxes.iterdir()))
    assert sum(totals["failed"].values()) == len(expected) - totals["duplicates"]
    assert run(boxes, folder, "-o", tmp_path / "out", "--make", "hierarchy", code=1)["built"] == 0


@LINUX
def test_a_zip_bomb_meets_its_limit_alone(boxes, tmp_path):
    bomb = tmp_path / "bomb.zip"
    zip_bomb(bomb, 2**30)
    assert bomb.stat().st_size < 2**24
    totals = run(bomb, boxes, "-o", tmp_path / "out", "--make", "hierarchy", "--memory", "800M", code=1)
    assert totals["failed"] == {"memory": 1} and totals["built"] == 13


@pytest.mark.parametrize("does, patience", [("while True: pass", 1e9), ("time.sleep(1e9)", 1)],
                         ids=["processor time", "waiting for ever"])
def test_a_reader_without_end_meets_its_limit(boxes, tmp_path, monkeypatch, does, patience):
    """Each limit alone. A module that Python loads before all others spins, or waits, when one file is read."""
    (tmp_path / "sitecustomize.py").write_text(
        "import sys, time\n"
        "def hook(event, arguments):\n"
        "    if event == 'open' and str(arguments[0]).endswith('box03.off'):\n"
        f"        {does}\n"
        "sys.addaudithook(hook)\n")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    monkeypatch.setattr(slot, "WALL_CLOCK_FACTOR", patience)
    counts = BatchRun(tmp_path / "out", [str(boxes / "box03.off")], BatchOptions(SETTINGS, 1, 0, seconds=1)).run()
    assert counts.failed == {"time limit": 1} and counts.built == 1


def count_done(folder):
    return sum(path.read_bytes().count(b"\n") for path in folder.glob("done/*"))


def children(process):
    """Process numbers of all that a process has started, and they in turn."""
    text = subprocess.run(["ps", "-e", "-o", "pid=,ppid="], capture_output=True, text=True, check=True).stdout
    parents = [tuple(map(int, line.split())) for line in text.splitlines()]
    descendants = {process}
    while children := {pid for pid, parent in parents if parent in descendants} - descendants:
        descendants |= children
    return descendants - {process}


def alive(numbers):
    text = subprocess.run(["ps", "-o", "pid=,stat=", "-p", ",".join(map(str, numbers))], capture_output=True,
                          text=True).stdout
    return {int(line.split()[0]) for line in text.splitlines() if not line.split()[1].startswith("Z")}


def until(condition):
    """Waits for what comes at last; how long is the machine's affair, so the limit is far away."""
    end = time.monotonic() + 6000
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.005)


def test_killed_at_random_and_resumed_nothing_is_lost_or_done_twice(boxes, tmp_path):
    for path in MORE or [HAND]:
        shutil.copy(path, boxes)
    total = len(list(boxes.iterdir()))
    arguments = boxes, "-o", tmp_path / "out", "--make", "hierarchy,cut,colliders"
    dice, kills = random.Random(5), 0
    for _ in range(KILLS):
        before = count_done(tmp_path / "out")
        process = subprocess.Popen(command(*arguments), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                   env=environment())
        goal = before + dice.randrange(max(3, total // (2 * KILLS)))
        until(lambda: process.poll() is not None or count_done(tmp_path / "out") >= goal)
        time.sleep(dice.random() / 5)  # at any moment of what follows
        started = children(process.pid)
        process.kill()
        kills += process.wait() == -signal.SIGKILL
        until(lambda: not started or not alive(started))  # nothing outlives it
    assert kills >= KILLS // 3
    totals = run(*arguments, code=None)
    assert totals["built"] + totals["existing"] + totals["duplicates"] == total
    whole = run(boxes, "-o", tmp_path / "whole", "--make", "hierarchy,cut,colliders", code=None)
    assert whole["built"] + whole["duplicates"] == total and results(tmp_path / "out") == results(tmp_path / "whole")
    keys = [json.loads(line)["key"] for path in (tmp_path / "out" / "done").iterdir()
            for line in path.read_text().splitlines()]
    assert len(keys) == len(set(keys))


@pytest.mark.parametrize("ending", [signal.SIGINT, signal.SIGTERM])
def test_ctrl_c_ends_all_and_keeps_what_is_done(boxes, tmp_path, ending):
    arguments = boxes, "-o", tmp_path / "out", "--make", "hierarchy", "--jobs", 1
    process = subprocess.Popen(command(*arguments), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                               env=environment())
    until(lambda: count_done(tmp_path / "out") >= 2 or process.poll() is not None)
    started = children(process.pid)
    process.send_signal(ending)
    words = process.communicate()[1]
    assert process.returncode == 130 and "continues with the rest" in words
    assert not started or not alive(started)
    assert list((tmp_path / "out" / "unfinished").iterdir()) == []
    before = count_done(tmp_path / "out")
    assert 2 <= before < 12 and run(*arguments)["built"] == 12 - before
