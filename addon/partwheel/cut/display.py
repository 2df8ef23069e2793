# SPDX-License-Identifier: GPL-3.0-or-later
"""What is drawn over the model while a cut is edited."""

import bpy
import numpy as np

from ..mesh import MeshSnapshot, find_object
from ..pick.view_cache import get_view_cache, is_at_rest, is_current
from ..view import overlay
from .states import CutState

ACTIVE_OPACITY, INACTIVE_OPACITY = 0.85, 0.4  # opacity of the active part, and of all others while there is one


class CutDisplay:
    """Draws the parts of a cut in their colors, where the object with this full name was displayed at the last update."""

    def __init__(self, name: str) -> None:
        self._name, self._parts = name, None

    def update(self) -> None:
        """Read the surface as it is displayed now."""
        if not bpy.app.background:
            snapshot = MeshSnapshot(find_object(self._name))
            self._parts = get_view_cache(snapshot).get_part_triangles(snapshot)
            overlay.redraw_views()

    def is_outdated(self) -> bool:
        """Return whether the surface is displayed differently now, such as in another frame."""
        return self._parts is not None and is_at_rest() and not is_current(find_object(self._name), self._parts)

    def draw(self, state: CutState) -> None:
        context, obj = bpy.context, find_object(self._name)
        if not obj or not overlay.is_visible(context, obj) or not is_current(obj, self._parts):
            return
        cut, part = state.cut, state.part

        def paint() -> np.ndarray:
            opacity = overlay.CUT_OPACITY if part is None else np.where(cut.labels == part, ACTIVE_OPACITY,
                                                                        INACTIVE_OPACITY)
            return overlay.make_distinct_colors(np.array(cut.keys)[cut.labels], opacity)

        overlay.draw_triangles(context, obj, self._parts.colored_batch(("whole", cut.parts, cut.keys, part), paint))
