# SPDX-License-Identifier: GPL-3.0-or-later
"""A lock on a folder's part, for processes on all machines that share the folder; a killed owner's is taken over.

It is a file NAME.NUMBER that the owner made and touches as long as it lives. To take a lock over is to make the file
of the next number, which only one process can; the highest number is never removed, so that nobody takes an older one's
place. (Not flock(): it holds on one machine only on many network file systems.)
"""

import json
import os
import platform
import secrets
import threading
from pathlib import Path

from ..library import Error

BEAT_SECONDS = 10  # between two touches
STALE_SECONDS = 120  # without a touch, by the file system's clock: its owner, on another machine, is taken for dead


class Busy(Error):
    """Another run has the folder. str() says which."""

    name = "busy"


class Lock:
    """with Lock(folder, name): nobody else has it. Raises Busy at once where a living process has it; OSError.

    lost: True when another has taken it over, for this process slept too long."""

    def __init__(self, folder, name):
        self._folder, self._name = Path(folder), name
        self._path, self._over = None, threading.Event()
        self.lost = False

    def __enter__(self):
        self._folder.mkdir(parents=True, exist_ok=True)
        while self._path is None:
            number, path = self._highest()
            if path is not None and (owner := _living(path)):
                raise Busy(f"{self._folder} is being worked on by process {owner.get('pid', '?')} on "
                           f"{owner.get('host', '?')} ({path.name}). Wait for it, or end it.")
            self._path = self._make(number + 1)
        for old, path in self._all():
            if old < self._number:
                path.unlink(missing_ok=True)
        self._beat = threading.Thread(target=self._touch, name="partwheel-lock", daemon=True)
        self._beat.start()
        return self

    def __exit__(self, *_):
        self._over.set()
        self._beat.join()
        if not self.lost:
            _write_beside(self._path, {})  # nobody's: its number stays

    def _all(self):
        numbers = ((path.name[len(self._name) + 1:], path) for path in self._folder.glob(f"{self._name}.*"))
        return sorted((int(number), path) for number, path in numbers if number.isdigit())

    def _highest(self):
        return (self._all() or [(0, None)])[-1]

    def _make(self, number):
        """The file, whole at once; None if another was first."""
        path, whole = self._folder / f"{self._name}.{number}", self._folder / f"new-{secrets.token_hex(8)}"
        whole.write_text(json.dumps(_myself()))
        try:
            os.link(whole, path)
        except FileExistsError:
            return None
        finally:
            whole.unlink()
        # Others may have come and gone between the look and this: then theirs is higher.
        if self._highest()[0] != number:
            path.unlink(missing_ok=True)
            return None
        self._number = number
        return path

    def _touch(self):
        while not self._over.wait(BEAT_SECONDS):
            try:
                os.utime(self._path)
            except FileNotFoundError:
                self.lost = True
                return
            except OSError:
                continue  # the file server may come back


def living(folder, prefix=""):
    """The names of the locks in a folder that living processes hold."""
    newest = {}
    for path in Path(folder).glob(f"{prefix}*.*"):
        name, number = path.name.rsplit(".", 1)
        if number.isdigit():
            newest[name] = max(newest.get(name, 0), int(number))
    return {name for name, number in newest.items() if _living(Path(folder) / f"{name}.{number}")}


def _myself():
    return {"host": platform.node(), "machine": _machine(), "pid": os.getpid(), "began": _began(os.getpid())}


def _machine():
    """What tells this machine and container, as long as it runs, from all others; None where the system does not tell."""
    try:
        return Path("/proc/sys/kernel/random/boot_id").read_text().strip() + os.readlink("/proc/self/ns/pid")
    except OSError:
        return None


def _began(pid):
    """When a process began, for numbers are used again; None if there is none. A zombie is none."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    except OSError:
        return None
    return None if fields[0] in "ZX" else fields[19]


def _living(path):
    """The owner in a lock's file if it lives, else None."""
    try:
        owner = json.loads(path.read_text())
        if not owner:
            return None
        if owner["machine"] and owner["machine"] == _machine():
            return owner if owner["began"] == _began(owner["pid"]) else None
        return owner if _age(path) < STALE_SECONDS else None
    except FileNotFoundError:
        return None


def _age(path):
    """Seconds since it was touched, by the clock that touches it: machines' clocks differ."""
    now = path.parent / f"now-{secrets.token_hex(8)}"
    now.touch()
    try:
        return now.stat().st_mtime - path.stat().st_mtime
    finally:
        now.unlink()


def _write_beside(path, value):
    beside = path.parent / f"new-{secrets.token_hex(8)}"
    beside.write_text(json.dumps(value))
    os.replace(beside, path)
