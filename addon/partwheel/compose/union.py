# SPDX-License-Identifier: GPL-3.0-or-later
"""Unites meshes into one by Blender's Boolean, or open ones by open_union. Each result is checked; if it is wrong, the next
solver is tried. The union of closed meshes is closed if a solver can do it. Open meshes, such as most game props, keep their holes."""

from collections.abc import Iterator, Sequence
from typing import Any

import bmesh
import bpy
import numpy as np
from mathutils import Vector
from mathutils.bvhtree import BVHTree

from ..mesh import Refused, arrays, assembly, rollback_on_error, temporary_scene
from ..solid import composition, solids
from . import pinches, seams
from .open_union import OpenInterior, unite_open
from partwheel import RayTarget, polygon_faults
from partwheel.appearance import barycentric
from partwheel.triangles import doubled_area_vectors
from ..translations.lookup import rpt_

# (solver of Blender's Boolean, its options), in order of preference. use_self resolves overlaps within one mesh. MANIFOLD
# exists since Blender 4.5; some builds list it without implementing it.
SOLVERS = (("MANIFOLD", {}), ("EXACT", {}), ("EXACT", {"use_self": True}))
N_SAMPLES = 200  # vertices of a mesh that are tested
RAY_DIRECTION = Vector((0.54, 0.31, 0.78)).normalized()  # unlikely to be parallel to a face or an edge
CHECKED_OVERLAP_FRACTION = 0.1  # of the smaller volume: with a larger overlap, missing surface is searched for
MAX_MISSING_FRACTION = 0.05  # of the samples: a few may lie on faces of the other mesh
CORNER_TOLERANCE = 1e-5  # barycentric: points so near to a vertex count as this vertex
RELATIVE_TOLERANCE = 1e-5  # relative, of volumes and lengths: coordinates are 32-bit floats


@rollback_on_error()
def unite(target: bpy.types.Object, others: list[bpy.types.Object], blend: float = 0.0,
          base_mesh: bpy.types.Mesh | None = None) -> str:
    """Makes the target's mesh the union of itself, without modifiers, and of the other objects, with theirs. The
    others stay.

    blend: width of a smooth transition on either side of each seam, in radii of the seam. base_mesh: replaces the
    target's own mesh. Remaining surface of the target keeps its shape keys. Returns the solver's name. Raises Refused
    before any change."""
    to_local = composition.world_to_local(target)
    keyed_mesh, slots, groups = base_mesh or target.data, _read_slots(target), target.vertex_groups.keys()
    solids.check_no_multires(target)
    base, operands, numbers = _copy_with_slots(target, keyed_mesh, range(len(slots))), [], []
    if blend > 0:
        seams.mark_solid(base, 0)
    for solid, other in enumerate(others, 1):
        operand = _create_operand(other, slots, target)
        operands.append(operand)
        numbers.append(_match_groups(groups, other, operand) if other.vertex_groups else {})
        if blend > 0:
            seams.mark_solid(operand, solid)
        operand.transform(to_local @ other.matrix_world)
        if target.matrix_world.is_negative != other.matrix_world.is_negative:
            operand.flip_normals()
        result, solver = _unite_pair(base, operand, target.name, other.name, slots)
        bpy.data.meshes.remove(base)
        base = result
    surface = _Surface(keyed_mesh) if groups or keyed_mesh.shape_keys else None
    if groups:
        _restore_weights(base, [(surface, None), *zip(map(_Surface, operands), numbers)])
    offsets = _key_offsets(surface, base) if keyed_mesh.shape_keys else {}
    if blend > 0:
        seams.blend_seams(base, blend)
        seams.remove_marks(base)
    bpy.data.batch_remove(operands)
    with composition.preserve_hooks(target):
        _replace_mesh(target, base, slots, offsets)
        for name in groups[len(target.vertex_groups):]:
            target.vertex_groups.new(name=name)
    return solver


def loss_messages(target: bpy.types.Object, others: list[bpy.types.Object]) -> list[str]:
    """Warnings about what a union of these objects will lose."""
    messages = composition.bound_modifier_messages(target)
    keyed_names = [obj.name for obj in others if obj.data.shape_keys]
    if keyed_names:
        messages.append(rpt_("The shape keys of {names} are lost; the parts keep their current shape. The shape "
                             "keys of {target} move only its own surface.").format(
                                 names=", ".join(keyed_names), target=target.name))
    return messages


def find_defect(mesh: bpy.types.Mesh) -> str | None:
    """What keeps the mesh from being a closed, manifold, oriented surface, as a clause; None if nothing does."""
    if not len(mesh.polygons):
        return rpt_("it has no faces")
    begin, _ = arrays.read_polygon_sizes(mesh)
    faults = polygon_faults(arrays.read_corner_vertices(mesh), begin, len(mesh.vertices))
    open_edges = faults.open_edges or abs(len(mesh.edges) - len(mesh.loops) // 2)  # or edges without faces
    if open_edges:
        return rpt_("{count} edges don't have exactly two faces").format(count=open_edges)
    if faults.inconsistent_edges:
        return rpt_("{count} edges have faces of opposite orientation").format(count=faults.inconsistent_edges)
    if faults.non_manifold_vertices:
        return rpt_("{count} vertices are loose or connect parts that only touch there").format(
            count=faults.non_manifold_vertices)
    return None


def _create_operand(obj: bpy.types.Object, slots: list, target: bpy.types.Object) -> bpy.types.Mesh:
    """A copy of the object's mesh with its modifiers, except those that the target has too: these act on the union."""
    shared = [modifier.name for modifier in obj.modifiers
              if any(_modifier_settings(modifier) == _modifier_settings(other) for other in target.modifiers)]
    if shared:
        mesh = _evaluate_without_modifiers(obj, shared)
    else:
        mesh = _evaluate_mesh(obj, bpy.context.evaluated_depsgraph_get())
    materials = _read_slots(obj)
    slots.extend(material for material in dict.fromkeys(materials) if material not in slots)
    try:
        return _copy_with_slots(obj, mesh, [slots.index(material) for material in materials])
    finally:
        bpy.data.meshes.remove(mesh)


def _evaluate_mesh(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> bpy.types.Mesh:
    """A new mesh: the object's with its modifiers."""
    return bpy.data.meshes.new_from_object(obj.evaluated_get(depsgraph), preserve_all_data_layers=True, depsgraph=depsgraph)


def _evaluate_without_modifiers(obj: bpy.types.Object, modifiers: list[str]) -> bpy.types.Mesh:
    """As _evaluate_mesh(), without the modifiers of these names."""
    copy = obj.copy()
    try:
        for name in modifiers:
            copy.modifiers.remove(copy.modifiers[name])
        with temporary_scene.create_temporary_scene(copy) as layer:
            return _evaluate_mesh(copy, temporary_scene.update_depsgraph(layer))
    finally:
        bpy.data.objects.remove(copy)


def _modifier_settings(modifier: bpy.types.Modifier) -> dict[str, Any]:
    """{property: value} of a modifier, for comparisons."""
    names = (property.identifier for property in modifier.bl_rna.properties if not property.is_readonly)
    values = ((name, getattr(modifier, name)) for name in names if name not in {"is_active", "show_expanded"})
    return {name: value[:] if hasattr(value, "foreach_get") else value for name, value in values}


def _read_slots(obj: bpy.types.Object) -> list:
    """The material of each slot; at least one, None."""
    return [slot.material for slot in obj.material_slots] or [None]


def _copy_with_slots(obj: bpy.types.Object, mesh: bpy.types.Mesh, new_slots: Sequence[int]) -> bpy.types.Mesh:
    """A copy with new_slots, of each slot of the object; welded and split at pinches unless closed. Raises Refused."""
    if not len(mesh.polygons):
        raise Refused("{name} has no faces. Deselect it, or choose another object.", name=obj.name)
    copy = mesh.copy()
    if copy.shape_keys:  # restored by _key_offsets()
        assembly.clear_shape_keys(copy)
    if find_defect(copy):
        assembly.weld_vertices(copy, arrays.find_coincident_vertices(copy))
        if find_defect(copy):
            _split_pinches(copy)
    indices = arrays.read_material_indices(copy)
    copy.materials.clear()
    arrays.write_material_indices(copy, np.array(new_slots, np.int32)[np.minimum(indices, len(new_slots) - 1)])
    return copy


def _unite_pair(base: bpy.types.Mesh, operand: bpy.types.Mesh, base_name: str, operand_name: str,
                slots: list) -> tuple[bpy.types.Mesh, str]:
    """(new mesh, solver). Raises Refused if no solver works."""
    volumes = arrays.mesh_volume(base), arrays.mesh_volume(operand)
    is_closed = not (find_defect(base) or find_defect(operand))
    for name, own_volume in zip((base_name, operand_name), volumes if is_closed else ()):
        if own_volume <= 0:
            raise Refused("{name} is not a solid: it is inside out. Turn its faces outside (Recalculate Outside).", name=name)
    reasons = []
    for solver, result, defect in _attempt_unions(base, operand, volumes, is_closed, slots):
        if not defect:
            return result, solver
        reasons.append(rpt_("by {solver}: {reason}").format(solver=solver, reason=defect))
        bpy.data.meshes.remove(result)
    raise Refused("{one} and {other} can't be united ({reasons}). Move one of them a little: overlapping coplanar "
                  "faces are the usual cause. Or join them (Ctrl J), which cuts nothing away.", one=base_name,
                  other=operand_name, reasons="; ".join(reasons))


def _attempt_unions(base: bpy.types.Mesh, operand: bpy.types.Mesh, volumes: tuple[float, float], is_closed: bool,
                    slots: list) -> Iterator[tuple[str, bpy.types.Mesh, str | None]]:
    """(solver, a new mesh, what is wrong with it as a clause, or None): Blender's, if both meshes are closed, then unite_open()."""
    available = bpy.types.BooleanModifier.bl_rna.properties["solver"].enum_items.keys()
    for solver, options in SOLVERS if is_closed else ():
        if solver in available:
            result = _apply_boolean(base, operand, solver, options, slots)
            defect = find_defect(result)
            if defect and _split_pinches(result, is_union=True):
                defect = find_defect(result)
            name = rpt_("{solver} with Self Intersection") if options else "{solver}"
            yield name.format(solver=solver.title()), result, defect or _volume_defect((base, operand), volumes, result)
    result = unite_open(base, operand, slots)
    defect = _surface_defect((base, operand), result, is_closed, MAX_MISSING_FRACTION)
    if is_closed and (united := arrays.mesh_volume(result)) <= 0:
        defect = _volume_clause(united / sum(volumes))
    yield "Intersect", result, defect


def _volume_clause(share: float) -> str:
    """A clause with the volume, as a share of the sum of both meshes'."""
    return rpt_("its volume would be {share:.0%} of the sum of both volumes").format(share=share)


def _surface_defect(meshes: tuple[bpy.types.Mesh, bpy.types.Mesh], result: bpy.types.Mesh, are_closed: bool,
                    allowed: float) -> str | None:
    """A clause if more than the allowed fraction of one mesh's vertices are missing: not on the result's surface, though they are
    neither inside the other mesh nor inside other shells of their own. None otherwise."""
    if not len(result.polygons):
        return rpt_("it has no faces")
    positions = arrays.read_positions(result)
    surface = BVHTree.FromPolygons(positions.tolist(), arrays.read_triangles(result)[0].tolist())
    tolerance = RELATIVE_TOLERANCE * float(np.linalg.norm(np.ptp(positions, axis=0)))
    judged = [(mesh, OpenInterior(mesh)) for mesh in meshes]
    for (mesh, own), (other, interior) in (judged, judged[::-1]):
        # Rays first: they are much faster, but miss one of two coincident walls.
        interiors = [_ClosedInterior(other), interior] if are_closed else [interior]
        with_faces = np.unique(arrays.read_corner_vertices(mesh))
        samples = [mesh.vertices[index].co for index in with_faces[::max(len(with_faces) // N_SAMPLES, 1)].tolist()]
        n_missing = sum(surface.find_nearest(sample)[3] > tolerance and not any(each.contains(sample) for each in interiors)
                        and not own.covers(sample) for sample in samples)
        if n_missing > allowed * len(samples):
            return rpt_("one of them is missing")
    return None


class _ClosedInterior:
    """The inside of a closed mesh: a ray from there leaves the mesh more often than it enters it."""

    def __init__(self, mesh: bpy.types.Mesh) -> None:
        vertices, triangles = arrays.read_positions(mesh), arrays.read_triangles(mesh)[0]
        self._target = RayTarget(vertices, triangles)
        self._signs = np.sign(doubled_area_vectors(vertices[triangles]) @ np.array(RAY_DIRECTION)).astype(int).tolist()

    def contains(self, position: Vector) -> bool:
        count, hit = 0, self._target.first_hit(position, RAY_DIRECTION)
        while hit:
            count += self._signs[hit[0]]
            hit = self._target.first_hit(position, RAY_DIRECTION, hit[1] * (1 + 1e-6))
        return count != 0


def _split_pinches(mesh: bpy.types.Mesh, is_union: bool = False) -> bool:
    """Splits where solids only touch and the Boolean merged their vertices. Returns whether the mesh is manifold.
    is_union: first deletes what coincides; in an object's own mesh, this could be a card with two sides."""
    with assembly.edit_as_bmesh(mesh) as bm:
        if is_union:
            pinches.cancel_coincident_faces(bm)
        bmesh.ops.delete(bm, geom=[vert for vert in bm.verts if not vert.link_faces], context="VERTS")
        bm.normal_update()
        is_manifold = pinches.split_pinches(bm, may_overlap=is_union)
        if is_manifold:
            bm.to_mesh(mesh)
        return is_manifold


def _volume_defect(meshes: tuple[bpy.types.Mesh, bpy.types.Mesh], volumes: tuple[float, float],
                   result: bpy.types.Mesh) -> str | None:
    """What is wrong with a union's volume, as a clause, or None. max(Va, Vb) <= V <= Va + Vb must hold. V = max(Va,
    Vb) only if the other solid lies inside (though faces of the result may be cut); and if V says that much of the
    smaller solid lies inside, little of either surface may be missing."""
    united = arrays.mesh_volume(result)
    tolerance = RELATIVE_TOLERANCE * sum(volumes)
    if not max(volumes) - tolerance <= united <= sum(volumes) + tolerance:
        return _volume_clause(united / sum(volumes))
    if sum(volumes) - united > CHECKED_OVERLAP_FRACTION * min(volumes):
        allowed = 0 if united <= max(volumes) + min(tolerance, min(volumes) / 2) else MAX_MISSING_FRACTION
        return _surface_defect(meshes, result, True, allowed)
    return None


def _apply_boolean(base: bpy.types.Mesh, operand: bpy.types.Mesh, solver: str, options: dict[str, bool],
                   slots: list) -> bpy.types.Mesh:
    """The result of Blender's Boolean modifier, on objects in a scene of their own."""
    objects = [bpy.data.objects.new(mesh.name, mesh) for mesh in (base, operand)]
    try:
        for obj in objects:
            indices = arrays.read_material_indices(obj.data)
            obj.data.materials.clear()
            for material in slots:
                obj.data.materials.append(material)
            arrays.write_material_indices(obj.data, indices)
        modifier = objects[0].modifiers.new("union", "BOOLEAN")
        modifier.operation, modifier.object, modifier.solver = "UNION", objects[1], solver
        for name, value in options.items():
            setattr(modifier, name, value)
        with temporary_scene.create_temporary_scene(*objects) as layer:
            return _evaluate_mesh(objects[0], temporary_scene.update_depsgraph(layer))
    finally:
        for obj in objects:
            bpy.data.objects.remove(obj)


class _Surface:
    """A mesh's surface, to find what lies on it."""

    def __init__(self, mesh: bpy.types.Mesh) -> None:
        self.mesh = mesh
        self._positions, self._triangles = arrays.read_positions(mesh), arrays.read_triangles(mesh)[0]
        self._tree = BVHTree.FromPolygons(self._positions.tolist(), self._triangles.tolist(), all_triangles=True)
        self._tolerance = RELATIVE_TOLERANCE * float(np.linalg.norm(np.ptp(self._positions, axis=0)))

    def locate(self, positions: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """(mask (n,) of the positions (n, 3) that are on the surface; of each of these the vertices of the triangle
        there, (m, 3), and its barycentric coordinates there, (m, 3))"""
        hits = [self._tree.find_nearest(position, self._tolerance) for position in positions.tolist()]
        is_on = np.array([hit[2] is not None for hit in hits], bool)
        corners = self._triangles[[hit[2] for hit in hits if hit[2] is not None]]
        points = np.array([hit[0] for hit in hits if hit[2] is not None]).reshape(-1, 1, 3)
        weights = barycentric(self._positions[corners].astype(float), points)[:, 0]
        weights = np.where((weights > 1 - CORNER_TOLERANCE).any(axis=1, keepdims=True), weights > 0.5, weights)
        return is_on, corners, weights


def _key_offsets(surface: _Surface, result: bpy.types.Mesh) -> dict[str, np.ndarray]:
    """{key: (V, 3) offset of each vertex of a result}, interpolated on the surface with shape keys, 0 elsewhere."""
    positions, keys = arrays.read_positions(result), surface.mesh.shape_keys
    is_on_surface, corners, weights = surface.locate(positions)
    offsets_by_key, reference = {}, arrays.read(keys.reference_key.data, "co", np.float32, 3)
    for key in keys.key_blocks:
        offsets = arrays.read(key.data, "co", np.float32, 3) - reference
        offsets_by_key[key.name] = np.zeros_like(positions)
        offsets_by_key[key.name][is_on_surface] = np.einsum("ij,ijk->ik", weights, offsets[corners])
    return offsets_by_key


def _match_groups(names: list[str], obj: bpy.types.Object, mesh: bpy.types.Mesh) -> dict[int, int]:
    """{vertex group that the mesh uses: index of its name in names}. Appends missing names, as Blender's Join does."""
    numbers = {}
    for number in sorted({group.group for vertex in mesh.vertices for group in vertex.groups}):
        if number < len(obj.vertex_groups):  # else left over from a group that was deleted
            name = obj.vertex_groups[number].name
            names.extend([name] if name not in names else [])
            numbers[number] = names.index(name)
    return numbers


def _restore_weights(result: bpy.types.Mesh, sources: Sequence[tuple[_Surface, dict[int, int] | None]]) -> None:
    """Gives vertices of a union the weights of the surface that they are on. Blender's Boolean gives no weights to the vertices
    that it creates where surfaces intersect, so bones would leave them behind, and wrong weights to vertices of all meshes but
    the first. sources: (surface of a united mesh, {its group: group of the union}, see _match_groups(); None: the same)."""
    if not any(vertex.groups for vertex in result.vertices):
        return
    positions, rest = arrays.read_positions(result), np.arange(len(result.vertices))
    with assembly.edit_as_bmesh(result, into=result) as bm:
        layer, verts = bm.verts.layers.deform.active, bm.verts[:]
        for surface, numbers in sources:
            is_on_surface, corners, shares = surface.locate(positions[rest])
            for vertex, triangle, weights in zip(rest[is_on_surface].tolist(), corners.tolist(), shares.tolist()):
                groups = verts[vertex][layer]
                if numbers is None and groups:
                    continue
                groups.clear()
                for corner, share in zip(triangle, weights):
                    for group in surface.mesh.vertices[corner].groups if share else ():
                        if (number := group.group if numbers is None else numbers.get(group.group)) is not None:
                            groups[number] = groups.get(number, 0) + share * group.weight
            rest = rest[~is_on_surface]
        for vertex in rest.tolist():
            verts[vertex][layer].clear()


def _replace_mesh(target: bpy.types.Object, result: bpy.types.Mesh, slots: list,
                  offsets: dict[str, np.ndarray]) -> None:
    """Replaces the target's geometry by the result; name, settings, properties, slots and users stay. Shape keys come from
    offsets, see _key_offsets()."""
    old = target.data
    normals = arrays.read_custom_normals(result)
    if old.users > 1 + old.use_fake_user:
        target.data = old = old.copy()
    for material in slots[len(old.materials):] if slots != [None] else ():  # its own may be the object's
        old.materials.append(material)
    positions = arrays.read_positions(result)
    assembly.replace_geometry(old, result, {key: positions + offset for key, offset in offsets.items()})
    if normals is not None:
        arrays.write_custom_normals(old, normals)
    old.update()
    bpy.data.meshes.remove(result)
