# SPDX-License-Identifier: GPL-3.0-or-later
"""Closed surfaces for tests: vertices (V,3), triangles (T,3), faces (T,) the polygon of each triangle, face_count; and how
many of them a test runs on."""

import itertools
import os
from pathlib import Path
from typing import NamedTuple

import numpy as np

MESHES = Path(__file__).resolve().parents[2] / "build" / "deps" / "meshes"
LIGHT = os.environ.get("PARTWHEEL_TEST_LIGHT", "0") not in ("", "0")  # as in tests/native/support/sizes.h


def lighter(arguments, count):
    """What a test runs on: all of them, or under a sanitizer, where the others would take the same code, the first."""
    return list(arguments)[:count] if LIGHT else arguments


class Shape(NamedTuple):
    vertices: np.ndarray
    triangles: np.ndarray
    faces: np.ndarray
    face_count: int


def polygons(vertices, polygon_list):
    """A shape of convex polygons, each cut into a fan."""
    triangles, faces = [], []
    for face, polygon in enumerate(polygon_list):
        for second, third in zip(polygon[1:], polygon[2:]):
            triangles.append((polygon[0], second, third))
            faces.append(face)
    return Shape(np.array(vertices, float), np.array(triangles, np.int32), np.array(faces, np.int32),
                 len(polygon_list))


def polycube(cells):
    """The surface of unit cells given by their lowest corners, in quads: many coplanar faces and equal costs."""
    cells = set(cells)
    corners, quads = {}, []
    for cell in sorted(cells):
        for axis, side in itertools.product(range(3), (0, 1)):
            neighbor = list(cell)
            neighbor[axis] += 2 * side - 1
            if tuple(neighbor) in cells:
                continue
            quads.append([corners.setdefault(corner, len(corners)) for corner in square(cell, axis, side)])
    return polygons(list(corners), quads)


def square(cell, axis, side):
    """The corners of the lower or upper side of a unit cell across an axis, wound outward."""
    corners = []
    for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)):
        corner = list(cell)
        corner[axis] += side
        corner[(axis + 1) % 3] += u
        corner[(axis + 2) % 3] += v
        corners.append(tuple(corner))
    return corners if side else corners[::-1]


def walled_cells(cells, wall_share, seed=0):
    """(vertices, quads) of unit cells given by their lowest corners, turned at random: with this share of the squares between
    two of them. Squares that don't close a cell are walls with windows, and fins."""
    rng = np.random.default_rng(seed)
    number, squares = {}, {}
    for cell in sorted(cells):
        for axis, side in itertools.product(range(3), (0, 1)):
            corners = square(cell, axis, side)
            squares.setdefault(frozenset(corners), []).append(corners)
    kept = [found[0] for found in squares.values() if len(found) == 1 or rng.random() < wall_share]
    quads = [[number.setdefault(corner, len(number)) for corner in square] for square in kept]
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    return (np.array(list(number), float) @ (turn * np.sign(np.linalg.det(turn)))).tolist(), quads


def prisms_with_window_and_fins():
    """(vertices, polygons, number of walls that close a prism on both sides, number of polygons that enclose nothing)"""
    vertices, polygon_list = prisms()
    edges = [frozenset(pair) for polygon in polygon_list for pair in zip(polygon, polygon[1:] + polygon[:1])]
    walls = [polygon for polygon in polygon_list if all(edges.count(frozenset(pair)) > 2
                                                     for pair in zip(polygon, polygon[1:] + polygon[:1]))]

    def inner(polygon, height=0.0):
        middle = np.mean([vertices[corner] for corner in polygon], axis=0) + [0, 0, height]
        vertices.extend(((np.array(vertices[corner]) + middle) / 2).tolist() for corner in polygon)
        return list(range(len(vertices) - len(polygon), len(vertices)))

    window = walls[0]
    ring = inner(window)
    polygon_list.remove(window)
    open_wall = [[window[k], window[(k + 1) % 4], ring[(k + 1) % 4], ring[k]] for k in range(4)]
    fins = []
    for hexagon in [polygon for polygon in polygon_list if len(polygon) == 6][::2]:
        top = inner(hexagon, 0.4 if vertices[hexagon[0]][2] == 0 else -0.4)
        fins.append([hexagon[0], hexagon[1], top[1], top[0]])
    used = sorted({corner for polygon in polygon_list + open_wall + fins for corner in polygon})
    number = {old: new for new, old in enumerate(used)}
    extended = [[number[corner] for corner in polygon] for polygon in polygon_list + open_wall + fins]
    return [vertices[old] for old in used], extended, 12 * 8 - len(prisms()[1]) - 1, len(open_wall) + len(fins)


def merged(*parts):
    """Several shapes as one, without joining anything."""
    vertex_offsets = np.cumsum([0] + [len(part.vertices) for part in parts])
    face_offsets = np.cumsum([0] + [part.face_count for part in parts])
    return Shape(
        np.vstack([part.vertices for part in parts]),
        np.vstack([part.triangles + offset for part, offset in zip(parts, vertex_offsets)]).astype(np.int32),
        np.concatenate([part.faces + offset for part, offset in zip(parts, face_offsets)]).astype(np.int32),
        int(face_offsets[-1]),
    )


HOUSE_VOLUME = 10 * 1.6 * 1.6 * 1.5


def house(across=7):
    """(vertices, quads) of a closed house of ten boxes with a chimney: 42 across^2 quads, as plain lists."""
    boxes = [(0, 0, 0), (1, 0, 0), (2, 0, 0), (3, 0, 0), (4, 0, 0), (1, 1, 0), (3, 1, 0), (3, 2, 0), (2, 0, 1), (2, 0, 2)]
    coarse = polycube(boxes)
    numbers, quads = {}, []
    for face in range(coarse.face_count):
        (a, b, c), (_, _, d) = coarse.triangles[coarse.faces == face]
        a, b, c, d = (coarse.vertices[corner].astype(int) * across for corner in (a, b, c, d))
        for i, j in itertools.product(range(across), repeat=2):
            corners = [a + ((b - a) * u + (d - a) * v) // across for u, v in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1))]
            quads.append([numbers.setdefault(tuple(corner.tolist()), len(numbers)) for corner in corners])
    return (np.array(list(numbers)) / across * (1.6, 1.6, 1.5)).tolist(), quads


PRISMS_VOLUME = 12 * 1.5 * 3 ** 0.5 * 0.5 ** 2 * 1.5


def prisms(columns=4, rows=3, radius=0.5, height=1.5):
    """(vertices, polygons) of hexagonal prisms side by side, as plain lists: what two have in common is there once."""
    numbers, vertices, index_of, known = {}, [], [], set()
    for column, row in itertools.product(range(columns), range(rows)):
        center = np.array([1.5 * column, 3 ** 0.5 * (row + column % 2 / 2)]) * radius
        ring = []
        for z in (0, height):
            for angle in np.arange(6) * np.pi / 3:
                place = *(center + radius * np.array([np.cos(angle), np.sin(angle)])), z
                if (key := tuple(np.round(place, 6))) not in numbers:
                    numbers[key] = len(vertices)
                    vertices.append([float(x) for x in place])
                ring.append(numbers[key])
        sides = [(ring[k], ring[(k + 1) % 6], ring[(k + 1) % 6 + 6], ring[k + 6]) for k in range(6)]
        for polygon in (ring[5::-1], ring[6:], *sides):
            if frozenset(polygon) not in known:
                known.add(frozenset(polygon))
                index_of.append(list(polygon))
    return vertices, index_of


def moved(shape, offset=(0, 0, 0), scale=1.0):
    return shape._replace(vertices=shape.vertices * scale + np.array(offset, float))


def turned_inside_out(shape):
    return shape._replace(triangles=np.ascontiguousarray(shape.triangles[:, ::-1]))


def split(shape, charts):
    """(the shape with a vertex of its own for each chart at it, (V,) the vertex that each was): charts (T,) of triangles,
    as glTF splits vertices where UVs or normals differ."""
    places, triangles = np.unique(np.column_stack([shape.triangles.ravel(), np.repeat(charts, 3)]), axis=0,
                                  return_inverse=True)
    was = places[:, 0]
    return shape._replace(vertices=shape.vertices[was], triangles=triangles.reshape(-1, 3).astype(np.int32)), was


def split_by_direction(shape):
    """split() where the axis changes that triangles face most, as box mapping has its seams."""
    corners = shape.vertices[shape.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    axis = abs(normals).argmax(axis=1)
    return split(shape, 2 * axis + (normals[np.arange(len(axis)), axis] > 0))


def split_everywhere(shape):
    """split() with every triangle separate."""
    return split(shape, np.arange(len(shape.triangles)))


def cube():
    return polycube([(0, 0, 0)])


def box_with_cavity():
    return merged(moved(cube(), scale=3.0), turned_inside_out(moved(cube(), offset=(1, 1, 1))))


def torus(n_around=24, across=10, radius=3.0, tube=1.0):
    """Quads, which are not flat: each is two triangles of one face."""
    u, v = np.meshgrid(np.arange(n_around) * 2 * np.pi / n_around, np.arange(across) * 2 * np.pi / across, indexing="ij")
    ring = radius + tube * np.cos(v)
    vertices = np.stack([ring * np.cos(u), ring * np.sin(u), tube * np.sin(v)], -1).reshape(-1, 3)
    quads = [
        (i * across + j, (i + 1) % n_around * across + j, (i + 1) % n_around * across + (j + 1) % across,
         i * across + (j + 1) % across)
        for i in range(n_around) for j in range(across)
    ]
    return polygons(vertices, quads)


def folded_torus(height, n_around=48):
    """A torus with a fold that crosses itself: two neighbors exchanged and lifted. Repair cuts it off."""
    shape = torus(n_around, across=24)
    outermost = int(shape.vertices[:, 0].argmax())
    neighbor = int(np.linalg.norm(shape.vertices - shape.vertices[outermost], axis=1).argsort()[1])
    shape.vertices[[outermost, neighbor]] = shape.vertices[[neighbor, outermost]] + np.array([height, 0, 0])
    return shape


def star(points=5, inner=0.2, depth=0.4):
    """A prism over a star: its arms are the parts. Its two lids are n-gons, cut into arms and a middle."""
    angles = np.arange(2 * points) * np.pi / points
    radii = np.where(np.arange(2 * points) % 2, inner, 1.0)
    # Rounded, for systems differ in a cosine's last bit, and of equal merges the last bits decide.
    rim = np.round(np.stack([radii * np.cos(angles), radii * np.sin(angles)], -1), 6)
    vertices = np.vstack([np.column_stack([rim, np.full(len(rim), z)]) for z in (0.0, depth)])
    n = 2 * points
    inner_ring = list(range(1, n, 2))
    lid = [(tip - 1 if tip else n - 1, tip, tip + 1) for tip in range(0, n, 2)]
    lid += [(inner_ring[0], second, third) for second, third in zip(inner_ring[1:], inner_ring[2:])]
    triangles = [(c, b, a) for a, b, c in lid] + [(a + n, b + n, c + n) for a, b, c in lid]
    faces = [0] * len(lid) + [1] * len(lid)
    for i in range(n):
        j = (i + 1) % n
        triangles += [(i, j, j + n), (i, j + n, i + n)]
        faces += [2 + i] * 2
    return Shape(vertices, np.array(triangles, np.int32), np.array(faces, np.int32), n + 2)


def off(name):
    """A real mesh with its polygons."""
    from partwheel import meshes

    mesh = meshes.read(MESHES / f"{name}.off")
    return Shape(mesh.vertices, mesh.triangles, mesh.faces, mesh.face_count)


SHAPES = {
    "tetrahedron": lambda: polygons([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)],
                                    [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]),
    "cube": cube,
    "bar": lambda: polycube([(x, 0, 0) for x in range(4)]),
    "L": lambda: polycube([(0, 0, 0), (1, 0, 0), (2, 0, 0), (0, 1, 0), (0, 2, 0)]),
    "jack": lambda: polycube([(0, 0, 0)] + [tuple(s * (i == a) for i in range(3)) for a in range(3) for s in (-1, 1)]),
    "frame": lambda: polycube([(x, y, 0) for x in range(3) for y in range(3) if (x, y) != (1, 1)]),
    "box with a cavity": box_with_cavity,
    "three cubes apart": lambda: merged(cube(), moved(cube(), (3, 0, 0)), moved(cube(), (0.25, 0.5, 7), 0.5)),
    "star": star,
    "torus": torus,
    "3torus.off": lambda: off("3torus"),
    "P.off": lambda: off("P"),
    "dragknob.off": lambda: off("dragknob"),
    "hand.off": lambda: off("hand"),
}
