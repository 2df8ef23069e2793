#!/usr/bin/env python3
"""Makes addon/partwheel/pick/partwheel.select.dat, the toolbar's icon: a part, what the next notch adds, and the wheel.

Blender's format: "VCO" and a 0, width and height (255), origin (0, 0), then for each triangle three corners of two
bytes, and after all these three colors of four bytes each; (0, 0) is at the bottom left.
"""

import math
import pathlib

TARGET = pathlib.Path(__file__).resolve().parents[1] / "addon" / "partwheel" / "pick" / "partwheel.select.dat"
GRAY, PART, NEXT = (222, 222, 222, 255), (255, 160, 40, 255), (120, 190, 255, 255)
CENTER, SIDES = (104, 128), 36


def ring(inner, outer, color):
    """Triangles between two circles."""
    def at(radius, step):
        angle = 2 * math.pi * step / SIDES
        return CENTER[0] + radius * math.cos(angle), CENTER[1] + radius * math.sin(angle)

    for step in range(SIDES):
        a, b, c, d = at(inner, step), at(outer, step), at(outer, step + 1), at(inner, step + 1)
        yield (a, b, c), color
        if inner:
            yield (a, c, d), color


def arrow(base, tip):
    """A triangle at the right side."""
    yield ((204, base), (250, base), (227, tip)), GRAY


def main():
    triangles = [*ring(0, 34, PART), *ring(44, 62, NEXT), *ring(74, 90, GRAY), *arrow(146, 196), *arrow(110, 60)]
    corners = bytes(round(value) for corner, _ in triangles for point in corner for value in point)
    colors = bytes(value for _, color in triangles for _ in range(3) for value in color)
    TARGET.write_bytes(b"VCO\0" + bytes((255, 255, 0, 0)) + corners + colors)


if __name__ == "__main__":
    main()
