# SPDX-License-Identifier: GPL-3.0-or-later
"""The report on a folder of results: one HTML page without a server; the pictures stay where they are."""

import json
import os
import secrets
from pathlib import Path

from .store import Store

NAME = "report.html"
STAGES = "read", "build", "save", "cut", "colliders", "preview"  # that follow each other; build's own are in it


def write(folder):
    """Writes report.html into a folder of results, and returns its path and how many models it has. Results that are
    gone or torn are left out. Raises OSError."""
    store = Store(folder)
    rows = [row(path, key, report) for path, key in sorted(store.inputs().items()) if (report := store.report(key))]
    path = store.folder / NAME
    beside = store.folder / f"{NAME}-{secrets.token_hex(4)}"
    beside.write_text(page(rows), "utf-8")
    os.replace(beside, path)
    return path, len(rows)


def row(path, key, report):
    """What the page knows of a model: path, key, bytes, faces, seconds, way, name and message of its failure, whether
    there is a picture."""
    error = report["error"] or {"name": None, "message": ""}
    seconds = sum(report.get("seconds", {}).get(stage, 0) for stage in STAGES)
    return [os.fsencode(path).decode("utf-8", "replace"), key, report["bytes"], report.get("faces", 0), round(seconds, 3),
            report.get("rung"), error["name"], error["message"], int("preview.png" in report["files"])]


def page(rows):
    """The page as HTML."""
    told = json.dumps(rows, separators=(",", ":")).replace("<", "\\u003c")  # or a name could end the script
    return Path(__file__).with_name("report.html").read_text("utf-8").replace("@ROWS@", told)
