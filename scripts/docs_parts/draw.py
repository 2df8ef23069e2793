# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws images for the docs: a truck taken apart, the wheel on a hand, convex parts, fill methods, parts for a 3D printer,
and the paper's figure 9.

usage: draw.py MESHES IMAGES NAME...     NAME: one of IMAGES_BY_NAME. Needs numpy, scipy, Pillow, manifold3d.
"""

import sys
from pathlib import Path

import numpy as np
from PIL import Image

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "native" / "python"), str(ROOT / "tests" / "quality")]

from pictures import GRAY, View, picture_of_part  # noqa: E402

from partwheel import FillMethod, Hierarchy, Mode, meshes  # noqa: E402
from partwheel.appearance import to_srgb  # noqa: E402
from partwheel.cut import Cut, colors, printing  # noqa: E402
from partwheel.examples import EXAMPLES  # noqa: E402

FRONT, UP = (0.5, -1, 0.2), (0, 0, 1)
# The figure's fingertip, finger, hand, arm and body: about these fractions of the area.
STOPS = 0.0011, 0.0048, 0.055, 0.128, 1.0
CLOSE_UP = 0.03  # stops with a smaller fraction fill the image
PARTS = 12


def read(folder, name):
    """A mesh: an example's or a file's."""
    if name not in EXAMPLES:
        return meshes.read(folder / f"{name}.off")
    example = EXAMPLES[name]()
    faces = np.repeat(np.arange(len(example.polygons)), [len(polygon) - 2 for polygon in example.polygons])
    return meshes.Mesh(example.vertices, example.triangles, faces, len(example.polygons), 0)


def draw_bodies(bodies, size, towards=FRONT, up=UP, paint=None):
    """An image of bodies [(vertices, triangles), ...]. paint: a color for each triangle; by default, each body has its own, and
    a single one is gray."""
    counts = np.cumsum([0] + [len(vertices) for vertices, _ in bodies])
    triangles = np.concatenate([triangles + first for (_, triangles), first in zip(bodies, counts)])
    mesh = meshes.triangle_mesh(np.concatenate([vertices for vertices, _ in bodies]), triangles)
    if paint is None:
        paint = np.repeat(colors(np.arange(len(bodies))) if len(bodies) > 1 else np.array([GRAY]),
                          [len(triangles) for _, triangles in bodies], axis=0)
    return View(mesh, towards, up, size).painted(paint)


def explode(bodies, middle, factor):
    """The bodies, each moved away from the middle by this factor of its distance."""
    return [(vertices + factor * (vertices.mean(axis=0) - middle), triangles) for vertices, triangles in bodies]


def save(cells, path):
    """Saves a grid of images of the same size. cells: rows of images."""
    image = np.concatenate([np.concatenate(row, axis=1) for row in cells])
    Image.fromarray((255 * image).astype(np.uint8)).save(path, quality=88)


def truck(folder, images):
    """The example truck in its own colors, its automatic parts, and their solids, moved apart, in those colors."""
    example, mesh = EXAMPLES["truck"](), read(folder, "truck")
    paint = to_srgb(np.array(list(example.materials.values())))[example.material_of_polygon]
    cut = Cut.automatic(Hierarchy.build(*mesh[:4]))
    solids = [solid for solid in cut.solids() if solid]
    view = View(mesh, FRONT, UP, 300)
    save([[view.painted(paint), view.painted(colors(cut.labels)),
           draw_bodies(explode([solid[:2] for solid in solids], mesh.vertices.mean(axis=0), 0.4), 300,
                       paint=np.concatenate([paint[solid.source_faces] for solid in solids]))]], images / "truck.jpg")


def wheel(folder, images):
    """Wheel stops of a click on the example figure's fingertip, small ones in close-ups."""
    mesh = read(folder, "figure")
    hierarchy = Hierarchy.build(*mesh[:4])
    fingertip = mesh.faces[mesh.vertices[mesh.triangles].mean(axis=1)[:, 0].argmax()]
    stops, _ = hierarchy.wheel(int(fingertip))
    fractions = hierarchy.area[stops] / hierarchy.area[-1]
    cells = []
    for fraction in STOPS:
        stop = stops[np.abs(np.log(fractions / fraction)).argmin()]
        part = mesh.vertices[mesh.triangles[np.isin(mesh.faces, hierarchy.faces(stop))]].reshape(-1, 3)
        focus = part.mean(axis=0) + 2.6 * (part - part.mean(axis=0)) if fraction < CLOSE_UP else None
        cells.append(picture_of_part(View(mesh, FRONT, UP, 300, focus), hierarchy, stop))
    save([cells], images / "wheel.jpg")


def parts(folder, images):
    """Two examples and their dendrograms, each cut into many, some and few convex parts."""
    rows = []
    for name, counts in (("figure", (96, 24, 8)), ("truck", (24, 12, 6))):
        mesh = read(folder, name)
        hierarchy = Hierarchy.build(*mesh[:4])
        cuts = [hierarchy.cut_parts(count) for count in counts]
        rows.append([draw_bodies([(mesh.vertices, mesh.triangles)], 300), *(
            draw_bodies([hierarchy.hull_of_slice(*pair) for pair in zip(bounds, bounds[1:])], 300) for bounds in cuts)])
    save(rows, images / "parts.jpg")


def fill_methods(folder, images):
    """The figure's parts: filled exactly, from points, and found on a copy with a tenth of the triangles."""
    mesh = read(folder, "figure")
    labels = []
    for options in ({}, {"fill_methods": FillMethod.POINTS}, {"exact_triangles": 4 * len(mesh.triangles) // 10}):
        hierarchy = Hierarchy.build(*mesh[:4], **options)
        labels.append(hierarchy.face_labels(hierarchy.cut_parts(PARTS)))
    view = View(mesh, FRONT, UP, 300)
    save([[view.painted(colors(match_labels(labels[0], other))) for other in labels]], images / "fill_methods.jpg")


def convex(folder, images):
    """A dinosaur (by Quaternius, CC0), and its 4, 12 and 32 convex parts."""
    mesh = read(folder, "Trex")
    hierarchy = Hierarchy.build(*mesh[:4])
    hulls = [[hull[:2] for hull in hierarchy.convex_parts(count)] for count in (4, 12, 32)]
    save([[draw_bodies(bodies, 420) for bodies in [[(mesh.vertices, mesh.triangles)], *hulls]]], images / "convex.jpg")


def printing_(folder, images):
    """The example figure's automatic parts with pegs and sockets, moved apart."""
    mesh = read(folder, "figure")
    cut = Cut.automatic(Hierarchy.build(*mesh[:4]))
    scale = 200 / np.ptp(mesh.vertices, axis=0).max()
    printable = printing.prepare_parts(cut, mesh.vertices, mesh.triangles, mesh.faces, printing.PrintOptions(scale, 0.2))
    middle = np.mean([vertices.mean(axis=0) for vertices, _ in printable.solids.values()], axis=0)
    save([[draw_bodies(explode(printable.solids.values(), middle, 0.9), 700)]], images / "printing.jpg")


def recipe_godot(folder, images):
    """The example chair, and its 9 convex hulls, moved apart."""
    mesh = read(folder, "chair")
    hulls = [hull[:2] for hull in Hierarchy.build(*mesh[:4]).convex_parts(9)]
    rows = [(mesh.vertices, mesh.triangles)], hulls, explode(hulls, mesh.vertices.mean(axis=0), 0.5)
    save([[draw_bodies(bodies, 420) for bodies in rows]], images / "recipe-godot.jpg")


def figure9(folder, images):
    """The paper's figure 9: two models in PARTS parts, in mode "paper" and the default mode, without and with points added inside."""
    rows = []
    for name, *camera in (("figure", FRONT, UP), ("dino", (1, -0.4, 0.2), (0, 0, 1))):
        mesh = read(folder, name)
        row = [draw_bodies([(mesh.vertices, mesh.triangles)], 300, *camera)]
        for mode in (Mode.PAPER, Mode.LEARNED):
            labels = []
            for quality in (0, 1.4):
                hierarchy = Hierarchy.build(*mesh[:4], mode=mode, quality=quality)
                bounds = hierarchy.cut_least_concavity(PARTS) if mode is Mode.PAPER else hierarchy.cut_parts(PARTS)
                labels.append(hierarchy.face_labels(bounds))
                print(f"{name}, {mode.name.lower()}, quality {quality}: {len(hierarchy.tetrahedra):,} tetrahedra, "
                      f"{len(hierarchy.tetrahedra) / len(mesh.triangles):.2f} a triangle")
            one, other = labels
            other = match_labels(one, other)
            row += [View(mesh, *camera, 300).painted(colors(part)) for part in (one, other)]
            print(f"   faces in the same part of both: {np.mean(one == other):.0%}")
        rows.append(row)
    save(rows, images / "figure9.jpg")


def match_labels(one, other):
    """The labels `other`, renumbered so that as many faces as possible have the same label as in `one`."""
    from scipy.optimize import linear_sum_assignment
    size = max(one.max(), other.max()) + 1
    common = np.zeros((size, size), int)
    np.add.at(common, (other, one), 1)
    return linear_sum_assignment(-common)[1][other]


IMAGES_BY_NAME = {"truck": truck, "wheel": wheel, "parts": parts, "fill_methods": fill_methods, "convex": convex,
                  "printing": printing_, "recipe-godot": recipe_godot, "figure9": figure9}

if __name__ == "__main__":
    for name in sys.argv[3:]:
        IMAGES_BY_NAME[name](*map(Path, sys.argv[1:3]))
