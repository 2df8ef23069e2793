# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes a cut into the mesh as face sets, vertex groups or materials. Outside Edit Mode; undo is up to the caller."""

import bpy
import numpy as np

from ..mesh import FACE_SET, Refused, arrays, find_users
from partwheel.cut import Cut, colors

MATERIAL_PROPERTY = "partwheel_color"  # the name for which write_colored_materials() has created a material, and may change it
GROUPS_PROPERTY = "partwheel_groups"  # mesh property: names of the vertex groups that write_vertex_groups() has created


def write_face_sets(obj: bpy.types.Object, cut: Cut, _names: list[str]) -> None:
    """One face set for each part; replaces all earlier ones."""
    mesh = obj.data
    arrays.ensure_attribute(mesh, FACE_SET, "INT", "FACE").data.foreach_set("value", cut.labels + 1)


def write_vertex_groups(obj: bpy.types.Object, names: list[str], weights: list[tuple[np.ndarray, np.ndarray]]) -> None:
    """One vertex group for each part, with these weights; replaces groups of the same names."""
    obj.data[GROUPS_PROPERTY] = sorted({*own_groups(obj), *names})
    for name, (vertices, values) in zip(names, weights):
        group = obj.vertex_groups.get(name)
        if group:
            obj.vertex_groups.remove(group)
        group = obj.vertex_groups.new(name=name)
        is_full = values == 1
        group.add(vertices[is_full].tolist(), 1.0, "REPLACE")
        for vertex, value in zip(vertices[~is_full].tolist(), values[~is_full].tolist()):
            group.add((vertex,), value, "REPLACE")


def own_groups(obj: bpy.types.Object) -> set[str]:
    """The names of the vertex groups that write_vertex_groups() has created and that are still there."""
    names = obj.data.get(GROUPS_PROPERTY, ())
    return {name for name in names if isinstance(name, str) and name in obj.vertex_groups} if isinstance(names, list) else set()


def check_locks(obj: bpy.types.Object, names: list[str]) -> None:
    """Raises Refused if write_vertex_groups() would replace a group that the user has locked."""
    for name in names:
        if name in obj.vertex_groups and obj.vertex_groups[name].lock_weight:
            raise Refused("The vertex group {name} is locked. Unlock it, or give it another name.", name=name)


def write_colored_materials(obj: bpy.types.Object, cut: Cut, names: list[str]) -> None:
    """One material for each part, with a color of its own; replaces the mesh's materials."""
    mesh = obj.data
    mesh.materials.clear()
    for name, color in zip(names, colors(cut.keys)):
        mesh.materials.append(_colored_material(f"{obj.name} {name}", color))
    arrays.write_material_indices(mesh, cut.labels)


def write_material_slots(obj: bpy.types.Object, cut: Cut, _names: list[str]) -> None:
    """The mesh's own materials with a slot for each part, or several where a part has several materials."""
    mesh = obj.data
    old_slots = {user: [(slot.link, slot.material) for slot in user.material_slots] for user in find_users(mesh)}
    old_materials = list(mesh.materials) or [None]
    indices = np.clip(arrays.read_material_indices(mesh), 0, len(old_materials) - 1)
    slots, index = np.unique(np.column_stack([cut.labels, indices]), axis=0, return_inverse=True)
    mesh.materials.clear()
    for _, material in slots.tolist():
        mesh.materials.append(old_materials[material])
    for user, of_user in old_slots.items():
        for slot, (_, material) in zip(user.material_slots, slots.tolist() if of_user else ()):
            if of_user[material][0] == "OBJECT":
                slot.link, slot.material = of_user[material]
    arrays.write_material_indices(mesh, index.ravel().astype(np.int32))


def _colored_material(name: str, color: np.ndarray) -> bpy.types.Material:
    """The material that this function created earlier for this name, and nobody has renamed, or a new one, with this sRGB
    color (3,). Its own name differs by a number if a material of the user has the name."""
    material = next((material for material in bpy.data.materials if not material.library
                     and material.get(MATERIAL_PROPERTY) == name and material.name.startswith(name)), None)
    if not material:
        material = bpy.data.materials.new(name)
        material[MATERIAL_PROPERTY] = name
    material.diffuse_color = *color, 1
    material.use_nodes = True
    for node in material.node_tree.nodes:
        if node.type == "BSDF_PRINCIPLED":
            node.inputs["Base Color"].default_value = *(color ** 2.2), 1
    return material
