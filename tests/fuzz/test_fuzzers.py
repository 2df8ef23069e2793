# SPDX-License-Identifier: GPL-3.0-or-later
"""The fuzzers of build/asan, each for a hundred inputs, from seeds made of real meshes: nothing they try may crash, hang,
leak or break a promise of the header.

PARTWHEEL_FUZZ=600 lets each run for that many seconds instead. What it found goes to build/test/fuzz: an input that failed is
run again by giving its file to the fuzzer. What was found before is in found/, and run each time.
"""

import os
import re
import subprocess

import pytest
import seeds
from conftest import ROOT
from partwheel import Hierarchy, PartwheelError

SECONDS = int(os.environ.get("PARTWHEEL_FUZZ", 0))
INPUTS = 100  # of the fuzzer's own, where no seconds are given
FOUND = ROOT / "tests" / "fuzz" / "found"
WORK = ROOT / "build" / "test" / "fuzz"
LONGEST = {"mesh": 1200, "saved": seeds.MOST_SAVED, "surface": 1500}  # bytes of an input
HANGS = 3600  # seconds for one input: far more than the slowest machine takes, so that what takes them hangs
# Fuzzer, kind of seed -> what the fuzzer tells of one at least; functions of the library that run; and that do not.
REACHED = {
    ("mesh", "exact"): ("ok exact, learned, triangles, 0 threads, no points inside, coarse",
                        ["cluster(", "merge_parts("], ["transfer_parts(", "smoothed(", "displace_vertices("]),
    ("mesh", "repaired"): ("ok repaired, learned, triangles, 1 threads, no points inside, coarse", ["attach("], []),
    ("mesh", "inside"): ("ok exact, learned, triangles, 2 threads, points inside, coarse",
                         ["fill_proxy(", "transfer_parts("], ["smoothed("]),
    ("mesh", "polygons"): ("ok exact, learned, polygons, 3 threads, no points inside, coarse", ["merge_parts("], []),
    ("mesh", "paper"): ("ok exact, paper, polygons, 0 threads, no points inside, coarse", ["cluster("], ["merge_parts("]),
    ("mesh", "fine"): ("ok exact, learned, triangles, 0 threads, no points inside, fine",
                       ["estimate_noise(", "merge_parts("], ["smoothed("]),
    ("mesh", "rough"): ("ok exact, learned, triangles, 0 threads, no points inside, fine",
                        ["smoothed(", "transfer_parts("], ["displace_vertices("]),
    # Smoothing would round the cube's corners by more than it may, so it is repaired another way in the end.
    ("mesh", "crossing"): ("ok repaired, learned, triangles, 0 threads, no points inside, fine",
                           ["displace_vertices(", "smoothed(", "attach("], []),
    ("mesh", "coarse"): ("ok coarse, learned, triangles, 0 threads, no points inside, coarse",
                         ["decimate(", "restore_source_faces("], []),
    **{("saved", kind): ("loaded", ["Hierarchy::finish(", "SolidBuilder::build(", "SolidBuilder::tets_of_faces(",
                                    "Hierarchy::cut_automatic(", "PartIndex::first_hit(", "PartIndex::intersect("], [])
       for kind in seeds.SAVED},
    **{("surface", kind): ("normals distances faults fair snapped deformed",
                           ["fair_vertices(", "minimum_cut(", "Deformation::iterate("], [])
       for kind in ("triangles", "polygons")},
}


@pytest.fixture(scope="module")
def corpora(tmp_path_factory):
    """Where the seeds are, for each process that runs tests; what an earlier run found interesting stays in WORK."""
    directory = tmp_path_factory.mktemp("seeds")
    counts = seeds.write(directory)
    assert len(counts) == len(LONGEST) and min(counts) >= 10
    return directory


def run(name, *arguments, **environment):
    """A fuzzer with these arguments; inputs that fail, hang or are slow go to WORK."""
    fuzzer = ROOT / "build" / "asan" / f"{name}_fuzzer"
    assert fuzzer.exists(), f"{fuzzer} is not there: scripts/build asan"
    WORK.mkdir(parents=True, exist_ok=True)
    return subprocess.run(
        [fuzzer, *arguments, f"-timeout={HANGS}", "-rss_limit_mb=4096", f"-artifact_prefix={WORK / name}-"],
        capture_output=True, text=True, errors="replace",
        env=os.environ | {"LSAN_OPTIONS": f"suppressions={ROOT / 'cmake' / 'lsan.supp'}:print_suppressions=0",
                          "UBSAN_OPTIONS": "print_stacktrace=1"} | environment)


@pytest.mark.parametrize("path", sorted(FOUND.glob("*/*")), ids=lambda path: path.name)
def test_what_was_found_is_mended(path):
    name = path.parent.name
    result = run(name, path)
    assert result.returncode == 0, result.stderr[-6000:]


@pytest.mark.parametrize("name, kind", REACHED)
def test_seeds_go_where_they_claim(name, kind, corpora):
    """By what the compiler counts: each function that ran."""
    told, reached, passed_by = REACHED[name, kind]
    result = run(name, corpora / name / kind, "-runs=0", "-print_coverage=1", PARTWHEEL_FUZZ_TELL="1")
    assert result.returncode == 0, result.stderr[-6000:]
    assert f"told: {told}\n" in result.stderr, re.findall("told: .*", result.stderr)
    ran = re.findall(r"^COVERED_FUNC: .*?(?:\d+/\d+) (.*)$", result.stderr, re.M)
    for function in reached:
        assert any(f"partwheel::{function}" in each for each in ran), f"{function}) was not reached"
    for function in passed_by:
        assert not any(f"partwheel::{function}" in each for each in ran), f"{function}) was reached"


def test_forged_hierarchies_get_in_here_alone(corpora, tmp_path):
    """The last bytes are the hash: the fuzzer's library does not compare it, the one that is shipped does."""
    for path in (corpora / "saved" / "learned").iterdir():
        forged = bytearray(path.read_bytes())
        forged[-1] ^= 0xFF
        (tmp_path / path.name).write_bytes(forged)
        with pytest.raises(PartwheelError, match="damaged"):
            Hierarchy.load(bytes(forged))
    result = run("saved", tmp_path, "-runs=0", PARTWHEEL_FUZZ_TELL="1")
    assert result.stderr.count("told: loaded\n") == len(list(tmp_path.iterdir())), result.stderr[-3000:]


@pytest.mark.parametrize("name", LONGEST)
def test_nothing_is_found(name, corpora):
    found = WORK / name
    found.mkdir(parents=True, exist_ok=True)
    given = sum(path.is_file() for directory in (found, corpora / name) for path in directory.rglob("*"))
    amount = f"-max_total_time={SECONDS}" if SECONDS else f"-runs={given + INPUTS}"
    result = run(name, found, corpora / name, amount, f"-max_len={LONGEST[name]}", "-print_final_stats=1")
    (WORK / f"{name}.log").write_text(result.stdout + result.stderr)
    assert result.returncode == 0, result.stdout[-3000:] + result.stderr[-6000:]
    executed = int(re.search(r"number_of_executed_units:\s*(\d+)", result.stderr).group(1))
    assert executed >= given + INPUTS, "too slow to find anything"
