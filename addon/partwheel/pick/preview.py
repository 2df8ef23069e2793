# SPDX-License-Identifier: GPL-3.0-or-later
"""The target of a pick that changes nothing before it is confirmed."""

from __future__ import annotations

import bpy
import numpy as np

from ..mesh import mesh_identity


class PreviewTarget:
    """Shows the part in the overlay only. The mesh is not touched, which would be slow for a million elements."""

    def __init__(self, obj: bpy.types.Object) -> None:
        self.name, self.mode, self.faces = obj.name_full, obj.mode, len(obj.data.polygons)

    def select(self, *_: object) -> None:
        """Do nothing: the overlay shows the part."""

    def selected_before(self, _obj: bpy.types.Object) -> np.ndarray | None:
        """Return the faces to which the part is added, as far as they can be seen: here none."""
        return None

    def restore(self) -> None:
        """Do nothing: nothing was changed."""

    def is_valid(self) -> bool:
        """Return whether the object is in the same mode and has as many faces as before."""
        obj = mesh_identity.find_object(self.name)
        return obj is not None and obj.mode == self.mode and len(obj.data.polygons) == self.faces
