# SPDX-License-Identifier: GPL-3.0-or-later
"""Conditions for poll() methods of operators. Blender shows the reason when one doesn't hold."""

from __future__ import annotations

import bpy

from ..words.say import tip_
from .errors import read_only_reason


def check_poll(cls: type[bpy.types.Operator], condition: object, reason: str | None) -> bool:
    """Return whether the condition holds; otherwise set the reason as the operator's poll message.

    Parameters
    ----------
    reason : English sentence; it is translated and loses its final period, as Blender's own messages have none.
    """
    if not condition:
        cls.poll_message_set(tip_(reason).rstrip(".。"))
    return bool(condition)


def poll_is_editable(cls: type[bpy.types.Operator], obj: bpy.types.Object) -> bool:
    """Return whether the object's mesh can be changed; otherwise set the poll message."""
    return check_poll(cls, not read_only_reason(obj), read_only_reason(obj))


class NeedsActiveMesh:
    """Mixin for operators, listed before bpy.types.Operator: poll() requires an active mesh object."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        obj = context.active_object
        return check_poll(cls, obj is not None and obj.type == "MESH" and obj.mode in {"EDIT", "OBJECT"},
                          "This is for an active mesh object, in Edit Mode or Object Mode.")
