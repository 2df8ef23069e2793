# SPDX-License-Identifier: GPL-3.0-or-later
"""For scripts and other add-ons: what the operators do, as functions of a mesh object, in any mode, with or without a
window. While the add-on is enabled, whatever its repository is called, and in Blender 3.4 too:

    from partwheel import api

    obj = bpy.context.active_object
    arm = api.part(obj, 42, level=2)       # a click on face 42 and two notches up
    api.select(obj, arm)
    copy = api.copy_part(obj, arm)         # the part as a closed solid, a new object
    fingers = api.similar(obj, finger)     # [(node, likeness), ...] of the parts that are alike
    cut = api.cut(obj, parts=8)            # the whole model in parts; cut.labels: the part of each face, 0 to 7
    api.write(obj, cut, to={"OBJECTS", "VERTEX_GROUPS"})
    hand = api.copy_part(obj, cut[3])      # a part of the cut, where a node is wanted
    api.convex(obj, hulls=16, max_vertices=64)  # convex colliders
    api.swap(obj, arm, other)              # exchanged for the most compatible part of another object

The object comes first, then the node: a number of the object's hierarchy, a partwheel.Hierarchy, or the Part that
part() gives, or a part of a cut as cut[3]. Everything is counted from 0. partwheel.hierarchy has a table of what the
numbers mean and how to convert them. Lengths, areas and matrices are in the object's own space unless it says "world", angles in radians. snap:
with the part's border moved to the creases nearby. Functions build the hierarchy if there is none; only start_build()
does not wait for it. One build runs at a time: those that are under way already come first.

Errors are partwheel.Error, whose text says what is wrong and what to do, most of them PartwheelError, whose status
tells what kind; or ValueError for what can't be meant: no mesh object, one linked from another file that is to change,
one that is in Edit Mode where that matters. Nothing has changed then. Undo steps are the caller's.
"""

import operator
import sys
import time
from dataclasses import dataclass, field
from typing import NamedTuple

import bpy
import numpy
from mathutils import Vector

import partwheel
from .compose import placement, swapping, union
from .deform import methods
from .deform.region import Region
from .deform.vertex_writer import VertexWriter
from .cut import hulls as hull_objects
from .cut import objects as part_objects
from .cut import print_parts as printing
from .cut import saved_cut, writing
from .mesh import arrays, selection
from .mesh.errors import Refused, read_only_reason
from .parts import builds, picks, registry
from .pick import borders, states
from .related import named_parts, similar_parts
from .solid import composition, solids
from partwheel import PartwheelError, Status
from partwheel.cut import Cut, CutPart
from partwheel.deform import MAX_ITERATIONS
from partwheel.joint import REACH
from partwheel.likeness import THRESHOLD

Build, State = builds.QueuedBuild, registry.State
NAME = f"{partwheel.__name__}.api"  # by which scripts import this module


# ---- Hierarchies


def start_build(obj, quality=0.0, open_surfaces=False, mode=None, cpu_limit=None, memory_limit=None, exactly=None):
    """A Build of the object's mesh as it is now; returns at once. It changes nothing until its result() is asked for.
    The one under way is found again, if it is of the same mesh and options; else it is cancelled for this one.

    quality: 0 adds no points inside the mesh; from 1.1 on it bounds how stretched the tetrahedra may be. open_surfaces:
    take a sheet for a thin solid, instead of refusing it. mode: a partwheel.Mode, how parts are joined. cpu_limit:
    seconds of processor time. memory_limit: bytes, kept on Linux only. exactly: find the parts of a large mesh on all of
    its triangles, not on a coarser copy. None: as the add-on's preferences have it."""
    _mesh(obj)
    return builds.request_build(obj, quality=quality, open_surfaces=open_surfaces, mode=mode, cpu_limit=cpu_limit,
                                memory_limit=memory_limit, exactly=exactly)


def build(obj, quality=0.0, open_surfaces=False, mode=None, cpu_limit=None, memory_limit=None, progress=None,
          exactly=None):
    """Builds the hierarchy of the object's mesh, keeps it and returns it: start_build() and its result()."""
    return start_build(obj, quality, open_surfaces, mode, cpu_limit, memory_limit, exactly).result(progress)


def hierarchy(obj):
    """The Hierarchy of the object's mesh as it is now, built if there is none."""
    _mesh(obj)
    return registry.get_hierarchy(obj) or builds.request_build(obj).result()


def state(obj):
    """How the object's mesh stands to its hierarchy, a State: NONE; UNOPENED, one came with the file and is opened, or
    refused, at its first use; FITS; MOVED, usable, but vertices have moved since; CHANGED, not usable, the next
    function that needs one builds anew. Builds nothing."""
    _mesh(obj)
    if registry.get_state(obj.data)[0] != State.UNOPENED:
        registry.get_hierarchy(obj)  # looks at the mesh itself, for what Blender has not told of yet
    return registry.get_state(obj.data)[0]


def clear(obj):
    """Lets the hierarchy of the object's mesh go, also one that came with the file. The mesh stays as it is."""
    _mesh(obj)
    picks.forget_parts(obj)


# ---- Parts


@dataclass(frozen=True)
class Part:
    """A node of a hierarchy, seen from a face that it holds. Wherever a node is wanted, the Part will do."""

    node: int
    face: int
    stops: tuple  # nodes, growing up to the whole: where the wheel stops after a click on the face
    start: int  # index of the stop that a click alone takes
    faces: numpy.ndarray = field(compare=False, repr=False)  # (n,) indices of the mesh's polygons
    area: float  # of the node's own faces, in the object's units squared
    parent: int  # the node above; None for the whole
    children: tuple  # the two nodes that it was joined of; () for a single tetrahedron

    def __index__(self):
        return self.node


def part(obj, face, level=0, size=None, snap=False):
    """The Part that a click on this face, an index of the mesh's polygons, takes, after level notches of the wheel
    (negative: down; held at both ends). size: not from where a click lands, but from the largest stop of at most this
    share of the whole's area, 0..1, or else the smallest stop. snap: for its faces. PartwheelError: no such face."""
    built = hierarchy(obj)
    picked = states.pick_face(built, operator.index(face))
    if size is not None:
        picked = picked.at(sum(built.area[stop] <= size * built.area[-1] for stop in picked.stops) - 1)
    node = picked.turn(level).node
    return Part(node, picked.face, picked.stops, picked.start, borders.get_part_faces(obj, built, node, snap),
                float(built.area[node]), int(built.parent[node]) if built.parent[node] >= 0 else None,
                tuple(numpy.flatnonzero(built.parent == node).tolist()))


def path(obj, face):
    """(n,) the nodes that hold a face, growing: from its leaf to the root. All of them; the wheel stops at some (in
    partwheel.Mode.PAPER at all)."""
    return hierarchy(obj).path(face)


def faces(obj, node, snap=False):
    """(n,) the faces of a node: indices of the mesh's polygons, in no certain order, read-only."""
    built, node = _node(obj, node)
    return borders.get_part_faces(obj, built, node, snap)


def select(obj, node=None, faces=None, extend=False, deselect=False, snap=False):
    """Selects a node, which so becomes the part picked last, or these faces, indices of polygons; and nothing else,
    but with extend what was selected before too, with deselect only what was and is not among these. In Edit Mode as
    the select mode has it. Hidden faces stay as they are. snap: of a node. Returns (n,) the faces."""
    if (node is None) == (faces is None):
        raise ValueError("Say what to select: a node, or faces=.")
    _mesh(obj, changes=True)  # Blender drops a selection that is set on a linked mesh, without a word
    face = None
    if node is not None:
        built, number = _node(obj, node)
        chosen = borders.get_part_faces(obj, built, number, snap)
        face = node.face if isinstance(node, Part) else int(chosen[0]) if len(chosen) else None
    else:
        chosen, count = numpy.array(faces, int).ravel(), len(arrays.update_mesh(obj).polygons)
        if len(chosen) and not 0 <= chosen.min() <= chosen.max() < count:
            raise ValueError(f"{obj.name} has the faces 0 to {count - 1}; others were to be selected.")
    if obj.mode == "EDIT":
        selection.Selection(obj).select(obj, chosen, face, extend, deselect)
    else:
        selection.select_outside_edit_mode(obj.data, chosen, extend, deselect)
    if face is not None:
        picks.remember(obj, face, number, snap)
    return chosen


def similar(obj, node, threshold=THRESHOLD, among=None):
    """[(node, likeness), ...] the other parts that are alike in shape and size, mirror images among them, the most alike
    first; none overlaps another or the node. likeness: 1 for the same down to 0; threshold: the least. among: another
    object, of which they are instead; sizes are those in the world."""
    if among is not None:
        hierarchy(among)
    where, found = among or obj, similar_parts.find_similar(obj, *_node(obj, node), [among] * (among is not None))
    return [(each.node, each.likeness) for each in found if each.name == where.name_full and each.likeness >= threshold]


def mirrored(obj, node, plane=0):
    """The node on the other side of the model. plane: of the planes in which it is its own mirror image and the node has
    another part on its other side, the best one first, counted from 0. partwheel.Error: there is none."""
    images = similar_parts.find_mirror_images(obj, *_node(obj, node))
    if not 0 <= plane < len(images):
        raise ValueError(f"There is no plane {plane}: such planes are numbered from 0 to {len(images) - 1}.")
    return images[plane].node


def remember(obj, node, name, snap=False):
    """The node gets a name, which the panel lists: the face attribute "part: NAME" of the mesh, 1 on its faces.
    partwheel.Error: another has it."""
    _mesh(obj, changes=True)
    named_parts.remember_part(obj.data, name, faces(obj, node, snap))


def remembered(obj):
    """{name: node} of the remembered parts: that which has most in common with the faces then. partwheel.Error: one of
    them is no more."""
    built = hierarchy(obj)
    return {name: named_parts.find_node(obj, built, name)[0] for name in named_parts.part_names(obj.data)}


def cut(obj, parts=None, height=None, least_concavity=None):
    """The whole model in parts, a partwheel.cut.Cut, by one of three, or by none as people would most likely take them.
    parts: into so many, the last merges undone. least_concavity: into so many, those with the least concavity in total,
    as for convex hulls. height: at this height of the dendrogram. What is inside the solid, without a face, goes with the
    part beside it.

    It is a value: cut.split(3), cut.join(3), cut.merge(0, 2) give others. cut.labels (F,): the part of each polygon."""
    built = hierarchy(obj)
    bounds = _bounds(built, parts, height, least_concavity)
    return Cut.from_labels(built, built.face_labels(bounds)) if parts is None else Cut.into(built, operator.index(parts))


def kept_parts(obj):
    """(the Cut that was written last and is kept in the object's mesh, its parts' names); None if there is none."""
    built = hierarchy(obj)
    found = saved_cut.load_cut(obj, built)
    return found and (found[0], saved_cut.complete_names(obj, *found))


def write(obj, cut, to=(), names=None, closed=True, origins=True, explode=0.0, shell=0.0, smooth=False,
          material=False, unwrap=False):
    """Keeps a cut in the object's mesh, as the face attribute "partwheel_part" and the parts' names, and writes it to
    any of these: "FACE_SETS"; "VERTEX_GROUPS", for an armature: 1 within a part, falling smoothly across its borders,
    adding up to 1; "COLORS", a material of its own for each part; "MATERIALS", the mesh's own, with a slot for each
    part; "SEAMS", along the borders, in creases, and where a part would not lie flat otherwise, in place of the mesh's;
    "OBJECTS", in a new collection, each the child of the part that it hangs on; "BONES": the vertex groups, and an
    armature with bones of their names, obj.find_armature(), that moves the object.

    names: one for each part; None: those that are kept, or such as say what is left, right and alike. Objects: closed:
    as solids that make the whole, else their own polygons alone. origins: in the middle of the border, else all where
    the object's is. explode: moved apart by so many times the distance of their middles, by drivers: the root's
    property "explode" changes it. shell: so thick, by a modifier. smooth, material: of caps, as for copy_part().
    Seams: unwrap: by Blender, angle-based, as a UV map of its own, the active one; what is rendered by others stays.
    Returns (names, objects, armature), the last None unless to "BONES". partwheel.Error: the cut is of another mesh, or it
    can't be done; nothing has changed then.
    Outside Edit Mode only."""
    _mesh(obj, edited=False, changes=True)
    if isinstance(to, str) or not set(to) <= set(writing.TARGETS):
        raise ValueError(f"to is to be some of {', '.join(writing.TARGETS)}.")
    built = hierarchy(obj)
    if cut.hierarchy is not built:
        raise Refused(f"The cut is not of {obj.name} as it is now: ask for its parts again.")
    if names is not None and (len(names) != len(cut) or len(set(names)) != len(cut)):
        raise ValueError(f"There are {len(cut)} parts; as many names are needed, each another one.")
    known = None if names is None else dict(zip(cut.parts, names))
    return writing.write(obj, cut, to, known, part_objects.ObjectOptions(solids.CapOptions(smooth, material), closed,
                                                                       origins, explode, shell), unwrap)


def print_parts(obj, cut, clearance=0.2, wall=1.2, bed=None):
    """A cut's parts as closed objects for a 3D printer, in a new collection: flat cuts, a peg and a socket across each
    where there is room. All in millimetres, as the scene's units and the object's scale have it. clearance: the gap
    around pegs; None: no pegs. wall: what stays around sockets. bed (3,): parts that are larger are split further.

    Returns (objects, pegs, notes): pegs as partwheel.cut.printing.Peg, in millimetres of the object's own space; notes:
    sentences on what could not be done, and on what is too thin or too large. partwheel.Error: manifold3d is not there,
    or it can't be done; nothing has changed then."""
    _mesh(obj, edited=False)
    if cut.hierarchy is not hierarchy(obj):
        raise Refused(f"The cut is not of {obj.name} as it is now: ask for its parts again.")
    plan = printing.plan_print(bpy.context, obj, cut, writing.load_names(obj, cut), clearance, wall, bed)
    return Printed(printing.create_print_objects(obj, plan), plan.printable.pegs, plan.printable.notes)


def convex(obj, hulls=None, error=None, max_vertices=None, engine="UNREAL", primitives=0.0):
    """[object, ...] convex hulls that together contain the object's mesh and little else, for game engines: children of
    the object, in a new collection; the largest first. Those that were made for it before are removed, and their
    collection is taken. Give one of the two: hulls: so many, fewer where more would gain nothing. error: as few as are
    found of which none goes farther than that from the mesh, in the object's own space. max_vertices: of each hull, 8 or
    more.

    engine: whose names they have: "UNREAL", UCX_<the object's name>_00 and so on; "GODOT", <name>_00-convcolonly;
    "UNITY", <name>_collider_00; "RIGID_BODY", Blender's own: the object becomes a rigid body, and they together are its
    shape. primitives: a box, sphere, capsule or cylinder is taken where it goes no farther than that from the hull, as
    far as the engine has these: UBX_, USP_, UCP_; <name>_box_00; 0: hulls alone. partwheel.Error: other objects have these
    names; nothing has changed then. Outside Edit Mode only."""
    _mesh(obj, edited=False)
    if engine not in hull_objects.NAME_PATTERNS:
        raise ValueError(f"engine is to be one of {', '.join(hull_objects.NAME_PATTERNS)}.")
    found = hierarchy(obj).convex_parts(hulls, error=error, max_vertices=max_vertices)
    return hull_objects.create_hulls(bpy.context, obj, found, engine, primitives)


class Printed(NamedTuple):
    objects: list
    pegs: list
    notes: list


# ---- Solids. smooth: caps that go on as the surface does, not the flat facets inside the solid. material: caps get a
# ---- material of their own.


def copy_part(obj, node, smooth=False, material=False, snap=False):
    """A new object in the part's place: the node as a closed solid, and all else as the object has it: parent, modifiers,
    animation, custom properties. Its polygons keep all their attributes; the caps that close it are marked by the face
    attribute "partwheel_cap". snap: as far as the tetrahedra about the border let
    it be there. partwheel.Error: it can't be closed. Outside Edit Mode only."""
    _mesh(obj, edited=False)
    built, node = _node(obj, node)
    return composition.create_part_object(obj, built, node, solids.CapOptions(smooth, material), snap)


def remove(obj, node, smooth=False, material=False, snap=False):
    """Takes the node out of the object's mesh and closes the hole; arguments and errors as for copy_part(). What it
    removes and what copy_part() gives make the whole. Outside Edit Mode only."""
    _mesh(obj, edited=False, changes=True)
    built, node = _node(obj, node)
    composition.remove_part(obj, built, node, solids.CapOptions(smooth, material), snap)


def split(obj, parts=None, height=None, explode=0.0, smooth=False, material=False, least_concavity=None):
    """[object, ...] new ones in a new collection, one for each part of a cut as cut() makes it: closed solids whose
    caps match exactly (unless smooth). Each is moved out by explode times its distance from the middle. Outside Edit
    Mode only."""
    _mesh(obj, edited=False)
    built = hierarchy(obj)
    bounds = _bounds(built, parts, height, least_concavity)
    return composition.split_into_objects(obj, built, bounds, solids.CapOptions(smooth, material), explode)


def place(obj, location, normal=(0, 0, 1), scale=1.0, angle=0.0, depth=0.0, target=None, fit=False, mirror=False):
    """Moves an object, one that copy_part() made for instance, so that its border, the largest group of its caps, comes
    to location in the world, turned against the surface's normal there. scale: times its size. angle: about the normal.
    depth: how far it is sunk in, times the border's radius, beyond the little that a union needs.

    target: the mesh object it goes onto. fit: onto the target's border nearest to location, and of its size. mirror:
    the mirror image across the target's own YZ plane as well; it is returned, else None. ValueError: no border
    there. Outside Edit Mode only."""
    _mesh(obj, edited=False)
    if obj.library:
        raise ValueError(f"{obj.name} is linked from another file and can't be moved: make it local first.")
    if fit or mirror:
        _mesh(target, edited=False)
    return placement.place(obj, target, placement.Pose(Vector(location), Vector(normal), scale, angle, depth, fit),
                           mirror)


def unite(obj, others, blend=0.0):
    """Makes the object's mesh the union of it and the other objects, which stay, by Blender's Boolean: n-gons, layers,
    materials and the object's shape keys kept; modifiers of the others applied, but for those that the object has too. Outside
    Edit Mode only.

    blend: the width of a smooth transition on either side of each seam, times the seam's radius; it moves vertices
    there, and has no more of them than the solids. partwheel.Error, before anything has changed: one of them is not
    closed, or no solver gave a closed mesh of a possible volume."""
    _mesh(obj, edited=False, changes=True)
    for other in others:
        _mesh(other, edited=False)
    if not others or obj in others:
        raise ValueError(f"Say which other objects {obj.name} is to be united with.")
    union.unite(obj, others, blend)


def compatible(obj, node, other):
    """[(node, score), ...] parts of another mesh object that can stand in for the node, the most compatible first; each
    clearly another part than those before. score: 1 for the same shape, down to 0. The node is None for the other
    object itself, if it is a part that was copied as a solid. other may be obj: then parts beside the node.
    partwheel.Error: the node is the whole, or has no border; or the other has no parts. Outside Edit Mode only."""
    return [(offer.node, offer.score) for offer in _place(obj, node, other).find_candidates([other])]


def swap(obj, node, other, other_node=None, scale=1.0, angle=0.0, depth=0.0, mirror=False, blend=0.0,
         snap=False):
    """Exchanges the node for a part of another object: what is left without it is united with a copy of the other's
    part, brought there border to border, of its size, and turned as it fits best. other_node: None for the most
    compatible one. scale, angle (about the border's normal), depth (radii of the border) change that; mirror takes its
    mirror image; blend is that of unite(); snap moves both parts' borders. The other object stays as it is. The other's
    node that stood in, or None if it was the object itself.

    partwheel.Error, before anything has changed: as for compatible(), copy_part() and unite(). Outside Edit Mode only.
    """
    _mesh(obj, changes=True)
    place = _place(obj, node, other, snap)
    offer = place.find_candidates([other])[0] if other_node is None else place.find_candidate(other, operator.index(other_node))
    place.swap(offer, swapping.Adjustment(scale, angle, depth, mirror), blend)
    return offer.node


# ---- Deforming: in the shape key that is active, if any, and across the x axis too if the mesh has that on, in any
# ---- mode. progress(fraction, what): called at every iteration, with the share of those allowed; most need few.
# ---- Returning True cancels, and so does time_limit, seconds by the clock: PartwheelError, status CANCELLED.


def deform(obj, node, handle, matrix, rings=0, snap=False, progress=None, time_limit=None):
    """Deforms a node's part as rigidly as possible: the handle, vertices of it (indices of the mesh's), go to matrix
    (4,4) times their place; the part's border and all beyond stay. rings: so many rings of faces around the part take
    part. ValueError: there is nothing to deform, or nothing to hold it, or the handle is not inside."""
    _mesh(obj, changes=True)
    region = Region(obj, faces(obj, node, snap), rings, obj.data.use_mirror_x)
    inside = region.indices(handle)
    if not ((inside >= 0).all() and region.free[inside].all()):
        raise ValueError("The handle has vertices that are not inside the part: on its border, beyond it, or hidden.")
    if not len(inside):
        raise ValueError("The handle has no vertices.")
    _deform(obj, region, methods.AsRigidAsPossible(region, [inside]), matrix, progress, time_limit)


def bend(obj, node, rotation, reach=REACH, snap=False, progress=None, time_limit=None):
    """Turns a node's part about the joint where it hangs on the rest, the middle of its border, by rotation (3,3). The
    part keeps its shape, but what is within reach of its border, in radii of that, bends, on either side; all beyond
    stays. ValueError: there is no such joint."""
    _mesh(obj, changes=True)
    region = Region(obj, faces(obj, node, snap), mirror=obj.data.use_mirror_x, reach=reach)
    matrix = numpy.eye(4)
    matrix[:3, :3] = rotation
    matrix[:3, 3] = region.center - matrix[:3, :3] @ region.center
    _deform(obj, region, methods.JointBending(region), matrix, progress, time_limit)


def _deform(obj, region, shape, matrix, progress, time_limit):
    watch = _Watch(progress, time_limit)
    shape.solve([numpy.asarray(matrix, float)], watch)
    if watch.reason:
        raise PartwheelError(Status.CANCELLED, f"{watch.reason} The mesh is as it was.")
    VertexWriter(obj, region).write(obj, shape.points())


class _Watch:
    """Asked before each iteration whether to stop, as a threading.Event would be; so it tells how far that is."""

    def __init__(self, progress, time_limit):
        self.progress, self.seconds, self.began = progress, time_limit, time.monotonic()
        self.asked, self.reason = 0, None

    def is_set(self):
        if self.seconds is not None and time.monotonic() - self.began > self.seconds:
            self.reason = f"The deformation was not done in {self.seconds:g} seconds."
        elif self.progress and self.progress(min(self.asked / MAX_ITERATIONS, 1.0), "deform"):
            self.reason = "The deformation was cancelled."
        self.asked += 1
        return self.reason is not None


# ---- What they share


def _mesh(obj, edited=True, changes=False):
    """Raises ValueError for what is no mesh object; unless edited, for one in Edit Mode; if its mesh is to change, for
    one that can't."""
    if obj is None or obj.type != "MESH":
        raise ValueError(f"{obj.name if obj else 'None'} is not a mesh object.")
    if changes and read_only_reason(obj):
        raise ValueError(read_only_reason(obj))
    if obj.mode == "EDIT" and not edited:
        raise ValueError(f"{obj.name} is in Edit Mode. Leave it before a script does this.")


def _node(obj, node):
    """(the Hierarchy of the object, the number of one of its nodes); PartwheelError: it has no such node; Refused: it is a
    part of another hierarchy's cut."""
    built = hierarchy(obj)
    if isinstance(node, CutPart) and node.cut.hierarchy is not built:
        raise Refused(f"The cut is not of {obj.name} as it is now: ask for its parts again.")
    number = operator.index(node)
    built.faces(number)
    return built, number


def _place(obj, node, other, snap=False):
    for each in (obj, other):
        _mesh(each, edited=False)
    built, node = _node(obj, node)
    if placement.cap_faces(other.data) is None:
        hierarchy(other)
    return swapping.SwapTarget(obj, built, node, snap)


def _bounds(built, parts, height, least_concavity):
    given = [(cut, value) for cut, value in ((built.cut_parts, parts), (built.cut_height, height),
                                             (built.cut_least_concavity, least_concavity)) if value is not None]
    if len(given) > 1:
        raise ValueError("Say how to cut by only one of the three: parts=, least_concavity= or height=.")
    return given[0][0](given[0][1]) if given else built.cut_automatic()


def register():
    """Scripts find this module in the package, whose name is the same wherever the add-on is."""
    partwheel.api = sys.modules[NAME] = sys.modules[__name__]


def unregister():
    if getattr(partwheel, "api", None) is sys.modules[__name__]:
        del partwheel.api, sys.modules[NAME]
