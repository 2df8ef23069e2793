# SPDX-License-Identifier: GPL-3.0-or-later
"""The tier `quality`: how well parts are selected, and how alike the two sides of symmetric models are, against limits.

Results are the same on every machine, so a figure moves only where a change moves it: limits stand close to what is
measured, and a change that improves a figure raises its limit. They are in LIMITS and DEMO_LIMITS, and nowhere else;
`pytest -s` prints what was measured. The benchmark's models and its score are not ours to pass on: where they are not,
only the mirror images of libcgal-demo's models are looked at.
"""

import os
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from mirror import images, mirror_faces
from psb import ROOT, Mode, arrays, build
from table import benchmark

MODELS = os.environ.get("PARTWHEEL_PSB") or ROOT / "build" / "deps" / "psb"
SCORE = ROOT.parent / "shared" / "psb" / "score.py"
# One a category (261 to 280 hold none), and another of the hardest ones: human, bust, mech, bearing, four-legged.
BENCHMARK = [m for m in range(10, 391, 20) if m != 270] + [16, 316, 336, 356, 396]
TEN = [10, 50, 90, 130, 170, 190, 290, 316, 336, 396]  # of these, what the gate has time for
SYMMETRIC = ["bull.off", "cow.off", "elk.off", "pig.off", "triceratops.off"]  # of libcgal-demo
HIGHER_IS_WORSE = {"notches", "cut", "chosen"}

# best, click, within two: overlap with what a person cut, on the wheel's path, at the click, within two notches of it;
# notches from the click to the best; cut, chosen: 1 - Rand index, the number of parts given, and not. images of clicks
# and nodes: see mirror.py; of those models that are symmetric.
LIMITS = {"best": 0.749, "click": 0.642, "within two": 0.72, "notches": 0.894, "cut": 0.097, "chosen": 0.101,
          "images of clicks": 0.998, "images of nodes": 0.872}
TEN_LIMITS = {"best": 0.781, "click": 0.67, "within two": 0.749, "notches": 0.912, "cut": 0.095, "chosen": 0.095,
              "images of clicks": 0.998, "images of nodes": 0.99}
DEMO_LIMITS = {"images of clicks": 0.957, "images of nodes": 0.769}  # of libcgal-demo's models alone


def figures(path):
    """What LIMITS has, of one model, as far as it applies to it."""
    mesh, hierarchy = build(path, Mode.LEARNED)
    scores = {}
    if path.parent.name == "off":
        clicks, cut, start_nodes = benchmark(SCORE).score_model(
            int(path.stem), path.parent, path.parents[1] / "seg", arrays(hierarchy, mesh.face_count))
        best, click, within, _, notches = clicks.mean(axis=0)
        scores |= {"best": best, "click": click, "within two": within, "notches": notches, "cut": cut.mean(),
                   "chosen": start_nodes.mean()}
    image = mirror_faces(mesh)
    if image is not None:
        of_clicks, of_nodes = images(hierarchy, mesh, image)
        scores |= {"images of clicks": of_clicks, "images of nodes": of_nodes}
    return scores


def means(paths):
    with ProcessPoolExecutor() as pool:
        rows = list(pool.map(figures, paths))
    names = {name: None for row in rows for name in row}
    return {name: np.mean([row[name] for row in rows if name in row]) for name in names}


def check(scores, limits):
    print("", *(f"{name} {figure:.4f}" for name, figure in scores.items()), sep="\n")  # what the next limits are made of
    assert scores.keys() == limits.keys()
    worse = [f"{name} {figure:.4f}, limit {limits[name]}" for name, figure in scores.items()
             if (figure > limits[name] if name in HIGHER_IS_WORSE else figure < limits[name])]
    assert not worse, "; ".join(worse)


def check_benchmark(models, limits):
    if not Path(MODELS).is_dir() or not SCORE.exists():
        pytest.skip(f"the benchmark is not here: {MODELS} and {SCORE}")
    check(means([Path(MODELS) / "off" / f"{model}.off" for model in models]), limits)


def test_24_models_of_the_benchmark():
    check_benchmark(BENCHMARK, LIMITS)


def test_ten_models_of_the_benchmark():
    """What the gate runs. Where the benchmark is absent, on models of libcgal-demo."""
    if Path(MODELS).is_dir() and SCORE.exists():
        check_benchmark(TEN, TEN_LIMITS)
    else:
        test_symmetric_models_of_libcgal_demo()


def test_symmetric_models_of_libcgal_demo():
    check(means([ROOT / "build" / "deps" / "meshes" / name for name in SYMMETRIC]), DEMO_LIMITS)
