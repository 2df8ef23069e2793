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


def test_borders_of_a_prism():
    """Five sides, bottom and top: two borders that do not touch, with the area, middle and normal of a pentagon."""
    angles = np.arange(5) * 2 * np.pi / 5
    ring = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(5)])
    vertices = np.vstack([ring, 0.5 * ring + [0, 0, 3]])
    top = [(5, 6, 7), (5, 7, 8), (5, 8, 9)]
    bottom = [(2, 1, 0), (3, 2, 0), (4, 3, 0)]
    matrix = similarity(1)
    scale = np.cbrt(np.linalg.det(matrix[:3, :3]))
    for reflect in (1, -1):
        flip = np.diag([reflect, 1.0, 1, 1])
        loops = compatible.cap_loops(vertices, np.array(top + bottom), matrix @ flip)
        assert len(loops) == 2
        area = 5 / 2 * np.sin(2 * np.pi / 5)
        for border, size, z, height in zip(loops, (1, 0.5), (-1, 1), (0, 3)):
            assert border.radius == pytest.approx(scale * size * np.sqrt(area / np.pi))
            assert border.center == pytest.approx(matrix[:3, :3] @ [0, 0, height] + matrix[:3, 3])
            assert border.normal == pytest.approx(matrix[:3, :3] @ [0, 0, z] / scale)


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


def test_a_part_is_its_own_first_under_any_motion():
    hierarchy, matrix = Hierarchy.build(*off("hand")[:2]), similarity(0)
    own_shapes, moved = shapes(hierarchy), shapes(hierarchy, matrix)
    for node in list(own_shapes)[::len(own_shapes) // 3]:
        best = compatible.rank_parts(own_shapes[node], list(moved.items()))[0]
        assert best.key == node and best.score > 0.99
        assert best.matrix @ matrix == pytest.approx(np.eye(4), abs=1e-6)


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
        if not shape.is_usable or len(shape.loops) > 1 or (solid.source_edges[:, 0] != solid.source_edges[:, 1]).any():
            continue
        # Its faces in the finer mesh, and its own caps.
        faces = hierarchy.faces(node)
        plain_faces = (faces + len(triangles) * np.arange(4)[:, None]).ravel()
        source = hierarchy.source[solid.source_edges[:, 0]]
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


def test_mirror_images_fit_mirrored(homer):
    matrix = similarity(3) @ np.diag([-1.0, 1, 1, 1])
    node = limb(homer, (0.14, 0.56, 0.6), 0.08)
    place, other = shapes(homer)[node], shapes(homer, matrix)[node]
    fitted = compatible.fit(place, other, mirror=True)
    assert fitted.matrix @ matrix == pytest.approx(np.eye(4), abs=1e-6)
    assert compatible.fit(place, other).distance > 10 * fitted.distance


def test_gap_between_bent_borders():
    """A part with a flat end on one whose end is hollow, as a spherical cap of the depth 0.3."""
    n_around, rows = 24, 6

    def disk(depth, length):
        """A cylinder's side and its end, at z = 0, towards +z: (vertices, triangles, caps)"""
        radii = np.linspace(1, 0, rows, endpoint=False)
        angles = np.arange(n_around) * 2 * np.pi / n_around
        rings = [np.column_stack([r * np.cos(angles), r * np.sin(angles), np.full(n_around, depth * (1 - r * r))])
                 for r in radii]
        far = rings[0] - [0, 0, length]
        vertices = np.vstack([*rings, [[0, 0, depth]], far, [[0, 0, -length]]])
        i, j = np.arange(n_around), np.roll(np.arange(n_around), -1)
        caps = [np.column_stack(triangle) for row in range(rows - 1) for base in [row * n_around]
                for triangle in ((base + i, base + j, base + n_around + j),
                             (base + i, base + n_around + j, base + n_around + i))]
        last = (rows - 1) * n_around
        caps.append(np.column_stack([last + i, last + j, np.full(n_around, rows * n_around)]))
        low = rows * n_around + 1
        side = [np.column_stack([low + i, low + j, j]), np.column_stack([low + i, j, i]),
                np.column_stack([low + j, low + i, np.full(n_around, low + n_around)])]
        triangles = np.vstack(caps + side)
        return vertices, triangles, np.arange(len(triangles)) < sum(map(len, caps))

    flat, bulging = (compatible.PartShape(*disk(depth, 4), np.eye(4), 4) for depth in (0.0, 0.3))
    assert compatible.gap(flat, flat, np.eye(4)) == pytest.approx(0, abs=1e-9)
    assert compatible.gap(flat, bulging, np.eye(4)) == pytest.approx(0, abs=0.02)  # it goes in by itself
    # But for the 5 % of the area that lie deepest.
    assert compatible.gap(bulging, flat, np.eye(4)) == pytest.approx(0.95 * 0.3 / bulging.main.radius, abs=0.02)


def test_limbs_are_offered_for_limbs(homer):
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
