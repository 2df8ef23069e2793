# SPDX-License-Identifier: GPL-3.0-or-later
"""States of picking with the wheel, and the transitions by click, notch and digit. Does not import bpy."""

from __future__ import annotations

from dataclasses import dataclass, replace

from partwheel import Hierarchy


@dataclass(frozen=True)
class Preparing:
    """The data for picking is prepared in slices since this event, which is handled afterwards."""

    type: str
    value: str
    mouse_x: int
    mouse_y: int


@dataclass(frozen=True)
class WaitingForParts:
    """A build runs. Afterwards the clicked face is picked, if there is one."""

    face: int = None


@dataclass(frozen=True)
class WaitingForClick:
    """Nothing is picked yet; the next click picks."""


@dataclass(frozen=True)
class PickedPart:
    """A face is picked: the part stops[index] on its path is selected."""

    face: int  # the clicked source face
    stops: tuple  # nodes of the hierarchy from small to large; the last is the root
    start: int  # index of the start level
    index: int  # index of the current stop
    typed: str = ""  # digits of a part's number typed so far

    @property
    def node(self) -> int:
        return self.stops[self.index]

    @property
    def level(self) -> int:
        """Notches from the start level; negative below it."""
        return self.index - self.start

    @property
    def next(self) -> int:
        """The node that one more notch up takes; the current one at the end of the path."""
        return self.stops[min(self.index + 1, len(self.stops) - 1)]

    def at_stop(self, index: int, typed: str = "") -> PickedPart:
        """Return the state at another stop, clamped to both ends of the path."""
        return replace(self, index=min(max(index, 0), len(self.stops) - 1), typed=typed)

    def turn(self, notches: int) -> PickedPart:
        """Return the state after this many notches up (negative: down)."""
        return self.at_stop(self.index + notches)

    def with_digit(self, digit: str) -> PickedPart:
        """Return the state after one more digit; part 1 is the smallest. A digit too many begins a new number."""
        typed = self.typed + digit
        if len(typed) > len(str(len(self.stops))):
            typed = digit
        return self.at_stop(int(typed) - 1, typed)

    def without_digit(self) -> PickedPart:
        """Return the state after removing the last digit. The part stays if none is left."""
        typed = self.typed[:-1]
        return self.at_stop(int(typed) - 1, typed) if typed else replace(self, typed="")


def pick_face(hierarchy: Hierarchy, face: int, level: int = 0) -> PickedPart:
    """Return the state after a click on a source face, then level notches. Raises PartwheelError if there is no such
    face."""
    stops, start = hierarchy.wheel(face)
    return PickedPart(face, tuple(stops.tolist()), start, start).turn(level)
