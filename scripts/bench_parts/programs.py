"""Running the measuring programs, each model in a process of its own."""

import json
import os
import pathlib
import platform
import re
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = ROOT / "build" / "bench"
WORK = BUILD / "models"  # models made or unpacked for the benchmarks
TIME_LIMIT = 1200  # seconds for any one process, so that nothing hangs for ever


class Failure(Exception):
    """Nothing more can be measured. The message says why."""


def run(*command, time_limit=TIME_LIMIT):
    """-> (what the program printed as JSON, None) or (None, why there is none)."""
    try:
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=time_limit)
    except subprocess.TimeoutExpired:
        return None, f"not done after {time_limit} s"
    if done.returncode:
        last = (done.stderr.strip() or f"ended with code {done.returncode}").splitlines()[-1]
        return None, last
    return json.loads(done.stdout), None


def stages(model, repetitions, quality=0):
    """What stages_bench prints of one model, and why not if it can't be built."""
    return run(BUILD / "stages_bench", model, repetitions, quality)


def machine():
    """What the numbers depend on: processor, cores, system, commit."""
    name = re.search(r"model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text())
    commit = subprocess.run(["git", "-C", ROOT, "describe", "--always", "--dirty"], capture_output=True, text=True)
    return {"processor": name.group(1) if name else platform.machine(), "cores": os.cpu_count(),
            "load": round(os.getloadavg()[0], 2), "commit": commit.stdout.strip() or "unknown"}
