# SPDX-License-Identifier: GPL-3.0-or-later
"""The translations: each can be filled in as its English message can. A message without one is shown in English."""

import json
import sys

import pytest
from conftest import ROOT

sys.path.append(str(ROOT / "scripts" / "package_parts"))
import translations  # noqa: E402
import zips  # noqa: E402

LANGUAGES = ["de_DE", "es", "ja_JP", "zh_HANS"]


def test_packages_have_a_dictionary_of_all_languages():
    files = zips.addon_files()
    tables = json.loads(files["words/dictionary.json"])
    assert list(tables) == LANGUAGES and not [name for name in files if name.endswith(".po")]
    for table in tables.values():
        assert len(table) > 100
        for message, translation in table.items():
            assert translations.placeholders(message) == translations.placeholders(translation), (message, translation)
            assert translation.strip() == translation and translation, message


def test_a_message_without_translation_is_left_out(tmp_path):
    catalog = write(tmp_path, 'msgid "Part"\nmsgstr "Teil"\n\nmsgid "Whole"\nmsgstr ""\n\n#, fuzzy\nmsgid "Half"\nmsgstr "Halb"\n')
    assert json.loads(translations.dictionary([catalog])) == {"de_DE": {"Part": "Teil"}}


@pytest.mark.parametrize("entry, why", [
    ('msgid "Part"\nmsgstr "Teil\n', "end-of-line within string"),
    ('msgid "Part"\nmsgstr "Teil"\n\nmsgid "Part"\nmsgstr "Stück"\n', "duplicate message definition"),
    ('#, python-brace-format\nmsgid "{a} of {b}"\nmsgstr "{a} von"\n', "'b' doesn't exist"),
    ('msgid "{a} of {b}"\nmsgstr "{a} von"\n', "the placeholders differ"),
    ('msgid "{a:.1f}"\nmsgstr "{a}"\n', "the placeholders differ"),
    ('msgid "Part"\nmsgstr "Teil "\n', "space around"),
])
def test_a_malformed_translation_fails_packaging(entry, why, tmp_path):
    with pytest.raises(SystemExit, match=why):
        translations.dictionary([write(tmp_path, entry)])


def write(folder, entries):
    """A catalog with the header of a real one."""
    real = (ROOT / "addon" / "partwheel" / "words" / "de_DE.po").read_text()
    catalog = folder / "de_DE.po"
    catalog.write_text(real.partition("\n\n")[0] + "\n\n" + entries)
    return catalog
