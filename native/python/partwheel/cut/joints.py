# SPDX-License-Identifier: GPL-3.0-or-later
"""What joins two printed pieces at a planar cut: pegs and sockets, or holes for dowels or magnets; and the number of the cut,
engraved into both sides. With manifold3d. Lengths are in millimeters."""

from __future__ import annotations

from typing import Any, Dict, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from .flat_cuts import KERF, FlatCutter, Plane, fits_bed

CLEARANCES = {"pla": 0.2, "petg": 0.3, "resin": 0.1}  # mm, by the material that is printed
PEG_SIDES = 6  # a prism, so that it can't turn
PEG_RADIUS_FRACTION = 0.5  # of the radius of the largest circle in the cut
MIN_PEG_RADIUS = 0.8  # mm
SHRINK = 0.8  # from one size that is tried to the next
PEG_LENGTHS = 2.0, 1.5, 1.0, 0.7  # in radii of the peg; the first that fits is used
PEG_ROOT_DEPTH = 0.25  # in radii of the peg: how far it reaches into its own part
PEG_RATIO = np.cos(np.pi / PEG_SIDES)  # inner radius / outer radius of the peg's prism
MIN_PEG_DISTANCE = 4.0  # in radii of the peg, between the centers of two pegs in a wide cut
CYLINDER_SIDES = 48
CYLINDER_RATIO = np.cos(np.pi / CYLINDER_SIDES)  # inner radius / outer radius of the prism that stands for a cylinder
SECTION_HEIGHT = 1e-3  # mm from a cut, where its two sides are measured
RELATIVE_TOLERANCE = 1e-6  # volumes below this fraction are rounding errors
# Numbers, of digits with seven segments, above a line that tells 6 from 9
MIN_DIGIT_HEIGHT, MAX_DIGIT_HEIGHT = 3.0, 8.0  # mm; smaller ones can't be read
DIGIT_WIDTH, DIGIT_PITCH, STROKE = 0.6, 0.8, 0.16  # in heights
LINE_HEIGHT = 2 * STROKE  # in heights of a digit
ENGRAVING_DEPTH = 0.6  # mm
ENGRAVING_MARGIN = 0.4  # mm, from the edge of the cut and from sockets, and below
SEGMENTS = (0b1110111, 0b0100100, 0b1011101, 0b1101101, 0b0101110, 0b1101011, 0b1111011, 0b0100101, 0b1111111,
            0b1101111)  # of each digit; bits: top, upper left, upper right, middle, lower left, lower right, bottom


class Insert(NamedTuple):
    """A cylinder that the user has, such as a dowel, a piece of filament or a magnet.

    diameter
    depth : how deep it sits in each of the two pieces: half the length of a dowel; the height of a magnet, one in each
    """

    diameter: float
    depth: float


class Peg(NamedTuple):
    """A peg of one piece in a socket of another, which leaves a gap on all sides except at the cut; or the place of an Insert,
    for which both have holes.

    part : the piece with the peg
    into : the piece with the socket
    center : (3,) on the cut
    direction : (3,) unit, into the other piece
    radius : to the corners
    length : from the cut
    """

    part: int
    into: int
    center: np.ndarray
    direction: np.ndarray
    radius: float
    length: float


class Joint:
    """The planar cut between two pieces; its normal points from the first one into the other."""

    def __init__(self, cutter: FlatCutter, plane: Plane, part: int, other: int, wall: float, bed: Optional[Sequence[float]]) -> None:
        """wall : least thickness around sockets; bed : (3,) that a piece with its peg must fit, or None"""
        self.cutter, self.plane, self.part, self.other = cutter, plane, part, other
        self.wall, self.bed = wall, bed
        self.occupied: List[Any] = []  # CrossSections of sockets

    def add_pegs(self, bodies: Dict[int, Any], clearance: float, insert: Optional[Insert] = None) -> List[Peg]:
        """Add one peg or, in a wide cut, two to the first piece, and cut their sockets into the other; or cut the holes for an
        Insert into both. [] if none fits."""
        region = self._region(bodies)
        if region.area() < np.pi * MIN_PEG_RADIUS ** 2:
            return []
        center, free_radius = _largest_circle(region)
        gap = clearance if insert else clearance / PEG_RATIO  # between the circles around peg and socket
        if insert:
            radius = min_radius = insert.diameter / 2
        else:
            radius = min(PEG_RADIUS_FRACTION * free_radius, CYLINDER_RATIO * free_radius - gap - self.wall)
            min_radius = MIN_PEG_RADIUS

        def add(place: np.ndarray) -> Optional[Peg]:
            return (self._add_holes(bodies, place, clearance, insert) if insert else
                    self._add_peg(bodies, place, radius, clearance))

        while radius >= min_radius:
            outer_radius = 1.01 * (radius + gap + self.wall) / CYLINDER_RATIO
            pair = _farthest_pair(region.offset(-outer_radius))
            pegs: List[Peg] = []
            if np.linalg.norm(pair[1] - pair[0]) > max(MIN_PEG_DISTANCE * radius, 2 * (radius + gap) + self.wall):
                pegs = [peg for end in pair if (peg := add(end))]
            pegs = pegs or [peg for peg in [add(center)] if peg]
            if pegs:
                circle = self.cutter.manifold.CrossSection.circle(radius + gap, CYLINDER_SIDES)
                self.occupied += [circle.translate(tuple(self.plane.to_local(peg.center[None])[0, :2])) for peg in pegs]
                return pegs
            radius *= SHRINK
        return []

    def engrave(self, bodies: Dict[int, Any], number: int) -> bool:
        """Engrave a number into both sides of the cut, readable from outside; return whether there is room for it."""
        free = self._region(bodies)
        for peg in self.occupied:
            free -= peg
        center, radius = _largest_circle(free)
        section = self.cutter.manifold.CrossSection
        text, size = _number(section, number)
        sides = (self.part, False), (self.other, True)
        height = min(MAX_DIGIT_HEIGHT, 2 * (radius - ENGRAVING_MARGIN) / np.hypot(*size))
        while height >= MIN_DIGIT_HEIGHT:
            box = section.square(tuple(height * size), center=True)
            around = [(piece, self._prism(box, center, -ENGRAVING_DEPTH - ENGRAVING_MARGIN, -KERF, mirrored))
                      for piece, mirrored in sides]
            if all(_is_inside(below, bodies[piece]) for piece, below in around):
                for piece, mirrored in sides:
                    bodies[piece] -= self._prism(text.scale((height, height)), center, -ENGRAVING_DEPTH, SECTION_HEIGHT, mirrored)
                return True
            height *= SHRINK
        return False

    def _region(self, bodies: Dict[int, Any]) -> Any:
        """The CrossSection where the two pieces meet."""
        return self.plane.section(bodies[self.part], -SECTION_HEIGHT) ^ self.plane.section(bodies[self.other], SECTION_HEIGHT)

    def _prism(self, section: Any, center: np.ndarray, bottom: float, top: float, mirrored: bool = False) -> Any:
        """A CrossSection around a center (2,) in the plane's frame as a tool between two heights. mirrored : as seen from the
        other side, with heights below the other piece's side of the cut"""
        if mirrored:
            section, bottom, top = section.mirror((1, 0)), -top, -bottom
        solid = self.cutter.manifold.Manifold.extrude(section, top - bottom).translate((*center, bottom))
        return self.cutter.make_tool(self.plane.to_model(solid))

    def _column(self, center: np.ndarray, bottom: float, top: float, radius: float, sides: int = CYLINDER_SIDES) -> Any:
        return self._prism(self.cutter.manifold.CrossSection.circle(radius, sides), center, bottom, top)

    def _add_holes(self, bodies: Dict[int, Any], center: np.ndarray, clearance: float, insert: Insert) -> Optional[Peg]:
        """Cut holes for an Insert at a place (2,) in the plane's frame; None if they don't fit."""
        radius, depth = insert.diameter / 2 + clearance, insert.depth + clearance
        outer = (radius + self.wall) / CYLINDER_RATIO
        walls = {self.part: self._column(center, -depth - self.wall, -KERF, outer),
                 self.other: self._column(center, KERF, depth + self.wall, outer)}
        if not all(_is_inside(wall, bodies[piece]) for piece, wall in walls.items()):
            return None
        hole = self._column(center, -depth, depth, radius / CYLINDER_RATIO)
        for piece in walls:
            bodies[piece] -= hole
        return self._peg(center, insert.diameter / 2, insert.depth)

    def _add_peg(self, bodies: Dict[int, Any], center: np.ndarray, radius: float, clearance: float) -> Optional[Peg]:
        """Add a peg at a place (2,) in the plane's frame; None if it does not fit."""
        one, other = bodies[self.part], bodies[self.other]
        socket_radius = radius + clearance / PEG_RATIO
        for length in (radius * relative for relative in PEG_LENGTHS):
            socket_wall = self._column(center, KERF, length + clearance + self.wall, (socket_radius + self.wall) / CYLINDER_RATIO)
            root = self._column(center, -PEG_ROOT_DEPTH * radius, -KERF, radius, PEG_SIDES)
            if not (_is_inside(socket_wall, other) and _is_inside(root, one)):
                continue
            with_peg = one + self._column(center, -PEG_ROOT_DEPTH * radius, length, radius, PEG_SIDES)
            if self.bed is not None and not fits_bed(np.asarray(with_peg.to_mesh64().vert_properties), np.sort(self.bed)):
                continue
            bodies[self.part] = with_peg
            bodies[self.other] = other - self._column(center, -SECTION_HEIGHT, length + clearance, socket_radius, PEG_SIDES)
            return self._peg(center, radius, length)
        return None

    def _peg(self, center: np.ndarray, radius: float, length: float) -> Peg:
        place = self.plane.center + self.plane.axes.T @ (*center, 0)
        return Peg(self.part, self.other, place, self.plane.axes[2], radius, length)


def _is_inside(tool: Any, body: Any) -> bool:
    """Whether a tool lies in a body, but for rounding errors."""
    return bool((tool - body).volume() <= RELATIVE_TOLERANCE * tool.volume())


def _number(section: Any, number: int) -> Tuple[Any, np.ndarray]:
    """(CrossSection of a number with digits of height 1, around the origin, its size (2,))"""
    digits = [int(digit) for digit in str(number)]
    size = np.array([DIGIT_PITCH * (len(digits) - 1) + DIGIT_WIDTH, 1 + LINE_HEIGHT])
    horizontal, vertical = section.square((DIGIT_WIDTH, STROKE)), section.square((STROKE, 0.5 + STROKE / 2))
    right, middle = DIGIT_WIDTH - STROKE, 0.5 - STROKE / 2
    segments = (horizontal.translate((0, 1 - STROKE)), vertical.translate((0, middle)), vertical.translate((right, middle)),
                horizontal.translate((0, middle)), vertical, vertical.translate((right, 0)), horizontal)
    shapes = [segment.translate((DIGIT_PITCH * k, LINE_HEIGHT)) for k, digit in enumerate(digits)
              for bit, segment in enumerate(segments) if SEGMENTS[digit] >> bit & 1]
    return section.compose([section.square((size[0], STROKE)), *shapes]).translate(tuple(-size / 2)), size


def _farthest_pair(section: Any) -> Tuple[np.ndarray, np.ndarray]:
    """The two corners of a CrossSection that are farthest apart; twice the same if it is empty."""
    contours = section.to_polygons()
    if not contours:
        return np.zeros(2), np.zeros(2)
    corners = np.vstack(contours)
    first = corners[np.linalg.norm(corners - corners.mean(axis=0), axis=1).argmax()]
    return first, corners[np.linalg.norm(corners - first, axis=1).argmax()]


def _largest_circle(section: Any) -> Tuple[np.ndarray, float]:
    """(center (2,), radius) of the largest circle in a CrossSection, by bisection on its inward offset."""
    if section.is_empty():
        return np.zeros(2), 0.0
    low, high = 0.0, float(np.ptp(np.reshape(section.bounds(), (2, 2)), axis=0).min()) / 2 + 1e-9
    inner = section
    while high - low > 1e-3 * high:
        middle = (low + high) / 2
        smaller = section.offset(-middle)
        if smaller.is_empty():
            high = middle
        else:
            low, inner = middle, smaller
    contour = max(inner.to_polygons(), key=len)
    return np.asarray(contour).mean(axis=0), low
