# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of a cut as objects. The origin of each is at the center of the border with its parent part. In Object
Mode; undo is up to the caller."""

from collections.abc import Iterator
from typing import NamedTuple

import bpy
import numpy as np
from mathutils import Matrix, Vector

from ..mesh import Refused, arrays, assembly, rollback_on_error
from ..solid import composition, fitting, solids
from ..translations.lookup import rpt_
from partwheel.cut import Cut, part_tree

VOLUME_TOLERANCE = 0.01  # relative to the whole: closed objects that differ by less cause no message
EXPLODE_PROPERTY = "explode"  # property of the root object that moves the others apart
# Modifiers whose effect does not depend on the object's origin. With any other modifier the origin stays where it is.
# Mirror is one of them, since _mirror_about() sets its mirror object.
ORIGIN_INDEPENDENT_MODIFIERS = {
    "ARMATURE", "BEVEL", "BOOLEAN", "DATA_TRANSFER", "EDGE_SPLIT", "LAPLACIANSMOOTH", "MASK", "MIRROR", "MULTIRES",
    "SMOOTH", "SOLIDIFY", "SUBSURF", "TRIANGULATE", "VERTEX_WEIGHT_EDIT", "VERTEX_WEIGHT_MIX", "WEIGHTED_NORMAL", "WELD",
    "WIREFRAME"}


class ObjectOptions(NamedTuple):
    """Options of create_part_objects()."""

    caps: solids.CapOptions = solids.CapOptions()  # of closed objects
    # Solids that add up to the whole and fit each other exactly, unless caps are smooth; a part of a broken mesh that can't
    # be closed stays open. False: the parts' own polygons only.
    closed: bool = True
    tree: bool = True  # each part is the child of the part that it is attached to. False: siblings with the object's origin
    # At the center of the border, or of a loose component, unless a modifier depends on the origin. False: the object's.
    origins: bool = True
    # Offset from the parent part, or of siblings from the center of the model, times the distance of their centers, by
    # drivers of a property of the root; 0: none.
    explode: float = 0.0
    shell: float = 0.0  # inward thickness of a Solidify modifier, for parts that are thick enough, in the object's units


@rollback_on_error()
def create_part_objects(obj: bpy.types.Object, cut: Cut, names: list[str],
                        options: ObjectOptions) -> list[bpy.types.Object]:
    """One object for each part that is not empty, in a new collection; the object itself stays. The root part gets
    the object's parent, the other parts become children of their parent part. If animation, constraints or an
    armature parent move the object, they move each part instead: all parts are siblings with the object's origin."""
    composition.update_matrices()
    mesh = arrays.update_mesh(obj)
    links, origins, centers = _part_links(mesh, cut)
    meshes = _closed_meshes(obj, cut, options.caps) if options.closed else [
        _open_mesh(mesh, cut, part) for part in range(len(cut))]
    collection = composition.create_collection(obj, f"{obj.name} parts")
    new = {part: composition.create_object_like(obj, part_object, names[part], collection)
           for part, part_object in enumerate(meshes) if part_object}
    root = new.get(next(part for part, link in enumerate(links) if link.parent < 0))
    is_chained = options.tree and _is_rigidly_attached(obj)
    moves_origins = options.origins and is_chained and all(modifier.type in ORIGIN_INDEPENDENT_MODIFIERS
                                                           for modifier in obj.modifiers)
    parents = {part: new[links[part].parent] for part in new if is_chained and links[part].parent in new}
    shifts = {part: origins[part] if moves_origins and part in parents else Vector() for part in new}
    for part in parents:
        part_object = new[part]
        part_object.parent = None
        part_object.matrix_world = obj.matrix_world @ Matrix.Translation(shifts[part])
        if moves_origins:
            part_object.data.transform(Matrix.Translation(-shifts[part]), shape_keys=True)
            if not part_object.data.use_auto_texspace:
                part_object.data.texspace_location = Vector(part_object.data.texspace_location) - shifts[part]
            _mirror_about(part_object, root)
    model_center = sum((Vector(corner) for corner in obj.bound_box), Vector()) / 8
    for part, part_object in new.items():
        if part in parents:
            part_object.parent, part_object.parent_type = parents[part], "OBJECT"
            # In the parent part's space. Its own transform can't hold the shear of an object in a stretched parent.
            place = Matrix.Translation(shifts[part] - shifts[links[part].parent])
            part_object.matrix_parent_inverse = place @ part_object.matrix_basis.inverted_safe()
        if options.explode and (part in parents or not is_chained):
            center = centers[links[part].parent] if is_chained else model_center
            offset = part_object.matrix_basis.to_3x3() @ (centers[part] - center)
            _add_explode_drivers(part_object, root, offset, options.explode)
        if options.shell and cut.volume(part) > options.shell * sum(face.area for face in part_object.data.polygons):
            shell = part_object.modifiers.new("Shell", "SOLIDIFY")
            shell.thickness, shell.offset = options.shell, -1
            # The simple mode creates spikes, hundreds of thicknesses long, where a cap meets the surface sharply.
            shell.solidify_mode, shell.nonmanifold_thickness_mode = "NON_MANIFOLD", "EVEN"
    composition.update_matrices()
    return list(new.values())


def create_siblings(obj: bpy.types.Object, cut: Cut, caps: solids.CapOptions, explode: float) -> list[bpy.types.Object]:
    """create_part_objects() with closed objects that are not parented to each other."""
    return create_part_objects(obj, cut, [f"{obj.name} part"] * len(cut), ObjectOptions(caps, tree=False, explode=explode))


def _is_rigidly_attached(obj: bpy.types.Object) -> bool:
    """Whether only the object's parent, as a whole, and its modifiers move or change it. (A child with the same
    constraints and animation as its parent would move twice; one with another parent would not be deformed; and in files,
    a skin has no parent but its armature.)"""
    animation = obj.animation_data
    animated = animation and (animation.action or animation.drivers or animation.nla_tracks)
    is_deformed = (obj.parent and obj.parent_type in {"ARMATURE", "LATTICE"}) or obj.find_armature()
    return not animated and not obj.constraints and not is_deformed


def _mirror_about(obj: bpy.types.Object, center: bpy.types.Object) -> None:
    """Sets the mirror object of Mirror modifiers that have none."""
    for modifier in obj.modifiers:
        if modifier.type == "MIRROR" and not modifier.mirror_object:
            modifier.mirror_object = center


def difference_messages(obj: bpy.types.Object, cut: Cut, objects: list[bpy.types.Object],
                        smooth: bool) -> Iterator[str]:
    """Messages about differences between closed objects and the model: duplicate faces, volume (unless Mirror modifiers close
    the objects)."""
    original = fitting.duplicate_originals(obj.data, cut.hierarchy)
    if count := np.count_nonzero(original != np.arange(len(original))):
        yield rpt_("The model has {count:,} duplicate faces. The objects contain each of them "
                   "once.").format(count=count)
    if composition.merging_mirrors(obj):
        return
    whole, total = cut.hierarchy.summary.volume, sum(arrays.mesh_volume(part_object.data) for part_object in objects)
    if not smooth and total - whole > VOLUME_TOLERANCE * whole:
        yield rpt_("The volumes of the objects add up to {total:.4g}, but the model's volume is {whole:.4g}: its surface "
                   "passes through itself, and the objects keep its polygons, so they contain some places twice. "
                   "Unite what overlaps, or turn off Closed.").format(total=total, whole=whole)
    if not smooth and whole - total > VOLUME_TOLERANCE * whole:
        yield rpt_("The volumes of the objects add up to {total:.4g}, but the model's volume is {whole:.4g}, "
                   "because its surface is broken. Repair the mesh, or turn off Closed.").format(total=total, whole=whole)


def _add_explode_drivers(obj: bpy.types.Object, root: bpy.types.Object, offset: Vector, factor: float) -> None:
    """Adds offset (3,) times the root's property, which starts at factor, to the object's delta location."""
    if root.get(EXPLODE_PROPERTY) != float(factor):
        root[EXPLODE_PROPERTY] = float(factor)
        root.id_properties_ui(EXPLODE_PROPERTY).update(min=0, soft_max=2,
                                                       description="How far the parts are moved apart")
        root.update_tag()  # otherwise drivers don't find the property and stay invalid
    for axis in range(3):
        curve = obj.animation_data and obj.animation_data.drivers.find("delta_location", index=axis)
        driver = (curve or obj.driver_add("delta_location", axis)).driver
        start = f"({driver.expression})" if curve else f"{obj.delta_location[axis]:.9g}"  # of a part that was exploded before, too
        variable = driver.variables.new()
        variable.name = EXPLODE_PROPERTY + str(len(driver.variables) - 1) * bool(curve)
        variable.targets[0].id, variable.targets[0].data_path = root, f'["{EXPLODE_PROPERTY}"]'
        driver.expression = f"{start} + {variable.name} * {offset[axis]:.9g}"  # simple expressions need no Python


def _closed_meshes(obj: bpy.types.Object, cut: Cut, options: solids.CapOptions) -> list[bpy.types.Mesh | None]:
    """The parts as closed meshes; open where a part can't be closed."""
    slices = [cut.slices(part) for part in range(len(cut))]
    try:
        return solids.create_meshes(obj, cut.hierarchy, slices, options)
    except Refused:
        meshes = []
        for part, part_slices in enumerate(slices):
            try:
                meshes += solids.create_meshes(obj, cut.hierarchy, [part_slices], options)
            except Refused:
                meshes.append(_open_mesh(obj.data, cut, part))
        return meshes


def _open_mesh(mesh: bpy.types.Mesh, cut: Cut, part: int) -> bpy.types.Mesh:
    plan = fitting.plan_of_faces(mesh, cut.labels == part, standalone=True)
    new, loops = assembly.assemble_mesh(mesh, plan, f"{mesh.name} part", False), plan.source_loops
    normals = arrays.read_custom_normals(mesh)
    if normals is not None:
        arrays.write_custom_normals(new, normals[loops])
    return new


def _part_links(mesh: bpy.types.Mesh, cut: Cut) -> tuple[list, list[Vector], list[Vector]]:
    """(the parts' links to their parents; origins: centers of borders or bounding boxes; bounding boxes' centers)"""
    surface = arrays.read_surface(mesh)
    labels = cut.labels[surface.faces]
    low, high = (np.array([reduce(surface.vertices[surface.triangles[labels == part]], axis=(0, 1))
                           for part in range(len(cut))]) for reduce in (np.min, np.max))
    centers = (low + high) / 2
    links = part_tree(cut, surface.vertices, surface.triangles, labels, centers)
    origins = [Vector(link.border.center if link.border else center) for link, center in zip(links, centers)]
    return links, origins, [Vector(center) for center in centers]
