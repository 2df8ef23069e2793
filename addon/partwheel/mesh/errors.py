# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors whose messages are sentences for users, in the user's language; and conditions of poll(), of which Blender
shows the reason when one doesn't hold."""

from collections.abc import Callable, Container
import functools
from typing import Any

import bpy

from ..library_error import describe_error
from ..translations.lookup import rpt_, tip_
from partwheel import Error

DYNAMIC_TOPOLOGY_REASON = "Dynamic topology changes the faces all the time: turn it off first."


class UserError(Error):
    """An error whose str() is one or more sentences for the user, translated."""

    def __init__(self, sentences: str, **values: object) -> None:
        """Translate the English sentences, then fill in the values of their {fields}."""
        super().__init__(rpt_(sentences).format(**values) if values else rpt_(sentences))


class Refused(UserError, ValueError):
    """The operation can't be done with this part or object. Nothing has changed."""


def report_errors(execute: Callable[[Any, bpy.types.Context], set[str]]) -> Callable[[Any, bpy.types.Context], set[str]]:
    """Wrap execute() of an operator: an Error is reported, and cancels the operator."""
    @functools.wraps(execute)
    def execute_and_report(self, context):
        try:
            return execute(self, context)
        except Error as error:
            self.report({"ERROR"}, describe_error(error))
            return {"CANCELLED"}
    return execute_and_report


def read_only_reason(obj: bpy.types.Object) -> str | None:
    """Return a sentence on why the object's mesh can't be changed, because another file holds it; None if it can."""
    if obj.library or obj.data.library:
        reason = rpt_("The mesh of {name} is linked from another file: make it local first (Object > Relations > Make "
                      "Local).")
    elif obj.data.override_library:
        reason = rpt_("The mesh of {name} is a library override, which Blender does not edit: make it local first "
                      "(Object > Relations > Make Local).")
    else:
        return None
    return reason.format(name=obj.name)


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
    """Return whether the active mesh can be changed in these modes; else set the poll message: in others the reason."""
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
        return (check_poll(cls, is_mesh, "Select a mesh object, in Edit Mode or Object Mode.")
                and (not cls.needs_editable or poll_is_editable(cls, obj)))
