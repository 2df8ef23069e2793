# SPDX-License-Identifier: GPL-3.0-or-later
"""Seams for unwrapping: along the borders of a cut, in creases. Where a part would not lie flat, would stretch or would
cover itself, cuts are added: into it, or through it along its tree."""

import numpy as np

from ..border import Creases
from ..components import components
from ..weld import is_welding, weld_surface
from .cut import Tree
from .patches import Patch, Sheet, cut_back, opened
from .stretch import Flat, measured

STRETCH = 1.09  # by this factor areas of a patch may be too large or too small on average; of all patches: by 1.1
COVERED = 0.0005  # the share of a patch that may lie on top of itself: what pixels can't tell
NEARLY, AT_ONCE = 2, 16  # cuts into a patch: one by one, once it stretches at most twice too much; else several at once
FAILED = 1.5  # by so much areas of an island differ only where a solver has failed: no patch is foretold half of that
ROUNDS = 3  # so often at most seams are added where a solver failed
SCRAP = 0.1  # of a part: pieces that are smaller, beside its largest, go with their neighbours
LEAST = 0.05  # of a patch that is divided: each side has more


def seams(vertices, triangles, faces, face_count, cut, stretch=STRETCH):
    """(n,2) vertices, the ends of the edges that are to be seams: cut open there and at its own borders, the surface
    falls into patches that are disks, of which none, laid flat with all angles kept, covers itself, nor has areas that
    differ by more than the factor stretch on average, as far as cuts can help.

    Seams follow the borders of the Cut, moved to the creases nearby; cuts into parts prefer creases, and hollows most. A
    part is divided along its tree where cuts into it won't do.

    vertices (V,3), triangles (T,3), faces (T,) the polygon of each, face_count: the surface that the cut is of.
    Coincident vertices are welded: what is cut there already is joined first, and of a seam all edges there are given.
    Raises PartwheelError."""
    old_to_new, welded = weld_surface(vertices, triangles)
    whole = Sheet(vertices, welded, faces)
    creases = Creases(vertices, triangles, faces, face_count)
    tree = _Tree(cut.hierarchy, creases)
    chosen = [whole.crowded]
    labels = in_creases(whole, creases, cut.labels)
    for own in whole.pieces(labels):
        chosen += _within(whole.part(own), tree, stretch)
    chosen.append(_between(whole, labels))
    return _split(whole.ends[np.unique(np.concatenate(chosen))], old_to_new, triangles)


def _split(ends, old_to_new, triangles):
    """The edges (n,2) of a surface that welding makes these (n,2) of."""
    if not is_welding(old_to_new):
        return ends
    edges = np.unique(np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]], axis=2).reshape(-1, 2), axis=0)
    return edges[np.isin(np.sort(old_to_new[edges], axis=1) @ [len(old_to_new), 1], ends @ [len(old_to_new), 1])]


def laid_flat(vertices, triangles, faces, face_count, cut, unwrap):
    """(seams (n,2), UVs (T,3,2) of the triangles' corners) of a cut: seams(), and further() where the solver failed.
    unwrap: the UVs by given seams, asked ROUNDS + 1 times at most."""
    surface = vertices, triangles, faces, face_count
    ends = seams(*surface, cut)
    uv = unwrap(ends)
    for _ in range(ROUNDS):
        more = further(*surface, cut, ends, uv)
        if np.array_equal(more, ends):
            break
        ends = more
        uv = unwrap(ends)
    return ends, uv


def further(vertices, triangles, faces, face_count, cut, ends, uv, stretch=STRETCH):
    """(n,2) seams as ends are, where an unwrapping by those failed: islands whose areas differ far more than was foretold
    are divided once more along the tree. The same seams if there are none, or nothing can be divided.

    ends (n,2): what seams() or this gave of the same surface and cut; uv (T,3,2): of the triangles' corners, by them."""
    old_to_new, welded = weld_surface(vertices, triangles)
    whole = Sheet(vertices, welded, faces)
    seam = np.isin(whole.ends @ [len(whole.places), 1], np.sort(old_to_new[ends], axis=1) @ [len(whole.places), 1])
    tree, inside = None, ~seam[whole.edge]
    for own in whole.pieces(components(len(whole.triangles), whole.pair[inside])):
        sheet = whole.part(own)
        if measured(sheet, uv[own]) <= FAILED:
            continue
        tree = tree or _Tree(cut.hierarchy, Creases(vertices, triangles, faces, face_count))
        sides = tree.divided(sheet)
        if sides is not None:
            seam[sheet.edge] = False  # its own cuts begin anew
            seam[_between(sheet, sides)] = True
            for piece in sheet.pieces(sides):
                for edges in _within(whole.part(own[piece]), tree, stretch):
                    seam[edges] = True
    return _split(whole.ends[seam], old_to_new, triangles)


def _between(sheet, labels):
    """The numbers of edges between triangles of different labels (T,)."""
    return sheet.edge[labels[sheet.pair[:, 0]] != labels[sheet.pair[:, 1]]]


def _within(part, tree, stretch):
    """[edges, ...] that are to be cut within a connected part: divided as long as it must be, and what was divided for
    another reason than its own joined again."""
    patches, todo = {}, [np.arange(len(part.triangles))]
    for own in todo:
        sheet = part.part(own)
        edges, _, apart = _slit(sheet, stretch)
        sides = tree.divided(sheet) if not apart else None
        if sides is None:
            patches[len(patches)] = own, edges
        else:
            todo += [own[piece] for piece in sheet.pieces(sides)]
    label, refused, fresh = np.empty(len(part.triangles), int), set(), len(patches)
    for number, (own, _) in patches.items():
        label[own] = number
    while way := _longest_border(part, label, refused):
        own = np.sort(np.concatenate([patches[number][0] for number in way]))
        edges, stretched, apart = _slit(part.part(own), stretch)
        if apart and stretched <= stretch:
            patches = {number: each for number, each in patches.items() if number not in way}
            patches[fresh], label[own] = (own, edges), fresh
            fresh += 1
        else:
            refused.add(way)
    return [_between(part, label), *(edges for _, edges in patches.values())]


def _longest_border(sheet, labels, refused):
    """(label, label) of those that have most in common, not among refused; None if there are none."""
    ways, common = _common(sheet, labels)
    order = np.argsort(-common, kind="stable")
    return next((way for way in map(tuple, ways[order].tolist()) if way[0] < way[1] and way not in refused), None)


def _common(sheet, labels):
    """((n,2) labels that are beside each other, both ways, (n,) the cost of what is between them)"""
    beside = labels[sheet.pair]
    apart = beside[:, 0] != beside[:, 1]
    ways, of = np.unique(np.concatenate([beside[apart], beside[apart, ::-1]]), axis=0, return_inverse=True)
    return ways, np.bincount(of.ravel(), np.tile(sheet.cost[apart], 2), len(ways))


def _slit(sheet, stretch):
    """(edges that make a connected Sheet a disk which stretches little, how much it then does, whether it lies apart from
    itself)"""
    cut, flat = opened(sheet), None
    while True:
        patch = Patch(sheet, cut)
        flat = Flat(patch, flat)
        now = flat.stretch()
        if now <= stretch:
            break
        away, by, before = patch.ways(np.flatnonzero(patch.rim))
        peaks = flat.peaks(away, 1 if now - 1 < NEARLY * (stretch - 1) else AT_ONCE)
        if not peaks:
            break
        for peak in peaks:
            cut_back(patch, cut, by, before, peak)
    return sheet.edge[cut], now, flat.covered() <= COVERED


class _Tree:
    """Divides patches along the tree of a hierarchy."""

    def __init__(self, hierarchy, creases):
        self.tree, self.creases = Tree(hierarchy), creases
        self.place = np.empty(len(hierarchy.order), int)
        self.place[hierarchy.order] = np.arange(len(hierarchy.order))

    def divided(self, sheet):
        """(T,) 1 on one side of a patch, else 0: of the nodes on the way to its largest piece, and those beside the way,
        the one with the shortest border for what it takes off. None if there is none."""
        place, share = self.place[sheet.faces], sheet.areas / max(sheet.areas.sum(), 1e-300)
        best, found, cluster = np.inf, None, self.tree.root
        while children := self.tree.children(cluster):
            sides = [(first <= place) & (place < last) for first, last in map(self.tree.run, children)]
            shares = [share[side].sum() for side in sides]
            for side, taken in zip(sides, shares):
                if LEAST <= taken <= 1 - LEAST:
                    border = sheet.cost[side[sheet.pair[:, 0]] != side[sheet.pair[:, 1]]].sum()
                    if border < best * min(taken, 1 - taken):
                        best, found = border / min(taken, 1 - taken), side
            larger = int(shares[1] > shares[0])
            if shares[larger] < LEAST:
                break
            cluster = children[larger]
        if found is None:
            return None
        inside = np.zeros(len(self.place), bool)
        inside[sheet.faces[found]] = True
        snapped = self.creases.snap(inside)[sheet.faces]
        if LEAST <= share[snapped].sum() <= 1 - LEAST:
            found = snapped
        return without_scraps(sheet, found.astype(int))


def in_creases(sheet, creases, labels):
    """(T,) the part of each triangle: labels (F,) of faces, but each part's border in the creases nearby, the largest
    part's last, and without scraps."""
    labels, nobody = labels.copy(), labels.max(initial=0) + 1
    one, other = sheet.faces[sheet.pair].T
    area = np.bincount(sheet.faces, sheet.areas, len(labels))
    for part in np.argsort(np.bincount(labels, area), kind="stable").tolist():
        inside = labels == part
        snapped = creases.snap(inside) if inside.any() else inside
        if not snapped.any():
            continue
        labels[snapped] = part
        labels[inside & ~snapped] = nobody  # until a neighbour takes it
        while (lost := labels == nobody).any():
            taken = labels.copy()
            for a, b in ((one, other), (other, one)):
                near = lost[a] & ~lost[b] & (labels[b] != part)
                np.minimum.at(taken, a[near], labels[b[near]])
            if (taken == labels).all():
                taken[lost] = part
            labels = taken
    return without_scraps(sheet, labels[sheet.faces])


def without_scraps(sheet, labels):
    """labels (T,) where small pieces go with the neighbour that they have most in common with."""
    while True:
        same = labels[sheet.pair[:, 0]] == labels[sheet.pair[:, 1]]
        piece = components(len(labels), sheet.pair[same])
        label, area = labels[np.unique(piece, return_index=True)[1]], np.bincount(piece, sheet.areas)
        largest = np.zeros(labels.max(initial=0) + 1)
        np.maximum.at(largest, label, area)
        scrap = area < SCRAP * largest[label]
        ways, common = _common(sheet, piece)
        usable = scrap[ways[:, 0]] & ~scrap[ways[:, 1]]
        if not usable.any():
            return labels
        ways, common = ways[usable], common[usable]
        order = np.lexsort((common, ways[:, 0]))  # of each piece the best is written last
        label[ways[order, 0]] = label[ways[order, 1]]
        labels = label[piece]
