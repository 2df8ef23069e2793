# SPDX-License-Identifier: GPL-3.0-or-later
"""What hovering, picking and drawing need of a mesh, made at its first use and kept while the mesh stays as it is."""

import functools

import bpy

from ..mesh import arrays
from ..mesh.kept import PerMesh, counts, key, named
from ..parts import changes, registry
from ..view import overlay, picking, seen

_kept = PerMesh()  # Prepared
_soon = {}  # full name of an object -> the timer that makes its Prepared


class Prepared:
    def __init__(self, obj, stamp):
        self.stamp = stamp
        arrays.up_to_date(obj)
        self._seen = seen.seen(obj)
        self._tree = self._hierarchy = self._parts = self._known = None
        self._asked = False

    def tree(self, obj):
        """A picking.FaceTree: made when it is asked for, which nobody does who has a face."""
        self._tree = self._tree or picking.FaceTree(obj, self._seen)
        return self._tree

    def hierarchy(self, obj):
        """registry.hierarchy(obj), asked again only when there is a new one."""
        if not self._asked or registry.known(obj.data) is not self._known:
            self._hierarchy, self._asked, self._parts = registry.hierarchy(obj), True, None
            self._known = registry.known(obj.data)
        return self._hierarchy

    def parts(self, obj):
        """An overlay.Parts, or None without a hierarchy."""
        hierarchy = self.hierarchy(obj)
        if hierarchy and not self._parts:
            self._parts = overlay.Parts(self._seen, hierarchy)
        return self._parts


def lacking(objects):
    """Of these in Edit Mode those that must be looked at anew, with what tells that they are as they are now."""
    return {obj: _stamp(obj) for obj in objects if obj.mode == "EDIT"
            and not ((kept := _kept.get(key(obj.data))) and kept.stamp == _stamp(obj))}


def prepared(obj):
    """The Prepared of the object's mesh as it is now, as far as Blender has told of changes."""
    stamp, kept = _stamp(obj), _kept.get(key(obj.data))
    if not kept or kept.stamp != stamp:
        _kept.drop_gone()
        kept = _kept[key(obj.data)] = Prepared(obj, stamp)
    return kept


def ready(obj):
    """The same for gizmos, while Blender asks which it must not be given new data: outside Edit Mode None as long as it
    isn't there, and then it will be soon."""
    kept = _kept.get(key(obj.data))
    if obj.mode == "EDIT" or kept and kept.stamp == _stamp(obj):
        return prepared(obj)
    if obj.name_full not in _soon:
        _soon[obj.name_full] = functools.partial(_make, obj.name_full)
        bpy.app.timers.register(_soon[obj.name_full])
    return None


def _make(name):
    _soon.pop(name)
    obj = named(name)
    if obj:
        prepared(obj)


def stop():
    """Makes none any more."""
    for make in _soon.values():
        if bpy.app.timers.is_registered(make):
            bpy.app.timers.unregister(make)
    _soon.clear()


def current(obj, parts):
    """Whether these parts are of the object's mesh as it is now. Makes nothing, so it may be asked while Blender draws.
    """
    kept = _kept.get(key(obj.data))
    return kept is not None and kept._parts is parts and kept.stamp == _stamp(obj)


def _stamp(obj):
    return obj.name_full, obj.mode, changes.revision(obj.data), counts(obj.data)
