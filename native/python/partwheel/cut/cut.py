# SPDX-License-Identifier: GPL-3.0-or-later
"""A cut: the whole model in parts, as a value. What edits it gives a new one."""

import heapq
from functools import cached_property
from typing import Optional

import numpy as np

from ..library import Error


class Tree:
    """The unpruned binary tree of a hierarchy with T tetrahedra: cluster c < T is leaf c, cluster T + m what merge m
    joins. Each cluster's tetrahedra are a slice, its left child's before its right one's."""

    def __init__(self, hierarchy):
        self.hierarchy = hierarchy
        self.leaves = len(hierarchy.tetrahedra)
        self.root = 2 * self.leaves - 2
        self._by_leaf = hierarchy.leaf[hierarchy.order]
        self._ends = {}

    @cached_property
    def parent(self):
        """(2T-1,) -1 at the root."""
        parent = np.full(2 * self.leaves - 1, -1, np.int32)
        merges = self.hierarchy.merges
        parent[merges] = self.leaves + np.arange(len(merges), dtype=np.int32)[:, None]
        return parent

    def children(self, cluster):
        """(left, right), or () of a leaf."""
        return tuple(self.hierarchy.merges[cluster - self.leaves].tolist()) if cluster >= self.leaves else ()

    def ends(self, cluster):
        """(first, last): its slice of the tetrahedra."""
        if cluster not in self._ends:
            first = last = cluster
            while first >= self.leaves:
                first = int(self.hierarchy.merges[first - self.leaves, 0])
            while last >= self.leaves:
                last = int(self.hierarchy.merges[last - self.leaves, 1])
            self._ends[cluster] = first, last + 1
        return self._ends[cluster]

    def run(self, cluster):
        """(first, last): its slice of the hierarchy's order of faces."""
        first, last = np.searchsorted(self._by_leaf, self.ends(cluster))
        return int(first), int(last)

    def faces(self, cluster):
        """How many source faces it has."""
        first, last = self.run(cluster)
        return last - first

    def path(self, cluster):
        """The clusters above it, growing."""
        while (cluster := int(self.parent[cluster])) >= 0:
            yield cluster


class CutPart:
    """A part of a Cut, which stands for its node wherever a node is wanted."""

    def __init__(self, cut: "Cut", number: int) -> None:
        self.cut, self.number = cut, number

    def __repr__(self) -> str:
        return f"<part {self.number} of {self.cut!r}>"

    def __index__(self) -> int:
        """The node's number. Raises CutError for a part that is no node."""
        node = self.cut.node(self.number)
        if node is None:
            raise CutError(f"Part {self.number} is not one node of the tree, perhaps because it was merged by hand. Split it "
                           f"(cut.split({self.number})), or take its faces: cut.faces({self.number}).")
        return node


class CutError(Error):
    """What a cut can't do; str() says why."""

    name = "cut"


class Cut:
    """A hierarchy's model in parts. Each part has at least one face and each tetrahedron is in one part.

    Make one with Cut.automatic(), Cut.into() or Cut.of_labels(). It never changes: split(), join(), merge(), more(),
    fewer() and sized() give another one, or the same where there is nothing to be done. Parts are numbered from 0; what
    an edit leaves as it was stays before what it makes, so numbers change little.

    parts: of each part its clusters (see Tree), sorted; more than one with faces where parts were merged by hand.
    keys: of each part a number that it keeps whatever is done to others, for colours and the like.
    """

    def __init__(self, tree, parts, keys):
        self._tree, self.parts, self.keys = tree, tuple(parts), tuple(keys)

    @property
    def hierarchy(self):
        return self._tree.hierarchy

    def __len__(self) -> int:
        return len(self.parts)

    def __repr__(self) -> str:
        return f"<Cut of {self.hierarchy!r} into {len(self)} parts>"

    def __getitem__(self, part: int) -> CutPart:
        """A part as what stands for its node. Negative numbers count from the end. Raises IndexError."""
        return CutPart(self, range(len(self))[part])

    def __eq__(self, other):
        """The same parts, whatever their numbers."""
        return isinstance(other, Cut) and self.hierarchy is other.hierarchy and set(self.parts) == set(other.parts)

    def __hash__(self):
        return hash(frozenset(self.parts))

    # ---- Made

    @classmethod
    def of_labels(cls, hierarchy, labels):
        """The cut with these parts, in this order: labels (F,) whole numbers, one for each source face. Where they
        divide the faces of one tetrahedron, most of them count. What is inside, without a face, goes with what it was
        joined to."""
        labels = np.unique(np.asarray(labels), return_inverse=True)[1].ravel()[hierarchy.order]
        tree = Tree(hierarchy)
        changes = np.concatenate([[0], np.cumsum(labels[1:] != labels[:-1])])
        found, todo = {}, [tree.root]
        while todo:  # from the root down, left first; most of a tree is never looked at
            cluster = todo.pop()
            first, last = tree.run(cluster)
            children = tree.children(cluster)
            if changes[first] != changes[last - 1] and children:
                todo += [child for child in children[::-1] if tree.faces(child)]
                continue
            values, counts = np.unique(labels[first:last], return_counts=True)
            found.setdefault(int(values[counts.argmax()]), []).append(cluster)
        return cls(tree, *_complete(tree, [found[label] for label in sorted(found)]))

    @classmethod
    def automatic(cls, hierarchy):
        """The parts that people would most likely take."""
        return cls.of_labels(hierarchy, hierarchy.face_labels(hierarchy.cut_automatic()))

    @classmethod
    def into(cls, hierarchy, count):
        """So many parts, the last merges undone: at least one, and not more than there are to be told apart."""
        most = min(max(count, 1), len(hierarchy.tetrahedra), 4096)
        return cls.of_labels(hierarchy, hierarchy.face_labels(hierarchy.cut_parts(most))).sized(count)

    @classmethod
    def of_parts(cls, hierarchy, parts):
        """The cut whose parts are these lists of clusters, as another one's parts tell. ValueError: they don't make the
        whole."""
        tree, labels = Tree(hierarchy), np.full(len(hierarchy.order), -1)
        for number, clusters in enumerate(parts):
            for cluster in clusters:
                if not 0 <= cluster <= tree.root:
                    raise ValueError(f"There is no cluster {cluster}: the tree has {tree.root + 1}.")
                labels[hierarchy.order[slice(*tree.run(cluster))]] = number
        if (labels < 0).any():
            raise ValueError("These parts don't make the whole.")
        return cls.of_labels(hierarchy, labels)

    # ---- Seen

    @cached_property
    def labels(self):
        """(F,) the part of each source face."""
        labels = np.empty(len(self.hierarchy.order), np.int32)
        for number, clusters in enumerate(self.parts):
            for cluster in clusters:
                labels[self.hierarchy.order[slice(*self._tree.run(cluster))]] = number
        return labels

    @cached_property
    def tet_labels(self) -> np.ndarray:
        """(T,) int32: the part of each tetrahedron."""
        labels = np.empty(len(self.hierarchy.tetrahedra), np.int32)
        for number, clusters in enumerate(self.parts):
            for cluster in clusters:
                labels[slice(*self._tree.ends(cluster))] = number
        return labels

    def faces(self, part: int) -> np.ndarray:
        """(n,) the source faces of a part, ascending. Raises IndexError for a part that there is not."""
        return np.flatnonzero(self.labels == range(len(self))[part]).astype(np.int32)

    def node(self, part: int) -> Optional[int]:
        """The node of the hierarchy that has the same tetrahedra as a part.

        Parameters
        ----------
        part : its number; negative ones count from the end

        Returns
        -------
        the node's number; None for a part that is no node, as those that were merged by hand

        Raises
        ------
        IndexError : there is no such part
        """
        first, last = self.slices(range(len(self))[part])
        return self.hierarchy.find_node(int(first[0]), int(last[0])) if len(first) == 1 else None

    def slices(self, part):
        """((n,) first, (n,) last): the part's slices of the tetrahedra, for Hierarchy.solids()."""
        first, last = np.array(sorted(map(self._tree.ends, self.parts[part])), np.int32).T
        apart = first[1:] != last[:-1]
        return first[np.r_[True, apart]], last[np.r_[apart, True]]

    def solids(self):
        """The part's Solids, whose volumes add up to the whole's; caps between two are the same in both. None where
        polygons that are cut leave nothing of a part."""
        return self.hierarchy.solids([self.slices(part) for part in range(len(self))])

    def volume(self, part):
        """Of the part's tetrahedra."""
        corners = np.concatenate([self.hierarchy.tetrahedra[first:last] for first, last in zip(*self.slices(part))])
        corners = self.hierarchy.vertices[corners]
        a, b, c = (corners[:, k] - corners[:, 3] for k in range(3))
        return float(np.abs(np.einsum("ij,ij->i", a, np.cross(b, c))).sum() / 6)

    def joined_at(self, one, other):
        """The number of the cluster that first holds all of two parts: the lower, the nearer they are in the tree."""
        return next(cluster for cluster in self._ways[one] if cluster in self._ways[other])

    @cached_property
    def _ways(self):
        """Of each part the clusters that hold all of it that is seen, growing: keys of a dict, for their order."""
        ways = []
        for part in range(len(self)):
            first, *others = ([cluster, *self._tree.path(cluster)] for cluster in self._seen(part))
            ways.append(dict.fromkeys(cluster for cluster in first if all(cluster in other for other in others)))
        return ways

    # ---- Edited

    def split(self, part):
        """The part as its two halves: what was joined last, or merged by hand. The larger one keeps the part's number,
        the other one comes last."""
        seen = self._seen(part)
        halves = self._halves(*seen) if len(seen) == 1 else [[cluster] for cluster in seen]
        if not halves:
            return self
        return self._with({part: halves[0] + sorted(set(self.parts[part]) - set(seen))}, halves[1:])

    def join(self, part):
        """The part and all that is in its sibling as one: the next larger node of the tree. Of parts that were merged
        by hand across that node, what is beyond it stays."""
        top = next(iter(self._ways[part]))
        if self._seen(part) == [top]:
            top = int(self._tree.parent[top])
        if top < 0:
            return self
        changes, joined = {}, [top]
        for number, clusters in enumerate(self.parts):
            beyond = [cluster for cluster in clusters if top not in (cluster, *self._tree.path(cluster))]
            if len(beyond) < len(clusters):
                seen = any(map(self._tree.faces, beyond))
                joined += [] if seen else beyond
                changes[number] = beyond if seen else []
        return self._with(changes | {part: joined})

    def merge(self, one, other):
        """Any two parts as one, with the first one's number."""
        return self if one == other else self._with({one: [*self.parts[one], *self.parts[other]], other: []})

    def more(self):
        """One part more: of all that were not merged by hand the last merge is undone."""
        return self.sized(len(self) + 1)

    def fewer(self):
        """One part less: the first merge that is still to be done is done."""
        owner = {cluster: part for part, clusters in enumerate(self.parts) for cluster in clusters}
        ways = sorted({int(self._tree.parent[cluster]) for cluster in owner} - {-1})
        for parent in ways:
            own = {owner[child] for child in self._tree.children(parent) if child in owner}
            if len(own) == 2:
                return self.merge(*sorted(own))
        return self.merge(0, 1) if len(self) > 1 else self

    def sized(self, count):
        """With so many parts, as far as more() and fewer() lead there."""
        cut = self
        while len(cut) > max(count, 1):
            cut = cut.fewer()
        if len(cut) >= count:
            return cut
        parts, total = {}, len(cut)  # those that become others, and new ones from there on
        last = [(-seen[0], part) for part in range(len(cut)) if len(seen := cut._seen(part)) == 1]
        heapq.heapify(last)
        while last and total < count:
            cluster, part = heapq.heappop(last)
            halves = self._halves(-cluster)
            if not halves:
                continue
            before = parts[part] if part in parts else cut.parts[part]
            parts[part] = halves[0] + [each for each in before if each != -cluster]
            parts[total] = halves[1]
            heapq.heappush(last, (-halves[0][0], part))
            heapq.heappush(last, (-halves[1][0], total))
            total += 1
        new = [parts.pop(number) for number in range(len(cut), total)]
        return cut._with(parts, new) if new else cut

    def _seen(self, part):
        """The part's clusters with faces; several were merged by hand."""
        return [cluster for cluster in self.parts[part] if self._tree.faces(cluster)]

    def _halves(self, cluster):
        """The two parts, as lists of clusters, the larger first, that the cluster falls into first; [] for one that
        can't be told apart. What has no face goes with the larger one."""
        beside = []
        while children := self._tree.children(cluster):
            small, large = sorted(children, key=self._tree.faces)
            if self._tree.faces(small):
                return [[large, *beside], [small]]
            beside.append(small)
            cluster = large
        return []

    def _with(self, changes, new=()):
        """Parts with other clusters: changes by number, none for parts that are no more; and new ones, which come
        last."""
        kept = [(changes.get(number, clusters), key)
                for number, (clusters, key) in enumerate(zip(self.parts, self.keys))]
        kept = [(_collapsed(self._tree, clusters), key) for clusters, key in kept if clusters]
        kept += zip((_collapsed(self._tree, clusters) for clusters in new), range(max(self.keys) + 1, 1 << 30))
        return Cut(self._tree, *zip(*kept))


def _complete(tree, parts):
    """(parts, keys) of lists of clusters that miss only what has no face: each such cluster goes with the part that its
    sibling, or the last piece of that, is in."""
    owner = {cluster: number for number, clusters in enumerate(parts) for cluster in clusters}
    above = {cluster for each in owner for cluster in tree.path(each)}
    parts = [list(clusters) for clusters in parts]
    for cluster in sorted(above):
        for child, sibling in zip(tree.children(cluster), tree.children(cluster)[::-1]):
            if child in above or child in owner:
                continue
            while sibling not in owner:
                sibling = next(each for each in tree.children(sibling)[::-1] if each in above or each in owner)
            owner[child] = owner[sibling]
            parts[owner[sibling]].append(child)
    return [_collapsed(tree, clusters) for clusters in parts], range(len(parts))


def _collapsed(tree, clusters):
    """The same tetrahedra with as few clusters as can be."""
    clusters = set(clusters)
    todo = sorted(clusters)
    while todo:
        parent = int(tree.parent[todo.pop(0)])
        if parent >= 0 and clusters.issuperset(tree.children(parent)):
            clusters -= set(tree.children(parent))
            clusters.add(parent)
            todo.append(parent)
    return tuple(sorted(clusters))
