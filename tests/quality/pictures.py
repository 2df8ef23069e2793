# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws what is selected: the automatic cut in colors, from both sides, and what the wheel goes through after a click.

usage: pictures.py OUT MODEL [--view X Y Z] [--up X Y Z] [--click X Y]... [--apart SHARE] [--sheet] [--mode paper] [--size 360]
                   [--columns 7]

OUT: an image file. MODEL: a mesh file. --view: from where it is seen, --up: what is up there. --click: a place in the
first picture, in shares of its width and height from the top left; the click's part is drawn, then what each notch
takes. --apart: also the parts of the automatic cut, each moved away from the center by this share of its distance. --sheet: instead, to
judge a model, the cut from four sides, then a row of stops, small to large, for each of six places far from each other; a dot
marks the place, a frame the click's own part. Needs numpy and Pillow.
"""

import argparse
from pathlib import Path

import numpy as np
from PIL import Image
from psb import Mode, build

from partwheel.cut import colors

FINER = 2  # drawn so many times larger, then averaged
POINTS_A_PIXEL = 12
GRAY, PICKED = (0.80, 0.80, 0.80), (0.95, 0.45, 0.10)
DOT = (0.1, 0.1, 0.1)
STOPS_SHOWN = 5
SHEET_CLICKS, SHEET_COLUMNS = 6, 6


class View:
    """A mesh seen from afar: which face is in each pixel (-1: none), and how bright.

    focus: (n, 3) points that fill the picture; None: the mesh"""

    def __init__(self, mesh, towards, up, size, focus=None):
        size *= FINER
        back = np.array(towards, float) / np.linalg.norm(towards)
        right = np.cross(up, back)
        right /= np.linalg.norm(right)
        axes = np.stack([right, np.cross(back, right), back])
        corners = (mesh.vertices @ axes.T)[mesh.triangles]
        shown = corners.reshape(-1, 3) if focus is None else focus @ axes.T
        low, high = shown.min(axis=0), shown.max(axis=0)
        middle, width = (low + high) / 2, (high - low)[:2].max() / 0.94
        corners = (corners - middle) * (size / width)
        low, high = corners.min(axis=1), corners.max(axis=1)
        near = np.flatnonzero(((low < size / 2) & (high > -size / 2))[:, :2].all(axis=1))  # the rest is not in the picture
        corners = corners[near]
        across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        area = np.linalg.norm(across, axis=1)
        rng = np.random.default_rng(0)
        triangle = np.repeat(np.arange(len(area)), rng.poisson(area / 2 * POINTS_A_PIXEL) + 1)
        u, v = rng.random((2, len(triangle)))
        u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
        a, b, c = corners[triangle].transpose(1, 0, 2)
        points = a + u[:, None] * (b - a) + v[:, None] * (c - a)
        is_inside = (np.abs(points[:, :2]) < size / 2).all(axis=1)
        points, triangle = points[is_inside], triangle[is_inside]
        column, row = (points[:, 0] + size / 2).astype(int), (size / 2 - points[:, 1]).astype(int)
        pixel = row * size + column
        order = np.argsort(points[:, 2])  # the nearest is written last
        visible_face = np.full(size * size, -1)
        visible_face[pixel[order]] = triangle[order]
        light = np.array([-0.35, 0.5, 0.8]) / np.linalg.norm([-0.35, 0.5, 0.8])
        bright = np.abs(across @ light) / np.maximum(area, 1e-300)
        self.face = np.where(visible_face >= 0, mesh.faces[near][visible_face], -1).reshape(size, size)
        self.bright = np.where(visible_face >= 0, 0.35 + 0.65 * bright[visible_face], 0).reshape(size, size)

    def at(self, x, y):
        face = self.face[int(y * len(self.face)), int(x * len(self.face))]
        assert face >= 0, "there is nothing at this place"
        return int(face)

    def painted(self, colors):
        """colors: of each face, 0..1"""
        picture = np.where(self.face[..., None] >= 0, colors[self.face] * self.bright[..., None], 1)
        side = len(picture) // FINER
        return picture.reshape(side, FINER, side, FINER, 3).mean(axis=(1, 3))


def picture_of_part(view, hierarchy, node):
    picked = np.tile(GRAY, (len(hierarchy.leaf), 1))
    picked[hierarchy.faces(int(node))] = PICKED
    return view.painted(picked)


def far_faces(mesh, views, count):
    """[(view, row, column)] of faces far from each other, each in the view that shows the most of it."""
    corners = mesh.vertices[mesh.triangles]
    middle = np.zeros((mesh.face_count, 3))
    middle[mesh.faces] = corners.mean(axis=1)
    pixels = np.array([np.bincount(view.face[view.face >= 0], minlength=mesh.face_count) for view in views])
    visible = np.flatnonzero(pixels.sum(axis=0))
    distance, result = np.full(len(visible), np.inf), []
    face = visible[np.linalg.norm(middle[visible] - corners.mean(axis=(0, 1)), axis=1).argmax()]
    for _ in range(count):
        view = views[pixels[:, face].argmax()]
        shown = np.argwhere(view.face == face)
        result.append((view, *shown[len(shown) // 2]))
        distance = np.minimum(distance, np.linalg.norm(middle[visible] - middle[face], axis=1))
        face = visible[distance.argmax()]
    return result


def sheet(mesh, hierarchy, part_colors, args):
    """The cells of --sheet, SHEET_COLUMNS a row."""
    side = np.cross(args.up, args.view)
    views = [View(mesh, towards, args.up, args.size) for towards in (args.view, side, -np.array(args.view), -side)]
    rows = [[view.painted(part_colors) for view in views]]
    for view, row, column in far_faces(mesh, views, SHEET_CLICKS):
        stops, start = hierarchy.wheel(int(view.face[row, column]))
        first = max(0, min(start - 1, len(stops) - SHEET_COLUMNS))
        cells = [picture_of_part(view, hierarchy, node) for node in stops[first:first + SHEET_COLUMNS]]
        y, x = row // FINER, column // FINER
        for cell in cells:
            cell[max(0, y - 2):y + 3, max(0, x - 2):x + 3] = DOT
        cells[start - first][[0, 1, -2, -1]] = cells[start - first][:, [0, 1, -2, -1]] = DOT
        rows.append(cells)
    blank = np.ones((args.size, args.size, 3))
    return [cell for cells in rows for cell in cells + [blank] * (SHEET_COLUMNS - len(cells))]


def moved_apart(mesh, labels, share):
    """The mesh with each part moved away from the center."""
    corners, part = mesh.vertices[mesh.triangles], labels[mesh.faces]
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    for number in np.unique(part):
        own = corners[part == number]
        corners[part == number] += share * ((own.min(axis=(0, 1)) + own.max(axis=(0, 1))) / 2 - (low + high) / 2)
    return mesh._replace(vertices=corners.reshape(-1, 3), triangles=np.arange(corners.size // 3).reshape(-1, 3))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=Path)
    parser.add_argument("model", type=Path)
    parser.add_argument("--view", type=float, nargs=3, default=(0, 0, 1))
    parser.add_argument("--up", type=float, nargs=3, default=(0, 1, 0))
    parser.add_argument("--click", type=float, nargs=2, action="append", default=[])
    parser.add_argument("--sheet", action="store_true")
    parser.add_argument("--apart", type=float)
    parser.add_argument("--mode", choices=[mode.name.lower() for mode in Mode], default=Mode(0).name.lower())
    parser.add_argument("--size", type=int, default=360)
    parser.add_argument("--columns", type=int, default=7)
    args = parser.parse_args()
    if not np.cross(args.up, args.view).any():
        parser.error("--up is parallel to --view: give another direction for one of them")
    mesh, hierarchy = build(args.model, Mode[args.mode.upper()])
    front, back = (View(mesh, sign * np.array(args.view), args.up, args.size) for sign in (1, -1))
    labels = hierarchy.face_labels(hierarchy.cut_automatic())
    part_colors = colors(labels)
    cells = [view.painted(part_colors) for view in (front, back)]
    for place in args.click:
        stops, start = hierarchy.wheel(front.at(*place))
        for node in stops[start:start + STOPS_SHOWN]:
            cells.append(picture_of_part(front, hierarchy, node))
    if args.apart:
        cells.append(View(moved_apart(mesh, labels, args.apart), args.view, args.up, args.size).painted(part_colors))
    if args.sheet:
        cells, args.columns = sheet(mesh, hierarchy, part_colors, args), SHEET_COLUMNS
    columns = min(args.columns, len(cells))
    cells += [np.ones_like(cells[0])] * (-len(cells) % columns)
    rows = [np.concatenate(cells[i:i + columns], axis=1) for i in range(0, len(cells), columns)]
    Image.fromarray((255 * np.concatenate(rows)).astype(np.uint8)).save(args.out, quality=88)


if __name__ == "__main__":
    main()
