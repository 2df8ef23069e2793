# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the fuzzers of build/asan with a hundred inputs each, from seeds of real meshes: no input may crash, hang, leak memory
or break a promise of the header.

PARTWHEEL_FUZZ=600 runs each for that many seconds instead. Inputs that fail are written to build/test/fuzz; to repeat one, pass
its file to the fuzzer. Earlier findings are in found/ and run each time.
"""

import os
import re
import subprocess

import pytest
import seeds
from conftest import ROOT
from partwheel import Hierarchy, PartwheelError

SECONDS = int(os.environ.get("PARTWHEEL_FUZZ", 0))
INPUTS = 100  # new inputs per fuzzer, without PARTWHEEL_FUZZ
FOUND = ROOT / "tests" / "fuzz" / "found"
WORK = ROOT / "build" / "test" / "fuzz"
MAX_BYTES = {"mesh": 1200, "saved": seeds.MAX_SAVED_BYTES, "surface": 1500}  # bytes of an input
TIME_LIMIT = 3600  # seconds for one input, far more than it takes on the slowest machine
# (fuzzer, kind of seed) -> the fuzzer's description of at least one input; functions of the library that run; that do not.
REACHED = {
    ("mesh", "exact"): ("ok exact, learned, triangles, 0 threads, no points inside, coarse",
                        ["cluster(", "merge_parts("], ["transfer_parts(", "remove_noise(", "displace_vertices("]),
    ("mesh", "repaired"): ("ok repaired, learned, triangles, 1 threads, no points inside, coarse", ["assign_source_faces_by_distance("], []),
    ("mesh", "inside"): ("ok exact, learned, triangles, 2 threads, points inside, coarse",
                         ["fill_proxy(", "transfer_parts("], ["remove_noise("]),
    ("mesh", "polygons"): ("ok exact, learned, polygons, 3 threads, no points inside, coarse", ["merge_parts("], []),
    ("mesh", "paper"): ("ok exact, paper, polygons, 0 threads, no points inside, coarse", ["cluster("], ["merge_parts("]),
    ("mesh", "fine"): ("ok exact, learned, triangles, 0 threads, no points inside, fine",
                       ["estimate_noise(", "merge_parts("], ["remove_noise("]),
    ("mesh", "rough"): ("ok exact, learned, triangles, 0 threads, no points inside, fine",
                        ["remove_noise(", "transfer_parts("], ["displace_vertices("]),
    # Smoothing would round the cube's corners by more than it may, so it is repaired another way in the end.
    ("mesh", "crossing"): ("ok repaired, learned, triangles, 0 threads, no points inside, fine",
                           ["displace_vertices(", "remove_noise(", "assign_source_faces_by_distance("], []),
    ("mesh", "coarse"): ("ok exact, learned, triangles, 0 threads, no points inside, coarse",
                         ["decimate(", "restore_source_faces("], []),
    **{("saved", kind): ("loaded", ["Hierarchy::derive(", "build_surface(", "SolidBuilder::tets_of_faces(",
                                    "Hierarchy::cut_automatic(", "PartIndex::first_hit(", "PartIndex::intersect("], [])
       for kind in seeds.SAVED},
    **{("surface", kind): ("normals distances faults fair snapped deformed",
                           ["fair_vertices(", "minimum_cut(", "Deformation::iterate("], [])
       for kind in ("triangles", "polygons")},
}


@pytest.fixture(scope="module")
def corpora(tmp_path_factory):
    """The folder of the seeds, one for each test process. Interesting inputs of earlier runs stay in WORK."""
    directory = tmp_path_factory.mktemp("seeds")
    counts = seeds.write(directory)
    assert len(counts) == len(MAX_BYTES) and min(counts) >= 10
    return directory


def run(name, *arguments, **environment):
    """Runs a fuzzer with these arguments. Inputs that fail, hang or are slow are written to WORK."""
    fuzzer = ROOT / "build" / "asan" / f"{name}_fuzzer"
    assert fuzzer.exists(), f"{fuzzer} is missing: run scripts/build asan"
    WORK.mkdir(parents=True, exist_ok=True)
    return subprocess.run(
        [fuzzer, *arguments, f"-timeout={TIME_LIMIT}", "-rss_limit_mb=4096", f"-artifact_prefix={WORK / name}-"],
        capture_output=True, text=True, errors="replace",
        env=os.environ | {"LSAN_OPTIONS": f"suppressions={ROOT / 'cmake' / 'lsan.supp'}:print_suppressions=0",
                          "UBSAN_OPTIONS": "print_stacktrace=1"} | environment)


@pytest.mark.parametrize("path", sorted(FOUND.glob("*/*")), ids=lambda path: path.name)
def test_earlier_findings_are_fixed(path):
    name = path.parent.name
    result = run(name, path)
    assert result.returncode == 0, result.stderr[-6000:]


@pytest.mark.parametrize("name, kind", REACHED)
def test_seeds_reach_their_functions(name, kind, corpora):
    """By the compiler's coverage of functions."""
    description, reached, not_reached = REACHED[name, kind]
    result = run(name, corpora / name / kind, "-runs=0", "-print_coverage=1", PARTWHEEL_FUZZ_REPORT="1")
    assert result.returncode == 0, result.stderr[-6000:]
    assert f"input: {description}\n" in result.stderr, re.findall("input: .*", result.stderr)
    ran = re.findall(r"^COVERED_FUNC: .*?(?:\d+/\d+) (.*)$", result.stderr, re.M)
    for function in reached:
        assert any(f"partwheel::{function}" in name for name in ran), f"{function}) was not reached"
    for function in not_reached:
        assert not any(f"partwheel::{function}" in covered for covered in ran), f"{function}) was reached"


def test_only_the_fuzzer_accepts_forged_hierarchies(corpora, tmp_path):
    """The last bytes are a hash, which the library of the fuzzer does not compare, unlike the released one."""
    for path in (corpora / "saved" / "learned").iterdir():
        forged = bytearray(path.read_bytes())
        forged[-1] ^= 0xFF
        (tmp_path / path.name).write_bytes(forged)
        with pytest.raises(PartwheelError, match="damaged"):
            Hierarchy.load(bytes(forged))
    # The search for leaks would run an input again.
    result = run("saved", tmp_path, "-runs=0", "-detect_leaks=0", PARTWHEEL_FUZZ_REPORT="1")
    assert result.stderr.count("input: loaded\n") == len(list(tmp_path.iterdir())), result.stderr[-3000:]


@pytest.mark.parametrize("name", MAX_BYTES)
def test_the_fuzzer_finds_no_new_defect(name, corpora):
    corpus = WORK / name
    corpus.mkdir(parents=True, exist_ok=True)
    n_seeds = sum(path.is_file() for directory in (corpus, corpora / name) for path in directory.rglob("*"))
    amount = f"-max_total_time={SECONDS}" if SECONDS else f"-runs={n_seeds + INPUTS}"
    result = run(name, corpus, corpora / name, amount, f"-max_len={MAX_BYTES[name]}", "-print_final_stats=1")
    (WORK / f"{name}.log").write_text(result.stdout + result.stderr)
    assert result.returncode == 0, result.stdout[-3000:] + result.stderr[-6000:]
    executed = int(re.search(r"number_of_executed_units:\s*(\d+)", result.stderr).group(1))
    assert executed >= n_seeds + INPUTS, "too slow to find anything"
