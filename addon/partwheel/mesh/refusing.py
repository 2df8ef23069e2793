# SPDX-License-Identifier: GPL-3.0-or-later
"""What can't be done and why, in sentences for users: as errors, and for poll(), where Blender shows them."""

from ..words.say import rpt_, tip_
from partwheel import Error


class Told(Error):
    """str() is sentences for the user, in the user's language."""

    def __init__(self, sentences, **values):
        """values: for what stands in braces."""
        super().__init__(rpt_(sentences).format(**values) if values else rpt_(sentences))


class Refused(Told, ValueError):
    """This can't be done with this part, or object; nothing has changed."""


def can(cls, holds, reason):
    """For an operator's poll(): whether it can start; if not, the reason is shown, as Blender does without a period."""
    if not holds:
        cls.poll_message_set(tip_(reason).rstrip(".。"))
    return bool(holds)


def read_only(obj):
    """A sentence why the object's mesh can't be changed, for another file holds it, or None."""
    if obj.library or obj.data.library:
        reason = rpt_("The mesh of {name} is linked from another file: make it local first (Object > Relations > Make "
                      "Local).")
    elif obj.data.override_library:
        reason = rpt_("The mesh of {name} is a library override, which Blender does not edit: make it local first "
                      "(Object > Relations > Make Local).")
    else:
        return None
    return reason.format(name=obj.name)


def changeable(cls, obj):
    """The same for poll()."""
    return can(cls, not read_only(obj), read_only(obj))


class NeedsMesh:
    """Mixed into an operator, ahead of bpy.types.Operator: it needs an active mesh object."""

    @classmethod
    def poll(cls, context):
        obj = context.active_object
        return can(cls, obj is not None and obj.type == "MESH" and obj.mode in {"EDIT", "OBJECT"},
                   "This is for an active mesh object, in Edit Mode or Object Mode.")
