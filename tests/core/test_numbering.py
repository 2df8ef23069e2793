# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers of faces, nodes, clusters, tetrahedra and parts, and how one becomes another: by plain searches."""

import operator

import numpy as np
import pytest
from partwheel import PartwheelError
from partwheel.cut import Cut, CutError
from partwheel.cut.cut import ClusterTree


def test_children_are_the_nodes_whose_parent_it_is(case):
    _, h = case
    for node in {0, len(h.parent) // 2, max(len(h.parent) - 2, 0), len(h.parent) - 1}:
        children = h.children(node)
        assert sorted(children) == [index for index in range(len(h.parent)) if h.parent[index] == node]
        if children:  # they are the node's tetrahedra, one after the other
            ends = [h.tet_first[node], *(h.tet_last[child] for child in children)]
            assert [h.tet_first[child] for child in children] == ends[:-1] and ends[-1] == h.tet_last[node]
        else:
            assert h.tet_last[node] - h.tet_first[node] == 1
        assert h.find_node(h.tet_first[node], h.tet_last[node]) == node
    for wrong in (-1, len(h.parent)):
        with pytest.raises(PartwheelError):
            h.children(wrong)
    assert h.find_node(0, 0) is None


def test_what_they_are_is_shown(build_shape):
    _, h = build_shape("hand.off")
    assert repr(h) == f"<Hierarchy of 2390 faces: {len(h.parent)} nodes, {len(h.tetrahedra)} tetrahedra, exact>"
    cut = Cut.into(h, 4)
    assert repr(cut) == f"<Cut of {h!r} into 4 parts>" and repr(cut[3]) == f"<part 3 of {cut!r}>"


@pytest.mark.parametrize("count", [1, 4, 9])
def test_parts_nodes_faces_and_tetrahedra(count, build_shape):
    _, h = build_shape("hand.off")
    tree, cut = ClusterTree(h), Cut.into(h, count)
    assert len(list(cut)) == count  # it can be iterated over
    for number, part in enumerate(cut):
        node = cut.node(number)
        assert operator.index(part) == node == cut[number - count].cut.node(number - count)
        assert sorted(h.faces(part).tolist()) == cut.faces(number).tolist() == np.flatnonzero(cut.labels == number).tolist()
        cluster, = cut.parts[number]
        assert tree.tet_slice(cluster) == (h.tet_first[node], h.tet_last[node])
        assert np.flatnonzero(cut.tet_labels == number).tolist() == list(range(h.tet_first[node], h.tet_last[node]))
        assert len(h.solid(part).triangles) == len(h.solid(node).triangles)
    assert (cut.tet_labels[h.leaf] == cut.labels).all()
    for wrong in (count, -count - 1):
        for ask in (cut.__getitem__, cut.node, cut.faces):
            with pytest.raises(IndexError):
                ask(wrong)


def test_a_part_merged_by_hand_is_no_node(build_shape):
    _, h = build_shape("hand.off")
    cut = Cut.into(h, 5)
    pair = next((a, b) for a in range(5) for b in range(a) if cut.merge(a, b).node(a - 1 if b < a else a) is None)
    merged = cut.merge(*pair)
    number = next(part for part in range(len(merged)) if merged.node(part) is None)
    with pytest.raises(CutError, match=rf"cut.split\({number}\)"):
        h.faces(merged[number])
    assert set(merged.faces(number)) == {*cut.faces(pair[0]), *cut.faces(pair[1])}
    assert merged.split(number).node(number) is not None
