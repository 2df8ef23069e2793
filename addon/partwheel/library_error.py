# SPDX-License-Identifier: GPL-3.0-or-later
"""What the user is told while the native library can't be loaded: in the preferences, in the panel, at a click."""

from __future__ import annotations

import textwrap
import unicodedata

import bpy

from partwheel import LibraryError
from partwheel.library import load

# Of Blender's interface font, on average, at a scale of 1; and what frames and tabs take of a region's width.
PIXELS_PER_LETTER, MARGIN_PIXELS = 7, 40

_logged = set()


def library_error() -> str:
    """Why the library can't be used and what to do, in sentences; "" while it can."""
    try:
        load()
        return ""
    except LibraryError as error:
        return log_library_error(error)


def log_library_error(error: LibraryError) -> str:
    """The LibraryError's sentences. The loader's own words go to the log, once."""
    if str(error) not in _logged:
        _logged.add(str(error))
        print(f"Partwheel: {error}" + (f"\nThe loader said: {error.__cause__}" if error.__cause__ else ""), flush=True)
    return str(error)


def draw_library_error(context: bpy.types.Context, layout: bpy.types.UILayout) -> bool:
    """Says so in a panel or in the preferences: whether there is anything to be said."""
    sentences = library_error()
    if sentences:
        column = layout.column(align=True)
        column.alert = True
        draw_wrapped_text(context, column, sentences, icon="ERROR")
    return bool(sentences)


def draw_wrapped_text(context: bpy.types.Context, column: bpy.types.UILayout, text: str, icon: str = "NONE") -> None:
    """A text in lines as long as the region is wide."""
    width = context.region.width / context.preferences.system.ui_scale - MARGIN_PIXELS
    for line in wrap_text(text, max(int(width / PIXELS_PER_LETTER), 20)):
        column.label(text=line, icon=icon, translate=False)
        icon = "BLANK1" if icon != "NONE" else icon


def wrap_text(text: str, letters: int) -> list[str]:
    """[line, ...] of at most so many letters. Those of East Asia are twice as wide, and a line may end after any."""
    widths = [2 if unicodedata.east_asian_width(letter) in "WF" else 1 for letter in text]
    if sum(widths) == len(text):
        return textwrap.wrap(text, letters)
    found, used = [""], 0
    for letter, width in zip(text, widths):
        if used + width > letters:
            found, used = [*found, ""], 0
        found[-1] += letter
        used += width
    return found
