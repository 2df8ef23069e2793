# SPDX-License-Identifier: GPL-3.0-or-later
"""What can't be done and why, in sentences for users: as errors, and for poll(), where Blender shows them."""

from partwheel import Error


class Refused(Error, ValueError):
    """This can't be done with this part, or object; nothing has changed. str() is sentences for the user."""


def can(cls, holds, reason):
    """For an operator's poll(): whether it can start; if not, the reason is shown, as Blender does without a period."""
    if not holds:
        cls.poll_message_set(reason.rstrip("."))
    return bool(holds)


def read_only(obj):
    """A sentence why the object's mesh can't be changed, for another file holds it, or None."""
    if obj.library or obj.data.library:
        reason = "is linked from another file"
    elif obj.data.override_library:
        reason = "is a library override, which Blender does not edit"
    else:
        return None
    return f"The mesh of {obj.name} {reason}: make it local first (Object > Relations > Make Local)"


def changeable(cls, obj):
    """The same for poll()."""
    return can(cls, not read_only(obj), read_only(obj))


class NeedsMesh:
    """Mixed into an operator, ahead of bpy.types.Operator: it needs an active mesh object."""

    @classmethod
    def poll(cls, context):
        obj = context.active_object
        return can(cls, obj is not None and obj.type == "MESH" and obj.mode in {"EDIT", "OBJECT"},
                   "Needs an active mesh object, in Edit Mode or Object Mode")
