# SPDX-License-Identifier: GPL-3.0-or-later
"""What hovering, picking and drawing need of a mesh, made at its first use and kept while the mesh stays as it is; for
hovering slice by slice, so that the window is never held up for long."""

import contextlib
import functools

import bpy

from ..mesh import arrays
from ..mesh.mesh_identity import MeshTable, element_counts, mesh_key, find_object
from ..parts import changes, registry
from ..view import overlay, picking, seen

_kept = MeshTable()  # Prepared
_written = MeshTable()  # what changes.told() said when Blender had written its edits back
_soon = {}  # full name of an object -> the timer that makes its Prepared


class Prepared:
    """Of an object's mesh as it was at this stamp. Making it reads what is seen; the rest follows when it is asked for."""

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

    @property
    def whole(self):
        """Whether advance() has nothing left to do."""
        drawn = not self._hierarchy or self._parts is not None and self._parts.whole
        return self._tree is not None and self._asked and drawn

    def advance(self, obj):
        """Makes the next slice of what hovering needs."""
        if not self._tree:
            self.tree(obj)
        elif not self._asked:
            self.hierarchy(obj)
        elif not self._parts:
            self.parts(obj)
        else:
            self._parts.advance()


def advance(objects):
    """Makes the next slice of what hovering lacks of those that are in Edit Mode; whether there was one. Blender writing
    its edits back, which takes longest, is a slice of its own."""
    edited = [obj for obj in objects if obj.mode == "EDIT"]
    for obj in edited:
        if not _written_back(obj):
            arrays.up_to_date(obj)
            _written[mesh_key(obj.data)] = changes.told(obj.data)
            return True
    lacking = next((obj for obj in edited if not _whole(obj)), None)
    if lacking:
        with arrays.one_reading():
            arrays.written_back(lacking)
            _slice(lacking)
    return lacking is not None


def _slice(obj):
    """The next one: what is seen of the object to begin with, and then what is made of that."""
    kept = _kept.get(mesh_key(obj.data))
    if kept and kept.stamp == _stamp(obj):
        kept.advance(obj)
    else:
        prepared(obj)


def note_written_back(objects):
    """Within arrays.one_reading(): Blender has nothing to write back of those of which it told nothing since hovering."""
    for obj in objects:
        if obj.mode == "EDIT" and _written_back(obj):
            arrays.written_back(obj)


def _written_back(obj):
    return _written.get(mesh_key(obj.data)) == changes.told(obj.data)


def _whole(obj):
    kept = _kept.get(mesh_key(obj.data))
    return kept is not None and kept.stamp == _stamp(obj) and kept.whole


@contextlib.contextmanager
def unchanged(obj):
    """What Blender tells of the object's mesh within it is no more than a selection: what is made stays."""
    kept = _kept.get(mesh_key(obj.data))
    fits = kept and kept.stamp == _stamp(obj)
    yield
    if fits:
        kept.stamp = _stamp(obj)


def prepared(obj):
    """The Prepared of the object's mesh as it is now, as far as Blender has told of changes."""
    stamp, kept = _stamp(obj), _kept.get(mesh_key(obj.data))
    if not kept or kept.stamp != stamp:
        _kept.drop_gone()
        kept = _kept[mesh_key(obj.data)] = Prepared(obj, stamp)
    return kept


def ready(obj):
    """The same for gizmos, while Blender asks which it must not be given new data: outside Edit Mode None as long as it
    isn't there, and then it will be soon."""
    if obj.mode == "EDIT" or _whole(obj):
        return prepared(obj)
    if obj.name_full not in _soon:
        _soon[obj.name_full] = functools.partial(_make, obj.name_full)
        bpy.app.timers.register(_soon[obj.name_full])
    return None


def _make(name):
    """A slice of it; what a timer waits for until the next, or None."""
    obj = find_object(name)
    if obj and at_rest() and not _whole(obj):
        _slice(obj)
        return 0
    _soon.pop(name)
    return None


def at_rest():
    """Whether neither playback nor a render goes on: each frame would have all made anew, or find Blender's data changing."""
    playing = any(window.screen.is_animation_playing for window in bpy.context.window_manager.windows)
    return not (playing or bpy.app.is_job_running("RENDER"))


def stop():
    """Makes none any more."""
    for make in _soon.values():
        if bpy.app.timers.is_registered(make):
            bpy.app.timers.unregister(make)
    _soon.clear()


def current(obj, parts):
    """Whether these parts are of the object's mesh as it is now. Makes nothing, so it may be asked while Blender draws.
    """
    kept = _kept.get(mesh_key(obj.data))
    return kept is not None and kept._parts is parts and kept.stamp == _stamp(obj)


def _stamp(obj):
    """Each view layer of each scene is evaluated by itself, with a frame of its own."""
    layer = bpy.context.view_layer
    evaluation = layer.id_data.name_full, layer.name
    return obj.name_full, obj.mode, evaluation, changes.revision(obj.data), element_counts(obj.data)
