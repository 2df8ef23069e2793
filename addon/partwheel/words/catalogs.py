# SPDX-License-Identifier: GPL-3.0-or-later
"""The catalogs beside this file, one per language: {English message: translation}. Untranslated messages stay English.
"""

from __future__ import annotations

import importlib

import bpy

from .say import OPERATOR

# File -> Blender's names of the language. Chinese had another one before 4.0.
LANGUAGES = {"german": ("de_DE",), "spanish": ("es",), "japanese": ("ja_JP",), "chinese": ("zh_HANS", "zh_CN")}


def register() -> None:
    """Register all catalogs at once, as Blender requires; it looks up only texts that it has no translation for.
    Buttons of operators look in the context of operator labels, so each text is registered there, too.
    """
    catalogs = {}
    for file, languages in LANGUAGES.items():
        table = importlib.import_module(f".{file}", __package__).WORDS
        messages = {(context, text): translation for text, translation in table.items() for context in ("*", OPERATOR)}
        catalogs.update(dict.fromkeys(languages, messages))
    bpy.app.translations.register(__package__, catalogs)


def unregister() -> None:
    bpy.app.translations.unregister(__package__)
