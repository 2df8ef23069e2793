# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of a cut as objects: each turns about the middle of the border by which it hangs on another, and is the
child of that. In Object Mode; undo is the caller's."""

from typing import NamedTuple

import bpy
import numpy as np
from mathutils import Matrix, Vector

from ..mesh import arrays, pieces
from ..mesh.refusing import Refused
from ..solid import composition, fitting, solids
from partwheel.cut import tree


EXPLODE = "explode"  # the property of the root by which the others are moved apart


class Options(NamedTuple):
    """caps: see solids.Options. closed: as solids, that add up to the whole and fit each other exactly, unless caps
    says smooth; a part of a broken mesh that can't be closed stays open. Else their own polygons alone. origins: at the
    middle of the border, of a loose piece in its own; else all where the object's is. explode: each is moved away from
    the one that it hangs on by so many times the distance of their middles; by drivers, so that the root's property
    changes it; 0: without. shell: so thick, inwards, by a modifier, where a part is thick enough; 0: solid."""

    caps: solids.Options = solids.Options()
    closed: bool = True
    origins: bool = True
    explode: float = 0.0
    shell: float = 0.0


def made(obj, cut, names, options=Options()):
    """[object, ...], one for each part that has anything left, in a new collection; the object itself stays."""
    composition.update_matrices()
    mesh = arrays.up_to_date(obj)
    hung, places, middles = _hung(mesh, cut)
    meshes = _closed(obj, cut, options.caps) if options.closed else [
        _open(mesh, cut, part) for part in range(len(cut))]
    collection = bpy.data.collections.new(f"{obj.name} parts")
    composition.home(obj).children.link(collection)
    new = {part: composition.beside(obj, each, names[part], collection) for part, each in enumerate(meshes) if each}
    if options.origins:
        for part, each in new.items():
            if hung[part].parent >= 0:
                each.data.transform(Matrix.Translation(-places[part]), shape_keys=True)
                each.matrix_world = obj.matrix_world @ Matrix.Translation(places[part])
    composition.update_matrices()
    for part, each in new.items():
        parent = new.get(hung[part].parent)
        if parent:
            each.parent = parent
            each.matrix_parent_inverse = parent.matrix_world.inverted_safe()
            if options.explode:
                away = obj.matrix_world.to_3x3() @ (middles[part] - middles[hung[part].parent])
                _drive(each, new[_root(hung)], away, options.explode)
        if options.shell and cut.volume(part) > options.shell * sum(face.area for face in each.data.polygons):
            shell = each.modifiers.new("Shell", "SOLIDIFY")
            shell.thickness, shell.offset = options.shell, -1
            # The simple mode draws out thorns, hundreds of thicknesses long, where a cap meets the surface sharply.
            shell.solidify_mode, shell.nonmanifold_thickness_mode = "NON_MANIFOLD", "EVEN"
    composition.update_matrices()
    return list(new.values())


def _root(hung):
    return next(part for part, link in enumerate(hung) if link.parent < 0)


def _drive(obj, root, away, factor):
    """The object moves by so many times this vector as the root's property says, from the factor on."""
    if EXPLODE not in root:
        root[EXPLODE] = float(factor)
        root.id_properties_ui(EXPLODE).update(min=0, soft_max=2, description="How far the parts are moved apart")
        root.update_tag()  # or drivers find no such property, and are taken for broken from then on
    for axis in range(3):
        driver = obj.driver_add("delta_location", axis).driver
        variable = driver.variables.new()
        variable.name = EXPLODE
        variable.targets[0].id, variable.targets[0].data_path = root, f'["{EXPLODE}"]'
        driver.expression = f"{EXPLODE} * {away[axis]:.9g}"  # simple enough to need no Python


def _closed(obj, cut, options):
    slices = [cut.slices(part) for part in range(len(cut))]
    try:
        return solids.parts(obj, cut.hierarchy, slices, options)
    except Refused:
        found = []
        for part, each in enumerate(slices):
            try:
                found += solids.parts(obj, cut.hierarchy, [each], options)
            except Refused:
                found.append(_open(obj.data, cut, part))
        return found


def _open(mesh, cut, part):
    """The part's polygons."""
    plan = fitting.of_faces(mesh, cut.hierarchy, 0, 1, cut.labels == part, alone=True)
    new, loops = pieces.assembled(mesh, plan, f"{mesh.name} part", False), plan.loops.first
    normals = arrays.custom_normals(mesh)
    if normals is not None:
        arrays.set_custom_normals(new, normals[loops])
    return new


def _hung(mesh, cut):
    """(the parts' Links, where each hangs on the other or else its middle, their middles)."""
    surface = arrays.surface(mesh)
    labels = cut.labels[surface.faces]
    low, high = (np.array([end(surface.vertices[surface.triangles[labels == part]], axis=(0, 1))
                           for part in range(len(cut))]) for end in (np.min, np.max))
    middles = (low + high) / 2
    hung = tree(cut, surface.vertices, surface.triangles, labels, middles)
    places = [Vector(link.border.center if link.border else middle) for link, middle in zip(hung, middles)]
    return hung, places, [Vector(middle) for middle in middles]
