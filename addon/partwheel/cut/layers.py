# SPDX-License-Identifier: GPL-3.0-or-later
"""A cut written into the mesh: as face sets, vertex groups, materials. Outside Edit Mode; undo is the caller's."""

import bpy
import numpy as np

from ..mesh import arrays
from ..mesh.errors import Refused
from ..pick.writers import FACE_SET
from partwheel.cut import colors, skin_weights


def face_sets(obj, cut, _names):
    """One for each part, in place of all that there were."""
    mesh = obj.data
    arrays.needed_attribute(mesh, FACE_SET, "INT", "FACE").data.foreach_set("value", cut.labels + 1)


def weights_of(obj, cut):
    """Of each part, as skin_weights() gives them: 1 within, falling smoothly across the borders. A vertex's add up to 1."""
    surface = arrays.surface(obj.data)
    return skin_weights(surface.vertices, surface.triangles, cut.labels[surface.faces], len(cut))


def vertex_groups(obj, names, weights):
    """One for each part with these weights, in place of groups of the same names."""
    for name, (vertices, values) in zip(names, weights):
        group = obj.vertex_groups.get(name)
        if group:
            obj.vertex_groups.remove(group)
        group = obj.vertex_groups.new(name=name)
        whole = values == 1
        group.add(vertices[whole].tolist(), 1.0, "REPLACE")
        for vertex, value in zip(vertices[~whole].tolist(), values[~whole].tolist()):
            group.add((vertex,), value, "REPLACE")


def check_locks(obj, names):
    """Raises Refused where vertex_groups() would replace a group that the user has locked."""
    for name in names:
        if name in obj.vertex_groups and obj.vertex_groups[name].lock_weight:
            raise Refused("The vertex group {name} is locked. Unlock it, or give it another name.", name=name)


def own_materials(obj, cut, names):
    """One for each part, of its own colour, in place of the mesh's."""
    mesh = obj.data
    mesh.materials.clear()
    for name, color in zip(names, colors(cut.keys)):
        mesh.materials.append(_material(f"{obj.name} {name}", color))
    arrays.set_material_indices(mesh, cut.labels)


def kept_materials(obj, cut, _names):
    """The mesh's own, with a slot for each part: several where a part has several materials."""
    mesh = obj.data
    before = list(mesh.materials) or [None]
    indices = np.clip(arrays.material_indices(mesh), 0, len(before) - 1)
    slots, index = np.unique(np.column_stack([cut.labels, indices]), axis=0, return_inverse=True)
    mesh.materials.clear()
    for _, material in slots.tolist():
        mesh.materials.append(before[material])
    arrays.set_material_indices(mesh, index.ravel().astype(np.int32))


def _material(name, color):
    material = bpy.data.materials.get(name) or bpy.data.materials.new(name)
    material.diffuse_color = *color, 1
    material.use_nodes = True
    for node in material.node_tree.nodes:
        if node.type == "BSDF_PRINCIPLED":
            node.inputs["Base Color"].default_value = *(color ** 2.2), 1
    return material
