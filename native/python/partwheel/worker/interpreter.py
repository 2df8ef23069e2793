# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds a Python that can run the worker process.

Each candidate is probed: sys.executable may be empty, or a version manager's shim that fails or hangs."""

import subprocess
import sys
import time
from pathlib import Path
from typing import Any, Dict, List, Optional, Tuple

from .exit_status import describe_exit
from .translatable import TranslatableText
from ..library import Error

# -I: isolated from this process's environment, such as Blender's paths. -S: no site-packages, so it starts faster.
# -B: no bytecode files.
OPTIONS = ["-I", "-S", "-B"]
NEXT_PROBE_SECONDS = 2  # without an answer, until the next candidate is probed as well
TIMEOUT_SECONDS = 60  # without an answer to the last probe, until the search fails

UNANSWERED = "did not answer in {seconds} seconds"
UNSTARTED = "can't be started ({reason})"
NONE = "there is none"

_working: Dict[Tuple[str, ...], str] = {}  # candidates -> the one that runs


class NoInterpreter(Error):
    """None of the candidates runs. text: why each failed."""

    name = "interpreter"

    def __init__(self, failures: Dict[str, TranslatableText]) -> None:
        values: Dict[str, object] = {f"path{number}": path for number, path in enumerate(failures)}
        values.update((f"how{number}", how) for number, how in enumerate(failures.values()))
        template = "; ".join(f"{{path{number}}} {{how{number}}}" for number in range(len(failures))) or NONE
        self.text = TranslatableText(template, **values)
        super().__init__(str(self.text))


def start(python: str, *arguments: str, **options: Any) -> "subprocess.Popen[bytes]":
    """Starts an isolated Python; options: of subprocess.Popen. Raises OSError."""
    return subprocess.Popen([python, *OPTIONS, *arguments], creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
                            **options)


def candidates(preferred: str = "") -> Tuple[str, ...]:
    """Paths of Pythons, best first: the preferred one, those next to this Python (Blender's own, for example),
    sys.executable."""
    root = Path(sys.prefix)
    name = f"python{sys.version_info.major}.{sys.version_info.minor}"
    bundled = [root / "bin" / name, root / "bin" / "python3", root / "bin" / "python.exe", root / "python.exe"]
    return tuple(dict.fromkeys(filter(None, [preferred, *(str(path) for path in bundled if path.is_file()),
                                             sys.executable])))


class Search:
    """An asynchronous search for a Python that runs. The result is cached for the session."""

    def __init__(self, preferred: str = "") -> None:
        self._candidates = candidates(preferred)
        self._untried: List[str] = list(self._candidates)
        self._probes: Dict[str, "subprocess.Popen[bytes]"] = {}
        self._failures: Dict[str, TranslatableText] = {}
        self._probe_time = time.monotonic()  # when the last probe began

    def poll(self) -> Optional[str]:
        """The path of a Python that runs; None while the search goes on. Raises NoInterpreter."""
        if working := _working.get(self._candidates):  # a single lookup: another thread may clear the cache
            return working
        for path, probe in self._probes.items():
            if probe.poll() == 0:
                _working[self._candidates] = path
                return path
            if probe.poll() is not None:
                self._failures[path] = describe_exit(probe.returncode)
        silent = [path for path in self._probes if path not in self._failures]
        waited = time.monotonic() - self._probe_time
        if self._untried and (not silent or waited > NEXT_PROBE_SECONDS):
            self._probe(self._untried.pop(0))
        elif not self._untried and (not silent or waited > TIMEOUT_SECONDS):
            timeout = f"{TIMEOUT_SECONDS:g}"
            self._failures.update((path, TranslatableText(UNANSWERED, seconds=timeout)) for path in silent)
            raise NoInterpreter(self._failures)
        return None

    def _probe(self, path: str) -> None:
        self._probe_time = time.monotonic()
        try:
            self._probes[path] = start(path, "-c", "import ctypes", stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)
        except OSError as error:
            self._failures[path] = TranslatableText(UNSTARTED, reason=error.strerror)

    def close(self) -> None:
        """Kills the remaining probes."""
        for probe in self._probes.values():
            probe.kill()
            probe.wait()


def clear_cache() -> None:
    """Makes the next search probe again, because the cached Python has stopped working."""
    _working.clear()
