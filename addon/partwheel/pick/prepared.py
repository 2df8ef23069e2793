# SPDX-License-Identifier: GPL-3.0-or-later
"""What hovering, picking and drawing need of a mesh, made at its first use and kept while the mesh stays as it is."""

import bmesh
import bpy

from ..parts import session
from ..view import overlay, picking, seen

_kept = {}  # session.key(mesh) -> Prepared


class Prepared:
    """tree: a picking.FaceTree."""

    def __init__(self, obj, stamp):
        self.stamp = stamp
        self._seen = None if obj.mode == "EDIT" else seen.seen(obj)  # in Edit Mode its mesh may not be up to date
        self.tree = picking.FaceTree(obj, self._seen)
        self._hierarchy = self._parts = self._known = None
        self._asked = False

    def hierarchy(self, obj):
        """session.hierarchy(obj), asked again only when there is a new one."""
        if not self._asked or session.known(obj.data) is not self._known:
            self._hierarchy, self._asked, self._parts = session.hierarchy(obj), True, None
            self._known = session.known(obj.data)
        return self._hierarchy

    def parts(self, obj):
        """An overlay.Parts, or None without a hierarchy."""
        hierarchy = self.hierarchy(obj)
        if hierarchy and not self._parts:
            self._parts = overlay.Parts(self._seen or seen.seen(obj), hierarchy)
        return self._parts


def prepared(obj):
    """The Prepared of the object's mesh as it is now, as far as Blender has told of changes."""
    stamp, key = _stamp(obj), session.key(obj.data)
    if key not in _kept or _kept[key].stamp != stamp:
        for gone in _kept.keys() - {session.key(mesh) for mesh in bpy.data.meshes}:
            del _kept[gone]
        _kept[key] = Prepared(obj, stamp)
    return _kept[key]


def current(obj, parts):
    """Whether these parts are of the object's mesh as it is now. Makes nothing, so it may be asked while Blender draws.
    """
    kept = _kept.get(session.key(obj.data))
    return kept is not None and kept._parts is parts and kept.stamp == _stamp(obj)


def _stamp(obj):
    return obj.name_full, obj.mode, session.revision(obj.data), _counts(obj)


def _counts(obj):
    if obj.mode == "EDIT":
        bm = bmesh.from_edit_mesh(obj.data)
        return len(bm.verts), len(bm.faces)
    return len(obj.data.vertices), len(obj.data.polygons)


@bpy.app.handlers.persistent
def _after_loading(*_):
    _kept.clear()


def register():
    bpy.app.handlers.load_post.append(_after_loading)


def unregister():
    bpy.app.handlers.load_post.remove(_after_loading)
    _kept.clear()
