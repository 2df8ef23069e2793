# SPDX-License-Identifier: GPL-3.0-or-later
"""Registers the translations, which scripts/package reads from the .po files beside this file. Untranslated messages
stay English."""

from __future__ import annotations

import json
from pathlib import Path

import bpy

from .lookup import OPERATOR

DICTIONARY = Path(__file__).with_name("dictionary.json")  # {language: {message: translation}}; in packages only
OLD_NAMES = {"zh_HANS": "zh_CN"}  # Blender's names of languages before 4.0


def register() -> None:
    """Register all languages at once, as Blender requires; it looks up only texts that it has no translation for.
    Buttons of operators look in the context of operator labels, so each text is registered there, too.
    """
    catalogs = {}
    for language, table in json.loads(DICTIONARY.read_text("utf-8") if DICTIONARY.exists() else "{}").items():
        messages = {(context, text): translation for text, translation in table.items() for context in ("*", OPERATOR)}
        catalogs.update(dict.fromkeys((language, OLD_NAMES.get(language, language)), messages))
    bpy.app.translations.register(__package__, catalogs)


def unregister() -> None:
    bpy.app.translations.unregister(__package__)
