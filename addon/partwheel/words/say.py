# SPDX-License-Identifier: GPL-3.0-or-later
"""What users read, in their language: Blender's own lookups, by the names that Blender's own scripts give them.

iface_() for what is drawn, tip_() for why something is greyed out, rpt_() for reports and errors. A text with values in
it is looked up first and filled in then: rpt_("{name} has no parts.").format(name=...). What Blender looks up by itself
is not looked up here: labels, descriptions, texts of layouts that are constant.
"""

from __future__ import annotations

import bpy
from bpy.app import translations

iface_, tip_ = translations.pgettext_iface, translations.pgettext_tip
rpt_ = getattr(translations, "pgettext_rpt", tip_)  # from Blender 4.2 on
OPERATOR = "Operator"  # the context of operators' labels


def get_operator_label(operator: bpy.types.Operator) -> str:
    """An operator's label, as it is drawn."""
    return iface_(operator.bl_label, OPERATOR)


def translate_error(error: Exception) -> str:
    """What an error of the package says, or part of one (partwheel.worker.translatable)."""
    if sentences := getattr(error, "sentences", ()):
        values = {name: translate_error(value) if isinstance(value, Exception) or hasattr(value, "sentences") else value
                  for name, value in error.values.items()}
        return " ".join(map(rpt_, sentences)).format(**values)
    return rpt_(str(error))


def format_percent(share: float) -> str:
    """Of 1, short enough to be read at a glance: never in powers of ten."""
    return "< 0.1%" if 0 < share < 0.0005 else f"{share:.1%}"
