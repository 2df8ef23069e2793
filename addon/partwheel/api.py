# SPDX-License-Identifier: GPL-3.0-or-later
"""For scripts and other add-ons: what the operators do, as functions of a mesh object, in any mode, with or without a
window. Available while the add-on is enabled, whatever the name of its repository:

    from partwheel import api

    obj = bpy.context.active_object
    arm = api.part(obj, 42, level=2)       # a click on face 42 and two notches up
    api.select(obj, arm)
    copy = api.copy_part(obj, arm)         # the part as a closed solid, a new object
    fingers = api.similar(obj, finger)     # [(node, likeness), ...] of similar parts
    cut = api.cut(obj, parts=8)            # the whole model in parts; cut.labels: the part of each face, 0 to 7
    api.write(obj, cut, to={"OBJECTS", "VERTEX_GROUPS"})
    hand = api.copy_part(obj, cut[3])      # a part of the cut, in place of a node
    api.convex(obj, hulls=16, max_vertices=64)  # convex colliders
    api.swap(obj, arm, other)              # by the most compatible part of another object

Common parameters:

* obj: the mesh object
* node (Node): a node number of the object's partwheel.Hierarchy, the Part that part() returns, or a part of a cut like cut[3]
* snap: whether to move the part's border to the creases nearby

All numbers count from 0; partwheel.hierarchy has a table of their meanings and conversions. Lengths, areas and
matrices are in the object's own space unless the text says "world"; angles are in radians. Functions build the
hierarchy if there is none; only start_build() does not wait for it. One build runs at a time, after those that were
requested earlier.

Every function raises partwheel.Error, whose text says what is wrong and what to do; most of these are PartwheelErrors
with a status. ValueError means invalid arguments: not a mesh object; one that is linked from another file, if it must
change; one in Edit Mode, for functions that need another mode; numbers that are not finite or out of range. After an
error nothing has changed. Undo steps are up to the caller.
"""

from __future__ import annotations

import operator
import sys
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import NamedTuple, Union

import bpy
from bpy.types import Object
import numpy as np
from mathutils import Vector

import partwheel
from .compose import placement, swapping, union
from .deform import methods
from .deform.region import Region
from .deform.vertex_writer import VertexWriter
from .cut import hulls as hull_objects
from .cut import objects as part_objects
from .cut import print_parts as printing
from .cut import labeled_cut, saved_cut, writing
from .mesh import (MeshSnapshot, Refused, arrays, element_counts, labels as mesh_labels, read_only_reason, run_steps,
                   selection)
from .parts import builds, picks, registry
from .pick import borders, states
from .related import named_parts, similar_parts
from .solid import composition, loose_bits, solids
from partwheel import Hierarchy, Mode, PartwheelError, Status
from partwheel.cut import Cut, CutPart
from partwheel.cut.printing import Insert, PrintOptions
from partwheel.deform import MAX_ITERATIONS, affine
from partwheel.joint import REACH
from partwheel.likeness import THRESHOLD

Build, State = builds.QueuedBuild, registry.State
Node = Union[int, "Part", CutPart]
Progress = Callable[[float, str], Union[bool, None]]
MODULE_NAME = f"{partwheel.__name__}.api"  # scripts import the module by this name


# ---- Hierarchies


def start_build(obj: Object, quality: float = 0.0, mode: Mode | None = None, cpu_limit: float | None = None,
                memory_limit: int | None = None, full_resolution: bool | None = None) -> Build:
    """Starts to build the hierarchy of the object's mesh and returns at once.

    A build of the same mesh and options that is still running is returned again; one with others is canceled.

    Parameters
    ----------
    quality : 0 adds no points inside the mesh; from 1.1 on it bounds how stretched the tetrahedra may be
    mode : partwheel.Mode, how parts merge; None: from the preferences
    cpu_limit : seconds of processor time; None: from the preferences
    memory_limit : bytes, on Linux only; None: from the preferences
    full_resolution : whether to find the parts of a large mesh on all of its triangles, not on a coarser copy; None:
        from the preferences

    Returns
    -------
    Build with poll(), wait(), cancel() and result(); only result() stores the hierarchy
    """
    _check_mesh_object(obj)
    _to_length(quality, "quality")
    _check_optional(_to_positive, cpu_limit=cpu_limit, memory_limit=memory_limit)
    return builds.request_build(MeshSnapshot(obj), quality=quality, mode=mode, cpu_limit=cpu_limit,
                                memory_limit=memory_limit, full_resolution=full_resolution)


def build(obj: Object, quality: float = 0.0, mode: Mode | None = None, cpu_limit: float | None = None,
          memory_limit: int | None = None, progress: Progress | None = None,
          full_resolution: bool | None = None) -> Hierarchy:
    """Builds the hierarchy of the object's mesh, stores it and returns it.

    Parameters
    ----------
    quality ... full_resolution : see start_build()
    progress : called as progress(fraction, stage) ten times a second; returning True cancels
    """
    return start_build(obj, quality, mode, cpu_limit, memory_limit, full_resolution).result(progress)


def hierarchy(obj: Object) -> Hierarchy:
    """The Hierarchy of the object's current mesh, built if there is none."""
    return _labeled_hierarchy(obj, None)


def state(obj: Object) -> State:
    """How the object's mesh matches its hierarchy. Builds nothing.

    Returns
    -------
    State.NONE : there is no hierarchy
    State.UNOPENED : one is stored in the file; its first use loads or refuses it
    State.FITS : it matches the mesh
    State.MOVED : usable, but vertices have moved since
    State.CHANGED : not usable; the next function that needs one builds it again
    """
    _check_mesh_object(obj)
    if registry.get_state(obj.data)[0] != State.UNOPENED:
        registry.get_hierarchy(MeshSnapshot(obj))  # reads the mesh, for changes that Blender has not reported yet
    return registry.get_state(obj.data)[0]


def clear(obj: Object) -> None:
    """Deletes the hierarchy of the object's mesh, also one that is stored in the file. The mesh stays as it is."""
    _check_mesh_object(obj)
    registry.forget(obj.data)


# ---- Parts


@dataclass(frozen=True)
class Part:
    """A node of a hierarchy, and a face in it. Functions accept it in place of a node number."""

    node: int
    face: int
    stops: tuple[int, ...]  # nodes of the wheel stops after a click on the face, from the smallest to the whole
    start: int  # index of the start level in stops
    faces: np.ndarray = field(compare=False, repr=False)  # (n,) indices of the mesh's polygons
    area: float  # of the node's own faces, in the object's units squared
    parent: int | None  # None for the whole
    children: tuple[int, ...]  # the two nodes that merged; () for a single tetrahedron

    def __index__(self) -> int:
        return self.node


def part(obj: Object, face: int, level: int = 0, size: float | None = None, snap: bool = False) -> Part:
    """The part that a click on a face takes.

    Parameters
    ----------
    face : index of a polygon
    level : notches of the wheel after the click, negative for smaller parts; clamped to the path
    size : start from the largest stop of at most this share of the whole area, 0 to 1, or else from the smallest
        stop, instead of the start level
    snap : for the part's faces
    """
    tree, level = hierarchy(obj), _to_integer(level, "level")
    pick = states.pick_face(tree, _to_integer(face, "face"))
    if size is not None:
        size = _to_numbers(size, "size")
        pick = pick.at_stop(sum(tree.area[stop] <= size * tree.area[-1] for stop in pick.stops) - 1)
    node = pick.turn(level).node
    parent = int(tree.parent[node])
    return Part(node, pick.face, pick.stops, pick.start, borders.get_part_faces(MeshSnapshot(obj), tree, node, snap),
                float(tree.area[node]), None if parent < 0 else parent, tuple(sorted(tree.children(node))))


def path(obj: Object, face: int) -> np.ndarray:
    """All nodes that contain a face, (n,), from its leaf to the root; the wheel stops at some of them."""
    return hierarchy(obj).path(_to_integer(face, "face"))


def faces(obj: Object, node: Node, snap: bool = False) -> np.ndarray:
    """The faces of a node: (n,) indices of polygons, in no particular order, read-only."""
    tree, node = _resolve_node(obj, node)
    return borders.get_part_faces(MeshSnapshot(obj), tree, node, snap)


def select(obj: Object, node: Node | None = None, faces: Sequence[int] | np.ndarray | None = None, extend: bool = False,
           deselect: bool = False, snap: bool = False) -> np.ndarray:
    """Selects a node, which becomes the current pick, or the given faces.

    In Edit Mode, the selection follows the select mode. Hidden faces don't change.

    Parameters
    ----------
    node : the node to select
    faces : instead of node: (n,) indices of polygons
    extend : keep the earlier selection
    deselect : remove the faces from the earlier selection instead
    snap : for a node

    Returns
    -------
    (n,) the faces
    """
    if (node is None) == (faces is None):
        raise ValueError("Say what to select: a node, or faces=.")
    _check_mesh_object(obj, changes=True)  # Blender silently drops a selection on a linked mesh
    face = None
    if node is not None:
        tree, number = _resolve_node(obj, node)
        selected = borders.get_part_faces(MeshSnapshot(obj), tree, number, snap)
        face = node.face if isinstance(node, Part) else int(selected[0]) if len(selected) else None
    else:
        selected = _to_indices(faces, "faces", len(arrays.update_mesh(obj).polygons))
    if obj.mode == "EDIT":
        selection.Selection(MeshSnapshot(obj)).select(obj, selected, face, extend, deselect)
    else:
        selection.select_outside_edit_mode(obj.data, selected, extend, deselect)
    if face is not None:
        picks.remember(MeshSnapshot(obj), face, number, snap)
    return selected


def similar(obj: Object, node: Node, threshold: float = THRESHOLD,
            among: Object | None = None) -> list[tuple[int, float]]:
    """Finds parts of similar shape and size, also mirror images. They overlap neither each other nor the node.

    Parameters
    ----------
    threshold : least likeness, 0 to 1
    among : another object to search instead; sizes are compared in the world

    Returns
    -------
    [(node, likeness), ...], the most similar first; likeness is 1 for the same shape and size, down to 0
    """
    tree, node = _resolve_node(obj, node)
    threshold = _to_numbers(threshold, "threshold")
    if among is not None:
        hierarchy(among)
    searched, others = among or obj, [] if among is None else [MeshSnapshot(among)]
    similar = similar_parts.find_similar(MeshSnapshot(obj), tree, node, others)
    return [(similar_part.node, similar_part.likeness) for similar_part in similar
            if similar_part.name == searched.name_full and similar_part.likeness >= threshold]


def mirror_image(obj: Object, node: Node, plane: int = 0) -> int:
    """The node on the other side of the model.

    Parameters
    ----------
    plane : index of the symmetry plane across which the node has another part, the best plane first
    """
    tree, node = _resolve_node(obj, node)
    images = similar_parts.find_mirror_images(MeshSnapshot(obj), tree, node)
    if not 0 <= _to_integer(plane, "plane") < len(images):
        raise ValueError(f"There is no plane {plane}: such planes are numbered from 0 to {len(images) - 1}.")
    return images[plane].node


def remember(obj: Object, node: Node, name: str, snap: bool = False) -> None:
    """Gives the node a name, which the panel lists: the face attribute "part: NAME" of the mesh, 1 on its faces. Raises
    partwheel.Error if the name is in use."""
    _check_mesh_object(obj, changes=True)
    named_parts.remember_part(obj.data, name, faces(obj, node, snap))


def remembered_parts(obj: Object) -> dict[str, int]:
    """The remembered parts: {name: node}, the node with the largest overlap with the remembered faces. Raises
    partwheel.Error if one of the parts no longer exists."""
    tree = hierarchy(obj)
    return {name: named_parts.find_node(MeshSnapshot(obj), tree, name)[0] for name in named_parts.part_names(obj.data)}


def cut(obj: Object, parts: int | None = None, height: float | None = None, least_concavity: int | None = None,
        labels: Sequence[int] | np.ndarray | str | None = None) -> Cut:
    """Divides the whole model into parts, by one of four parameters, or without any by the automatic segmentation.

    Parts without faces, inside the solid, are merged with a neighbor.

    Parameters
    ----------
    parts : number of parts; the last merges are undone
    height : height in the dendrogram
    least_concavity : number of parts; the least total concavity, as for convex hulls
    labels : (F,) integers, one for each polygon; or "MATERIALS", "FACE_SETS", "VERTEX_GROUPS" (the one with the largest weight),
        "LOOSE", or the name of a face attribute. The parts are the polygons of each label, in ascending order, exactly, if
        the mesh is closed. Unless the hierarchy has them already, it is built again with borders there

    Returns
    -------
    partwheel.cut.Cut, a value: cut.split(3), cut.join(3), cut.merge(0, 2) return others; cut.labels (F,) is the part
    of each polygon
    """
    if sum(choice is not None for choice in (parts, height, least_concavity, labels)) > 1:
        raise ValueError("Say how to divide the model by only one of the parameters.")
    if labels is not None:
        face_labels = _read_labels(obj, labels)
        return labeled_cut.find_cut(_labeled_hierarchy(obj, face_labels), face_labels)[0]
    _check_optional(_to_integer, parts=parts, least_concavity=least_concavity)
    _check_optional(_to_length, height=height)
    tree = hierarchy(obj)
    if parts is not None:
        tree.cut_parts(parts)  # raises PartwheelError if there can't be as many
        return Cut.into(tree, operator.index(parts))
    bounds = (tree.cut_height(height) if height is not None else tree.cut_automatic() if least_concavity is None else
              tree.cut_least_concavity(least_concavity))
    return Cut.from_labels(tree, tree.face_labels(bounds))


def _read_labels(obj: Object, labels: Sequence[int] | np.ndarray | str) -> mesh_labels.Labels:
    _check_mesh_object(obj)
    if isinstance(labels, str):
        source = labels if labels in mesh_labels.SOURCES else "ATTRIBUTE"
        return mesh_labels.read_labels(obj, source, labels if source == "ATTRIBUTE" else "")
    face_labels = mesh_labels.Labels(np.unique(labels, return_inverse=True)[1].ravel().astype(np.int32), {})
    _, n_polygons = element_counts(obj.data)
    if len(face_labels.of_face) != n_polygons:
        raise ValueError(f"{obj.name} has {n_polygons} polygons; give a label for each.")
    return face_labels


def _labeled_hierarchy(obj: Object, face_labels: mesh_labels.Labels | None) -> Hierarchy:
    """The object's hierarchy, with borders of parts where the labels differ; built if it has none."""
    _check_mesh_object(obj)
    snapshot = MeshSnapshot(obj)
    return (labeled_cut.find_exact_hierarchy(snapshot, face_labels)
            or builds.request_build(snapshot, **labeled_cut.build_options(face_labels)).result())


def load_cut(obj: Object) -> tuple[Cut, list[str]] | None:
    """(Cut, names of its parts) that write() saved last in the object's mesh, or None."""
    _check_mesh_object(obj)
    saved = saved_cut.load_cut(obj, _labeled_hierarchy(obj, saved_cut.read_chosen_labels(obj.data)))
    return saved and (saved[0], saved_cut.complete_names(obj, *saved))


def write(obj: Object, cut: Cut, to: Iterable[str] = (), names: Sequence[str] | None = None, closed: bool = True,
          origins: bool = True, explode: float = 0.0, shell: float = 0.0, smooth: bool = False, material: bool = False,
          unwrap: bool = False, own_parts: Sequence[int] = ()) -> writing.WriteResult:
    """Saves a cut in the object's mesh and writes it to the chosen results.

    The face attribute "partwheel_part" and the parts' names are always saved. Outside Edit Mode only.

    Parameters
    ----------
    cut : Cut of the current mesh of obj
    to : set of results:
        "FACE_SETS" : one for each part
        "VERTEX_GROUPS" : one for each part, for an armature: 1 inside the part, a smooth falloff across its borders,
            and a sum of 1
        "COLORS" : a material with a color of its own for each part
        "MATERIALS" : the mesh's own materials, with a slot for each part
        "SEAMS" : along borders, in creases, and where a part would not lie flat otherwise; they replace the mesh's
            seams
        "OBJECTS" : in a new collection, each the child of the part that it is attached to
        "BONES" : vertex groups and an armature, obj.find_armature(), with a bone of the same name for each part; it also
            moves the objects, which are its children then
    names : a different name for each part; None: the saved ones, or generated ones that show which parts are alike,
        left or right
    closed : objects are solids that add up to the whole; False: only their own polygons
    origins : origins of objects at the centers of their borders; False: at the object's origin
    explode : offset of objects, times the distance of their centers, by drivers of the root's property "explode"
    shell : thickness of objects' walls, by a modifier; 0: solid
    smooth, material : caps of objects, as for copy_part()
    unwrap : also unwrap along the seams (angle-based) into a new active UV map; the rendered map stays
    own_parts : parts that were made by hand: the wheel stops at them from now on, at their mirror images, and at similar parts.
        Then the object has another hierarchy, so call cut() again

    Returns
    -------
    (names, objects, armature); armature is None without "BONES"

    Raises
    ------
    partwheel.Error : the cut is of another mesh, or a result is impossible
    """
    _check_mesh_object(obj, edited=False, changes=True)
    if isinstance(to, str) or not set(to) <= set(writing.TARGETS):
        raise ValueError(f"to must contain only {', '.join(writing.TARGETS)}.")
    _check_cut(obj, cut)
    if names is not None and (len(names) != len(cut) or len(set(names)) != len(cut)):
        raise ValueError(f"There are {len(cut)} parts; give each part a different name.")
    _to_numbers(explode, "explode")
    _to_numbers(shell, "shell")
    own_parts = _to_indices(own_parts, "own_parts", len(cut))
    known = writing.load_names(obj, cut) if names is None else dict(zip(cut.parts, names))
    plan = run_steps(writing.plan_write(obj, cut, to, known, unwrap, own_parts))
    return writing.write(obj, cut, plan, part_objects.ObjectOptions(
        solids.CapOptions(smooth, material), closed, origins=origins, explode=explode, shell=shell))


class PrintResult(NamedTuple):
    """Result of print_parts()."""

    objects: list[Object]
    pegs: list
    notes: list[str]


def print_parts(obj: Object, cut: Cut, clearance: float | None = 0.2, wall: float = 1.2,
                bed: Sequence[float] | None = None, inserts: Insert | None = None, numbers: bool = False,
                joint: str = "peg") -> PrintResult:
    """Creates a cut's parts as closed objects for a 3D printer, in a new collection.

    Cuts are flat, with a peg and a socket where they are large enough. All lengths are in millimeters, by the scene's units
    and the object's scale. Outside Edit Mode only.

    Parameters
    ----------
    cut : Cut of the current mesh of obj
    clearance : gap around pegs; None: no pegs
    wall : least wall around sockets
    bed : (3,) size of the printer; larger parts are split further
    inserts : partwheel.cut.printing.Insert: dowels or magnets that both sides of a cut get holes for, instead of pegs
    numbers : engrave the same number into the two sides of each cut
    joint : "peg"; or "snap pin" or "dovetail" where these fit, and pegs elsewhere

    Returns
    -------
    (objects, pegs, notes): pegs are partwheel.cut.printing.Peg, in millimeters of the object's own space; notes are
    sentences about what was impossible and about parts that are too thin or too large

    Raises
    ------
    partwheel.Error : manifold3d is missing, or the parts can't be cut
    """
    _check_mesh_object(obj, edited=False)
    _check_cut(obj, cut)
    _to_length(wall, "wall")
    _check_optional(_to_length, clearance=clearance)
    if bed is not None:
        _to_positive(bed, "bed", 3)
    options = PrintOptions(pegs=clearance, wall=wall, bed=bed, inserts=inserts, numbers=numbers, joint=joint)
    printable = run_steps(printing.plan_print(bpy.context, obj, cut, writing.load_names(obj, cut), options))
    return PrintResult(printing.create_print_objects(obj, printable), printable.pegs, printable.notes)


def convex(obj: Object, hulls: int | None = None, error: float | None = None, max_vertices: int | None = None,
           engine: str = "UNREAL", primitives: float = 0.0, keep_open: float | None = None) -> list[Object]:
    """Creates convex hulls that together contain the object's mesh, for game engines.

    They are children of the object, in a collection of their own. They replace earlier ones of the same object.
    Outside Edit Mode only.

    Parameters
    ----------
    hulls : number of hulls; fewer where more would not improve the fit
    error : instead of hulls: largest distance of a hull from the mesh, in the object's own space, with as few hulls as possible
    max_vertices : of each hull, at least 8
    engine : naming: "UNREAL", UCX_<object's name>_00 ...; "GODOT", <name>_00-convcolonly; "UNITY",
        <name>_collider_00; "RIGID_BODY": the object becomes a rigid body with the hulls as its shape
    primitives : largest distance at which a box, sphere, capsule or cylinder replaces a hull, if the engine has it:
        UBX_, USP_, UCP_; <name>_box_00; 0: hulls only
    keep_open : radius of a ball: openings that it passes stay free, as far as there are enough hulls

    Returns
    -------
    [object, ...], the largest first
    """
    _check_mesh_object(obj, edited=False)
    if engine not in hull_objects.NAME_PATTERNS:
        raise ValueError(f"engine must be one of {', '.join(hull_objects.NAME_PATTERNS)}.")
    _to_length(primitives, "primitives")
    _check_optional(_to_length, error=error, keep_open=keep_open)
    _check_optional(_to_integer, hulls=hulls, max_vertices=max_vertices)
    convex_parts = hierarchy(obj).convex_parts(hulls, error=error, max_vertices=max_vertices, keep_open=keep_open)
    return hull_objects.create_hulls(bpy.context, obj, [hull_objects.HullGroup(convex_parts)], engine, primitives,
                                     error or keep_open or 0.0)


# ---- Solids. smooth: caps that continue the surface, not flat facets. material: caps get a material of their own.


def copy_part(obj: Object, node: Node, smooth: bool = False, material: bool = False, snap: bool = False) -> Object:
    """Copies the node as a closed solid: a new object in the part's place.

    It has the object's parent, modifiers, animation and custom properties. Polygons keep all their attributes; the
    face attribute "partwheel_cap" marks the caps. With snap, the border moves as far as the tetrahedra around it
    allow. Outside Edit Mode only. Raises partwheel.Error if the part can't be closed.
    """
    _check_mesh_object(obj, edited=False)
    tree, node = _resolve_node(obj, node)
    return composition.create_part_object(obj, tree, node, solids.CapOptions(smooth, material), snap)


def remove(obj: Object, node: Node, smooth: bool = False, material: bool = False, snap: bool = False) -> None:
    """Removes the node from the object's mesh and closes the hole.

    Parameters and errors are those of copy_part(). The removed part and the rest add up to the whole. Outside Edit
    Mode only.
    """
    _check_mesh_object(obj, edited=False, changes=True)
    tree, node = _resolve_node(obj, node)
    composition.remove_part(obj, tree, node, solids.CapOptions(smooth, material), snap)


def split(obj: Object, parts: int | None = None, height: float | None = None, explode: float = 0.0,
          smooth: bool = False, material: bool = False, least_concavity: int | None = None) -> list[Object]:
    """Creates an object for each part of a cut, in a new collection.

    The objects are closed solids whose caps match exactly, unless smooth; on a defective mesh, a part that can't be
    closed stays open. They are siblings. Outside Edit Mode only.

    Parameters
    ----------
    parts, height, least_concavity : as for cut()
    explode : offset of each object, times its distance from the center, by drivers as in write()
    """
    _check_mesh_object(obj, edited=False)
    _to_numbers(explode, "explode")
    segmentation = cut(obj, parts, height, least_concavity)
    return part_objects.create_siblings(obj, segmentation, solids.CapOptions(smooth, material), explode)


def delete_loose_bits(obj: Object, size: float = loose_bits.DEFAULT_SIZE) -> int:
    """Deletes floating fragments from the object's mesh, and returns the number of deleted faces.

    Parameters
    ----------
    size : largest size of a fragment, the diagonal of its bounding box as a fraction of the mesh's. The largest
        connected piece always stays
    """
    _check_mesh_object(obj, changes=True)
    _to_length(size, "size")
    return loose_bits.delete_loose_bits(obj, size)


def place(obj: Object, location: Sequence[float], normal: Sequence[float] = (0, 0, 1), scale: float = 1.0,
          angle: float = 0.0, depth: float = 0.0, target: Object | None = None, fit: bool = False,
          mirror: bool = False) -> Object | None:
    """Moves an object, for example a copied part, so that its border (of the largest group of caps) touches a
    surface.

    Outside Edit Mode only.

    Parameters
    ----------
    obj : mesh object that moves
    location : (3,) point in the world
    normal : (3,) surface normal there; the border turns against it
    scale : factor of the object's size
    angle : around the normal
    depth : how far the part sinks in, in radii of the border, beyond the little that a union needs
    target : mesh object to place it on, for fit and mirror
    fit : onto the target's border nearest to location, and with its size
    mirror : also create the mirror image across the target's own YZ plane, and return it
    """
    _check_mesh_object(obj, edited=False)
    if obj.library:
        raise ValueError(f"{obj.name} is linked from another file and can't be moved: make it local first.")
    if fit or mirror:
        _check_mesh_object(target, edited=False)
    location, normal = (Vector(_to_numbers(vector, name, 3)) for name, vector in (("location", location), ("normal", normal)))
    if not normal.length:
        raise ValueError("normal must not be 0: it says where the outside of the surface is.")
    _check_adjustment(scale, angle, depth)
    return placement.place(obj, target, placement.Pose(location, normal, scale, angle, depth, fit), mirror)


def unite(obj: Object, others: Sequence[Object], blend: float = 0.0) -> None:
    """Makes the object's mesh the union of the object and others, by Blender's Boolean. The others stay.

    If all are closed, so is the union, if a solver can do it. Open meshes keep their holes. N-gons, layers, materials
    and the object's shape keys are kept; the others' modifiers are applied, except those that the object has, too.
    Outside Edit Mode only.

    Parameters
    ----------
    others : mesh objects
    blend : width of a smooth transition on either side of each seam, in radii of the seam; it moves vertices and adds
        none

    Raises
    ------
    partwheel.Error : a mesh has no faces, a closed one is inside out, or every solver loses surface that should stay
    """
    _check_mesh_object(obj, edited=False, changes=True)
    if not isinstance(others, Iterable):
        raise ValueError(f"others must be mesh objects, not {others!r}.")
    others = list(others)
    for other in others:
        _check_mesh_object(other, edited=False)
    if not others or obj in others:
        raise ValueError(f"Say which other objects to unite {obj.name} with.")
    _to_length(blend, "blend")
    union.unite(obj, others, blend)


def compatible(obj: Object, node: Node, other: Object) -> list[tuple[int | None, float]]:
    """Finds parts of another object that can stand in for the node. Outside Edit Mode only.

    Parameters
    ----------
    other : mesh object; may be obj, for parts that don't overlap the node

    Returns
    -------
    [(node, score), ...], the most compatible first, without near duplicates; score is 1 for the same shape, down to
    0; node is None for the other object itself, if it is a part that was copied as a solid

    Raises
    ------
    partwheel.Error : the node is the whole or has no border, or the other has no parts
    """
    return [(candidate.node, candidate.score)
            for candidate in _create_swap_target(obj, node, other).find_candidates([other])]


def swap(obj: Object, node: Node, other: Object, other_node: int | None = None, scale: float = 1.0, angle: float = 0.0,
         depth: float = 0.0, mirror: bool = False, blend: float = 0.0, snap: bool = False) -> int | None:
    """Exchanges the node for a part of another object, which stays as it is.

    The rest of obj is united with a copy of the other's part, whose border is fitted to the node's. Outside Edit Mode
    only.

    Parameters
    ----------
    other : mesh object
    other_node : its node; None: the most compatible one
    scale : factor of the fitted size
    angle : around the border's normal
    depth : in radii of the border
    mirror : use the mirror image
    blend : see unite()
    snap : for both parts' borders

    Returns
    -------
    the other's node, or None if it was the object itself

    Raises
    ------
    partwheel.Error : as for compatible(), copy_part() and unite()
    """
    _check_mesh_object(obj, changes=True)
    _check_adjustment(scale, angle, depth)
    _to_length(blend, "blend")
    target = _create_swap_target(obj, node, other, snap)
    if other_node is None:
        candidate = target.find_candidates([other])[0]
    else:
        candidate = target.find_candidate(other, _to_integer(other_node, "other_node"))
    target.swap(candidate, swapping.Adjustment(scale, angle, depth, mirror), blend)
    return candidate.node


# ---- Deformation: of the active shape key, if any; mirrored across the x axis if the mesh's X symmetry is on; in any
# ---- mode. progress(fraction, "deform") is called at every iteration, with the fraction of the iteration limit; most
# ---- deformations need few. Returning True cancels, and so does time_limit (seconds): PartwheelError, CANCELED.


def deform(obj: Object, node: Node, handle: Sequence[int], matrix: np.ndarray, rings: int = 0, snap: bool = False,
           progress: Progress | None = None, time_limit: float | None = None) -> None:
    """Deforms a node's part as rigidly as possible. The part's border and the rest of the mesh stay in place.

    Parameters
    ----------
    handle : indices of vertices inside the part
    matrix : (4, 4) that moves the handle
    rings : rings of faces around the part that deform, too

    Raises
    ------
    ValueError : there is nothing to deform, or nothing fixed, or the handle is not inside the part
    """
    _check_mesh_object(obj, changes=True)
    handle, matrix = _to_indices(handle, "handle", len(arrays.update_mesh(obj).vertices)), _to_numbers(matrix, "matrix", 4, 4)
    region = Region(obj, faces(obj, node, snap), _to_integer(rings, "rings"), obj.data.use_mirror_x)
    if not len(handle):
        raise ValueError(f"The handle has no vertices: give some from inside the part, such as {region.example()}.")
    region_indices = region.indices(handle)
    is_inside = (region_indices >= 0) & region.free[region_indices]
    if not is_inside.all():
        raise ValueError(f"Vertex {handle[~is_inside][0]} of the handle is not inside the part: it is on its border, beyond it, "
                         f"or hidden. Take vertices that only faces of the part have, such as {region.example()}; or with "
                         "rings=, more of the mesh deforms.")
    _apply_deformation(obj, region, methods.AsRigidAsPossible(region, [region_indices]), matrix, progress, time_limit)


def bend(obj: Object, node: Node, rotation: np.ndarray, reach: float = REACH, snap: bool = False,
         progress: Progress | None = None, time_limit: float | None = None) -> None:
    """Turns a node's part about its joint, the center of its border. The part keeps its shape, except near the
    border.

    Parameters
    ----------
    rotation : (3, 3)
    reach : distance from the border within which both sides bend, in radii of the border

    Raises
    ------
    ValueError : there is no joint
    """
    _check_mesh_object(obj, changes=True)
    linear, _ = _to_numbers(rotation, "rotation", 3, 3), _to_positive(reach, "reach")
    region = Region(obj, faces(obj, node, snap), mirror=obj.data.use_mirror_x, reach=reach)
    matrix = affine(linear, region.center - linear @ region.center)
    _apply_deformation(obj, region, methods.JointBending(region), matrix, progress, time_limit)


def _apply_deformation(obj: Object, region: Region, shape: methods.AsRigidAsPossible, matrix: np.ndarray,
                       progress: Progress | None, time_limit: float | None) -> None:
    _check_optional(_to_length, time_limit=time_limit)
    watch = _ProgressMonitor(progress, time_limit)
    shape.solve([matrix], watch)
    if watch.reason:
        raise PartwheelError(Status.CANCELED, f"{watch.reason} The mesh is unchanged.")
    VertexWriter(obj, region).write(obj, shape.points())


class _ProgressMonitor:
    """A threading.Event for iterations that counts the calls of is_set(), reports progress and checks the time."""

    def __init__(self, progress: Progress | None, time_limit: float | None) -> None:
        self.progress, self.seconds, self.start_time = progress, time_limit, time.monotonic()
        self.n_calls, self.reason = 0, None

    def is_set(self) -> bool:
        if self.seconds is not None and time.monotonic() - self.start_time > self.seconds:
            self.reason = f"The deformation was not done in {self.seconds:g} seconds."
        elif self.progress and self.progress(min(self.n_calls / MAX_ITERATIONS, 1.0), "deform"):
            self.reason = "The deformation was canceled."
        self.n_calls += 1
        return self.reason is not None


# ---- Helpers


def _check_mesh_object(obj: Object | None, edited: bool = True, changes: bool = False) -> None:
    """Raises ValueError if obj is no mesh object; or is in Edit Mode, unless edited; or is not editable, if changes."""
    if not isinstance(obj, Object) or obj.type != "MESH":
        raise ValueError(f"{getattr(obj, 'name', obj)} is not a mesh object. Give one, such as bpy.context.active_object.")
    if changes and read_only_reason(obj):
        raise ValueError(read_only_reason(obj))
    if obj.mode == "EDIT" and not edited:
        raise ValueError(f"{obj.name} is in Edit Mode. Leave Edit Mode before you call this function.")


def _to_numbers(values: object, name: str, *shape: int, above: float = -np.inf, at_least: float = -np.inf) -> np.ndarray:
    """The values as float64 of a shape. Raises ValueError unless all are finite and within the limits."""
    try:
        numbers = np.asarray(values, np.float64)
    except (TypeError, ValueError):
        numbers = np.array([None])  # of no shape
    if numbers.shape != shape or not (np.isfinite(numbers) & (numbers > above) & (numbers >= at_least)).all():
        limits = f" above {above:g}" if above > -np.inf else f" of at least {at_least:g}" if at_least > -np.inf else ""
        count = f"have {' x '.join(map(str, shape))} finite numbers" if shape else "be a finite number"
        raise ValueError(f"{name} must {count}{limits}, not {values!r}.")
    return numbers


_to_positive = partial(_to_numbers, above=0)
_to_length = partial(_to_numbers, at_least=0)


def _to_integer(value: object, name: str) -> int:
    """Raises ValueError unless it is an integer; whoever takes it knows its limits. A Part, or a part of a cut, is its node."""
    try:
        return operator.index(value)
    except TypeError:
        raise ValueError(f"{name} must be an integer, not {value!r}.") from None


def _check_optional(convert: Callable[[object, str], object], **values: object) -> None:
    """Raises ValueError unless convert(value, name) accepts each value that isn't None."""
    for name, value in values.items():
        if value is not None:
            convert(value, name)


def _to_indices(values: object, name: str, count: int) -> np.ndarray:
    """The values as int64 (n,). Raises ValueError unless they are integers from 0 to count - 1."""
    indices = np.asarray(values).ravel()
    if len(indices) and (indices.dtype.kind not in "iu" or not 0 <= indices.min() <= indices.max() < count):
        raise ValueError(f"{name} must be integers from 0 to {count - 1}, not {indices}. Get them from a mask by numpy.flatnonzero().")
    return indices.astype(np.int64)


def _check_adjustment(scale: float, angle: float, depth: float) -> None:
    """Raises ValueError unless these are numbers that an object can be moved by."""
    _to_positive(scale, "scale")
    _to_numbers(angle, "angle")
    _to_numbers(depth, "depth")


def _resolve_node(obj: Object, node: Node) -> tuple[Hierarchy, int]:
    """(the object's Hierarchy, node number). Raises PartwheelError, or Refused for a part of another cut."""
    if isinstance(node, CutPart):
        _check_cut(obj, node.cut)
    tree, number = hierarchy(obj), _to_integer(node, "node")
    tree.faces(number)
    return tree, number


def _check_cut(obj: Object, cut: Cut) -> None:
    """Raises Refused if the cut is not of the object's current hierarchy."""
    if cut.hierarchy is not hierarchy(obj):
        raise Refused(f"The cut is not of {obj.name} as it is now: call cut() again.")


def _create_swap_target(obj: Object, node: Node, other: Object, snap: bool = False) -> swapping.SwapTarget:
    for mesh_obj in (obj, other):
        _check_mesh_object(mesh_obj, edited=False)
    tree, node = _resolve_node(obj, node)
    if placement.cap_faces(other.data) is None:
        hierarchy(other)
    return swapping.SwapTarget(obj, tree, node, snap)


def register() -> None:
    """Makes the module available as partwheel.api, whatever the add-on's package is called."""
    partwheel.api = sys.modules[MODULE_NAME] = sys.modules[__name__]


def unregister() -> None:
    if getattr(partwheel, "api", None) is sys.modules[__name__]:
        del partwheel.api, sys.modules[MODULE_NAME]
