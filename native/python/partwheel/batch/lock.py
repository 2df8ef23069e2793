# SPDX-License-Identifier: GPL-3.0-or-later
"""A named lock in a shared folder, for processes on several machines. The lock of a killed process can be taken over.

The lock is a file NAME.NUMBER. Its owner creates the file, and touches it as long as the owner lives. To take the lock over,
a process creates the file with the next number, which succeeds for one process only. The file with the highest number is
never removed, so numbers are not reused. (flock() would not do: on many network file systems it works within one machine
only.)
"""

from __future__ import annotations

import json
import os
import platform
import secrets
import threading
from pathlib import Path
from typing import Any, Dict, List, Optional, Set, Tuple, Union

from ..library import Error
from ..output import replace_text

HEARTBEAT_SECONDS = 10  # between two touches
STALE_SECONDS = 120  # an owner on another machine counts as dead if it has not touched the file for so long


class FolderInUseError(Error):
    """Another run uses the folder; str() names it."""

    name = "busy"


class Lock:
    """A context manager that holds the lock.

    Entering it raises FolderInUseError if a live process holds the lock, OSError if the folder can't be used.

    is_lost : whether another process has taken the lock over, because this one did not touch it for too long
    """

    def __init__(self, folder: Union[str, Path], name: str) -> None:
        self._folder, self._name = Path(folder), name
        self._path: Optional[Path] = None
        self._released = threading.Event()
        self.is_lost = False

    def __enter__(self) -> Lock:
        self._folder.mkdir(parents=True, exist_ok=True)
        while self._path is None:
            number, path = self._newest()
            if path is not None and (owner := _live_owner(path)):
                raise FolderInUseError(f"{self._folder} is in use by process {owner.get('pid', '?')} on "
                                       f"{owner.get('host', '?')} ({path.name}). Wait until it ends, or stop it.")
            self._path = self._create(number + 1)
        for old, old_path in self._files():
            if old < self._number:
                old_path.unlink(missing_ok=True)
        self._heartbeat = threading.Thread(target=self._touch, name="partwheel-lock", daemon=True)
        self._heartbeat.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._released.set()
        self._heartbeat.join()
        assert self._path is not None
        if not self.is_lost:
            replace_text(self._path, "{}")  # without an owner; the number stays in use

    def _files(self) -> List[Tuple[int, Path]]:
        """(number, path) of the lock's files, sorted."""
        return [(number, path) for name, number, path in _lock_files(self._folder, self._name) if name == self._name]

    def _newest(self) -> Tuple[int, Optional[Path]]:
        files = self._files()
        return files[-1] if files else (0, None)

    def _create(self, number: int) -> Optional[Path]:
        """Creates the file atomically; None if another process was first."""
        path, temporary = self._folder / f"{self._name}.{number}", self._folder / f"new-{secrets.token_hex(8)}"
        temporary.write_text(json.dumps({"host": platform.node(), "machine": _machine_id(), "pid": os.getpid(),
                                         "start_time": _start_time(os.getpid())}))
        try:
            os.link(temporary, path)
        except FileExistsError:
            return None
        finally:
            temporary.unlink()
        # A higher number means that other processes have held and released the lock since this one read the number.
        if self._newest()[0] != number:
            path.unlink(missing_ok=True)
            return None
        self._number = number
        return path

    def _touch(self) -> None:
        assert self._path is not None
        while not self._released.wait(HEARTBEAT_SECONDS):
            try:
                os.utime(self._path)
            except FileNotFoundError:
                self.is_lost = True
                return
            except OSError:
                continue  # the file server may recover


def held_locks(folder: Union[str, Path]) -> Set[str]:
    """The names of the locks in a folder that live processes hold."""
    newest = {name: path for name, _, path in _lock_files(Path(folder))}
    return {name for name, path in newest.items() if _live_owner(path)}


def _lock_files(folder: Path, prefix: str = "*") -> List[Tuple[str, int, Path]]:
    """(name of the lock, number, path) of the files of a folder's locks whose names start with the prefix, sorted."""
    files = ((path.name.rsplit(".", 1), path) for path in folder.glob(f"{prefix}.*"))
    return sorted((name, int(number), path) for (name, number), path in files if number.isdigit())


def _machine_id() -> Optional[str]:
    """An id of this boot of this machine and of its process namespace (container); None if unknown."""
    try:
        return Path("/proc/sys/kernel/random/boot_id").read_text().strip() + os.readlink("/proc/self/ns/pid")
    except OSError:
        return None


def _start_time(pid: int) -> Optional[str]:
    """When a process started, which tells it from others with the same id; None if it doesn't exist or is a zombie."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    except OSError:
        return None
    return None if fields[0] in "ZX" else fields[19]


def _live_owner(path: Path) -> Optional[Dict[str, Any]]:
    """The owner that a lock's file names, if it is alive; else None."""
    try:
        owner = json.loads(path.read_text())
        if not owner:
            return None
        if owner["machine"] and owner["machine"] == _machine_id():
            return owner if owner["start_time"] == _start_time(owner["pid"]) else None
        return owner if _age(path) < STALE_SECONDS else None
    except FileNotFoundError:
        return None


def _age(path: Path) -> float:
    """Seconds since a file was touched, by the clock of the file system, since those of machines differ."""
    now = path.parent / f"now-{secrets.token_hex(8)}"
    now.touch()
    try:
        return now.stat().st_mtime - path.stat().st_mtime
    finally:
        now.unlink()
