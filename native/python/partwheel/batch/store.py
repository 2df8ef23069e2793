# SPDX-License-Identifier: GPL-3.0-or-later
"""The folder of results. A model's results are written to a temporary folder, then published by one atomic rename.

    models/ab/KEY/model.json   the report on a model, next to its files; KEY begins with ab
    inputs/SHARD.jsonl         one line per file that was read: its path and key
    done/SHARD.jsonl           one line per published result: its key
    unfinished/SHARD/          results in progress; garbage after the run has ended
    locks/                     see lock.py
"""

import json
import os
import secrets
import shutil
from pathlib import Path
from typing import Any, Dict, Iterator, Optional, Set, Tuple, Union

REPORT = "model.json"


class Store:
    """The results in a folder, for the run that holds the shard's lock. shard: its name, such as "1-of-4"."""

    def __init__(self, folder: Union[str, Path], shard: str = "1-of-1") -> None:
        self.folder, self._shard = Path(folder), shard
        self._unfinished = self.folder / "unfinished" / shard
        self._inputs: Set[Tuple[str, str]] = set()

    def begin(self) -> None:
        """Removes what a killed run left unfinished. Call it once, with the lock held."""
        shutil.rmtree(self._unfinished, ignore_errors=True)
        self._unfinished.mkdir(parents=True, exist_ok=True)
        self._inputs = {(line["path"], line["key"]) for line in _read_lines(self._lines_path("inputs"))}

    def result_folder(self, key: str) -> Path:
        """The folder of a published result."""
        return self.folder / "models" / key[:2] / key

    def report(self, key: str) -> Optional[Dict[str, Any]]:
        """The content of model.json; None if there is no result, or its files don't have the sizes given there."""
        folder = self.result_folder(key)
        try:
            report = json.loads((folder / REPORT).read_text("utf-8"))
            is_complete = all((folder / name).stat().st_size == size for name, size in report["files"].items())
        except (FileNotFoundError, NotADirectoryError, ValueError):
            return None
        return report if is_complete else None

    def create_folder(self, key: str) -> Path:
        """Creates an empty folder for a result in progress."""
        folder = self._unfinished / f"{key}-{secrets.token_hex(4)}"
        folder.mkdir()
        return folder

    def publish(self, folder: Path, key: str, report: Dict[str, Any]) -> bool:
        """Moves a result from a folder of create_folder() to its final place; False if another shard was first. report : the
        content of model.json, without "files". Raises OSError."""
        report["files"] = {path.name: path.stat().st_size for path in sorted(folder.iterdir())}
        (folder / REPORT).write_bytes(encode_report(report))
        target = self.result_folder(key)
        target.parent.mkdir(parents=True, exist_ok=True)
        if target.exists() and self.report(key) is None:
            self.remove(key)  # damaged
        try:
            os.rename(folder, target)
        except OSError:
            if self.report(key) is None:
                raise
            self.discard(folder)
            return False
        _append(self._lines_path("done"), {"key": key})
        return True

    def remove(self, key: str) -> None:
        """Removes a published result, atomically for other processes."""
        renamed = self._unfinished / f"{key}-{secrets.token_hex(4)}"
        os.rename(self.result_folder(key), renamed)
        self.discard(renamed)

    def discard(self, folder: Path) -> None:
        """Deletes a folder of create_folder()."""
        shutil.rmtree(folder, ignore_errors=True)  # the next begin() removes what remains

    def add_input(self, path: str, key: str) -> None:
        """Records the key of a file; a repeated pair is recorded once."""
        if (path, key) not in self._inputs:
            self._inputs.add((path, key))
            _append(self._lines_path("inputs"), {"path": path, "key": key})

    def inputs(self) -> Dict[str, str]:
        """{path: the key recorded last} of all shards."""
        return {line["path"]: line["key"] for file in sorted((self.folder / "inputs").glob("*.jsonl"))
                for line in _read_lines(file)}

    def end(self) -> None:
        """Removes the folder of unfinished results."""
        shutil.rmtree(self._unfinished, ignore_errors=True)

    def _lines_path(self, kind: str) -> Path:
        return self.folder / kind / f"{self._shard}.jsonl"


def encode_report(report: Dict[str, Any]) -> bytes:
    """The content of model.json."""
    return (json.dumps(report, indent=1, sort_keys=True) + "\n").encode()


def _append(path: Path, value: Dict[str, Any]) -> None:
    """Appends a line by one write. If a killed run left an incomplete last line, the new line starts after it."""
    path.parent.mkdir(exist_ok=True)
    with open(path, "ab+") as file:
        is_incomplete = file.tell() and (file.seek(-1, os.SEEK_END), file.read(1))[1] != b"\n"
        file.write((b"\n" if is_incomplete else b"") + json.dumps(value).encode() + b"\n")


def _read_lines(path: Path) -> Iterator[Dict[str, Any]]:
    try:
        text = path.read_bytes()
    except FileNotFoundError:
        return
    for line in text.splitlines():
        try:
            yield json.loads(line)
        except ValueError:
            continue  # incomplete, by a killed run; a later run records it again
