# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts that the user made by splitting and merging, and parts like them: wheel stops from then on. The mesh stores
them as a face attribute, which Blender preserves through edits, undo and copies: the number of the smallest such part
of each face, and in a property the number of the part around each part. 0: none."""

import hashlib
import json

import bpy
import numpy as np

from partwheel.likeness import MAX_OWN_PARTS
from ..mesh import arrays, parse_json

ATTRIBUTE = "partwheel_own_part"
PROPERTY = "partwheel_own_parts"  # JSON: the number of the part around part 1, 2, ...


def load(mesh: bpy.types.Mesh) -> list[np.ndarray]:
    """Masks (F,) of the parts, the largest first; any two are nested or disjoint."""
    labels = _read_labels(mesh)
    if labels is None:
        return []
    count = int(labels.max(initial=0))
    parents = _parse_parents(mesh.get(PROPERTY), count)
    masks = []
    for part in range(1, count + 1):
        inside = {part}
        for child in range(part + 1, count + 1):
            if parents[child - 1] in inside:
                inside.add(child)
        masks.append(np.isin(labels, list(inside)))
    return [mask for mask in masks if mask.any()]


def save(mesh: bpy.types.Mesh, masks: list[np.ndarray]) -> None:
    """Stores masks (F,), any two nested or disjoint. Outside Edit Mode."""
    masks = sorted(masks, key=np.count_nonzero, reverse=True)
    labels, parents = np.zeros(len(mesh.polygons), np.int32), []
    for number, mask in enumerate(masks, 1):
        parents.append(int(labels[mask][0]))
        labels[mask] = number
    arrays.ensure_attribute(mesh, ATTRIBUTE, "INT", "FACE").data.foreach_set("value", labels)
    mesh[PROPERTY] = json.dumps(parents)


def digest(mesh: bpy.types.Mesh) -> bytes:
    """A digest of the stored parts; b"" if there are none. O(F) if there are some."""
    labels = _read_labels(mesh)
    if labels is None or not labels.any():
        return b""
    return hashlib.blake2b(labels.tobytes() + str(mesh.get(PROPERTY)).encode(), digest_size=16).digest()


def _read_labels(mesh: bpy.types.Mesh) -> np.ndarray | None:
    """(F,) int32: the number of each face, 0 for invalid ones; None without the attribute."""
    labels = arrays.read_face_integers(mesh, ATTRIBUTE)
    return None if labels is None else np.where((labels > 0) & (labels <= MAX_OWN_PARTS), labels, 0)


def _parse_parents(text: object, count: int) -> list[int]:
    """The number around each of count parts, from the property, which may hold anything if others have written it."""
    parsed = parse_json(text)
    parents = parsed if isinstance(parsed, list) else []
    parents = [parent if type(parent) is int and 0 <= parent < number else 0 for number, parent in enumerate(parents, 1)]
    return (parents + [0] * count)[:count]
