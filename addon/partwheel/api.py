# SPDX-License-Identifier: GPL-3.0-or-later
"""For scripts: what the operators do, as functions of a mesh object, in any mode, with or without a window.

    import bpy
    from partwheel import api          # Blender 4.2 and later: from bl_ext.user_default.partwheel import api

    obj = bpy.context.active_object
    api.build(obj)
    nodes = api.path(obj, face=42)     # from the face's own small part up to the whole
    api.select(obj, face=42, level=2)  # a click on face 42 and two notches up
    labels = api.cut(obj, parts=8)     # (F,) the part of each face, 0 to 7
    copy = api.copy_part(obj, node)    # the part as a closed solid, a new object
    api.swap(obj, node, other)         # exchanged for the most compatible part of another object

Nodes are numbers of the object's hierarchy, a partwheel.Hierarchy, which build() returns and hierarchy() finds. The other
functions build it if there is none. One build runs at a time: those that are under way already come first. All raise
partwheel.PartwheelError, whose text says what is wrong, or ValueError for an object that holds no mesh.
"""

import numpy
from mathutils import Vector

from .compose import placement, swapping, union
from .deform import deforming
from .mesh import selection
from .parts import builds, picks, registry
from .pick import borders, states
from .solid import composition, solids
from partwheel.joint import REACH


def build(obj, quality=0.0, open_surfaces=False, mode=None):
    """Builds the hierarchy of the object's mesh and keeps it; waits until it is done. The Hierarchy.

    quality: 0 adds no points inside the mesh; from 1.1 on it bounds how stretched the tetrahedra may be. open_surfaces:
    take a sheet for a thin solid, instead of refusing it. mode: a partwheel.Mode, how parts are joined; None: as the add-on's
    preferences have it.
    """
    _check(obj)
    return builds.build(obj, quality=quality, open_surfaces=open_surfaces, mode=mode).finish()


def hierarchy(obj):
    """The Hierarchy of the object's mesh as it is now, built if there is none."""
    _check(obj)
    return registry.hierarchy(obj) or builds.build(obj).finish()


def path(obj, face):
    """(n,) the nodes that hold a face, growing: from its leaf to the root. All of them; the wheel stops at some (in
    partwheel.Mode.PAPER at all)."""
    return hierarchy(obj).path(face)


def faces(obj, node, snap=False):
    """(n,) the faces of a node: indices of the mesh's polygons, read-only. snap: with its border in the creases nearby.
    """
    return borders.faces(obj, hierarchy(obj), node, snap)


def select(obj, face, level=0, extend=False, snap=False):
    """Selects the part that a click on this face takes, after level notches of the wheel (negative: down), and makes it
    the part picked last. With extend the selection before stays too. In Edit Mode as the select mode has it. Hidden
    faces stay as they are. snap: as for faces(). The node."""
    picked = states.pick(hierarchy(obj), face, level)
    chosen = faces(obj, picked.node, snap)
    if obj.mode == "EDIT":
        selection.Selection(obj, obj.data).select(obj, chosen, picked.face, extend)
    else:
        selection.select_outside_edit_mode(obj.data, chosen, extend)
    picks.remember(obj, picked.face, picked.node, snap)
    return picked.node


def cut(obj, parts=None, height=None, least_concavity=None):
    """(F,) the part of each face, counted from 0, when the whole is cut: give one of the three. parts: into so many,
    the last merges undone. least_concavity: into so many, those with the least concavity in total, as for convex hulls.
    height: at this height of the dendrogram. A part inside the solid has no face."""
    built = hierarchy(obj)
    return built.face_labels(_bounds(built, parts, height, least_concavity))


def copy_part(obj, node, smooth=False, material=False, snap=False):
    """A new object in the part's place: the node as a closed solid. Its polygons keep all their attributes; the caps
    that close it are marked by the face attribute "partwheel_cap". smooth: caps that go on as the surface does, not the
    flat facets inside the solid. material: caps get a material of their own. snap: its border is moved to the creases
    nearby, as far as the tetrahedra about it let it be there. solids.NotClosed: it can't be closed."""
    return composition.copied(obj, hierarchy(obj), node, solids.Options(smooth, material), snap)


def remove(obj, node, smooth=False, material=False, snap=False):
    """Takes the node out of the object's mesh, which must not be in Edit Mode, and closes the hole; options as for
    copy_part(). What it removes and what copy_part() gives make the whole."""
    _check(obj)
    if obj.mode == "EDIT":
        raise ValueError(f"{obj.name} is in Edit Mode. Leave it before a part is removed by a script.")
    composition.removed(obj, hierarchy(obj), node, solids.Options(smooth, material), snap)


def split(obj, parts=None, height=None, explode=0.0, smooth=False, material=False, least_concavity=None):
    """New objects in a new collection, one for each part of a cut as cut() makes it: closed solids whose caps match
    exactly (unless smooth). Each is moved out by explode times its distance from the middle."""
    built = hierarchy(obj)
    bounds = _bounds(built, parts, height, least_concavity)
    return composition.split(obj, built, bounds, solids.Options(smooth, material), explode)


def place(part, location, normal=(0, 0, 1), scale=1.0, angle=0.0, depth=0.0, target=None, fit=False, mirror=False):
    """Moves an object, one that copy_part() made for instance, so that its border, the largest group of its caps, comes
    to location in the world, turned against the surface's normal there. scale: times its size. angle: about the normal,
    in radians. depth: how far it is sunk in, times the border's radius, beyond the little that a union needs.

    target: the mesh object it goes onto. fit: onto the target's border nearest to location, and of its size. mirror:
    the mirror image across the target's own YZ plane as well; it is returned, else None. ValueError: no border there."""
    _check(part)
    if fit or mirror:
        _check(target)
    return placement.place(part, target, placement.Pose(Vector(location), Vector(normal), scale, angle, depth, fit),
                           mirror)


def unite(target, others, blend=0.0):
    """Makes the target's mesh the union of it and the other objects, which stay, by Blender's Boolean: n-gons, layers
    and materials kept, modifiers of the others applied. Outside Edit Mode only.

    blend: the width of a smooth transition on either side of each seam, times the seam's radius; it moves vertices
    there, and has no more of them than the solids. union.NotUnited, before anything has changed: one of them is not
    closed, or no solver gave a closed mesh of a possible volume."""
    for obj in (target, *others):
        _check(obj)
    if any(obj.mode == "EDIT" for obj in (target, *others)):
        raise ValueError("Leave Edit Mode before solids are united by a script.")
    union.unite(target, others, blend)


def compatible(obj, node, other):
    """[(node, score), ...] parts of another mesh object that can stand in for the node, the most compatible first; each
    clearly another part than those before. score: 1 for the same shape, down to 0. The node is None for the other
    object itself, if it is a part that was copied as a solid. other may be obj: then parts beside the node.
    swapping.NotSwapped: the node is the whole, or has no border; or the other has no parts."""
    return [(offer.node, offer.score) for offer in _place(obj, node, other).offers([other])]


def swap(obj, node, other, other_node=None, scale=1.0, angle=0.0, depth=0.0, mirror=False, blend=0.0,
         snap=False):
    """Exchanges the node for a part of another object: what is left without it is united with a copy of the other's
    part, brought there border to border, of its size, and turned as it fits best. other_node: None for the most
    compatible one. scale, angle (about the border's normal, radians), depth (radii of the border) change that; mirror
    takes its mirror image; blend is that of unite(); snap moves both parts' borders to the creases nearby. The other
    object stays as it is. The other's node that stood in, or None if it was the object itself.

    swapping.NotSwapped, solids.NotClosed, union.NotUnited, before anything has changed. Outside Edit Mode only."""
    place = _place(obj, node, other, snap)
    if obj.mode == "EDIT":
        raise ValueError(f"{obj.name} is in Edit Mode. Leave it before a part is exchanged by a script.")
    offer = place.offers([other])[0] if other_node is None else place.offer(other, other_node)
    place.swap(offer, swapping.Adjustment(scale, angle, depth, mirror), blend)
    return offer.node


def _place(obj, node, other, snap=False):
    built = hierarchy(obj)
    if other.type == "MESH" and placement.caps(other.data) is None:
        hierarchy(other)
    _check(other)
    return swapping.Place(obj, built, node, snap)


def _bounds(built, parts, height, least_concavity):
    given = [(cut, value) for cut, value in ((built.cut_parts, parts), (built.cut_height, height),
                                             (built.cut_least_concavity, least_concavity)) if value is not None]
    if len(given) != 1:
        raise ValueError("Say how to cut by one of the three: parts=, least_concavity= or height=.")
    (cut, value), = given
    return cut(value)


def deform(obj, node, handle_vertices, matrix, rings=0):
    """Deforms a node's part as rigidly as possible: these vertices of it (indices of the mesh's) go to matrix (4,4), in
    the object's space, times their place; the part's border and all beyond stay. In the shape key that is active, if
    any, and across the x axis too if the mesh has that on. rings: so many rings of faces around the part take part.
    Raises ValueError if there is nothing to deform, or nothing to hold it."""
    region = deforming.Region(obj, faces(obj, node), rings, obj.data.use_mirror_x)
    inside = numpy.searchsorted(region.vertices, handle_vertices)
    known = inside < len(region.vertices)
    if not (known.all() and (region.vertices[inside] == handle_vertices).all() and region.free[inside].all()):
        raise ValueError("The handle has vertices that are not inside the part: on its border, beyond it, or hidden.")
    if not len(inside):
        raise ValueError("The handle has no vertices.")
    shape = deforming.AsRigidAsPossible(region, [inside])
    shape.jump([numpy.asarray(matrix, float)])
    deforming.Pen(obj, region).write(obj, shape.points())


def bend(obj, node, rotation, reach=REACH):
    """Turns a node's part about the joint where it hangs on the rest, the middle of its border, by rotation (3,3) in the
    object's space. The part keeps its shape, but what is within reach of its border, in radii of that, bends, on either
    side; all beyond stays. Shape keys and the x axis as for deform(). Raises ValueError if there is no such joint."""
    region = deforming.Region(obj, faces(obj, node), mirror=obj.data.use_mirror_x, reach=reach)
    matrix = numpy.eye(4)
    matrix[:3, :3] = rotation
    matrix[:3, 3] = region.center - matrix[:3, :3] @ region.center
    shape = deforming.AtJoint(region)
    shape.jump([matrix])
    deforming.Pen(obj, region).write(obj, shape.points())


def _check(obj):
    if obj is None or obj.type != "MESH":
        raise ValueError(f"{obj.name if obj else 'None'} is not a mesh object.")
