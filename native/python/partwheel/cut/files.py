# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of a model as files: closed objects, colors, labels. With trimesh."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any, Dict, List, Optional, Sequence, Tuple, Union

import numpy as np

from ..output import whole_file
from ..requirements import load_module
from ..separation import separate
from .borders import parents_first, part_tree
from .colors import colors
from .names import name_parts

if TYPE_CHECKING:
    from ..meshes import Mesh
    from .cut import Cut
    from .printing import Printable

FORMATS = "glb", "3mf", "stl", "ply"


def write(folder: Path, name: str, mesh: Mesh, cut: Cut, formats: Sequence[str] = ("glb", "ply"), word: str = "Part",
          printed: Optional[Printable] = None) -> List[Path]:
    """Write the parts of a cut to files.

    glb, 3mf: NAME.glb, NAME.3mf, all parts as closed objects with names and colors; in GLB each is a child of its parent in
    the tree of parts. stl: PART.stl for each part. ply: NAME.ply, the model in the colors of its parts, with the part of
    each triangle. NAME.json, always: name, color, face count, volume and parent of each part; the part of each face; of pieces
    for a printer, the names and the numbers of their parts.

    Parameters
    ----------
    folder : created if it does not exist
    name : of the files
    formats : some of FORMATS; if empty, only NAME.json is written
    word : what names of parts begin with
    printed : pieces to write instead of the cut's solids

    Returns
    -------
    the paths of the files

    Raises
    ------
    RequirementError : there are formats, but trimesh is not installed
    OSError : a file can't be written
    """
    trimesh: Any = load_module("trimesh", "Writing parts") if formats else None
    names = name_parts(cut, mesh.vertices, mesh.triangles, mesh.faces, word)
    labels = cut.labels[mesh.faces]
    links = part_tree(cut, mesh.vertices, mesh.triangles, labels)
    rgba = np.column_stack([colors(cut.keys), np.ones(len(cut))])
    folder.mkdir(parents=True, exist_ok=True)
    paths = []

    def write_file(file_name: str, data: Union[bytes, str]) -> None:
        path = folder / file_name
        with whole_file(path):
            path.write_bytes(data if isinstance(data, bytes) else data.encode())
        paths.append(path)

    surfaces: Dict[int, Tuple[np.ndarray, np.ndarray]] = {}
    piece_names, piece_parts = names, list(range(len(cut)))
    if printed:
        surfaces, piece_names, piece_parts = printed.solids, printed.names, printed.parts
    elif formats:
        surfaces = {part: separate(*solid[:2])[:2] for part, solid in enumerate(cut.solids()) if solid is not None}
    solids = {piece: trimesh.Trimesh(*surface, process=False) for piece, surface in surfaces.items()} if formats else {}
    for piece, solid in solids.items():
        solid.visual.vertex_colors = np.tile(rgba[piece_parts[piece]] * 255, (len(solid.vertices), 1)).astype(np.uint8)
    for file_format in formats:
        if file_format == "stl":
            for piece, solid in solids.items():
                write_file(f"{piece_names[piece]}.stl", solid.export(file_type=file_format))
        elif file_format == "ply":
            model = trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False)
            model.visual.face_colors = (rgba[labels] * 255).astype(np.uint8)
            model.face_attributes["part"] = labels
            write_file(f"{name}.ply", model.export(file_type=file_format, include_attributes=True))
        else:
            scene = trimesh.Scene()
            order = parents_first(links)
            for piece in sorted(solids, key=lambda piece: order.index(piece_parts[piece])):
                parent = links[piece_parts[piece]].parent
                parent_name = piece_names[parent] if file_format == "glb" and parent in solids else None
                scene.add_geometry(solids[piece], node_name=piece_names[piece], geom_name=piece_names[piece],
                                   parent_node_name=parent_name)
            write_file(f"{name}.{file_format}", scene.export(file_type=file_format))
    write_file(f"{name}.json", json.dumps({
        "parts": [{"name": names[part], "parent": None if links[part].parent < 0 else names[links[part].parent],
                   "faces": int((cut.labels == part).sum()), "volume": cut.volume(part),
                   "color": rgba[part, :3].round(4).tolist()} for part in range(len(cut))],
        "labels": cut.labels.tolist(),
        **({"pieces": [{"name": piece_names[piece], "part": piece_parts[piece]} for piece in surfaces]} if printed else {})}))
    return paths
