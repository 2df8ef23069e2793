# SPDX-License-Identifier: GPL-3.0-or-later
"""A cut: the model divided into disjoint parts, as an immutable value. Each edit returns a new cut."""

from __future__ import annotations

import collections
import heapq
import itertools
from functools import cached_property
from typing import Any, Dict, Iterable, Iterator, List, Optional, Sequence, Set, Tuple

import numpy as np
from numpy.typing import ArrayLike

from ..hierarchy import ConvexPart, Hierarchy, Solid
from ..library import Error

MAX_PARTS = 4096  # of Cut.into()


class ClusterTree:
    """The unpruned merge tree of a hierarchy with T tetrahedra. Cluster c < T is tetrahedron c; cluster T + m is the
    result of merge m; the root is 2T - 2. The tetrahedra of a cluster are one slice, the left child's before the right
    child's."""

    def __init__(self, hierarchy: Hierarchy) -> None:
        self.hierarchy = hierarchy
        self.leaf_count = len(hierarchy.tetrahedra)
        self.root = 2 * self.leaf_count - 2
        self._ordered_leaves = hierarchy.leaf[hierarchy.order]  # ascending
        self._tet_slices: Dict[int, Tuple[int, int]] = {}

    @cached_property
    def parent(self) -> np.ndarray:
        """(2T - 1,) int32; -1 at the root."""
        parent = np.full(2 * self.leaf_count - 1, -1, np.int32)
        merges = self.hierarchy.merges
        parent[merges] = self.leaf_count + np.arange(len(merges), dtype=np.int32)[:, None]
        return parent

    def children(self, cluster: int) -> Tuple[int, ...]:
        """(left, right); () for a leaf."""
        return tuple(self.hierarchy.merges[cluster - self.leaf_count].tolist()) if cluster >= self.leaf_count else ()

    def tet_slice(self, cluster: int) -> Tuple[int, int]:
        """(first, last): the cluster has the tetrahedra first..last-1."""
        if cluster not in self._tet_slices:
            first = last = cluster
            while first >= self.leaf_count:
                first = int(self.hierarchy.merges[first - self.leaf_count, 0])
            while last >= self.leaf_count:
                last = int(self.hierarchy.merges[last - self.leaf_count, 1])
            self._tet_slices[cluster] = first, last + 1
        return self._tet_slices[cluster]

    def face_slice(self, cluster: int) -> Tuple[int, int]:
        """(first, last): the cluster has the source faces hierarchy.order[first:last]."""
        first, last = np.searchsorted(self._ordered_leaves, self.tet_slice(cluster))
        return int(first), int(last)

    def face_count(self, cluster: int) -> int:
        """The number of the cluster's source faces; 0 if it is inside the solid."""
        first, last = self.face_slice(cluster)
        return last - first

    def ancestors(self, cluster: int) -> Iterator[int]:
        """The clusters that contain this one, smallest first."""
        while (cluster := int(self.parent[cluster])) >= 0:
            yield cluster


class CutPart:
    """A part of a Cut. Functions that take a node accept it."""

    def __init__(self, cut: Cut, number: int) -> None:
        self.cut, self.number = cut, number

    def __repr__(self) -> str:
        return f"<part {self.number} of {self.cut!r}>"

    def __index__(self) -> int:
        """The node's number. Raises CutError if the part is not a node."""
        node = self.cut.node(self.number)
        if node is None:
            raise CutError(f"Part {self.number} is not one node of the tree, perhaps because it was merged by hand. Split it "
                           f"(cut.split({self.number})), or take its faces: cut.faces({self.number}).")
        return node


class CutError(Error):
    """A cut can't do what was asked; str() says why."""

    name = "cut"


class Cut:
    """The model of a hierarchy, divided into parts. Each part has at least one face; each tetrahedron is in one part.

    Create one with Cut.automatic(), Cut.into() or Cut.from_labels(). A cut is immutable: split(), join(), merge() and
    resize() return another cut, or the same if there is nothing to do. Parts are numbered from 0; an edit keeps the order of
    unchanged parts and puts new parts last.

    Attributes
    ----------
    parts : of each part its clusters (see ClusterTree), ascending. More than one with faces: the part was merged by hand
    keys : of each part a number that edits of other parts don't change, for colors and the like
    keeps_borders : whether seams stay on the borders, which somebody chose, instead of moving into the creases nearby
    """

    def __init__(self, tree: ClusterTree, parts: Iterable[Tuple[int, ...]], keys: Iterable[int],
                 keeps_borders: bool = False) -> None:
        self._tree, self.parts, self.keys, self.keeps_borders = tree, tuple(parts), tuple(keys), keeps_borders

    @property
    def hierarchy(self) -> Hierarchy:
        """The hierarchy of the model."""
        return self._tree.hierarchy

    def __len__(self) -> int:
        return len(self.parts)

    def __repr__(self) -> str:
        return f"<Cut of {self.hierarchy!r} into {len(self)} parts>"

    def __getitem__(self, part: int) -> CutPart:
        """The part, to pass where a node is expected. Negative numbers count from the end. Raises IndexError."""
        return CutPart(self, range(len(self))[part])

    def __eq__(self, other: Any) -> bool:
        """Whether both have the same parts, in any order."""
        return isinstance(other, Cut) and self.hierarchy is other.hierarchy and set(self.parts) == set(other.parts)

    def __hash__(self) -> int:
        return hash(frozenset(self.parts))

    # ---- Creation

    @classmethod
    def from_labels(cls, hierarchy: Hierarchy, labels: ArrayLike, keeps_borders: bool = False) -> Cut:
        """The cut with given parts.

        Parameters
        ----------
        labels : (F,) int, any numbers, one for each source face; parts are in their ascending order. Where the faces of
            one tetrahedron have several labels, the majority label counts. To avoid that, build the hierarchy with the
            labels as hard marks: marks_of_labels(..., chosen=True). Clusters without faces join the part of their sibling
        keeps_borders : see the attribute
        """
        labels = np.unique(np.asarray(labels), return_inverse=True)[1].ravel()[hierarchy.order]
        tree = ClusterTree(hierarchy)
        change_count = np.concatenate([[0], np.cumsum(labels[1:] != labels[:-1])])  # before each position of the order
        clusters: Dict[int, List[int]] = {}
        stack = [tree.root]
        while stack:  # depth first, left first; stops at clusters with a single label
            cluster = stack.pop()
            first, last = tree.face_slice(cluster)
            children = tree.children(cluster)
            if change_count[first] != change_count[last - 1] and children:
                stack += [child for child in children[::-1] if tree.face_count(child)]
                continue
            values, counts = np.unique(labels[first:last], return_counts=True)
            clusters.setdefault(int(values[counts.argmax()]), []).append(cluster)
        parts, keys = _add_faceless_clusters(tree, [clusters[label] for label in sorted(clusters)])
        return cls(tree, parts, keys, keeps_borders)

    @classmethod
    def automatic(cls, hierarchy: Hierarchy) -> Cut:
        """The automatic segmentation."""
        return cls.from_labels(hierarchy, hierarchy.face_labels(hierarchy.cut_automatic()))

    @classmethod
    def into(cls, hierarchy: Hierarchy, count: int) -> Cut:
        """The cut that undoes the last merges.

        Parameters
        ----------
        count : number of parts; the cut has fewer if the model can't be divided further
        """
        node_count = min(max(count, 1), len(hierarchy.tetrahedra), MAX_PARTS)
        return cls.from_labels(hierarchy, hierarchy.face_labels(hierarchy.cut_parts(node_count))).resize(count)

    @classmethod
    def from_clusters(cls, hierarchy: Hierarchy, parts: Iterable[Iterable[int]], keeps_borders: bool = False) -> Cut:
        """The cut with the parts of another cut of the same hierarchy.

        Parameters
        ----------
        parts : the clusters of each part, see Cut.parts
        keeps_borders : see the attribute

        Raises
        ------
        ValueError : a cluster does not exist, or the parts don't cover the model
        """
        tree, labels = ClusterTree(hierarchy), np.full(len(hierarchy.order), -1)
        for number, clusters in enumerate(parts):
            for cluster in clusters:
                if not 0 <= cluster <= tree.root:
                    raise ValueError(f"There is no cluster {cluster}: the tree has {tree.root + 1}.")
                labels[hierarchy.order[slice(*tree.face_slice(cluster))]] = number
        if (labels < 0).any():
            raise ValueError("These parts don't cover the whole model.")
        return cls.from_labels(hierarchy, labels, keeps_borders)

    # ---- Queries

    @cached_property
    def labels(self) -> np.ndarray:
        """(F,) int32: the part of each source face."""
        return self.tet_labels[self.hierarchy.leaf]

    @cached_property
    def tet_labels(self) -> np.ndarray:
        """(T,) int32: the part of each tetrahedron."""
        labels = np.empty(len(self.hierarchy.tetrahedra), np.int32)
        for number, clusters in enumerate(self.parts):
            for cluster in clusters:
                labels[slice(*self._tree.tet_slice(cluster))] = number
        return labels

    def faces(self, part: int) -> np.ndarray:
        """(n,) int32: the source faces of a part, ascending. Raises IndexError if there is no such part."""
        return np.flatnonzero(self.labels == range(len(self))[part]).astype(np.int32)

    def node(self, part: int) -> Optional[int]:
        """The node of the hierarchy with the same tetrahedra as a part; None if there is none, for example after a merge by
        hand. Negative numbers count from the end. Raises IndexError."""
        first, last = self.slices(range(len(self))[part])
        return self.hierarchy.find_node(int(first[0]), int(last[0])) if len(first) == 1 else None

    def slices(self, part: int) -> Tuple[np.ndarray, np.ndarray]:
        """(first (n,), last (n,)): the maximal slices of the part's tetrahedra, for Hierarchy.solids()."""
        first, last = np.array(sorted(map(self._tree.tet_slice, self.parts[part])), np.int32).T
        has_gap = first[1:] != last[:-1]
        return first[np.r_[True, has_gap]], last[np.r_[has_gap, True]]

    def tetrahedra(self, part: int) -> np.ndarray:
        """(n, 4) the vertices of the part's tetrahedra."""
        return np.concatenate([self.hierarchy.tetrahedra[first:last] for first, last in zip(*self.slices(part))])

    def convex_parts(self, hulls: Optional[int] = None, **options: Any) -> List[List[ConvexPart]]:
        """Hierarchy.convex_parts() of each part, all with these options."""
        return [self.hierarchy.convex_parts(hulls, slices=np.stack(self.slices(part), axis=1), **options)
                for part in range(len(self))]

    def solids(self) -> List[Optional[Solid]]:
        """The Solid of each part; None where cut polygons leave nothing of it. Their volumes add up to the model's;
        neighbors share the same caps."""
        return self.hierarchy.solids([self.slices(part) for part in range(len(self))])

    def volume(self, part: int) -> float:
        """The volume of the part's tetrahedra."""
        corners = self.hierarchy.vertices[self.tetrahedra(part)]
        a, b, c = (corners[:, k] - corners[:, 3] for k in range(3))
        return float(np.abs(np.einsum("ij,ij->i", a, np.cross(b, c))).sum() / 6)

    def common_ancestor(self, one: int, other: int) -> int:
        """The smallest cluster that contains all faces of two parts. Clusters are numbered in merge order, so the smaller
        the number, the earlier the parts merge."""
        return next(cluster for cluster in self._ancestors[one] if cluster in self._ancestors[other])

    @cached_property
    def _ancestors(self) -> List[Dict[int, None]]:
        """For each part the clusters that contain all its faces, smallest first, as an ordered set."""
        ancestors = []
        for part in range(len(self)):
            first, *rest = ([cluster, *self._tree.ancestors(cluster)] for cluster in self._clusters_with_faces(part))
            ancestors.append(dict.fromkeys(cluster for cluster in first if all(cluster in path for path in rest)))
        return ancestors

    # ---- Edits

    def split(self, part: int) -> Cut:
        """Undo the last merge of a part. The larger half keeps the part's number, the other one comes last. A part that was
        merged by hand is split into its clusters: the first keeps the number, the others come last."""
        with_faces = self._clusters_with_faces(part)
        halves = self._halves(*with_faces) if len(with_faces) == 1 else [[cluster] for cluster in with_faces]
        if not halves:
            return self
        return self._replace_parts({part: halves[0] + sorted(set(self.parts[part]) - set(with_faces))}, halves[1:])

    def join(self, part: int) -> Cut:
        """Join a part with its sibling: with all parts in the next larger cluster. If a part was merged by hand with
        something outside this cluster, what is outside remains a part."""
        top = next(iter(self._ancestors[part]))
        if self._clusters_with_faces(part) == [top]:
            top = int(self._tree.parent[top])
        if top < 0:
            return self
        changes: Dict[int, List[int]] = {}
        joint_clusters = [top]
        for number, clusters in enumerate(self.parts):
            outside = [cluster for cluster in clusters if top not in (cluster, *self._tree.ancestors(cluster))]
            if len(outside) < len(clusters):
                has_faces = any(map(self._tree.face_count, outside))
                joint_clusters += [] if has_faces else outside
                changes[number] = outside if has_faces else []
        return self._replace_parts(changes | {part: joint_clusters})

    def merge(self, one: int, other: int) -> Cut:
        """Merge any two parts; the result has the first one's number."""
        return self if one == other else self._replace_parts({one: [*self.parts[one], *self.parts[other]], other: []})

    def _coarsen(self) -> Cut:
        """One part fewer: do the first merge that is not done yet."""
        owner = {cluster: part for part, clusters in enumerate(self.parts) for cluster in clusters}
        parents = sorted({int(self._tree.parent[cluster]) for cluster in owner} - {-1})
        for parent in parents:
            owners = {owner[child] for child in self._tree.children(parent) if child in owner}
            if len(owners) == 2:
                return self.merge(*sorted(owners))
        return self.merge(0, 1) if len(self) > 1 else self

    def resize(self, count: int) -> Cut:
        """The cut with this number of parts: undo the last merges, though not those by hand, or do the first ones that are not
        done yet. The cut has fewer parts if the model can't be divided that far."""
        cut = self
        while len(cut) > max(count, 1):
            cut = cut._coarsen()
        if len(cut) >= count:
            return cut
        parts: Dict[int, List[int]] = {}  # changed parts; new ones are numbered from len(cut)
        total = len(cut)
        heap = [(-clusters[0], part) for part in range(len(cut)) if len(clusters := cut._clusters_with_faces(part)) == 1]
        heapq.heapify(heap)
        while heap and total < count:
            cluster, part = heapq.heappop(heap)
            halves = self._halves(-cluster)
            if not halves:
                continue
            before = parts[part] if part in parts else cut.parts[part]
            parts[part] = halves[0] + [unchanged for unchanged in before if unchanged != -cluster]
            parts[total] = halves[1]
            heapq.heappush(heap, (-halves[0][0], part))
            heapq.heappush(heap, (-halves[1][0], total))
            total += 1
        new_parts = [parts.pop(number) for number in range(len(cut), total)]
        return cut._replace_parts(parts, new_parts) if new_parts else cut

    def _clusters_with_faces(self, part: int) -> List[int]:
        """The part's clusters that have faces; several after a merge by hand."""
        return [cluster for cluster in self.parts[part] if self._tree.face_count(cluster)]

    def _halves(self, cluster: int) -> List[List[int]]:
        """The clusters of the two halves that a cluster divides into, the half with more faces first. Clusters without
        faces belong to that one. [] if it has no two descendants with faces."""
        faceless: List[int] = []
        while children := self._tree.children(cluster):
            small, large = sorted(children, key=self._tree.face_count)
            if self._tree.face_count(small):
                return [[large, *faceless], [small]]
            faceless.append(small)
            cluster = large
        return []

    def _replace_parts(self, changes: Dict[int, List[int]], new_parts: Iterable[List[int]] = ()) -> Cut:
        """The cut with other clusters for some parts, {part: clusters}, none: the part is removed, and with these new parts
        at the end."""
        parts: List[Tuple[Sequence[int], int]] = [(changes.get(number, clusters), key)
                                                  for number, (clusters, key) in enumerate(zip(self.parts, self.keys))]
        result = [(_collapse_clusters(self._tree, clusters), key) for clusters, key in parts if clusters]
        result += zip((_collapse_clusters(self._tree, clusters) for clusters in new_parts),
                      range(max(self.keys) + 1, 1 << 30))
        return Cut(self._tree, [clusters for clusters, _ in result], [key for _, key in result], self.keeps_borders)


def _add_faceless_clusters(tree: ClusterTree, parts: List[List[int]]) -> Tuple[List[Tuple[int, ...]], range]:
    """(parts, keys): parts, lists of clusters, completed to cover the tree. Each missing cluster, which has no faces, goes
    to the part of its sibling, or of the last covered cluster in it."""
    owner = {cluster: number for number, clusters in enumerate(parts) for cluster in clusters}
    ancestors: Set[int] = set()
    for cluster in owner:  # up to a known ancestor: trees may be deep
        ancestors.update(itertools.takewhile(lambda ancestor: ancestor not in ancestors, tree.ancestors(cluster)))
    parts = [list(clusters) for clusters in parts]
    for cluster in sorted(ancestors):
        for child, sibling in zip(tree.children(cluster), tree.children(cluster)[::-1]):
            if child in ancestors or child in owner:
                continue
            while sibling not in owner:
                sibling = next(heir for heir in tree.children(sibling)[::-1] if heir in ancestors or heir in owner)
            owner[child] = owner[sibling]
            parts[owner[sibling]].append(child)
    return [_collapse_clusters(tree, clusters) for clusters in parts], range(len(parts))


def _collapse_clusters(tree: ClusterTree, clusters: Iterable[int]) -> Tuple[int, ...]:
    """The smallest set of clusters with the same tetrahedra, ascending."""
    remaining = set(clusters)
    queue = collections.deque(sorted(remaining))
    while queue:
        parent = int(tree.parent[queue.popleft()])
        if parent >= 0 and remaining.issuperset(tree.children(parent)):
            remaining -= set(tree.children(parent))
            remaining.add(parent)
            queue.append(parent)
    return tuple(sorted(remaining))
