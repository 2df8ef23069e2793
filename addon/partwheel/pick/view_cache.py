# SPDX-License-Identifier: GPL-3.0-or-later
"""Caches what hovering, picking and drawing need of a mesh while it does not change. For hovering it is prepared in
slices, so that the window never blocks for long.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
import contextlib
import functools

import bpy

from ..mesh import arrays
from ..mesh.mesh_identity import element_counts, find_object
from ..mesh.mesh_state import find_deleted, get_mesh_state
from ..parts import registry
from ..view import overlay, picking, visible_surface
from partwheel import Hierarchy

_timers = {}  # full name of an object -> function of the timer


class ViewCache:
    """Cached data of an object's mesh at a stamp: the visible surface, and on demand ray caster, hierarchy and
    triangles."""

    def __init__(self, obj: bpy.types.Object, stamp: tuple) -> None:
        self.stamp = stamp
        arrays.update_mesh(obj)
        self._surface = visible_surface.compute_visible_surface(obj)
        self._ray_caster = self._hierarchy = self._part_triangles = self._found_hierarchy = None
        self._has_looked_up = False

    def get_ray_caster(self, obj: bpy.types.Object) -> picking.FaceRayCaster:
        """Return the FaceRayCaster, created at its first use."""
        self._ray_caster = self._ray_caster or picking.FaceRayCaster(obj, self._surface)
        return self._ray_caster

    def get_hierarchy(self, obj: bpy.types.Object) -> Hierarchy | None:
        """Return registry.get_hierarchy(obj), cached until the mesh has a new one."""
        if not self._has_looked_up or registry.find_hierarchy(obj.data) is not self._found_hierarchy:
            self._hierarchy, self._has_looked_up, self._part_triangles = registry.get_hierarchy(obj), True, None
            self._found_hierarchy = registry.find_hierarchy(obj.data)
        return self._hierarchy

    def get_part_triangles(self, obj: bpy.types.Object) -> overlay.PartTriangles | None:
        """Return the overlay.PartTriangles, or None without a hierarchy."""
        hierarchy = self.get_hierarchy(obj)
        if hierarchy and not self._part_triangles:
            self._part_triangles = overlay.PartTriangles(self._surface, hierarchy)
        return self._part_triangles

    @property
    def is_complete(self) -> bool:
        """Whether prepare_next() has nothing left to do."""
        is_drawable = not self._hierarchy or self._part_triangles is not None and self._part_triangles.is_complete
        return self._ray_caster is not None and self._has_looked_up and is_drawable

    def prepare_next(self, obj: bpy.types.Object) -> None:
        """Prepare the next slice of what hovering needs."""
        if not self._ray_caster:
            self.get_ray_caster(obj)
        elif not self._has_looked_up:
            self.get_hierarchy(obj)
        elif not self._part_triangles:
            self.get_part_triangles(obj)
        else:
            self._part_triangles.prepare_next()


def prepare_next_slice(objects: Iterable[bpy.types.Object]) -> bool:
    """Prepare the next slice for the objects in Edit Mode, and return whether there was one.

    Writing Blender's edits back takes longest and is a slice of its own.
    """
    edited = [obj for obj in objects if obj.mode == "EDIT"]
    for obj in edited:
        if not _is_written_back(obj):
            arrays.update_mesh(obj)
            state = get_mesh_state(obj.data)
            state.written_revision = state.update_revision
            return True
    incomplete = next((obj for obj in edited if not _is_complete(obj)), None)
    if incomplete:
        with arrays.use_snapshot():
            arrays.mark_up_to_date(incomplete)
            _prepare_slice(incomplete)
    return incomplete is not None


def _prepare_slice(obj: bpy.types.Object) -> None:
    """Prepare the next slice for an object: first its visible surface, then what depends on it."""
    cache = get_mesh_state(obj.data).view_cache
    if cache and cache.stamp == _compute_stamp(obj):
        cache.prepare_next(obj)
    else:
        get_view_cache(obj)


def mark_written_meshes(objects: Iterable[bpy.types.Object]) -> None:
    """Within arrays.use_snapshot(): mark meshes as up to date whose edits hovering has written back, if Blender has
    reported no update since.
    """
    for obj in objects:
        if obj.mode == "EDIT" and _is_written_back(obj):
            arrays.mark_up_to_date(obj)


def _is_written_back(obj: bpy.types.Object) -> bool:
    state = get_mesh_state(obj.data)
    return state.written_revision == state.update_revision


def _is_complete(obj: bpy.types.Object) -> bool:
    cache = get_mesh_state(obj.data).view_cache
    return cache is not None and cache.stamp == _compute_stamp(obj) and cache.is_complete


@contextlib.contextmanager
def keep_view_cache(obj: bpy.types.Object) -> Iterator[None]:
    """Keep the cache valid within, although Blender reports updates: only the selection changes."""
    cache = get_mesh_state(obj.data).view_cache
    fits = cache and cache.stamp == _compute_stamp(obj)
    yield
    if fits:
        cache.stamp = _compute_stamp(obj)


def get_view_cache(obj: bpy.types.Object) -> ViewCache:
    """Return the ViewCache of the object's mesh, as far as Blender has reported changes."""
    stamp, state = _compute_stamp(obj), get_mesh_state(obj.data)
    if not state.view_cache or state.view_cache.stamp != stamp:
        for deleted in find_deleted():
            deleted.view_cache = None
        state.view_cache = ViewCache(obj, stamp)
    return state.view_cache


def get_ready_cache(obj: bpy.types.Object) -> ViewCache | None:
    """Return the same for gizmos, during which Blender must not be given new data.

    Outside Edit Mode None until it is complete; a timer prepares it.
    """
    if obj.mode == "EDIT" or _is_complete(obj):
        return get_view_cache(obj)
    if obj.name_full not in _timers:
        _timers[obj.name_full] = functools.partial(_prepare_in_timer, obj.name_full)
        bpy.app.timers.register(_timers[obj.name_full])
    return None


def _prepare_in_timer(name: str) -> float | None:
    """Prepare a slice. Return the seconds until the next one, or None at the end."""
    obj = find_object(name)
    if obj and is_at_rest() and not _is_complete(obj):
        _prepare_slice(obj)
        return 0
    _timers.pop(name)
    return None


def is_at_rest() -> bool:
    """Return whether neither playback nor a render runs. Each frame would invalidate the cache, or change data
    meanwhile."""
    playing = any(window.screen.is_animation_playing for window in bpy.context.window_manager.windows)
    return not (playing or bpy.app.is_job_running("RENDER"))


def stop_timers() -> None:
    """Stop preparing."""
    for make in _timers.values():
        if bpy.app.timers.is_registered(make):
            bpy.app.timers.unregister(make)
    _timers.clear()


def is_current(obj: bpy.types.Object, parts: overlay.PartTriangles) -> bool:
    """Return whether parts belong to the object's current mesh. Creates nothing, so it may be called while Blender
    draws."""
    cache = get_mesh_state(obj.data).view_cache
    return cache is not None and cache._part_triangles is parts and cache.stamp == _compute_stamp(obj)


def _compute_stamp(obj: bpy.types.Object) -> tuple:
    """Return what a ViewCache depends on. Each view layer of each scene has an evaluation and a frame of its own."""
    layer = bpy.context.view_layer
    evaluation = layer.id_data.name_full, layer.name
    return obj.name_full, obj.mode, evaluation, get_mesh_state(obj.data).revision, element_counts(obj.data)
