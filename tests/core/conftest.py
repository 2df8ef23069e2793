# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes partwheel importable from the checkout, or from PARTWHEEL_PACKAGES, and builds each shape of shapes.py once for
all tests.

PARTWHEEL_TEST_COMMA=1 runs all of them in a locale in which numbers have a comma, as some host programs do.
"""

import functools
import locale
import os
import signal
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
# The package that is tested: an installed one where the caller says so, else the checkout's.
PACKAGES = os.environ.get("PARTWHEEL_PACKAGES", str(ROOT / "native" / "python"))
sys.path[:0] = [PACKAGES, str(ROOT / "tests" / "faults"), str(Path(__file__).parent)]

import shapes  # noqa: E402
from partwheel import Hierarchy, Mode  # noqa: E402


def set_comma():
    """Numbers have a comma from now on in this process, as C prints and reads them. Fails where there is no locale."""
    os.environ["LOCPATH"] = str(ROOT / "build" / "deps" / "locales")  # in which setup puts it
    locale.setlocale(locale.LC_ALL, "de_DE.UTF-8")
    assert locale.localeconv()["decimal_point"] == ","


# A shell lets what it starts in its background ignore Ctrl C, which tests send.
signal.signal(signal.SIGINT, signal.default_int_handler)

if os.environ.get("PARTWHEEL_TEST_COMMA"):
    set_comma()


@pytest.fixture
def comma():
    before = locale.setlocale(locale.LC_ALL)
    set_comma()
    yield
    locale.setlocale(locale.LC_ALL, before)


@functools.cache
def built(name, mode=Mode.LEARNED):
    """(Shape, its Hierarchy)"""
    shape = shapes.SHAPES[name]()
    return shape, Hierarchy.build(*shape, mode=mode)


@pytest.fixture(params=[(name, mode) for mode in Mode for name in shapes.SHAPES],
                ids=lambda name_mode: f"{name_mode[0]}, {name_mode[1].name.lower()}")
def case(request):
    return built(*request.param)


@pytest.fixture(params=shapes.SHAPES)
def paper_case(request):
    return built(request.param, Mode.PAPER)


@pytest.fixture
def build_shape():
    return built


@pytest.fixture(scope="session")
def meshes_directory():
    """The real meshes that setup unpacks."""
    directory = ROOT / "build" / "deps" / "meshes"
    assert directory.is_dir(), f"{directory} is missing: run scripts/setup.sh first"
    return directory


@pytest.fixture
def mujoco():
    """MuJoCo, while numbers have a point: it reads them as the host program's locale has them."""
    module = pytest.importorskip("mujoco")
    before = locale.setlocale(locale.LC_NUMERIC)
    locale.setlocale(locale.LC_NUMERIC, "C")
    yield module
    locale.setlocale(locale.LC_NUMERIC, before)


# AddressSanitizer takes more memory than any limit, and answers a crash itself.
PLAIN = "asan" not in os.environ.get("LD_PRELOAD", "")
UNLIMITED = {} if PLAIN else {"memory_limit": 0}
