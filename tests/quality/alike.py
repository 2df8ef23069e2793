# SPDX-License-Identifier: GPL-3.0-or-later
"""Which of the segments that people made of a model are alike: a rigid alignment of their surfaces, by scipy. Nothing
here is Partwheel's. The truth that similar.py measures against."""

import numpy as np
from scipy.spatial import cKDTree

POINTS = 400
# Mean distance after alignment, in roots of the area, up to which two segments are alike (the same twice: 0.027, by the
# points' own distances), and from which on they are not.
NEAR, FAR = 0.05, 0.08
LEAST = 0.002  # of the whole's area: smaller segments are left out
STEPS, TURNS, TRIES = 30, 8, 6


def spread(corners, count, seed=0):
    """(count,3) points on triangles (T,3,3), at random by area."""
    random = np.random.default_rng(seed)
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) + 1e-30
    sampled = corners[random.choice(len(corners), count, p=areas / areas.sum())]
    u, v = random.random((2, count))
    u, v = np.where(u + v > 1, 1 - u, u)[:, None], np.where(u + v > 1, 1 - v, v)[:, None]
    return sampled[:, 0] + u * (sampled[:, 1] - sampled[:, 0]) + v * (sampled[:, 2] - sampled[:, 0])


class Surface:
    def __init__(self, corners):
        self.area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum() / 2
        points = spread(corners, POINTS)
        self.points = points - points.mean(axis=0)
        self.tree = cKDTree(self.points)
        self.axes = np.linalg.eigh(self.points.T @ self.points)[1].T[::-1]


def apart(one, other):
    """The mean distance of two Surfaces once one is brought to the other by a rotation, or a rotation and a reflection,
    relative to the root of their area."""
    distances = []
    for signs in np.ndindex(2, 2, 2):
        for turn in np.arange(TURNS) * np.pi / TURNS:
            about = np.array([[1, 0, 0], [0, np.cos(turn), -np.sin(turn)], [0, np.sin(turn), np.cos(turn)]])
            distances.append((other.axes.T * (1 - 2 * np.array(signs))) @ about @ one.axes)
    distances.sort(key=lambda matrix: other.tree.query(one.points[::4] @ matrix.T)[0].mean())
    best = np.inf
    for matrix in distances[:TRIES]:
        move, side = np.zeros(3), np.linalg.det(matrix)
        for _ in range(STEPS):
            nearest = other.points[other.tree.query(one.points @ matrix.T + move)[1]]
            a, b = one.points - one.points.mean(axis=0), nearest - nearest.mean(axis=0)
            left, _, right = np.linalg.svd(b.T @ a)
            matrix = left @ np.diag([1, 1, np.sign(np.linalg.det(left @ right)) * side]) @ right
            move = nearest.mean(axis=0) - matrix @ one.points.mean(axis=0)
        moved = one.points @ matrix.T + move
        both = other.tree.query(moved)[0].mean() + cKDTree(moved).query(other.points)[0].mean()
        best = min(best, both / 2)
    return best / np.sqrt((one.area + other.area) / 2)


def distances(mesh, labels):
    """(the labels of a person's segments, (n,n) how far apart two of them are once aligned, inf where the areas alone
    say that they differ). mesh: of triangles only; labels (F,)."""
    corners = mesh.vertices[mesh.triangles]
    of = labels[mesh.faces]
    surfaces = {label: Surface(corners[of == label]) for label in np.unique(labels).tolist()}
    whole = sum(surface.area for surface in surfaces.values())
    kept_labels = [label for label, each in surfaces.items() if each.area > LEAST * whole]
    distances = np.full((len(kept_labels), len(kept_labels)), np.inf)
    for i, one in enumerate(kept_labels):
        for j, other in enumerate(kept_labels[:i]):
            if 0.6 < surfaces[one].area / surfaces[other].area < 1 / 0.6:
                distances[i, j] = distances[j, i] = apart(surfaces[one], surfaces[other])
    return np.array(kept_labels), distances
