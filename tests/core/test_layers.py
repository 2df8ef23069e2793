# SPDX-License-Identifier: GPL-3.0-or-later
"""The layers of the code: imports run one way, in the order in which data flows, and the docs list every layer."""

import ast
import functools
import re
from pathlib import Path

import pytest
from conftest import ROOT

NATIVE, PACKAGE, ADDON = ROOT / "native" / "src", ROOT / "native" / "python" / "partwheel", ROOT / "addon" / "partwheel"
# From the bottom up: a file imports from its own layer and from those before it. A folder inside a layer is a layer of its
# own; "x.py" is that file alone.
LAYERS = {
    NATIVE: ["base", "mesh", "prepare", "hull", "fill", "cluster", "parts", "tree", "convex", "query", "edit", "assembly.cpp", "pipeline.cpp",
             "api_common.h", "api.cpp", "api_edit.cpp", "api_query.cpp"],
    ADDON: ["translations", "library_error.py", "preferences.py", "mesh", "view", "parts", "pick", "related", "solid", "cut",
             "compose", "deform", "ui", "api.py", "command.py", "__init__.py"],
}
SUFFIXES = {".c", ".cpp", ".h", ".py"}


def source_files(tree):
    """But for the copies of headers that the build installs into the package."""
    return sorted(path for path in tree.rglob("*") if path.suffix in SUFFIXES and path.parent != PACKAGE / "include")


def cpp_includes(path):
    """The files of native/src that a C++ file includes."""
    return [NATIVE / name for name in re.findall(r'^#include "(\w[\w/]*\.h)"', path.read_text(), re.M)
            if (NATIVE / name).exists()]


def python_imports(path):
    """The files of the same package that a Python file imports, also inside functions."""
    modules = []
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom) and node.level:
            place = path.parents[node.level - 1].joinpath(*(node.module or "").split("."))
            for name in [place / alias.name for alias in node.names] if place.is_dir() else [place]:
                module = name.with_suffix(".py")
                modules.append(module if module.exists() else (name if name.is_dir() else name.parent) / "__init__.py")
    return modules


@functools.cache
def import_edges(tree):
    """(importer, imported) for each pair of files of a tree; a header and its source count as one."""
    edges = ((path, other) for path in source_files(tree)
             for other in (python_imports if path.suffix == ".py" else cpp_includes)(path))
    return {(path.with_suffix(""), other.with_suffix("")) for path, other in edges
            if path.with_suffix("") != other.with_suffix("")}


def layer_index(tree, path):
    name = path.relative_to(tree).as_posix()
    names = [name, *(parent.as_posix() for parent in Path(name).parents)]
    stems = {layer.rsplit(".", 1)[0]: index for index, layer in enumerate(LAYERS[tree])}
    return next((stems[candidate] for candidate in names if candidate in stems), None)


@pytest.mark.parametrize("tree", LAYERS, ids=lambda tree: tree.parent.name)
def test_every_file_is_in_a_layer(tree):
    assert [path for path in source_files(tree) if layer_index(tree, path.with_suffix("")) is None] == []
    assert all((tree / name).exists() for name in LAYERS[tree])


@pytest.mark.parametrize("tree", LAYERS, ids=lambda tree: tree.parent.name)
def test_imports_run_one_way_between_layers(tree):
    upward = [f"{path} imports {other}" for path, other in sorted(import_edges(tree))
              if layer_index(tree, other) > layer_index(tree, path)]
    assert len(import_edges(tree)) > 50 and upward == []


@pytest.mark.parametrize("tree", [NATIVE, PACKAGE, ADDON], ids=["library", "package", "addon"])
def test_there_are_no_import_cycles(tree):
    reachable = {path: {other for start, other in import_edges(tree) if start == path} for path, _ in import_edges(tree)}
    for middle in list(reachable):
        for path in reachable:
            if middle in reachable[path]:
                reachable[path] |= reachable[middle]
    assert [path for path in reachable if path in reachable[path]] == []


def test_the_addon_uses_the_package_and_the_package_nothing_of_blender():
    for path in source_files(PACKAGE):
        names = {alias.name for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.Import)
                 for alias in node.names}
        assert not names & {"bpy", "bmesh", "mathutils"}, path
    for path in source_files(ADDON):
        assert "ctypes" not in path.read_text(), path


def test_the_docs_list_every_layer():
    text = (ROOT / "docs" / "how.md").read_text()
    folders = {path.parent.relative_to(ROOT).as_posix() + "/"
               for path in source_files(ROOT / "native") + source_files(ROOT / "addon")}
    listed = set(re.findall(r"^    ((?:native|addon)/[\w/]*/) ", text, re.M))
    assert listed == folders
