# SPDX-License-Identifier: GPL-3.0-or-later
"""Closed meshes united into one by Blender's Boolean. What it gives is never trusted: it is checked, and the next
solver is tried."""

import bpy
import numpy as np
from mathutils import Vector
from mathutils.bvhtree import BVHTree

from ..mesh import arrays, pieces
from . import pinches, seams
from partwheel import RayTarget, polygon_faults
from ..mesh.refusing import Refused
from ..words.say import rpt_

# (solver, whether it also unites what overlaps within one mesh), in the order tried. Blenders before 4.5 have no
# MANIFOLD; some later ones have it and do nothing.
WAYS = (("MANIFOLD", False), ("EXACT", False), ("EXACT", True))
SAMPLES = 200  # vertices that are looked at to see whether a mesh lies inside another
RAY = Vector((0.5377, 0.3141, 0.7823)).normalized()  # no model is likely to be built along it
SUSPICIOUS = 0.1  # of the smaller volume: with more of it inside the other, what is missing is looked for
MISSING = 0.05  # of the samples: a few may lie in faces of the other
TOLERANCE = 1e-5  # of the sum of the volumes: coordinates are of 24 bits
# How the properties begin that are a mesh's settings.
SETTINGS = ("remesh_", "use_remesh_", "use_mirror_", "use_paint_", "use_auto_", "auto_smooth", "radial", "texspace")


def unite(target, others, blend=0.0, instead=None):
    """Makes the target's mesh the union of it, as it is without modifiers, and of the other objects, with theirs. The
    others stay. blend: the width of a smooth transition on either side of each seam, times the seam's radius. instead:
    a mesh to be taken for the target's own. Returns the solver that did it. Raises Refused before anything has
    changed."""
    slots = []
    base = _input(target, instead or target.data, slots)
    try:
        if blend > 0:
            seams.mark(base, 0)
        for side, other in enumerate(others, 1):
            operand = _evaluated(other, slots)
            try:
                if blend > 0:
                    seams.mark(operand, side)
                operand.transform(target.matrix_world.inverted() @ other.matrix_world)
                if target.matrix_world.is_negative != other.matrix_world.is_negative:
                    operand.flip_normals()
                result, solver = _united(base, operand, target.name, other.name, slots)
            finally:
                bpy.data.meshes.remove(operand)
            bpy.data.meshes.remove(base)
            base = result
        if blend > 0:
            seams.blend(base, blend)
            seams.unmark(base)
    except Exception:
        bpy.data.meshes.remove(base)
        raise
    _replace(target, base, slots)
    return solver


def problem(mesh):
    """What keeps the mesh from being a closed, manifold, oriented surface, as the end of a sentence; None if nothing
    does."""
    if not len(mesh.polygons):
        return rpt_("it has no faces")
    begin, _ = arrays.polygon_sizes(mesh)
    faults = polygon_faults(arrays.read(mesh.loops, "vertex_index", np.int32), begin, len(mesh.vertices))
    open_edges = faults.open or abs(len(mesh.edges) - len(mesh.loops) // 2)  # or edges that no face has
    if open_edges:
        return rpt_("{count} edges have not just two faces").format(count=open_edges)
    if faults.against:
        return rpt_("at {count} edges the faces wind against each other").format(count=faults.against)
    if faults.touching:
        return rpt_("{count} vertices are loose or join parts that only touch there").format(count=faults.touching)
    return None


def volume(mesh):
    """That the mesh encloses, in its own unit cubed."""
    corners = arrays.read(mesh.vertices, "co", np.float32, 3).astype(float)
    if not len(corners):
        return 0.0
    corners -= corners.mean(axis=0)
    a, b, c = (corners[each] for each in arrays.triangles(mesh)[0].T)
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def _evaluated(obj, slots):
    depsgraph = bpy.context.evaluated_depsgraph_get()
    mesh = bpy.data.meshes.new_from_object(obj.evaluated_get(depsgraph), preserve_all_data_layers=True,
                                           depsgraph=depsgraph)
    try:
        return _input(obj, mesh, slots)
    finally:
        bpy.data.meshes.remove(mesh)


def _input(obj, mesh, slots):
    """A copy of the mesh with its materials numbered by slots, a list of all materials, which grows."""
    wrong = problem(mesh)
    if wrong:
        raise Refused("{name} is no solid: {reason}. Repair it, or copy its part anew.", name=obj.name, reason=wrong)
    own = [slot.material for slot in obj.material_slots] or [None]
    for material in own:
        if material not in slots:
            slots.append(material)
    indices = arrays.material_indices(mesh)
    numbers = np.array([slots.index(material) for material in own], np.int32)
    copy = mesh.copy()
    copy.materials.clear()
    arrays.set_material_indices(copy, numbers[np.minimum(indices, len(own) - 1)])
    if copy.shape_keys:  # they can't outlive a union
        pieces.clear_keys(copy)
    return copy


def _united(base, operand, base_name, operand_name, slots):
    """(new mesh, solver)"""
    known = {item.identifier for item in bpy.types.BooleanModifier.bl_rna.properties["solver"].enum_items}
    volumes = volume(base), volume(operand)
    for name, measured in zip((base_name, operand_name), volumes):
        if measured <= 0:
            raise Refused("{name} is no solid: it is inside out. Turn its faces outwards (Recalculate Outside).", name=name)
    reasons = []
    for solver, within in WAYS:
        if solver not in known:
            continue
        result = _boolean(base, operand, solver, within, slots)
        wrong = problem(result)
        if wrong and _set_apart(result):
            wrong = problem(result)
        wrong = wrong or _implausible((base, operand), volumes, result)
        if not wrong:
            return result, solver
        told = rpt_("by {solver} within: {reason}") if within else rpt_("by {solver}: {reason}")
        reasons.append(told.format(solver=solver.title(), reason=wrong))
        bpy.data.meshes.remove(result)
    raise Refused("{one} and {other} can't be united ({reasons}). Move one of them a little: faces that lie in each other "
                  "are the usual cause.", one=base_name, other=operand_name, reasons="; ".join(reasons))


def _left_out(one, other, result):
    """The share of the vertices of one mesh that lie outside of the other, by the parity of crossings along a ray, and are
    missing from the surface of the result."""
    places = arrays.read(result.vertices, "co", np.float32, 3)
    surface = BVHTree.FromPolygons(places.tolist(), arrays.triangles(result)[0].tolist())
    near = TOLERANCE * float(np.linalg.norm(np.ptp(places, axis=0)))
    target = RayTarget(arrays.read(other.vertices, "co", np.float32, 3), arrays.triangles(other)[0])
    step = max(len(one.vertices) // SAMPLES, 1)
    return np.mean([surface.find_nearest(vertex.co)[3] > near and not _crossings(target, vertex.co) % 2
                    for vertex in list(one.vertices)[::step]])


def _crossings(target, place):
    count, hit = 0, target.first(place, RAY)
    while hit:
        count += 1
        hit = target.first(place, RAY, hit[1] * (1 + 1e-6))
    return count


def _set_apart(mesh):
    """Where the solids only touch, and vertices of one place were joined into one. Whether it could."""
    with pieces.edited(mesh) as bm:
        bm.normal_update()
        done = pinches.set_apart(bm)
        if done:
            bm.to_mesh(mesh)
        return done


def _implausible(meshes, volumes, result):
    """What is wrong with a union's volume, by inclusion and exclusion: it is at least the larger volume and at most the
    sum. It is the larger only if the other lies within, though faces of the one that is left may have been cut; and where
    it says that much of the smaller one lies within, not much of either may be missing."""
    united = volume(result)
    slack = TOLERANCE * sum(volumes)
    if not max(volumes) - slack <= united <= sum(volumes) + slack:
        return rpt_("its volume would be {share:.0%} of that of the two").format(share=united / sum(volumes))
    if sum(volumes) - united > SUSPICIOUS * min(volumes):
        allowed = 0 if united <= max(volumes) + min(slack, min(volumes) / 2) else MISSING
        if max(_left_out(*meshes, result), _left_out(*meshes[::-1], result)) > allowed:
            return rpt_("one of them was left out")
    return None


def _boolean(base, operand, solver, within, slots):
    """The result of Blender's modifier, on objects that are in the scene only for as long as this takes."""
    collection = bpy.data.collections.new("partwheel union")
    bpy.context.scene.collection.children.link(collection)
    objects = [bpy.data.objects.new(mesh.name, mesh) for mesh in (base, operand)]
    try:
        for obj in objects:
            collection.objects.link(obj)
            indices = arrays.material_indices(obj.data)
            obj.data.materials.clear()
            for material in slots:
                obj.data.materials.append(material)
            arrays.set_material_indices(obj.data, indices)
        modifier = objects[0].modifiers.new("union", "BOOLEAN")
        modifier.operation, modifier.object, modifier.solver = "UNION", objects[1], solver
        if within:
            modifier.use_self = True
        bpy.context.view_layer.update()
        depsgraph = bpy.context.evaluated_depsgraph_get()
        return bpy.data.meshes.new_from_object(objects[0].evaluated_get(depsgraph), preserve_all_data_layers=True,
                                               depsgraph=depsgraph)
    finally:
        for obj in objects:
            bpy.data.objects.remove(obj)
        bpy.data.collections.remove(collection)


def _replace(target, result, slots):
    """Makes the result the target's mesh: name, settings, properties and users are those of the one before."""
    if slots == [None]:
        result.materials.clear()  # it was none
    old, name = target.data, target.data.name
    if old.animation_data or old.asset_data or old.use_fake_user:  # what a new one can't have
        normals = arrays.custom_normals(result)
        if old.users > 1 + old.use_fake_user:
            target.data = old = old.copy()
        if old.shape_keys:
            pieces.clear_keys(old)
        old.materials.clear()
        for material in result.materials:
            old.materials.append(material)
        pieces.replace_geometry(old, result)
        if normals is not None:
            arrays.set_custom_normals(old, normals)
        old.update()
        bpy.data.meshes.remove(result)
        return
    for setting in old.bl_rna.properties:
        if setting.identifier.startswith(SETTINGS) and not result.is_property_readonly(setting.identifier):
            setattr(result, setting.identifier, getattr(old, setting.identifier))
    for key in old.keys():
        result[key] = old[key]
    if old.users > 1:
        target.data = result
    else:
        old.user_remap(result)
        bpy.data.meshes.remove(old)
        result.name = name
