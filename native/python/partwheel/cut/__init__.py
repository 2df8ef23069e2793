# SPDX-License-Identifier: GPL-3.0-or-later
"""The whole model in parts: a cut that can be edited, the parts' borders, seams and names, files of them."""

from .borders import Border, Link, borders, links, weights
from .colors import colors
from .cut import Cut
from .names import mirror_planes, named
from .seams import seams

__all__ = ["Border", "Cut", "Link", "borders", "colors", "links", "mirror_planes", "named", "seams", "weights"]
