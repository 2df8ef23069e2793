# SPDX-License-Identifier: GPL-3.0-or-later
"""Module-level state that several threads use at a time. What is right passes however the threads are scheduled."""

import concurrent.futures
import sys
import time

import shapes
from partwheel import library
from partwheel.cut import mirror_planes
from partwheel.worker import interpreter

THREADS = 8


def test_threads_get_the_mirror_planes_of_their_own_surface():
    """Another thread asks for another surface's planes before every line of the function."""
    cube = shapes.cube()
    one, other = ((cube.vertices * (1, 2, 3) + (place, 0, 0), cube.triangles) for place in (0, 5))
    expected = str(mirror_planes(*one))
    with concurrent.futures.ThreadPoolExecutor(1) as pool:
        assert pool.submit(mirror_planes, *other).result() and str(mirror_planes(*other)) != expected

        def before_each_line(frame, event, _):
            if event == "line":
                pool.submit(mirror_planes, *other).result()
            return before_each_line

        sys.settrace(lambda frame, *_: before_each_line if frame.f_code is mirror_planes.__code__ else None)
        try:
            planes = mirror_planes(*one)
        finally:
            sys.settrace(None)
    assert str(planes) == expected


def test_one_thread_at_a_time_opens_the_library(monkeypatch):
    """On Windows opening it writes a copy of it."""
    open_library, inside, max_inside = library.open_library, [], []

    def noted(path):
        inside.append(path)
        max_inside.append(len(inside))
        time.sleep(0.01)
        inside.pop()
        return open_library(path)

    monkeypatch.setattr(library, "open_library", noted)
    with concurrent.futures.ThreadPoolExecutor(THREADS) as pool:
        list(pool.map(lambda _: library.load.__wrapped__(), range(THREADS)))
    assert max_inside == [1] * THREADS


def test_a_search_survives_a_cache_cleared_by_another_thread(monkeypatch):
    class ForgottenMeanwhile(dict):
        def __contains__(self, key):
            known = super().__contains__(key)
            self.clear()  # as forget() does in another thread
            return known

    search = interpreter.Search()
    monkeypatch.setattr(interpreter, "_working", ForgottenMeanwhile({interpreter.candidates(): sys.executable}))
    try:
        assert search.poll() in (None, sys.executable)
    finally:
        search.close()
