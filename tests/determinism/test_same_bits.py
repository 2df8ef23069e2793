# SPDX-License-Identifier: GPL-3.0-or-later
"""Saved hierarchies are the same bits from every compiler, optimized much or little, with wide vectors or narrow ones,
in one thread or many.

The libraries are those of build/PRESET/libpartwheel.so, which scripts/test builds; each runs in a process of its own.
PARTWHEEL_RUNTIMES: what is loaded before a library with sanitizers.
"""

import functools
import json
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from digests import CASES, ROOT

# What must not matter: preset and threads (0: as many as help). The first is what all are compared with.
CONFIGURATIONS = {
    "g++ -O2, one thread": ("release", 1),
    "g++ -O2, three threads": ("release", 3),
    "clang++ -O1 and -O0, sanitizers, this processor's widest vectors": ("asan", 0),
}
REFERENCE, *OTHERS = CONFIGURATIONS

PARTS = 2  # of the cases: the slowest configuration takes longer than all others
POOL = ThreadPoolExecutor(os.cpu_count())


@functools.cache
def started(configuration):
    """Futures of its digests, by parts of the cases."""
    preset, threads = CONFIGURATIONS[configuration]
    library = ROOT / "build" / preset / "libpartwheel.so"
    assert library.exists(), f"{library} is not there: scripts/build {preset} partwheel"
    environment = {"LD_PRELOAD": os.environ["PARTWHEEL_RUNTIMES"], "ASAN_OPTIONS": "detect_leaks=0"} if preset == "asan" else {}
    return [POOL.submit(subprocess.run, [sys.executable, Path(__file__).with_name("digests.py"), str(threads),
                                         *list(CASES)[part::PARTS]],
                        capture_output=True, text=True, env=os.environ | environment | {"PARTWHEEL_LIBRARY": str(library)})
            for part in range(PARTS)]


@functools.cache
def digests(configuration):
    for each in reversed(CONFIGURATIONS):  # side by side, the slowest first
        started(each)
    digests = {}
    for run in started(configuration):
        assert run.result().returncode == 0, run.result().stderr
        digests |= json.loads(run.result().stdout)
    return digests


def test_digests_of_different_models_differ():
    # A digest that says nothing about the model would agree with itself in every configuration.
    assert len(set(digests(REFERENCE).values())) == len(CASES)


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("configuration", OTHERS)
def test_same_bits(configuration, case):
    assert digests(configuration)[case] == digests(REFERENCE)[case]
