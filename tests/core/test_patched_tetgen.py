# SPDX-License-Identifier: GPL-3.0-or-later
"""TetGen's source is patched, and its calls of functions that differ between systems are replaced, or the build is not
configured."""

import subprocess

import pytest
from conftest import ROOT

SOURCES = sorted((ROOT / "build" / "deps").glob("tetgen-*/src/tetgen.cxx"))
pytestmark = pytest.mark.skipif(not SOURCES, reason="the pinned TetGen is not there")


def configured(directory, text, predicates=None):
    (directory / "tetgen.cxx").write_text(text, encoding="latin-1")
    source = SOURCES[-1].with_name("predicates.cxx").read_text(encoding="latin-1")
    (directory / "predicates.cxx").write_text(predicates or source, encoding="latin-1")
    return subprocess.run(["cmake", f"-Dtetgen_include={directory}", "-P", ROOT / "cmake" / "patched_tetgen.cmake"],
                          capture_output=True, text=True)


def test_the_pinned_tetgen_is_accepted(tmp_path):
    result = configured(tmp_path, SOURCES[-1].read_text(encoding="latin-1"))
    assert result.returncode == 0, result.stderr


@pytest.mark.parametrize("before, after, message", [
    ("theta = acos(", "theta = atan2(1, ", "calls atan2: results would depend on the system"),
    (" log(", " logarithm(", "does not call log"),
    ("memorypool::alloc()", "memorypool::take()", "so a cancellation could not interrupt it"),
    ("inittables();", "init_tables();", "could not run in several threads"),
    ("// Search the edge torg->tdest.", "", "the time for a fan would be quadratic"),
])
def test_another_tetgen_is_refused(before, after, message, tmp_path):
    text = SOURCES[-1].read_text(encoding="latin-1")
    assert before in text
    result = configured(tmp_path, text.replace(before, after))
    assert result.returncode != 0
    assert message in " ".join(result.stderr.split())
