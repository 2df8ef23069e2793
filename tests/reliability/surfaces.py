# SPDX-License-Identifier: GPL-3.0-or-later
"""What is wrong with a surface, found without the library: slow, simple, and exact where it matters."""

import re
from fractions import Fraction

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components


def deserved(vertices, triangles, faces, name, message):
    """Whether the surface has earned this refusal of the exact fill method. For self-intersection the faces that the message
    names must truly meet, and nothing else be wrong, for that is looked for first."""
    wrong = defects(vertices, triangles)
    if name != "self-intersection":
        return name in wrong
    first, second = (np.flatnonzero(faces == int(face))
                     for face in re.search(r"faces (\d+) and (\d+) meet", message).groups())
    return not wrong and any(crossing(vertices, triangles, a, b) for a in first for b in second if a != b)


def defects(vertices, triangles):
    """Names of what is wrong with the surface, self-intersection aside, as the library names it."""
    pairs = set()
    if not len(vertices) or not len(triangles):
        return {"empty"}
    if not np.isfinite(vertices).all():
        pairs.add("not finite")
    if triangles.min() < 0 or triangles.max() >= len(vertices):
        return pairs | {"index"}
    if without_area(vertices, triangles):
        pairs.add("degenerate")
    directed = np.vstack([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    _, uses = np.unique(np.sort(directed), axis=0, return_counts=True)
    _, same_way = np.unique(directed, axis=0, return_counts=True)
    if uses.min() == 1:
        pairs.add("open")
    if uses.max() > 2 or touching_vertices(triangles):
        pairs.add("non-manifold")
    if same_way.max() > 1:
        pairs.add("orientation")
    return pairs


def without_area(vertices, triangles):
    """Whether any triangle's corners lie on one line: decided exactly where rounding leaves a doubt."""
    a, b, c = (vertices[triangles[:, i]] for i in range(3))
    doubled = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    size = np.maximum(np.abs(b - a).max(1), np.abs(c - a).max(1))
    for doubtful in triangles[doubled <= 1e-6 * size * size]:
        p, q, r = (exact(vertices[corner]) for corner in doubtful)
        if not any(cross(subtract(q, p), subtract(r, p))):
            return True
    return False


def touching_vertices(triangles):
    """Whether the triangles round some vertex are not one fan: corners of one vertex are joined where their triangles
    have an edge at it in common, and then there must be one group of corners for each vertex."""
    corners = np.arange(3 * len(triangles)).repeat(2)
    at = triangles.reshape(-1).repeat(2)
    to = triangles[:, [1, 2, 2, 0, 0, 1]].reshape(-1)
    _, spoke = np.unique(np.column_stack([at, to]), axis=0, return_inverse=True)
    spoke = spoke.reshape(-1) + corners[-1] + 1
    size = spoke.max() + 1
    groups, _ = connected_components(coo_matrix((np.ones(len(spoke)), (corners, spoke)), (size, size)), directed=False)
    return groups > len(np.unique(triangles))


def exact(point):
    return tuple(Fraction(float(value)) for value in point)


def subtract(a, b):
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def crossing(vertices, triangles, first, second):
    """Whether two triangles meet elsewhere than at the vertices and edges they share, in exact arithmetic.

    They do if an edge of one meets the other one: every point of an intersection's rim is such a meeting."""
    shared = set(triangles[first].tolist()) & set(triangles[second].tolist())
    if len(shared) == 3:
        return True
    one, two = ([(int(v), exact(vertices[v])) for v in triangles[t]] for t in (first, second))
    return any(edge_meets(one[i], one[(i + 1) % 3], two, shared) or edge_meets(two[i], two[(i + 1) % 3], one, shared)
               for i in range(3))


def edge_meets(start, end, triangle, shared):
    """Whether the segment meets the triangle at a point that is not of a shared vertex or edge."""
    (start_name, p), (end_name, q) = start, end
    corners = [point for _, point in triangle]
    names = [name for name, _ in triangle]
    if start_name in names and end_name in names:
        return False  # a shared edge; the triangles' other edges tell
    normal = cross(subtract(corners[1], corners[0]), subtract(corners[2], corners[0]))
    height_p, below = (dot(normal, subtract(point, corners[0])) for point in (p, q))
    if height_p == below == 0:
        return flat_edge_meets(start, end, triangle, normal)
    if height_p * below > 0:
        return False
    share = height_p / (height_p - below)
    point = tuple(a + share * (b - a) for a, b in zip(p, q))
    if start_name in names and point == p or end_name in names and point == q:
        return False
    return inside(point, corners, normal)


def inside(point, corners, normal):
    return all(dot(cross(subtract(b, a), subtract(point, a)), normal) >= 0
               for a, b in zip(corners, corners[1:] + corners[:1]))


def flat_edge_meets(start, end, triangle, normal):
    """The same in the triangle's own plane: the part of the segment within the triangle, cut side by side."""
    (start_name, p), (end_name, q) = start, end
    names, corners = [name for name, _ in triangle], [point for _, point in triangle]
    low, high = Fraction(0), Fraction(1)
    for a, b in zip(corners, corners[1:] + corners[:1]):
        side = subtract(b, a)
        at_p, at_q = (dot(cross(side, subtract(point, a)), normal) for point in (p, q))
        if at_p < 0 and at_q < 0:
            return False
        if at_p < 0:
            low = max(low, at_p / (at_p - at_q))
        elif at_q < 0:
            high = min(high, at_p / (at_p - at_q))
    if low > high:
        return False
    if low == high:  # one point: nothing, if it is a shared vertex
        return not (low == 0 and start_name in names or low == 1 and end_name in names)
    return True


def near_pairs(vertices, triangles):
    """Pairs (i < j) of triangles whose bounding boxes meet, by a sweep along x."""
    corners = vertices[triangles]
    low, high = corners.min(1), corners.max(1)
    order = np.argsort(low[:, 0], kind="stable")
    starts = low[order, 0]
    for place, triangle in enumerate(order):
        end = np.searchsorted(starts, high[triangle, 0], side="right")
        candidates = order[place + 1:end]
        meet = (low[candidates, 1:] <= high[triangle, 1:]).all(1) & (low[triangle, 1:] <= high[candidates, 1:]).all(1)
        for other in candidates[meet].tolist():
            yield int(triangle), other
