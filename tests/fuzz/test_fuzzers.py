# SPDX-License-Identifier: GPL-3.0-or-later
"""The fuzzers of build/fuzz, each for some seconds, from seeds made of real meshes: nothing they try may crash, hang,
leak or break a promise of the header.

PARTWHEEL_FUZZ=600 lets each run for that many seconds. What it found goes to build/test/fuzz: an input that failed is
run again by giving its file to the fuzzer.
"""

import os
import re
import shutil
import subprocess

import pytest
import seeds
from conftest import ROOT

SECONDS = int(os.environ.get("PARTWHEEL_FUZZ", 20))
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


@pytest.mark.parametrize("name", LIMITS)
def test_nothing_is_found(name, corpora):
    fuzzer = ROOT / "build" / "fuzz" / f"{name}_fuzzer"
    assert fuzzer.exists(), f"{fuzzer} is not there: scripts/build fuzz"
    longest, slowest = LIMITS[name]
    found = WORK / name
    found.mkdir(parents=True, exist_ok=True)
    run = subprocess.run(
        [fuzzer, found, corpora / name, f"-max_total_time={SECONDS}", f"-max_len={longest}", f"-timeout={slowest}",
         "-rss_limit_mb=4096", "-print_final_stats=1", f"-artifact_prefix={found}-failed-"],
        capture_output=True, text=True, errors="replace", timeout=SECONDS + slowest + 120,
        env=os.environ | {"LSAN_OPTIONS": f"suppressions={ROOT / 'cmake' / 'lsan.supp'}:print_suppressions=0",
                          "UBSAN_OPTIONS": "print_stacktrace=1"})
    (WORK / f"{name}.log").write_text(run.stdout + run.stderr)
    assert run.returncode == 0, run.stdout[-3000:] + run.stderr[-6000:]
    executed = int(re.search(r"number_of_executed_units:\s*(\d+)", run.stderr).group(1))
    assert executed > 100, "too slow to find anything"
