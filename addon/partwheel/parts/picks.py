# SPDX-License-Identifier: GPL-3.0-or-later
"""The part that was picked and confirmed last in each mesh. Undo restores the previous one."""

import hashlib
from operator import attrgetter
from typing import NamedTuple

import bmesh
import bpy
import numpy as np

from ..mesh import MeshSnapshot, Refused, arrays, check_poll, get_mesh_state
from . import registry
from partwheel import Hierarchy

NO_PICK = "No part is picked. Pick one with Select Part by Wheel, and confirm it."


class Pick(NamedTuple):
    """A part that the user chose: a node, and the face that was clicked. snap: whether its border is in creases."""

    node: int
    face: int
    hierarchy: Hierarchy
    snap: bool


MAX_PAST_PICKS = 32  # per mesh, that undo can restore


def remember(snapshot: MeshSnapshot, face: int, node: int, snap: bool = False) -> None:
    """Record that the user has chosen this part of the mesh, which has a hierarchy."""
    snapshot.state.pick = Pick(int(node), int(face), registry.find_hierarchy(snapshot.mesh), bool(snap))


def record_selection(snapshot: MeshSnapshot) -> None:
    """Record the mesh's selection after the pick, so that undo can find the pick by it."""
    mesh, pick, past = snapshot.mesh, snapshot.state.pick, snapshot.state.past_picks
    if pick:
        past[:] = [past_pick for past_pick in past if past_pick[1].hierarchy is pick.hierarchy][1 - MAX_PAST_PICKS:] + [
            ((_summarize_selection(mesh), _hash_selection(mesh)), pick)]


def _summarize_selection(mesh: bpy.types.Mesh) -> tuple[int, int]:
    """Return (active face, number of selected faces), fast in Edit Mode. If they differ, so do the selections."""
    if mesh.is_editmode:
        active = bmesh.from_edit_mesh(mesh).faces.active
        return active.index if active else -1, mesh.total_face_sel
    return mesh.polygons.active, int(np.count_nonzero(arrays.read(mesh.polygons, "select", bool)))


def _hash_selection(mesh: bpy.types.Mesh) -> bytes:
    if mesh.is_editmode:
        faces = bmesh.from_edit_mesh(mesh).faces
        selected = np.fromiter(map(attrgetter("select"), faces), bool, len(faces))
    else:
        selected = arrays.read(mesh.polygons, "select", bool)
    return hashlib.blake2b(np.packbits(selected), digest_size=16).digest()


def restore_picks() -> None:
    """After undo, restore in each mesh the newest pick whose selection equals the current one. In Object Mode, drop the
    pick if nothing is selected; otherwise keep it."""
    for mesh in bpy.data.meshes:
        state = get_mesh_state(mesh)
        if state.past_picks:
            summary = _summarize_selection(mesh)
            candidates = [(digest, pick) for (before, digest), pick in reversed(state.past_picks) if before == summary]
            current = _hash_selection(mesh) if candidates else None
            pick = next((pick for digest, pick in candidates if digest == current), None)
            if pick:
                state.pick = pick
            elif not (mesh.is_editmode or summary[1]):
                state.pick = None


def get_pick(snapshot: MeshSnapshot) -> Pick | None:
    """Return the last Pick in the mesh; None if there is none or its hierarchy is not the mesh's any more."""
    pick = snapshot.state.pick
    return pick if pick and registry.get_hierarchy(snapshot) is pick.hierarchy else None


def get_pick_for_poll(obj: bpy.types.Object) -> Pick | None:
    """Return get_pick() for panels and poll(), which Blender calls often: as far as registry.get_state() knows."""
    pick = get_mesh_state(obj.data).pick
    if not pick:
        return None
    state, entry = registry.get_state(obj.data)
    return pick if state in registry.USABLE and entry.hierarchy is pick.hierarchy else None


def resolve_node(snapshot: MeshSnapshot, node: int) -> tuple[Hierarchy, int]:
    """Return (hierarchy of the mesh, node). For node -1, the last pick. Raises Refused."""
    hierarchy = registry.require_hierarchy(snapshot)
    if node >= len(hierarchy.parent):
        raise Refused("There is no part {number}: there are {count}.", number=node, count=len(hierarchy.parent))
    pick = get_pick(snapshot)
    if node < 0 and not pick:
        raise Refused(NO_PICK)
    return hierarchy, node if node >= 0 else pick.node


class NeedsPick:
    """Mixin for operators, listed before bpy.types.Operator: poll() requires a pick, in Edit Mode."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return check_poll(cls, context.mode == "EDIT_MESH" and get_pick_for_poll(context.edit_object), NO_PICK)
