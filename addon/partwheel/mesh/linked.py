# SPDX-License-Identifier: GPL-3.0-or-later
"""What can't be changed because another file holds it, in one sentence for all operators."""


def read_only(obj):
    """A sentence why the object's mesh can't be changed, or None."""
    if obj.library or obj.data.library:
        reason = "is linked from another file"
    elif obj.data.override_library:
        reason = "is a library override, which Blender does not edit"
    else:
        return None
    return f"The mesh of {obj.name} {reason}: make it local first (Object > Relations > Make Local)"


def changeable(cls, obj):
    """For an operator's poll(): whether the object's mesh can be changed; if not, Blender shows why it is grey."""
    reason = read_only(obj)
    if reason:
        cls.poll_message_set(reason)
    return not reason
