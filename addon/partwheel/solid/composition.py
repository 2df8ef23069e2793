# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects made of parts (the paper, section 4.2): copied and split off. In Object Mode; the caller looks after undo."""

from contextlib import contextmanager

import bpy
import numpy as np
from mathutils import Vector

from ..mesh import arrays
from ..mesh.datablocks import all_or_nothing, copy_settings, own_actions, redirect_drivers
from ..mesh.errors import Refused
from ..pick import borders
from ..words.say import rpt_
from . import solids

HULL = "partwheel_hull"  # the property of objects that Convex Parts removes again: never of a copy
WHOLE = "The part is the whole model: nothing would be left without it. Pick a smaller one."
# How modifiers say that they were bound to the vertices of a mesh, as copies have no longer.
_BOUND = {"SURFACE_DEFORM": "is_bound", "MESH_DEFORM": "is_bound", "CORRECTIVE_SMOOTH": "is_bind", "LAPLACIANDEFORM": "is_bind"}


@all_or_nothing()

def copied(obj, hierarchy, node, options=solids.Options(), snap=False, collection=None):
    """A new object with the part as a closed mesh, in the place of the part; beside the object, or in a collection. snap:
    with its border in creases, as far as the tetrahedra about it let it be there."""
    update_matrices()
    return beside(obj, part_mesh(obj, hierarchy, node, options, snap), f"{obj.name} part", collection)


def part_mesh(obj, hierarchy, node, options=solids.Options(), snap=False):
    """The new mesh of such an object."""
    first, last = _slice(hierarchy, node)
    return solids.part(obj, hierarchy, first, last, options, moved_faces(obj, hierarchy, node, snap))


@all_or_nothing()
def removed(obj, hierarchy, node, options=solids.Options(), snap=False):
    """Takes the part, as copied() makes it, out of the object's mesh and closes the hole."""
    first, last = _slice(hierarchy, node)
    faces = moved_faces(obj, hierarchy, node, snap)
    check_rest(hierarchy, node, faces)
    with hooks_kept(obj):
        solids.remove(obj, hierarchy, first, last, options, faces)


def check_rest(hierarchy, node, faces=None):
    """Raises Refused if nothing of the model is left without a node. faces (F,) bool: those that it has instead."""
    count = len(hierarchy.faces(node)) if faces is None else np.count_nonzero(faces)
    if count == len(hierarchy.order):
        raise Refused(WHOLE)


def rest(obj, hierarchy, node, snap=False):
    """A new mesh: the object's without the part, as removed() leaves it, but for what has no face."""
    solids.check_resolution(obj)
    first, last = _slice(hierarchy, node)
    faces = moved_faces(obj, hierarchy, node, snap)
    check_rest(hierarchy, node, faces)
    return solids.part(obj, hierarchy, last, first, faces=faces)


@all_or_nothing()
def split(obj, hierarchy, bounds, options=solids.Options(), explode=0.0):
    """New objects in a new collection: the parts of a cut as closed meshes, those without faces left out. Each is moved
    away from the middle of the object's bounding box by explode times its distance to it."""
    update_matrices()
    middle = sum((Vector(corner) for corner in obj.bound_box), Vector()) / 8
    made = []
    meshes = solids.parts(obj, hierarchy, list(zip(bounds.tolist(), bounds[1:].tolist())), options)
    collection = new_collection(obj, f"{obj.name} parts")
    for mesh in filter(None, meshes):
        part = beside(obj, mesh, f"{obj.name} part", collection)
        corners = arrays.read(mesh.vertices, "co", np.float32, 3)
        away = Vector((corners.min(axis=0) + corners.max(axis=0)) / 2) - middle
        part.delta_location += obj.matrix_basis.to_3x3() @ away * explode  # what is animated stays so
        made.append(part)
    update_matrices()
    return made


def update_matrices():
    """Afterwards each object's matrix_world fits its location, rotation and scale. Blender 5 forgets the matrices at
    undo, and repeats an operator with other options right after that."""
    bpy.context.view_layer.update()


def homes(obj):
    """The collections that new objects beside this one go to: all that it is in, but for those that Blender can't edit, since
    another file holds them; the scene's if none of them is in the view layer. Raises Refused if that can't be edited."""
    found = [each for each in obj.users_collection if not each.library and not each.override_library]
    scene = bpy.context.scene
    shown = set(_shown(bpy.context.view_layer.layer_collection))
    if shown.isdisjoint(found) and (not found or obj.name in bpy.context.view_layer.objects):
        if scene.library or scene.override_library:
            raise Refused("The scene is linked from another file, and nothing can be added to it.")
        return [scene.collection, *found]
    return sorted(found, key=lambda each: each not in shown)


def _shown(layer):
    """The collections of a view layer, from this one on, that are not excluded."""
    if not layer.exclude:
        yield layer.collection
    for child in layer.children:
        yield from _shown(child)


def home(obj):
    """The collection that new ones beside this object go to."""
    return homes(obj)[0]


def new_collection(obj, name):
    """For what is made of the object."""
    parent, collection = home(obj), bpy.data.collections.new(name)
    parent.children.link(collection)
    return collection


def moved_faces(obj, hierarchy, node, snap):
    """(F,) bool: the faces of a node with its border in creases; None for its own: if not snap, or if it has none."""
    return borders.inside(obj, hierarchy, node) if snap and len(hierarchy.faces(node)) else None


def _slice(hierarchy, node):
    return int(hierarchy.tet_first[node]), int(hierarchy.tet_last[node])


def beside(obj, mesh, name, collection=None):
    """A new object with this mesh, made of the object's, and all else as the object has it, as Blender's Separate makes one:
    parent, modifiers, constraints, animation and drivers, custom properties, slots. In the object's collections; collection:
    in place of the first of them. Only levels of sculpting go, see losses()."""
    new = _local_copy(obj)
    new.data, new.name = mesh, name
    if HULL in new:
        del new[HULL]
    for each in homes(obj) if collection is None else [collection, *homes(obj)[1:]]:
        each.objects.link(new)
    images = {obj: new, obj.data: mesh, **({obj.data.shape_keys: mesh.shape_keys} if mesh.shape_keys else {})}
    for block in (new, mesh, mesh.shape_keys):
        if block:
            own_actions(block)
            redirect_drivers(block, images)
    for modifier in list(new.modifiers):
        if modifier.type == "MULTIRES" and modifier.total_levels:
            new.modifiers.remove(modifier)
    _hook(new, _hooked(obj))
    return new


@contextmanager
def hooks_kept(obj):
    """What is in this block gives the object's mesh other vertices; its Hook modifiers go on to move those at the same
    places."""
    hooked = _hooked(obj)
    yield
    _hook(obj, hooked)


def _hooked(obj):
    """{modifier: the places of the vertices that it names by number}"""
    vertices = obj.data.vertices
    return {modifier.name: {tuple(vertices[vertex].co) for vertex in modifier.vertex_indices}
            for modifier in obj.modifiers if modifier.type == "HOOK" and len(modifier.vertex_indices)}


def _hook(obj, hooked):
    for name, places in hooked.items():
        obj.modifiers[name].vertex_indices_set([vertex.index for vertex in obj.data.vertices if tuple(vertex.co) in places])


def _local_copy(obj):
    """Also of an override, of which Blender makes another override."""
    if obj.override_library and bpy.app.version < (4, 0, 0):  # it has no way to make that local
        new = obj.override_library.reference.copy()
        copy_settings(obj, new, {"name", "data", "dimensions", "matrix_world", "matrix_local", "matrix_basis"})
        return new
    new = obj.copy()
    return new.make_local(clear_liboverride=True) if new.override_library else new


def bare(obj, mesh, name, collection=None):
    """A new object with this mesh in the object's place, and nothing else of it."""
    new = bpy.data.objects.new(name, mesh)
    (collection or home(obj)).objects.link(new)
    new.matrix_world = obj.matrix_world
    return new


def losses(obj):
    """Sentences on what objects made of the object's parts will not have, to be said beforehand; [] if they have all."""
    found = []
    if any(each.type == "MULTIRES" and each.total_levels for each in obj.modifiers):
        found.append(rpt_("{name} is sculpted in several resolutions: the new objects have only the coarsest one. To keep the "
                          "details, apply its Multiresolution modifier first.").format(name=obj.name))
    keys = obj.data.shape_keys and obj.data.shape_keys.animation_data
    if keys and any(not strip.action for track in keys.nla_tracks for strip in track.strips):
        found.append(rpt_("The shape keys of {name} have NLA strips that play no action: the new objects go without those.").format(
            name=obj.name))
    return found + bound(obj)


def bound(obj):
    """The same on what depends on the very vertices of the object's mesh."""
    found = []
    for each in obj.modifiers:
        if getattr(each, _BOUND.get(each.type, ""), False):
            found.append(rpt_("The modifier {modifier} is bound to the vertices of {name}, which will be others: bind it "
                              "again.").format(modifier=each.name, name=obj.name))
    return found
