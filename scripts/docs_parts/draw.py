# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws images for the docs: convex parts, parts for a 3D printer, and the paper's figures 4 and 9.

usage: draw.py MESHES IMAGES NAME...     NAME: convex, printing, recipe-godot, figure4, figure9. Needs numpy, scipy,
Pillow, manifold3d.
"""

import sys
from pathlib import Path

import numpy as np
from PIL import Image
from scipy.spatial import ConvexHull

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "native" / "python"), str(ROOT / "tests" / "quality")]

from pictures import GRAY, View  # noqa: E402

from partwheel import Hierarchy, Mode, meshes  # noqa: E402
from partwheel.cut import Cut, colors, printing  # noqa: E402
from partwheel.examples import EXAMPLES  # noqa: E402

FRONT, UP = (0.5, -1, 0.2), (0, 0, 1)
PARTS = 12


def read(folder, name):
    """A mesh: an example's or a file's."""
    if name not in EXAMPLES:
        return meshes.read(folder / f"{name}.off")
    example = EXAMPLES[name]()
    return meshes.triangle_mesh(example.vertices, example.triangles)


def draw_bodies(bodies, size, towards=FRONT, up=UP):
    """An image of bodies [(vertices, triangles), ...], each in a different color; a single one in gray."""
    counts = np.cumsum([0] + [len(vertices) for vertices, _ in bodies])
    triangles = np.concatenate([triangles + first for (_, triangles), first in zip(bodies, counts)])
    mesh = meshes.triangle_mesh(np.concatenate([vertices for vertices, _ in bodies]), triangles)
    paint = colors(np.arange(len(bodies))) if len(bodies) > 1 else np.array([GRAY])
    body_of_triangle = np.repeat(np.arange(len(bodies)), [len(triangles) for _, triangles in bodies])
    return View(mesh, towards, up, size).painted(paint[body_of_triangle])


def explode(bodies, middle, factor):
    """The bodies, each moved away from the middle by this factor of its distance."""
    return [(vertices + factor * (vertices.mean(axis=0) - middle), triangles) for vertices, triangles in bodies]


def save(cells, path):
    """Saves a grid of images of the same size. cells: rows of images."""
    image = np.concatenate([np.concatenate(row, axis=1) for row in cells])
    Image.fromarray((255 * image).astype(np.uint8)).save(path, quality=88)


def convex(folder, images):
    """A dinosaur (by Quaternius, CC0), and its 4, 12 and 32 convex parts."""
    mesh = read(folder, "Trex")
    hierarchy = Hierarchy.build(mesh.vertices, mesh.triangles)
    hulls = [[hull[:2] for hull in hierarchy.convex_parts(count)] for count in (4, 12, 32)]
    save([[draw_bodies(bodies, 420) for bodies in [[(mesh.vertices, mesh.triangles)], *hulls]]], images / "convex.jpg")


def printing_(folder, images):
    """The example figure's automatic parts with pegs and sockets, moved apart."""
    mesh = read(folder, "figure")
    cut = Cut.automatic(Hierarchy.build(mesh.vertices, mesh.triangles))
    scale = 200 / np.ptp(mesh.vertices, axis=0).max()
    printable = printing.prepare_parts(cut, mesh.vertices, mesh.triangles, mesh.faces, printing.PrintOptions(scale, 0.2))
    middle = np.mean([vertices.mean(axis=0) for vertices, _ in printable.solids.values()], axis=0)
    save([[draw_bodies(explode(printable.solids.values(), middle, 0.9), 700)]], images / "printing.jpg")


def recipe_godot(folder, images):
    """The example chair, and its 9 convex hulls, moved apart."""
    mesh = read(folder, "chair")
    hulls = [hull[:2] for hull in Hierarchy.build(mesh.vertices, mesh.triangles).convex_parts(9)]
    rows = [(mesh.vertices, mesh.triangles)], hulls, explode(hulls, mesh.vertices.mean(axis=0), 0.5)
    save([[draw_bodies(bodies, 420) for bodies in rows]], images / "recipe-godot.jpg")


# ---- The paper's figures


def figure4(_, images):
    """The tree of a simple shape before and after Listing 2: three tetrahedra around an axis, where the paper has three
    triangles around a point. Heights are concavities (Eq. 1)."""
    angles = np.arange(3) * 2 * np.pi / 3
    vertices = np.vstack([np.column_stack([np.cos(angles), np.sin(angles), 0 * angles]), [(0, 0, 0.3), (0, 0, -0.3)]])
    triangles = [(a, (a + 1) % 3, 3) for a in range(3)] + [((a + 1) % 3, a, 4) for a in range(3)]
    hierarchy = Hierarchy.build(vertices, np.array(triangles), mode=Mode.PAPER)
    merged = dict(enumerate(hierarchy.merges.tolist(), len(hierarchy.tetrahedra)))
    pruned = {}
    for node, parent in enumerate(hierarchy.parent[:-1].tolist()):
        pruned.setdefault(parent, []).append(node)

    def leaves(children, node):
        return [leaf for child in children[node] for leaf in leaves(children, child)] if node in children else [node]

    def concavity(children, node):
        corners = hierarchy.vertices[hierarchy.tetrahedra[leaves(children, node)]]
        return abs(ConvexHull(corners.reshape(-1, 3)).volume - np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1])).sum() / 6)

    highest = max(concavity(merged, node) for node in merged)

    def draw_tree(children, left, title):
        def place(node):
            below = [place(child) for child in children.get(node, [])]
            x = np.mean([place[0] for place in below]) if below else left + 40 + 110 * leaves(children, top).index(node)
            # A node at the height of its children is drawn a little above them, so that the lines are visible.
            level = 1 + max(place[1] for place in below) if below else 0
            height = concavity(children, node)
            y = 250 - 150 * height / highest - 24 * level
            marks[:0] = [f'<path d="M{x:.0f} {y:.0f} L{place[0]:.0f} {place[2]:.0f}" stroke="#888" stroke-width="2"/>' for place in below]
            label = "".join(str(leaf + 1) for leaf in sorted(leaves(children, node)))
            marks.extend([f'<circle cx="{x:.0f}" cy="{y:.0f}" r="6" fill="{"#e07b00" if height > 1e-9 else "#607d8b"}"/>',
                          f'<text x="{x + 11:.0f}" y="{y + 5:.0f}">{label}: {height:.3f}</text>'])
            return x, level, y

        marks, top = [f'<text x="{left + 40}" y="300">{title}</text>'], max(children)
        place(top)
        return marks

    marks = draw_tree(merged, 0, "the binary tree: node, concavity") + draw_tree(pruned, 380, "after Listing 2")
    (images / "figure4.svg").write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 760 320" font-family="sans-serif" font-size="14">\n'
        '<rect width="760" height="320" fill="#fff"/>\n' + "\n".join(marks) + "\n</svg>\n")


def figure9(folder, images):
    """Two models in PARTS parts, in mode "paper" and the default mode, without and with points added inside."""
    rows = []
    for name, *camera in (("figure", FRONT, UP), ("dino", (1, -0.4, 0.2), (0, 0, 1))):
        mesh = read(folder, name)
        row = [draw_bodies([(mesh.vertices, mesh.triangles)], 300, *camera)]
        for mode in (Mode.PAPER, Mode.LEARNED):
            labels = []
            for quality in (0, 1.4):
                hierarchy = Hierarchy.build(mesh.vertices, mesh.triangles, mode=mode, quality=quality)
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


if __name__ == "__main__":
    draw = {"convex": convex, "printing": printing_, "recipe-godot": recipe_godot, "figure4": figure4, "figure9": figure9}
    for name in sys.argv[3:]:
        draw[name](*map(Path, sys.argv[1:3]))
