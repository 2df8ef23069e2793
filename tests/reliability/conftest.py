# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes partwheel importable from the checkout, and the models that are not there yet."""

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "native" / "python"), str(Path(__file__).parent)]


def pytest_configure(config):
    """Before the processes that share the tests ask for the models, for they would all make them, in one place."""
    if not hasattr(config, "workerinput"):
        import models

        models.primitives()
        models.benchmark()
