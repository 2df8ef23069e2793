# SPDX-License-Identifier: GPL-3.0-or-later
"""The fuzzers of build/fuzz, each for some seconds, from seeds made of real meshes: nothing they try may crash, hang,
leak or break a promise of the header.

PARTWHEEL_FUZZ=600 lets each run for that many seconds. What it found goes to build/test/fuzz: an input that failed is
run again by giving its file to the fuzzer. What was found before is in found/, and run each time.
"""

import os
import re
import shutil
import subprocess

import pytest
import seeds
from conftest import ROOT

SECONDS = int(os.environ.get("PARTWHEEL_FUZZ", 20))
FOUND = ROOT / "tests" / "fuzz" / "found"
WORK = ROOT / "build" / "test" / "fuzz"
LIMITS = {  # bytes of an input, seconds for one input
    "mesh": (1200, 120),
    "saved": (seeds.MOST_SAVED, 20),
}


@pytest.fixture(scope="module")
def corpora():
    """Where the seeds are; what an earlier run found interesting stays beside them."""
    directory = WORK / "seeds"
    shutil.rmtree(directory, ignore_errors=True)
    assert min(seeds.write(directory)) >= 10
    return directory


def run(name, *arguments, seconds):
    """A fuzzer with these arguments, and the limits of one input; seconds by the clock for all of it."""
    fuzzer = ROOT / "build" / "fuzz" / f"{name}_fuzzer"
    assert fuzzer.exists(), f"{fuzzer} is not there: scripts/build fuzz"
    return subprocess.run(
        [fuzzer, *arguments, f"-timeout={LIMITS[name][1]}", "-rss_limit_mb=4096"],
        capture_output=True, text=True, errors="replace", timeout=seconds,
        env=os.environ | {"LSAN_OPTIONS": f"suppressions={ROOT / 'cmake' / 'lsan.supp'}:print_suppressions=0",
                          "UBSAN_OPTIONS": "print_stacktrace=1"})


@pytest.mark.parametrize("path", sorted(FOUND.glob("*/*")), ids=lambda path: path.name)
def test_what_was_found_is_mended(path):
    name = path.parent.name
    result = run(name, path, seconds=LIMITS[name][1] + 60)
    assert result.returncode == 0, result.stderr[-6000:]


@pytest.mark.parametrize("name", LIMITS)
def test_nothing_is_found(name, corpora):
    longest, slowest = LIMITS[name]
    found = WORK / name
    found.mkdir(parents=True, exist_ok=True)
    result = run(name, found, corpora / name, f"-max_total_time={SECONDS}", f"-max_len={longest}",
                 "-print_final_stats=1", f"-artifact_prefix={found}-failed-", seconds=SECONDS + slowest + 120)
    (WORK / f"{name}.log").write_text(result.stdout + result.stderr)
    assert result.returncode == 0, result.stdout[-3000:] + result.stderr[-6000:]
    executed = int(re.search(r"number_of_executed_units:\s*(\d+)", result.stderr).group(1))
    assert executed > 100, "too slow to find anything"
