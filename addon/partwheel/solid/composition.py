# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects made from parts (paper, section 4.2): copies, removals. In Object Mode; undo is up to the caller."""

from collections.abc import Iterator
from contextlib import contextmanager

import bmesh
import bpy
import numpy as np
from mathutils import Matrix

from ..mesh import MeshSnapshot, Refused, arrays, assembly, find_users, local_copy, rename, rollback_on_error
from ..mesh.datablocks import copy_actions, redirect_drivers
from ..pick import borders
from ..translations.lookup import rpt_
from . import solids
from partwheel import Hierarchy

HULL_PROPERTY = "partwheel_hull"  # marks objects that Convex Parts replaces; copies of them don't get it
_MAX_ROUNDING = 1e-5  # of matrices, relative to their largest number
# Modifier type -> its property that says whether it is bound to the vertices of a mesh. Copies have other vertices.
_BIND_PROPERTIES = {"SURFACE_DEFORM": "is_bound", "MESH_DEFORM": "is_bound", "CORRECTIVE_SMOOTH": "is_bind",
                    "LAPLACIANDEFORM": "is_bind"}


@rollback_on_error()
def create_part_object(obj: bpy.types.Object, hierarchy: Hierarchy, node: int, options: solids.CapOptions,
                       snap: bool) -> bpy.types.Object:
    """A new object with the part as a closed mesh, where the part is; in the object's collections. snap: with its border
    in creases, as far as the tetrahedra nearby allow it."""
    update_matrices()
    return create_object_like(obj, create_part_mesh(obj, hierarchy, node, options, snap), f"{obj.name} part")


def create_part_mesh(obj: bpy.types.Object, hierarchy: Hierarchy, node: int, options: solids.CapOptions,
                     snap: bool) -> bpy.types.Mesh:
    """The mesh of create_part_object()."""
    faces = snapped_faces(obj, hierarchy, node, snap)
    return solids.create_meshes(obj, hierarchy, [hierarchy.tet_slice(node)], options, faces)[0]


@rollback_on_error()
def remove_part(obj: bpy.types.Object, hierarchy: Hierarchy, node: int,
                options: solids.CapOptions = solids.CapOptions(), snap: bool = False) -> None:
    """Removes the part, as create_part_object() copies it, from the object's mesh and closes the hole."""
    faces = _faces_to_remove(obj, hierarchy, node, snap)
    with preserve_hooks(obj):
        solids.remove_from_mesh(obj, hierarchy, hierarchy.tet_slice(node), options, faces)


def create_rest_mesh(obj: bpy.types.Object, hierarchy: Hierarchy, node: int, snap: bool = False) -> bpy.types.Mesh:
    """A new mesh: the object's without the part, as remove_part() leaves it, but without loose edges and vertices."""
    solids.check_no_multires(obj)
    faces = _faces_to_remove(obj, hierarchy, node, snap)
    return solids.create_meshes(obj, hierarchy, [hierarchy.tet_slice(node)[::-1]], faces=faces)[0]


def _faces_to_remove(obj: bpy.types.Object, hierarchy: Hierarchy, node: int, snap: bool) -> np.ndarray | None:
    """snapped_faces() of the node. Raises Refused if no other face is left."""
    faces = snapped_faces(obj, hierarchy, node, snap)
    if (len(hierarchy.faces(node)) if faces is None else np.count_nonzero(faces)) == len(hierarchy.order):
        raise Refused("The part is the whole model: nothing would be left without it. Pick a smaller one.")
    return faces


def update_matrices() -> None:
    """Makes each object's matrix_world match its location, rotation and scale. Blender 5 forgets the matrices at
    undo, and repeats an operator with other options right after that."""
    bpy.context.view_layer.update()


def world_to_local(obj: bpy.types.Object) -> Matrix:
    """The inverse of the object's matrix_world. Raises Refused if it has none."""
    try:
        return obj.matrix_world.inverted()
    except ValueError:
        raise Refused("{name} is flat, as its scale is 0 along an axis. Set another scale.", name=obj.name) from None


def target_collections(obj: bpy.types.Object) -> list[bpy.types.Collection]:
    """The collections for new objects like this one: all of its collections that are editable, those in the view
    layer first; the scene's collection if none of them is in the view layer. Raises Refused if that is not editable."""
    editable = [collection for collection in obj.users_collection if not collection.library
                and not collection.override_library]
    scene = bpy.context.scene
    included = set(_included_collections(bpy.context.view_layer.layer_collection))
    if included.isdisjoint(editable) and (not editable or obj.name in bpy.context.view_layer.objects):
        if scene.library or scene.override_library:
            raise Refused("The scene is linked from another file, so no object can be added to it.")
        return [scene.collection, *editable]
    return sorted(editable, key=lambda collection: collection not in included)


def _included_collections(layer_collection: bpy.types.LayerCollection) -> Iterator[bpy.types.Collection]:
    """The collections of a view layer, from this one down, that are not excluded."""
    if not layer_collection.exclude:
        yield layer_collection.collection
    for child in layer_collection.children:
        yield from _included_collections(child)


def create_collection(obj: bpy.types.Object, name: str) -> bpy.types.Collection:
    """A new collection for objects made from this one."""
    parent, collection = target_collections(obj)[0], bpy.data.collections.new(name)
    parent.children.link(collection)
    return collection


def snapped_faces(obj: bpy.types.Object, hierarchy: Hierarchy, node: int, snap: bool) -> np.ndarray | None:
    """(F,) bool: the faces of a node with its border in creases. None stands for its own faces: without snap, and if it has
    none."""
    return borders.get_part_mask(MeshSnapshot(obj), hierarchy, node) if snap and len(hierarchy.faces(node)) else None


def create_object_like(obj: bpy.types.Object, mesh: bpy.types.Mesh, name: str,
                       collection: bpy.types.Collection | None = None) -> bpy.types.Object:
    """A new object with this mesh, made from the object's, and all else like the object, as Blender's Separate does
    it: parent, modifiers, constraints, animation, drivers, custom properties, material slots. In the object's
    collections; collection: in place of the first of them. Multires levels stay on whole polygons, see loss_messages()."""
    _remove_mirrored_caps(obj, mesh)
    new = local_copy(obj)
    new.data = mesh
    rename(new, name)
    rename(mesh, new.name)  # in USD files an object has the name of its mesh
    if HULL_PROPERTY in new:
        del new[HULL_PROPERTY]
    for target in target_collections(obj) if collection is None else [collection, *target_collections(obj)[1:]]:
        if target not in new.users_collection:  # as copies of rigid bodies are in their world's collections
            target.objects.link(new)
    copies = {obj: new, obj.data: mesh, **({obj.data.shape_keys: mesh.shape_keys} if mesh.shape_keys else {})}
    for block in (new, mesh, mesh.shape_keys):
        if block:
            copy_actions(block)
            redirect_drivers(block, copies)
    if solids.has_multires_levels(obj):
        assembly.copy_multires_levels(obj.data, mesh)
    _bind_hooks(new, _hook_positions(obj))
    return new


def merging_mirrors(obj: bpy.types.Object) -> list[bpy.types.Modifier]:
    """The Mirror modifiers that merge the object's mesh with its image."""
    return [modifier for modifier in obj.modifiers if modifier.type == "MIRROR" and modifier.use_mirror_merge]


def _remove_mirrored_caps(obj: bpy.types.Object, mesh: bpy.types.Mesh) -> None:
    """Removes caps that lie in the plane of a Mirror modifier of the object: with their image they would be a wall inside."""
    mirrors = merging_mirrors(obj)
    if not mirrors or solids.CAP_ATTRIBUTE not in mesh.attributes:
        return
    positions, corners = arrays.read_positions(mesh).astype(float), arrays.read_corner_vertices(mesh)
    begin, sizes = arrays.read_polygon_sizes(mesh)
    is_wall = np.zeros(len(sizes), bool)
    for modifier in mirrors:
        center = modifier.mirror_object
        matrix = np.array(center.matrix_world.inverted_safe() @ obj.matrix_world if center else Matrix())
        is_near = np.abs(positions @ matrix[:3, :3].T + matrix[:3, 3]) <= modifier.merge_threshold
        is_wall |= np.logical_and.reduceat(is_near[corners], begin)[:, list(modifier.use_axis)].any(axis=1)
    if not is_wall.any():
        return
    is_wall &= arrays.read(mesh.attributes[solids.CAP_ATTRIBUTE].data, "value", bool)
    normals = arrays.read_custom_normals(mesh)
    with assembly.edit_as_bmesh(mesh, mesh) as bm:
        bm.faces.ensure_lookup_table()
        bmesh.ops.delete(bm, geom=[bm.faces[face] for face in np.flatnonzero(is_wall).tolist()], context="FACES")
    if normals is not None:
        arrays.write_custom_normals(mesh, normals[~np.repeat(is_wall, sizes)])


@contextmanager
def preserve_hooks(obj: bpy.types.Object) -> Iterator[None]:
    """While the block changes the object's vertices, its Hook modifiers stay bound to those at the same positions, as do
    those of other objects with its mesh."""
    hook_positions = {user: _hook_positions(user) for user in find_users(obj.data)}
    yield
    for user, of_user in hook_positions.items():
        _bind_hooks(user, of_user)


def _hook_positions(obj: bpy.types.Object) -> dict[str, set[tuple[float, ...]]]:
    """{modifier name: positions of the vertices that a Hook modifier moves}"""
    vertices = obj.data.vertices
    return {modifier.name: {tuple(vertices[vertex].co) for vertex in modifier.vertex_indices}
            for modifier in obj.modifiers if modifier.type == "HOOK" and len(modifier.vertex_indices)}


def _bind_hooks(obj: bpy.types.Object, hook_positions: dict[str, set[tuple[float, ...]]]) -> None:
    """Binds Hook modifiers to the vertices at these positions."""
    for name, positions in hook_positions.items():
        obj.modifiers[name].vertex_indices_set([vertex.index for vertex in obj.data.vertices
                                                if tuple(vertex.co) in positions])


def create_bare_object(obj: bpy.types.Object, mesh: bpy.types.Mesh, name: str,
                       collection: bpy.types.Collection) -> bpy.types.Object:
    """A new object with this mesh and the object's transform, and nothing else of it. Shear goes into the mesh."""
    new = bpy.data.objects.new(name, mesh)
    collection.objects.link(new)
    new.matrix_world = without_shear(obj.matrix_world)
    if new.matrix_world != obj.matrix_world:
        mesh.transform(new.matrix_world.inverted_safe() @ obj.matrix_world, shape_keys=True)
    return new


def without_shear(matrix: Matrix) -> Matrix:
    """What location, rotation and scale can hold of a matrix, which a stretched parent may have sheared."""
    held = Matrix.LocRotScale(*matrix.decompose())
    return matrix if differ_by_rounding(held, matrix) else held


def differ_by_rounding(one: Matrix, other: Matrix) -> bool:
    return np.allclose(one, other, rtol=0, atol=_MAX_ROUNDING * np.abs(other).max())


def loss_messages(obj: bpy.types.Object) -> list[str]:
    """Warnings for the user about what objects made from the object's parts will lack; [] if nothing."""
    messages = []
    if solids.has_multires_levels(obj):
        messages.append(rpt_("{name} has a Multiresolution modifier: polygons that a border divides have only its coarsest "
                             "level in the new objects. To keep all details, apply the modifier first.").format(name=obj.name))
    return messages + bound_modifier_messages(obj)


def bound_modifier_messages(obj: bpy.types.Object) -> list[str]:
    """Warnings about modifiers that are bound to the vertices of the object's mesh."""
    text = rpt_("The modifier {modifier} is bound to the vertices of {name}, which change: bind it again afterward.")
    return [text.format(modifier=modifier.name, name=obj.name) for modifier in obj.modifiers
            if getattr(modifier, _BIND_PROPERTIES.get(modifier.type, ""), False)]
