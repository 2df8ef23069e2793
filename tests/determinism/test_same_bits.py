# SPDX-License-Identifier: GPL-3.0-or-later
"""Saved hierarchies are the same bits from every compiler, optimized or not, with wide vectors or narrow ones, in
one thread or many.

The libraries are those of build/PRESET/libpartwheel.so, which scripts/test builds; each runs in a process of its own.
"""

import functools
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from digests import CASES, ROOT

# What must not matter: preset and threads (0: as many as help). The first is what all are compared with.
CONFIGURATIONS = {
    "g++ -O2, one thread": ("release", 1),
    "g++ -O2, three threads": ("release", 3),
    "clang++ -O2": ("clang", 0),
    "g++ -O2 with AVX2": ("avx2", 0),
    "g++ -O0": ("unoptimized", 0),
}
REFERENCE, *OTHERS = CONFIGURATIONS


@functools.cache
def digests(configuration):
    preset, threads = CONFIGURATIONS[configuration]
    if preset == "avx2" and not re.search(r"^flags\b.*\bavx2\b", Path("/proc/cpuinfo").read_text(), re.MULTILINE):
        pytest.skip("this processor has no AVX2")
    library = ROOT / "build" / preset / "libpartwheel.so"
    assert library.exists(), f"{library} is not there: scripts/build {preset} partwheel"
    run = subprocess.run([sys.executable, str(Path(__file__).with_name("digests.py")), str(threads)],
                         capture_output=True, text=True, timeout=900,
                         env=os.environ | {"PARTWHEEL_LIBRARY": str(library)})
    assert run.returncode == 0, run.stderr
    return json.loads(run.stdout)


def test_models_differ():
    # A digest that says nothing about the model would agree with itself in every configuration.
    assert len(set(digests(REFERENCE).values())) == len(CASES)


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("configuration", OTHERS)
def test_same_bits(configuration, case):
    assert digests(configuration)[case] == digests(REFERENCE)[case]
