# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that are held for longer than a moment: undo makes them anew, so it is by name, the one in full, for a linked
and a local one may have the same."""

import bpy


def named(name_full):
    """The object that is named so, or None."""
    found = bpy.data.objects.get(name_full)  # any linked one too
    if found is None or found.name_full != name_full:
        found = next((obj for obj in bpy.data.objects if obj.name_full == name_full), None)
    return found


def wanted(name):
    """The one that a user or a script names, in full or, where that is none, without its library."""
    return named(name) or bpy.data.objects.get(name)
