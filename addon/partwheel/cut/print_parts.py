# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of a cut for a 3D printer: flat cuts, pegs and sockets, with checks. Undo is up to the caller."""

import importlib.util
import sys

import bpy
import numpy as np

from ..mesh import Computation, Refused, Steps, arrays, rollback_on_error
from ..solid import composition
from . import saved_cut
from partwheel.cut import Cut, printing

MILLIMETERS_PER_METER = 1000
MAX_SCALE_DIFFERENCE = 1e-4  # relative difference of the object's scales: more would make pegs oval


def plan_print(context: bpy.types.Context, obj: bpy.types.Object, cut: Cut, known: dict,
               options: printing.PrintOptions) -> Steps:
    """Steps that return a printing.Printable, in millimeters. They change nothing. Raises an Error. options: their
    scale is replaced by that of the scene's units and the object. known: {clusters: name} of parts with a name."""
    if not importlib.util.find_spec("manifold3d"):
        raise Refused("Printing needs the Python package manifold3d, and Partwheel has none for Python {version}. To install it, "
                      "run: {python} -m pip install manifold3d.", python=sys.executable, version=sys.version.split()[0])
    scales = np.linalg.svd(np.array(obj.matrix_world.to_3x3()), compute_uv=False)  # also where a stretched parent shears it
    if np.ptp(scales) > MAX_SCALE_DIFFERENCE * scales.max():
        raise Refused("The scale of {name} is not uniform: apply its scale first.", name=obj.name)
    scale = float(scales.mean()) * context.scene.unit_settings.scale_length * MILLIMETERS_PER_METER
    surface = arrays.read_surface(obj.data)
    options = options._replace(scale=scale)
    cut = yield Computation(printing.split_parts, cut, options)
    names = saved_cut.complete_names(obj, cut, known)
    return (yield Computation(printing.prepare_parts, cut, surface.vertices, surface.triangles, surface.faces, options,
                              names=names))


@rollback_on_error()
def create_print_objects(obj: bpy.types.Object, printable: printing.Printable) -> list[bpy.types.Object]:
    """New objects in the object's place, in a new collection: only the meshes, without modifiers, UVs and attributes,
    which cuts would tear. The notes of the checks become the collection's property "notes"."""
    composition.update_matrices()
    collection = composition.create_collection(obj, f"{obj.name} for printing")
    collection["notes"] = "\n".join(printable.notes)
    objects = []
    for part, (vertices, triangles) in printable.solids.items():
        mesh = bpy.data.meshes.new(printable.names[part])
        mesh.from_pydata((vertices / printable.scale).tolist(), [], triangles.tolist())
        objects.append(composition.create_bare_object(obj, mesh, mesh.name, collection))
    composition.update_matrices()
    return objects
