# SPDX-License-Identifier: GPL-3.0-or-later
"""Messages of errors; above all why the native library can't be loaded: in the preferences, in the panel, and on a click."""

import textwrap
import unicodedata

import bpy

from .translations.lookup import translate_error
from partwheel import Error, LibraryError
from partwheel.library import load

# Average letter of Blender's interface font at scale 1; width of frames and tabs in a region.
PIXELS_PER_LETTER, MARGIN_PIXELS = 6, 40

_logged = set()


def find_library_error() -> str:
    """Return sentences on why the library can't be used and what to do; "" if it can."""
    try:
        load()
        return ""
    except LibraryError as error:
        return describe_error(error)


def describe_error(error: Error) -> str:
    """Return the error's message, translated. Of a LibraryError, also print it and the loader's own message, once."""
    if isinstance(error, LibraryError) and str(error) not in _logged:
        _logged.add(str(error))
        print(f"Partwheel: {error}" + (f"\nThe loader said: {error.__cause__}" if error.__cause__ else ""), flush=True)
    return translate_error(error)


def draw_library_error(context: bpy.types.Context, layout: bpy.types.UILayout) -> bool:
    """Draw the error in a panel or the preferences, and return whether there is one."""
    sentences = find_library_error()
    if sentences:
        column = layout.column(align=True)
        column.alert = True
        draw_wrapped_text(context, column, sentences, icon="ERROR")
    return bool(sentences)


def draw_wrapped_text(context: bpy.types.Context, column: bpy.types.UILayout, text: str, icon: str = "NONE") -> None:
    width = context.region.width / context.preferences.system.ui_scale - MARGIN_PIXELS
    for line in wrap_text(text, max(int(width / PIXELS_PER_LETTER), 20)):
        column.label(text=line, icon=icon, translate=False)
        icon = "BLANK1" if icon != "NONE" else icon


def wrap_text(text: str, letters: int) -> list[str]:
    """Wrap the text at this many letters. East Asian letters are twice as wide, and a line may end after any of them."""
    widths = [2 if unicodedata.east_asian_width(letter) in "WF" else 1 for letter in text]
    if sum(widths) == len(text):
        return textwrap.wrap(text, letters)
    lines, width_used = [""], 0
    for letter, width in zip(text, widths):
        if width_used + width > letters:
            lines, width_used = [*lines, ""], 0
        lines[-1] += letter
        width_used += width
    return lines
