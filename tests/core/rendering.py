# SPDX-License-Identifier: GPL-3.0-or-later
"""Mesh files as trimesh and Pillow read them, and their pictures: an orthographic rasterizer with a depth buffer, in numpy
alone."""

import io
from typing import NamedTuple

import numpy as np
import trimesh
from PIL import Image

SIZE = 100  # pixels


class Surface(NamedTuple):
    """Triangles with a material. name of the object, corners (n, 3, 3), uv (n, 3, 2) or None, v up; image (h, w, 3) uint8 or
    None; color (3,) and colors (n, 3, 3) or None, 0 to 1; material: its name"""

    name: str
    corners: np.ndarray
    uv: np.ndarray
    image: np.ndarray
    color: np.ndarray
    colors: np.ndarray
    material: str

    def color_at(self, triangle, weights):
        """(m, 3) colors at barycentric coordinates (m, 3) of triangles (m,)."""
        result = np.tile(self.color, (len(triangle), 1))
        if self.image is not None:
            u, v = np.moveaxis(np.einsum("mc,mck->mk", weights, self.uv[triangle]) % 1, -1, 0)
            height, width = self.image.shape[:2]
            result = result * self.image[np.minimum(((1 - v) * height).astype(int), height - 1),
                                         np.minimum((u * width).astype(int), width - 1)] / 255
        if self.colors is not None:
            result = result * np.einsum("mc,mck->mk", weights, self.colors[triangle])
        return result


def load(path):
    """[Surface] of a file, as trimesh reads it."""
    scene = trimesh.load(path, process=False, force="scene", **({"fix_texture": True} if path.suffix == ".ply" else {}))
    surfaces = []
    for node in scene.graph.nodes_geometry:
        matrix, name = scene.graph[node]
        mesh = scene.geometry[name].copy().apply_transform(matrix)
        uv = image = colors = None
        color, material_name = np.ones(3), None
        if mesh.visual.kind == "texture":
            material = mesh.visual.material
            uv = None if mesh.visual.uv is None else mesh.visual.uv[mesh.faces]
            image = getattr(material, "baseColorTexture", None) or getattr(material, "image", None)
            factor = material.baseColorFactor if hasattr(material, "baseColorFactor") else material.diffuse
            if factor is not None and not (path.suffix == ".ply" and image is not None):
                color = np.asarray(factor, float)[:3] / 255
            image = None if image is None or uv is None else np.asarray(image.convert("RGB"))
            material_name = material.name
            colors = mesh.visual.vertex_attributes.get("color")
            colors = None if colors is None else colors[mesh.faces][:, :, :3] / (255 if colors.dtype == np.uint8 else 1)
        elif mesh.visual.kind == "vertex":
            colors = mesh.visual.vertex_colors[mesh.faces][:, :, :3] / 255
        elif mesh.visual.kind == "face":
            colors = np.repeat(mesh.visual.face_colors[:, None, :3] / 255, 3, axis=1)
        surfaces.append(Surface(node, mesh.vertices[mesh.faces], uv, image, color, colors, material_name))
    return surfaces


def render(surfaces, low, high, back=False):
    """(SIZE, SIZE, 3) colors 0 to 1 seen along z; (SIZE, SIZE) depth, -inf beside the model. low, high : the model's box"""
    picture, depth = np.ones((SIZE, SIZE, 3)), np.full((SIZE, SIZE), -np.inf)
    scale = 0.9 * SIZE / (high - low)[:2].max()
    for surface in surfaces:
        points = (surface.corners - (low + high) / 2) * (-1 if back else 1, 1, -1 if back else 1)
        screen = points[:, :, :2] * scale + SIZE / 2
        for number, (flat, heights) in enumerate(zip(screen, points[:, :, 2])):
            first, last = np.floor(flat.min(axis=0)).astype(int), np.ceil(flat.max(axis=0)).astype(int) + 1
            x, y = np.meshgrid(np.arange(max(first[0], 0), min(last[0], SIZE)), np.arange(max(first[1], 0), min(last[1], SIZE)))
            (ax, ay), (bx, by), (cx, cy) = flat
            area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
            if abs(area) < 1e-9 or not x.size:
                continue
            px, py = x + 0.5, y + 0.5
            b = ((px - ax) * (cy - ay) - (py - ay) * (cx - ax)) / area
            c = ((bx - ax) * (py - ay) - (by - ay) * (px - ax)) / area
            weights = np.stack([1 - b - c, b, c], axis=-1)
            z = weights @ heights
            is_seen = (weights >= -1e-9).all(axis=-1) & (z > depth[y, x] + 1e-7 * np.ptp(high - low))
            rows, columns = y[is_seen], x[is_seen]
            depth[rows, columns] = z[is_seen]
            picture[rows, columns] = surface.color_at(np.full(len(rows), number), weights[is_seen])
    return picture[::-1], depth[::-1]


def save(picture, path):
    """For people to look at."""
    Image.fromarray((np.clip(picture, 0, 1) * 255).astype(np.uint8)).save(path)


def difference(source, result, tolerance):
    """The largest share, of the views from the front and from behind, of the pixels of the model whose colors (0 to 1) differ
    by more than the tolerance."""
    points = np.vstack([surface.corners.reshape(-1, 3) for surface in source])
    shares = []
    for back in (False, True):
        one, depth = render(source, points.min(axis=0), points.max(axis=0), back)
        other, other_depth = render(result, points.min(axis=0), points.max(axis=0), back)
        is_model = np.isfinite(depth) | np.isfinite(other_depth)
        shares.append((abs(one - other)[is_model].max(axis=1) > tolerance).mean())
    return max(shares)


def png(pixels):
    data = io.BytesIO()
    Image.fromarray(pixels).save(data, "PNG")
    return data.getvalue()
