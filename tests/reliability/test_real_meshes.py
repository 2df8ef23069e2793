# SPDX-License-Identifier: GPL-3.0-or-later
"""All real meshes of build/deps/meshes on the exact rung alone, through the command line, a process each: what is
closed, manifold, oriented and free of self-intersection is built; every other one gets the named error it deserves.

What each mesh deserves is found here without the library (surfaces.py). A refusal for self-intersection must be right,
too: the two faces it names must truly meet, in exact arithmetic.
"""

import json
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import pytest
import surfaces
from conftest import ROOT
from partwheel import meshes

MESHES = ROOT / "build" / "deps" / "meshes"
FILES = sorted(path.name for path in MESHES.iterdir())
SECONDS = 3600  # so that nothing hangs for ever
PROCESSES = 2
NO_TRIANGLES = {"b9.ply"}  # a cloud of points


def build(name):
    """(exit code, report, what was written beside it)"""
    run = subprocess.run(
        [sys.executable, "-m", "partwheel", "build", str(MESHES / name), "--json", "--rungs", "exact"],
        capture_output=True, text=True, timeout=SECONDS, env={**os.environ, "PYTHONPATH": str(ROOT / "native" / "python")},
    )
    return run.returncode, json.loads(run.stdout) if run.stdout else None, run.stderr


@pytest.fixture(scope="session")
def results():
    """File name -> a future of build(); large meshes first, so that none is left for the end."""
    with ThreadPoolExecutor(PROCESSES) as pool:
        by_size = sorted(FILES, key=lambda name: -(MESHES / name).stat().st_size)
        yield {name: pool.submit(build, name) for name in by_size}


def test_there_are_meshes():
    assert len(FILES) >= 130, f"{MESHES} holds only {len(FILES)} meshes: run scripts/setup.sh again"


@pytest.mark.parametrize("name", FILES)
def test_built_or_named(name, results):
    code, report, errors = results[name].result()
    assert code in (0, 1) and report is not None and "Traceback" not in errors, errors
    if name in NO_TRIANGLES:
        assert report["error"]["name"] == "mesh file"
        return
    mesh = meshes.read(MESHES / name)
    if code == 0:
        assert surfaces.defects(mesh.vertices, mesh.triangles) == set()
        assert report["faces"] == mesh.face_count and report["tets"] > 0 and report["volume"] > 0
    else:
        error = report["error"]
        assert surfaces.deserved(mesh.vertices, mesh.triangles, mesh.faces, error["name"], error["message"]), error


@pytest.mark.parametrize("name", ["3torus.off", "dragknob.off", "cross.off", "joint.off", "helmet.off"])
def test_what_was_built_has_no_self_intersection(name, results):
    code, _, _ = results[name].result()
    mesh = meshes.read(MESHES / name)
    pairs = list(surfaces.near_pairs(mesh.vertices, mesh.triangles))
    assert code == 0 and len(pairs) >= 3 * len(mesh.triangles) // 2
    assert not any(surfaces.crossing(mesh.vertices, mesh.triangles, *pair) for pair in pairs)
