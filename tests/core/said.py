# SPDX-License-Identifier: GPL-3.0-or-later
"""What the add-on says to users, gathered from its sources: [(kind, text, where), ...].

Kinds: label (what is drawn), description (tooltips), poll (why something is greyed out), report (reports and errors),
fragment (what is put into one of these). Whoever says something in another way is found by test_words.py.
"""

import ast
import re
from pathlib import Path

from conftest import ROOT

ADDON = ROOT / "addon" / "partwheel"
# Tables of texts that are looked up where they are drawn, by name of the variable.
TABLES = {"STATES": "label", "SHEET": "label", "DONE": "label", "LABELS": "items", "BECOMES": "label", "NO_PICK": "report",
          "NO_OTHERS": "report", "lost": "report", "TOOL": "label", "DESCRIPTIONS": "description", "GESTURES": "items",
          "MODES": "items", "DYNAMIC": "poll"}
CALLS = {"iface_": "label", "tip_": "poll", "rpt_": "report", "Refused": "report", "Outdated": "report", "Told": "report"}
READABLE = re.compile(r"[^\W\d_]{2}").search  # "0-9" is the same in all languages
FOR_SCRIPTS = {"api.py", "command.py"}  # they speak to those who write English anyway


def texts(node):
    """The constant texts of an expression: of all its branches."""
    if isinstance(node, ast.Constant):
        return [node.value] if isinstance(node.value, str) and node.value else []
    if isinstance(node, ast.IfExp):
        return texts(node.body) + texts(node.orelse)
    if isinstance(node, ast.BoolOp):
        return [text for value in node.values for text in texts(value)]
    if isinstance(node, ast.Dict):
        return [text for value in node.values for text in texts(value)]
    if isinstance(node, (ast.List, ast.Tuple)):
        return [text for value in node.elts for text in texts(value)]
    return []


def _items(node):
    """Of an enumeration: (identifier, label, description), or a table of (label, description)."""
    rows = node.values if isinstance(node, ast.Dict) else node.elts if isinstance(node, (ast.List, ast.Tuple)) else []
    for row in rows:
        if isinstance(row, ast.Tuple):
            pair = row.elts[-2:]
            for kind, each in zip(("label", "description"), pair):
                yield from ((kind, text) for text in texts(each))


class _Reader(ast.NodeVisitor):
    def __init__(self, path):
        self.path, self.found, self.seen = path, [], set()

    def say(self, kind, *nodes):
        for node in nodes:
            self.seen.update(ast.walk(node))
            for text in filter(READABLE, texts(node)):
                self.found.append((kind, text, f"{self.path.relative_to(ADDON)}:{node.lineno}"))

    def visit_ClassDef(self, node):
        own = {target.id: each.value for each in node.body if isinstance(each, ast.Assign)
               for target in each.targets if isinstance(target, ast.Name)}
        bases = {ast.unparse(base).rpartition(".")[2] for base in node.bases}
        for name, value in own.items():
            if name in {"bl_label", "bl_description"}:
                self.say(name[3:], value)
        if bases & {"Operator", "Macro"}:
            self.say("description", node.body[0].value)
        self.generic_visit(node)

    def visit_Assign(self, node):
        for target in node.targets:
            kind = TABLES.get(ast.unparse(target))
            if kind == "items":
                self.items(node.value)
            elif kind:
                self.say(kind, node.value)
        self.generic_visit(node)

    def items(self, node):
        self.seen.update(ast.walk(node))
        where = f"{self.path.relative_to(ADDON)}:{node.lineno}"
        self.found += [(kind, text, where) for kind, text in _items(node)]

    def visit_Call(self, node):
        name = ast.unparse(node.func).rpartition(".")[2]
        given = {each.arg: each.value for each in node.keywords}
        if ast.unparse(node.func).startswith("bpy.props."):
            for kind, key in (("label", "name"), ("description", "description")):
                if key in given and "HIDDEN" not in ast.unparse(given.get("options", ast.Constant(""))):
                    self.say(kind, given[key])
            if "items" in given and "HIDDEN" not in ast.unparse(given.get("options", ast.Constant(""))):
                self.items(given["items"])
        elif name in {"label", "operator", "popover", "prop", "menu", "_entries", "column", "row"}:
            self.say("label", *(given[key] for key in ("text", "heading") if key in given))
        elif name in {"Key", "Command"}:
            self.say("label", *node.args[2:3], *(given[key] for key in ("names",) if key in given))
        elif name == "_replace":
            self.say("label", *(given[key] for key in ("label", "names") if key in given))
        elif name == "undo_push":
            self.say("label", given["message"])
        elif name == "can":
            self.say("poll", node.args[2])
        elif name == "report" and isinstance(node.args[1], (ast.Constant, ast.IfExp)):
            self.say("report", node.args[1])
        elif name in CALLS and node.args:
            self.say(CALLS[name], node.args[0])
        self.generic_visit(node)

    def visit_For(self, node):
        self.pairs(node.iter)
        self.generic_visit(node)

    def visit_GeneratorExp(self, node):
        for each in node.generators:
            self.pairs(each.iter)
        self.generic_visit(node)

    def pairs(self, node):
        """Rows of a table that is gone through at once: the last of each is what is drawn."""
        for row in node.elts if isinstance(node, (ast.Tuple, ast.List)) else ():
            if isinstance(row, ast.Tuple) and len(row.elts) > 1 and any(
                    text[0].isupper() and "_OT_" not in text for text in texts(row.elts[-1])):
                self.say("label", row.elts[-1])


def _documented(tree):
    """The nodes of docstrings."""
    return {node.body[0].value for node in ast.walk(tree)
            if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef)) and node.body
            and isinstance(node.body[0], ast.Expr)}


# What of the library's errors is about a mesh or a part, and the same each time.
NATIVE = re.compile(r'Error\(PW_ERROR_(?:EMPTY|NOT_SOLID|NO_VOLUME|MEMORY|DEGENERATE|SELF_INTERSECTION|TETRAHEDRA|OPEN),'
                    r'\s*((?:"[^"]*"\s*)+)\)')


WORKER = ROOT / "native" / "python" / "partwheel" / "worker"


def of_the_library():
    """What users may be told by the library and its worker, likewise."""
    return [(kind, node.value.value, name) for name, kind in (("job.py", "report"), ("ending.py", "fragment"), ("interpreter.py", "fragment"))
            for node in ast.parse((WORKER / name).read_text()).body
            if isinstance(node, ast.Assign) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)] + [("report", "".join(re.findall('"([^"]*)"', each)), path.name)
            for path in sorted((ROOT / "native" / "src").rglob("*.cpp")) for each in NATIVE.findall(path.read_text())]


def sources():
    return [path for path in sorted(ADDON.rglob("*.py")) if path.name not in FOR_SCRIPTS]


def read(path):
    """([(kind, text, where)] of a file, [texts that look as if they were for users but are not among these])."""
    tree = ast.parse(Path(path).read_text(encoding="utf-8"))
    reader = _Reader(path)
    reader.visit(tree)
    printed = {each for node in ast.walk(tree) if isinstance(node, ast.Call) and ast.unparse(node.func) == "print"
               for each in ast.walk(node)}
    known = reader.seen | _documented(tree) | printed
    missed = [f"{path.relative_to(ADDON)}:{node.lineno}: {node.value}" for node in ast.walk(tree)
              if isinstance(node, ast.Constant) and isinstance(node.value, str) and node not in known
              and node.value[:1].isupper() and " " in node.value]
    return reader.found, missed
