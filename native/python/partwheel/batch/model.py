# SPDX-License-Identifier: GPL-3.0-or-later
"""One model, from its file to a folder of results."""

import time
from pathlib import Path

import numpy as np

from . import blend
from .. import convex, meshes
from ..cut import Cut, files
from ..library import Error, Mode
from ..worker import Job
from .preview import preview

OUTPUTS = "hierarchy", "cut", "objects", "colliders", "preview"  # what can be made, see make()
Y_UP = {".dae", ".glb", ".gltf"}  # formats whose second axis is up


def make(path, folder, settings, *, memory=0, seconds=None, threads=1):
    """Makes what settings["outputs"] names, in the folder, and returns what is to be told of it.

    hierarchy: hierarchy.partwheel. cut: cut.json, the parts and the part of each face. objects: objects.glb, the parts
    as closed objects. colliders: colliders.obj, settings["hulls"] convex hulls of settings["max_vertices"] at most (0: any
    number), UCX_00 and so on. preview: preview.png. settings: as command.settings() gives them. memory: bytes that
    the worker process may take, 0: no limit. seconds: of its processor time; None: as Job has it. A model that the mesher
    refuses is drawn in grey, if a preview is wanted and can be: the error has the attribute pictured then. Returns
    {"account", "rung", sizes ..., "seconds": {stage: seconds}}; raises Error, OSError, MemoryError."""
    clock = _Clock()
    suffix = Path(path).suffix.lower()
    mesh = blend.read(path, folder) if suffix == ".blend" else meshes.read(path)
    clock.lap("read")
    build = dict(settings["build"], mode=Mode[settings["build"]["mode"].upper()])
    job = Job(mesh.vertices, mesh.triangles, mesh.faces, mesh.face_count, memory_limit=memory, cpu_limit=seconds,
              threads=threads, **build)
    try:
        hierarchy = job.result()
    except Error as error:
        error.pictured = "preview" in settings["outputs"] and _sound(mesh)
        if error.pictured:
            _draw(folder, mesh, None, settings, suffix)
        raise
    clock.lap("build")
    clock.laps.update(hierarchy.seconds)
    report = {"vertices": len(mesh.vertices), "triangles": len(mesh.triangles), "faces": mesh.face_count,
              "welded_vertices": mesh.welded, "dropped": mesh.dropped, "tets": len(hierarchy.tetrahedra), "nodes": len(hierarchy.parent),
              "account": hierarchy.account, **hierarchy.summary._asdict(),
              "worker_failures": [{"name": each.name, "message": str(each)} for each in job.failures],
              "seconds": clock.laps}
    wanted = settings["outputs"]
    if "hierarchy" in wanted:
        (folder / "hierarchy.partwheel").write_bytes(hierarchy.save())
        clock.lap("save")
    if set(wanted) & {"cut", "objects", "preview"}:
        cut = Cut.into(hierarchy, settings["parts"]) if settings["parts"] else Cut.automatic(hierarchy)
        report["parts"] = len(cut)
    if set(wanted) & {"cut", "objects"}:
        name = "objects" if "objects" in wanted else "cut"
        formats, solids = (["glb"], None) if "objects" in wanted else ([], {})
        files.write(folder, name, mesh, cut, formats, printed=solids)
        if name == "objects":
            (folder / "objects.json").rename(folder / "cut.json")
        clock.lap("cut")
    if "colliders" in wanted:
        hulls = hierarchy.convex_parts(settings["hulls"], max_vertices=settings["max_vertices"])
        convex.write_obj(folder / "colliders.obj", [(f"UCX_{number:02}", *hull[:2]) for number, hull in enumerate(hulls)])
        report["hulls"] = len(hulls)
        clock.lap("colliders")
    if "preview" in wanted:
        _draw(folder, mesh, cut, settings, suffix)
        clock.lap("preview")
    return report


def _draw(folder, mesh, cut, settings, suffix):
    preview(folder / "preview.png", mesh, cut, settings["preview"], suffix in Y_UP)


def _sound(mesh):
    """Whether its numbers can be drawn at all, for the library may have refused them."""
    return (len(mesh.triangles) > 0 and np.isfinite(mesh.vertices).all() and mesh.triangles.min() >= 0
            and mesh.triangles.max() < len(mesh.vertices))


class _Clock:
    """laps: {stage: seconds by the clock since the one before}."""

    def __init__(self):
        self.laps, self._last = {}, time.monotonic()

    def lap(self, stage):
        now = time.monotonic()
        self.laps[stage], self._last = now - self._last, now
