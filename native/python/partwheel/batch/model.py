# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds one model: from its file to a folder of results."""

import time
from pathlib import Path
from typing import Any, Dict, Optional, Union

import numpy as np

from . import blend
from .. import convex, meshes
from ..contents import find_dropped, find_losses
from ..cut import Cut, files
from ..hierarchy import Hierarchy
from ..library import Error, Mode
from ..marks import marks_of_model
from ..separation import separate
from ..worker import Job
from .preview import draw_preview

OUTPUTS = "hierarchy", "cut", "objects", "colliders", "preview"  # see build_model()
Y_UP = {".dae", ".glb", ".gltf"}  # formats in which y is up


def build_model(path: Union[str, Path], folder: Path, settings: Dict[str, Any], *, memory: int, seconds: Optional[float],
                threads: int) -> Dict[str, Any]:
    """Reads and builds a model and writes the outputs that settings, see command.settings(), choose into a folder:

    hierarchy  hierarchy.partwheel
    cut        cut.json, the parts and the part of each face
    objects    objects.glb, the parts as closed objects
    colliders  colliders.obj, settings["hulls"] convex hulls UCX_00, ..., with at most settings["max_vertices"] vertices
    preview    preview.png; also of a model that can't be built, in gray, if its numbers are valid

    memory, seconds, threads : limits of the worker process; 0 bytes: no limit, None: the default of Job

    Returns the report: {"notes", "fill_method", sizes ..., "seconds": {stage: seconds}}. Raises OSError, MemoryError, and
    Error if the model can't be read or built; its attribute has_preview says whether preview.png was written."""
    timer = _StageTimer()
    suffix = Path(path).suffix.lower()
    mesh = blend.read(path, folder) if suffix == ".blend" else meshes.read(path)
    timer.end_stage("read")
    build = dict(settings["build"], mode=Mode[settings["build"]["mode"].upper()])
    job = Job(mesh.vertices, mesh.triangles, mesh.faces, mesh.face_count, memory_limit=memory, cpu_limit=seconds,
              threads=threads, marks=marks_of_model(mesh, settings.get("use", ())), **build)
    outputs = settings["outputs"]
    try:
        hierarchy = job.result()
    except Error as error:
        has_preview = "preview" in outputs and _is_drawable(mesh)
        error.has_preview = has_preview  # type: ignore[attr-defined]
        if has_preview:
            draw_preview(folder / "preview.png", mesh, None, settings["preview"], suffix in Y_UP)
        raise
    timer.end_stage("build")
    timer.seconds.update(hierarchy.seconds)
    losses = find_losses(mesh.dropped, mesh.kinds, ["glb"] if "objects" in outputs else [])
    return {"vertices": len(mesh.vertices), "triangles": len(mesh.triangles), "faces": mesh.face_count,
            "welded_vertices": mesh.welded, "dropped": find_dropped(losses), "tets": len(hierarchy.tetrahedra),
            "nodes": len(hierarchy.parent), "notes": hierarchy.notes, **hierarchy.summary._asdict(),
            "worker_failures": [{"name": failure.name, "message": str(failure)} for failure in job.failures],
            "seconds": timer.seconds, **_write_outputs(folder, settings, mesh, hierarchy, threads, suffix in Y_UP, timer)}


def _write_outputs(folder: Path, settings: Dict[str, Any], mesh: meshes.Mesh, hierarchy: Hierarchy, threads: int,
                   is_y_up: bool, timer: "_StageTimer") -> Dict[str, int]:
    """Writes what build_model() does for a hierarchy; returns the numbers of parts and hulls, for the report."""
    outputs, counts = settings["outputs"], {}
    if "hierarchy" in outputs:
        (folder / "hierarchy.partwheel").write_bytes(hierarchy.save())
        timer.end_stage("save")
    if set(outputs) & {"cut", "objects", "preview"}:
        cut = Cut.into(hierarchy, settings["parts"]) if settings["parts"] else Cut.automatic(hierarchy)
        counts["parts"] = len(cut)
    if set(outputs) & {"cut", "objects"}:
        name = "objects" if "objects" in outputs else "cut"
        files.write(folder, name, mesh, cut, ["glb"] if "objects" in outputs else [])
        if name == "objects":
            (folder / "objects.json").rename(folder / "cut.json")
        timer.end_stage("cut")
    if "colliders" in outputs:
        hulls = hierarchy.convex_parts(settings["hulls"], max_vertices=settings["max_vertices"], threads=threads)
        convex.write_obj(folder / "colliders.obj", [(f"UCX_{number:02}", *separate(*hull[:2])[:2])
                                                    for number, hull in enumerate(hulls)])
        counts["hulls"] = len(hulls)
        timer.end_stage("colliders")
    if "preview" in outputs:
        draw_preview(folder / "preview.png", mesh, cut, settings["preview"], is_y_up)
        timer.end_stage("preview")
    return counts


def _is_drawable(mesh: meshes.Mesh) -> bool:
    """Whether the mesh has triangles, finite coordinates and valid indices; the library may have rejected it."""
    return bool(len(mesh.triangles) > 0 and np.isfinite(mesh.vertices).all() and mesh.triangles.min() >= 0
                and mesh.triangles.max() < len(mesh.vertices))


class _StageTimer:
    """Wall-clock time of consecutive stages. seconds: {stage: seconds}."""

    def __init__(self) -> None:
        self.seconds: Dict[str, float] = {}
        self._last = time.monotonic()

    def end_stage(self, stage: str) -> None:
        now = time.monotonic()
        self.seconds[stage], self._last = now - self._last, now
