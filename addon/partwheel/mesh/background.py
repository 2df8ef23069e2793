# SPDX-License-Identifier: GPL-3.0-or-later
"""A computation in a background thread. It must not access Blender's data."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future, wait
import threading
from typing import Any


class BackgroundTask:
    """Runs function(stop) in a thread; stop is a threading.Event that asks it to return early, without an error."""

    def __init__(self, function: Callable[[threading.Event], Any]) -> None:
        self._function, self._stop, self._future = function, threading.Event(), Future()
        threading.Thread(target=self._run, name="partwheel-background", daemon=True).start()

    def _run(self) -> None:
        try:
            self._future.set_result(self._function(self._stop))
        except BaseException as error:  # any: finish() raises it
            self._future.set_exception(error)

    def is_running(self, seconds: float = 0) -> bool:
        """Return whether the function still runs after at most this many seconds."""
        return not wait([self._future], seconds).done

    def request_stop(self) -> None:
        """Ask the function to end, without waiting: its result is not needed any more."""
        self._stop.set()

    def finish(self) -> Any:
        """Wait for the end. Return what the function returned, or raise what it raised."""
        return self._future.result()
