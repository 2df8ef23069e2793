# SPDX-License-Identifier: GPL-3.0-or-later
"""README and docs: links lead somewhere, and the Python examples run."""

import re

import numpy as np
import pytest
import shapes
from conftest import PLAIN, ROOT

PAGES = sorted([ROOT / "README.md", ROOT / "CONTRIBUTING.md", *(ROOT / "docs").rglob("*.md")])
EXAMPLES = re.compile(r"```python\n(.*?)```", re.S)

named = pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())


def anchors(page):
    """As GitHub and MkDocs make them of headings."""
    return {anchor_of(heading) for heading in re.findall(r"^#+ .+$", page.read_text(), re.M)}


def anchor_of(heading):
    return re.sub(r"[^\w -]", "", heading.lstrip("#").lower()).strip().replace(" ", "-")


@named
def test_links_have_targets(page):
    for target in re.findall(r"\]\(([^)\s]+)\)", page.read_text()):
        if "://" in target:
            continue
        path, _, anchor = target.partition("#")
        file = (page.parent / path).resolve() if path else page
        assert file.exists(), target
        assert not anchor or anchor in anchors(file), target


def test_the_python_examples_run():
    examples = [text for text in EXAMPLES.findall((ROOT / "docs" / "scripting.md").read_text()) if "hierarchy" in text]
    assert len(examples) == 3
    hand = shapes.SHAPES["hand.off"]()
    scope = {"vertices": hand.vertices, "triangles": hand.triangles}
    exec(compile(examples[0], "docs/scripting.md", "exec"), scope)
    assert 0 < scope["part"].sum() < len(hand.triangles) and len(scope["cut"]) > 1
    first = scope["saved"]
    limited = examples[1] if PLAIN else examples[1].replace("memory_limit=2**32", "memory_limit=0")
    exec(compile(limited, "docs/scripting.md", "exec"), scope)
    assert scope["hierarchy"].save() == first
    exec(compile(examples[2], "docs/scripting.md", "exec"), scope)
    assert "Marks: the colors divide the surface" in scope["hierarchy"].notes


@pytest.mark.parametrize("name", ["character", "scan"])
def test_a_scenario_plays_the_steps_of_the_recipe(name):
    """Its comments have the numbers of all steps, which may begin after the import; and it presses their keys."""
    page = (ROOT / "docs" / "recipes" / f"{name}.md").read_text()
    scenario = (ROOT / "tests" / "gui" / "scenarios" / f"recipe_{name}.py").read_text()
    steps = re.findall(r"^(\d)\. (.+?)(?=^\d\. |\n\n)", page, re.M | re.S)
    played = set()
    for first, word, last in re.findall(r"# Steps? (\d)(?: (and|to) (\d))?", scenario):
        played |= {*range(int(first), int(last or first) + 1)}
    assert played | {1} == {*range(1, len(steps) + 1)}
    for key in re.findall(r"\*\*([A-Z])\*\*", "".join(text for _, text in steps)):
        assert f'"{key}"' in scenario, key


def test_the_example_of_the_reference_runs(capsys):
    text, = EXAMPLES.findall((ROOT / "docs" / "api_python.md").read_text())
    exec(compile(text, "docs/api_python.md", "exec"), {})
    assert re.fullmatch(r"[1-9]\d* faces\n", capsys.readouterr().out)


def test_the_example_of_the_index_runs():
    text, = EXAMPLES.findall((ROOT / "docs" / "index-queries.md").read_text())
    hand = shapes.SHAPES["hand.off"]()
    middles = hand.vertices[hand.triangles].mean(1)
    scope = {"vertices": hand.vertices, "triangles": hand.triangles, "points": middles, "origins": middles + 1,
             "directions": -np.ones_like(middles)}
    exec(compile(text, "docs/index-queries.md", "exec"), scope)
    assert (scope["distances"] <= 1e-12).all() and len(np.unique(scope["parts"])) == len(scope["bounds"]) - 1
    assert scope["intersecting"].min() >= 0 and (scope["part"] >= -1).all()


def test_the_places_that_how_it_works_names_exist():
    """Files and folders of its tables, and what it says is in them: "`name` in `file`", "`name` (`file`)"."""
    text = (ROOT / "docs" / "how.md").read_text()
    folders = [ROOT / folder for folder in ("", "native/src", "native/python/partwheel", "addon/partwheel")]

    def find(path):
        return next((folder / path for folder in folders if (folder / path).exists()), None)

    missing = [path for path in re.findall(r"`([\w.]+(?:/[\w.]+)+/?)`|^    (\S+/)  ", text, re.M) if not find(path[0] or path[1])]
    assert missing == []
    pairs = re.findall(r"`(\w+(?:\.\w+)?)(?:\(\))?`(?: in | \(|, )+`([\w/]+\.(?:py|cpp))`", text)
    assert len(pairs) > 15
    assert [pair for pair in pairs if not re.search(rf"\b{pair[0].split('.')[-1]}\b", find(pair[1]).read_text())] == []
