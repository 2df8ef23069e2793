# SPDX-License-Identifier: GPL-3.0-or-later
"""Deformation: beside libigl's on real meshes, what it keeps, what it refuses; distances beside a search of our own."""

import heapq
import math

import igl
import numpy as np
import pytest
import shapes
from partwheel import PartwheelError, Status
from partwheel.deform import FIXED, FREE, Deformation, surface_distances
from partwheel.deform import vertex_normals

# Model -> the direction that its limb points in, and the share of the model, along it, that deforms.
LIMBS = {"hand": ((0, 0, 1), 0.3), "elephant": ((0, 1, 0), 0.4), "diplodocus": ((1, 0, 0), 0.3),
         "armadillo": ((0, -1, 0), 0.3)}


def turn(axis, degrees, center=(0, 0, 0)):
    """(4,4) rotation about an axis through center."""
    x, y, z = np.asarray(axis, float) / np.linalg.norm(axis)
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = math.radians(degrees)
    matrix = np.eye(4)
    matrix[:3, :3] = np.eye(3) + math.sin(angle) * k + (1 - math.cos(angle)) * k @ k
    matrix[:3, 3] = center - matrix[:3, :3] @ center
    return matrix


def moved(matrix, points):
    return points @ np.asarray(matrix)[:3, :3].T + np.asarray(matrix)[:3, 3]


def limb(name):
    """(vertices, triangles, roles): the end of a model deforms, its outermost tenth is the handle."""
    vertices, triangles, *_ = shapes.off(name)
    direction, share = LIMBS[name]
    place = vertices @ np.array(direction, float)
    place = (place.max() - place) / np.ptp(place)
    roles = np.where(place > share, FIXED, np.where(place > share / 6, FREE, 0))
    return vertices, triangles, roles


def cylinder(n_around=24, along=60, length=10.0):
    """An open tube along z of radius 1."""
    angle = np.arange(n_around) * 2 * np.pi / n_around
    ring = np.stack([np.cos(angle), np.sin(angle)], -1)
    vertices = np.vstack([np.column_stack([ring, np.full(n_around, z)]) for z in np.linspace(0, length, along + 1)])
    triangles = []
    for j in range(along):
        for i in range(n_around):
            a, b = j * n_around + i, j * n_around + (i + 1) % n_around
            triangles += [(a, b, b + n_around), (a, b + n_around, a + n_around)]
    return vertices, np.array(triangles)


def energy(rest, positions, triangles):
    """The energy of partwheel_edit.h, from its formula alone: rotations by numpy's singular values."""
    corners = rest[triangles]
    total, covariance, edges = 0.0, np.zeros((len(rest), 3, 3)), []
    for k in range(3):
        a, b, c = (corners[:, (k + j) % 3] for j in range(3))
        cot = ((b - a) * (c - a)).sum(axis=1) / np.linalg.norm(np.cross(b - a, c - a), axis=1)
        i, j = triangles[:, (k + 1) % 3], triangles[:, (k + 2) % 3]
        e, e_now = rest[i] - rest[j], positions[i] - positions[j]
        edges.append((cot, e, e_now))
        for corner in range(3):
            np.add.at(covariance, triangles[:, corner], cot[:, None, None] * e_now[:, :, None] * e[:, None, :])
    u, _, vt = np.linalg.svd(covariance)
    u[:, :, 2] *= np.sign(np.linalg.det(u @ vt))[:, None]
    rotation = u @ vt
    for cot, e, e_now in edges:
        for corner in range(3):
            off = e_now - np.einsum("nij,nj->ni", rotation[triangles[:, corner]], e)
            total += (cot * (off * off).sum(axis=1)).sum()
    return total


def lengths(vertices, edges):
    return np.linalg.norm(vertices[edges[:, 0]] - vertices[edges[:, 1]], axis=1)


def edges_of(triangles):
    return np.unique(np.sort(np.vstack([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])), axis=0)


def normals(vertices, triangles):
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    return np.cross(b - a, c - a)


@pytest.mark.parametrize("name", shapes.lighter(LIMBS, 2))
@pytest.mark.parametrize("iterations", [1, 10])
def test_deformations_match_libigl(name, iterations):
    """The same start, the same number of iterations, libigl's implementation of the same energy."""
    vertices, triangles, roles = limb(name)
    matrix = turn((1, 0.3, 0.2), 30, vertices[roles == 0].mean(axis=0))
    matrix[:3, 3] += 0.02 * np.ptp(vertices, axis=0)
    deformation = Deformation(vertices, triangles, roles)
    deformation.move(0, matrix)
    start = deformation.positions()
    np.testing.assert_allclose(start[roles == 0], moved(matrix, vertices[roles == 0]), atol=1e-9 * np.ptp(vertices))
    assert (start[roles == FIXED] == deformation.positions()[roles == FIXED]).all()
    deformation.iterate(iterations)

    fixed = np.flatnonzero(roles != FREE).astype(np.int32)
    data = igl.ARAPData()
    data.energy = igl.ARAP_ENERGY_TYPE_SPOKES_AND_RIMS
    data.max_iter = iterations
    igl.arap_precomputation(vertices, triangles.astype(np.int64), 3, fixed, data)
    expected = igl.arap_solve(start[fixed], data, start)

    actual = deformation.positions()
    reached, theirs_reached = (energy(vertices, points, triangles) for points in (actual, expected))
    assert reached == pytest.approx(deformation.energy(), rel=1e-9)
    assert reached == pytest.approx(theirs_reached, rel=1e-3)
    assert np.abs(actual - expected).max() < 1e-3 * np.ptp(vertices)


@pytest.mark.parametrize("name", shapes.lighter(LIMBS, 2))
def test_energy_never_rises(name):
    vertices, triangles, roles = limb(name)
    deformation = Deformation(vertices, triangles, roles)
    deformation.move(0, turn((0.2, 1, 0.4), 60, vertices[roles == 0].mean(axis=0)))
    energies = [deformation.energy()]
    for _ in range(20):
        deformation.iterate()
        energies.append(deformation.energy())
    assert all(after <= before * (1 + 1e-12) for before, after in zip(energies, energies[1:]))
    assert energies[-1] < 0.9 * energies[0]


@pytest.mark.parametrize("name", shapes.lighter(LIMBS, 2))
def test_no_face_turns_over_at_45_degrees(name):
    """None folds back on its neighbors: the angle between two faces of an edge stays less than 150 degrees wherever
    it was less than 90."""
    vertices, triangles, roles = limb(name)
    deformation = Deformation(vertices, triangles, roles)
    joint = vertices[roles == FREE].mean(axis=0)
    direction = np.array(LIMBS[name][0], float)
    deformation.move_in_steps([turn(np.cross(direction, (0.3, 0.5, 0.8)), 45, joint)])
    before, after = (normals(points, triangles) for points in (vertices, deformation.positions()))
    side = np.sort(np.vstack([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]))
    order = np.lexsort(side.T[::-1])
    same = np.flatnonzero((side[order[1:]] == side[order[:-1]]).all(axis=1))
    one, other = order[same] % len(triangles), order[same + 1] % len(triangles)

    def cosine(n):
        n = n / np.maximum(np.linalg.norm(n, axis=1), 1e-30)[:, None]
        return (n[one] * n[other]).sum(axis=1)

    smooth = cosine(before) > 0
    assert smooth.sum() > 0.9 * len(one)
    folded = cosine(after)[smooth] < math.cos(math.radians(150))
    assert not folded.any(), f"{folded.sum()} of {smooth.sum()}"


def refused(status, *arguments):
    with pytest.raises(PartwheelError) as error:
        Deformation(*arguments)
    assert error.value.status == status
    assert len(str(error.value)) > 20


def test_invalid_deformations_are_refused():
    vertices, triangles = cylinder(n_around=6, along=3)
    roles = np.full(len(vertices), FREE)
    roles[0] = 0
    refused(Status.ARGUMENT, vertices, triangles, np.zeros(len(vertices), int))  # the handle is all there is
    refused(Status.ARGUMENT, vertices, triangles, np.full(len(vertices), FREE))  # nothing holds or moves
    refused(Status.ARGUMENT, vertices, triangles, np.full(len(vertices), -3))
    refused(Status.ARGUMENT, vertices, triangles, np.where(roles == 0, 1, roles))  # no handle 0
    refused(Status.INDEX, vertices, [[0, 1, len(vertices)]], roles)
    refused(Status.INDEX, vertices, [[0, 1, -1]], roles)
    refused(Status.EMPTY, vertices, np.empty((0, 3), int), roles)
    bad = vertices.copy()
    bad[3, 1] = math.nan
    refused(Status.NOT_FINITE, bad, triangles, roles)
    with pytest.raises(ValueError):
        Deformation(vertices, triangles, roles[1:])
    deformation = Deformation(vertices, triangles, roles)
    for handle, matrix, status in ((1, np.eye(4), Status.ARGUMENT), (-1, np.eye(4), Status.ARGUMENT),
                                   (0, np.full((4, 4), math.inf), Status.NOT_FINITE)):
        with pytest.raises(PartwheelError) as error:
            deformation.move(handle, matrix)
        assert error.value.status == status
    np.testing.assert_array_equal(deformation.positions(), vertices)


def test_a_triangle_that_names_a_vertex_twice_pulls_nothing():
    """Only its one edge counts: no iteration raises the energy, and what is at rest stays there."""
    vertices = np.array([(-36, 119, -36), (49, 0, -120), (-120, 0, -120), (-120, 0, 49), (49, 0, 49), (-36, -120, -36)])
    triangles = np.array([(0, 4, 1), (1, 5, 2), (2, 3, 0), (3, 5, 4), (1, 1, 0), (3, 4, 0), (4, 5, 1), (3, 2, 5)])
    roles = np.array([0, FREE, FREE, FREE, FREE, FIXED])
    deformation = Deformation(vertices, triangles, roles)
    deformation.iterate(3)
    np.testing.assert_allclose(deformation.positions(), vertices, atol=1e-9)
    deformation.move(0, turn((1, 0, 0), 10))
    before = deformation.energy()
    for _ in range(5):
        deformation.iterate(1)
        assert (after := deformation.energy()) <= before
        before = after


@pytest.mark.parametrize("power", [330, 266, 60, -60, -282, -900])  # 2^266 is 1e80, 2^-282 1e-85
def test_vertex_normals_of_any_unit(power):
    """Bit for bit those at scale 1, wherever the squares of the lengths are numbers or not."""
    vertices, triangles = shapes.off("hand")[:2]
    vertices = vertices.astype(np.float32).astype(float)  # so that none of the scales rounds them
    expected = vertex_normals(vertices, triangles)
    np.testing.assert_allclose(np.linalg.norm(expected, axis=1), 1)
    np.testing.assert_array_equal(vertex_normals(np.ldexp(vertices, power), triangles), expected)


def test_distances_on_a_real_mesh():
    """Between the straight line and the shortest way over edges."""
    vertices, triangles, *_ = shapes.off("elephant")
    distance = surface_distances(vertices, triangles, [5, 900])
    neighbors = [[] for _ in vertices]
    for a, b in edges_of(triangles):
        length = float(np.linalg.norm(vertices[a] - vertices[b]))
        neighbors[a].append((length, b))
        neighbors[b].append((length, a))
    reached, front = np.full(len(vertices), math.inf), [(0.0, 5), (0.0, 900)]
    while front:
        length, v = heapq.heappop(front)
        if length < reached[v]:
            reached[v] = length
            for step, to in neighbors[v]:
                heapq.heappush(front, (length + step, to))
    straight = np.linalg.norm(vertices[:, None] - vertices[[5, 900]], axis=2).min(axis=1)
    assert (distance <= reached + 1e-12).all() and (distance >= straight - 1e-12).all()
    assert distance.mean() < 0.99 * reached.mean()
