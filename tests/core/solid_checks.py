# SPDX-License-Identifier: GPL-3.0-or-later
"""What must hold of every solid, checked with numpy and trimesh alone."""

import numpy as np
import trimesh

TOLERANCE = 1e-9


def volume(vertices, triangles):
    """Enclosed volume, about the middle so that a model far from the origin loses no digits."""
    corners = (vertices - vertices.mean(axis=0))[triangles]
    return np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6


def tetrahedra_volume(hierarchy, tets=slice(None)):
    """Sum over tetrahedra, counted anew from their corners."""
    corners = hierarchy.vertices[hierarchy.tetrahedra[tets]]
    sides = corners[:, 1:] - corners[:, :1]
    return np.einsum("ij,ij->i", np.cross(sides[:, 0], sides[:, 1]), sides[:, 2]).sum() / 6


def check_solid(solid):
    """Closed, manifold and consistently wound, with a mesh in which every vertex is used."""
    vertices, triangles = solid.vertices, solid.triangles
    assert np.array_equal(np.unique(triangles), np.arange(len(vertices)))
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    _, counts = np.unique(edges, axis=0, return_counts=True)
    assert counts.max() == 1, "an edge is run along twice in the same direction"
    mesh = trimesh.Trimesh(vertices, triangles, process=False, validate=False)
    assert mesh.is_watertight and mesh.is_winding_consistent
    # One umbrella a vertex: its triangles' opposite edges are a single ring.
    fans = trimesh.graph.connected_components(_corner_links(triangles), nodes=np.arange(3 * len(triangles)))
    assert len(fans) == len(vertices)
    ends = solid.ends
    assert ends.shape == (len(vertices), 2) and solid.faces.shape == solid.beyond.shape == (len(triangles),)
    assert not (solid.faces[solid.beyond >= 0] >= 0).any()


def _corner_links(triangles):
    """Pairs of corners (3 * triangle + corner) at the same vertex whose triangles share an edge."""
    index = np.arange(3 * len(triangles)).reshape(-1, 3)
    start, end = triangles, np.roll(triangles, -1, axis=1)
    edge = {(a, b): (i, j) for a, b, i, j in zip(start.ravel().tolist(), end.ravel().tolist(), index.ravel().tolist(),
                                                 np.roll(index, -1, axis=1).ravel().tolist())}
    links = []
    for (a, b), (i, j) in edge.items():
        at_b, at_a = edge[b, a]
        links.append((i, at_a))
        links.append((j, at_b))
    return np.array(links)
