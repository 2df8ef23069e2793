# SPDX-License-Identifier: GPL-3.0-or-later
"""The models that the tour, the demo and the recipes use are what their descriptions say. trimesh judges them."""

import numpy as np
import pytest
from partwheel.examples import EXAMPLES

# shells, closed, mirror image of itself in x
MODELS = {"figure": (1, True, True), "truck": (24, True, False), "chair": (9, True, True), "dog": (1, False, False)}


@pytest.mark.parametrize("name", EXAMPLES)
def test_shells_are_closed_and_face_outward(name):
    cKDTree = pytest.importorskip("scipy.spatial").cKDTree
    trimesh = pytest.importorskip("trimesh")
    example = EXAMPLES[name]()
    mesh = trimesh.Trimesh(example.vertices, example.triangles, process=False)
    shells, closed, symmetric = MODELS[name]
    assert (mesh.body_count, mesh.is_watertight) == (shells, closed)
    assert len(np.unique(example.vertices, axis=0)) == len(example.vertices)
    if closed:
        assert all(shell.volume > 0 for shell in mesh.split())
    if symmetric:
        distances, _ = cKDTree(example.vertices).query(example.vertices * [-1, 1, 1])
        assert distances.max() < 1e-4


@pytest.mark.parametrize("name", EXAMPLES)
def test_each_polygon_has_a_material_or_a_place_in_the_texture(name):
    example = EXAMPLES[name]()
    assert len(example.material_of_polygon) == len(example.polygons)
    assert example.material_of_polygon.max() < max(len(example.materials), 1)
    assert len(example.triangles) == sum(len(polygon) - 2 for polygon in example.polygons)
    if example.texture is None:
        return
    assert example.uvs.shape == (sum(map(len, example.polygons)), 2)
    assert 0 < example.uvs.min() and example.uvs.max() < 1
    height, width, _ = example.texture.shape
    pixels = (example.uvs * (width, height)).astype(int).reshape(-1, 4, 2)
    tiles = {(x // 10, y // 10) for x, y in pixels[:, 0].tolist()}
    assert len(tiles) == len(example.polygons)  # no two polygons share one
    middle = pixels.mean(axis=1).astype(int)
    shoes = example.vertices[np.array(example.polygons)][:, :, 2].max(axis=1) < 0.02
    assert (example.texture[middle[shoes, 1], middle[shoes, 0]] < 0.2).all()  # dark soles


@pytest.mark.parametrize("up", ["y", "z"])
def test_a_saved_example_stands_and_faces_outward(up, tmp_path):
    """As trimesh reads it, which turns nothing: its height is along the axis that points up, and its volume is the same."""
    trimesh = pytest.importorskip("trimesh")
    example = EXAMPLES["figure"]()
    example.save(tmp_path / "figure.obj", up=up)
    mesh = trimesh.load(tmp_path / "figure.obj", process=False)
    height = mesh.extents["xyz".index(up)]
    assert height == pytest.approx(np.ptp(example.vertices[:, 2])) and mesh.bounds[0]["xyz".index(up)] == pytest.approx(0, abs=0.05)
    assert mesh.volume == pytest.approx(trimesh.Trimesh(example.vertices, example.triangles, process=False).volume)
