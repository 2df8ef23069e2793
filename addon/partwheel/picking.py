# SPDX-License-Identifier: GPL-3.0-or-later
"""The face of an edited mesh under the mouse: a ray against the cage, hidden faces left out."""

import bmesh
from bpy_extras.view3d_utils import region_2d_to_origin_3d, region_2d_to_vector_3d
from mathutils.bvhtree import BVHTree


class Picker:
    """Finds faces of meshes in Edit Mode. Builds a search tree for each mesh at its first use and keeps it: make a new
    Picker when geometry or hidden faces may have changed."""

    def __init__(self):
        self._trees = {}

    def face_under(self, obj, region, view, point):
        """(face index, distance along the ray in world units), or None. obj: in Edit Mode. view: a RegionView3D.
        point: (x, y) in pixels of the region."""
        tree, indices = self._tree(obj)
        to_local = obj.matrix_world.inverted_safe()
        origin = region_2d_to_origin_3d(region, view, point)
        direction = region_2d_to_vector_3d(region, view, point)
        hit, _, index, _ = tree.ray_cast(to_local @ origin, to_local.to_3x3() @ direction)
        if index is None:
            return None
        return indices[index] if indices else index, (obj.matrix_world @ hit - origin).length

    def _tree(self, obj):
        """(BVH of the visible faces, their indices in the mesh or None when none is hidden)."""
        if obj.name_full not in self._trees:
            self._trees[obj.name_full] = _visible_tree(bmesh.from_edit_mesh(obj.data))
        return self._trees[obj.name_full]


def _visible_tree(bm):
    bm.faces.index_update()
    hidden = [face.index for face in bm.faces if face.hide]
    if not hidden:
        return BVHTree.FromBMesh(bm), None
    visible = bm.copy()
    visible.faces.ensure_lookup_table()
    indices = [face.index for face in bm.faces if not face.hide]
    bmesh.ops.delete(visible, geom=[visible.faces[index] for index in hidden], context="FACES_ONLY")
    visible.faces.index_update()
    tree = BVHTree.FromBMesh(visible)
    visible.free()
    return tree, indices


def view_under(window, x, y):
    """(area, region, RegionView3D) of the 3D view at a window's pixel, or None; a panel lying over the view counts as
    not the view."""
    for area in window.screen.areas:
        if area.type != "VIEW_3D" or not _holds(area, x, y):
            continue
        regions = [region for region in area.regions if region.width > 1 and region.height > 1 and _holds(region, x, y)]
        if len(regions) != 1 or regions[0].type != "WINDOW":
            return None
        space, windows = area.spaces.active, [region for region in area.regions if region.type == "WINDOW"]
        views = list(space.region_quadviews) or [space.region_3d]  # four in quad view, in the order of the regions
        return area, regions[0], views[windows.index(regions[0])]
    return None


def _holds(box, x, y):
    return box.x <= x < box.x + box.width and box.y <= y < box.y + box.height
