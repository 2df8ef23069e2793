# SPDX-License-Identifier: GPL-3.0-or-later
"""The states while a cut is edited, and the transitions by click, notch, drag and digit. Without bpy."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

from partwheel.cut import Cut

MAX_DIGITS = 3  # most digits of a typed number of parts


@dataclass(frozen=True)
class CutState:
    """A cut, some notches away from a base cut. The notches change the part with the clicked face, or else the number
    of parts. So turning the wheel back restores the earlier cuts.

    own_parts: the clusters of parts that earlier clicks and drags made (see Cut.parts), whether or not the cut still has them.
    """

    base: Cut
    face: int | None = None  # the clicked face, if any
    level: int = 0
    typed: str = ""  # the digits typed so far, of the number of parts
    own_parts: frozenset[tuple[int, ...]] = frozenset()

    @cached_property
    def cut(self) -> Cut:
        if self.face is None:
            return self.base.resize(len(self.base) + self.level)
        cut = self.base
        for _ in range(abs(self.level)):
            part = int(cut.labels[self.face])
            cut = cut.join(part) if self.level > 0 else cut.split(part)
        return cut

    @property
    def part(self) -> int | None:
        return None if self.face is None else int(self.cut.labels[self.face])

    @property
    def own_parts_so_far(self) -> frozenset[tuple[int, ...]]:
        """own_parts, and those that the notches have made of the part with the clicked face."""
        return self.own_parts if self.face is None else self.own_parts | (set(self.cut.parts) - set(self.base.parts))

    def turn(self, notches: int) -> CutState:
        """The state after notches: up for a larger part, or more parts. The same state at the ends of the range."""
        state = replace(self, level=self.level + notches, typed="")
        return self if state.cut == self.cut else state

    def click(self, face: int | None) -> CutState:
        """The state after a click on this face: its part is active; none if it was active before, or face is None."""
        is_deselected = face is None or self.part == self.cut.labels[face]
        return CutState(self.cut, None if is_deselected else face, own_parts=self.own_parts_so_far)

    def merge(self, first: int, second: int) -> CutState:
        labels = self.cut.labels
        merged = self.cut.merge(int(labels[first]), int(labels[second]))
        return CutState(merged, own_parts=self.own_parts_so_far | (set(merged.parts) - set(self.cut.parts)))

    def with_digit(self, digit: str) -> CutState:
        """The state after one more digit of the number of parts. A digit too many begins a new number."""
        base = self.base if self.face is None else self.cut
        typed = digit if len(self.typed) == MAX_DIGITS else self.typed + digit
        return CutState(base, None, max(int(typed), 1) - len(base), typed, self.own_parts_so_far)

    def without_digit(self) -> CutState:
        """The state after the last digit is erased; the parts stay when no digit is left."""
        typed = self.typed[:-1]
        return replace(self, level=int(typed) - len(self.base) if typed else self.level, typed=typed)
