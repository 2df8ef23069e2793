# SPDX-License-Identifier: GPL-3.0-or-later
"""Marks: edges at which something besides the shape divides a surface, such as material borders and seams."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Optional

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


class Marks(NamedTuple):
    """Marked edges of one kind.

    Attributes
    ----------
    name : of the kind, in the plural, for Hierarchy.notes: "seams"
    edges : (n, 2) vertices. Pairs that are no edge of the mesh mark nothing
    strengths : (n,) from 0 to 1; None: all are 1. 1: drawn on purpose, no part crosses the edge; below: a hint that the
        shape may overrule; below 0.5: nothing
    """

    name: str
    edges: ArrayLike
    strengths: Optional[ArrayLike] = None
