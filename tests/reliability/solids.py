# SPDX-License-Identifier: GPL-3.0-or-later
"""What must hold of every hierarchy, whatever the mesh: found from its arrays with numpy alone."""

import numpy as np
from partwheel import duplicate_faces

CORNERS = [(1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1)]  # of the facet opposite each corner, outward


def boundary(h):
    """(n,3) the outward triangles that bound the tetrahedra."""
    facets = np.vstack([h.tetrahedra[:, corners] for corners in CORNERS])
    _, place, uses = np.unique(np.sort(facets, axis=1), axis=0, return_index=True, return_counts=True)
    assert uses.max() <= 2, "three tetrahedra share a facet"
    return facets[place[uses == 1]]


def enclosed(vertices, triangles):
    """The volume within a closed surface, by the divergence theorem."""
    a, b, c = (vertices[triangles[:, k]] - vertices.mean(axis=0) for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def check(h, vertices, triangles, faces, face_count):
    """Asserts that h is a sound hierarchy of this mesh."""
    leaves, nodes = len(h.tetrahedra), len(h.parent)

    # The solid: closed, and as large as its tetrahedra and its surface say.
    surface = boundary(h)
    edges = np.vstack([surface[:, [0, 1]], surface[:, [1, 2]], surface[:, [2, 0]]])
    keys, opposite_keys = (np.sort(key) for key in (edges @ [len(h.vertices), 1], edges @ [1, len(h.vertices)]))
    assert np.array_equal(keys, opposite_keys), "the surface used is not closed"
    volume = h.summary.volume
    assert volume > 0 and np.isclose(h.volume[:leaves].sum(), volume, rtol=1e-9)
    # Where one vertex is far away the other edges have fewer digits: each term of both sums is rounded by some 1e-16 of
    # the extent's cube.
    slack = 1e-16 * (leaves + len(surface)) * np.ptp(h.vertices, axis=0).max() ** 3
    assert np.isclose(enclosed(h.vertices, surface), volume, rtol=1e-6, atol=slack)
    assert h.summary.hull_volume >= volume * (1 - 1e-9)

    # Every source face in exactly one leaf, and the areas those of the source.
    assert np.array_equal(np.sort(h.order), np.arange(face_count)) and len(h.leaf) == face_count
    assert h.leaf.min() >= 0 and h.leaf.max() < leaves and (np.diff(h.leaf[h.order]) >= 0).all()
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
    # Beside a vertex that is far away all others have fewer digits: each is rounded by some 1e-16 of the extent.
    perimeter = sum(np.linalg.norm(p - q, axis=1).sum() for p, q in ((a, b), (b, c), (c, a)))
    slack = 1e-9 * area.sum() + 1e-15 * np.ptp(vertices[np.unique(triangles)], axis=0).max() * perimeter
    if not np.isclose(h.area[-1], area.sum(), rtol=0, atol=slack):  # faces that are duplicates have no area
        area = np.where(duplicate_faces(vertices, triangles, faces, face_count)[faces] == faces, area, 0)
    assert np.isclose(h.area[-1], area.sum(), rtol=0, atol=slack)
    assert np.allclose(np.bincount(h.leaf, weights=np.bincount(faces, area, face_count), minlength=leaves),
                       h.area[:leaves], atol=slack)

    # The tree.
    assert h.parent[-1] == -1 and (h.parent[:-1] > np.arange(nodes - 1)).all() and h.parent.max() < nodes
    inner = h.parent[:-1]
    assert (h.first[:-1] >= h.first[inner]).all() and (h.last[:-1] <= h.last[inner]).all()
    assert (h.first[-1], h.last[-1]) == (0, face_count)

    # Source vertices are where they were; on the exact fill method there are no others but the mesher's.
    is_source = h.source >= 0
    assert np.array_equal(h.vertices[is_source], vertices[h.source[is_source]]), "a source vertex moved"
    if h.summary.is_exact:
        assert h.summary.deviation == 0 and h.notes == ""
        assert np.array_equal(np.unique(h.source[is_source]), np.unique(triangles))
        assert (~is_source).sum() == h.summary.added_vertices
    else:
        assert 0 <= h.summary.deviation < 1 and h.notes.endswith(".")
