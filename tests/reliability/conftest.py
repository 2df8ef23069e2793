# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes partwheel importable from the checkout."""

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "native" / "python"), str(Path(__file__).parent)]
