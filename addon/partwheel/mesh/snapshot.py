# SPDX-License-Identifier: GPL-3.0-or-later
"""An object's mesh during one step of the add-on: what functions get that need the mesh up to date."""

from functools import cached_property

import bpy

from . import arrays
from .arrays import Fingerprint
from .mesh_state import get_mesh_state


class MeshSnapshot:
    """An object's mesh and its MeshState during one step, in which no other code changes the mesh.

    A step creates it, passes it on, and does not keep it. So the edits of Edit Mode are written back, and the mesh is
    hashed, at most once: each takes half a second for a million faces. Creating it is O(1), also while Blender draws."""

    def __init__(self, obj: bpy.types.Object, trust_reports: bool = False) -> None:
        """trust_reports: whether Blender has reported all changes so far. Then edits that were written back after the
        last report need not be written back again. Scripts may change a mesh without any report."""
        self.obj, self.mesh, self.state, self.trust_reports = obj, obj.data, get_mesh_state(obj.data), trust_reports
        self.is_up_to_date = obj.mode != "EDIT" or (
            trust_reports and self.state.written_revision == self.state.update_revision)

    def update_mesh(self) -> bpy.types.Mesh:
        """Return the mesh as arrays.update_mesh() does, which it calls at most once."""
        if not self.is_up_to_date:
            arrays.update_mesh(self.obj)
            self.state.written_revision, self.is_up_to_date = self.state.update_revision, True
        return self.mesh

    @cached_property
    def fingerprint(self) -> Fingerprint:
        """The Fingerprint of the mesh, which is updated first."""
        return arrays.compute_fingerprint(self.update_mesh(), self.obj)
