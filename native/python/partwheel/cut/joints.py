# SPDX-License-Identifier: GPL-3.0-or-later
"""What joins two printed pieces at a planar cut: pegs, snap pins or dovetails and their sockets, or holes for dowels or
magnets; and the number of the cut, engraved into both sides. With manifold3d. Lengths are in millimeters."""

from typing import Any, Dict, Iterator, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from .flat_cuts import KERF, FlatCutter, Plane, fits_bed, read_body

CLEARANCES = {"pla": 0.2, "petg": 0.3, "resin": 0.1}  # mm, by the material that is printed
KINDS = "peg", "snap pin", "dovetail"
PEG_CORNERS = np.radians([60, 120, 180, 240, 300])  # a hexagon without a corner, so that it can't turn and fits one way only
PEG_RATIO = np.sin(PEG_CORNERS[0])  # inner radius / outer radius
PEG_RADIUS_FRACTION = 0.5  # of the radius of the largest circle in the cut
MIN_PEG_RADIUS = 0.8  # mm
SLACK = 1.002  # factor by which the space checked around a peg is larger than needed
SHRINK = 0.8  # ratio of the sizes of two pegs that are tried one after the other
PEG_LENGTHS = 2.0, 1.5, 1.0, 0.7  # in radii of the peg; the first that fits is used
PEG_ROOT_DEPTH = 0.25  # in radii of the peg: how far it reaches into its own part
MIN_PEG_DISTANCE = 4.0  # in radii of the peg, between the centers of two pegs in a wide cut
MIN_PEG_STRETCH = 1.0  # in radii of the peg: a single peg is stretched where the cut is longer than wide by this much
CYLINDER_SIDES = 48
CYLINDER_RATIO = np.cos(np.pi / CYLINDER_SIDES)  # inner radius / outer radius of the prism that stands for a cylinder
SECTION_HEIGHT = 1e-3  # mm from a cut, where its two sides are measured
RELATIVE_TOLERANCE = 1e-6  # volumes below this fraction are rounding errors
# Snap pins: two halves with bumps on their outer sides, which bend as they pass the socket's mouth
SNAP_STRAIN = 0.02  # that PLA and resin withstand
SNAP_HEIGHT = 0.7  # of the bumps, in lengths of the pin
MIN_CATCH, MAX_CATCH = 0.1, 0.5  # mm that each half must bend
# Dovetails
FLARE = 0.35  # growth of half of the width per depth
DOVETAIL_DEPTH = 1.0  # in halves of its narrowest width
DOVETAIL_LENGTHS = 0.8, 0.5, 0.2  # beyond the middle of the cut, in radii of the largest circle in it
SLIDES = 0.02, 0.1, 0.25, 0.5, 0.75, 1.0  # of the dovetail's length, where the pieces must not touch
MAX_EDGE_AREA = 1.25  # of the thin area next to a dovetail's open end, in squares of the wall: two edges of 30 degrees
# Numbers, of digits with seven segments, above a line that distinguishes 6 from 9
MIN_DIGIT_HEIGHT, MAX_DIGIT_HEIGHT = 3.0, 8.0  # mm; smaller ones can't be read
DIGIT_WIDTH, DIGIT_PITCH, STROKE = 0.6, 0.8, 0.16  # in heights
LINE_HEIGHT = 2 * STROKE  # in heights of a digit
ENGRAVING_DEPTH = 0.6  # mm
ENGRAVING_MARGIN = 0.4  # mm, from the edge of the cut and from sockets, and below
SEGMENTS = (0b1110111, 0b0100100, 0b1011101, 0b1101101, 0b0101110, 0b1101011, 0b1111011, 0b0100101, 0b1111111,
            0b1101111)  # of each digit; bits: top, upper left, upper right, middle, lower left, lower right, bottom


class Insert(NamedTuple):
    """A cylinder that the user has, such as a dowel, a piece of filament or a magnet."""

    diameter: float
    depth: float  # in each of the two pieces: half the length of a dowel; the height of a magnet, one in each


class Peg(NamedTuple):
    """A peg, snap pin or dovetail of one piece in a socket of another, which leaves a gap on all sides except at the cut; or the
    place of an Insert, for which both have holes."""

    part: int  # the piece with the peg
    into: int  # the piece with the socket
    center: np.ndarray  # (3,) on the cut
    direction: np.ndarray  # (3,) unit, the way in: into the other piece; of a dovetail along the cut
    radius: float  # to the corners; of a dovetail half of its narrowest width
    length: float  # from the cut
    kind: str  # one of KINDS; "hole" for an Insert
    outline: np.ndarray  # (n, 3) corners on the cut


class CutJoint:
    """The planar cut between two pieces; its normal points from the first one into the other."""

    def __init__(self, cutter: FlatCutter, plane: Plane, part: int, other: int, free: Dict[int, Any], wall: float,
                 bed: Optional[Sequence[float]]) -> None:
        """free : of each piece, what is in no peg and no socket, for those of all joints; wall : least thickness around sockets;
        bed : (3,) that a piece with its peg must fit, or None"""
        self.cutter, self.plane, self.part, self.other = cutter, plane, part, other
        self.free, self.wall, self.bed = free, wall, bed
        self.section = cutter.manifold.CrossSection
        self.occupied: List[Any] = []  # CrossSections of sockets

    def join(self, bodies: Dict[int, Any], clearance: float, kind: str = "peg", insert: Optional[Insert] = None) -> List[Peg]:
        """Add one peg or snap pin or, in a wide cut, two to the first piece, or a dovetail, and cut their sockets into the other;
        or cut the holes for an Insert into both. [] if none fits."""
        region = self._region(self.plane, bodies)
        if region.area() < np.pi * MIN_PEG_RADIUS ** 2:
            return []
        center, free_radius = _largest_circle(region)
        if kind == "dovetail" and not insert:
            pegs = self._add_dovetail(bodies, region, center, free_radius, clearance)
        else:
            pegs = self._add_pegs(bodies, region, center, free_radius, clearance, kind, insert)
        self.occupied += [self.section([self.plane.to_local(peg.outline)[:, :2]]).offset(clearance) for peg in pegs]
        return pegs

    def engrave(self, bodies: Dict[int, Any], number: int) -> bool:
        """Engrave a number into both sides of the cut, readable from outside; return whether there is room for it."""
        free = self._region(self.plane, bodies)
        for peg in self.occupied:
            free -= peg
        center, radius = _largest_circle(free)
        text, size = _number(self.section, number)
        sides = (self.part, False), (self.other, True)
        height = min(MAX_DIGIT_HEIGHT, 2 * (radius - ENGRAVING_MARGIN) / np.hypot(*size))
        while height >= MIN_DIGIT_HEIGHT:
            box = self.section.square(tuple(height * size), center=True)
            around = [(piece, self._engraving(box, center, -ENGRAVING_DEPTH - ENGRAVING_MARGIN, -KERF, mirrored))
                      for piece, mirrored in sides]
            if all(_is_inside(below, bodies[piece]) for piece, below in around):
                scaled = text.scale((height, height))
                for piece, mirrored in sides:
                    bodies[piece] -= self._engraving(scaled, center, -ENGRAVING_DEPTH, SECTION_HEIGHT, mirrored)
                return True
            height *= SHRINK
        return False

    def _engraving(self, section: Any, center: np.ndarray, bottom: float, top: float, mirrored: bool) -> Any:
        """A CrossSection around a center (2,) in the plane's frame as a tool between two heights. mirrored : as seen from the
        other side, with heights below the other piece's side of the cut"""
        if mirrored:
            section, bottom, top = section.mirror((1, 0)), -top, -bottom
        return self._tool(self.plane.moved(center), self._extrude(section, bottom, top))

    def _region(self, frame: Plane, bodies: Dict[int, Any]) -> Any:
        """The CrossSection where the two pieces meet, in the frame, which is in the plane."""
        return frame.section(bodies[self.part], -SECTION_HEIGHT) ^ frame.section(bodies[self.other], SECTION_HEIGHT)

    def _extrude(self, section: Any, bottom: float, top: float) -> Any:
        return self.cutter.manifold.Manifold.extrude(section, top - bottom).translate((0, 0, bottom))

    def _tool(self, frame: Plane, solid: Any) -> Any:
        return self.cutter.make_tool(frame.to_model(solid))

    # ---- Pegs, snap pins, holes

    def _add_pegs(self, bodies: Dict[int, Any], region: Any, center: np.ndarray, free_radius: float, clearance: float, kind: str,
                  insert: Optional[Insert]) -> List[Peg]:
        """The largest pegs that fit."""
        gap = clearance if insert else clearance / PEG_RATIO  # between the circles around peg and socket
        if insert:
            radius = min_radius = insert.diameter / 2
        else:
            radius = min(PEG_RADIUS_FRACTION * free_radius, CYLINDER_RATIO * free_radius / SLACK - gap - self.wall)
            min_radius = MIN_PEG_RADIUS
        while radius >= min_radius:
            for places in self._arrangements(region, center, free_radius, radius, gap, bool(insert)):
                added = [self._add_holes(bodies, frame, clearance, insert) if insert else
                         self._add_peg(bodies, frame, outline, radius, clearance, kind) for frame, outline in places]
                if pegs := [peg for peg in added if peg]:
                    return pegs
            radius *= SHRINK
        return []

    def _arrangements(self, region: Any, center: np.ndarray, free_radius: float, radius: float, gap: float,
                      is_round: bool) -> Iterator[List[Tuple[Plane, np.ndarray]]]:
        """Ways to fill a cut, the best first: (frame, outline (n, 2) in it) of each peg. They point along the cut."""
        margin = SLACK * (radius + gap + self.wall) / CYLINDER_RATIO
        one, other = _farthest_pair(region.offset(-margin, circular_segments=CYLINDER_SIDES))
        spread = float(np.linalg.norm(other - one))
        is_long = spread - 2 * max(0, free_radius - margin) > MIN_PEG_STRETCH * radius
        along = other - one if is_long else _long_side(region)
        outline = radius * np.column_stack([np.cos(PEG_CORNERS), np.sin(PEG_CORNERS)])
        if spread > max(MIN_PEG_DISTANCE * radius, 2 * (radius + gap) + self.wall):
            yield [(self.plane.moved(end, along), outline) for end in (one, other)]
        if is_long and not is_round:
            half = (spread / 2, 0)
            stretched = np.where(outline[:, :1] > 0, outline + half, outline - half)
            yield [(self.plane.moved((one + other) / 2, along), stretched)]
        yield [(self.plane.moved(center, along), outline)]

    def _add_holes(self, bodies: Dict[int, Any], frame: Plane, clearance: float, insert: Insert) -> Optional[Peg]:
        """Cut holes for an Insert around the center of a frame; None if they don't fit."""
        radius, depth = insert.diameter / 2 + clearance, insert.depth + clearance
        outer = self.section.circle((radius + self.wall) / CYLINDER_RATIO, CYLINDER_SIDES)
        walls = {self.part: self._extrude(outer, -depth - self.wall, -KERF),
                 self.other: self._extrude(outer, KERF, depth + self.wall)}
        if not all(_is_inside(self._tool(frame, wall), self.free[piece]) for piece, wall in walls.items()):
            return None
        circle = self.section.circle(radius / CYLINDER_RATIO, CYLINDER_SIDES)
        hole = self._tool(frame, self._extrude(circle, -depth, depth))
        for piece in walls:
            bodies[piece] -= hole
            self.free[piece] -= hole
        return self._peg(frame, circle.to_polygons()[0], insert.diameter / 2, insert.depth, "hole")

    def _add_peg(self, bodies: Dict[int, Any], frame: Plane, outline: np.ndarray, radius: float, clearance: float,
                 kind: str) -> Optional[Peg]:
        """Add a peg or snap pin with an outline (n, 2) in a frame; None if it does not fit."""
        one, other = bodies[self.part], bodies[self.other]
        for length in (radius * relative for relative in PEG_LENGTHS):
            shapes = (self._snap_pin if kind == "snap pin" else self._plain_peg)(outline, radius, length, clearance)
            if not shapes:
                continue
            peg, socket, around = shapes
            socket_wall = self._extrude(_grown(around, self.wall), KERF, length + clearance + self.wall)
            root = self._extrude(self.section([outline]), -PEG_ROOT_DEPTH * radius, -KERF)
            if not (_is_inside(self._tool(frame, socket_wall), self.free[self.other])
                    and _is_inside(self._tool(frame, root), one)):
                continue
            peg, socket = self._tool(frame, peg), self._tool(frame, socket)
            if not fits_bed(read_body(one + peg)[0], self.bed):
                continue
            bodies[self.part], bodies[self.other] = one + peg, other - socket
            self.free[self.part] -= peg
            self.free[self.other] -= socket
            return self._peg(frame, outline, radius, length, kind)
        return None

    def _plain_peg(self, outline: np.ndarray, radius: float, length: float, clearance: float) -> Tuple[Any, Any, Any]:
        """(peg, socket, CrossSection around the socket) in the peg's frame"""
        mouth = self.section([outline]).offset(clearance, self.cutter.manifold.JoinType.Miter)
        return (self._extrude(self.section([outline]), -PEG_ROOT_DEPTH * radius, length),
                self._extrude(mouth, -SECTION_HEIGHT, length + clearance), mouth)

    def _snap_pin(self, outline: np.ndarray, radius: float, length: float, clearance: float) -> Optional[Tuple[Any, Any, Any]]:
        """_plain_peg() of a snap pin; None if its halves would be too thin, or can't bend so far that the bumps hold."""
        height, thickness = SNAP_HEIGHT * length, PEG_RATIO * radius
        catch = min(MAX_CATCH, SNAP_STRAIN * 2 * height ** 2 / (3 * thickness))  # of a beam that is fixed at the cut
        bump = catch + clearance
        if catch < MIN_CATCH or thickness - bump < self.wall or height + bump > length:
            return None
        peg, socket, mouth = self._plain_peg(outline, radius, length, clearance)
        wide = self._bulge(outline, bump)
        peg += _hull(self.cutter.manifold, [(outline, height - bump), (wide, height), (outline, height + bump)])
        slit = self.section.square((2 * np.ptp(outline[:, 0]), 2 * bump), center=True)  # the halves touch before they break
        peg -= self._extrude(slit.translate(tuple(outline.mean(axis=0) * (1, 0))), 0, length + SECTION_HEIGHT)
        outer = mouth.to_polygons()[0]
        wide = self._bulge(outer, bump)
        socket += _hull(self.cutter.manifold, [(outer, height - bump - clearance), (wide, height - clearance),
                                               (wide, height + clearance), (outer, height + bump + clearance)])
        return peg, socket, self.section([wide]).hull()

    @staticmethod
    def _bulge(outline: np.ndarray, bump: float) -> np.ndarray:
        """The outline with bumps on both sides."""
        return outline + np.outer(np.sign(outline[:, 1].round(6)), (0, bump))

    def _peg(self, frame: Plane, outline: np.ndarray, radius: float, length: float, kind: str) -> Peg:
        corners = frame.center + outline @ frame.axes[:2]
        return Peg(self.part, self.other, frame.center, frame.axes[2], radius, length, kind, corners)

    # ---- Dovetails

    def _add_dovetail(self, bodies: Dict[int, Any], region: Any, center: np.ndarray, free_radius: float,
                      clearance: float) -> List[Peg]:
        """The widest dovetail that fits, open at one end."""
        x, y = _long_side(region)
        half = PEG_RADIUS_FRACTION * free_radius
        while half >= max(MIN_PEG_RADIUS, self.wall / 2):
            for direction in np.array([(x, y), (-x, -y), (-y, x), (y, -x)]):
                frame = self.plane.moved(center, direction)
                if peg := self._dovetail(bodies, frame, half, free_radius, clearance):
                    return [peg]
            half *= SHRINK
        return []

    def _dovetail(self, bodies: Dict[int, Any], frame: Plane, half: float, free_radius: float, clearance: float) -> Optional[Peg]:
        """Add a dovetail that slides out along a frame's x axis; None if it doesn't fit. half : of its narrowest width"""
        one, other = bodies[self.part], bodies[self.other]
        depth = DOVETAIL_DEPTH * half
        below, wide = depth + clearance, half + FLARE * (depth + clearance) + clearance * np.hypot(1, FLARE)
        region = self._region(frame, bodies)
        for back in (share * free_radius for share in DOVETAIL_LENGTHS):
            walls = self._box((-back - clearance - self.wall, 0), wide + self.wall)
            if (walls - region).area() > RELATIVE_TOLERANCE * walls.area():
                continue
            root = self._extrude(self._box((-back, 0), half), -PEG_ROOT_DEPTH * half, -KERF)
            if (_is_inside(self._tool(frame, self._extrude(walls, KERF, below + self.wall)), self.free[self.other])
                    and _is_inside(self._tool(frame, root), one)):
                break
        else:
            return None
        slot = self._tool(frame, self._trapezoid(half, below, -back - clearance, clearance))
        socketed = other - slot
        if (len(self.cutter.components(slot ^ other)) > 1 or len(self.cutter.components(socketed)) > 1
                or not self._keeps_edges(frame, other, slot)):
            return None
        tail = self._tool(frame, self._trapezoid(half, depth, -back)) ^ other
        # Planes of a cut are a kerf apart.
        neck = (frame.section(tail, SECTION_HEIGHT) ^ region).offset(-SECTION_HEIGHT)
        with_tail = one + tail + self._tool(frame, self._extrude(neck, -SECTION_HEIGHT, SECTION_HEIGHT))
        length = np.ptp(frame.to_local(read_body(tail)[0])[:, 0])
        overlaps = ((with_tail.translate(tuple(share * length * frame.axes[0])) ^ socketed).volume() for share in SLIDES)
        if not fits_bed(read_body(with_tail)[0], self.bed) or any(overlap > RELATIVE_TOLERANCE * tail.volume() for overlap in overlaps):
            return None
        bodies[self.part], bodies[self.other] = with_tail, socketed
        self.free[self.part] -= self._tool(frame, root)
        self.free[self.other] -= slot
        outline = max(neck.to_polygons(), key=lambda contour: self.section([contour]).area())
        return self._peg(frame, outline, half, depth, "dovetail")._replace(direction=-frame.axes[0])

    def _box(self, ends: Tuple[float, float], half: float) -> Any:
        return self.section.square((ends[1] - ends[0], 2 * half)).translate((ends[0], -half))

    def _trapezoid(self, half: float, depth: float, start: float, gap: float = 0.0) -> Any:
        """A dovetail or, with a gap, its slot, in the frame, from a start on x to beyond the model."""
        end = 2 * np.ptp(np.reshape(self.cutter.whole.bounding_box(), (2, 3)), axis=0).sum()
        wide = half + gap * np.hypot(1, FLARE)
        bottom, top = -SECTION_HEIGHT if gap else 0.0, depth
        profile = self.section([[(y * (wide + FLARE * z), z) for y, z in ((-1, bottom), (1, bottom), (1, top), (-1, top))]])
        # y, z, x: it is extruded along x
        return self._extrude(profile, start, end).transform(np.column_stack([np.eye(3)[[2, 0, 1]], np.zeros(3)]))

    def _keeps_edges(self, frame: Plane, body: Any, slot: Any) -> bool:
        """Whether nothing beside or below the open end of a slot is thinner than the wall, but for edges."""
        lengthwise = Plane(frame.center, frame.axes[[2, 0, 1]])
        bottom = float(frame.to_local(read_body(slot)[0])[:, 2].max())
        for plane, height in ((frame, SECTION_HEIGHT), (frame, bottom - SECTION_HEIGHT), (lengthwise, 0.0)):
            before = plane.section(body, height)
            after = before - plane.section(slot, height)
            if _thin_area(after, self.wall) - _thin_area(before, self.wall) > MAX_EDGE_AREA * self.wall ** 2:
                return False
        return True


def _grown(section: Any, distance: float) -> Any:
    """A CrossSection with at least so much around it."""
    return section.offset(distance / CYLINDER_RATIO, circular_segments=CYLINDER_SIDES)


def _thin_area(section: Any, thickness: float) -> float:
    """The area of a CrossSection where no circle of a diameter fits."""
    return float(section.area() - _grown(section.offset(-thickness / 2, circular_segments=CYLINDER_SIDES), thickness / 2).area())


def _hull(manifold: Any, layers: Sequence[Tuple[np.ndarray, float]]) -> Any:
    """The hull of outlines (n, 2) at heights."""
    return manifold.Manifold.hull_points(np.vstack([np.column_stack([outline, np.full(len(outline), height)])
                                                    for outline, height in layers]))


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


def _long_side(section: Any) -> np.ndarray:
    """(2,) the direction of the long side of the smallest rectangle around a CrossSection."""
    corners = section.hull().to_polygons()[0]
    sides = np.roll(corners, -1, axis=0) - corners
    x = sides / np.linalg.norm(sides, axis=1)[:, None]
    y = np.column_stack([-x[:, 1], x[:, 0]])
    widths, heights = np.ptp(corners @ x.T, axis=0), np.ptp(corners @ y.T, axis=0)
    best = (widths * heights).argmin()
    return np.array(x[best] if widths[best] >= heights[best] else y[best])


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
