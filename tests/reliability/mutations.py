# SPDX-License-Identifier: GPL-3.0-or-later
"""Broken meshes made from whole ones, as editing, importing and bad luck break them. The same for the same seed."""

import numpy as np


def some(draw, count, share):
    """Indices of a random share, at least one, of so many elements."""
    return draw.choice(count, max(1, int(count * draw.uniform(0, share))), replace=False)


def flip(draw, vertices, triangles):
    triangles = triangles.copy()
    is_chosen = some(draw, len(triangles), 0.3)
    triangles[is_chosen] = triangles[is_chosen, ::-1]
    return vertices, triangles


def duplicate(draw, vertices, triangles):
    copies = triangles[some(draw, len(triangles), 0.2)]
    return vertices, np.vstack([triangles, copies[:, ::draw.choice([1, -1])]])


def delete(draw, vertices, triangles):
    remaining = np.delete(triangles, some(draw, len(triangles), 0.3), axis=0)
    return vertices, remaining if len(remaining) else triangles


def cut(draw, vertices, triangles):
    """All on one side of a plane is gone."""
    side = vertices @ draw.normal(size=3)
    is_kept = side[triangles].min(axis=1) > np.quantile(side, draw.uniform(0, 0.6))
    return vertices, triangles[is_kept] if is_kept.any() else triangles


def weld(draw, vertices, triangles):
    """Vertices that share a cell of a grid become one; triangles may collapse."""
    size = np.ptp(vertices, axis=0).max() / draw.integers(4, 60)
    _, first_index, names = np.unique(np.floor(vertices / size), axis=0, return_index=True, return_inverse=True)
    return vertices[first_index], names.reshape(-1)[triangles].astype(np.int32)


def collapse(draw, vertices, triangles):
    """Edges of length 0: one end takes the other's name."""
    names = np.arange(len(vertices))
    edges = triangles[some(draw, len(triangles), 0.1)][:, :2]
    names[edges[:, 0]] = edges[:, 1]
    return vertices, names[triangles].astype(np.int32)


def flatten(draw, vertices, triangles):
    """Edges of length almost 0: one end is put where the other is."""
    vertices = vertices.copy()
    edges = triangles[some(draw, len(triangles), 0.1)][:, :2]
    vertices[edges[:, 0]] = vertices[edges[:, 1]] * (1 + draw.choice([0, 1e-16, 1e-9]))
    return vertices, triangles


def intersect(draw, vertices, triangles):
    """A turned copy through the original."""
    turn, _ = np.linalg.qr(draw.normal(size=(3, 3)))
    copy = vertices @ turn * draw.uniform(0.2, 1.2) + draw.normal(size=3) * np.ptp(vertices, axis=0) * 0.3
    return np.vstack([vertices, copy]), np.vstack([triangles, triangles + len(vertices)]).astype(np.int32)


def spikes(draw, vertices, triangles):
    vertices = vertices.copy()
    is_chosen = some(draw, len(vertices), 0.05)
    vertices[is_chosen] += draw.normal(size=(len(is_chosen), 3)) * np.ptp(vertices, axis=0).max()
    return vertices, triangles


def tremble(draw, vertices, triangles):
    return vertices + draw.normal(size=vertices.shape) * np.ptp(vertices, axis=0).max() * 10 ** draw.uniform(-9, -2), \
        triangles


def loosen(draw, vertices, triangles):
    """Every triangle for itself, as in an STL file."""
    return vertices[triangles].reshape(-1, 3), np.arange(triangles.size, dtype=np.int32).reshape(-1, 3)


def scramble(draw, vertices, triangles):
    """Some corners are of other vertices altogether."""
    triangles = triangles.copy()
    is_chosen = some(draw, len(triangles), 0.05)
    triangles[is_chosen, draw.integers(3)] = draw.integers(0, len(vertices), len(is_chosen))
    return vertices, triangles


def slivers(draw, vertices, triangles):
    """Triangles fall into three, with the new corner almost on an edge."""
    is_chosen = some(draw, len(triangles), 0.3)
    weights = np.array([0.5, 0.5, 0]) + np.array([-1, -1, 2]) * 10 ** draw.uniform(-9, -3)
    middle = np.einsum("k,nkx->nx", weights, vertices[triangles[is_chosen]])
    new = len(vertices) + np.arange(len(is_chosen), dtype=triangles.dtype)
    a, b, c = triangles[is_chosen].T
    thirds = [np.column_stack([new, b, c]), np.column_stack([a, new, c]), np.column_stack([a, b, new])]
    return np.vstack([vertices, middle]), np.vstack([np.delete(triangles, is_chosen, axis=0), *thirds])


def dust(draw, vertices, triangles):
    """Specks about the model: triangles of their own, and tiny tetrahedra."""
    count, size = draw.integers(1, 100), np.ptp(vertices, axis=0).max()
    places = vertices.min(axis=0) + draw.uniform(size=(count, 1, 3)) * np.ptp(vertices, axis=0)
    corners = places + draw.normal(size=(count, 4, 3)) * size * 10 ** draw.uniform(-6, -2)
    facets = np.array([[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]])[:draw.choice([1, 4])]
    specks = len(vertices) + 4 * np.arange(count)[:, None, None] + facets
    return np.vstack([vertices, corners.reshape(-1, 3)]), \
        np.vstack([triangles, specks.reshape(-1, 3)]).astype(np.int32)


def permute(draw, vertices, triangles):
    """The same mesh in another order."""
    order = draw.permutation(len(vertices))
    return vertices[order], np.argsort(order)[draw.permutation(triangles)].astype(np.int32)


def huge(draw, vertices, triangles):
    return vertices * 10.0 ** draw.integers(3, 25), triangles


def tiny(draw, vertices, triangles):
    return vertices * 10.0 ** -draw.integers(3, 25), triangles


def far(draw, vertices, triangles):
    """One vertex is out of all proportion."""
    vertices = vertices.copy()
    vertices[draw.integers(len(vertices))] *= 10.0 ** draw.integers(2, 20)
    return vertices, triangles


def plane(draw, vertices, triangles):
    vertices = vertices.copy()
    vertices[:, draw.integers(3)] *= draw.choice([0, 1e-12, 1e-5])
    return vertices, triangles


def not_a_number(draw, vertices, triangles):
    vertices = vertices.copy()
    vertices[draw.integers(len(vertices)), draw.integers(3)] = draw.choice([np.nan, np.inf, -np.inf, 1e200])
    return vertices, triangles


def no_such_vertex(draw, vertices, triangles):
    triangles = triangles.copy()
    triangles[draw.integers(len(triangles)), draw.integers(3)] = draw.choice([-1, len(vertices), 2**31 - 1, -(2**31)])
    return vertices, triangles


ORDINARY = (flip, duplicate, delete, cut, weld, collapse, flatten, intersect, spikes, tremble, loosen, scramble,
            slivers, dust, permute, huge, tiny, far, plane)
REFUSED = {not_a_number: "not finite", no_such_vertex: "index"}


def mutated(seed, vertices, triangles):
    """(names of what was done, vertices, triangles, the name of the error that it must give or None)."""
    draw = np.random.default_rng(seed)
    steps = [ORDINARY[i] for i in draw.integers(0, len(ORDINARY), draw.integers(1, 4))]
    error = None
    if draw.random() < 0.1:
        steps.append(list(REFUSED)[draw.integers(len(REFUSED))])
        error = REFUSED[steps[-1]]
    for step in steps:
        vertices, triangles = step(draw, vertices, triangles)
    if error is None and not np.abs(vertices).max() <= 1e100:
        error = "not finite"
    return [step.__name__ for step in steps], vertices, np.ascontiguousarray(triangles, np.int32), error
