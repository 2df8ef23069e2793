# SPDX-License-Identifier: GPL-3.0-or-later
"""Job: the same answers as a build in this process; and whatever befalls the worker, an error with a name, no process,
no file, no open pipe left, and a new attempt on the next fill method.

The harm is done by a real library with one function replaced (tests/faults), so the product has no hook for tests. How
fast the machine is must not matter: workers are held where they come to harm, and where a test is about the clock it
has one of its own.
"""

import _thread
import os
import resource
import signal
import subprocess
import sys
import textwrap
import threading
import time
import types
from pathlib import Path

import faults
import numpy as np
import pytest
import shapes
from conftest import PACKAGES, PLAIN, UNLIMITED
from partwheel import FillMethod, Hierarchy, PartwheelError, Stage, Status
from partwheel.library import load
from partwheel.worker import MESSAGE, Job, WorkerError
from partwheel.worker import job as worker

HERE = Path(__file__).parent
LINUX = sys.platform == "linux"
EXACT = 1  # pw_fill_method: with it alone there is one attempt
STAGES = range(len(Stage))
LIMIT = 400 * 2**20
NEVER = 600  # seconds until something counts as never happening


@pytest.fixture(scope="session")
def faulty_entry(tmp_path_factory):
    directory = tmp_path_factory.mktemp("faults")
    return faults.entry(worker.ENTRY, faults.library(load()._name, directory), directory)


@pytest.fixture
def harm(faulty_entry, monkeypatch):
    """harm("segv", 2): from now on workers crash in stage 2. This process keeps the library that it has loaded."""
    def set_fault(fault, stage, fill_method=None):
        monkeypatch.setattr(worker, "ENTRY", faulty_entry)
        monkeypatch.setenv("PARTWHEEL_FAULT", f"{fault}:{stage}")
        if fill_method:
            monkeypatch.setenv("PARTWHEEL_FAULT_METHOD", str(fill_method))
    return set_fault


def process_id(job):
    """Of the current or last worker; None if there is none yet."""
    job.poll()
    return job._process.pid if job._process else None


def state(process):
    """The state letter of a process, or None if there is none; one that nobody has asked after yet (Z) is none."""
    try:
        letter = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0]
    except OSError:
        return None
    return None if letter == "Z" else letter


def until(predicate):
    """Waits for something that must happen."""
    start_time = time.monotonic()
    while not predicate():
        assert time.monotonic() - start_time < NEVER, "never seen"
        time.sleep(0.005)


class Clock:
    """The clock by which jobs judge workers that do nothing: it stands still unless it is set on."""

    def __init__(self):
        self.now, self.looks = 1000.0, 0

    def monotonic(self):
        self.looks += 1
        return self.now

    def set_on(self, seconds, job):
        """And waits until the job has looked at it."""
        self.now, looks = self.now + seconds, self.looks
        until(lambda: self.looks > looks + 1 or job.poll() is None)


@pytest.fixture
def clock(monkeypatch):
    clock = Clock()
    monkeypatch.setattr(worker, "time", types.SimpleNamespace(monotonic=clock.monotonic))
    return clock


@pytest.fixture(autouse=True)
def nothing_is_left(tmp_path, monkeypatch):
    empty = tmp_path / "empty"
    empty.mkdir()
    monkeypatch.chdir(empty)
    monkeypatch.setenv("TMPDIR", str(empty))
    pipes = set(os.listdir("/proc/self/fd")) if LINUX else None
    yield
    until(lambda: not [thread for thread in threading.enumerate() if thread.name.startswith("partwheel-")])
    assert list(empty.iterdir()) == []
    if LINUX:
        assert set(os.listdir("/proc/self/fd")) == pipes
        children = Path(f"/proc/self/task/{threading.get_native_id()}/children").read_text().split()
        assert [child for child in children if b"worker/process.py" in Path(f"/proc/{child}/cmdline").read_bytes()] == []


# ---- Answers


def test_the_worker_gives_the_result_of_this_process(case, request):
    shape, h = case
    _, mode = request.node.callspec.params["case"]
    job = Job(*shape, mode=mode, **UNLIMITED)
    assert job.result().save() == h.save()
    assert job.failures == [] and job.poll() is None and job.wait(0)
    assert state(process_id(job)) is None


def test_named_errors():
    cube = shapes.cube()
    for vertices, triangles, status in ((cube.vertices, cube.triangles[1:], Status.OPEN),
                                        (np.zeros((0, 3)), np.zeros((0, 3), int), Status.EMPTY),
                                        (cube.vertices * np.nan, cube.triangles, Status.NOT_FINITE),
                                        (cube.vertices, cube.triangles + 1, Status.INDEX)):
        job = Job(vertices, triangles, fill_methods=EXACT, **UNLIMITED)
        with pytest.raises(PartwheelError) as refused:
            job.result()
        assert refused.value.status == status and job.failures == []
        assert list(refused.value.seconds) == [load().pw_stage_name(stage).decode() for stage in STAGES]
    with pytest.raises(ValueError, match="vertices"):
        Job(cube.vertices[:, :2], cube.triangles)


def test_two_workers_run_concurrently(build_shape):
    names = ["torus", "star", "torus"]
    jobs = [Job(*build_shape(name)[0], **UNLIMITED) for name in names]
    for name, job in zip(names, jobs):
        assert job.result().save() == build_shape(name)[1].save()


def test_a_job_runs_one_thread_and_only_once_polled():
    """Each is a danger to Blender, too, above all to the script that has just asked for a build."""
    Job(*shapes.cube(), **UNLIMITED).result()  # by now a Python is known
    before = threading.active_count()
    job = Job(*shapes.cube(), **UNLIMITED)
    assert threading.active_count() == before and process_id(job)
    max_threads = 0
    while job.poll():
        max_threads = max(max_threads, threading.active_count())
    job.result()
    assert max_threads in (0, before + 1)  # 0: it was over before it was looked at


# ---- Harm

if LINUX and PLAIN:

    CRASHES = {"segv": "SIGSEGV", "abort": "SIGABRT", "free": "SIGABRT", "stack": "SIGSEGV", "exit": "exit code 3",
               "exit0": "exit code 0", "kill": "SIGKILL"}

    @pytest.mark.parametrize("stage", STAGES)
    @pytest.mark.parametrize("fault", CRASHES)
    def test_crashes_at_each_stage(harm, fault, stage):
        harm(fault, stage)
        job = Job(*shapes.off("hand"), fill_methods=EXACT)
        with pytest.raises(WorkerError, match=CRASHES[fault]) as failed:
            job.result()
        assert failed.value.name == "crash" and "The mesh was not changed" in str(failed.value)
        assert job.failures == [failed.value] and state(process_id(job)) is None

    def processor_time_of_children():
        """Seconds, of those that have ended."""
        usage = resource.getrusage(resource.RUSAGE_CHILDREN)
        return usage.ru_utime + usage.ru_stime

    @pytest.mark.parametrize("stage", [Stage.TETRAHEDRA, Stage.CLUSTER, Stage.HIERARCHY])
    def test_progress_is_reported_while_it_builds(harm, stage):
        harm("sleep", stage)
        job = Job(*shapes.off("hand"))
        assert job.poll() == (0.0, "surface")
        name = load().pw_stage_name(stage).decode()
        until(lambda: job.poll()[0] > 0 and job.poll()[1] == name)
        job.cancel()

    @pytest.mark.parametrize("stage", STAGES)
    def test_an_endless_loop_is_killed(harm, clock, stage):
        harm("loop", stage)
        before = processor_time_of_children()
        job = Job(*shapes.off("hand"), fill_methods=EXACT, cpu_limit=1)
        with pytest.raises(WorkerError, match="after 1 seconds of work") as failed:
            job.result()
        assert failed.value.name == "time limit" and 1 <= processor_time_of_children() - before
        assert state(process_id(job)) is None

    @pytest.mark.parametrize("stage", STAGES)
    @pytest.mark.parametrize("fault", ["stop", "sleep"])
    def test_an_idle_worker_is_killed(harm, clock, fault, stage):
        harm(fault, stage)
        job = Job(*shapes.off("hand"), fill_methods=EXACT, cpu_limit=60)
        until(lambda: faults.harmed(process_id(job)))
        clock.set_on(59, job)
        assert job.poll() and state(process_id(job))
        while job.poll():  # earlier work may be reported only now
            clock.set_on(61, job)
        with pytest.raises(WorkerError, match="after 60 seconds without any work") as failed:
            job.result()
        assert failed.value.name == "time limit" and state(process_id(job)) is None

    def test_larger_meshes_have_more_time(harm, clock):
        """Unless a limit is given: two minutes and 2 ms a triangle."""
        harm("sleep", 1)
        shape = shapes.off("hand")
        limit = 120 + 0.002 * len(shape.triangles)
        assert limit > 124
        job = Job(*shape, fill_methods=EXACT)
        until(lambda: faults.harmed(process_id(job)))
        clock.set_on(limit - 1, job)
        assert job.poll() and state(process_id(job))
        while job.poll():  # earlier work may be reported only now
            clock.set_on(limit + 1, job)
        with pytest.raises(WorkerError, match=f"after {limit:g} seconds without any work"):
            job.result()

    def test_a_slow_machine_is_no_reason_to_stop_a_build(clock, monkeypatch, tmp_path):
        """The worker is held up, all in all for longer than the limit, though it does not work for so long."""
        entry = tmp_path / "slow.py"
        entry.write_text(textwrap.dedent(f"""
            import json, os, runpy, time
            for turn in (1, 2, 3):
                while not os.path.exists(f"{tmp_path}/{{turn}}"):
                    time.sleep(0.005)
                message = json.dumps([turn / 100, "surface", 1, turn / 100]).encode()
                os.write(1, {MESSAGE.pack(b"P", 0)[:1]!r} + len(message).to_bytes(8, "little") + message)
            runpy.run_path({str(worker.ENTRY)!r}, run_name="__main__")
        """))
        monkeypatch.setattr(worker, "ENTRY", entry)
        shape = shapes.cube()  # which the pipe holds, so that the job listens before the worker has read it
        job = Job(*shape, fill_methods=EXACT, cpu_limit=60)
        for turn in (1, 2, 3):
            clock.set_on(50, job)
            (tmp_path / str(turn)).touch()
            until(lambda turn=turn: job.poll() is None or job.poll()[0] >= turn / 100)
        assert job.result().save() == Hierarchy.build(*shape).save() and job.failures == []

    @pytest.mark.parametrize("stage", STAGES)
    def test_memory_is_limited(harm, stage, build_shape):
        harm("fill", stage)
        shape, h = build_shape("hand.off")
        job = Job(*shape, fill_methods=EXACT, memory_limit=LIMIT)
        max_memory = 0
        while job.poll() is not None:
            try:
                pages = int(Path(f"/proc/{process_id(job)}/statm").read_text().split()[1])
                max_memory = max(max_memory, pages * os.sysconf("SC_PAGE_SIZE"))
            except OSError:
                pass  # not there yet, or no more
            job.wait(0.001)
        try:
            assert job.result().save() == h.save() and stage > Stage.CLUSTER  # late, little more memory is asked for
        except WorkerError as error:
            assert error.name in {"memory", "crash"}  # a library that does not look at what malloc() says crashes
        assert LIMIT / 4 < max_memory < LIMIT + 50 * 2**20  # it did fill, and code and libraries come on top

    @pytest.mark.parametrize("stage", STAGES)
    def test_memory_written_over(harm, stage):
        """The worker may notice or not: what it answers is loaded as a sound hierarchy of this mesh or refused."""
        harm("corrupt", stage)
        shape = shapes.off("homer")
        job = Job(*shape, fill_methods=EXACT, cpu_limit=20)
        try:
            assert len(job.result().order) == shape.face_count
        except PartwheelError as error:
            assert str(error).endswith(".")
        assert state(process_id(job)) is None

    def test_a_mesh_too_large_for_the_memory():
        with pytest.raises(WorkerError, match="0.0 GiB") as failed:
            Job(*shapes.off("bear"), memory_limit=40 * 2**20, fill_methods=EXACT).result()
        assert failed.value.name == "memory" and failed.value.status == Status.MEMORY

    def test_a_damaged_answer_is_refused(harm):
        harm("scribble", len(Stage))
        with pytest.raises(WorkerError, match="damaged"):
            Job(*shapes.off("hand"), fill_methods=EXACT).result()

    @pytest.mark.parametrize("written", [
        MESSAGE.pack(b"X", 0), MESSAGE.pack(b"P", 2) + b"[]", MESSAGE.pack(b"P", 3) + b"abc",
        MESSAGE.pack(b"E", 2) + b"{}", MESSAGE.pack(b"E", 25) + b'{"status":99,"message":1}',
        MESSAGE.pack(b"S", 2) + b"[]", MESSAGE.pack(b"H", 4) + b"none", MESSAGE.pack(b"H", 0),
    ])
    def test_malformed_answers_of_a_worker_are_refused(monkeypatch, tmp_path, written):
        """It writes what is no sound message, and lives on."""
        entry = tmp_path / "mad.py"
        entry.write_text(f"import os, time\nos.write(1, {written!r})\ntime.sleep({NEVER})")
        monkeypatch.setattr(worker, "ENTRY", entry)
        job = Job(*shapes.cube())
        with pytest.raises(WorkerError, match="damaged answer"):
            job.result()
        assert [failure.name for failure in job.failures] == ["crash"] * len(FillMethod)

    def test_an_answer_for_another_mesh_is_refused(monkeypatch, tmp_path, build_shape):
        saved = build_shape("torus")[1].save()
        (tmp_path / "answer").write_bytes(MESSAGE.pack(b"H", len(saved)) + saved)
        entry = tmp_path / "other.py"
        entry.write_text(f"import sys\nsys.stdout.buffer.write(open({str(tmp_path / 'answer')!r}, 'rb').read())")
        monkeypatch.setattr(worker, "ENTRY", entry)
        with pytest.raises(WorkerError, match="another mesh"):
            Job(*shapes.cube(), fill_methods=EXACT).result()

    def test_output_of_libraries_is_not_read_as_an_answer(harm, build_shape, capfd):
        harm("chatter", len(Stage))
        shape, h = build_shape("hand.off")
        assert Job(*shape, fill_methods=EXACT).result().save() == h.save()
        assert "standard output" in capfd.readouterr().err

    @pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM, signal.SIGSEGV])
    def test_a_worker_killed_by_a_signal_is_reported(harm, number):
        harm("loop", 1)
        job = Job(*shapes.off("hand"), fill_methods=EXACT)
        until(lambda: faults.harmed(process_id(job)))
        os.kill(process_id(job), number)
        with pytest.raises(WorkerError, match=number.name):
            job.result()

    # ---- The next fill method

    def test_the_next_fill_method_is_tried(harm, build_shape):
        harm("segv", 1, fill_method=1)
        shape, h = build_shape("hand.off")
        job = Job(*shape)
        repaired = job.result()
        assert len(job.failures) == 1 and "SIGSEGV" in str(job.failures[0])
        assert len(repaired.order) == shape.face_count
        assert repaired.summary.fill_method != h.summary.fill_method == "exact"

    def test_a_fill_method_that_hangs_is_tried_once(harm, clock):
        harm("loop", 1, fill_method=4)
        job = Job(*shapes.off("cow"), cpu_limit=3)  # neither closed nor to be repaired: one process gets to the points
        assert job.result().summary.fill_method == "sheet"
        assert [failure.name for failure in job.failures] == ["time limit"]

    def test_all_fill_methods_fail(harm):
        harm("abort", 0)
        job = Job(*shapes.cube())
        with pytest.raises(WorkerError) as failed:
            job.result()
        assert len(job.failures) == len(FillMethod) and job.failures[-1] is failed.value

    # ---- Cancel

    @pytest.mark.parametrize("fault", ["loop", "stop"])
    @pytest.mark.parametrize("stage", STAGES)
    def test_cancel_frees_the_machine(harm, fault, stage):
        harm(fault, stage)
        job = Job(*shapes.off("hand"))
        until(lambda: faults.harmed(process_id(job)))  # a stopped process can't be asked to end, only killed
        process = process_id(job)
        job.cancel()
        with pytest.raises(PartwheelError) as stopped:
            job.result()
        assert state(process) is None
        assert stopped.value.status == Status.CANCELED and job.failures == [] and process_id(job) == process

    def test_cancel_at_any_time():
        shape = shapes.off("hand")
        alone = Hierarchy.build(*shape).save()
        for milliseconds in (0, 1, 5, 10, 20, 30, 40, 60, 80, 100, 150):
            job = Job(*shape)
            job.wait(milliseconds / 1000)
            job.cancel()
            try:
                assert job.result().save() == alone
            except PartwheelError as error:
                assert error.status == Status.CANCELED
            job.cancel()

    def test_canceling_a_finished_job_keeps_its_result():
        shape = shapes.off("hand")
        job = Job(*shape)
        until(lambda: job.poll() is None)
        job.cancel()
        assert job.result().save() == Hierarchy.build(*shape).save()

    def test_ctrl_c_outside_a_wait_cancels(harm, clock):
        """As one that comes just before: Python has recorded the signal, but handles it only while it is not waiting. The job
        does not have to end for that."""
        harm("loop", 1)
        job = Job(*shapes.off("hand"), cpu_limit=20)
        timer = threading.Timer(0.05, _thread.interrupt_main)
        with pytest.raises(KeyboardInterrupt):
            timer.start()
            job.result()
        with pytest.raises(PartwheelError) as ended:
            job.result()
        assert ended.value.status == Status.CANCELED and state(process_id(job)) is None

    # ---- The end of the parent

    PARENT = textwrap.dedent("""
        import signal, sys, shapes
        from partwheel.worker import Job, job as worker
        worker.ENTRY = sys.argv[1]
        # Processes started in the background of a shell ignore it.
        signal.signal(signal.SIGINT, signal.default_int_handler)
        job = Job(*shapes.off("hand"))
        while not job._process:
            job.wait(0.01)
        print(job._process.pid, flush=True)
        job.result()
    """)

    def parent(**environment):
        """(a process that builds, its worker's id)"""
        path = os.pathsep.join([PACKAGES, str(HERE)])
        process = subprocess.Popen([sys.executable, "-c", PARENT, worker.ENTRY], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                   text=True, env={**os.environ, "PYTHONPATH": path, **environment})
        return process, int(process.stdout.readline())

    def ends(process, number, worker):
        process.send_signal(number)
        process.communicate()
        until(lambda: state(worker) is None)

    @pytest.mark.parametrize("fault", ["loop", "stop"])
    @pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
    def test_the_worker_ends_with_its_parent(harm, fault, number):
        harm(fault, 1)
        process, worker = parent()
        until(lambda: faults.harmed(worker))
        ends(process, number, worker)

    def test_the_worker_ends_with_its_parent_where_the_system_sends_no_signal(harm, tmp_path):
        """As on macOS and Windows: the end of the pipe alone tells the worker, and that while the library runs."""
        harm("loop", 1)
        source = tmp_path / "no_prctl.c"
        source.write_text("int prctl(int option, ...) { return option * 0; }")
        process, worker = parent(LD_PRELOAD=faults.compiled(source, tmp_path / "no_prctl.so"))
        until(lambda: faults.harmed(worker) and Path(f"/proc/{worker}/maps").read_text().count("no_prctl"))
        ends(process, signal.SIGKILL, worker)
