# SPDX-License-Identifier: GPL-3.0-or-later
"""A patch laid flat with its angles kept, without laying it flat: how much each place is scaled follows from the
curvature alone (Poisson's equation, with the rim as long as it is), and with it the outline."""

import numpy as np

SHARPEST = 50.0  # a triangle's cotangents beyond that are taken as that
EXACT = 1e-4  # the residual is to be so much smaller than at first
MOST_STEPS = 3000
SMOOTHED = 3  # so many rounds: a peak is to be more than one sharp vertex
SADDLE = 0.5  # a cut to a saddle makes its surroundings cover each other: not so soon
NEXT, FAR = 0.5, 2.0  # peaks at a time: those half as high, so much farther apart than from the rim
DIGITS = 6  # of heights: of what is the same on both sides of a model the lower number comes first
WORST = 10.0  # by which a triangle counts at most, where it is measured
FINE = 192  # pixels that an outline is wide or high


class Flat:
    """A Patch that is a disk, laid flat so that all angles stay and the rim keeps its length: of all ways to keep the
    angles the one in which areas differ least.

    scale (vertices,) the natural logarithm of how much longer lengths get at each vertex: negative on bulges, positive
    on saddles. before: the same sheet's Flat with fewer cuts, to begin the search from."""

    def __init__(self, patch, before=None):
        self.patch, count, vertex = patch, patch.count, patch.vertex
        free = ~patch.rim
        angle, cotangent = patch.sheet.angles
        turn = 2 * np.pi - np.bincount(vertex.ravel(), angle.ravel(), count)
        # Half the cotangents of the corners across from it: an edge's weight.
        a, b = vertex[:, [1, 2, 0]].ravel(), vertex[:, [2, 0, 1]].ravel()
        weight = np.clip(cotangent.ravel(), -SHARPEST, SHARPEST) / 2
        low, high = np.minimum(a, b), np.maximum(a, b)
        keys, of = np.unique(low * count + high, return_inverse=True)
        low, high, weight = keys // count, keys % count, np.bincount(of.ravel(), weight)
        diagonal = np.bincount(low, weight, count) + np.bincount(high, weight, count)

        def differences(values):
            return (diagonal * values - np.bincount(low, weight * values[high], count)
                    - np.bincount(high, weight * values[low], count))

        begin = np.zeros(count)
        if before:
            begin[vertex] = before.scale[before.patch.vertex]
            begin[patch.rim] = 0
        self.scale = _solved(lambda values: np.where(free, differences(values), 0), np.where(free, -turn, 0),
                             np.where(diagonal > 0, diagonal, 1), begin)
        # At the rim: how far an outline turns there.
        self.turn = turn - np.pi + differences(self.scale)

    def stretch(self):
        """How much areas differ: the mean, by area, of by what factor a place is too large or too small."""
        return _unevenness(np.exp(np.clip(2 * self.scale[self.patch.vertex].mean(axis=1), -50, 50)), self.patch.sheet.areas)

    def peaks(self, away, most):
        """[vertex, ...] at most so many that are scaled most, up or down, each farther from the others than they are from
        the rim: away (vertices,). By what is around them, so that noise is none."""
        patch, smooth = self.patch, self.scale
        a, b = patch.joined.T
        around = 1 + np.bincount(a, minlength=patch.count) + np.bincount(b, minlength=patch.count)
        for _ in range(SMOOTHED):
            smooth = np.where(patch.rim, 0, (smooth + np.bincount(a, smooth[b], patch.count)
                                             + np.bincount(b, smooth[a], patch.count)) / around)
        size = np.where(smooth < 0, -smooth, SADDLE * smooth)
        size = np.round(size / max(size.max(initial=0), 1e-300), DIGITS)
        places = np.empty((patch.count, 3))
        places[patch.vertex] = patch.sheet.places[patch.sheet.triangles]
        likely = np.flatnonzero((size > NEXT) & np.isfinite(away))
        likely, found = likely[np.argsort(-size[likely], kind="stable")], []
        while len(likely) and len(found) < most:
            found.append(int(likely[0]))
            apart = np.linalg.norm(places[likely] - places[likely[0]], axis=1)
            likely = likely[apart > FAR * np.maximum(away[likely], away[likely[0]])]
        return found

    def covered(self):
        """The share of the inside of its outline that is covered more than once."""
        rim, length = self.patch.outline()
        heading = np.cumsum(self.turn[rim])
        steps = length[:, None] * np.column_stack([np.cos(heading), np.sin(heading)])
        steps -= length[:, None] * (steps.sum(axis=0) / max(length.sum(), 1e-300))  # so that it closes
        return _covered_twice(np.cumsum(steps, axis=0))


def measured(sheet, uv):
    """What Flat.stretch() foretells, of a Sheet that was laid flat: uv (T,3,2). A triangle counts at most WORST."""
    a, b, c = uv.transpose(1, 0, 2)
    return _unevenness(abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / np.maximum(sheet.areas, 1e-300),
                       sheet.areas, WORST)


def _unevenness(factor, areas, most=1e9):
    """The mean, by area, of by what factor a place is too large or too small."""
    area = areas / max(areas.sum(), 1e-300)
    factor = factor / max(_dot(factor, area), 1e-300)
    return _dot(np.minimum(np.maximum(factor, 1 / np.maximum(factor, 1e-9)), most), area)


def _covered_twice(outline):
    """The share of a closed line's inside (n,2) that it winds around more than once; by points of a grid."""
    low, size = outline.min(axis=0), np.ptp(outline, axis=0).max()
    if not size > 0:
        return 0.0
    x, y = ((outline - low) * (FINE / size)).T
    after_x, after_y = np.roll(x, -1), np.roll(y, -1)
    first, last = np.ceil(np.minimum(y, after_y) - 0.5), np.ceil(np.maximum(y, after_y) - 0.5)
    rows = (last - first).astype(int)
    of = np.repeat(np.arange(len(x)), rows)
    row = first[of] + np.arange(len(of)) - np.repeat(np.cumsum(rows) - rows, rows)
    at = x[of] + (row + 0.5 - y[of]) / (after_y - y)[of] * (after_x - x)[of]
    column = np.clip(np.ceil(at - 0.5), 0, FINE).astype(int)
    winding = np.zeros((FINE + 1, FINE + 1))
    np.add.at(winding, (np.clip(row, 0, FINE).astype(int), column), np.where(after_y < y, 1, -1)[of])
    winding = abs(np.cumsum(winding, axis=1))
    return np.count_nonzero(winding > 1) / max(np.count_nonzero(winding), 1)


def _solved(applied, right, diagonal, begin):
    """Conjugate gradients."""
    found, rest = begin, right - applied(begin)
    goal = EXACT * EXACT * _dot(right, right / diagonal)
    ready = rest / diagonal
    way, size = ready, _dot(rest, ready)
    for _ in range(MOST_STEPS):
        if size <= goal:
            break
        image = applied(way)
        down = _dot(way, image)
        if down <= 0:
            break
        found = found + size / down * way
        rest = rest - size / down * image
        ready = rest / diagonal
        size, before = _dot(rest, ready), size
        way = ready + size / before * way
    return found


def _dot(one, other):
    """Without BLAS, which adds in another order on other processors, and waits for its threads."""
    return float((one * other).sum())
