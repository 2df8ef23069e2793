# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of a cut as objects for a 3D printer: flat cuts, pegs and sockets, checked. By manifold3d, where Blender's
Python has it. Undo is the caller's."""

import importlib.util
import sys
from typing import NamedTuple

import bpy
import numpy as np

from ..mesh import arrays
from ..mesh.datablocks import all_or_nothing
from ..mesh.errors import Refused
from ..solid import composition
from . import stored
from partwheel.cut import printing

MILLIMETRES = 1000  # in a metre
UNEVEN = 1e-4  # scales of an object that differ by more would make pegs oval


class Plan(NamedTuple):
    """printable: a printing.Printable, in millimetres; scale: so many of them is a unit of the object's mesh."""

    printable: object
    scale: float


def planned(context, obj, cut, known, pegs=None, wall=1.2, bed=None):
    """A Plan; nothing changes yet. pegs: their clearance; None: none, only flat cuts. wall: what stays around sockets,
    and below which walls are told. bed (3,): what is larger is split further; None: large enough. All in millimetres, as
    the scene's units and the object's scale have it. known: {clusters: name} of parts that have one. Raises an Error."""
    if not importlib.util.find_spec("manifold3d"):
        raise Refused("Printing needs the Python package manifold3d, which Blender doesn't have. To install it, run: "
                      "{python} -m pip install manifold3d.", python=sys.executable)
    size = np.linalg.norm(np.array(obj.matrix_world.to_3x3()), axis=0)
    if np.ptp(size) > UNEVEN * size.max():
        raise Refused("{name} is scaled differently along its axes: apply its scale first.", name=obj.name)
    scale = float(size.mean()) * context.scene.unit_settings.scale_length * MILLIMETRES
    surface = arrays.surface(obj.data)
    return Plan(printing.prepare_parts(cut, surface.vertices, surface.triangles, surface.faces,
                                       printing.PrintOptions(scale, pegs, wall, bed),
                                       name_cut=lambda cut: stored.names_of(obj, cut, known)), scale)


@all_or_nothing()
def made(obj, plan):
    """[object, ...] in the object's place, in a new collection: without its UVs and attributes, which cuts would tear, and
    without its modifiers and all else, since what is printed is the mesh itself.
    What the checks found is the collection's property "notes"."""
    composition.update_matrices()
    collection = composition.create_collection(obj, f"{obj.name} for printing")
    collection["notes"] = "\n".join(plan.printable.notes)
    found = []
    for part, (vertices, triangles) in plan.printable.solids.items():
        mesh = bpy.data.meshes.new(plan.printable.names[part])
        mesh.from_pydata((vertices / plan.scale).tolist(), [], triangles.tolist())
        new = composition.create_bare_object(obj, mesh, mesh.name, collection)
        found.append(new)
    composition.update_matrices()
    return found
