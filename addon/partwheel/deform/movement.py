# SPDX-License-Identifier: GPL-3.0-or-later
"""One movement with the mouse, as Blender's own transforms: G, R or S; along an axis or in a plane, the world's or the
object's; by a typed number; in steps (Ctrl) and finely (Shift)."""

import math

from bpy_extras.view3d_utils import (
    location_3d_to_region_2d, region_2d_to_location_3d, region_2d_to_vector_3d,
)
from mathutils import Matrix, Vector
from mathutils.geometry import intersect_line_line, intersect_line_plane

from ..view import keys
from ..words.say import iface_

STEP_DEGREES, STEP_SCALE = 5.0, 0.1  # what Ctrl snaps to
FINE = 0.1  # what Shift makes of the mouse's way, and of these steps
GRAZING = 0.1  # cosine: a line seen so much from its end, a plane so much from its edge, gives no place under the mouse
DIGITS = {**keys.DIGITS, **{f"NUMPAD_{digit}": str(digit) for digit in range(10)}, "PERIOD": ".", "NUMPAD_PERIOD": "."}
MINUS = {"MINUS", "NUMPAD_MINUS"}


class Movement:
    """What is under way since a key or a button began it. Regions and RegionView3Ds are those it began in; the mouse is
    in pixels of the region."""

    def __init__(self, kind, pivot, dragging, axis=None):
        self.kind = kind  # G, R or S
        self.pivot = pivot  # of turns and scales, in the world
        self.dragging = dragging  # ends when the button is released
        self.axis, self.plane, self.local = axis, False, False  # along or about which alone, or along all but that
        self.frame = Matrix.Identity(3)  # the world's axes, or the object's if local
        self.typed = ""
        self._start = self._place = self._mouse = None  # where it began; where it is for the movement, and is really
        self._fine, self._held = False, False  # Shift counts; it is held since before, when it meant something else
        self._turned, self._angle = 0.0, None  # so far, in radians: full turns count; the mouse about the pivot

    def constrain(self, axis, plane, matrix_world):
        """As Blender's transforms: the key of an axis takes the world's, pressed again the object's own, then none."""
        again = (self.axis, self.plane) == (axis, plane)
        if again and self.local:
            axis, plane = None, False
        self.axis, self.plane, self.local = axis, plane, again and not self.local
        self.frame = matrix_world.to_3x3().normalized() if self.local else Matrix.Identity(3)

    def type(self, event_type):
        """Whether that event is part of a number, which it then is."""
        if event_type in DIGITS:
            self.typed += DIGITS[event_type]
        elif event_type in MINUS:
            self.typed = self.typed[1:] if self.typed.startswith("-") else "-" + self.typed
        elif event_type == "BACK_SPACE":
            self.typed = self.typed[:-1]
        else:
            return False
        return True

    def told(self):
        """In words: what moves how."""
        words = {"G": iface_("Move"), "R": iface_("Rotate"), "S": iface_("Scale")}[self.kind]
        if self.axis is not None:
            along = iface_("{movement} along local {axes}") if self.local else iface_("{movement} along global {axes}")
            within = iface_("{movement} in local {axes}") if self.local else iface_("{movement} in global {axes}")
            words = (within if self.plane else along).format(movement=words, axes="".join("XYZ"[k] for k in self._free()))
        return f"{words}: {self.typed}" if self.typed else words

    def track(self, region, view, mouse, shift):
        """The mouse went there, with Shift held or not. To be told of every place that it passed, from the first, for
        full turns count."""
        mouse = Vector(mouse)
        if self._mouse is None:
            self._start = self._place = self._mouse = mouse
            self._held = shift
        self._held = self._held and shift
        self._fine = shift and not self._held
        share = FINE if self._fine else 1.0
        self._place = self._place + share * (mouse - self._mouse)
        self._mouse = mouse
        away = mouse - self._center(region, view)
        if away.length < 1:
            return
        angle = math.atan2(away.y, away.x)
        if self._angle is not None:
            self._turned += share * ((angle - self._angle + math.pi) % (2 * math.pi) - math.pi)
        self._angle = angle

    def matrix(self, region, view, steps):
        """The movement so far, in the world (4 x 4)."""
        function = {"G": self._moved, "R": self._rotated, "S": self._scaled}[self.kind]
        size = (FINE if self._fine else 1.0) if steps else None
        return function(region, view, self._number(), size)

    def _free(self):
        """Of the frame's axes those along which there is movement."""
        return [k for k in range(3) if self.axis is None or (k == self.axis) != self.plane]

    def _number(self):
        try:
            return float(self.typed)
        except ValueError:  # nothing yet, or only a sign
            return None

    def _center(self, region, view):
        """The pivot's pixel; where there is none, behind the viewer, that where it began."""
        return location_3d_to_region_2d(region, view, self.pivot) or self._start

    # Each with a typed number or None, and with what share of a step to go by, or None.

    def _moved(self, region, view, number, steps):
        if number is not None:
            return Matrix.Translation(number * self.frame.col[self._free()[0]])
        now, before = (self._under(region, view, point) for point in (self._place, self._start))
        shift = self.frame.transposed() @ (now - before)
        shift = Vector(shift[k] if k in self._free() else 0 for k in range(3))
        if steps:
            # A step that shows: the power of ten next to some 20 pixels.
            aside = self._start + Vector((20, 0))
            pixels = (region_2d_to_location_3d(region, view, aside, self.pivot)
                      - region_2d_to_location_3d(region, view, self._start, self.pivot)).length
            step = steps * 10 ** round(math.log10(max(pixels, 1e-12)))
            shift = Vector(step * round(value / step) for value in shift)
        return Matrix.Translation(self.frame @ shift)

    def _under(self, region, view, point):
        """The place under a pixel of the region: on the line or in the plane through the pivot that the movement keeps
        to, unless that is seen too much from its end or its edge; else as far away as the pivot."""
        place = region_2d_to_location_3d(region, view, point, self.pivot)
        if self.axis is None:
            return place
        direction, axis = region_2d_to_vector_3d(region, view, point), self.frame.col[self.axis]
        slant = abs(direction.normalized().dot(axis))
        if self.plane and slant > GRAZING:
            return intersect_line_plane(place, place + direction, self.pivot, axis)
        if not self.plane and slant < math.sqrt(1 - GRAZING * GRAZING):
            return intersect_line_line(self.pivot, self.pivot + axis, place, place + direction)[0]
        return place

    def _rotated(self, _region, view, number, steps):
        towards_user = view.view_matrix.inverted().to_3x3().col[2]
        axis = towards_user if self.axis is None else self.frame.col[self.axis].copy()
        angle = self._turned if axis.dot(towards_user) >= 0 else -self._turned
        if number is not None:
            angle = math.radians(number)
        elif steps:
            step = math.radians(steps * STEP_DEGREES)
            angle = step * round(angle / step)
        return self._about_pivot(Matrix.Rotation(angle, 4, axis))

    def _scaled(self, region, view, number, steps):
        center = self._center(region, view)
        factor = (self._place - center).length / max((self._start - center).length, 1)
        if number is not None:
            factor = number
        elif steps:
            step = steps * STEP_SCALE
            factor = step * round(factor / step)
        scale = Matrix.Diagonal([factor if k in self._free() else 1 for k in range(3)])
        return self._about_pivot((self.frame @ scale @ self.frame.transposed()).to_4x4())

    def _about_pivot(self, matrix):
        return Matrix.Translation(self.pivot) @ matrix @ Matrix.Translation(-self.pivot)
