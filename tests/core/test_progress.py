# SPDX-License-Identifier: GPL-3.0-or-later
"""Progress, cancelling, and many threads at once."""

import _thread
import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
import shapes
from partwheel import Hierarchy, PartwheelError, FillMethod, Status
from partwheel.hierarchy import POLL_SECONDS

STAGES = ["surface", "repair", "tetrahedra", "cluster", "dendrogram", "hierarchy"]


def test_progress_never_falls_and_ends_whole():
    calls = []
    h = Hierarchy.build(*shapes.off("homer"), progress=lambda *call: calls.append(call))
    fractions = [fraction for fraction, _ in calls]
    places = [STAGES.index(stage) for _, stage in calls]
    assert fractions[0] == 0 and fractions[-1] == 1
    assert fractions == sorted(fractions) and places == sorted(places)
    assert list(h.seconds) == STAGES and all(seconds > 0 for seconds in h.seconds.values())


def test_cancel_before_the_first_stage():
    with pytest.raises(PartwheelError) as stopped:
        Hierarchy.build(*shapes.cube(), progress=lambda *_: True)
    assert stopped.value.status == Status.CANCELED


def test_cancel_in_the_middle():
    polls = []

    def progress(fraction, _):
        polls.append(fraction)
        return fraction > 0

    with pytest.raises(PartwheelError) as stopped:
        Hierarchy.build(*shapes.off("bear"), progress=progress)
    assert stopped.value.status == Status.CANCELED
    assert 0 < polls[-1] < 1


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


def test_many_threads_may_ask_one_hierarchy(build_shape):
    shape, h = build_shape("hand.off")
    faces = np.random.default_rng(2).integers(0, shape.face_count, 200).tolist()

    def query(face):
        stops, start = h.wheel(face)
        return (h.path(face).tolist(), stops.tolist(), start, h.faces(stops[start]).tolist(),
                h.hull(stops[start])[1].tolist(), h.cut_parts(face % 50 + 1).tolist())

    alone = [query(face) for face in faces]
    with ThreadPoolExecutor(8) as pool:
        assert list(pool.map(query, faces)) == alone


def test_builds_in_parallel_give_the_same(build_shape):
    shape, h = build_shape("torus")
    with ThreadPoolExecutor(4) as pool:
        for other in pool.map(lambda _: Hierarchy.build(*shape), range(8)):
            assert other.save() == h.save()


def test_error_messages_belong_to_their_build():
    good, open_, crossed = shapes.cube(), shapes.cube(), shapes.merged(shapes.cube(), shapes.cube())
    open_ = shapes.Shape(open_.vertices, open_.triangles[1:], None, None)

    def build(shape):
        try:
            Hierarchy.build(*shape, fill_methods=FillMethod.EXACT)
        except PartwheelError as error:
            return error.name, str(error)

    expected = [build(shape) for shape in (good, open_, crossed)]
    with ThreadPoolExecutor(6) as pool:
        assert list(pool.map(build, [good, open_, crossed] * 40)) == expected * 40
