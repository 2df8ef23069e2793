# SPDX-License-Identifier: GPL-3.0-or-later
"""Long computations that use no bpy, run here or in a thread.

An operation that needs some is a generator, its "steps": it reads Blender's data, yields each Computation, gets the
result, and writes only after the last one, so that canceling leaves everything as it was:

    weights = yield Computation(skin_weights, vertices, triangles, labels, count)"""

from collections.abc import Callable, Generator
from concurrent.futures import Future, wait
import functools
import threading
from typing import Any

from partwheel import Context


def start_thread(function: Callable[[], Any]) -> Future:
    """Call the function, which must not access Blender's data, in a thread. Blender can quit while it runs."""
    future: Future = Future()

    def run() -> None:
        try:
            future.set_result(function())
        except BaseException as error:  # any: result() raises it
            future.set_exception(error)

    threading.Thread(target=run, name="partwheel-background", daemon=True).start()
    return future


def is_running(future: Future, seconds: float) -> bool:
    """Return whether the function still runs after at most this many seconds."""
    return not wait([future], seconds).done


class Computation:
    """A call of function(*arguments, context=context, **options), where context is a partwheel.Context to cancel it."""

    def __init__(self, function: Callable, *arguments: object, **options: object) -> None:
        self.context = Context()
        self.run = functools.partial(function, *arguments, context=self.context, **options)


Steps = Generator[Computation, Any, Any]


def run_steps(steps: Steps) -> Any:
    """Run the computations in this thread and return what the steps return. Raises what they raise."""
    step = functools.partial(next, steps)
    while True:
        try:
            computation = step()
        except StopIteration as end:
            return end.value
        try:
            step = functools.partial(steps.send, computation.run())
        except Exception as error:  # any: the steps decide
            step = functools.partial(steps.throw, error)


class BackgroundSteps:
    """Steps whose computations run in a thread; all else runs in the thread that calls poll().

    result : what the steps return; None before the end"""

    def __init__(self, steps: Steps) -> None:
        """Run the steps up to the first computation. Raises what they raise."""
        self.result = None
        self._steps, self._computation, self._task = steps, None, None
        self._advance(functools.partial(next, steps))

    def poll(self, seconds: float = 0) -> float | None:
        """Wait at most this many seconds for the running computation, and run the steps after it. Return the fraction
        of the running computation that is done, 0 to 1; None once the steps have ended. Raises what they raise."""
        if self._task:
            if is_running(self._task, seconds):
                return self._computation.context.progress()[0]
            try:
                step = functools.partial(self._steps.send, self._task.result())
            except BaseException as error:  # any: the steps decide
                step = functools.partial(self._steps.throw, error)
            self._advance(step)
        return 0.0 if self._task else None

    def cancel(self) -> None:
        """End the steps. A computation that runs stops at its next check, and its result is dropped."""
        if self._task:
            self._computation.context.cancel()
            self._task = None
        self._steps.close()

    def _advance(self, step: Callable[[], Computation]) -> None:
        self._task = None
        try:
            self._computation = step()
        except StopIteration as end:
            self.result = end.value
            return
        self._task = start_thread(self._computation.run)
