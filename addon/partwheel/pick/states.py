# SPDX-License-Identifier: GPL-3.0-or-later
"""States of picking with the wheel, and the transitions by click, notch and digit. Does not import bpy."""

from __future__ import annotations

from dataclasses import dataclass, replace

from partwheel import Hierarchy


@dataclass(frozen=True)
class Preparing:
    """The data for picking is being prepared, in slices. The event that started this is handled at the end."""

    type: str
    value: str
    mouse_x: int
    mouse_y: int


@dataclass(frozen=True)
class WaitingForClick:
    """Nothing is picked yet; the next click picks."""


@dataclass(frozen=True)
class PickedPart:
    """A face is picked: the part stops[index] on its path is selected, or above the root a group of whole objects."""

    face: int  # the clicked source face
    stops: tuple  # nodes of the hierarchy from small to large; the last is the root
    start: int  # index of the start level, which a click selects when the view is not known
    index: int  # index of the current stop; those after stops are groups
    typed: str = ""  # digits of a part's number typed so far
    groups: tuple | None = None  # full names of the objects of each group, from small to large; None: not known yet

    @property
    def node(self) -> int:
        """The node of the clicked object; the root in a group."""
        return self.stops[min(self.index, len(self.stops) - 1)]

    @property
    def group(self) -> frozenset:
        """The full names of the selected objects; empty below the groups."""
        return self.groups[self.index - len(self.stops)] if self.index >= len(self.stops) else frozenset()

    @property
    def next_group(self) -> frozenset:
        """The group after one more notch up."""
        return self.turn(1).group

    @property
    def count(self) -> int:
        """The number of stops, as far as they are known."""
        return len(self.stops) + len(self.groups or ())

    @property
    def needs_groups(self) -> bool:
        """Whether the next notch up needs with_groups() first."""
        return self.groups is None and self.index == len(self.stops) - 1

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
        return replace(self, index=min(max(index, 0), self.count - 1), typed=typed)

    def with_groups(self, groups: tuple) -> PickedPart:
        """Return the state with these groups above the root, at the stop that has been typed."""
        state = replace(self, groups=groups)
        return state.at_stop(int(self.typed) - 1, self.typed) if self.typed else state

    def turn(self, notches: int) -> PickedPart:
        """Return the state after this many notches up (negative: down)."""
        return self.at_stop(self.index + notches)

    def with_digit(self, digit: str) -> PickedPart:
        """Return the state after one more digit; part 1 is the smallest. A digit too many begins a new number."""
        typed = self.typed + digit
        if len(typed) > len(str(self.count)):
            typed = digit
        return self.at_stop(int(typed) - 1, typed)

    def without_digit(self) -> PickedPart:
        """Return the state after removing the last digit. The part stays if none is left."""
        typed = self.typed[:-1]
        return self.at_stop(int(typed) - 1, typed) if typed else replace(self, typed="")


def pick_face(hierarchy: Hierarchy, face: int, level: int = 0, view: float = 0.0) -> PickedPart:
    """Return the state after a click on a source face in a view of this size (see Hierarchy.wheel), then level notches.
    Raises PartwheelError if there is no such face."""
    stops, start = hierarchy.wheel(face)
    index = hierarchy.wheel(face, view)[1] if view else start
    return PickedPart(face, tuple(stops.tolist()), start, index).turn(level)
