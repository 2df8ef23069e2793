# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects made of parts (the paper, section 4.2): copied and split off. In Object Mode; the caller looks after undo."""

import bpy
import numpy as np
from mathutils import Vector

from ..mesh import arrays
from ..pick import borders
from . import solids


def copied(obj, hierarchy, node, options=solids.Options(), snap=False, collection=None):
    """A new object with the part as a closed mesh, in the place of the part; beside the object, or in a collection. snap:
    with its border in creases, as far as the tetrahedra about it let it be there."""
    update_matrices()
    first, last = _slice(hierarchy, node)
    mesh = solids.part(obj, hierarchy, first, last, options, moved_faces(obj, hierarchy, node, snap))
    return beside(obj, mesh, f"{obj.name} part", collection)


def removed(obj, hierarchy, node, options=solids.Options(), snap=False):
    """Takes the part, as copied() makes it, out of the object's mesh and closes the hole."""
    first, last = _slice(hierarchy, node)
    solids.remove(obj, hierarchy, first, last, options, moved_faces(obj, hierarchy, node, snap))


def rest(obj, hierarchy, node, snap=False):
    """A new mesh: the object's without the part, as removed() leaves it, but for what has no face."""
    solids.check_resolution(obj)
    first, last = _slice(hierarchy, node)
    return solids.part(obj, hierarchy, last, first, faces=moved_faces(obj, hierarchy, node, snap))


def split(obj, hierarchy, bounds, options=solids.Options(), explode=0.0):
    """New objects in a new collection: the parts of a cut as closed meshes, those without faces left out. Each is moved
    away from the middle of the object's bounding box by explode times its distance to it."""
    update_matrices()
    middle = sum((Vector(corner) for corner in obj.bound_box), Vector()) / 8
    made = []
    meshes = solids.parts(obj, hierarchy, list(zip(bounds.tolist(), bounds[1:].tolist())), options)
    collection = bpy.data.collections.new(f"{obj.name} parts")
    home(obj).children.link(collection)
    for mesh in filter(None, meshes):
        part = beside(obj, mesh, f"{obj.name} part", collection)
        corners = arrays.read(mesh.vertices, "co", np.float32, 3)
        away = Vector((corners.min(axis=0) + corners.max(axis=0)) / 2) - middle
        part.matrix_world.translation += obj.matrix_world.to_3x3() @ away * explode
        made.append(part)
    return made


def update_matrices():
    """Afterwards each object's matrix_world fits its location, rotation and scale. Blender 5 forgets the matrices at
    undo, and repeats an operator with other options right after that."""
    bpy.context.view_layer.update()


def home(obj):
    """The collection that new objects beside this one go to."""
    return obj.users_collection[0] if obj.users_collection else bpy.context.scene.collection


def moved_faces(obj, hierarchy, node, snap):
    """(F,) bool: the faces of a node with its border in creases; None for its own: if not snap, or if it has none."""
    return borders.inside(obj, hierarchy, node) if snap and len(hierarchy.faces(node)) else None


def _slice(hierarchy, node):
    return int(hierarchy.tet_first[node]), int(hierarchy.tet_last[node])


def beside(obj, mesh, name, collection=None):
    """A new object with this mesh in the object's place; beside it, or in a collection."""
    new = bpy.data.objects.new(name, mesh)
    (collection or home(obj)).objects.link(new)
    new.matrix_world = obj.matrix_world
    return new
