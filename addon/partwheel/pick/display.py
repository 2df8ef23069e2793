# SPDX-License-Identifier: GPL-3.0-or-later
"""What a running pick shows over the model: the part, what the next notch adds, and the whole objects of groups."""

from collections.abc import Callable

import bpy
import numpy as np

from ..mesh import MeshSnapshot, find_object, get_mesh_state
from ..view import overlay
from ..view.visible_surface import read_displayed_triangles
from .states import PickedPart
from .view_cache import get_view_cache, is_at_rest

MAX_TINTED = 256  # objects of a group that are drawn, since each takes a while


class PickDisplay:
    """Draws the pick of the running operator in every 3D view, unless the object has changed since, as in another frame."""

    def __init__(self) -> None:
        self.clear()

    def clear(self) -> None:
        self._target = self._fits = self._picked = None  # target: the object's full name, and arguments of draw_picked_part()
        self._triangles = {}  # full name of an object of the groups -> its ObjectTriangles

    @property
    def is_shown(self) -> bool:
        return self._target is not None

    def read_groups(self, obj: bpy.types.Object, picked: PickedPart) -> None:
        """Read the triangles of the objects in the groups that have changed since they were last read."""
        for member in _find_tinted_objects(obj, picked):
            if not self._is_current(member):
                self._triangles[member.name_full] = overlay.ObjectTriangles(*read_displayed_triangles(member),
                                                                            _make_change_test(member))

    def show(self, obj: bpy.types.Object, parts: overlay.PartTriangles, picked: PickedPart,
             *faces: np.ndarray | None) -> None:
        """Draw this pick. faces: snapped and selected, see overlay.draw_picked_part()."""
        self._target = obj.name_full, parts, picked.node, picked.next, *faces
        self._fits, self._picked = _make_change_test(obj), picked
        overlay.redraw_views()

    def update_frame(self, obj: bpy.types.Object) -> None:
        """Draw the pick in the current frame, once playback has stopped."""
        if (self.is_shown and is_at_rest()
                and not (self._fits(obj) and all(map(self._is_current, _find_tinted_objects(obj, self._picked))))):
            self.read_groups(obj, self._picked)
            snapshot = MeshSnapshot(obj)
            self.show(obj, get_view_cache(snapshot).get_part_triangles(snapshot), self._picked, *self._target[4:])

    def draw(self) -> None:
        if self.is_shown:
            context, (name, *part) = bpy.context, self._target
            obj = find_object(name)
            if obj and overlay.is_visible(context, obj) and self._fits(obj):
                overlay.draw_picked_part(context, obj, *part)
            groups = self._picked.group - {name}, self._picked.next_group - {name}
            overlay.draw_whole_objects(context, self._triangles, *groups)

    def _is_current(self, obj: bpy.types.Object) -> bool:
        return obj.name_full in self._triangles and self._triangles[obj.name_full].fits(obj)


pick_display = PickDisplay()  # there is one pick at a time


def _find_tinted_objects(obj: bpy.types.Object, picked: PickedPart) -> list[bpy.types.Object]:
    names = (picked.group | picked.next_group) - {obj.name_full}
    return list(filter(None, map(find_object, sorted(names)[:MAX_TINTED])))


def _make_change_test(obj: bpy.types.Object) -> Callable[[bpy.types.Object], bool]:
    """Return a function that returns whether the object is still displayed as it is now."""
    revision = get_mesh_state(obj.data).display_revision
    return lambda obj: get_mesh_state(obj.data).display_revision == revision
