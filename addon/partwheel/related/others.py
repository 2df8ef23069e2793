# SPDX-License-Identifier: GPL-3.0-or-later
"""From a part to others of its mesh: those that are alike, and the one on the other side. Found once and kept, for the
wheel and the panel of the last operation ask again."""

from ..mesh import arrays
from ..mesh.refusing import Refused
from ..parts import registry
from partwheel import likeness

_last = [None, None]  # ((what was asked for, the mesh's Fingerprint, its hierarchy, the node), the answer)


def alike(obj, hierarchy, node):
    """[(node, likeness), ...] of all the others, the most alike first: see partwheel.likeness.similar. The hierarchy is
    what registry.hierarchy(obj) said."""
    return _found("alike", obj, hierarchy, node, lambda surface: likeness.similar(
        hierarchy, likeness.measures(hierarchy, *surface[:3]), node))


def images(obj, hierarchy, node):
    """[partwheel.likeness.Image, ...], one for each plane of symmetry, the model's best first. Raises Refused for none.
    """
    found = _found("images", obj, hierarchy, node, lambda surface: likeness.mirrored(hierarchy, *surface[:3], node))
    if not found:
        raise Refused("The part has no mirror image in {name}: it lies across the plane of symmetry, or the model "
                      "is not the same on both sides.", name=obj.name)
    return found


def _found(what, obj, hierarchy, node, find):
    asked = what, registry.entry_of(obj.data).seen, hierarchy, node
    if _last[0] != asked:
        _last[:] = asked, find(arrays.surface(obj.data))
    return _last[1]


def unregister():
    _last[:] = None, None
