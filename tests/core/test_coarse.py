# SPDX-License-Identifier: GPL-3.0-or-later
"""Large meshes: parts found on a coarser copy. exact_triangles makes small ones large here."""

import numpy as np
import pytest
import shapes
from partwheel import Hierarchy

LARGE = 2000  # of more triangles: copies have some 500


def two_balls(rings=60, segments=80):
    """Two spheres grown together at z = 0, finely: 16,000 triangles."""
    turn = np.linspace(0, np.pi, rings + 1)
    z = np.concatenate([-0.9 - np.cos(turn[:-10]), 0.9 - np.cos(turn[10:])])
    radius = np.concatenate([np.sin(turn[:-10]), np.sin(turn[10:])])
    z, radius = z[radius > 1e-6], radius[radius > 1e-6]
    angles = np.linspace(0, 2 * np.pi, segments, endpoint=False)
    vertices = np.vstack([np.column_stack([r * np.cos(angles + 0.01 * i), r * np.sin(angles + 0.01 * i),
                                           np.full(segments, h)]) for i, (r, h) in enumerate(zip(radius, z))])
    vertices = np.vstack([vertices, [0, 0, z[0] - 0.01], [0, 0, z[-1] + 0.01]])
    k, n, last = np.arange(segments), (np.arange(segments) + 1) % segments, len(vertices) - 1
    triangles = [np.column_stack([n, k, np.full(segments, last - 1)]),
                 np.column_stack([k, n, np.full(segments, last)]) + [[last - 1 - segments] * 2 + [0]]]
    for ring in range(0, last - 1 - segments, segments):
        triangles += [np.column_stack([k, n, n + segments]) + ring, np.column_stack([k, n + segments, k + segments]) + ring]
    return shapes.Shape(vertices, np.vstack(triangles).astype(np.int32), None, sum(map(len, triangles)))


def off(name):
    return shapes.Shape(*shapes.off(name)[:2], None, len(shapes.off(name)[1]))


@pytest.fixture(scope="module")
def elephant():
    return off("elephant")


def coarse(shape, **options):
    return Hierarchy.build(shape.vertices, shape.triangles, exact_triangles=LARGE, **options)


def overlap(areas, a, b):
    return areas[a & b].sum() / areas[a | b].sum()


def areas_of(shape):
    a, b, c = (shape.vertices[shape.triangles[:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def test_every_source_face_has_a_leaf_in_the_proxy(elephant):
    built = coarse(elephant)
    assert built.summary.proxy_triangles and len(built.tetrahedra) < LARGE
    assert f"500 of {len(elephant.triangles):,} triangles" in built.notes
    assert np.array_equal(np.sort(built.order), np.arange(len(elephant.triangles)))
    assert built.area[-1] == pytest.approx(areas_of(elephant).sum())
    inner = np.arange(len(built.tetrahedra), len(built.parent) - 1)
    parents = built.parent[inner]
    assert (built.first[parents] <= built.first[inner]).all() and (built.last[inner] <= built.last[parents]).all()
    known = built.source >= 0
    assert known.all() and np.array_equal(built.vertices, elephant.vertices[built.source])
    assert Hierarchy.load(built.save()).save() == built.save()


def test_parts_are_those_of_the_shape():
    shape = two_balls()
    built, areas = coarse(shape), areas_of(shape)
    lower = shape.vertices[shape.triangles].mean(axis=1)[:, 2] < 0
    for face in (5, len(shape.triangles) // 4):
        ball = lower if lower[face] else ~lower
        stops, _ = built.wheel(face)
        is_inside = [np.isin(np.arange(len(areas)), built.faces(stop)) for stop in stops]
        assert max(overlap(areas, ball, part) for part in is_inside) > 0.9


def test_coincident_seams_of_the_proxy_are_closed(elephant):
    """Each triangle with vertices of its own: what the copy is of is the closed surface all the same."""
    soup = elephant.vertices[elephant.triangles].reshape(-1, 3)
    built = Hierarchy.build(soup, np.arange(len(soup), dtype=np.int32).reshape(-1, 3), exact_triangles=LARGE)
    closed = coarse(elephant)
    assert built.summary[:4] == closed.summary[:4] and np.array_equal(built.leaf, closed.leaf)
    # Hulls may be united in another order, which rounds their volume differently.
    assert built.summary.hull_volume == pytest.approx(closed.summary.hull_volume, rel=1e-12)


@pytest.mark.parametrize("gap", shapes.lighter([1e-5, 1e-4], 1))
def test_triangle_soups_are_decimated(elephant, gap):
    """Triangles moved apart have nothing in common: their vertices are united by cells."""
    size = np.ptp(elephant.vertices)
    offsets = np.random.default_rng(1).normal(size=(len(elephant.triangles), 1, 3)) * gap * size
    soup = (elephant.vertices[elephant.triangles] + offsets).reshape(-1, 3)
    built = Hierarchy.build(soup, np.arange(len(soup), dtype=np.int32).reshape(-1, 3), exact_triangles=5000)
    assert built.summary.proxy_triangles and built.summary.deviation < 0.1
    assert np.array_equal(np.sort(built.order), np.arange(len(elephant.triangles)))
    assert built.summary.volume == pytest.approx(coarse(elephant).summary.volume, rel=0.3)
