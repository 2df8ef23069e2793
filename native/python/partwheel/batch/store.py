# SPDX-License-Identifier: GPL-3.0-or-later
"""The folder of results: a model's are made beside and come into their place whole, by one renaming.

    models/ab/KEY/model.json   what became of it, and beside it the files that were made; KEY begins with ab
    inputs/SHARD.jsonl         a line for each file that was read: its path and key
    done/SHARD.jsonl           a line for each result that came into its place: its key
    unfinished/SHARD/          what is being made; rubbish once its run has ended
    locks/                     see lock.py
"""

import json
import os
import secrets
import shutil
from pathlib import Path

REPORT = "model.json"


class Store:
    """The results in a folder, for the run that holds the shard's lock. shard: its name, as "1-of-4"."""

    def __init__(self, folder, shard="1-of-1"):
        self.folder, self._shard = Path(folder), shard
        self._unfinished = self.folder / "unfinished" / shard
        self._known = set()

    def begin(self):
        """To be called once, with the lock held: removes what a killed run left unfinished."""
        shutil.rmtree(self._unfinished, ignore_errors=True)
        self._unfinished.mkdir(parents=True, exist_ok=True)
        self._known = {(line["path"], line["key"]) for line in _lines(self._lines_of("inputs"))}

    def place(self, key):
        return self.folder / "models" / key[:2] / key

    def report(self, key):
        """What model.json says; None if there is no result, or one whose files are not as it says."""
        place = self.place(key)
        try:
            report = json.loads((place / REPORT).read_text("utf-8"))
            whole = all((place / name).stat().st_size == size for name, size in report["files"].items())
        except (FileNotFoundError, NotADirectoryError, ValueError):
            return None
        return report if whole else None

    def beside(self, key):
        """A new, empty folder to make a result in."""
        folder = self._unfinished / f"{key}-{secrets.token_hex(4)}"
        folder.mkdir()
        return folder

    def publish(self, beside, key, report):
        """The result made in that folder comes into its place; False if another shard was first."""
        report["files"] = {path.name: path.stat().st_size for path in sorted(beside.iterdir())}
        (beside / REPORT).write_bytes(written(report))
        place = self.place(key)
        place.parent.mkdir(parents=True, exist_ok=True)
        if place.exists() and self.report(key) is None:
            self.withdraw(key)  # damaged
        try:
            os.rename(beside, place)
        except OSError:
            if self.report(key) is None:
                raise
            self.discard(beside)
            return False
        _append(self._lines_of("done"), {"key": key})
        return True

    def withdraw(self, key):
        """Takes a result away."""
        away = self._unfinished / f"{key}-{secrets.token_hex(4)}"
        os.rename(self.place(key), away)
        self.discard(away)

    def discard(self, beside):
        shutil.rmtree(beside, ignore_errors=True)  # the next begin() removes what is left

    def note(self, path, key):
        """That this file has this key; once, however often it is told."""
        if (path, key) not in self._known:
            self._known.add((path, key))
            _append(self._lines_of("inputs"), {"path": path, "key": key})

    def inputs(self):
        """{path: key} of all shards; the key that was told last."""
        return {line["path"]: line["key"] for file in sorted((self.folder / "inputs").glob("*.jsonl"))
                for line in _lines(file)}

    def done(self):
        """Keys of all results that came into their place, as often as they did."""
        return [line["key"] for file in sorted((self.folder / "done").glob("*.jsonl")) for line in _lines(file)]

    def end(self):
        """Nothing is being made any more."""
        shutil.rmtree(self._unfinished, ignore_errors=True)

    def _lines_of(self, kind):
        return self.folder / kind / f"{self._shard}.jsonl"


def written(report):
    """model.json, as bytes."""
    return (json.dumps(report, indent=1, sort_keys=True) + "\n").encode()


def _append(path, value):
    """One write: a run that is killed leaves a whole line, or a torn one that the next begins behind."""
    path.parent.mkdir(exist_ok=True)
    with open(path, "ab+") as file:
        torn = file.tell() and (file.seek(-1, os.SEEK_END), file.read(1))[1] != b"\n"
        file.write((b"\n" if torn else b"") + json.dumps(value).encode() + b"\n")


def _lines(path):
    try:
        text = path.read_bytes()
    except FileNotFoundError:
        return
    for line in text.splitlines():
        try:
            yield json.loads(line)
        except ValueError:
            continue  # torn by a kill; what it told is told again
