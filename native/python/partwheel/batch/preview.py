# SPDX-License-Identifier: GPL-3.0-or-later
"""A small picture of a model in its parts' colours, without a window or a graphics card: by Embree (embreex), Pillow."""

import numpy as np

from ..cut import colors
from ..requirements import PREVIEWS, load_module

FINER = 2  # drawn so many times larger, then averaged
TOWARDS, UP = (0.5, -0.8, 0.45), (0, 0, 1)  # from where it is seen; glTF and its like are turned so that they stand


def preview(path, mesh, cut, size, y_up=False):
    """Writes a PNG of size x size pixels. mesh: a meshes.Mesh, sound in its numbers; cut: None for grey; y_up: its second
    axis is up, not its third. Raises RequirementError, OSError."""
    trimesh, _, _ = (load_module(name, "Drawing previews") for name in PREVIEWS)
    from PIL import Image
    from trimesh.ray.ray_pyembree import RayMeshIntersector

    vertices = mesh.vertices[:, [0, 2, 1]] * [1, -1, 1] if y_up else mesh.vertices
    used = vertices[mesh.triangles]
    middle = (used.min(axis=(0, 1)) + used.max(axis=(0, 1))) / 2
    largest = np.abs(used - middle).max() or 1.0
    vertices = (vertices - middle) / largest  # embree counts in single precision
    back = np.array(TOWARDS) / np.linalg.norm(TOWARDS)
    right = np.cross(UP, back) / np.linalg.norm(np.cross(UP, back))
    axes = np.stack([right, np.cross(back, right), back])

    seen = vertices[np.unique(mesh.triangles)] @ axes.T
    low, high = seen.min(axis=0), seen.max(axis=0)
    pixels = size * FINER
    steps = ((np.arange(pixels) + 0.5) / pixels - 0.5) * (high - low)[:2].max() * 1.06
    x, y = np.meshgrid(steps + (low[0] + high[0]) / 2, -steps + (low[1] + high[1]) / 2)
    origins = np.column_stack([x.ravel(), y.ravel(), np.full(x.size, high[2] + 1)]) @ axes
    rays = RayMeshIntersector(trimesh.Trimesh(vertices, mesh.triangles, process=False))
    hit = rays.intersects_first(origins, np.tile(-back, (len(origins), 1)))

    corners = vertices[mesh.triangles]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(across, axis=1)
    bright = 0.25 + 0.75 * np.abs(across @ back) / np.where(length, length, 1)
    paint = (colors(cut.keys)[cut.labels[mesh.faces]] if cut else np.full(3, 0.8)) * bright[:, None]
    picture = np.ones((len(hit), 3))
    picture[hit >= 0] = paint[hit[hit >= 0]]
    picture = picture.reshape(size, FINER, size, FINER, 3).mean(axis=(1, 3))
    Image.fromarray((picture * 255 + 0.5).astype(np.uint8)).save(path, format="PNG", optimize=False)
