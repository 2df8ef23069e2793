# SPDX-License-Identifier: GPL-3.0-or-later
"""A calculation in a thread of its own, while Blender goes on. It must not touch Blender's data."""

from __future__ import annotations

from collections.abc import Callable
import threading


class BackgroundTask:
    """function(stop) in a thread; stop is a threading.Event that asks it to end early, which is no error."""

    def __init__(self, function: Callable[[threading.Event], None]) -> None:
        self._function, self._stop, self._error = function, threading.Event(), None
        self._thread = threading.Thread(target=self._run, name="partwheel-background")
        self._thread.start()

    def _run(self) -> None:
        try:
            self._function(self._stop)
        except Exception as error:  # whatever it is, finish() raises it
            self._error = error

    def is_running(self, seconds: float = 0) -> bool:
        """Whether it still does after at most so many seconds."""
        self._thread.join(seconds)
        return self._thread.is_alive()

    def request_stop(self) -> None:
        """Asks it to end, and waits for nothing: its result is of no use any more."""
        self._stop.set()

    def finish(self) -> None:
        """Waits for its end; raises what it raised."""
        self._thread.join()
        if self._error:
            raise self._error
