# SPDX-License-Identifier: GPL-3.0-or-later
"""What is copied and pickled: hierarchies by their saved form, errors with all they say, handles not at all."""

import concurrent.futures
import copy
import gc
import multiprocessing
import pickle

import numpy as np
import pytest
import shapes
from partwheel import Creases, Deformation, Hierarchy, Index, PartwheelError, RayTarget, Status, library, worker
from partwheel.cut import Cut

CUBE = shapes.cube()
COPIES = {"pickle": lambda value: pickle.loads(pickle.dumps(value)), "copy": copy.copy, "deepcopy": copy.deepcopy}


def build_cube():
    return Hierarchy.build(*CUBE)


# ---- Hierarchies


def same_hierarchy(one, other):
    return (one.save() == other.save() and one.seconds == other.seconds and one.summary == other.summary
            and all(np.array_equal(getattr(one, name), getattr(other, name)) for name, _ in library.Arrays._fields_
                    if hasattr(one, name)))


@pytest.mark.parametrize("copy_of", COPIES)
def test_a_copy_outlives_the_original_hierarchy(copy_of):
    original = build_cube()
    saved, seconds = original.save(), original.seconds
    copied = COPIES[copy_of](original)
    assert seconds and same_hierarchy(copied, original)
    del original
    gc.collect()
    churn = [build_cube() for _ in range(3)]  # takes the memory that was freed
    assert copied.save() == saved and copied.seconds == seconds and len(churn) == 3
    assert np.array_equal(copied.faces(len(copied.parent) - 1), copied.order)


@pytest.mark.parametrize("copy_of", COPIES)
def test_a_copied_cut_brings_its_hierarchy(copy_of):
    cut = Cut.into(build_cube(), 2)
    copied = COPIES[copy_of](cut)
    assert copied.parts == cut.parts and np.array_equal(copied.labels, cut.labels)
    assert [solid and len(solid.triangles) for solid in copied.solids()] == \
        [solid and len(solid.triangles) for solid in cut.solids()]


def answers(hierarchy):
    return hierarchy.save(), hierarchy.path(0).tolist(), hierarchy.faces(len(hierarchy.parent) - 1).tolist()


@pytest.fixture(scope="module")
def pool():
    with concurrent.futures.ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
        yield pool


def test_a_hierarchy_goes_to_another_process_and_back(pool):
    hierarchy = build_cube()
    assert pool.submit(answers, hierarchy).result() == answers(hierarchy)
    assert same_hierarchy(pool.submit(copy.copy, hierarchy).result(), hierarchy)


# ---- Errors


def raise_everything_known():
    """In a process of the pool."""
    raise PartwheelError(Status.OPEN, "A hole.", {"surface": 0.25}, faces=(3,), vertices=(1, 2), triangle=7)


def test_errors_go_through_a_pool(pool):
    with pytest.raises(PartwheelError, match="A hole.") as raised:
        pool.submit(raise_everything_known).result()
    error = raised.value
    assert (error.status, error.name, error.seconds) == (Status.OPEN, "open", {"surface": 0.25})
    assert (error.faces, error.vertices, error.triangle) == ((3,), (1, 2), 7)


# ---- Handles

HANDLES = {
    library.Handle: lambda: build_cube()._handle,
    library.Context: library.Context,
    Creases: lambda: Creases(*CUBE),
    Deformation: lambda: Deformation(CUBE.vertices, CUBE.triangles, np.arange(len(CUBE.vertices)) - 1),
    Index: lambda: Index(build_cube()),
    RayTarget: lambda: RayTarget(CUBE.vertices, CUBE.triangles),
    worker.Job: lambda: worker.Job(*CUBE),
}


@pytest.mark.parametrize("copy_of", COPIES)
@pytest.mark.parametrize("kind", HANDLES)
def test_a_handle_is_neither_copied_nor_pickled(kind, copy_of):
    handle = HANDLES[kind]()
    with pytest.raises(TypeError, match=f"{kind.__name__} can't be copied or pickled.*Make "):
        COPIES[copy_of](handle)
