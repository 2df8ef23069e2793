# SPDX-License-Identifier: GPL-3.0-or-later
"""What is copied and pickled: hierarchies by their saved form, errors with all they say, handles not at all."""

import concurrent.futures
import copy
import gc
import importlib
import inspect
import multiprocessing
import pickle
from pathlib import Path

import numpy as np
import partwheel
import pytest
import shapes
from partwheel import Creases, Deformation, Error, Hierarchy, Index, RayTarget, Status, library, worker
from partwheel.cut import Cut
from partwheel.worker import interpreter

CUBE = shapes.cube()
COPIES = {"pickle": lambda value: pickle.loads(pickle.dumps(value)), "copy": copy.copy, "deepcopy": copy.deepcopy}


def package_classes():
    """Every class that a module of the package defines."""
    root = Path(partwheel.__file__).parent
    files = [path.relative_to(root.parent).with_suffix("") for path in root.rglob("*.py")]
    names = [".".join(file.parts).removesuffix(".__init__") for file in files if file.name not in {"__main__", "process"}]
    classes = {value for name in names for value in vars(importlib.import_module(name)).values() if inspect.isclass(value)}
    return {candidate for candidate in classes if candidate.__module__.partition(".")[0] == "partwheel"}


def build_cube():
    return Hierarchy.build(*CUBE)


# ---- Hierarchies


def same_hierarchy(one, other):
    return (one.save() == other.save() and one.seconds == other.seconds and one.summary == other.summary
            and all(np.array_equal(getattr(one, name), getattr(other, name)) for name in library.Arrays.POINTERS))


@pytest.mark.parametrize("copy_of", COPIES)
def test_a_copy_of_a_hierarchy_outlives_it(copy_of):
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


def refuse(_):
    """In a process of the pool."""
    Hierarchy.build(CUBE.vertices * np.nan, CUBE.triangles)


@pytest.fixture(scope="module")
def pool():
    with concurrent.futures.ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
        yield pool


def test_a_hierarchy_goes_to_another_process_and_back(pool):
    hierarchy = build_cube()
    assert pool.submit(answers, hierarchy).result() == answers(hierarchy)
    assert same_hierarchy(pool.submit(copy.copy, hierarchy).result(), hierarchy)


def test_the_pool_hands_on_what_was_refused(pool):
    with pytest.raises(partwheel.PartwheelError) as refused:
        pool.submit(refuse, 0).result()
    assert refused.value.status == Status.NOT_FINITE and refused.value.name == "not finite"
    with pytest.raises(partwheel.PartwheelError) as raised_here:
        refuse(0)
    assert str(refused.value) == str(raised_here.value)


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


def names_in(function):
    """Attributes that a function of Python uses."""
    return function.__code__.co_names if inspect.isfunction(function) else ()


def test_every_class_with_native_memory_is_known():
    """One that is added either has a saved form or is refused, and is tested here."""
    refused = {cls for cls in package_classes() if issubclass(cls, library.NonCopyable)} - {library.NonCopyable}
    assert refused == set(HANDLES)
    holding = {cls for cls in package_classes() if "_handle" in names_in(cls.__init__)}
    assert holding - refused == {Hierarchy}


@pytest.mark.parametrize("copy_of", COPIES)
@pytest.mark.parametrize("kind", HANDLES)
def test_a_handle_is_neither_copied_nor_pickled(kind, copy_of):
    handle = HANDLES[kind]()
    with pytest.raises(TypeError, match=f"{kind.__name__} can't be copied or pickled.*Make "):
        COPIES[copy_of](handle)


# ---- Errors

ERRORS = {
    "Error": lambda kind: kind("Something was refused."),
    "CutError": lambda kind: kind("It is no node."),
    "LibraryError": lambda kind: kind("There is no library."),
    "PartwheelError": lambda kind: kind(Status.OPEN, "A hole.", {"surface": 0.25}),
    "MeshFileError": lambda kind: kind("No mesh."),
    "UrdfError": lambda kind: kind("No robot."),
    "PrintError": lambda kind: kind("Too thin."),
    "FolderInUseError": lambda kind: kind("Another run is here."),
    "RequirementError": lambda kind: kind("A package is missing."),
    "WorkerError": lambda kind: kind("worker", worker.job.START_FAILED, worker.job.MESH_UNCHANGED, reason=OSError(2, "No such file")),
    "NoInterpreter": lambda kind: kind({"/bin/false": worker.exit_status.describe_exit(1), "/bin/cat": worker.exit_status.describe_exit(-9)}),
}


def plain(value):
    """An attribute as something that can be compared: exceptions and TranslatableTexts are equal only to themselves."""
    if isinstance(value, dict):
        return {name: plain(item) for name, item in value.items()}
    return (type(value), str(value)) if isinstance(value, Exception) or hasattr(value, "sentences") else value


@pytest.mark.parametrize("copy_of", COPIES)
@pytest.mark.parametrize("kind", sorted((cls for cls in package_classes() if issubclass(cls, BaseException)),
                                        key=lambda kind: kind.__name__))
def test_errors_keep_all_they_say(kind, copy_of):
    error = ERRORS[kind.__name__](kind)
    error.note = "added by a caller"
    copied = COPIES[copy_of](error)
    assert type(copied) is kind and isinstance(copied, Error)
    assert str(copied) == str(error) != "" and copied.args == error.args
    assert (copied.name, copied.seconds) == (error.name, error.seconds)
    assert plain(vars(copied)) == plain(vars(error)) and copied.note == error.note


def test_no_interpreter_says_what_became_of_each():
    message = str(interpreter.NoInterpreter({"/bin/false": worker.exit_status.describe_exit(1)}))
    assert message == "/bin/false ended without an answer (exit code 1)"
