# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of a cut as objects: each turns about the middle of the border by which it hangs on another, and is the
child of that. In Object Mode; undo is the caller's."""

from typing import NamedTuple

import numpy as np
from mathutils import Matrix, Vector

from ..mesh import arrays, pieces
from ..mesh.datablocks import all_or_nothing
from ..mesh.errors import Refused
from ..solid import composition, fitting, solids
from ..words.say import rpt_
from partwheel.cut import part_tree


VOLUME_TOLERANCE = 0.01  # of the whole, by which closed objects may differ from it without a message
EXPLODE = "explode"  # the property of the root by which the others are moved apart
# Modifiers that do the same wherever the object's origin is; of others, and of those that Blender has yet to get, it must stay.
# Mirror does by our making.
ANYWHERE = {"ARMATURE", "BEVEL", "BOOLEAN", "DATA_TRANSFER", "EDGE_SPLIT", "LAPLACIANSMOOTH", "MASK", "MIRROR",
            "MULTIRES", "SMOOTH", "SOLIDIFY", "SUBSURF", "TRIANGULATE", "VERTEX_WEIGHT_EDIT", "VERTEX_WEIGHT_MIX",
            "WEIGHTED_NORMAL", "WELD", "WIREFRAME"}


class Options(NamedTuple):
    """caps: see solids.CapOptions. closed: as solids, that add up to the whole and fit each other exactly, unless caps
    says smooth; a part of a broken mesh that can't be closed stays open. Else their own polygons alone. origins: at the
    middle of the border, of a loose piece in its own, unless a modifier needs it where it is; else all where the object's is.
    explode: each is moved away from the one that it hangs on by so many times the distance of their middles; by drivers, so
    that the root's property changes it; 0: without. shell: so thick, inwards, by a modifier, where a part is thick enough; 0: solid."""

    caps: solids.CapOptions = solids.CapOptions()
    closed: bool = True
    origins: bool = True
    explode: float = 0.0
    shell: float = 0.0


@all_or_nothing()
def made(obj, cut, names, options=Options()):
    """[object, ...], one for each part that has anything left, in a new collection; the object itself stays. The root hangs
    where the object does, and the others on each other; but if what moves the object acts on itself alone, it moves each of
    them: then they are side by side, with its origin."""
    composition.update_matrices()
    mesh = arrays.up_to_date(obj)
    hung, places, middles = _hung(mesh, cut)
    meshes = _closed(obj, cut, options.caps) if options.closed else [
        _open(mesh, cut, part) for part in range(len(cut))]
    collection = composition.create_collection(obj, f"{obj.name} parts")
    new = {part: composition.create_object_like(obj, each, names[part], collection) for part, each in enumerate(meshes) if each}
    root, chained = new.get(_root(hung)), _hangs_alone(obj)
    moved = options.origins and chained and all(each.type in ANYWHERE for each in obj.modifiers)
    parents = {part: new[hung[part].parent] for part in new if hung[part].parent in new}
    if chained:
        for part in parents:
            each = new[part]
            each.parent = None
            each.matrix_world = obj.matrix_world @ Matrix.Translation(places[part] if moved else Vector())
            if moved:
                each.data.transform(Matrix.Translation(-places[part]), shape_keys=True)
                if not each.data.use_auto_texspace:
                    each.data.texspace_location = Vector(each.data.texspace_location) - places[part]
                _mirror_about(each, root)
    composition.update_matrices()
    for part, each in new.items():
        if part in parents and chained:
            each.parent, each.parent_type = parents[part], "OBJECT"
            each.matrix_parent_inverse = parents[part].matrix_world.inverted_safe()
        if part in parents and options.explode:
            frame, other = (obj.matrix_world, hung[part].parent) if chained else (obj.matrix_basis, _root(hung))
            _drive(each, root, frame.to_3x3() @ (middles[part] - middles[other]), options.explode)
        if options.shell and cut.volume(part) > options.shell * sum(face.area for face in each.data.polygons):
            shell = each.modifiers.new("Shell", "SOLIDIFY")
            shell.thickness, shell.offset = options.shell, -1
            # The simple mode draws out thorns, hundreds of thicknesses long, where a cap meets the surface sharply.
            shell.solidify_mode, shell.nonmanifold_thickness_mode = "NON_MANIFOLD", "EVEN"
    composition.update_matrices()
    return list(new.values())


def _hangs_alone(obj):
    """Whether nothing but its parent, as a whole, and its modifiers move or change the object. (A child with the same
    constraints and animation as its parent would move twice, one with another parent would not be deformed.)"""
    animation = obj.animation_data
    animated = animation and (animation.action or animation.drivers or animation.nla_tracks)
    return not animated and not obj.constraints and (not obj.parent or obj.parent_type not in {"ARMATURE", "LATTICE"})


def _mirror_about(obj, center):
    """Its Mirror modifiers go on to mirror about an object's origin."""
    for modifier in obj.modifiers:
        if modifier.type == "MIRROR" and not modifier.mirror_object:
            modifier.mirror_object = center


def notes(obj, cut, made, smooth):
    """Sentences on what closed objects don't have in common with the model: duplicates, and a volume."""
    original = fitting.duplicate_originals(obj.data, cut.hierarchy)
    if count := np.count_nonzero(original != np.arange(len(original))):
        yield rpt_("The model has {count:,} duplicate faces. Each is in the objects once.").format(count=count)
    whole, total = cut.hierarchy.summary.volume, sum(_volume(each.data) for each in made)
    if not smooth and abs(total - whole) > VOLUME_TOLERANCE * whole:
        yield rpt_("The volumes of the objects add up to {total:.4g}, but the model's is {whole:.4g}, since its surface is "
                   "broken. Repair it, or divide it without Closed.").format(total=total, whole=whole)


def _volume(mesh):
    """That a closed mesh encloses."""
    corners, _ = arrays.triangles(mesh)
    points = arrays.read(mesh.vertices, "co", np.float32, 3).astype(np.float64)
    a, b, c = (points - points.mean(axis=0))[corners].transpose(1, 0, 2)
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def _root(hung):
    return next(part for part, link in enumerate(hung) if link.parent < 0)


def _drive(obj, root, away, factor):
    """The object moves by so many times this vector as the root's property says, from the factor on."""
    if root.get(EXPLODE) != float(factor):
        root[EXPLODE] = float(factor)
        root.id_properties_ui(EXPLODE).update(min=0, soft_max=2, description="How far the parts are moved apart")
        root.update_tag()  # or drivers find no such property, and are taken for broken from then on
    for axis in range(3):
        known = obj.animation_data and obj.animation_data.drivers.find("delta_location", index=axis)
        driver = (known or obj.driver_add("delta_location", axis)).driver
        before = f"{driver.expression} + " if known else ""  # an exploded part that is divided again
        variable = driver.variables.new()
        variable.name = EXPLODE + str(len(driver.variables) - 1) * bool(known)
        variable.targets[0].id, variable.targets[0].data_path = root, f'["{EXPLODE}"]'
        driver.expression = f"{before}{variable.name} * {away[axis]:.9g}"  # simple enough to need no Python


def _closed(obj, cut, options):
    slices = [cut.slices(part) for part in range(len(cut))]
    try:
        return solids.create_meshes(obj, cut.hierarchy, slices, options)
    except Refused:
        found = []
        for part, each in enumerate(slices):
            try:
                found += solids.create_meshes(obj, cut.hierarchy, [each], options)
            except Refused:
                found.append(_open(obj.data, cut, part))
        return found


def _open(mesh, cut, part):
    """The part's polygons."""
    plan = fitting.plan_of_faces(mesh, cut.hierarchy, 0, 1, cut.labels == part, standalone=True)
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
    hung = part_tree(cut, surface.vertices, surface.triangles, labels, middles)
    places = [Vector(link.border.center if link.border else middle) for link, middle in zip(hung, middles)]
    return hung, places, [Vector(middle) for middle in middles]
