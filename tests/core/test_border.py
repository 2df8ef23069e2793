# SPDX-License-Identifier: GPL-3.0-or-later
"""Borders in creases: parts of real meshes, costs by numpy, time."""

import itertools
import os

import numpy as np
import pytest
import shapes
from partwheel import Hierarchy, PartwheelError, Status, snap_border
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

MODELS = shapes.lighter(["hand", "elephant", "dragknob", "bear", "man"], 3)


def edges_with_costs(shape):
    """(E,2) the faces at each edge between two, and (E,) length times weight, as partwheel_edit.h documents them."""
    vertices, triangles, faces, count = shape
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    normals = np.zeros((count, 3))
    np.add.at(normals, faces, np.cross(b - a, c - a))
    normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-300)[:, None]
    side = {}
    for (corners, face), k in itertools.product(zip(triangles.tolist(), faces.tolist()), range(3)):
        side[corners[k], corners[(k + 1) % 3]] = face
    edges = np.array([(i, j, face, side[j, i]) for (i, j), face in side.items() if face < side.get((j, i), -1)])
    along = vertices[edges[:, 1]] - vertices[edges[:, 0]]
    n, m = normals[edges[:, 2]], normals[edges[:, 3]]
    turn = np.einsum("ij,ij->i", np.cross(n, m), along)
    weight = (1 - np.linalg.norm(n - m, axis=1) / 2) ** np.where(turn > 0, 1, 10)
    return edges[:, 2:], np.linalg.norm(along, axis=1) * np.where(turn == 0, 1, weight)


def pieces(edges, part):
    """Connected pieces of the faces where part is True."""
    inner_edges = edges[part[edges].all(axis=1)]
    graph = coo_matrix((np.ones(len(inner_edges)), (inner_edges[:, 0], inner_edges[:, 1])), (len(part), len(part)))
    return len(np.unique(connected_components(graph, directed=False)[1][part]))


@pytest.mark.parametrize("name", MODELS)
def test_parts_of_a_real_mesh(name):
    """The stops of clicks here and there: their borders never cost more than before, all in all much less, and
    nothing falls apart."""
    shape = shapes.off(name)
    hierarchy = Hierarchy.build(*shape)
    edges, costs = edges_with_costs(shape)
    before = after = 0
    for face in range(0, shape.face_count, shape.face_count // 5):
        for stop in hierarchy.wheel(face)[0][:-1]:
            part = np.zeros(shape.face_count, bool)
            part[hierarchy.faces(stop)] = True
            if part.all():
                continue
            snapped = snap_border(*shape, part)
            assert snapped.any() and not snapped.all()
            cost, snapped_cost = (costs[mask[edges[:, 0]] != mask[edges[:, 1]]].sum() for mask in (part, snapped))
            assert snapped_cost <= cost * (1 + 1e-5)
            before, after = before + cost, after + snapped_cost
            assert pieces(edges, snapped) <= pieces(edges, part)
            assert pieces(edges, ~snapped) <= pieces(edges, ~part)
    print(f"{name}: {after / before:.3f} of the cost")
    assert after < 0.97 * before


if "libasan" not in os.environ.get("LD_PRELOAD", ""):  # memory is kept there
    def test_100000_faces():
        """What that takes is measured by scripts/bench_latency."""
        vertices, triangles, *_ = shapes.off("bear")
        while len(triangles) < 80000:
            vertices, triangles = halved(vertices, triangles)
        middle = np.median(vertices, axis=0)
        height = vertices[triangles].mean(axis=1) - middle
        for axis, offset in itertools.product(range(3), (-0.1, 0, 0.2)):
            part = height[:, axis] > offset * np.ptp(vertices[:, axis])
            snapped = snap_border(vertices, triangles, None, None, part)
            assert (snapped != part).any()


def halved(vertices, triangles):
    """Each triangle in four."""
    sides = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    unique, middle = np.unique(sides, axis=0, return_inverse=True)
    ab, bc, ca = (middle.reshape(-1, 3) + len(vertices)).T
    a, b, c = triangles.T
    triangles = np.vstack([np.stack(corners, axis=1) for corners in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
    return np.vstack([vertices, vertices[unique].mean(axis=1)]), triangles.astype(np.int32)


def test_refusals():
    shape = shapes.cube()
    with pytest.raises(PartwheelError) as refusal:
        snap_border(*shape, np.zeros(shape.face_count, bool))
    assert refusal.value.status == Status.EMPTY
    with pytest.raises(ValueError, match="shape"):
        snap_border(*shape, np.ones(shape.face_count + 1, bool))
    with pytest.raises(TypeError, match="bool"):
        snap_border(*shape, np.arange(shape.face_count))
    part = np.arange(shape.face_count) < 1
    assert (snap_border(*shape, part) == part).all()
    assert part.sum() == 1
