# SPDX-License-Identifier: GPL-3.0-or-later
"""How near hulls are to a model, measured by scipy and libigl: nothing of ours has a part in it."""

import igl
import numpy as np
from scipy.spatial import ConvexHull

SAMPLES = 20_000  # of a surface, evenly by area
INSIDE = 0.5  # of the winding number


def volume(vertices, triangles):
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->i", np.cross(a, b), c).sum() / 6)


def sampled(vertices, triangles):
    """Points of a surface; the same on each run."""
    draw = np.random.default_rng(0)
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    sampled = draw.choice(len(triangles), SAMPLES, p=area / area.sum())
    u, v = draw.uniform(size=(2, SAMPLES, 1))
    u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
    return a[sampled] + u * (b - a)[sampled] + v * (c - a)[sampled]


def away(points, vertices, triangles):
    """Distances from a surface."""
    if not len(points):
        return np.zeros(0)
    squared, _, _ = igl.point_mesh_squared_distance(points, vertices, triangles.astype(np.int64))
    return np.sqrt(squared)


def measured(hulls, vertices, triangles):
    """hulls: points of each. Volumes over the model's; largest and 99 % distances over its box's diagonal: of points of the
    hulls' surfaces from the solid, and of points of the model's surface from the hulls."""
    hulls_of_points = [ConvexHull(points, qhull_options="QJ") for points in hulls]  # joggled: some of V-HACD's are flat
    diagonal = np.linalg.norm(np.ptp(vertices, axis=0))
    first = np.cumsum([0] + [len(points) for points in hulls])
    surface = np.concatenate(hulls), np.concatenate([hull.simplices + at for hull, at in zip(hulls_of_points, first)])

    points = sampled(*surface)
    outside = igl.fast_winding_number(vertices, triangles.astype(np.int64), points) < INSIDE
    beyond = np.zeros(SAMPLES)
    beyond[outside] = away(points[outside], vertices, triangles)

    points = sampled(vertices, triangles)
    out = np.ones(SAMPLES, bool)
    for hull in hulls_of_points:
        out[out] = (points[out] @ hull.equations[:, :3].T + hull.equations[:, 3] > 1e-9 * diagonal).any(axis=1)
    missed = np.zeros(SAMPLES)
    missed[out] = away(points[out], *surface)
    of = {"hulls": len(hulls), "volume": sum(hull.volume for hull in hulls_of_points) / volume(vertices, triangles)}
    for name, distances in ("beyond", beyond), ("missed", missed):
        of[name] = float(distances.max() / diagonal)
        of[f"{name} 99"] = float(np.quantile(distances, 0.99) / diagonal)
    return of
