# SPDX-License-Identifier: GPL-3.0-or-later
"""What several operators need before they can start: mixed into them, ahead of bpy.types.Operator."""

from ..parts import picks


class NeedsMesh:
    """An active mesh object."""

    @classmethod
    def poll(cls, context):
        obj = context.active_object
        if obj is None or obj.type != "MESH" or obj.mode not in {"EDIT", "OBJECT"}:
            cls.poll_message_set("Needs an active mesh object, in Edit Mode or Object Mode")
            return False
        return True


class NeedsPick:
    """A part that was picked, in Edit Mode."""

    @classmethod
    def poll(cls, context):
        if context.mode != "EDIT_MESH" or picks.picked_as_told(context.edit_object) is None:
            cls.poll_message_set("Pick a part first, in Edit Mode")
            return False
        return True
