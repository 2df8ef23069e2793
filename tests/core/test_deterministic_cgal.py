# SPDX-License-Identifier: GPL-3.0-or-later
"""CGAL's headers are changed where results would depend on the system, or the build is not configured."""

import subprocess

import pytest
from conftest import ROOT

HEADERS = ROOT / "build" / "deps" / "root" / "usr" / "include" / "CGAL"
CHANGED = {
    "Hilbert_sort_base.h": "std::nth_element",
    "Kernel/function_objects.h": "std::atan2",
    "Polygon_mesh_processing/border.h": "std::unordered_set",
    "Polygon_mesh_processing/internal/Hole_filling/Triangulate_hole_polyline.h": "if(m_min == -1 || w < w_min){",
}


def configured(include, build):
    return subprocess.run(["cmake", f"-DCGAL_INCLUDE={include}", f"-Dsteady_cgal={build}", "-P", ROOT / "cmake" / "steady_cgal.cmake"],
                          capture_output=True, text=True)


@pytest.fixture(scope="module")
def include(tmp_path_factory):
    """A copy of the headers that are expected to change."""
    directory = tmp_path_factory.mktemp("cgal")
    for line in (ROOT / "cmake" / "steady_cgal.cmake").read_text().split("set(expected")[1].split(")\n")[0].splitlines():
        if "@" in line:
            name = line.split("@")[1].rstrip('")')
            path = directory / "CGAL" / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text((HEADERS / name).read_text())
    return directory


def test_changes_take_effect(include, tmp_path):
    stale = tmp_path / "CGAL" / "of_another_version.h"
    stale.parent.mkdir()
    stale.touch()
    result = configured(include, tmp_path)
    assert result.returncode == 0, result.stderr
    for name, text in CHANGED.items():
        assert text in (include / "CGAL" / name).read_text()
        assert text not in (tmp_path / "CGAL" / name).read_text()
    assert not stale.exists()


@pytest.mark.parametrize("name", CHANGED)
def test_a_cgal_without_the_place_is_refused(name, include, tmp_path):
    path = include / "CGAL" / name
    text = path.read_text()
    path.write_text(text.replace(CHANGED[name], "other"))
    try:
        result = configured(include, tmp_path)
    finally:
        path.write_text(text)
    assert result.returncode != 0
    words = " ".join(result.stderr.split())
    assert f"CGAL/{name}" in words and "Use CGAL 5.5" in words
