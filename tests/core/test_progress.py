# SPDX-License-Identifier: GPL-3.0-or-later
"""Progress, cancelling, and many threads at once."""

import _thread
import threading

import pytest
import shapes
from partwheel import Hierarchy
from partwheel.hierarchy import POLL_SECONDS

STAGES = ["surface", "repair", "tetrahedra", "cluster", "dendrogram", "hierarchy"]


def test_an_exception_in_progress_stops_the_build_and_goes_on():
    class Interrupted(Exception):
        pass

    def progress(fraction, _):
        if fraction > 0:
            raise Interrupted

    with pytest.raises(Interrupted):
        Hierarchy.build(*shapes.off("bear"), progress=progress)
    assert not [thread for thread in threading.enumerate() if thread.name == "partwheel-build"]


def test_ctrl_c_stops_the_build(monkeypatch):
    wait = threading.Event.wait

    def interrupted(event, timeout=None):  # in the midst of waiting for the build
        if timeout == POLL_SECONDS:
            _thread.interrupt_main()
        return wait(event, timeout)

    monkeypatch.setattr(threading.Event, "wait", interrupted)
    with pytest.raises(KeyboardInterrupt):
        Hierarchy.build(*shapes.off("bear"))
    assert not [thread for thread in threading.enumerate() if thread.name == "partwheel-build"]


def test_python_runs_on_during_a_build():
    """ctypes lets go of Python's lock: this thread counts while another builds."""
    is_done = threading.Event()
    shape = shapes.off("homer")
    builder = threading.Thread(target=lambda: (Hierarchy.build(*shape), is_done.set()))
    builder.start()
    counted = 0
    while not is_done.is_set():
        counted += 1
    builder.join()
    assert counted > 1000
