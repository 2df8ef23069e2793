# SPDX-License-Identifier: GPL-3.0-or-later
"""Ray casts against what a 3D view shows.

Hidden, clipped, and locally invisible objects are skipped. What modifiers show leads to the mesh's own faces."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import bpy
from bpy_extras.view3d_utils import region_2d_to_origin_3d, region_2d_to_vector_3d
from mathutils import Matrix, Vector

from partwheel import RayTarget
from ..preferences import preferences
from .visible_surface import VisibleSurface

CLIPPED_STEP = 1e-5  # behind a clipped face, where the search continues: fraction of the distance
HIDDEN_STEP = 1e-6  # behind a hidden face: fraction of the coordinates, which have 24 bits


class FaceHit(NamedTuple):
    """A face at a point of a view."""

    obj: bpy.types.Object
    face: int  # NO_FACE if modifiers have generated it
    distance: float  # along the ray, in world units
    view_size: float  # see measure_view()


class FaceRayCaster:
    """Casts rays against the visible faces of an object."""

    def __init__(self, surface: VisibleSurface) -> None:
        self._faces, self._target = surface.faces, RayTarget(surface.positions, surface.triangles)

    def cast(self, obj: bpy.types.Object, matrix: Matrix, region: bpy.types.Region, view: bpy.types.RegionView3D,
             point: tuple) -> FaceHit | None:
        """Return the first FaceHit of the object at a point of the region, or None. matrix: of the object, or of its
        instance, to the world."""
        to_local = matrix.inverted_safe()
        eye = region_2d_to_origin_3d(region, view, point)
        origin, towards = to_local @ eye, to_local.to_3x3() @ region_2d_to_vector_3d(region, view, point)
        hit = self._target.first_hit(origin, towards)
        while hit:
            triangle, distance = hit
            place = matrix @ (origin + distance * towards)
            if not is_clipped(view, place):
                return FaceHit(obj, int(self._faces[triangle]), (place - eye).length, measure_view(matrix, view, place))
            hit = self._target.first_hit(origin, towards, distance * (1 + CLIPPED_STEP))
        return None


def measure_view(matrix: Matrix, view: bpy.types.RegionView3D, place: Sequence[float]) -> float:
    """Return what fits into the smaller side of the region at the depth of a point of the world, in the units of the
    object with this matrix to the world; 0 if the preferences say that it does not count."""
    if not preferences().use_view:
        return 0.0
    depth = (view.perspective_matrix @ Vector((*place, 1.0))).w  # 1 in orthographic views
    across = 2 * depth / max(abs(view.window_matrix[side][side]) for side in (0, 1))
    scale = abs(matrix.to_3x3().determinant()) ** (1 / 3)
    return across / scale if scale > 0 else 0.0


def is_clipped(view: bpy.types.RegionView3D, point: Sequence[float]) -> bool:
    """Return whether the view's clipping region (Alt B) excludes a point of the world."""
    return view.use_clip_planes and any(Vector(plane).dot((*point, 1.0)) < 0 for plane in list(view.clip_planes)[:4])


class SurfaceHit(NamedTuple):
    """A point on a surface, in the world. normal: toward the eye. matrix: of obj, or of its instance, to the world."""

    location: Vector
    normal: Vector
    obj: bpy.types.Object
    matrix: Matrix


def find_surface_under(context: bpy.types.Context, area: bpy.types.Area, region: bpy.types.Region,
                       view: bpy.types.RegionView3D, point: tuple,
                       is_candidate: Callable[[bpy.types.Object], bool] = lambda obj: True) -> SurfaceHit | None:
    """Return the SurfaceHit that a 3D view shows at a point of its region, or None. is_candidate(object): False to look
    through the object."""
    depsgraph = context.evaluated_depsgraph_get()
    origin = region_2d_to_origin_3d(region, view, point)
    towards = region_2d_to_vector_3d(region, view, point)
    while True:
        has_hit, location, normal, _, obj, matrix = context.scene.ray_cast(depsgraph, origin, towards)
        if not has_hit:
            return None
        obj = obj.original
        if (is_candidate(obj) and not is_clipped(view, location)
                and _is_shown(area.spaces.active, depsgraph, obj, matrix)):
            return SurfaceHit(location, -normal if normal.dot(towards) > 0 else normal, obj, matrix)
        origin = location + towards * HIDDEN_STEP * max(location.length, origin.length)


def _is_shown(space: bpy.types.SpaceView3D, depsgraph: bpy.types.Depsgraph, obj: bpy.types.Object,
              matrix: Matrix) -> bool:
    """Return whether a 3D view shows the object, or an instance with this matrix, which scene.ray_cast() ignores."""
    if obj.evaluated_get(depsgraph).matrix_world == matrix and obj.visible_get(viewport=space):
        return True
    return any(instance.is_instance and instance.object.original == obj and instance.matrix_world == matrix
               and instance.parent.original.visible_get(viewport=space) for instance in depsgraph.object_instances)


def find_view_under_mouse(context: bpy.types.Context, event: bpy.types.Event) -> tuple | None:
    """Return (area, region, RegionView3D, point of the region) of the 3D view under the mouse, or None."""
    return find_view_at(context.window, event.mouse_x, event.mouse_y) if context.window else None


def find_view_at(window: bpy.types.Window, x: int, y: int) -> tuple | None:
    """Return find_view_under_mouse() for a pixel of a window; None if a panel covers the view there."""
    for area in window.screen.areas:
        if area.type != "VIEW_3D" or not _contains_point(area, x, y):
            continue
        regions = [region for region in area.regions
                   if region.width > 1 and region.height > 1 and _contains_point(region, x, y)]
        if len(regions) != 1 or regions[0].type != "WINDOW":
            return None
        return area, regions[0], get_region_view(area, regions[0]), (x - regions[0].x, y - regions[0].y)
    return None


def get_region_view(area: bpy.types.Area, region: bpy.types.Region) -> bpy.types.RegionView3D:
    """Return the RegionView3D of a region of type WINDOW."""
    space, windows = area.spaces.active, [other for other in area.regions if other.type == "WINDOW"]
    views = list(space.region_quadviews) or [space.region_3d]  # four in quad view, in the order of regions
    return views[windows.index(region)]


def _contains_point(box: bpy.types.Area | bpy.types.Region, x: int, y: int) -> bool:
    return box.x <= x < box.x + box.width and box.y <= y < box.y + box.height
