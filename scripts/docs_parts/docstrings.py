# SPDX-License-Identifier: GPL-3.0-or-later
"""Rewrites docstrings for the site. In ours an item is "name : what it is", and its type is the annotation; the parser of numpy's
style takes what follows the colon for the type."""

import re

import griffe

SECTION = re.compile(r"^(Parameters|Attributes|Raises|Returns)\n-+\n", re.M)
ITEM = re.compile(r"^(\*{0,2}\w[\w, *]*?) : (.+)$", re.M)
SHAPED = re.compile(r"^((?:\w+, )*\w+ \([^)]*\)(?:, (?:\w+, )*\w+ \([^)]*\))*) *(.*)$", re.M)  # name (shape)   what it is


class Docstrings(griffe.Extension):
    def on_instance(self, *, obj, **_):
        if obj.docstring:
            obj.docstring.value = rewrite(obj.docstring.value)


def rewrite(text):
    """The docstring with lists in place of items outside of sections, with descriptions below names in sections, and
    with what it returns before the sections."""
    head, *sections = SECTION.split(text)
    head, rest = [write_list(paragraph) for paragraph in head.strip().split("\n\n")], []
    for title, body in zip(sections[::2], sections[1::2]):
        if title == "Returns":
            head.append("**Returns:**\n" + write_list(body.strip()))
        else:
            rest.append(f"{title}\n{'-' * len(title)}\n" + ITEM.sub(r"\1\n    \2", body.strip()))
    return "\n\n".join(head + rest)


def write_list(paragraph):
    """A paragraph of items as a Markdown list; others as they are."""
    pattern = next((pattern for pattern in (ITEM, SHAPED) if pattern.match(paragraph)), None)
    return "\n" + pattern.sub(r"* `\1`: \2", paragraph).replace("`: \n", "`\n").removesuffix(": ") if pattern else paragraph
