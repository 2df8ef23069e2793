# SPDX-License-Identifier: GPL-3.0-or-later
"""Caches what hovering, picking and drawing need of a mesh while it does not change. For hovering it is prepared in
slices, so that the window never blocks for long."""

from collections.abc import Iterable, Iterator
import contextlib
import functools

import bpy

from ..mesh import MeshSnapshot, element_counts, find_deleted, find_object
from ..parts import registry
from ..view import overlay, picking, visible_surface
from partwheel import Hierarchy

_timers = {}  # full name of an object -> function of the timer


class ViewCache:
    """Cached data of a mesh at a stamp: the visible surface; on demand ray caster, hierarchy and triangles."""

    def __init__(self, snapshot: MeshSnapshot, stamp: tuple) -> None:
        self.stamp = stamp
        snapshot.update_mesh()
        self._surface = visible_surface.compute_visible_surface(snapshot.obj)
        self._ray_caster = self._hierarchy = self._part_triangles = self._found_hierarchy = None
        self._has_looked_up = False

    def get_ray_caster(self) -> picking.FaceRayCaster:
        self._ray_caster = self._ray_caster or picking.FaceRayCaster(self._surface)
        return self._ray_caster

    def get_hierarchy(self, snapshot: MeshSnapshot) -> Hierarchy | None:
        """Return registry.get_hierarchy(snapshot), cached until the mesh has a new one."""
        if not self._has_looked_up or registry.find_hierarchy(snapshot.mesh) is not self._found_hierarchy:
            self._hierarchy, self._has_looked_up, self._part_triangles = registry.get_hierarchy(snapshot), True, None
            self._found_hierarchy = registry.find_hierarchy(snapshot.mesh)
        return self._hierarchy

    def get_part_triangles(self, snapshot: MeshSnapshot) -> overlay.PartTriangles | None:
        """Return the overlay.PartTriangles, or None without a hierarchy."""
        hierarchy = self.get_hierarchy(snapshot)
        if hierarchy and not self._part_triangles:
            self._part_triangles = overlay.PartTriangles(self._surface, hierarchy)
        return self._part_triangles

    @property
    def is_complete(self) -> bool:
        """Whether prepare_next() has nothing left to do."""
        is_drawable = not self._hierarchy or self._part_triangles is not None and self._part_triangles.is_complete
        return self._ray_caster is not None and self._has_looked_up and is_drawable

    def prepare_next(self, snapshot: MeshSnapshot) -> None:
        """Prepare the next slice of what hovering needs."""
        if not self._ray_caster:
            self.get_ray_caster()
        elif not self._has_looked_up:
            self.get_hierarchy(snapshot)
        elif not self._part_triangles:
            self.get_part_triangles(snapshot)
        else:
            self._part_triangles.prepare_next()


def prepare_next_slice(objects: Iterable[bpy.types.Object]) -> bool:
    """Prepare the next slice for the objects in Edit Mode, and return whether there was one. Writing Blender's edits
    back takes longest and is a slice of its own."""
    edited = [MeshSnapshot(obj, trust_reports=True) for obj in objects if obj.mode == "EDIT"]
    for snapshot in edited:
        if not snapshot.is_up_to_date:
            snapshot.update_mesh()
            return True
    incomplete = next((snapshot for snapshot in edited if not _is_cache_complete(snapshot)), None)
    if incomplete:
        _prepare_slice(incomplete)
    return incomplete is not None


def _prepare_slice(snapshot: MeshSnapshot) -> None:
    """Prepare the next slice for an object: first its visible surface, then what depends on it."""
    if _is_cache_current(snapshot):
        snapshot.state.view_cache.prepare_next(snapshot)
    else:
        get_view_cache(snapshot)


def _is_cache_current(snapshot: MeshSnapshot) -> bool:
    cache = snapshot.state.view_cache
    return cache is not None and cache.stamp == _compute_stamp(snapshot)


def _is_cache_complete(snapshot: MeshSnapshot) -> bool:
    return _is_cache_current(snapshot) and snapshot.state.view_cache.is_complete


@contextlib.contextmanager
def keep_view_cache(snapshot: MeshSnapshot) -> Iterator[None]:
    """Keep the cache valid within, although Blender reports updates: only the selection changes."""
    cache = snapshot.state.view_cache if _is_cache_current(snapshot) else None
    yield
    if cache:
        cache.stamp = _compute_stamp(snapshot)


def get_view_cache(snapshot: MeshSnapshot) -> ViewCache:
    """Return the ViewCache of the object's mesh, as far as Blender has reported changes."""
    if not _is_cache_current(snapshot):
        for deleted in find_deleted():
            deleted.view_cache = None
        snapshot.state.view_cache = ViewCache(snapshot, _compute_stamp(snapshot))
    return snapshot.state.view_cache


def get_ready_cache(snapshot: MeshSnapshot) -> ViewCache | None:
    """Return get_view_cache() for gizmos, which can't create data outside Edit Mode: None until a timer has prepared it."""
    name = snapshot.obj.name_full
    if snapshot.obj.mode == "EDIT" or _is_cache_complete(snapshot):
        return get_view_cache(snapshot)
    if name not in _timers:
        _timers[name] = functools.partial(_prepare_in_timer, name)
        bpy.app.timers.register(_timers[name])
    return None


def find_nearest_face(objects: Iterable[bpy.types.Object], region: bpy.types.Region, view: bpy.types.RegionView3D,
                      point: tuple) -> picking.FaceHit | None:
    """Return the first face at a point of the region, or None. Trusts what Blender has reported."""
    casters = [(obj, get_view_cache(MeshSnapshot(obj, trust_reports=True)).get_ray_caster()) for obj in objects]
    hits = filter(None, (caster.cast(obj, obj.matrix_world, region, view, point) for obj, caster in casters))
    return min(hits, key=lambda hit: hit.distance, default=None)


def cast_ray(cache: ViewCache, hit: picking.SurfaceHit, *view: object) -> picking.FaceHit | None:
    """Return the face of an object, or of its instance, whose surface was hit at a point of the view, or None."""
    return cache.get_ray_caster().cast(hit.obj, hit.matrix, *view)


def _prepare_in_timer(name: str) -> float | None:
    """Prepare a slice. Return the seconds until the next one, or None at the end."""
    obj = find_object(name)
    if obj and is_at_rest() and not _is_cache_complete(snapshot := MeshSnapshot(obj)):
        _prepare_slice(snapshot)
        return 0
    _timers.pop(name)
    return None


def is_at_rest() -> bool:
    """Return whether neither playback nor a render runs, which would invalidate the cache or change data."""
    playing = any(window.screen.is_animation_playing for window in bpy.context.window_manager.windows)
    return not (playing or bpy.app.is_job_running("RENDER"))


def stop_timers() -> None:
    for make in _timers.values():
        if bpy.app.timers.is_registered(make):
            bpy.app.timers.unregister(make)
    _timers.clear()


def is_current(obj: bpy.types.Object, parts: overlay.PartTriangles) -> bool:
    """Return whether parts belong to the object's current mesh. Creates nothing: also while Blender draws."""
    snapshot = MeshSnapshot(obj)
    return _is_cache_current(snapshot) and snapshot.state.view_cache._part_triangles is parts


def _compute_stamp(snapshot: MeshSnapshot) -> tuple:
    """Return what a ViewCache depends on. Each view layer of each scene has an evaluation and a frame of its own."""
    layer = bpy.context.view_layer
    evaluation = layer.id_data.name_full, layer.name
    return snapshot.obj.name_full, snapshot.obj.mode, evaluation, snapshot.state.revision, element_counts(snapshot.mesh)
