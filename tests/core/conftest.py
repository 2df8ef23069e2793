# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes partwheel.core importable from the checkout, and builds each shape of shapes.py once for all tests."""

import functools
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "addon"), str(ROOT / "tests" / "faults"), str(Path(__file__).parent)]

import shapes  # noqa: E402
from partwheel.core import Hierarchy  # noqa: E402


@functools.cache
def built(name):
    """(Shape, its Hierarchy)"""
    shape = shapes.SHAPES[name]()
    return shape, Hierarchy.build(*shape)


@pytest.fixture(params=shapes.SHAPES)
def case(request):
    return built(request.param)


@pytest.fixture
def build_shape():
    return built


@pytest.fixture(scope="session")
def meshes_directory():
    """The real meshes that setup unpacks."""
    directory = ROOT / "build" / "deps" / "meshes"
    assert directory.is_dir(), f"{directory} is missing: run scripts/setup.sh first"
    return directory
