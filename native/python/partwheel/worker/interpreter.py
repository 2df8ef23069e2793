# SPDX-License-Identifier: GPL-3.0-or-later
"""Which Python runs the worker process: one that was seen to run, for sys.executable may be nothing, or a shim of some
version manager that fails, or hangs."""

import subprocess
import sys
import time
from pathlib import Path
from typing import Dict, Tuple

from .ending import ending
from .said import Said
from ..library import Error

# -I: nothing of this process's Python, such as Blender's paths, reaches the other. -S, -B: it starts faster, and writes
# no bytecode.
OPTIONS = ["-I", "-S", "-B"]
# Seconds in which a Python may say nothing before the next is tried as well, and before that is taken for a no.
PATIENCE, LIMIT = 2, 60

UNANSWERED = "did not answer in {seconds} seconds"
UNSTARTED = "can't be started ({reason})"
NONE = "there is none"

_found: Dict[Tuple[str, ...], str] = {}  # candidates -> the one that runs


class NoInterpreter(Error):
    """None of the candidates runs. said: what became of each."""

    name = "interpreter"

    def __init__(self, failed):
        values = {f"path{number}": path for number, path in enumerate(failed)}
        values |= {f"how{number}": how for number, how in enumerate(failed.values())}
        self.said = Said("; ".join(f"{{path{number}}} {{how{number}}}" for number in range(len(failed))) or NONE, **values)
        super().__init__(str(self.said))


def start(python, *arguments, **options):
    """A subprocess.Popen. Raises OSError."""
    return subprocess.Popen([python, *OPTIONS, *arguments], creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
                            **options)


def candidates(preferred=""):
    """Paths, the best first: the one that the user wants; the one that this Python, Blender's own for instance, brings;
    and what the system finds."""
    root = Path(sys.prefix)
    name = f"python{sys.version_info.major}.{sys.version_info.minor}"
    brought = [root / "bin" / name, root / "bin" / "python3", root / "bin" / "python.exe", root / "python.exe"]
    return tuple(dict.fromkeys(filter(None, [preferred, *(str(path) for path in brought if path.is_file()),
                                             sys.executable])))


class Search:
    """Looks for a Python that runs, once a session, while the caller does other things."""

    def __init__(self, preferred=""):
        self._candidates = candidates(preferred)
        self._waiting = list(self._candidates)
        self._probes = {}  # of those that were begun: path -> Popen
        self._failed = {}  # path -> how, a Said
        self._began = time.monotonic()  # the last of them

    def poll(self):
        """Its path, or None for not yet. Raises NoInterpreter."""
        if known := _found.get(self._candidates):  # one look: another thread may forget() at any time
            return known
        for path, probe in self._probes.items():
            if probe.poll() == 0:
                _found[self._candidates] = path
                return path
            if probe.poll() is not None:
                self._failed[path] = ending(probe.poll())
        silent = [path for path in self._probes if path not in self._failed]
        waited = time.monotonic() - self._began
        if self._waiting and (not silent or waited > PATIENCE):
            self._probe(self._waiting.pop(0))
        elif not self._waiting and (not silent or waited > LIMIT):
            self._failed.update((path, Said(UNANSWERED, seconds=f"{LIMIT:g}")) for path in silent)
            raise NoInterpreter(self._failed)
        return None

    def _probe(self, path):
        self._began = time.monotonic()
        try:
            self._probes[path] = start(path, "-c", "import ctypes", stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)
        except OSError as error:
            self._failed[path] = Said(UNSTARTED, reason=error.strerror)

    def close(self):
        """Ends what still runs of it."""
        for probe in self._probes.values():
            probe.kill()
            probe.wait()


def forget():
    """The next search begins anew: one that was found does not run any more."""
    _found.clear()
