# SPDX-License-Identifier: GPL-3.0-or-later
"""The states of the modal select tool, and how a click or a notch leads from one to the next. No bpy here."""

from dataclasses import dataclass, replace


@dataclass(frozen=True)
class Building:
    """The parts are still being found: after that this face, the one that was clicked, is picked, if there is one."""

    face: int = None


@dataclass(frozen=True)
class Waiting:
    """Nothing is picked yet: the next click picks."""


@dataclass(frozen=True)
class Picked:
    """A face is picked: the part stops[index] on its path is selected."""

    face: int  # the clicked source face
    stops: tuple  # nodes of the hierarchy, growing; the last is the whole
    start: int  # index of the stop that the click alone takes
    index: int  # index of the stop now selected

    @property
    def node(self):
        return self.stops[self.index]

    @property
    def level(self):
        """Notches from the start; negative below it."""
        return self.index - self.start

    def turned(self, notches):
        """The state after this many notches up (negative: down), held at both ends of the path."""
        return replace(self, index=min(max(self.index + notches, 0), len(self.stops) - 1))


def pick(hierarchy, face, level=0):
    """The state after a click on a source face and then level notches. Raises PartwheelError for no such face."""
    stops, start = hierarchy.wheel(face)
    return Picked(face, tuple(stops.tolist()), start, start).turned(level)
