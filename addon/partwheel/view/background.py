# SPDX-License-Identifier: GPL-3.0-or-later
"""A computation in a background thread. It must not access Blender's data."""

from __future__ import annotations

from collections.abc import Callable
import threading


class BackgroundTask:
    """Runs function(stop) in a thread; stop is a threading.Event that asks it to return early, without an error."""

    def __init__(self, function: Callable[[threading.Event], None]) -> None:
        self._function, self._stop, self._error = function, threading.Event(), None
        self._thread = threading.Thread(target=self._run, name="partwheel-background")
        self._thread.start()

    def _run(self) -> None:
        try:
            self._function(self._stop)
        except Exception as error:  # any error: finish() raises it
            self._error = error

    def is_running(self, seconds: float = 0) -> bool:
        """Return whether the thread still runs after at most this many seconds."""
        self._thread.join(seconds)
        return self._thread.is_alive()

    def request_stop(self) -> None:
        """Ask the thread to end, without waiting: its result is not needed any more."""
        self._stop.set()

    def finish(self) -> None:
        """Wait for the end and raise what the function raised."""
        self._thread.join()
        if self._error:
            raise self._error
