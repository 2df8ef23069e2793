# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws a preview of a model in the colors of its parts, without a window or a GPU: rays by Embree (embreex), PNG by
Pillow."""

from pathlib import Path
from typing import Optional

import numpy as np

from ..cut import Cut, colors
from ..meshes import Mesh
from ..requirements import PREVIEWS, load_module
from ..triangles import doubled_area_vectors

SUPERSAMPLING = 2  # samples per pixel along each axis
TO_CAMERA, UP = (0.5, -0.8, 0.45), (0, 0, 1)


def draw_preview(path: Path, mesh: Mesh, cut: Optional[Cut], size: int, is_y_up: bool) -> None:
    """Draws a mesh with finite coordinates and valid indices as a PNG of size x size pixels, by an orthographic camera and a
    headlight, in the colors of a cut's parts, or gray. Raises RequirementError, OSError."""
    trimesh, _, _ = (load_module(name, "Drawing previews") for name in PREVIEWS)
    from PIL import Image
    from trimesh.ray.ray_pyembree import RayMeshIntersector

    vertices = mesh.vertices[:, [0, 2, 1]] * [1, -1, 1] if is_y_up else mesh.vertices
    corners = vertices[mesh.triangles]
    center = (corners.min(axis=(0, 1)) + corners.max(axis=(0, 1))) / 2
    scale = np.abs(corners - center).max() or 1.0
    vertices = (vertices - center) / scale  # Embree uses single precision
    to_camera = np.array(TO_CAMERA) / np.linalg.norm(TO_CAMERA)
    right = np.cross(UP, to_camera) / np.linalg.norm(np.cross(UP, to_camera))
    axes = np.stack([right, np.cross(to_camera, right), to_camera])

    projected = vertices[np.unique(mesh.triangles)] @ axes.T
    low, high = projected.min(axis=0), projected.max(axis=0)
    samples = size * SUPERSAMPLING
    offsets = ((np.arange(samples) + 0.5) / samples - 0.5) * (high - low)[:2].max() * 1.06
    x, y = np.meshgrid(offsets + (low[0] + high[0]) / 2, -offsets + (low[1] + high[1]) / 2)
    origins = np.column_stack([x.ravel(), y.ravel(), np.full(x.size, high[2] + 1)]) @ axes
    rays = RayMeshIntersector(trimesh.Trimesh(vertices, mesh.triangles, process=False))
    hit = rays.intersects_first(origins, np.tile(-to_camera, (len(origins), 1)))

    corners = vertices[mesh.triangles]
    normals = doubled_area_vectors(corners)
    lengths = np.linalg.norm(normals, axis=1)
    shading = 0.25 + 0.75 * np.abs(normals @ to_camera) / np.where(lengths, lengths, 1)
    triangle_colors = (colors(cut.keys)[cut.labels[mesh.faces]] if cut else np.full(3, 0.8)) * shading[:, None]
    image = np.ones((len(hit), 3))
    image[hit >= 0] = triangle_colors[hit[hit >= 0]]
    image = image.reshape(size, SUPERSAMPLING, size, SUPERSAMPLING, 3).mean(axis=(1, 3))
    Image.fromarray((image * 255 + 0.5).astype(np.uint8)).save(path, format="PNG", optimize=False)
