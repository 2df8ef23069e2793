# SPDX-License-Identifier: GPL-3.0-or-later
"""Each message in the .po files is one that the sources still have: a changed message would be shown in English."""

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


@pytest.mark.parametrize("catalog", CATALOGS, ids=lambda catalog: catalog.stem)
def test_every_message_is_in_the_sources(catalog, sources):
    messages = re.findall(r'^msgid ("(?:[^"\\]|\\.)*"(?:\n"(?:[^"\\]|\\.)*")*)', catalog.read_text(), re.M)
    assert len(messages) > 500
    # A tooltip of a tool is two sentences, each from a table of its own.
    missing = [line for message in messages for line in re.split(r"\\n", re.sub(r'"\n"', "", message)[1:-1])
               if joined(line).strip() not in sources]
    assert missing == []
