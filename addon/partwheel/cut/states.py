# SPDX-License-Identifier: GPL-3.0-or-later
"""The states while a cut is edited, and how a click, a notch, a drag or a digit leads on. No bpy here."""

from dataclasses import dataclass, replace
from functools import cached_property

from partwheel.cut import Cut

DIGITS = 3


@dataclass(frozen=True)
class Cutting:
    """A cut, some notches away from another one: those of the part with a face that was clicked, or else of the number
    of parts. So the wheel comes back by the way that it went."""

    base: Cut
    face: int = None  # the one that was clicked, if any
    level: int = 0
    typed: str = ""  # the digits of the number of parts, as far as they have been typed

    @cached_property
    def cut(self):
        if self.face is None:
            return self.base.resize(len(self.base) + self.level)
        cut = self.base
        for _ in range(abs(self.level)):
            part = int(cut.labels[self.face])
            cut = cut.join(part) if self.level > 0 else cut.split(part)
        return cut

    @property
    def part(self):
        """The part that was clicked, or None."""
        return None if self.face is None else int(self.cut.labels[self.face])

    def turned(self, notches):
        """After this many notches: up for a larger part, or for more of them. As it is where there are no others."""
        after = replace(self, level=self.level + notches, typed="")
        return self if after.cut == self.cut else after

    def clicked(self, face):
        """On the part with this face from now on; on none if it is the same part again, or face is None."""
        again = face is None or self.part == self.cut.labels[face]
        return Cutting(self.cut, None if again else face)

    def merged(self, one, other):
        """The parts of two faces as one."""
        labels = self.cut.labels
        return Cutting(self.cut.merge(int(labels[one]), int(labels[other])))

    def with_digit(self, digit):
        """So many parts. A digit too many begins a new number."""
        base = self.base if self.face is None else self.cut
        typed = digit if len(self.typed) == DIGITS else self.typed + digit
        return Cutting(base, None, max(int(typed), 1) - len(base), typed)

    def without_digit(self):
        """After the last digit was taken back; the parts stay when none is left."""
        typed = self.typed[:-1]
        return Cutting(self.base, None, int(typed) - len(self.base), typed) if typed else replace(self, typed="")
