# SPDX-License-Identifier: GPL-3.0-or-later
"""The catalogues beside this file, one per language: {English message: translation}. Blender shows a message that has
none in English."""

from __future__ import annotations

import importlib

import bpy

from .say import OPERATOR

# File -> what Blender calls the language; Chinese otherwise before 4.0.
LANGUAGES = {"german": ("de_DE",), "spanish": ("es",), "japanese": ("ja_JP",), "chinese": ("zh_HANS", "zh_CN")}


def register() -> None:
    """Blender wants all at once, and looks up only what it has no words for itself. A button of an operator looks for
    its text among operators' labels, so all are there too."""
    words = {}
    for file, languages in LANGUAGES.items():
        table = importlib.import_module(f".{file}", __package__).WORDS
        known = {(context, said): meant for said, meant in table.items() for context in ("*", OPERATOR)}
        words.update(dict.fromkeys(languages, known))
    bpy.app.translations.register(__package__, words)


def unregister() -> None:
    bpy.app.translations.unregister(__package__)
