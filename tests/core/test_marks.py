# SPDX-License-Identifier: GPL-3.0-or-later
"""Marked edges as borders of parts."""

import numpy as np
import pytest
import shapes
from conftest import UNLIMITED
from partwheel import FillMethod, Hierarchy, Marks, PartwheelError, Status
from partwheel.worker import Job


def marked_borders(shape, labels):
    """(n, 2) the edges between triangles with different labels, where vertices at the same place count as one."""
    place = np.unique(shape.vertices, axis=0, return_inverse=True)[1].ravel()
    sides, edges = {}, []
    for t, triangle in enumerate(shape.triangles):
        for k in range(3):
            edge = triangle[k], triangle[(k + 1) % 3]
            sides.setdefault(tuple(sorted(place[list(edge)])), []).append((t, edge))
    for at_edge in sides.values():
        if len({labels[t] for t, _ in at_edge}) > 1:
            edges.append(at_edge[0][1])
    return np.array(edges)


def patches(shape, labels):
    """Sets of faces: the connected pieces of equal labels."""
    place = np.unique(shape.vertices, axis=0, return_inverse=True)[1].ravel()
    at_edge = {}
    for t, triangle in enumerate(place[shape.triangles]):
        for k in range(3):
            at_edge.setdefault(frozenset((triangle[k], triangle[(k + 1) % 3])), []).append(t)
    neighbors = {}
    for triangles in at_edge.values():
        for t in triangles:
            neighbors.setdefault(t, set()).update(u for u in triangles if labels[u] == labels[t])
    left, result = set(range(len(labels))), []
    while left:
        patch, todo = set(), [left.pop()]
        while todo:
            t = todo.pop()
            patch.add(t)
            todo.extend(neighbors[t] & left)
            left -= neighbors[t]
        result.append(set(shape.faces[list(patch)].tolist()))
    return result


def bands(shape, count, axis=1):
    """A label for each triangle: which of `count` slices along an axis the first triangle of its face is in."""
    first = np.unique(shape.faces, return_index=True)[1]
    height = shape.vertices[shape.triangles[first[shape.faces]]].mean(axis=1)[:, axis]
    return np.minimum(count * (height - height.min()) / np.ptp(height), count - 1e-9).astype(int)


def wheel_stops(hierarchy):
    """All nodes at which any wheel stops, as sets of faces."""
    nodes = {int(stop) for face in range(len(hierarchy.order)) for stop in hierarchy.wheel(face)[0]}
    return [set(hierarchy.faces(node).tolist()) for node in nodes]


@pytest.mark.parametrize("methods", [0, FillMethod.POINTS, FillMethod.SHEET])
@pytest.mark.parametrize("name", ["torus", "hand", "rotor", "head"])
def test_no_part_crosses_marks_of_strength_one(name, methods):
    shape = shapes.SHAPES[name]() if name in shapes.SHAPES else shapes.off(name)
    labels = bands(shape, 4)
    marks = Marks("seams", marked_borders(shape, labels))
    hierarchy = Hierarchy.build(*shape, fill_methods=methods, marks=[marks])
    nodes = [set(hierarchy.faces(node).tolist()) for node in range(len(hierarchy.parent))]
    stops = wheel_stops(hierarchy)
    for patch in patches(shape, labels):
        assert patch in stops
        assert all(node.isdisjoint(patch) or node <= patch or patch <= node for node in nodes)


def test_only_tetrahedra_behind_several_patches_are_divided():
    shape = shapes.off("hand")
    labels = bands(shape, 4)
    plain = Hierarchy.build(*shape)
    marked = Hierarchy.build(*shape, marks=[Marks("seams", marked_borders(shape, labels))])
    patch_of = {face: number for number, patch in enumerate(patches(shape, labels)) for face in patch}
    shared = [tet for tet in range(len(plain.tetrahedra))
              if len({patch_of[face] for face in plain.faces(tet).tolist()}) > 1]
    whole = {frozenset(plain.tetrahedra[tet].tolist()) for tet in shared}
    left = {frozenset(corners) for corners in marked.tetrahedra.tolist()}
    assert shared and not whole & left
    assert len(marked.tetrahedra) == len(plain.tetrahedra) + 3 * len(shared)
    assert len(marked.vertices) == len(plain.vertices) + len(shared)
    assert marked.volume[:len(marked.tetrahedra)].min() > 0
    assert marked.volume[-1] == pytest.approx(plain.volume[-1], rel=1e-12)


@pytest.mark.parametrize("name", ["hand", "rotor", "head"])
def test_hints_bring_stops_closer_to_their_patches(name):
    shape = shapes.off(name)
    labels = bands(shape, 3)
    edges = marked_borders(shape, labels)

    def mean_overlap(*marks):
        stops = wheel_stops(Hierarchy.build(*shape, marks=marks))
        return np.mean([max(len(patch & stop) / len(patch | stop) for stop in stops) for patch in patches(shape, labels)])

    for strength, gain in (0.9, 0.1), (0.6, 0.05):  # the weaker ones mostly by moving borders there
        assert mean_overlap(Marks("materials", edges, np.full(len(edges), strength))) > mean_overlap() + gain


@pytest.mark.parametrize("marks", [
    Marks("seams", np.zeros((0, 2), int)),
    Marks("seams", [[0, 1], [5, 900]]),  # they enclose nothing
    Marks("weak hints", "borders", "weak"),
    Marks("islands of an atlas", "all"),
    Marks("face sets", "random"),
], ids=lambda marks: marks.name)
def test_marks_that_say_nothing_change_nothing(marks):
    shape = shapes.off("hand")
    borders = {"borders": bands(shape, 3), "all": np.arange(shape.face_count),
               "random": np.random.default_rng(0).integers(0, 12, shape.face_count)}
    if isinstance(marks.edges, str):
        edges = marked_borders(shape, borders[marks.edges])
        marks = Marks(marks.name, edges, np.full(len(edges), 0.49) if marks.strengths else None)
    plain, marked = Hierarchy.build(*shape), Hierarchy.build(*shape, marks=[marks])
    for name in ("order", "parent", "first", "tetrahedra", "score"):
        assert np.array_equal(getattr(plain, name), getattr(marked, name))
    assert f"Marks: the {marks.name} " in marked.notes


def test_of_two_marks_at_an_edge_the_stronger_counts():
    shape = shapes.off("hand")
    edges = marked_borders(shape, bands(shape, 4))
    hard, hints = Marks("seams", edges), Marks("materials", edges, np.full(len(edges), 0.6))
    alone, *both = (Hierarchy.build(*shape, marks=marks) for marks in ([hard], [hard, hints], [hints, hard]))
    for hierarchy in both:
        for name in ("order", "parent", "tetrahedra", "score"):
            assert np.array_equal(getattr(hierarchy, name), getattr(alone, name)), name


def test_a_worker_builds_with_marks():
    shape = shapes.SHAPES["torus"]()
    labels = bands(shape, 3)
    kinds = [Marks("seams", marked_borders(shape, labels)), Marks("materials", marked_borders(shape, bands(shape, 2, 0)))]
    assert Job(*shape, marks=kinds, **UNLIMITED).result().save() == Hierarchy.build(*shape, marks=kinds).save()


def test_wrong_marks_are_refused():
    shape = shapes.cube()

    def build(*marks):
        return Hierarchy.build(*shape, marks=[Marks("seams", *marks)])

    with pytest.raises(PartwheelError) as error:
        build([[0, 8]])
    assert error.value.status == Status.INDEX and "vertex 8" in str(error.value)
    for strength in (-0.1, 1.1, np.nan):
        with pytest.raises(PartwheelError, match="from 0 to 1"):
            build([[0, 1]], [strength])
    for marks in ([[0, 1]], [0.5, 0.5]), ([0, 1, 2],):
        with pytest.raises(ValueError):
            build(*marks)


def paneled_box(size, margins, depth):
    """A box with a sunk pane in each side, this far from the edges, on either of two opposite sides: 4 polygons around it,
    4 inward, the pane; and the faces that are panes."""
    size = np.array(size, float)
    polygons, points = [], {}

    def number(point):
        return points.setdefault(tuple(point), len(points))

    for axis, side in np.ndindex(3, 2):
        u, v = (axis + 1) % 3, (axis + 2) % 3

        def ring(inset, depth):
            """Counterclockwise as seen from outside."""
            corners = []
            for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)):
                point = np.zeros(3)
                point[axis] = size[axis] - depth if side else depth
                point[u], point[v] = (size[k] - inset if at else inset for k, at in ((u, a), (v, b)))
                corners.append(number(point))
            return corners if side else corners[::-1]

        rings = ring(0, 0), ring(margins[side], 0), ring(margins[side], depth)
        for outer, inner in zip(rings, rings[1:]):
            polygons += [(outer[k], outer[(k + 1) % 4], inner[(k + 1) % 4], inner[k]) for k in range(4)]
        polygons.append(rings[2])
    return shapes.polygons(list(points), polygons), set(range(8, len(polygons), 9))


@pytest.mark.parametrize("margins", [(0.35, 0.35), (0.35, 0.49)], ids=["symmetric", "otherwise"])
@pytest.mark.parametrize("depth", [0.05, 0.15])
def test_creases_around_a_piece_of_a_hard_surface_make_it_a_part(depth, margins):
    shape, panes = paneled_box((4, 2, 1.5), margins, depth)
    hierarchy = Hierarchy.build(*shape)
    assert not hierarchy.notes
    for pane in panes:
        stops, start = hierarchy.wheel(pane)
        assert hierarchy.faces(int(stops[start])).tolist() == [pane]
    selected = hierarchy.faces(int(hierarchy.wheel(0)[0][-2]))  # the whole without a few panes
    assert set(range(shape.face_count)) - set(selected.tolist()) <= panes
