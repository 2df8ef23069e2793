# SPDX-License-Identifier: GPL-3.0-or-later
"""One movement by the mouse, like Blender's own transforms: G, R or S; along an axis or in a plane of the world or
the object; by a typed number; in steps (Ctrl) and precisely (Shift)."""

import math

import bpy
from bpy_extras.view3d_utils import location_3d_to_region_2d, region_2d_to_location_3d, region_2d_to_vector_3d
from mathutils import Matrix, Vector
from mathutils.geometry import intersect_line_line, intersect_line_plane

from ..view import keys
from ..translations.lookup import iface_

STEP_DEGREES, STEP_SCALE = 5.0, 0.1  # steps with Ctrl
PRECISION_FACTOR = 0.1  # factor of mouse motion and steps with Shift
MIN_COSINE = 0.1  # cosine: lines and planes at smaller angles to the view direction have no point under the mouse
DIGIT_KEYS = {**keys.DIGITS, **{f"NUMPAD_{digit}": str(digit) for digit in range(10)}, "PERIOD": ".",
              "NUMPAD_PERIOD": "."}
MINUS_KEYS = {"MINUS", "NUMPAD_MINUS"}


class Movement:
    """A movement since a key or button started it. The mouse is in pixels of the region that it started in."""

    def __init__(self, kind: str, pivot: Vector, dragging: bool, axis: int | None = None) -> None:
        self.kind = kind  # G, R or S
        self.pivot = pivot  # in the world
        self.dragging = dragging  # whether it ends when the button is released
        self.axis, self.plane, self.local = axis, False, False  # along or around this axis; plane: along the other two
        self.frame = Matrix.Identity(3)  # columns: the axes of the world, or of the object if local
        self.typed = ""
        self._view = None  # (region, RegionView3D)
        self._start = self._position = self._mouse = None  # mouse: start, effective position, real position
        # Whether Shift makes the motion precise. It does not if it was down when the movement started, until it is released.
        self._is_precise, self._was_shift_down = False, False
        self._total_angle, self._mouse_angle = 0.0, None  # radians: total; of the mouse around the pivot

    def constrain(self, axis: int, plane: bool, matrix_world: Matrix) -> None:
        """Like Blender's transforms: an axis key selects the world's axis, again the object's own, then none."""
        is_repeated = (self.axis, self.plane) == (axis, plane)
        if is_repeated and self.local:
            axis, plane = None, False
        self.axis, self.plane, self.local = axis, plane, is_repeated and not self.local
        self.frame = matrix_world.to_3x3().normalized() if self.local else Matrix.Identity(3)

    def type_key(self, event_type: str) -> bool:
        """Adds the key to the typed number. Returns whether it is part of a number."""
        if event_type in DIGIT_KEYS:
            self.typed += DIGIT_KEYS[event_type]
        elif event_type in MINUS_KEYS:
            self.typed = self.typed[1:] if self.typed.startswith("-") else "-" + self.typed
        elif event_type == "BACK_SPACE":
            self.typed = self.typed[:-1]
        else:
            return False
        return True

    def status_text(self) -> str:
        text = {"G": iface_("Move"), "R": iface_("Rotate"), "S": iface_("Scale")}[self.kind]
        if self.axis is not None:
            axis = iface_("{movement} along local {axes}") if self.local else iface_("{movement} along global {axes}")
            plane = iface_("{movement} in local {axes}") if self.local else iface_("{movement} in global {axes}")
            text = (plane if self.plane else axis).format(movement=text,
                                                            axes="".join("XYZ"[k] for k in self._free_axes()))
        return f"{text}: {self.typed}" if self.typed else text

    def track(self, region: bpy.types.Region, view: bpy.types.RegionView3D, mouse: tuple[float, float],
              shift: bool) -> None:
        """Follows the mouse, with or without Shift. Called for every position from the first on: full turns count."""
        self._view, mouse = (region, view), Vector(mouse)
        if self._mouse is None:
            self._start = self._position = self._mouse = mouse
            self._was_shift_down = shift
        self._was_shift_down = self._was_shift_down and shift
        self._is_precise = shift and not self._was_shift_down
        factor = PRECISION_FACTOR if self._is_precise else 1.0
        self._position = self._position + factor * (mouse - self._mouse)
        self._mouse = mouse
        from_center = mouse - self._pivot_pixel()
        if from_center.length < 1:
            return
        angle = math.atan2(from_center.y, from_center.x)
        if self._mouse_angle is not None:
            self._total_angle += factor * ((angle - self._mouse_angle + math.pi) % (2 * math.pi) - math.pi)
        self._mouse_angle = angle

    def matrix(self, steps: bool) -> Matrix:
        """The movement so far, in the world (4 x 4)."""
        function = {"G": self._translation, "R": self._rotation, "S": self._scaling}[self.kind]
        size = (PRECISION_FACTOR if self._is_precise else 1.0) if steps else None
        return function(self._typed_number(), size)

    def _free_axes(self) -> list[int]:
        """The axes of the frame along which the movement is free."""
        return [k for k in range(3) if self.axis is None or (k == self.axis) != self.plane]

    def _typed_number(self) -> float | None:
        try:
            return float(self.typed)
        except ValueError:  # empty, or only a sign
            return None

    def _pivot_pixel(self) -> Vector:
        """The pivot's pixel; behind the viewer, where the movement started."""
        return location_3d_to_region_2d(*self._view, self.pivot) or self._start

    # number: as typed, or None. steps: fraction of a step to snap to, or None.

    def _translation(self, number: float | None, steps: float | None) -> Matrix:
        if number is not None:
            return Matrix.Translation(number * self.frame.col[self._free_axes()[0]])
        end, start = (self._point_under(point) for point in (self._position, self._start))
        shift = self.frame.transposed() @ (end - start)
        shift = Vector(shift[k] if k in self._free_axes() else 0 for k in range(3))
        if steps:
            # A visible step: the power of ten nearest to 20 pixels.
            right = self._start + Vector((20, 0))
            pixels = (region_2d_to_location_3d(*self._view, right, self.pivot)
                      - region_2d_to_location_3d(*self._view, self._start, self.pivot)).length
            step = steps * 10 ** round(math.log10(max(pixels, 1e-12)))
            shift = Vector(step * round(value / step) for value in shift)
        return Matrix.Translation(self.frame @ shift)

    def _point_under(self, point: Vector) -> Vector:
        """The point under a pixel: on the line or plane through the pivot to which the movement is constrained;
        without one, or nearly edge-on, at the pivot's depth."""
        point_3d = region_2d_to_location_3d(*self._view, point, self.pivot)
        if self.axis is None:
            return point_3d
        direction, axis = region_2d_to_vector_3d(*self._view, point), self.frame.col[self.axis]
        cosine = abs(direction.normalized().dot(axis))
        if self.plane and cosine > MIN_COSINE:
            return intersect_line_plane(point_3d, point_3d + direction, self.pivot, axis)
        if not self.plane and cosine < math.sqrt(1 - MIN_COSINE * MIN_COSINE):
            return intersect_line_line(self.pivot, self.pivot + axis, point_3d, point_3d + direction)[0]
        return point_3d

    def _rotation(self, number: float | None, steps: float | None) -> Matrix:
        view_axis = self._view[1].view_matrix.inverted().to_3x3().col[2]
        axis = view_axis if self.axis is None else self.frame.col[self.axis].copy()
        angle = self._total_angle if axis.dot(view_axis) >= 0 else -self._total_angle
        if number is not None:
            angle = math.radians(number)
        elif steps:
            step = math.radians(steps * STEP_DEGREES)
            angle = step * round(angle / step)
        return self._about_pivot(Matrix.Rotation(angle, 4, axis))

    def _scaling(self, number: float | None, steps: float | None) -> Matrix:
        center = self._pivot_pixel()
        factor = (self._position - center).length / max((self._start - center).length, 1)
        if number is not None:
            factor = number
        elif steps:
            step = steps * STEP_SCALE
            factor = step * round(factor / step)
        scale = Matrix.Diagonal([factor if k in self._free_axes() else 1 for k in range(3)])
        return self._about_pivot((self.frame @ scale @ self.frame.transposed()).to_4x4())

    def _about_pivot(self, matrix: Matrix) -> Matrix:
        return Matrix.Translation(self.pivot) @ matrix @ Matrix.Translation(-self.pivot)
