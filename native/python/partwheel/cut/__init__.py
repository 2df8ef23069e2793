# SPDX-License-Identifier: GPL-3.0-or-later
"""The whole model in parts: a cut that can be edited, the parts' borders, seams and names, files of them."""

from .bones import Bone, bones
from .borders import Border, Link, borders, links, tree, weights
from .colors import colors
from .cut import Cut, CutError, CutPart
from .names import mirror_planes, named
from .seams import further, laid_flat, seams

__all__ = ["Bone", "Border", "Cut", "CutError", "CutPart", "Link", "bones", "borders", "colors", "further", "laid_flat", "links", "mirror_planes",
           "named", "seams", "tree", "weights"]
