# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the part of each face from a file: labels of another tool, or by hand."""

from pathlib import Path

import numpy as np

from .meshes import Mesh, MeshFileError, read, read_elements

PLY_PROPERTIES = "part", "label", "labels", "segment", "segment_id", "object", "class"  # the first that a face has


def read_labels(path: Path, mesh: Mesh) -> np.ndarray:
    """(F,) the label of each face of a mesh, for Cut.from_labels().

    path : a PLY file whose faces have an integer property of PLY_PROPERTIES, in the model's order; a GLB or glTF file with
        the model's triangles, in which each node with a mesh is a part; or a text file with an integer for each face or
        triangle

    Raises MeshFileError, OSError, and RequirementError without plyfile, which reads PLY, or trimesh, which reads GLB."""
    suffix = path.suffix.lower()
    labels = (_of_ply(path) if suffix == ".ply" else read(path).nodes if suffix in (".glb", ".gltf") else _of_text(path))
    if len(labels) == mesh.face_count:
        return labels
    if len(labels) != len(mesh.triangles):
        raise MeshFileError(f"{path.name} has {len(labels)} labels, but the model has {mesh.face_count} faces. Give one for "
                            "each face, in the order of the file.")
    return labels[np.unique(mesh.faces, return_index=True)[1]]


def _of_text(path: Path) -> np.ndarray:
    try:
        return np.array(path.read_text("utf-8-sig").split(), np.int64)
    except (ValueError, OverflowError) as error:
        raise MeshFileError(f"{path.name} must have nothing but integers, one for each face: {error}.") from error


def _of_ply(path: Path) -> np.ndarray:
    data = read_elements(path).get("face")
    name = next((name for name in PLY_PROPERTIES if data is not None and name in (data.dtype.names or ())), None)
    if data is None or name is None:
        raise MeshFileError(f"{path.name} has no labels: its faces need an integer property {', '.join(PLY_PROPERTIES[:-1])} "
                            f"or {PLY_PROPERTIES[-1]}.")
    return np.asarray(data[name]).ravel().astype(np.int64)
