# SPDX-License-Identifier: GPL-3.0-or-later
"""CGAL's headers are changed where results would depend on the system, or the build is not configured."""

import re
import subprocess

import pytest
from conftest import ROOT

SCRIPT = ROOT / "cmake" / "deterministic_cgal.cmake"
HEADERS = re.findall(r'"[^"]*@([\w/]+\.h)"', SCRIPT.read_text())  # those in which a change is required
CACHE = ROOT / "build" / "release" / "CMakeCache.txt"
INCLUDE = re.search(r"^CGAL_INCLUDE:PATH=(.*)$", CACHE.read_text(), re.M) if CACHE.exists() else None
pytestmark = pytest.mark.skipif(INCLUDE is None, reason="the library was not built here")


def configure(directory, **changes):
    """changes: header -> (before, after)"""
    for header in HEADERS:
        text = (ROOT.joinpath(INCLUDE[1]) / "CGAL" / header).read_text()
        before, after = changes.get(header, ("", ""))
        assert before in text
        path = directory / "from" / "CGAL" / header
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text.replace(before, after))
    return subprocess.run(["cmake", f"-DCGAL_INCLUDE={directory / 'from'}", f"-Ddeterministic_cgal={directory / 'to'}", "-P", SCRIPT],
                          capture_output=True, text=True)


def test_the_pinned_cgal_is_accepted(tmp_path):
    result = configure(tmp_path)
    assert result.returncode == 0 and len(HEADERS) == 15, result.stderr


@pytest.mark.parametrize("header, before, after", [
    ("AABB_traits.h", "std::nth_element", "std::ranges::nth_element"),
    ("Weights/internal/utils.h", "std::acos", "acos"),
    ("Polygon_mesh_processing/internal/Hole_filling/Triangulate_hole_polyline.h", "w < w_min", "w_min > w"),
])
def test_a_cgal_to_which_a_change_does_not_apply_is_refused(header, before, after, tmp_path):
    result = configure(tmp_path, **{header: (before, after)})
    message = " ".join(result.stderr.split())
    assert result.returncode != 0 and f"CGAL/{header} can't be changed" in message and "results would depend on the system" in message
