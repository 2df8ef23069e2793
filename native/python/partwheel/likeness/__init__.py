# SPDX-License-Identifier: GPL-3.0-or-later
"""Similar parts of a model, and parts that are mirror images of each other."""

from .mirrored import MirrorImage, mirrored_parts
from .own_parts import MAX_OWN_PARTS, are_nested, extend_own_parts, with_own_parts
from .similar import THRESHOLD, NodeMeasures, best_node, measure_nodes, similar_parts

__all__ = ["MAX_OWN_PARTS", "THRESHOLD", "MirrorImage", "NodeMeasures", "are_nested", "best_node", "extend_own_parts",
           "measure_nodes", "mirrored_parts", "similar_parts", "with_own_parts"]
