# SPDX-License-Identifier: GPL-3.0-or-later
"""The translations: each can be filled in as its English message can. A message without one is shown in English."""

import ast
import string

import pytest
from conftest import ROOT

CATALOGS = ROOT / "addon" / "partwheel" / "words"
LANGUAGES = ["german", "spanish", "japanese", "chinese"]


def catalog(language):
    return ast.literal_eval(next(node.value for node in ast.parse((CATALOGS / f"{language}.py").read_text()).body
                                 if isinstance(node, ast.Assign)))


def placeholders(text):
    """(name, format) of each placeholder, sorted."""
    return sorted((name, form) for _, name, form, _ in string.Formatter().parse(text) if name is not None)


@pytest.mark.parametrize("language", LANGUAGES)
def test_translations_have_the_placeholders_of_their_messages(language):
    messages = catalog(language)
    assert len(messages) > 100
    for message, translation in messages.items():
        assert placeholders(message) == placeholders(translation), (message, translation)
        assert translation.strip() == translation and translation, message
