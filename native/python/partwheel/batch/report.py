# SPDX-License-Identifier: GPL-3.0-or-later
"""The report on a folder of results: one HTML page that needs no server and links to the previews in the folder."""

import json
import os
from pathlib import Path
from typing import Any, Dict, List, Tuple, Union

from .store import Store
from ..output import replace_text

NAME = "report.html"
STAGES = "read", "build", "save", "cut", "colliders", "preview"  # consecutive; "build" includes the native stages


def write(folder: Union[str, Path]) -> Tuple[Path, int]:
    """Writes report.html into a folder of results; returns its path and the number of models, without missing or incomplete
    results. Raises OSError."""
    store = Store(folder)
    rows = [table_row(path, key, report) for path, key in sorted(store.inputs().items()) if (report := store.report(key))]
    path = store.folder / NAME
    replace_text(path, render_page(rows))
    return path, len(rows)


def table_row(path: str, key: str, report: Dict[str, Any]) -> List[Any]:
    """The row of a model in the page's table: [path, key, bytes, faces, seconds, fill method or None, name of the error or
    None, its message, 1 with a preview or 0]. report : the content of model.json"""
    error = report["error"] or {"name": None, "message": ""}
    seconds = sum(report.get("seconds", {}).get(stage, 0) for stage in STAGES)
    return [os.fsencode(path).decode("utf-8", "replace"), key, report["bytes"], report.get("faces", 0), round(seconds, 3),
            report.get("fill_method"), error["name"], error["message"], int("preview.png" in report["files"])]


def render_page(rows: List[List[Any]]) -> str:
    """The page as HTML."""
    data = json.dumps(rows, separators=(",", ":")).replace("<", "\\u003c")  # so that no name can end the script element
    return Path(__file__).with_name("report.html").read_text("utf-8").replace("@ROWS@", data)
