# SPDX-License-Identifier: GPL-3.0-or-later
"""The .po files and the sources have the same messages: a new or changed one would be shown in English."""

import ast
import re

import pytest
from conftest import ROOT

CATALOGS = sorted((ROOT / "addon" / "partwheel" / "translations").glob("*.po"))
SOURCES = [path for folder in ("addon/partwheel", "native/python/partwheel", "native/src")
           for path in (ROOT / folder).rglob("*") if path.suffix in {".py", ".cpp", ".h", ".toml"}]


def joined(text):
    """Source text or a catalog with literals that continue on the next line joined, and docstrings on one line."""
    return re.sub(r"\s+", " ", re.sub(r'"\s*\n\s*f?"', "", text).replace(r"\n", "\n").replace('\\"', '"'))


@pytest.fixture(scope="module")
def sources():
    return "\n".join(joined(path.read_text()) for path in SOURCES)


def messages_of(catalog):
    messages = re.findall(r'^msgid ("(?:[^"\\]|\\.)*"(?:\n"(?:[^"\\]|\\.)*")*)', catalog.read_text(), re.M)
    return [re.sub(r'"\n"', "", message)[1:-1] for message in messages]


@pytest.mark.parametrize("catalog", CATALOGS, ids=lambda catalog: catalog.stem)
def test_every_message_is_in_the_sources(catalog, sources):
    messages = messages_of(catalog)
    assert len(messages) > 500
    # A tooltip of a tool is two sentences, each from a table of its own.
    missing = [line for message in messages for line in re.split(r"\\n", message)
               if joined(line).strip() not in sources]
    assert missing == []


@pytest.mark.parametrize("catalog", CATALOGS, ids=lambda catalog: catalog.stem)
def test_every_refusal_is_translated(catalog):
    calls = [node for path in SOURCES if path.is_relative_to(ROOT / "addon") and path.suffix == ".py"
             for node in ast.walk(ast.parse(path.read_text()))
             if isinstance(node, ast.Call) and getattr(node.func, "id", None) == "Refused" and node.args]
    # Those that are put together by f-strings are for scripts only.
    texts = [part.value for call in calls for part in ast.walk(call.args[0])
             if isinstance(part, ast.Constant) and not isinstance(call.args[0], ast.JoinedStr)]
    assert len(texts) > 30
    assert sorted({text.replace('"', '\\"') for text in texts} - {*messages_of(catalog)}) == []
