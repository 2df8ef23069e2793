# SPDX-License-Identifier: GPL-3.0-or-later
"""Conditions for poll() methods of operators. Blender shows the reason when one doesn't hold."""

from collections.abc import Container

import bpy

from ..translations.lookup import tip_
from .errors import read_only_reason

DYNAMIC_TOPOLOGY_REASON = "Dynamic topology changes the faces all the time: turn it off first."


def check_poll(cls: type[bpy.types.Operator], condition: object, reason: str | None) -> bool:
    """Return whether the condition holds; otherwise set the reason, an English sentence, as the operator's poll message:
    translated and without its final period, as Blender's own messages have none."""
    if not condition:
        cls.poll_message_set(tip_(reason).rstrip(".。"))
    return bool(condition)


def poll_is_editable(cls: type[bpy.types.Operator], obj: bpy.types.Object) -> bool:
    """Return whether the object's mesh can be changed; otherwise set the poll message."""
    return check_poll(cls, not read_only_reason(obj), read_only_reason(obj))


def poll_in_modes(cls: type[bpy.types.Operator], context: bpy.types.Context, modes: Container[str], reason: str) -> bool:
    """Return whether the active mesh can be changed in one of these modes of the context; otherwise set the poll
    message: reason if it is the mode."""
    obj = context.active_object
    return (check_poll(cls, context.mode in modes and obj is not None and obj.type == "MESH", reason)
            and poll_is_editable(cls, obj)
            and check_poll(cls, not obj.use_dynamic_topology_sculpting, DYNAMIC_TOPOLOGY_REASON))


class NeedsEditMode:
    """Mixin for operators, listed before bpy.types.Operator: poll() requires Edit Mode of a mesh."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return check_poll(cls, context.mode == "EDIT_MESH" and context.edit_object,
                          "Select parts in Edit Mode of a mesh.")


class NeedsActiveMesh:
    """Mixin for operators, listed before bpy.types.Operator: poll() requires an active mesh object."""

    needs_editable = False  # whether poll() also requires that the mesh can be changed

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        obj = context.active_object
        is_mesh = obj is not None and obj.type == "MESH" and obj.mode in {"EDIT", "OBJECT"}
        return (check_poll(cls, is_mesh, "This is for an active mesh object, in Edit Mode or Object Mode.")
                and (not cls.needs_editable or poll_is_editable(cls, obj)))
