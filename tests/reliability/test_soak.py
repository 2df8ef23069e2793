# SPDX-License-Identifier: GPL-3.0-or-later
"""Broken meshes by the hundred, each in a worker: every answer is sound or an error that the mesh deserves, nothing
hangs beyond its limit, and this process neither crashes nor leaks.

PARTWHEEL_SOAK=2000 sets how many, of up to 1,500 triangles and with 30 seconds of work for each worker; without it a
few small ones with 4 seconds. PARTWHEEL_SOAK_FROM is the first seed. What befell each is left in build/test/soak.txt.

Time is the workers' own processor time, read from the system, so that a busy machine makes nothing fail; only a worker
that does no work at all is judged by the clock.
"""

import os
import signal
import threading
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import models
import mutations
import numpy as np
import pytest
import solids
from conftest import ROOT
from partwheel import Hierarchy, PartwheelError
from partwheel.worker import Job

LONG = "PARTWHEEL_SOAK" in os.environ
COUNT = int(os.environ.get("PARTWHEEL_SOAK", 30))
FIRST = int(os.environ.get("PARTWHEEL_SOAK_FROM", 1))
MOST_TRIANGLES = 1500 if LONG else 200
SECONDS = 30 if LONG else 4  # of work for a worker; there are three at most
LATE = 60  # more of them until a worker beyond its limit is ended: this process may have to wait for its turn
LOOK = 0.1  # seconds between two looks at a worker
PROCESSES = 2
# What a mesh of finite coordinates and right indices may be called.
SOUND_ERRORS = {"not solid", "no volume", "not finite"}
# Answers that are none, though with a name. The mesher's are counted, and few; time depends on the machine.
LOST = {"crash", "memory", "tetrahedra", "internal"}
MOST_LOST = 0.05
LEAK = 64 * 2**20


@pytest.fixture(scope="module")
def sources():
    """Real meshes that are small, so that many mutants can be built."""
    small = []
    for name in models.demo():
        if name not in models.NO_TRIANGLES and (models.DEMO / name).stat().st_size < 150_000:
            vertices, triangles, *_ = models.read(name)
            if 4 <= len(triangles) <= MOST_TRIANGLES:
                small.append((name, vertices, triangles))
    assert len(small) > (50 if LONG else 25)
    return small


def processor_seconds(process):
    """Of a child of this process, its threads together, also after its end; 0 once it is gone."""
    try:
        fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    except (FileNotFoundError, ProcessLookupError):
        return 0
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def watched(job, most_work=SECONDS + LATE, most_idle=2 * SECONDS + LATE):
    """(processor seconds of the job's workers, what is wrong with them or None), at the job's end or when it hangs.
    Looks without any work are counted, not the time between them: this process may be held up just as a worker may."""
    taken, idle = {}, 0
    while not job.wait(LOOK):
        process, before = job._process and job._process.pid, sum(taken.values())
        if process:
            taken[process] = max(processor_seconds(process), taken.get(process, 0))
        idle = 0 if sum(taken.values()) > before else idle + LOOK
        if idle > most_idle:
            job.cancel()
            return before, f"hung: {idle:.0f} s without any work"
    work, beyond = sum(taken.values()), max(taken.values(), default=0) > most_work or len(taken) > 3
    return work, f"took {work:.0f} s of {len(taken)} workers" if beyond else None


def outcome(seed, sources):
    """One mutant from start to end: (line for the table, what is wrong with the answer or None, the answer's name)."""
    name, vertices, triangles = sources[seed % len(sources)]
    steps, vertices, triangles, error = mutations.mutated(seed, vertices, triangles)
    label = f"{seed} {name} {'+'.join(steps)}"
    job = Job(vertices, triangles, cpu_limit=SECONDS, memory_limit=4 * 2**30)
    (seconds, late), wrong = watched(job), None
    try:
        h = job.result()
        result = h.summary.fill_method
        if error:
            wrong = f"built, though it is {error}"
        else:
            check(h, vertices, triangles)
    except PartwheelError as refused:
        result = refused.name
        if refused.name != error and (error or refused.name not in SOUND_ERRORS | LOST | {"time limit"}):
            wrong = f"{refused.name}: {refused}"
        elif not str(refused).endswith("."):
            wrong = f"not a sentence: {refused}"
    except AssertionError as unsound:
        result, wrong = "unsound", f"unsound: {unsound}"
    fates = [failure.name for failure in job.failures]
    wrong = late or wrong
    return f"{label:70}{result:14}{seconds:6.1f} s {' '.join(fates)}", wrong and f"{label}: {wrong}", result


def check(h, vertices, triangles):
    """The invariants of every hierarchy, and of some of its answers."""
    count = len(triangles)
    solids.check(h, vertices, triangles, np.arange(count), count)
    assert Hierarchy.load(h.save()).save() == h.save()
    for face in {0, count // 2, count - 1}:
        stops, start = h.wheel(face)
        path = set(h.path(face).tolist())
        assert 0 <= start < len(stops) and set(stops.tolist()) <= path and stops[-1] == len(h.parent) - 1
        assert all(face in h.faces(stop) for stop in stops)


def memory():
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE")


def test_a_worker_that_hangs_is_found():
    """Where Job itself would wait for long: a worker that is stopped, and one that works for longer than it may."""
    vertices, triangles, *_ = models.read("armadillo.off")
    job = Job(vertices, triangles, cpu_limit=1000)
    while not job._process:
        job.wait(0.01)
    os.kill(job._process.pid, signal.SIGSTOP)
    assert "without any work" in watched(job, most_idle=1)[1]
    job = Job(vertices, triangles, cpu_limit=1000)
    seconds, late = watched(job, most_work=0)
    assert seconds > 0 and "took" in late
    assert job.result().summary.fill_method == "exact"


def test_mutated_models_are_built_or_refused(sources):
    seeds = range(FIRST, FIRST + COUNT)
    warm_up = min(COUNT // 2, 100)
    with ThreadPoolExecutor(PROCESSES) as pool:
        lines = list(pool.map(lambda seed: outcome(seed, sources), seeds[:warm_up]))
        before = memory()
        lines += pool.map(lambda seed: outcome(seed, sources), seeds[warm_up:])
    counts = Counter(result for *_, result in lines)
    table = [*(line for line, *_ in lines), ", ".join(f"{count} {result}" for result, count in counts.most_common())]
    (ROOT / "build" / "test").mkdir(exist_ok=True)
    (ROOT / "build" / "test" / "soak.txt").write_text("\n".join(table) + "\n")
    wrong = [problem for _, problem, _ in lines if problem]
    assert not wrong, "\n".join(wrong)
    assert sum(counts[name] for name in LOST) <= max(1, MOST_LOST * COUNT), table[-1]
    assert memory() - before < LEAK
    assert not [thread for thread in threading.enumerate() if thread.name.startswith("partwheel-")]
