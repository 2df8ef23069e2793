# SPDX-License-Identifier: GPL-3.0-or-later
"""The house from its sources: data flows one way, so imports do; no room is too full; the docs list the rooms."""

import ast
import functools
import re
from pathlib import Path

import pytest
from conftest import ROOT

NATIVE, PACKAGE, ADDON = ROOT / "native" / "src", ROOT / "native" / "python" / "partwheel", ROOT / "addon" / "partwheel"
# The order in which data flows: a file imports from its own room and from those before it. A room's sub-folder is a
# room of its own; "x.py": that file alone.
FLOWS = {
    NATIVE: ["base", "surface", "surface/prepare", "fill", "cluster/hull", "cluster", "tree/mirror", "tree/snap",
             "tree/regroup", "tree", "part", "api.cpp"],
    ADDON: ["words", "trouble.py", "preferences.py", "mesh", "view", "parts", "pick", "related", "solid", "cut", "compose", "deform", "ui",
            "api.py", "command.py", "__init__.py"],
}
CODE = {".c", ".cpp", ".h", ".py"}
MOST_FILES = 12


def code(tree):
    return sorted(path for path in tree.rglob("*") if path.suffix in CODE)


def included(path):
    """The files of native/src that this one includes."""
    return [NATIVE / name for name in re.findall(r'^#include "(\w[\w/]*\.h)"', path.read_text(), re.M)
            if (NATIVE / name).exists()]


def imported(path):
    """The files of the same package that this one imports, also inside functions."""
    found = []
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom) and node.level:
            place = path.parents[node.level - 1].joinpath(*(node.module or "").split("."))
            for name in [place / alias.name for alias in node.names] if place.is_dir() else [place]:
                module = name.with_suffix(".py")
                found.append(module if module.exists() else (name if name.is_dir() else name.parent) / "__init__.py")
    return found


@functools.cache
def arrows(tree):
    """(from, to) for each import between two files of a tree; a header and its source count as one."""
    ways = ((path, other) for path in code(tree) for other in (imported if path.suffix == ".py" else included)(path))
    return {(path.with_suffix(""), other.with_suffix("")) for path, other in ways
            if path.with_suffix("") != other.with_suffix("")}


def room(tree, path):
    """The number of a file's room in the flow."""
    name = path.relative_to(tree).as_posix()
    names = [name, *(parent.as_posix() for parent in Path(name).parents)]
    stems = {each.rsplit(".", 1)[0]: number for number, each in enumerate(FLOWS[tree])}
    return next((stems[each] for each in names if each in stems), None)


@pytest.mark.parametrize("tree", FLOWS, ids=lambda tree: tree.parent.name)
def test_every_room_is_in_the_flow(tree):
    assert [path for path in code(tree) if room(tree, path.with_suffix("")) is None] == []
    assert all((tree / name).exists() for name in FLOWS[tree])


@pytest.mark.parametrize("tree", FLOWS, ids=lambda tree: tree.parent.name)
def test_imports_run_one_way_between_rooms(tree):
    against = [f"{path} imports {other}" for path, other in sorted(arrows(tree)) if room(tree, other) > room(tree, path)]
    assert len(arrows(tree)) > 50 and against == []


@pytest.mark.parametrize("tree", [NATIVE, PACKAGE, ADDON], ids=["library", "package", "addon"])
def test_no_file_imports_itself_in_the_end(tree):
    reached = {path: {other for start, other in arrows(tree) if start == path} for path, _ in arrows(tree)}
    for middle in list(reached):
        for path in reached:
            if middle in reached[path]:
                reached[path] |= reached[middle]
    assert [path for path in reached if path in reached[path]] == []


def test_the_addon_uses_the_package_and_the_package_nothing_of_blender():
    for path in code(PACKAGE):
        names = {alias.name for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.Import)
                 for alias in node.names}
        assert not names & {"bpy", "bmesh", "mathutils"}, path
    for path in code(ADDON):
        assert "ctypes" not in path.read_text(), path


@pytest.mark.parametrize("tree", ["native", "addon"])
def test_no_room_is_too_full(tree):
    folders = {path.parent for path in code(ROOT / tree)}
    full = {folder: number for folder in folders
            if (number := sum(path.suffix in CODE for path in folder.iterdir())) > MOST_FILES}
    assert full == {}


def test_the_docs_list_the_rooms():
    text = (ROOT / "docs" / "how.md").read_text()
    rooms = {path.parent.relative_to(ROOT).as_posix() + "/" for path in code(ROOT / "native") + code(ROOT / "addon")}
    listed = set(re.findall(r"^    ((?:native|addon)/[\w/]*/) ", text, re.M))
    assert listed == rooms
