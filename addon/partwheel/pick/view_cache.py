# SPDX-License-Identifier: GPL-3.0-or-later
"""What hovering, picking and drawing need of a mesh, made at its first use and kept while the mesh stays as it is; for
hovering slice by slice, so that the window is never held up for long."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
import contextlib
import functools

import bpy

from ..mesh import arrays
from ..mesh.mesh_identity import MeshTable, element_counts, mesh_key, find_object
from ..parts import changes, registry
from ..view import overlay, picking, visible_surface
from partwheel import Hierarchy

_caches = MeshTable()  # Prepared
_written_revisions = MeshTable()  # what changes.update_revision() said when Blender had written its edits back
_timers = {}  # full name of an object -> the timer that makes its Prepared


class ViewCache:
    """Of an object's mesh as it was at this stamp. Making it reads what is seen; the rest follows when it is asked
    for."""

    def __init__(self, obj: bpy.types.Object, stamp: tuple) -> None:
        self.stamp = stamp
        arrays.update_mesh(obj)
        self._surface = visible_surface.compute_visible_surface(obj)
        self._ray_caster = self._hierarchy = self._part_triangles = self._known = None
        self._asked = False

    def get_ray_caster(self, obj: bpy.types.Object) -> picking.FaceRayCaster:
        """A picking.FaceRayCaster: made when it is asked for, which nobody does who has a face."""
        self._ray_caster = self._ray_caster or picking.FaceRayCaster(obj, self._surface)
        return self._ray_caster

    def get_hierarchy(self, obj: bpy.types.Object) -> Hierarchy | None:
        """registry.get_hierarchy(obj), asked again only when there is a new one."""
        if not self._asked or registry.find_hierarchy(obj.data) is not self._known:
            self._hierarchy, self._asked, self._part_triangles = registry.get_hierarchy(obj), True, None
            self._known = registry.find_hierarchy(obj.data)
        return self._hierarchy

    def get_part_triangles(self, obj: bpy.types.Object) -> overlay.PartTriangles | None:
        """An overlay.PartTriangles, or None without a hierarchy."""
        hierarchy = self.get_hierarchy(obj)
        if hierarchy and not self._part_triangles:
            self._part_triangles = overlay.PartTriangles(self._surface, hierarchy)
        return self._part_triangles

    @property
    def is_complete(self) -> bool:
        """Whether advance() has nothing left to do."""
        drawn = not self._hierarchy or self._part_triangles is not None and self._part_triangles.is_complete
        return self._ray_caster is not None and self._asked and drawn

    def prepare_next(self, obj: bpy.types.Object) -> None:
        """Makes the next slice of what hovering needs."""
        if not self._ray_caster:
            self.get_ray_caster(obj)
        elif not self._asked:
            self.get_hierarchy(obj)
        elif not self._part_triangles:
            self.get_part_triangles(obj)
        else:
            self._part_triangles.prepare_next()


def prepare_next_slice(objects: Iterable[bpy.types.Object]) -> bool:
    """Makes the next slice of what hovering lacks of those that are in Edit Mode; whether there was one. Blender
    writing its edits back, which takes longest, is a slice of its own."""
    edited = [obj for obj in objects if obj.mode == "EDIT"]
    for obj in edited:
        if not _is_written_back(obj):
            arrays.update_mesh(obj)
            _written_revisions[mesh_key(obj.data)] = changes.update_revision(obj.data)
            return True
    lacking = next((obj for obj in edited if not _is_complete(obj)), None)
    if lacking:
        with arrays.use_snapshot():
            arrays.mark_up_to_date(lacking)
            _prepare_slice(lacking)
    return lacking is not None


def _prepare_slice(obj: bpy.types.Object) -> None:
    """The next one: what is seen of the object to begin with, and then what is made of that."""
    kept = _caches.get(mesh_key(obj.data))
    if kept and kept.stamp == _compute_stamp(obj):
        kept.prepare_next(obj)
    else:
        get_view_cache(obj)


def mark_written_meshes(objects: Iterable[bpy.types.Object]) -> None:
    """Within arrays.use_snapshot(): Blender has nothing to write back of those of which it told nothing since
    hovering."""
    for obj in objects:
        if obj.mode == "EDIT" and _is_written_back(obj):
            arrays.mark_up_to_date(obj)


def _is_written_back(obj: bpy.types.Object) -> bool:
    return _written_revisions.get(mesh_key(obj.data)) == changes.update_revision(obj.data)


def _is_complete(obj: bpy.types.Object) -> bool:
    kept = _caches.get(mesh_key(obj.data))
    return kept is not None and kept.stamp == _compute_stamp(obj) and kept.is_complete


@contextlib.contextmanager
def keep_view_cache(obj: bpy.types.Object) -> Iterator[None]:
    """What Blender tells of the object's mesh within it is no more than a selection: what is made stays."""
    kept = _caches.get(mesh_key(obj.data))
    fits = kept and kept.stamp == _compute_stamp(obj)
    yield
    if fits:
        kept.stamp = _compute_stamp(obj)


def get_view_cache(obj: bpy.types.Object) -> ViewCache:
    """The Prepared of the object's mesh as it is now, as far as Blender has told of changes."""
    stamp, kept = _compute_stamp(obj), _caches.get(mesh_key(obj.data))
    if not kept or kept.stamp != stamp:
        _caches.remove_deleted()
        kept = _caches[mesh_key(obj.data)] = ViewCache(obj, stamp)
    return kept


def get_ready_cache(obj: bpy.types.Object) -> ViewCache | None:
    """The same for gizmos, while Blender asks which it must not be given new data: outside Edit Mode None as long as it
    isn't there, and then it will be soon."""
    if obj.mode == "EDIT" or _is_complete(obj):
        return get_view_cache(obj)
    if obj.name_full not in _timers:
        _timers[obj.name_full] = functools.partial(_prepare_in_timer, obj.name_full)
        bpy.app.timers.register(_timers[obj.name_full])
    return None


def _prepare_in_timer(name: str) -> float | None:
    """A slice of it; what a timer waits for until the next, or None."""
    obj = find_object(name)
    if obj and is_at_rest() and not _is_complete(obj):
        _prepare_slice(obj)
        return 0
    _timers.pop(name)
    return None


def is_at_rest() -> bool:
    """Whether neither playback nor a render goes on: each frame would have all made anew, or find Blender's data
    changing."""
    playing = any(window.screen.is_animation_playing for window in bpy.context.window_manager.windows)
    return not (playing or bpy.app.is_job_running("RENDER"))


def stop_timers() -> None:
    """Makes none any more."""
    for make in _timers.values():
        if bpy.app.timers.is_registered(make):
            bpy.app.timers.unregister(make)
    _timers.clear()


def is_current(obj: bpy.types.Object, parts: overlay.PartTriangles) -> bool:
    """Whether these parts are of the object's mesh as it is now. Makes nothing, so it may be asked while Blender draws.
    """
    kept = _caches.get(mesh_key(obj.data))
    return kept is not None and kept._part_triangles is parts and kept.stamp == _compute_stamp(obj)


def _compute_stamp(obj: bpy.types.Object) -> tuple:
    """Each view layer of each scene is evaluated by itself, with a frame of its own."""
    layer = bpy.context.view_layer
    evaluation = layer.id_data.name_full, layer.name
    return obj.name_full, obj.mode, evaluation, changes.revision(obj.data), element_counts(obj.data)
