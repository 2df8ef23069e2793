# SPDX-License-Identifier: GPL-3.0-or-later
"""All that the add-on knows of each mesh, until another file is opened, and what makes it wrong.

Meshes and objects are found by identities that stay valid across undo and file loading, where pointers into Blender's
data dangle: objects by their full name, because a linked and a local object may share the short one."""

from collections.abc import Iterable, Iterator
import contextlib
from enum import Enum
import itertools
from typing import Any

import bmesh
import bpy

_revisions = itertools.count()  # never repeats, so a value differs from all earlier ones of any mesh


def mesh_key(mesh: bpy.types.Mesh) -> int | str:
    """Return an identity that outlives undo: the session UID; before Blender 4.1 the full name, which may change."""
    return getattr(mesh, "session_uid", None) or mesh.name_full


def element_counts(mesh: bpy.types.Mesh) -> tuple[int, int]:
    """Return (vertex count, polygon count), also in Edit Mode, O(1). Different counts mean a changed mesh."""
    if mesh.is_editmode:
        bm = bmesh.from_edit_mesh(mesh)
        return len(bm.verts), len(bm.faces)
    return len(mesh.vertices), len(mesh.polygons)


def find_object(name_full: str) -> bpy.types.Object | None:
    """Return the object with this full name, or None."""
    obj = bpy.data.objects.get(name_full)  # a linked object may match, too
    if obj is None or obj.name_full != name_full:
        obj = next((other for other in bpy.data.objects if other.name_full == name_full), None)
    return obj


def resolve_object(name: str) -> bpy.types.Object | None:
    """Return the object that a user or a script names: by full name, or else by its name without the library."""
    return find_object(name) or bpy.data.objects.get(name)


class MeshState:
    """What is known of one mesh. Modules of later layers fill it in; invalidate() says what may be wrong by now.

    A revision differs after each change of its kind that Blender reports:
    geometry_revision: of geometry or visibility. Selecting is no change.
    display_revision: of what modifiers show, for example in another frame.
    update_revision: any update, also of the selection."""

    def __init__(self, key: int | str) -> None:
        self.key = key  # mesh_key() of the mesh
        self.geometry_revision = self.display_revision = self.update_revision = next(_revisions)
        self.written_revision = None  # update_revision when a MeshSnapshot last wrote edits back
        self.entry: Any = None  # registry.HierarchyEntry
        self.unmatched_revision = None  # geometry_revision when no identical mesh was found
        self.stored: bytes | None = None  # the packed hierarchy that came with the file, until its first use
        self.is_from_newer_version = False  # whether that was of a newer version, which the user doesn't know yet
        self.pick: Any = None  # picks.Pick
        self.past_picks: list[tuple] = []  # [(summary and digest of the selection, Pick), ...], newest last
        self.view_cache: Any = None  # view_cache.ViewCache
        self.creases: Any = None  # (Fingerprint, Creases)
        self.border_lines: tuple = (None, None)  # geometry_revision, overlay.Drawable of the drawn borders or None

    @property
    def revision(self) -> tuple[int, int]:
        """A value that differs after each change of geometry or display."""
        return self.geometry_revision, self.display_revision


class Reason(Enum):
    """Why what is stored for a mesh may be out of date, and the revisions that change."""

    UPDATE = ["update_revision"]  # Blender reports an update of any kind, such as of the selection
    GEOMETRY = ["geometry_revision"]  # Blender reports a change of geometry or visibility
    DISPLAY = ["display_revision"]  # modifiers show the mesh differently
    UNDO = ["geometry_revision", "update_revision"]  # undo or redo


_states: dict[int | str, MeshState] = {}  # by mesh_key
is_ignoring_reports = False  # within ignore_reports()


def get_mesh_state(mesh: bpy.types.Mesh) -> MeshState:
    """Return the MeshState of the mesh, a new one at first."""
    key = mesh_key(mesh)
    if key not in _states:
        _states[key] = MeshState(key)
    return _states[key]


def list_states() -> list[MeshState]:
    return list(_states.values())


def invalidate(reason: Reason, mesh: bpy.types.Mesh | None = None) -> None:
    """Record why what is known of a mesh, by default of all meshes, may be wrong."""
    for state in [get_mesh_state(mesh)] if mesh else _states.values():
        for name in reason.value:
            setattr(state, name, next(_revisions))
        if reason is Reason.UNDO and state.entry:
            state.entry.assume_fit()


@contextlib.contextmanager
def ignore_reports() -> Iterator[None]:
    """Within, the changes that Blender reports are not the user's."""
    global is_ignoring_reports
    before, is_ignoring_reports = is_ignoring_reports, True
    try:
        yield
    finally:
        is_ignoring_reports = before


def find_deleted() -> list[MeshState]:
    """Return the states of meshes that no longer exist."""
    return [_states[key] for key in _states.keys() - {mesh_key(mesh) for mesh in bpy.data.meshes}]


def forget_states(states: Iterable[MeshState]) -> None:
    for state in states:
        del _states[state.key]
