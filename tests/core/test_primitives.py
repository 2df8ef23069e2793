# SPDX-License-Identifier: GPL-3.0-or-later
"""Primitives in place of hulls: found where there is one, around all of the hull, as near as they say (distances by libigl),
and in files as their readers understand them, by how far they reach in many directions."""


import numpy as np
import pytest
import shapes
from partwheel import Hierarchy, convex, meshes
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

EXACT = [("box", (1, 2, 3)), ("box", (1, 1, 1)), ("box", (0.05, 2, 3)), ("sphere", (2, 2, 2)), ("capsule", (1, 1, 3)),
         ("capsule", (1, 1, 1.5)), ("cylinder", (1, 1, 3)), ("cylinder", (2, 2, 0.3))]


def turned(number):
    """Something in general position: (center, axes)."""
    return np.array([3.0, -5, 8]) + number, Rotation.from_euler("xyz", [0.3 + number, 1.1, -0.7]).as_matrix()


def rounded(kind, half, count=24):
    """Points all over a shape, in its own space: corners of a box, or circles that are much finer than those of meshes."""
    radius, straight = half[0], half[2] - half[0]
    if kind == "box":
        return np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * half
    turns = np.arange(count) / count * 2 * np.pi
    circle = np.column_stack([np.cos(turns), np.sin(turns)])
    if kind == "cylinder":
        rings = [(radius, -half[2]), (radius, half[2])]
    else:
        up = np.linspace(0, np.pi / 2, count // 4 + 1)
        rings = [(radius * np.cos(turn), sign * (radius * np.sin(turn) + straight)) for turn in up for sign in (-1, 1)]
    return np.vstack([np.column_stack([ring * circle, np.full(count, z)]) for ring, z in rings])


def hull_of(points):
    hull = ConvexHull(points)
    number = np.zeros(len(points), int)
    number[hull.vertices] = np.arange(len(hull.vertices))
    vertices, triangles = points[hull.vertices], number[hull.simplices]
    a, b, c = vertices[triangles].transpose(1, 0, 2)
    inward = (np.cross(b - a, c - a) * hull.equations[:, :3]).sum(axis=1) < 0
    triangles[inward] = triangles[inward][:, ::-1]
    return vertices, triangles


def outside(primitive, points):
    """(n,) how far points are outside of a primitive, at most 0 for those in it."""
    x = np.abs((points - primitive.center) @ primitive.axes)
    if primitive.kind == "box":
        return (x - primitive.half_extents).max(axis=1)
    across, radius, half = np.linalg.norm(x[:, :2], axis=1), primitive.half_extents[0], primitive.half_extents[2]
    if primitive.kind == "cylinder":
        return np.maximum(across - radius, x[:, 2] - half)
    return np.hypot(across, np.maximum(x[:, 2] - (half - radius), 0)) - radius


def reach(primitive, vertices, triangles):
    """How far it goes away from a hull, by points on it."""
    igl = pytest.importorskip("igl")
    points = rounded(primitive.kind, primitive.half_extents, 128) @ primitive.axes.T + primitive.center
    squared = igl.point_mesh_squared_distance(points, vertices, triangles.astype(np.int64))[0]
    planes = ConvexHull(vertices).equations
    is_outside = (points @ planes[:, :3].T + planes[:, 3]).max(axis=1) > 0
    return np.sqrt(squared[is_outside].max(initial=0))


@pytest.mark.parametrize("number", range(len(EXACT)))
def test_primitives_are_recognized_at_their_place(number):
    kind, half = EXACT[number]
    center, axes = turned(number)
    hull = hull_of(rounded(kind, np.array(half, float)) @ axes.T + center)
    primitive = convex.fit_primitive(*hull, 0.02 * max(half))
    assert primitive.kind == kind
    np.testing.assert_allclose(primitive.center, center, atol=2e-3 * max(half))
    np.testing.assert_allclose(np.sort(primitive.half_extents), np.sort(half), atol=3e-3 * max(half))
    assert outside(primitive, hull[0]).max() < 1e-9
    assert reach(primitive, *hull) <= 0.02 * max(half)
    np.testing.assert_allclose(primitive.axes.T @ primitive.axes, np.eye(3), atol=1e-12)
    assert np.linalg.det(primitive.axes) == pytest.approx(1)
    if kind in {"capsule", "cylinder"}:
        assert abs(primitive.axes[:, 2] @ axes[:, 2]) > 1 - 1e-5
    other = convex.fit_primitive(*hull, 0.02 * max(half), [candidate for candidate in ("sphere", "box", "cylinder") if candidate != kind])
    assert other is None


@pytest.mark.parametrize("number", range(len(EXACT)))
def test_meshes_are_closed_and_as_large(number):
    kind, half = EXACT[number]
    primitive = convex.Primitive(kind, *turned(number), np.array(half, float))
    vertices, triangles = primitive.mesh()
    directed = {tuple(pair) for k in range(3) for pair in triangles[:, [k, (k + 1) % 3]]}
    assert len(directed) == 3 * len(triangles) and directed == {(b, a) for a, b in directed}
    np.testing.assert_allclose(vertices.max(axis=0), half)
    np.testing.assert_allclose(vertices.min(axis=0), -np.array(half))
    inside = np.linalg.det(vertices[triangles]).sum() / 6
    assert inside == pytest.approx(ConvexHull(vertices).volume)
    assert 0.93 * primitive.volume() < inside <= primitive.volume() * (1 + 1e-9)
    assert primitive.volume() == pytest.approx(ConvexHull(rounded(kind, np.array(half), 120)).volume, rel=3e-3)


@pytest.mark.parametrize("name", ["homer", "elephant"])
def test_parts_of_models(name):
    mesh = meshes.read(shapes.MESHES / f"{name}.off")
    hierarchy = Hierarchy.build(mesh.vertices, mesh.triangles, mesh.faces, mesh.face_count)
    max_excess = 0.04 * np.linalg.norm(np.ptp(hierarchy.vertices, axis=0))
    parts = hierarchy.convex_parts(8, max_vertices=64)
    primitives = [convex.fit_primitive(*part[:2], max_excess) for part in parts]
    assert any(primitives)
    for primitive, part in zip(primitives, parts):
        if primitive:
            assert outside(primitive, part.vertices).max() < 1e-9 * max_excess
            assert reach(primitive, part.vertices, part.triangles) <= max_excess
    assert [convex.fit_primitive(*part[:2], 0) for part in parts] == [None] * len(parts)
