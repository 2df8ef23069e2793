# SPDX-License-Identifier: GPL-3.0-or-later
"""Names of parts from what a model has already: the bone that moves a part, its material, its vertex group."""

from collections.abc import Collection
import re

import bpy
import numpy as np

from ..mesh import arrays
from ..mesh.elements import read_weights
from ..solid.solids import CAP_MATERIAL_NAME
from . import layers
from partwheel.cut import Cut
from partwheel.cut.names import MIN_SHARE, find_majority


def find_names(obj: bpy.types.Object, cut: Cut) -> list[str | None]:
    """For each part the name of the bone that moves it (its humanoid name, if it has one in VRM), else of its material,
    if there are several, else of its vertex group; None without any."""
    mesh = obj.data
    areas = arrays.read(mesh.polygons, "area", np.float32).astype(float)
    part_areas = np.maximum(np.bincount(cut.labels, areas, len(cut)), 1e-300)
    bone_names = _find_bone_names(obj)
    own = layers.own_groups(obj)
    groups = [group for group in obj.vertex_groups if group.name not in own]
    shares = _group_areas(mesh, cut, areas, [group.index for group in groups]) / part_areas
    is_bone = np.array([group.name in bone_names for group in groups], bool)
    bones = [bone_names[group.name] for group in groups if group.name in bone_names]
    others = [group.name for group in groups if group.name not in bone_names]
    materials, material_areas = _material_areas(obj, cut, areas)
    named = (find_majority(bones, shares[is_bone] / np.maximum(shares[is_bone].sum(axis=0), MIN_SHARE)),
             find_majority(materials, material_areas / part_areas), find_majority(others, shares[~is_bone]))
    return [next(filter(None, names), None) for names in zip(*named)]


def _group_areas(mesh: bpy.types.Mesh, cut: Cut, areas: np.ndarray, groups: Collection[int]) -> np.ndarray:
    """(groups, parts) the area of each part times its weights in each group."""
    sizes = arrays.read_polygon_sizes(mesh)[1]
    labels, corner_areas = np.repeat(cut.labels, sizes), np.repeat(areas / sizes, sizes)
    corners = arrays.read_corner_vertices(mesh)
    of_groups = read_weights(mesh, groups) if groups else ()
    areas_in_groups = [np.bincount(labels, corner_areas * weights[corners], len(cut)) for weights in of_groups]
    return np.array(areas_in_groups).reshape(-1, len(cut))


def _material_areas(obj: bpy.types.Object, cut: Cut, areas: np.ndarray) -> tuple[list[str], np.ndarray]:
    """(names of the materials, (materials, parts) area); none if the whole model has the same one."""
    slots = np.minimum(arrays.read_material_indices(obj.data), max(len(obj.material_slots) - 1, 0))
    of_names = {}
    for index, material in enumerate(slot.material for slot in obj.material_slots):
        if material and not material.name.startswith(CAP_MATERIAL_NAME):
            of_slot = np.bincount(cut.labels, areas * (slots == index), len(cut))
            of_names[material.name] = of_names.get(material.name, 0) + of_slot
    names = sorted(name for name, of_name in of_names.items() if of_name.any())
    return (names, np.array([of_names[name] for name in names])) if len(names) > 1 else ([], np.empty((0, len(cut))))


def find_rigs(obj: bpy.types.Object) -> list[bpy.types.Object]:
    """The armature objects that deform an object, by modifiers or as its parent."""
    rigs = [modifier.object for modifier in obj.modifiers if modifier.type == "ARMATURE"]
    return list(filter(None, [*rigs, obj.parent if obj.parent_type == "ARMATURE" else None]))


def _find_bone_names(obj: bpy.types.Object) -> dict[str, str]:
    """{vertex group: name} of the bones that deform the object."""
    names = {}
    for rig in find_rigs(obj):
        humanoid = _read_humanoid_map(rig.data)
        names.update((bone.name, humanoid.get(bone.name, bone.name)) for bone in rig.data.bones if bone.use_deform)
    return names


def _read_humanoid_map(armature: bpy.types.Armature) -> dict[str, str]:
    """{bone: readable humanoid name} from the VRM add-on's data, versions 0 and 1, whether or not it is enabled."""
    extension = armature.get("vrm_addon_extension", getattr(armature, "vrm_addon_extension", None))
    if extension is None:
        return {}
    result = {}
    human_bones = _read(extension, "vrm1", "humanoid", "human_bones")
    for kind in human_bones.keys() if human_bones is not None else ():
        result[_read(human_bones, kind, "node", "bone_name")] = kind
    for human_bone in _read(extension, "vrm0", "humanoid", "human_bones") or ():
        result[_read(human_bone, "node", "bone_name")] = _read(human_bone, "bone")
    return {bone: _humanoid_name(kind) for bone, kind in result.items() if isinstance(bone, str) and bone
            and isinstance(kind, str) and kind}


def _read(data: object, *path: str) -> object:
    """A nested entry of ID properties or of an add-on's properties; None without one."""
    for name in path:
        data = data.get(name, getattr(data, name, None)) if hasattr(data, "get") else getattr(data, name, None)
    return data


def _humanoid_name(kind: str) -> str:
    """"leftUpperArm", "left_upper_arm" -> "upper arm.L" """
    words = re.sub(r"([A-Z])", r"_\1", kind).lower().split("_")
    side = {"left": ".L", "right": ".R"}.get(words[0], "")
    return " ".join(words[1:] if side else words) + side
