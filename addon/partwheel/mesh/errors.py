# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors whose messages are sentences for users, in the user's language."""

from collections.abc import Callable
import functools
from typing import Any

import bpy

from ..translations.lookup import rpt_
from partwheel import Error


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
            self.report({"ERROR"}, str(error))
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
