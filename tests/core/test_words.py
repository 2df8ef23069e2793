# SPDX-License-Identifier: GPL-3.0-or-later
"""What the add-on says to users: by one rule, in plain words, and in every language, with nothing missing or left over."""

import ast
import re
import string

import pytest
import said

SAID = [each for path in said.sources() for each in said.read(path)[0]] + said.of_the_library()
CATALOGUES = said.ADDON / "words"
LANGUAGES = ["german", "spanish", "japanese", "chinese"]
# Names in code, and numbers as programs write them.
CODE = re.compile(r"\b((?i:tets?|tetrahedr\w+|dendrogram|hierarch\w+|nodes?|clusters?|rungs?|index|indices|bmesh)|None|True"
                  r"|False|Eq|API)\b|_|\be-\d|:\.?\d*[eg]\}|%[sd]")
# Texts that nobody reads, or that are names in the user's data, and are what they are in every language.
NOT_SAID = ["__init__.py", "compose/swap.py: All of It", "compose/swap.py: The object is a part itself",
            "cut/layers.py: Base Color", "cut/objects.py: How far the parts are moved apart",
            "cut/parts_to.py: The parts, as lists", "deform/operator.py: The movement to start with",
            "pick/pick.py: From the Toolbar", "pick/pick.py: The next click starts", "pick/writers.py: Part ",
            "solid/solids.py: Partwheel Cap", "view/in_view.py: Partwheel: "]


def catalogue(language):
    return ast.literal_eval(next(node.value for node in ast.parse((CATALOGUES / f"{language}.py").read_text()).body
                                 if isinstance(node, ast.Assign)))


def fields(text):
    """The placeholders, with their formats."""
    return sorted((name, form) for _, name, form, _ in string.Formatter().parse(text) if name is not None)


def test_nothing_is_said_past_the_catalogues():
    missed = [each for path in said.sources() for each in said.read(path)[1] if "words/" not in each]
    missed = [re.sub(r":\d+:", ":", each) for each in missed]
    assert [each for each in missed if not each.startswith(tuple(NOT_SAID))] == []


@pytest.mark.parametrize("kind", ["label", "description", "poll", "report"])
def test_one_rule_a_kind(kind):
    """Labels and descriptions, as Blender has them, end without a full stop, what is refused or reported with one. What
    begins small is put into another text, and so is all that is wrong with a solid."""
    texts = [(text, where) for each, text, where in SAID if each == kind]
    assert len(texts) > 5
    for text, where in texts:
        fragment = text[0].islower() or where.startswith("compose/union.py") and text.startswith("{count}")
        assert kind in {"label", "report"} or not fragment, (text, where)
        stop = text.endswith(".") and not text.endswith("...") or text.endswith("{reason}")
        assert stop == (kind in {"poll", "report"} and not fragment) or fragment, (text, where)
        assert text == text.strip() and "  " not in text and " . " not in text, (text, where)


def test_no_names_of_code():
    found = [(text, where) for _, text, where in SAID if CODE.search(re.sub(r"\{\w+(:[^}eg]*)?\}", "", text))]
    assert found == []


@pytest.mark.parametrize("language", LANGUAGES)
def test_each_language_has_all_and_no_more(language):
    texts, words = {text for _, text, _ in SAID}, catalogue(language)
    assert texts - words.keys() == set() and words.keys() - texts == set()


@pytest.mark.parametrize("language", LANGUAGES)
def test_translations_fit_their_texts(language):
    for text, meant in catalogue(language).items():
        assert fields(text) == fields(meant), (text, meant)
        assert text.endswith((".", "{reason}")) == meant.endswith((".", "。", "{reason}")) or (
            language in {"japanese", "chinese"} and "。" in meant), (text, meant)
        assert meant == meant.strip() and meant.count("\n") == text.count("\n"), (text, meant)


def test_the_librarys_errors_are_found():
    assert "The mesh has no faces. Choose a mesh object that has some." in {text for _, text, _ in said.of_the_library()}


def test_the_worker_says_only_constants():
    """Which the catalogues' tests find: no sentence stands where an error is raised."""
    found = []
    for path in sorted(said.WORKER.glob("*.py")):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.Call) and ast.unparse(node.func) in {"Said", "WorkerError", "_no_worker", "PartwheelError"}:
                said_here = node.args[1:] if ast.unparse(node.func).endswith("Error") else node.args  # the first is what kind
                found += [ast.unparse(each) for each in said_here if isinstance(each, ast.JoinedStr) or said.texts(each)]
    assert found == []


def test_placeholders_are_words():
    assert {name for _, text, _ in SAID for name, _ in fields(text) if not name.isidentifier()} == set()
