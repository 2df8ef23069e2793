# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts that can stand in for each other: motions that are known are found again, also from other triangles; limbs are
offered for limbs."""

import numpy as np
import pytest
from shapes import off
from partwheel import Hierarchy, compatible
from scipy.spatial.transform import Rotation


def similarity(seed):
    rng = np.random.default_rng(seed)
    matrix = np.eye(4)
    matrix[:3, :3] = Rotation.random(random_state=seed).as_matrix() * rng.uniform(0.2, 5)
    matrix[:3, 3] = rng.normal(size=3) * 10
    return matrix


def shapes(hierarchy, matrix=np.eye(4)):
    """{node: PartShape} of all parts that would be offered."""
    size = np.linalg.norm(np.ptp(hierarchy.vertices, axis=0)) / 2 * np.cbrt(abs(np.linalg.det(matrix[:3, :3])))
    shapes = {node: compatible.part_shape(hierarchy, node, hierarchy.vertices, matrix, size)
            for node in compatible.candidate_nodes(hierarchy)}
    return {node: shape for node, shape in shapes.items() if shape and shape.is_usable}


def middle(hierarchy, node):
    """As shares of the model's extent."""
    low, high = hierarchy.vertices.min(axis=0), hierarchy.vertices.max(axis=0)
    tetrahedra = hierarchy.tetrahedra[hierarchy.tet_first[node]:hierarchy.tet_last[node]]
    return (hierarchy.vertices[tetrahedra].mean(axis=(0, 1)) - low) / (high - low)


def limb(hierarchy, place, share):
    """The part offered with about this share of the area whose middle is nearest to a place."""
    of_all = hierarchy.area / hierarchy.area[-1]
    return min((node for node in compatible.candidate_nodes(hierarchy) if 0.7 * share < of_all[node] < 1.4 * share),
               key=lambda node: np.linalg.norm(middle(hierarchy, node) - place))


@pytest.fixture(scope="module")
def homer():
    return Hierarchy.build(*off("homer")[:2])


def test_borders_are_those_of_their_rims():
    """Caps between the same rim, flat and deeply creased: the same size and direction, and middle but for its height."""
    angles = np.arange(12) * np.pi / 6
    rim = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(12)])
    loops = []
    for middle in ((0, 0, 0), (0.5, 0.2, -1)):
        vertices = np.vstack([rim, [middle]])
        loops += compatible.cap_loops(vertices, np.array([(i, (i + 1) % 12, 12) for i in range(12)]), np.eye(4))
    flat, creased = loops
    assert creased.radius == pytest.approx(flat.radius)
    assert creased.normal == pytest.approx(flat.normal)
    assert creased.center[:2] == pytest.approx(flat.center[:2])
    assert -1 < creased.center[2] < 0


def test_a_long_part_with_a_narrow_border_fits_itself():
    """A rod 300 radii long: rounding at its far end is not taken for a distance."""
    angles = np.arange(12) * np.pi / 6
    rings = [np.column_stack([np.cos(angles), np.sin(angles), np.full(12, z)]) for z in np.linspace(0, 300, 61)]
    sides = [(12 * ring + i, 12 * ring + (i + 1) % 12, 12 * (ring + 1) + i, 12 * (ring + 1) + (i + 1) % 12)
             for ring in range(60) for i in range(12)]
    triangles = [triangle for a, b, c, d in sides for triangle in ((a, b, d), (a, d, c))]
    caps = [(0, i + 1, i) for i in range(1, 11)]
    ends = [(720, 720 + i, 721 + i) for i in range(1, 11)]
    is_cap = np.arange(len(triangles) + 20) >= len(triangles) + 10
    rod = compatible.PartShape(np.vstack(rings), np.array(triangles + ends + caps), is_cap, np.eye(4), 150)
    assert compatible.fit(rod, rod).distance < 1e-6


def test_motion_is_found_from_other_triangles():
    """The same part of a mesh that was cut finer and moved: its samples are others."""
    vertices, triangles = off("hand")[:2]
    sides = np.sort(np.vstack([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]))
    sides, at = np.unique(sides, axis=0, return_inverse=True)
    (a, b, c), (ab, bc, ca) = triangles.T, len(vertices) + at.reshape(3, -1)
    fine = np.vstack([np.column_stack(three) for three in ((a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca))])
    finer = np.vstack([vertices, vertices[sides].mean(axis=1)])
    hierarchy, matrix = Hierarchy.build(vertices, triangles), similarity(7)
    size = np.linalg.norm(np.ptp(vertices, axis=0)) / 2
    tried = 0
    for node in compatible.candidate_nodes(hierarchy)[::12]:
        solid = hierarchy.solid(node)
        shape = compatible.part_shape(hierarchy, node, hierarchy.vertices, np.eye(4), size)
        if not shape.is_usable or len(shape.loops) > 1:
            continue
        # Its faces in the finer mesh, and its own caps.
        faces = hierarchy.faces(node)
        plain_faces = (faces + len(triangles) * np.arange(4)[:, None]).ravel()
        source = hierarchy.source[solid.source_vertices]
        caps = source[solid.triangles[solid.neighbor_tets >= 0]]
        if (caps < 0).any():
            continue
        both = np.vstack([fine[plain_faces], caps])
        other = compatible.PartShape(finer, both, np.arange(len(both)) >= len(plain_faces), matrix, size)
        fitted = compatible.fit(shape, other)
        error = compatible.transform_points(shape.points, fitted.matrix @ matrix) - shape.points
        assert np.linalg.norm(error, axis=1).max() < 0.02 * np.sqrt(shape.area)
        tried += 1
    assert tried >= 3


def test_limbs_rank_first_for_limbs(homer):
    """An arm's first sticks out to a side, neither head nor trunk, and so it does in the armadillo (an ear or an arm); the
    other arm is among the first three."""
    arm = limb(homer, (0.14, 0.56, 0.6), 0.08)
    place = shapes(homer)[arm]
    for hierarchy in (homer, Hierarchy.build(*off("armadillo")[:2])):
        parts = [(node, shape) for node, shape in shapes(hierarchy).items()
                 if hierarchy is not homer or compatible.node_overlap(homer, node, arm) == 0]
        ranked = compatible.rank_parts(place, parts, lambda one, other: compatible.node_overlap(hierarchy, one, other)
                                  >= compatible.MIN_OVERLAP)
        assert not 0.42 < middle(hierarchy, ranked[0].key)[0] < 0.58
        if hierarchy is homer:
            matches = [middle(homer, match.key) for match in ranked[:3]]
            assert any(each[0] > 0.7 and 0.4 < each[1] < 0.7 for each in matches)
