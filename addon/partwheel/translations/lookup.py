# SPDX-License-Identifier: GPL-3.0-or-later
"""Translations of user texts: Blender's own lookups, by the names that Blender's scripts use.

iface_() for drawn texts, tip_() for reasons of disabled buttons, rpt_() for reports and errors. A text with values is
translated first and formatted afterwards: rpt_("{name} has no parts.").format(name=...). Blender itself translates
labels, descriptions and constant texts of layouts.
"""

from __future__ import annotations

import bpy
from bpy.app import translations

iface_, tip_ = translations.pgettext_iface, translations.pgettext_tip
rpt_ = getattr(translations, "pgettext_rpt", tip_)  # from Blender 4.2 on
OPERATOR = "Operator"  # translation context of operator labels


def get_operator_label(operator: bpy.types.Operator) -> str:
    """Return the translated label of an operator."""
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
