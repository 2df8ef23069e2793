# SPDX-License-Identifier: GPL-3.0-or-later
"""The model divided into parts: a cut that can be edited; borders, bones, seams, names and files of its parts."""

from .bones import Bone, bones
from .borders import ParentLink, PartBorder, VertexWeights, link_parts, part_borders, part_tree, skin_weights
from .colors import colors
from .cut import Cut, CutError, CutPart
from .names import mirror_planes, name_parts, reflect
from .seams import refine_seams, seams

__all__ = ["Bone", "Cut", "CutError", "CutPart", "ParentLink", "PartBorder", "VertexWeights", "bones", "colors",
           "link_parts", "mirror_planes", "name_parts", "part_borders", "part_tree", "refine_seams", "reflect",
           "seams", "skin_weights"]
