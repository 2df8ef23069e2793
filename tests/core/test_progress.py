# SPDX-License-Identifier: GPL-3.0-or-later
"""Progress, cancelling, and many threads at once."""

import _thread
import threading

import pytest
import shapes
from partwheel import Hierarchy
from partwheel.hierarchy import POLL_SECONDS


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
