# SPDX-License-Identifier: GPL-3.0-or-later
"""The target of a pick that changes nothing before it is confirmed."""

from __future__ import annotations

import bpy

from ..mesh import mesh_identity


class PreviewTarget:
    """The overlay alone shows the part: no element of the mesh is touched, which a million of them would be felt by."""

    def __init__(self, obj: bpy.types.Object) -> None:
        self.name, self.mode, self.faces = obj.name_full, obj.mode, len(obj.data.polygons)

    def select(self, *_: object) -> None:
        """What is drawn says it all."""

    def restore(self) -> None:
        """Nothing was changed."""

    def is_valid(self) -> bool:
        obj = mesh_identity.find_object(self.name)
        return obj is not None and obj.mode == self.mode and len(obj.data.polygons) == self.faces
