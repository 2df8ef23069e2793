# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts under names of the user's. Each is a face attribute "part: NAME" of the mesh, 1 on its faces: so it is in the
.blend file, Blender carries it through edits and undo, and Geometry Nodes find it. Which node of the hierarchy that is
now, whichever way it was found since, the overlap of the faces tells."""

import bmesh
import numpy as np

from ..mesh import arrays
from ..mesh.errors import Refused
from ..pick import borders
from partwheel.likeness import best_node

PREFIX = "part: "
LONGEST = 50  # letters of a name: Blender cuts those of attributes at 63, and counts bytes
OVERLAP = 0.5  # of a node with the remembered faces; with less it is another part


def ours(attribute):
    return (attribute.name.startswith(PREFIX) and attribute.domain == "FACE" and attribute.data_type == "INT")


def names(mesh):
    """[name, ...] in the order in which they were remembered. For panels too."""
    return [each.name[len(PREFIX):] for each in mesh.attributes if ours(each)]


def faces(mesh, name):
    """(n,) the faces that are remembered. Raises Refused."""
    _needed(mesh, name)
    if mesh.is_editmode:  # Blender shows no attribute's values then
        bm = bmesh.from_edit_mesh(mesh)
        layer = bm.faces.layers.int[PREFIX + name]
        return np.flatnonzero(np.fromiter((face[layer] for face in bm.faces), np.int32, len(bm.faces)))
    return np.flatnonzero(arrays.read(mesh.attributes[PREFIX + name].data, "value", np.int32))


def remember(mesh, name, faces):
    """Under this name, which none has yet. Raises Refused."""
    name = _free(mesh, name)
    if mesh.is_editmode:
        bm = bmesh.from_edit_mesh(mesh)
        layer = bm.faces.layers.int.new(PREFIX + name)
        bm.faces.ensure_lookup_table()
        for face in faces.tolist():
            bm.faces[face][layer] = 1
        bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)
    else:
        mesh.attributes.new(PREFIX + name, "INT", "FACE").data.foreach_set(
            "value", arrays.make_mask(len(mesh.polygons), faces).astype(np.int32))
    arrays.invalidate_snapshot()


def rename(mesh, name, new):
    """Raises Refused, for a name that another one has, for instance."""
    _needed(mesh, name)
    if new != name:
        mesh.attributes[PREFIX + name].name = PREFIX + _free(mesh, new)


def forget(mesh, name):
    """Raises Refused."""
    _needed(mesh, name)
    mesh.attributes.remove(mesh.attributes[PREFIX + name])


def node(obj, hierarchy, name):
    """(the node that is nearest to what is remembered, whether its border is in creases). The hierarchy is what
    registry.get_hierarchy(obj) said. Raises Refused where no node is near."""
    wanted = arrays.make_mask(len(hierarchy.order), faces(obj.data, name))
    found, overlap = best_node(hierarchy, wanted)
    if overlap < OVERLAP:
        raise Refused("No part of {name} as it is now is much like the one remembered as {part}. Pick the part anew, "
                      "forget this name, and remember the part under it again.", name=obj.name, part=name)
    if overlap == 1:
        return found, False
    snapped = borders.get_part_mask(obj, hierarchy, found)
    return found, bool((snapped & wanted).sum() / (snapped | wanted).sum() > overlap)


def _needed(mesh, name):
    if name not in names(mesh):
        raise Refused("No part of {name} is remembered as {part}. Pick the part, and give it the name with Remember Part.",
                      name=mesh.name, part=name)


def _free(mesh, name):
    name = name.strip()
    if not name:
        raise Refused("A part is remembered by a name: it can't be empty.")
    if len(name.encode()) > LONGEST:
        raise Refused("{name} is too long for a name: it can have {count} letters, fewer of some alphabets.", name=name,
                      count=LONGEST)
    if PREFIX + name in mesh.attributes:
        raise Refused("There is a part that is remembered as {name}. Give another name, or forget that one first.", name=name)
    return name
