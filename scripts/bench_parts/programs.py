"""Runs the benchmark programs, each model in a separate process."""

import contextlib
import json
import os
import pathlib
import platform
import re
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = ROOT / "build" / "bench"  # reports
PROGRAMS = ROOT / "build" / "release"
BUILDER = pathlib.Path(__file__).with_name("builds.py")
WORK = BUILD / "models"  # generated and extracted models
TIME_LIMIT = 1200  # seconds for one process, so that nothing hangs forever
STAGES_TIME_LIMIT = "3h"  # for one that alternates with others


class Failure(Exception):
    """The measurement can't continue. The message says why."""


def run(*command, time_limit=TIME_LIMIT):
    """Runs a program: (its JSON output, {} without any, None) or (None, the reason of its failure)."""
    try:
        process = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=time_limit)
    except subprocess.TimeoutExpired:
        return None, f"not done after {time_limit} s"
    if process.returncode:
        return None, (process.stderr.strip() or f"ended with code {process.returncode}").splitlines()[-1]
    return json.loads(process.stdout or "{}"), None


def required(model, result):
    """The report of a result of run(). Raises Failure."""
    report, reason = result
    if report is None:
        raise Failure(f"{model}: {reason}")
    return report


def build(kind, *words, time_limit=TIME_LIMIT):
    """Builds a model by builds.py: (report, None) or (None, why not)."""
    return run(ROOT / "build/venv/core/bin/python", BUILDER, kind, *words, time_limit=time_limit)


def stages(model, repetitions, quality=0):
    """Runs stages_bench on a model: (report, None) or (None, why it can't be built)."""
    try:
        with Stages(model, quality) as program:
            return {**program.report, "seconds": [program.rebuild() for _ in range(repetitions)]}, None
    except Failure as failure:
        return None, str(failure)


class Stages(contextlib.AbstractContextManager):
    """A stages_bench process with one model that can be built repeatedly, so that several models can alternate. Raises
    Failure with the program's last line of output."""

    def __init__(self, model, quality=0):
        self._process = subprocess.Popen(["timeout", STAGES_TIME_LIMIT, PROGRAMS / "stages_bench", model, str(quality)], text=True,
                                         stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.report = self._read()  # sizes, peak and the first run

    def rebuild(self):
        """Builds the model again: {stage: [wall seconds, processor seconds]}"""
        with contextlib.suppress(BrokenPipeError):  # the process has ended; _read() raises the reason
            print(file=self._process.stdin, flush=True)
        return self._read()

    def __exit__(self, *_):
        self._process.communicate()

    def _read(self):
        line = self._process.stdout.readline()
        if line:
            return json.loads(line)
        _, errors = self._process.communicate()
        raise Failure((errors.strip() or f"ended with code {self._process.returncode}").splitlines()[-1])


def machine():
    """What the results depend on: processor, cores, load, commit."""
    name = re.search(r"model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text())
    commit = subprocess.run(["git", "-C", ROOT, "describe", "--always", "--dirty"], capture_output=True, text=True)
    return {"processor": name.group(1) if name else platform.machine(), "cores": os.cpu_count(),
            "load": round(os.getloadavg()[0], 2), "commit": commit.stdout.strip() or "unknown"}
