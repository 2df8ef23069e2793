# SPDX-License-Identifier: GPL-3.0-or-later
"""The states of the modal select tool, and how a click, a notch or a digit leads from one to the next. No bpy here."""

from __future__ import annotations

from dataclasses import dataclass, replace

from partwheel import Hierarchy


@dataclass(frozen=True)
class Preparing:
    """What is needed is being made, slice by slice, since this event: what of it is asked for then, as it was."""

    type: str
    value: str
    mouse_x: int
    mouse_y: int


@dataclass(frozen=True)
class WaitingForParts:
    """The parts are still being found: after that this face, the one that was clicked, is picked, if there is one."""

    face: int = None


@dataclass(frozen=True)
class WaitingForClick:
    """Nothing is picked yet: the next click picks."""


@dataclass(frozen=True)
class PickedPart:
    """A face is picked: the part stops[index] on its path is selected."""

    face: int  # the clicked source face
    stops: tuple  # nodes of the hierarchy, growing; the last is the whole
    start: int  # index of the stop that the click alone takes
    index: int  # index of the stop now selected
    typed: str = ""  # the digits of a part's number, as far as they have been typed

    @property
    def node(self) -> int:
        return self.stops[self.index]

    @property
    def level(self) -> int:
        """Notches from the start; negative below it."""
        return self.index - self.start

    @property
    def next(self) -> int:
        """The node that one more notch up takes; the same at the end of the path."""
        return self.stops[min(self.index + 1, len(self.stops) - 1)]

    def at_stop(self, index: int, typed: str = "") -> PickedPart:
        """The state at another stop, held at both ends of the path."""
        return replace(self, index=min(max(index, 0), len(self.stops) - 1), typed=typed)

    def turn(self, notches: int) -> PickedPart:
        """The state after this many notches up (negative: down)."""
        return self.at_stop(self.index + notches)

    def with_digit(self, digit: str) -> PickedPart:
        """The state after one more digit: part 1 is the smallest. A digit too many begins a new number."""
        typed = self.typed + digit
        if len(typed) > len(str(len(self.stops))):
            typed = digit
        return self.at_stop(int(typed) - 1, typed)

    def without_digit(self) -> PickedPart:
        """The state after the last digit was taken back; the part stays when none is left."""
        typed = self.typed[:-1]
        return self.at_stop(int(typed) - 1, typed) if typed else replace(self, typed="")


def pick_face(hierarchy: Hierarchy, face: int, level: int = 0) -> PickedPart:
    """The state after a click on a source face and then level notches. Raises PartwheelError for no such face."""
    stops, start = hierarchy.wheel(face)
    return PickedPart(face, tuple(stops.tolist()), start, start).turn(level)
