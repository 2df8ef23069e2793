# SPDX-License-Identifier: GPL-3.0-or-later
"""Leaving and reentering Edit Mode in an operator, so that its undo step holds all that it changes.

Blender's undo steps of Edit Mode hold only the meshes there. Undo to one restores all else from the last step before it
that has all data: changes of others since then, such as a new modifier, are lost, and those of the operator may stay."""

import bpy


def go_to_object_mode(obj: bpy.types.Object, is_repeat: bool = False) -> None:
    """Leave the mode of the object. From Edit Mode, push a step with all data first, to which undo returns. is_repeat:
    Adjust Last Operation repeats the operator, and has returned to that step."""
    if obj.mode == "EDIT" and not is_repeat:
        _store_all_in_next_step()
        bpy.ops.ed.undo_push(message="Edit Mode")
    if obj.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")


def return_to_mode(mode: str) -> None:
    """Enter a mode of the active object after changes in Object Mode."""
    if mode != "OBJECT":
        _store_all_in_next_step()
        bpy.ops.object.mode_set(mode=mode)


def _store_all_in_next_step() -> None:
    """Make Blender store all data with the next undo step of Edit Mode, as it does if there are other data-blocks."""
    bpy.data.meshes.remove(bpy.data.meshes.new("partwheel"))
