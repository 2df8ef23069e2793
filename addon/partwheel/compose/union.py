# SPDX-License-Identifier: GPL-3.0-or-later
"""Closed meshes united into one by Blender's Boolean. What it gives is never trusted: it is checked, and the next
solver is tried."""

from contextlib import contextmanager

import bpy
import numpy as np
from mathutils import Vector
from mathutils.bvhtree import BVHTree

from ..mesh import apart, arrays, pieces
from ..mesh.datablocks import all_or_nothing
from ..solid import composition, solids
from . import pinches, seams
from partwheel import RayTarget, polygon_faults
from ..mesh.errors import Refused
from ..words.say import rpt_

# (solver, whether it also unites what overlaps within one mesh), in the order tried. Blenders before 4.5 have no
# MANIFOLD; some later ones have it and do nothing.
WAYS = (("MANIFOLD", False), ("EXACT", False), ("EXACT", True))
SAMPLES = 200  # vertices that are looked at to see whether a mesh lies inside another
RAY = Vector((0.5377, 0.3141, 0.7823)).normalized()  # no model is likely to be built along it
SUSPICIOUS = 0.1  # of the smaller volume: with more of it inside the other, what is missing is looked for
MISSING = 0.05  # of the samples: a few may lie in faces of the other
NEAR_CORNER = 1e-5  # a share: what is so near to a vertex is taken for it
TOLERANCE = 1e-5  # of the sum of the volumes: coordinates are of 24 bits


@all_or_nothing()
def unite(target, others, blend=0.0, instead=None):
    """Makes the target's mesh the union of it, as it is without modifiers, and of the other objects, with theirs. The
    others stay. blend: the width of a smooth transition on either side of each seam, times the seam's radius. instead:
    a mesh to be taken for the target's own. What is left of the target's surface keeps its shape keys. Returns the solver
    that did it. Raises Refused before anything has changed."""
    slots, keyed = [], instead or target.data
    solids.check_no_multires(target)
    base = _input(target, instead or target.data, slots)
    try:
        if blend > 0:
            seams.mark(base, 0)
        for side, other in enumerate(others, 1):
            operand = _evaluated(other, slots, target)
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
        offsets = _key_offsets(keyed, base)
        if blend > 0:
            seams.blend(base, blend)
            seams.unmark(base)
    except Exception:
        bpy.data.meshes.remove(base)
        raise
    with composition.preserve_hooks(target):
        _replace(target, base, slots, offsets)
    return solver


def losses(target, others):
    """Sentences on what of these objects a union can't keep, to be said beforehand."""
    found = composition.bound_modifier_messages(target)
    keyed = [obj.name for obj in others if obj.data.shape_keys]
    if keyed:
        found.append(rpt_("The shape keys of {names} can't be kept: the parts stay as they are now. The shape keys of {target} "
                          "move its own surface only.").format(names=", ".join(keyed), target=target.name))
    return found


def problem(mesh):
    """What keeps the mesh from being a closed, manifold, oriented surface, as the end of a sentence; None if nothing
    does."""
    if not len(mesh.polygons):
        return rpt_("it has no faces")
    begin, _ = arrays.polygon_sizes(mesh)
    faults = polygon_faults(arrays.read(mesh.loops, "vertex_index", np.int32), begin, len(mesh.vertices))
    open_edges = faults.open_edges or abs(len(mesh.edges) - len(mesh.loops) // 2)  # or edges that no face has
    if open_edges:
        return rpt_("{count} edges have not just two faces").format(count=open_edges)
    if faults.inconsistent_edges:
        return rpt_("at {count} edges the faces wind against each other").format(count=faults.inconsistent_edges)
    if faults.non_manifold_vertices:
        return rpt_("{count} vertices are loose or join parts that only touch there").format(
            count=faults.non_manifold_vertices)
    return None


def volume(mesh):
    """That the mesh encloses, in its own unit cubed."""
    corners = arrays.read(mesh.vertices, "co", np.float32, 3).astype(float)
    if not len(corners):
        return 0.0
    corners -= corners.mean(axis=0)
    a, b, c = (corners[each] for each in arrays.triangles(mesh)[0].T)
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def _evaluated(obj, slots, target):
    """A copy of the object's mesh with its modifiers, but for those that the target has too: they act on the union."""
    shared = [modifier.name for modifier in obj.modifiers
              if any(_settings(modifier) == _settings(other) for other in target.modifiers)]
    if shared:
        with _without(obj, shared) as double:
            return _evaluated(double, slots, double)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    mesh = bpy.data.meshes.new_from_object(obj.evaluated_get(depsgraph), preserve_all_data_layers=True,
                                           depsgraph=depsgraph)
    try:
        return _input(obj, mesh, slots)
    finally:
        bpy.data.meshes.remove(mesh)


def _settings(modifier):
    """Of a modifier, to be compared."""
    names = (each.identifier for each in modifier.bl_rna.properties if not each.is_readonly)
    values = ((name, getattr(modifier, name)) for name in names if name not in {"is_active", "show_expanded"})
    return {name: value[:] if hasattr(value, "foreach_get") else value for name, value in values}


@contextmanager
def _without(obj, modifiers):
    """A double of the object for a while, without the modifiers of these names."""
    double = obj.copy()
    try:
        bpy.context.scene.collection.objects.link(double)
        for name in modifiers:
            double.modifiers.remove(double.modifiers[name])
        yield double
    finally:
        bpy.data.objects.remove(double)


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
    if copy.shape_keys:  # see _key_offsets()
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
    count, hit = 0, target.first_hit(place, RAY)
    while hit:
        count += 1
        hit = target.first_hit(place, RAY, hit[1] * (1 + 1e-6))
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
    """The result of Blender's modifier, on objects in a scene of their own."""
    objects = [bpy.data.objects.new(mesh.name, mesh) for mesh in (base, operand)]
    try:
        for obj in objects:
            indices = arrays.material_indices(obj.data)
            obj.data.materials.clear()
            for material in slots:
                obj.data.materials.append(material)
            arrays.set_material_indices(obj.data, indices)
        modifier = objects[0].modifiers.new("union", "BOOLEAN")
        modifier.operation, modifier.object, modifier.solver = "UNION", objects[1], solver
        if within:
            modifier.use_self = True
        with apart.scene_apart(*objects) as layer:
            depsgraph = apart.depsgraph(layer)
            return bpy.data.meshes.new_from_object(objects[0].evaluated_get(depsgraph), preserve_all_data_layers=True,
                                                   depsgraph=depsgraph)
    finally:
        for obj in objects:
            bpy.data.objects.remove(obj)


def _key_offsets(mesh, result):
    """{key: (V,3) how far it moves each vertex of a result}, {} if the mesh has no shape keys. What lies on the mesh's surface
    goes as that does there, the rest stays."""
    if not mesh.shape_keys:
        return {}
    own, triangles = arrays.read(mesh.vertices, "co", np.float32, 3), arrays.triangles(mesh)[0]
    places = arrays.read(result.vertices, "co", np.float32, 3)
    tree = BVHTree.FromPolygons(own.tolist(), triangles.tolist(), all_triangles=True)
    near = TOLERANCE * float(np.linalg.norm(np.ptp(own, axis=0)))
    hits = [tree.find_nearest(place, near) for place in places.tolist()]
    on = np.array([hit[2] is not None for hit in hits], bool)
    corners = triangles[[hit[2] for hit in hits if hit[2] is not None]]
    weights = _barycentric(np.array([hit[0] for hit in hits if hit[2] is not None]).reshape(-1, 3), own[corners].astype(float))
    found, reference = {}, arrays.read(mesh.shape_keys.reference_key.data, "co", np.float32, 3)
    for key in mesh.shape_keys.key_blocks:
        offsets = arrays.read(key.data, "co", np.float32, 3) - reference
        found[key.name] = np.zeros_like(places)
        found[key.name][on] = np.einsum("ij,ijk->ik", weights, offsets[corners])
    return found


def _barycentric(places, corners):
    """(n,3) the weights of the corners (n,3,3) of triangles at places (n,3) in them."""
    sides = corners[:, 1:] - corners[:, :1]
    products = np.einsum("ijk,ilk->ijl", sides, sides)
    along = np.einsum("ijk,ik->ij", sides, places - corners[:, 0])
    flat = np.linalg.det(products) <= 0
    products[flat], along[flat] = np.eye(2), 0
    two = np.linalg.solve(products, along[..., None])[..., 0]
    found = np.clip(np.concatenate([1 - two.sum(axis=1, keepdims=True), two], axis=1), 0, 1)
    return np.where((found > 1 - NEAR_CORNER).any(axis=1, keepdims=True), found > 0.5, found)


def _replace(target, result, slots, offsets):
    """Makes the result the target's mesh: name, settings, properties and users are those of the one before, and its shape
    keys, by offsets, see _key_offsets()."""
    if slots == [None]:
        result.materials.clear()  # it was none
    old = target.data
    normals = arrays.custom_normals(result)
    if old.users > 1 + old.use_fake_user:
        target.data = old = old.copy()
    old.materials.clear()
    for material in result.materials:
        old.materials.append(material)
    places = arrays.read(result.vertices, "co", np.float32, 3)
    pieces.replace_geometry(old, result, {key: places + offset for key, offset in offsets.items()})
    if normals is not None:
        arrays.set_custom_normals(old, normals)
    old.update()
    bpy.data.meshes.remove(result)
