# SPDX-License-Identifier: GPL-3.0-or-later
"""Similar parts of a model, and parts that are mirror images of each other."""

from .mirrored import MirrorImage, mirrored_parts
from .similar import THRESHOLD, NodeMeasures, best_node, measure_nodes, similar_parts

__all__ = ["THRESHOLD", "MirrorImage", "NodeMeasures", "best_node", "measure_nodes", "mirrored_parts", "similar_parts"]
