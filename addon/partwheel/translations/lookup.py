# SPDX-License-Identifier: GPL-3.0-or-later
"""Translations of user texts: Blender's own lookups, by the names that Blender's scripts use.

iface_() for drawn texts, tip_() for reasons of disabled buttons, rpt_() for reports and errors. A text with values is
translated first and formatted afterward: rpt_("{name} has no parts.").format(name=...). Blender itself translates
labels, descriptions and constant texts of layouts. Untranslated messages stay English."""

import json
from pathlib import Path

import bpy
from bpy.app import translations

iface_, tip_ = translations.pgettext_iface, translations.pgettext_tip
rpt_ = getattr(translations, "pgettext_rpt", tip_)  # from Blender 4.2 on
OPERATOR = "Operator"  # translation context of operator labels
# {language: {message: translation}}, which scripts/package reads from the .po files beside this file; in packages only
DICTIONARY = Path(__file__).with_name("dictionary.json")
OLD_NAMES = {"zh_HANS": "zh_CN"}  # Blender's names of languages before 4.0


def get_operator_label(operator: bpy.types.Operator) -> str:
    return iface_(operator.bl_label, OPERATOR)


def translate_error(error: Exception) -> str:
    """Return the translated message of an error of the package, or of a part of one (partwheel.worker.translatable)."""
    if sentences := getattr(error, "sentences", ()):
        values = {name: translate_error(value) if isinstance(value, Exception) or hasattr(value, "sentences") else value
                  for name, value in error.values.items()}
        return " ".join(map(rpt_, sentences)).format(**values)
    return rpt_(str(error))


def format_percent(share: float) -> str:
    """Format a fraction of 1, never in powers of ten."""
    return "< 0.1%" if 0 < share < 0.0005 else f"{share:.1%}"


def register() -> None:
    """Register all languages at once, as Blender requires; it looks up only texts that it has no translation for.
    Buttons of operators look in the context of operator labels, so each text is registered there, too."""
    catalogs = {}
    for language, table in json.loads(DICTIONARY.read_text("utf-8") if DICTIONARY.exists() else "{}").items():
        messages = {(context, text): translation for text, translation in table.items() for context in ("*", OPERATOR)}
        catalogs.update(dict.fromkeys((language, OLD_NAMES.get(language, language)), messages))
    translations.register(__package__, catalogs)


def unregister() -> None:
    translations.unregister(__package__)
