# SPDX-License-Identifier: GPL-3.0-or-later
"""Solids with openings, made by manifold3d, and how much of their openings hulls leave free."""

from typing import NamedTuple

import numpy as np
from manifold3d import CrossSection, Manifold
from scipy.spatial import ConvexHull

SAMPLES = 4_000  # of a model's openings


class OpenModel(NamedTuple):
    vertices: np.ndarray
    triangles: np.ndarray
    openings: np.ndarray  # (n, 3), points in the passages
    exact: int  # convex pieces that the model was made of; 0 if round


def box(low, high):
    return Manifold.cube(np.subtract(high, low).tolist()).translate(list(low))


def prism(sides, radius, low, high, center=(0, 0)):
    """A prism along z around a regular polygon, of which two sides are along y."""
    turn = np.pi / sides + 2 * np.pi / sides * np.arange(sides)
    polygon = radius * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    return CrossSection([polygon]).extrude(high - low).translate([*center, low])


def points_in(solid, count=SAMPLES):
    """Random points in a convex solid."""
    low, high = np.reshape(solid.bounding_box(), (2, 3))
    mesh = solid.to_mesh64()
    corners = np.asarray(mesh.vert_properties)[:, :3][np.asarray(mesh.tri_verts)]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    points = np.random.default_rng(0).uniform(low, high, (2 * count, 3))
    for corner, normal in zip(corners[:, 0], normals):
        points = points[(points - corner) @ normal <= 0]
    return points[:count]


def model(pieces, cuts=(), passages=(), exact=0):
    """pieces less cuts. passages: convex solids, by default the cuts."""
    solid = pieces[0]
    for piece in pieces[1:]:
        solid += piece
    for cut in cuts:
        solid -= cut
    mesh = solid.to_mesh64()
    openings = [points_in(passage) for passage in passages or cuts]
    volumes = [passage.volume() for passage in passages or cuts]
    shares = [points[:max(1, round(SAMPLES * volume / sum(volumes)))] for points, volume in zip(openings, volumes)]
    return OpenModel(np.asarray(mesh.vert_properties, float)[:, :3], np.asarray(mesh.tri_verts, np.int32),
                     np.concatenate(shares), exact)


def house():
    """A slab and four walls of ten boxes, with a door and a window."""
    walls = box((0, 0, 0), (8, 6, 3)) - box((0.3, 0.3, -1), (7.7, 5.7, 4))
    door, window = box((3, 0, 0), (4, 0.3, 2)), box((3, 5.7, 1), (5, 6, 2.2))
    return model([box((-0.5, -0.5, -0.2), (8.5, 6.5, 0)), walls], [door, window], exact=10)


def plate(sides):
    """A plate with two holes, regular polygons."""
    holes = [prism(sides, 1, 0, 0.5, (x, 3)) for x in (3, 7)]
    return model([box((0, 0, 0), (10, 6, 0.5))], holes)


def stall():
    """A counter, two posts and a roof."""
    pieces = [box((0, 0, 0), (4, 1, 1)), box((0, 0, 1), (0.2, 0.2, 3)), box((3.8, 0, 1), (4, 0.2, 3)),
              box((-0.2, -0.3, 3), (4.2, 1.3, 3.2))]
    return model(pieces, passages=[box((0.2, 0, 1), (3.8, 0.2, 3))], exact=4)


def frame():
    """A window frame with a cross."""
    panes = [box((x, 0, z), (x + 1.2, 0.15, z + 1.4)) for x in (0.2, 1.6) for z in (0.2, 1.8)]
    return model([box((0, 0, 0), (3, 0.15, 3.4))], panes, exact=7)


def ring():
    """A square bar bent into a polygon of 16 sides."""
    return model([prism(16, 1, 0, 0.2)], [prism(16, 0.8, 0, 0.2)], exact=16)


def stairs():
    """Treads between two stringers, open behind."""
    pieces = [box((0, 0, 0), (0.1, 3, 0.2)).rotate([45, 0, 0]), box((1.9, 0, 0), (2, 3, 0.2)).rotate([45, 0, 0])]
    treads = [box((0.1, 0.35 * i + 0.1, 0.35 * i + 0.2), (1.9, 0.35 * i + 0.4, 0.35 * i + 0.25)) for i in range(6)]
    passages = [box((0.1, 0.35 * i + 0.2, 0.35 * i + 0.28), (1.9, 0.35 * i + 0.35, 0.35 * i + 0.52)) for i in range(5)]
    return model(pieces + treads, passages=passages, exact=8)


def arcade():
    """A wall with three round arches."""
    arches = [box((x - 0.6, -0.1, -0.1), (x + 0.6, 0.5, 1.4)) for x in (1, 2.6, 4.2)]
    rounds = [prism(12, 0.6, -0.5, 0.1).rotate([90, 0, 0]).translate([x, 0, 1.4]) for x in (1, 2.6, 4.2)]
    return model([box((0, 0, 0), (5.2, 0.4, 2.5))], arches + rounds,
                 passages=[box((x - 0.6, 0, 0), (x + 0.6, 0.4, 1.4)) for x in (1, 2.6, 4.2)])


def shelf():
    """Two sides and four boards, without a back."""
    pieces = [box((0, 0, 0), (0.1, 1, 4)), box((2.9, 0, 0), (3, 1, 4))]
    boards = [box((0.1, 0, z), (2.9, 1, z + 0.1)) for z in (0.2, 1.4, 2.6, 3.9)]
    passages = [box((0.1, 0, low), (2.9, 1, high)) for low, high in ((0.3, 1.4), (1.5, 2.6), (2.7, 3.9))]
    return model(pieces + boards, passages=passages, exact=6)


def gear():
    """A disk with twelve teeth and a hole."""
    teeth = [box((0.9, -0.12, 0), (1.25, 0.12, 0.3)).rotate([0, 0, 30 * i]) for i in range(12)]
    return model([prism(24, 1, 0, 0.3), *teeth], [prism(24, 0.4, 0, 0.3)])


def tube(sides=8):
    return model([prism(sides, 1, 0, 2)], [prism(sides, 0.9, 0, 2)], exact=sides)


def beaker(sides=16):
    return model([prism(sides, 1, 0, 2)], [prism(sides, 0.9, 0.1, 2)], exact=sides + 1)


def open_box():
    return model([box((-1, -1, 0), (1, 1, 2))], [box((-0.9, -0.9, 0.1), (0.9, 0.9, 2))], exact=5)


def bowl(segments=24):
    def half(radius):
        return Manifold.sphere(radius, segments).trim_by_plane([0, 0, -1], 0)
    return model([half(1)], [half(0.9)])


def dented_ball(segments=150):
    """With dents and bumps all over, finer than a coarse copy."""
    ball = Manifold.sphere(1, segments).to_mesh64()
    points = np.asarray(ball.vert_properties)[:, :3]
    points = points * (1 + 0.1 * np.sin(9 * points).prod(axis=1, keepdims=True))
    return OpenModel(points, np.asarray(ball.tri_verts, np.int32), np.empty((0, 3)), 0)


MODELS = {"stall": stall, "frame": frame, "ring": ring, "stairs": stairs, "arcade": arcade, "shelf": shelf, "gear": gear}


def covered(hulls, points, tolerance=1e-6):
    """Which points are inside a hull, by its half-spaces from scipy; hulls: corners of each."""
    inside = np.zeros(len(points), bool)
    for corners in hulls:
        planes = ConvexHull(corners, qhull_options="QJ").equations
        inside |= (points @ planes[:, :3].T + planes[:, 3] < -tolerance).all(axis=1)
    return inside


def volume_ratio(hulls, shape):
    """The sum of the hulls' volumes over the solid's."""
    a, b, c = (shape.vertices[shape.triangles[:, k]] for k in range(3))
    solid = np.einsum("ij,ij->i", np.cross(a, b), c).sum() / 6
    return sum(ConvexHull(corners, qhull_options="QJ").volume for corners in hulls) / solid
