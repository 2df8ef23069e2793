# SPDX-License-Identifier: GPL-3.0-or-later
"""A model's parts as files: closed objects, colours, labels. By trimesh."""

import json

import numpy as np

from ..requirements import load_module
from .borders import from_root, tree
from .colors import colors
from .names import named

FORMATS = "glb", "3mf", "stl", "ply"


def write(folder, name, mesh, cut, formats=("glb", "ply"), word="Part", printed=None):
    """Writes the parts of a cut into a folder, made if it is not there; [path, ...] what was written.

    glb, 3mf: NAME.glb, NAME.3mf: all parts as closed objects with names and colours, in glb parented as the parts hang
    together. stl: a file for each, PART.stl. ply: NAME.ply, the model itself in the parts' colours, the number of its
    part on each triangle. And always NAME.json: of each part its name, colour, faces, volume and what it hangs on; the
    part of each face. mesh: a meshes.Mesh. printed: {part: (vertices, triangles)} to be written as objects instead of
    the cut's own solids, see printing. formats may be empty: then only NAME.json is written. Raises
    RequirementError without trimesh where there are formats, OSError."""
    trimesh = load_module("trimesh", "Writing parts") if formats else None
    names = named(cut, mesh.vertices, mesh.triangles, mesh.faces, word)
    labels = cut.labels[mesh.faces]
    hung = tree(cut, mesh.vertices, mesh.triangles, labels)
    paint = np.column_stack([colors(cut.keys), np.ones(len(cut))])
    folder.mkdir(parents=True, exist_ok=True)
    written = []

    def put(file_name, data):
        path = folder / file_name
        path.write_bytes(data if isinstance(data, bytes) else data.encode())
        written.append(path)

    if printed is None and formats:
        printed = {part: solid[:2] for part, solid in enumerate(cut.solids()) if solid is not None}
    solids = {part: trimesh.Trimesh(*solid, process=False) for part, solid in printed.items()} if formats else {}
    for part, solid in solids.items():
        solid.visual.vertex_colors = np.tile(paint[part] * 255, (len(solid.vertices), 1)).astype(np.uint8)
    for form in formats:
        if form == "stl":
            for part, solid in solids.items():
                put(f"{names[part]}.stl", solid.export(file_type=form))
        elif form == "ply":
            whole = trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False)
            whole.visual.face_colors = (paint[labels] * 255).astype(np.uint8)
            whole.face_attributes["part"] = labels
            put(f"{name}.ply", whole.export(file_type=form, include_attributes=True))
        else:
            scene = trimesh.Scene()
            for part in from_root(hung):
                if part in solids:
                    parent = hung[part].parent
                    scene.add_geometry(solids[part], node_name=names[part], geom_name=names[part],
                                       parent_node_name=names[parent] if form == "glb" and parent in solids else None)
            put(f"{name}.{form}", scene.export(file_type=form))
    put(f"{name}.json", json.dumps({
        "parts": [{"name": names[part], "parent": None if hung[part].parent < 0 else names[hung[part].parent],
                   "faces": int((cut.labels == part).sum()), "volume": cut.volume(part),
                   "color": paint[part, :3].round(4).tolist()} for part in range(len(cut))],
        "labels": cut.labels.tolist()}))
    return written
