# SPDX-License-Identifier: GPL-3.0-or-later
"""README and docs against what they speak of: links lead somewhere, what is named is there, the Python examples run."""

import ast
import re

import numpy as np
import pytest
import shapes
from conftest import PLAIN, ROOT

PAGES = sorted([ROOT / "README.md", ROOT / "CONTRIBUTING.md", *(ROOT / "docs").rglob("*.md")])
LONGEST_README = 80  # lines
EXAMPLES = re.compile(r"```python\n(.*?)```", re.S)

named = pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())


def anchors(page):
    """As GitHub and MkDocs make them of headings."""
    return {anchor_of(heading) for heading in re.findall(r"^#+ .+$", page.read_text(), re.M)}


def anchor_of(heading):
    return re.sub(r"[^\w -]", "", heading.lstrip("#").lower()).strip().replace(" ", "-")


@named
def test_links_lead_somewhere(page):
    for target in re.findall(r"\]\(([^)\s]+)\)", page.read_text()):
        if "://" in target:
            continue
        path, _, anchor = target.partition("#")
        file = (page.parent / path).resolve() if path else page
        assert file.exists(), target
        assert not anchor or anchor in anchors(file), target


@named
def test_scripts_and_files_that_are_named_exist(page):
    text = page.read_text()
    paths = re.findall(r"(?:^    |`)((?:scripts(?!/partwheel\.js)|tests|native|addon|docs|cmake)/[\w./]+)", text, re.M)
    for path in paths:
        assert (ROOT / path.rstrip(".")).exists(), path


def test_each_page_is_in_the_sites_menu_and_each_picture_on_a_page():
    menu = (ROOT / "mkdocs.yml").read_text()
    text = "".join(page.read_text() for page in PAGES)
    for page in (ROOT / "docs").rglob("*.md"):
        assert page.relative_to(ROOT / "docs").as_posix() in menu
    for picture in (ROOT / "docs" / "images").iterdir():
        assert f"images/{picture.name})" in text, picture


def test_each_picture_is_made_by_what_the_table_says():
    """The script, or a file of the folder of its parts, has the picture's name in it."""
    table = (ROOT / "docs" / "commands.md").read_text().split("## Pictures")[1]
    rows = re.findall(r"^\| (`.+`) \| (.+) \|$", table, re.M)
    script_of = {name: by for names, by in rows for name in re.findall(r"`(.+?)`", names)}
    assert set(script_of) == {picture.name for picture in (ROOT / "docs" / "images").iterdir()}
    for name, by in script_of.items():
        if by.startswith("by hand") and name.endswith(".svg"):
            continue
        script = ROOT / re.match(r"`(scripts/\w+)", by)[1]
        parts = script.with_name("docs_parts" if script.name == "draw" else script.name + "_parts")
        sources = [script, *parts.glob("*.py")]
        assert any(re.search(rf"\b{name.split('.')[0]}\b", source.read_text()) for source in sources), (name, by)


def test_the_readme_is_short():
    assert len((ROOT / "README.md").read_text().splitlines()) <= LONGEST_README


def test_the_python_examples_run():
    examples = [text for text in EXAMPLES.findall((ROOT / "docs" / "scripting.md").read_text()) if "hierarchy" in text]
    assert len(examples) == 2
    hand = shapes.SHAPES["hand.off"]()
    scope = {"vertices": hand.vertices, "triangles": hand.triangles}
    exec(compile(examples[0], "docs/scripting.md", "exec"), scope)
    assert 0 < scope["part"].sum() < len(hand.triangles) and len(scope["cut"]) > 1
    first = scope["saved"]
    limited = examples[1] if PLAIN else examples[1].replace("memory_limit=2**32", "memory_limit=0")
    exec(compile(limited, "docs/scripting.md", "exec"), scope)
    assert scope["hierarchy"].save() == first


def test_the_example_of_the_index_runs():
    text, = EXAMPLES.findall((ROOT / "docs" / "index-queries.md").read_text())
    hand = shapes.SHAPES["hand.off"]()
    middles = hand.vertices[hand.triangles].mean(1)
    scope = {"vertices": hand.vertices, "triangles": hand.triangles, "points": middles, "origins": middles + 1,
             "directions": -np.ones_like(middles)}
    exec(compile(text, "docs/index-queries.md", "exec"), scope)
    assert (scope["distances"] <= 1e-12).all() and len(np.unique(scope["parts"])) == len(scope["bounds"]) - 1
    assert scope["intersecting"].min() >= 0 and (scope["part"] >= -1).all()


def test_what_the_examples_for_blender_call_is_in_the_api():
    text = next(text for text in EXAMPLES.findall((ROOT / "docs" / "scripting.md").read_text()) if "import api" in text)
    api = ast.parse((ROOT / "addon" / "partwheel" / "api.py").read_text())
    functions = {node.name: node for node in api.body if isinstance(node, ast.FunctionDef)}
    calls = [node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.Call)
             and getattr(node.func.value, "id", "") == "api"]
    assert len(calls) >= 8
    for call in calls:
        arguments = functions[call.func.attr].args
        names = [argument.arg for argument in arguments.args + arguments.kwonlyargs]
        assert len(call.args) <= len(arguments.args)
        assert {keyword.arg for keyword in call.keywords} <= set(names), call.func.attr


@named
def test_no_page_names_a_trademark(page):
    assert "homer" not in page.read_text().lower()
