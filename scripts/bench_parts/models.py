"""Models for benchmarks: real ones, and generated shapes. Generated coordinates are rounded to single precision, as in
Blender; this also avoids exactly regular input, on which TetGen is very slow.

A mesh is (vertices (V,3) float64, triangles (T,3) int), closed and counter-clockwise seen from outside.
"""

import os
import sys
from pathlib import Path

import numpy as np
from programs import ROOT, WORK, Failure
from scipy.spatial import ConvexHull, Delaunay, cKDTree

sys.path += [str(ROOT / "native" / "python"), str(ROOT / "tests" / "core")]

from shapes import polycube  # noqa: E402

from partwheel import meshes  # noqa: E402

DEMO = ROOT / "build" / "deps" / "meshes"  # of CGAL's demos
PSB = Path(os.environ.get("PARTWHEEL_PSB", ROOT / "build" / "deps" / "psb")) / "off"  # as setup_psb leaves it
NATURAL = DEMO / "bear.off"  # the model that is subdivided; 27,648 faces
SEED = 1


def real_models(low, high):
    """(OFF files of all real models with low to high faces, smallest first; name of their source)"""
    if PSB.exists():
        files, source = sorted(PSB.glob("*.off")), "the Princeton Segmentation Benchmark"
    else:
        files = sorted(DEMO.glob("*.off"))
        source = "libcgal-demo, because the Princeton Segmentation Benchmark is not available"
    sizes = [(face_count(file), file) for file in files]
    return [file for faces, file in sorted(sizes) if low <= faces <= high], source


def evenly_spaced(files, count):
    """At most count of the files, evenly spaced from the first to the last."""
    if len(files) <= count:
        return files
    return [files[round(i * (len(files) - 1) / (count - 1))] for i in range(count)]


def face_count(path):
    """The number of faces in an OFF file; 0 for any other file."""
    with open(path) as file:
        words = file.readline().split() + file.readline().split()
    return int(words[2]) if words[0] == "OFF" and len(words) > 2 and words[2].isdigit() else 0


def read(path):
    """(vertices, triangles) of a mesh file."""
    return meshes.read(path)[:2]


def write(name, mesh):
    """Writes an OFF file with coordinates rounded to single precision; returns its path."""
    vertices, triangles = mesh
    WORK.mkdir(parents=True, exist_ok=True)
    path = WORK / f"{name}.off"
    with open(path, "w") as file:
        file.write(f"OFF\n{len(vertices)} {len(triangles)} 0\n")
        np.savetxt(file, vertices.astype(np.float32), fmt="%.9g")
        np.savetxt(file, np.column_stack([np.full(len(triangles), 3), triangles]), fmt="%d")
    return path


# ---- A natural model at any resolution


def subdivide(mesh, faces):
    """The mesh, subdivided to this number of faces by bisecting the longest edges first. New vertices lie on the PN
    triangles of Vlachos et al. 2001, so that the surface stays smooth and no faces become coplanar."""
    vertices, triangles = np.array(mesh[0], float), np.array(mesh[1], int)
    while len(triangles) < faces:
        normals = vertex_normals(vertices, triangles)
        half = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2)  # edges: from corner k to k + 1
        length = np.linalg.norm(vertices[half[:, :, 0]] - vertices[half[:, :, 1]], axis=2)
        ends = np.sort(half, axis=2)
        key = ends[:, :, 0] * len(vertices) + ends[:, :, 1]
        # The longest edge of each triangle, ties broken by its vertices. Edges that are the longest of both their
        # triangles can be bisected independently.
        corner = np.lexsort((key, length), axis=1)[:, -1]
        longest_edge = key[np.arange(len(triangles)), corner]
        order = np.argsort(longest_edge, kind="stable")
        shared = np.flatnonzero(longest_edge[order][1:] == longest_edge[order][:-1])
        first, second = order[shared], order[shared + 1]
        longest = np.argsort(-length[first, corner[first]], kind="stable")[:(faces - len(triangles)) // 2]
        if not len(longest):
            raise Failure("a model with an odd number of faces can't be subdivided to an even one, or the reverse")
        first, second = first[longest], second[longest]
        a, b = triangles[first, corner[first]], triangles[first, (corner[first] + 1) % 3]
        along = vertices[b] - vertices[a]
        rise, fall = ((along * normals[end]).sum(1)[:, None] * normals[end] for end in (a, b))
        middle = len(vertices) + np.arange(len(first))
        vertices = np.vstack([vertices, (vertices[a] + vertices[b]) / 2 - (rise - fall) / 8])
        added = []
        for t in (first, second):
            k = corner[t]
            start, end, opposite = triangles[t, k], triangles[t, (k + 1) % 3], triangles[t, (k + 2) % 3]
            triangles[t] = np.column_stack([start, middle, opposite])
            added.append(np.column_stack([middle, end, opposite]))
        triangles = np.vstack([triangles, *added])
    return vertices, triangles


def vertex_normals(vertices, triangles):
    """(V, 3) unit normals, averaged by area."""
    a, b, c = vertices[triangles].transpose(1, 0, 2)
    normals = np.zeros_like(vertices)
    for k in range(3):
        np.add.at(normals, triangles[:, k], np.cross(b - a, c - a))
    return normals / np.linalg.norm(normals, axis=1)[:, None]


def crossed(path, faces):
    """A model subdivided to nearly this number of faces, with seven round holes and a smaller copy of the original through it."""
    copy = read(path)
    vertices, triangles = subdivide(copy, faces - len(copy[1]))
    middles, size = vertices[triangles].mean(axis=1), np.ptp(vertices, axis=0).max()
    centers = middles[np.random.default_rng(SEED).choice(len(middles), 7, replace=False)]
    distances, _ = cKDTree(centers).query(middles)
    shrunk = 0.5 * copy[0][:, [1, 2, 0]] + vertices.mean(axis=0) - 0.5 * copy[0][:, [1, 2, 0]].mean(axis=0)
    return np.vstack([vertices, shrunk]), np.vstack([triangles[distances > 0.02 * size], copy[1] + len(vertices)])


# ---- Worst cases


def ball(faces):
    """The convex hull of random points on a sphere: every union is nearly convex, and all costs are nearly 0."""
    points = np.random.default_rng(SEED).normal(size=(faces // 2 + 2, 3))
    return hull(round_to_single(points / np.linalg.norm(points, axis=1)[:, None]))


def strip(faces):
    """A wavy ribbon, a thousand times as long as wide."""
    rings = faces // 8 + 1
    t = np.linspace(0, 1000, rings)
    wave = np.sin(t / 7)
    section = np.array([[-0.5, 0], [0, -0.1], [0.5, 0], [0, 0.1]])
    vertices = np.stack([np.column_stack([t, wave + y, 0.3 * np.cos(t / 5) + z]) for y, z in section], axis=1)
    return tube(jitter(vertices.reshape(-1, 3), 1e-4), rings, len(section))


def box(faces):
    """A cube with random points on its sides: irregular and exactly coplanar. Convex unions of tetrahedra cost exactly
    0, and there are very many of them."""
    random = np.random.default_rng(SEED)
    # Two sides share the points on their edge, so that the sides match; V - 2 = F / 2.
    n = faces // 2 + 2 - 8
    on_edge = max(1, int(np.sqrt(n) / 10))
    points = [corner for corner in np.ndindex(2, 2, 2)]
    for axis in range(3):
        for ends in np.ndindex(2, 2):
            for along in random.uniform(size=on_edge):
                points.append(np.insert(np.array(ends, float), axis, along))
    inside = n - 12 * on_edge
    for i in range(inside):
        side = i % 6
        points.append(np.insert(random.uniform(size=2), side % 3, side // 3))
    points = round_to_single(np.array(points, float))
    triangles = []
    for axis in range(3):
        for end in (0, 1):
            on = np.flatnonzero(points[:, axis] == end)
            u, v = (axis + 1) % 3, (axis + 2) % 3
            flat = Delaunay(points[on][:, [u, v]]).simplices
            p = points[on][:, [u, v]][flat]
            cross = ((p[:, 1, 0] - p[:, 0, 0]) * (p[:, 2, 1] - p[:, 0, 1])
                     - (p[:, 1, 1] - p[:, 0, 1]) * (p[:, 2, 0] - p[:, 0, 0]))
            flat[(cross > 0) != (end == 1)] = flat[(cross > 0) != (end == 1)][:, ::-1]
            triangles.append(on[flat[cross != 0]])
    return points, np.vstack(triangles)


def comb(faces):
    """A bar with hundreds of teeth: one cluster with very many neighbors."""
    height = 12
    teeth = max(2, round(faces / (8 * height + 14)))  # each with its section of the bar
    bar = {(x, 0, 0) for x in range(2 * teeth + 1)}
    surface = polycube(bar | {(x, 0, z) for x in range(1, 2 * teeth, 2) for z in range(1, height + 1)})
    return jitter(surface.vertices, 1e-3), surface.triangles


def porous(faces):
    """A cube with hundreds of cavities, each a ball of 80 faces."""
    side = max(2, round((faces / 80) ** (1 / 3)))
    corners = np.array(list(np.ndindex(2, 2, 2)), float)
    vertices, triangles = hull(corners * side)
    vertices, triangles = [vertices], [triangles]
    ball_vertices, ball_triangles = ball(80)
    random = np.random.default_rng(SEED)
    for index in np.ndindex(side, side, side):
        turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
        turn *= np.linalg.det(turn)
        triangles.append(ball_triangles[:, ::-1] + sum(map(len, vertices)))
        vertices.append(0.35 * ball_vertices @ turn + np.array(index) + 0.5)
    return np.vstack(vertices), np.vstack(triangles)


def jitter(vertices, amount):
    """The vertices, each coordinate moved randomly by at most this amount."""
    return vertices + np.random.default_rng(SEED).uniform(-amount, amount, vertices.shape)


def round_to_single(vertices):
    """The vertices rounded to single precision, before exact shapes are built from them."""
    return vertices.astype(np.float32).astype(float)


def hull(points):
    """The convex hull of points in convex position."""
    qhull = ConvexHull(points)
    triangles = qhull.simplices.copy()
    a, b, c = (points[triangles[:, k]] for k in range(3))
    inward = (np.cross(b - a, c - a) * qhull.equations[:, :3]).sum(1) < 0
    triangles[inward] = triangles[inward][:, ::-1]
    used_vertices, index = np.unique(triangles, return_inverse=True)
    return points[used_vertices], index.reshape(triangles.shape)


def tube(vertices, rings, across):
    """Consecutive rings of `across` vertices each, connected, and closed by a fan at each end."""
    ring, k = np.meshgrid(np.arange(rings - 1), np.arange(across), indexing="ij")
    a, b = ring * across + k, ring * across + (k + 1) % across
    c, d = a + across, b + across
    sides = np.concatenate([np.stack([a, b, d], -1), np.stack([a, d, c], -1)], axis=2).reshape(-1, 3)
    fan = np.array([[0, k + 1, k] for k in range(1, across - 1)])
    triangles = np.vstack([sides, fan, fan[:, ::-1] + (rings - 1) * across])
    return vertices, triangles if np.linalg.det(vertices[triangles]).sum() > 0 else triangles[:, ::-1]
