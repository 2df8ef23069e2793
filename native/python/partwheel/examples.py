# SPDX-License-Identifier: GPL-3.0-or-later
"""Models made by formula, to try things on: a fused, textured figure, a truck of many shells, a chair, and a dog as scanners
make it. All are about two meters large, with z up, and look along -y.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np

TILE = 10  # pixels along a quad's side in the figure's texture
BLEND = 0.018  # how far round cones melt into each other, in meters
SKIN, SHIRT, STRIPE, JEANS, SHOE, HAIR, DARK, WHITE = np.array([
    (0.93, 0.70, 0.54), (0.93, 0.93, 0.90), (0.80, 0.25, 0.22), (0.20, 0.33, 0.58), (0.30, 0.20, 0.16), (0.35, 0.20, 0.11),
    (0.10, 0.08, 0.08), (1.0, 1.0, 1.0)], np.float32)


class Example(NamedTuple):
    """A model.

    vertices : (V, 3) float64
    polygons : the vertices of each, counterclockwise seen from outside
    materials : {name: (red, green, blue)}; empty with a texture
    material_of_polygon : (P,) int32, in the order of materials
    uvs : (L, 2) float32 for all corners, polygon by polygon; None without a texture
    texture : (height, width, 3) float32, the bottom row first; or None
    """

    vertices: np.ndarray
    polygons: list[list[int]]
    materials: dict[str, tuple[float, float, float]]
    material_of_polygon: np.ndarray
    uvs: np.ndarray | None = None
    texture: np.ndarray | None = None

    @property
    def triangles(self) -> np.ndarray:
        """(T, 3) int32: each polygon as a fan."""
        return np.array([(polygon[0], *side) for polygon in self.polygons for side in zip(polygon[1:], polygon[2:])], np.int32)

    def save(self, path: str | Path, up: Literal["y", "z"] = "y") -> None:
        """Write the triangles, without materials and texture, to an OBJ file.

        Parameters
        ----------
        up : the axis that points up in the file; "y" as Blender's importer and engines expect it, "z" as slicers do
        """
        vertices = self.vertices if up == "z" else self.vertices[:, [0, 2, 1]] * [1, 1, -1]
        Path(path).write_text("\n".join([*(f"v {x:.8f} {y:.8f} {z:.8f}" for x, y, z in vertices),
                                         *(f"f {a} {b} {c}" for a, b, c in self.triangles + 1), ""]))


# ---- Fused models: round cones, melted together


def figure(step: float = 0.02) -> Example:
    """A cartoon figure, one closed surface with a texture and without a name for anything, as generators make them.

    Parameters
    ----------
    step : the size of a face, in meters
    """
    cones = mirrored([
        ((0.21, 0, 1.23), 0.078, (0.44, 0, 1.15), 0.060),  # arm
        ((0.44, 0, 1.15), 0.060, (0.64, -0.03, 1.08), 0.046),
        ((0.70, -0.03, 1.06), 0.062, (0.75, -0.035, 1.045), 0.062),  # hand
        ((0.77, -0.085, 1.03), 0.026, (0.88, -0.115, 0.98), 0.023),
        ((0.78, -0.030, 1.025), 0.027, (0.91, -0.035, 0.97), 0.024),
        ((0.77, 0.025, 1.03), 0.026, (0.88, 0.055, 0.98), 0.023),
        ((0.69, -0.08, 1.07), 0.029, (0.74, -0.175, 1.06), 0.025),
        ((0.095, 0, 0.80), 0.100, (0.125, -0.01, 0.48), 0.074),  # leg
        ((0.125, -0.01, 0.48), 0.074, (0.135, 0.01, 0.13), 0.056),
        ((0.137, 0.02, 0.065), 0.066, (0.165, -0.15, 0.055), 0.058),
        ((0.195, 0.0, 1.58), 0.036, (0.225, 0.01, 1.63), 0.042),  # ear
    ]) + [
        ((0, 0, 0.92), 0.195, (0, 0, 1.19), 0.180),  # body
        ((0, 0, 1.30), 0.062, (0, 0, 1.42), 0.062),
        ((0, -0.01, 1.56), 0.165, (0, 0.01, 1.66), 0.175),  # head
        ((0, -0.18, 1.585), 0.030, (0, -0.23, 1.57), 0.036),
    ]
    vertices, quads = melt(cones, step)
    uvs, texture = _paint(vertices, quads, _figure_colors)
    return Example(vertices, quads.tolist(), {}, np.zeros(len(quads), np.int32), uvs, texture)


def dog() -> Example:
    """A sitting toy dog as scanners make it: bumpy, with a hole where it stood, without UV map and texture."""
    cones = mirrored([
        ((0.20, -0.20, 0.55), 0.100, (0.22, -0.32, 0.10), 0.085),  # front leg
        ((0.22, -0.34, 0.07), 0.095, (0.23, -0.46, 0.06), 0.075),
        ((0.30, 0.25, 0.28), 0.200, (0.36, -0.02, 0.20), 0.130),  # hind leg
        ((0.38, -0.02, 0.08), 0.095, (0.42, -0.22, 0.06), 0.080),
        ((0.25, -0.26, 1.36), 0.055, (0.40, -0.24, 1.05), 0.100),  # ear
    ]) + [
        ((0, 0.22, 0.33), 0.300, (0, -0.10, 0.80), 0.220),  # body
        ((0, -0.12, 0.85), 0.160, (0, -0.22, 1.10), 0.150),
        ((0, -0.25, 1.22), 0.235, (0, -0.30, 1.26), 0.230),  # head
        ((0, -0.45, 1.14), 0.130, (0, -0.62, 1.12), 0.105),
        ((0, -0.71, 1.17), 0.045, (0, -0.72, 1.17), 0.045),
        ((0, 0.50, 0.30), 0.070, (0, 0.78, 0.42), 0.055),  # tail
        ((0, 0.78, 0.42), 0.055, (0, 0.90, 0.66), 0.045),
    ]
    vertices, quads = melt(cones, 0.025)
    rng = np.random.default_rng(0)
    vertices = vertices + rng.normal(0, 0.0015, vertices.shape)
    quads = quads[(vertices[quads][:, :, 2] > 0).all(axis=1)]
    used, flat = np.unique(quads, return_inverse=True)
    return Example(vertices[used], flat.reshape(-1, 4).tolist(), {}, np.zeros(len(quads), np.int32))


def mirrored(cones: list) -> list:
    """Return the round cones and their mirror images across x = 0."""
    return [cone for (a, r, b, s) in cones for cone in ((a, r, b, s), ((-a[0], *a[1:]), r, (-b[0], *b[1:]), s))]


def melt(cones: list, step: float) -> tuple[np.ndarray, np.ndarray]:
    """Return vertices (V, 3) and quads (Q, 4) of the surface around round cones [(end, radius, end, radius), ...]."""
    ends = np.array([(a, b) for a, _, b, _ in cones])
    radii = np.array([(r, s) for _, r, _, s in cones])
    low = (ends - radii[..., None]).min(axis=(0, 1)) - 4 * BLEND
    high = (ends + radii[..., None]).max(axis=(0, 1)) + 4 * BLEND
    counts = np.ceil((high - low) / step).astype(int)
    axes = [(low[i] + high[i]) / 2 + step * (np.arange(counts[i]) - (counts[i] - 1) / 2) for i in range(3)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).astype(np.float32)
    total = np.zeros(points.shape[:3], np.float32)
    for (a, b), (r, s) in zip(ends, radii):
        along = b - a
        t = np.clip((points - a) @ along / (along @ along), 0, 1)
        distance = np.linalg.norm(points - a - t[..., None] * along, axis=-1) - (r + t * (s - r))
        total += np.exp(np.clip(-distance / BLEND, -60, 60))
    return _surface_net(-np.log(np.maximum(total, 1e-30)), axes, step)


def _surface_net(field: np.ndarray, axes: list[np.ndarray], step: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the surface where a field on a grid changes its sign, negative inside: a vertex per cell at the mean of the
    crossings on its edges, a quad per crossed grid edge."""
    inside = field < 0
    shape = tuple(size - 1 for size in field.shape)
    total, count = np.zeros((*shape, 3)), np.zeros(shape, int)
    crossings = []
    for axis in range(3):
        head, tail = [slice(None)] * 3, [slice(None)] * 3
        head[axis], tail[axis] = slice(None, -1), slice(1, None)
        a, b = field[tuple(head)], field[tuple(tail)]
        where = np.argwhere(inside[tuple(head)] != inside[tuple(tail)])
        at = tuple(where.T)
        place = where.astype(float)
        place[:, axis] += a[at] / (a[at] - b[at])
        for cells in _cells_around(where, axis, ((0, 0), (0, 1), (1, 0), (1, 1))):
            np.add.at(total, cells, place)
            np.add.at(count, cells, 1)
        crossings.append((axis, where, inside[at]))
    used = count > 0
    number = np.cumsum(used.ravel()).reshape(shape) - 1
    vertices = total[used] / count[used][:, None] * step + [values[0] for values in axes]
    quads = []
    for axis, where, is_inside in crossings:
        ring = np.stack([number[cells] for cells in _cells_around(where, axis, ((0, 0), (1, 0), (1, 1), (0, 1)))], axis=1)
        quads.append(np.where(is_inside[:, None], ring, ring[:, ::-1]))
    return vertices, np.concatenate(quads)


def _cells_around(edges: np.ndarray, axis: int, order: tuple) -> Iterator[tuple]:
    """The indices of the four cells around each edge (n, 3) of a grid along an axis."""
    for back in order:
        yield tuple((edges - np.roll((0, *back), axis)).T)


def _paint(vertices: np.ndarray, quads: np.ndarray, color: Callable) -> tuple[np.ndarray, np.ndarray]:
    """Return UVs and a texture: a tile of its own for each quad, as generators without an unwrapper do it."""
    columns = int(np.ceil(np.sqrt(len(quads))))
    rows, number = -(-len(quads) // columns), np.arange(len(quads))
    left, bottom = number % columns * TILE, number // columns * TILE
    corners = np.array([(0, 0), (1, 0), (1, 1), (0, 1)]) * (TILE - 3) + 1.5
    size = np.array([columns * TILE, rows * TILE])
    uvs = (np.stack([left, bottom], axis=1)[:, None] + corners) / size
    share = np.clip((np.arange(TILE) + 0.5 - 1.5) / (TILE - 3), 0, 1)
    u, v = (values[None, :, :, None] for values in np.meshgrid(share, share))
    a, b, c, d = (vertices[quads[:, corner]][:, None, None] for corner in range(4))
    places = (1 - v) * ((1 - u) * a + u * b) + v * ((1 - u) * d + u * c)
    tiles = np.zeros((rows * columns, TILE, TILE, 3), np.float32)
    tiles[:len(quads)] = color(places.reshape(-1, 3)).reshape(-1, TILE, TILE, 3)
    texture = tiles.reshape(rows, columns, TILE, TILE, 3).transpose(0, 2, 1, 3, 4).reshape(rows * TILE, columns * TILE, 3)
    return uvs.reshape(-1, 2).astype(np.float32), texture


def _figure_colors(places: np.ndarray) -> np.ndarray:
    """(n, 3) colors of places on the figure."""
    x, y, z = np.abs(places[:, 0]), places[:, 1], places[:, 2]
    paint = np.tile(SKIN, (len(places), 1))
    paint[(z > 0.86) & (z < 1.335) & (x < 0.43)] = SHIRT
    paint[(z > 1.02) & (z < 1.10) & (x < 0.25)] = STRIPE
    paint[(z < 0.90) & (x < 0.35)] = JEANS
    paint[(z > 0.86) & (z < 0.90) & (x < 0.35)] = SHOE
    paint[z < 0.13] = SHOE
    paint[z < 0.03] = DARK
    paint[(z > 1.50 - 0.9 * y) & (z > 1.48) & (x < 0.178)] = HAIR
    front = y < -0.1
    eye = np.hypot(x - 0.07, z - 1.655)
    paint[front & (eye < 0.040)] = WHITE
    paint[front & (eye < 0.018)] = DARK
    paint[front & (np.abs(z - 1.500 - 3 * x * x) < 0.008) & (x < 0.075)] = STRIPE
    return paint


# ---- Models of shells


def truck() -> Example:
    """A toy truck: 24 closed shells in one mesh that touch, cross or contain each other, as game assets are."""
    shells = _Shells()
    shells.box("Paint", (0, -0.72, 0.72), (0.80, 0.46, 0.66))  # cab
    shells.box("Glass", (0, -0.86, 0.86), (0.66, 0.22, 0.26))
    shells.box("Glass", (0, -0.70, 0.88), (0.84, 0.26, 0.20))
    shells.box("Paint", (0, -1.08, 0.52), (0.72, 0.34, 0.30))  # hood
    shells.box("Metal", (0, -1.27, 0.36), (0.86, 0.06, 0.10))  # bumper
    shells.box("Metal", (0, -0.15, 0.36), (0.44, 2.10, 0.10))  # frame
    shells.box("Metal", (0, 0.33, 0.48), (0.90, 1.40, 0.08))  # bed
    for x in (-0.43, 0.43):
        shells.box("Paint", (x, 0.33, 0.66), (0.05, 1.40, 0.32))
        shells.cylinder("Light", (0.62 * x, -1.26, 0.55), 1, 0.075, 0.06)
        shells.cylinder("Metal", (1.05 * x, -0.46, 1.00), 2, 0.04, 0.80)  # pipe
    for y in (-0.35, 1.01):
        shells.box("Paint", (0, y, 0.66), (0.81, 0.05, 0.32))
    for x in (-0.42, 0.42):
        for y in (-0.80, 0.10, 0.72):
            shells.cylinder("Rubber", (x, y, 0.24), 0, 0.24, 0.20)
    for x, y, size in ((-0.18, 0.0, 0.36), (0.16, 0.45, 0.42)):
        shells.box("Wood", (x, y, 0.52 + size / 2), (size, size, size))
    shells.cylinder("Wood", (-0.2, 0.55, 0.72), 2, 0.15, 0.40)
    return shells.example({"Paint": (0.72, 0.12, 0.10), "Glass": (0.45, 0.65, 0.75), "Metal": (0.45, 0.46, 0.48),
                           "Rubber": (0.05, 0.05, 0.05), "Light": (0.95, 0.85, 0.45), "Wood": (0.55, 0.36, 0.18)})


def chair() -> Example:
    """A chair of nine shells: a prop that needs colliders."""
    shells = _Shells()
    for x in (-0.40, 0.40):
        shells.box("Wood", (x, -0.40, 0.40), (0.10, 0.10, 0.80))
        shells.box("Wood", (x, 0.40, 0.90), (0.10, 0.10, 1.80))
        shells.box("Wood", (x, 0, 0.25), (0.06, 0.76, 0.06))
    shells.box("Cushion", (0, -0.02, 0.85), (0.96, 0.96, 0.12))
    for z in (1.30, 1.65):
        shells.box("Cushion", (0, 0.40, z), (0.76, 0.06, 0.18))
    return shells.example({"Wood": (0.45, 0.28, 0.14), "Cushion": (0.20, 0.42, 0.40)})


class _Shells:
    """Collects closed shells."""

    def __init__(self) -> None:
        self._vertices: list[np.ndarray] = []
        self._polygons: list[list[int]] = []
        self._materials: list[str] = []
        self._count = 0

    def box(self, material: str, center: tuple, size: tuple) -> None:
        """A box with bevels of a tenth of its shortest side."""
        half = np.array(size) / 2
        inset = half - 0.2 * half.min()
        rings = [(x * (inset if z in (0, 3) else half)[0], y * (inset if z in (0, 3) else half)[1],
                  (-half[2], -inset[2], inset[2], half[2])[z])
                 for z in range(4) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        self._add(material, np.array(rings) + center, 4)

    def cylinder(self, material: str, center: tuple, axis: int, radius: float, length: float) -> None:
        sides = 24
        angles = 2 * np.pi * np.arange(sides) / sides
        circle = np.stack([np.cos(angles), np.sin(angles)], axis=1)
        bevel = 0.15 * min(radius, length)
        rings = np.concatenate([np.column_stack([circle * r, np.full(sides, z)])
                                for r, z in ((radius - bevel, -length / 2), (radius, bevel - length / 2),
                                             (radius, length / 2 - bevel), (radius - bevel, length / 2))])
        self._add(material, np.roll(rings, axis + 1, axis=1) + center, sides)

    def _add(self, material: str, rings: np.ndarray, sides: int) -> None:
        """Four rings of vertices, from the bottom to the top."""
        first = self._count
        polygons = [[*range(sides)][::-1], [*range(3 * sides, 4 * sides)]]
        polygons += [[ring + k, ring + (k + 1) % sides, ring + sides + (k + 1) % sides, ring + sides + k]
                     for ring in range(0, 3 * sides, sides) for k in range(sides)]
        self._polygons += [[first + vertex for vertex in polygon] for polygon in polygons]
        self._materials += [material] * len(polygons)
        self._vertices.append(rings)
        self._count += len(rings)

    def example(self, materials: dict) -> Example:
        names = list(materials)
        return Example(np.concatenate(self._vertices), self._polygons, materials,
                       np.array([names.index(name) for name in self._materials], np.int32))


EXAMPLES: dict[str, Callable[[], Example]] = {"figure": figure, "truck": truck, "chair": chair, "dog": dog}
