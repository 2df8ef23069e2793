# SPDX-License-Identifier: GPL-3.0-or-later
"""From a part to others: those that are alike, in its mesh and in other objects', and the one on the other side. Found
once and kept, for the wheel and the panel of the last operation ask again."""

from typing import NamedTuple

import numpy as np

from ..mesh import arrays
from ..mesh.errors import Refused
from ..parts import registry
from partwheel import likeness

_last = {}  # what was asked for -> ((the meshes' Fingerprints, their hierarchies, ...), the answer)


class Alike(NamedTuple):
    """A node of an object that is like another, by a likeness down from 1. name: the object's, in full."""

    name: str
    node: int
    likeness: float


def alike(obj, hierarchy, node, objects=()):
    """[Alike, ...] of all the others of the object, and of those of other objects that have parts, the most alike first:
    see partwheel.likeness.similar_parts. Sizes are those in the world. The hierarchy is what registry.get_hierarchy(obj) said."""
    searched = [(obj, hierarchy)] + [(other, found) for other in objects if (found := registry.get_hierarchy(other))]
    matrices = [np.array(each.matrix_world) for each, _ in searched]

    def find():
        measured = [likeness.measure_nodes(found, *arrays.read_surface(each.data)[:3], matrix)
                    for (each, found), matrix in zip(searched, matrices)]
        among = [None, *((found, those) for (_, found), those in list(zip(searched, measured))[1:])]
        found = [Alike(each.name_full, *pair) for (each, _), where in zip(searched, among)
                 for pair in likeness.similar_parts(hierarchy, measured[0], node, where)]
        return sorted(found, key=lambda each: -each.likeness)

    asked = [(each.name_full, registry.find_entry(each.data).seen, found) for each, found in searched]
    return _kept("alike", (asked, [matrix.tobytes() for matrix in matrices], node), find)


def images(obj, hierarchy, node):
    """[partwheel.likeness.MirrorImage, ...], one for each plane of symmetry, the model's best first. Raises Refused for none.
    """
    if node == len(hierarchy.parent) - 1:
        raise Refused("The part is the whole model, which has no other side. Pick a smaller one.")
    asked = registry.find_entry(obj.data).seen, hierarchy, node
    found = _kept("images", asked, lambda: likeness.mirrored_parts(hierarchy, *arrays.read_surface(obj.data)[:3], node))
    if not found:
        raise Refused("The part has no mirror image in {name}: it lies across the plane of symmetry, or the model "
                      "is not the same on both sides.", name=obj.name)
    return found


def _kept(what, asked, find):
    if what not in _last or _last[what][0] != asked:
        _last[what] = asked, find()
    return _last[what][1]


def unregister():
    _last.clear()
