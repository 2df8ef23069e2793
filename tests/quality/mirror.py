# SPDX-License-Identifier: GPL-3.0-or-later
"""How alike the two sides of a model are that is its own mirror image: of clicks and of nodes, the share that overlap
their mirror image by 0.9."""

import numpy as np
from scipy.spatial import cKDTree

NEAR = 0.01  # of the diagonal: what lies within this of its mirror image has one
SYMMETRIC = 0.95  # of the area has one
ALIKE = 0.9  # overlap (intersection over union, by area) with a mirror image
CLICKS = 200
SIZES = (0.01, 0.8)  # of the nodes that are looked at, in shares of the area


def triangle_areas(mesh):
    a, b, c = mesh.vertices[mesh.triangles].transpose(1, 0, 2)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def mirror_faces(mesh):
    """(F,) the face at the mirror image of each face's middle, in the plane for which the images are nearest to the surface
    on average; None if no plane has images for enough of the area."""
    areas, middles = triangle_areas(mesh), mesh.vertices[mesh.triangles].mean(axis=1)
    center = np.average(middles, axis=0, weights=areas)
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    principal = np.linalg.eigh(((middles - center) * areas[:, None]).T @ (middles - center))[1].T
    tree, least, image = cKDTree(middles), np.inf, None
    for normal in (*principal, *np.eye(3)):
        for point in (center, (low + high) / 2):
            distance, nearest = tree.query(middles - 2 * np.outer((middles - point) @ normal, normal))
            share = areas[distance < NEAR * np.linalg.norm(high - low)].sum() / areas.sum()
            mean_distance = np.average(distance, weights=areas)
            if share >= SYMMETRIC and mean_distance < least:
                least, image = mean_distance, nearest
    if image is None:
        return None
    of_face = np.empty(mesh.face_count, int)
    of_face[mesh.faces] = mesh.faces[image]
    return of_face


def images(hierarchy, mesh, image):
    """(clicks, nodes): the share of clicks (faces by area, seeded) whose part overlaps the mirror image of the mirrored
    click's part by ALIKE; and of the wheels' nodes that overlap the mirror image of any node so."""
    area = np.bincount(mesh.faces, triangle_areas(mesh), mesh.face_count)
    area /= area.sum()
    order, first, last = hierarchy.order, hierarchy.first, hierarchy.last
    sums = np.concatenate([[0], np.cumsum(area[order])])

    def reflected(node):
        inside = np.zeros(mesh.face_count, bool)
        inside[hierarchy.faces(node)] = True
        return inside[image]

    def overlaps(inside, nodes):
        expected = np.concatenate([[0], np.cumsum((area * inside)[order])])
        hit = expected[last[nodes]] - expected[first[nodes]]
        return hit / (sums[last[nodes]] - sums[first[nodes]] + expected[-1] - hit)

    clicks, met = [], set()
    for face in np.random.default_rng(0).choice(mesh.face_count, CLICKS, p=area):
        (stops, at), (other_stops, other_start) = hierarchy.wheel(int(face)), hierarchy.wheel(int(image[face]))
        clicks.append(overlaps(reflected(int(stops[at])), other_stops[other_start]) >= ALIKE)
        met.update(map(int, stops))
    share = sums[last] - sums[first]
    every = np.arange(len(first))
    nodes = [overlaps(reflected(node), every).max() >= ALIKE for node in sorted(met)
             if SIZES[0] <= share[node] <= SIZES[1]]
    return np.mean(clicks), np.mean(nodes)
