# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of a cut for a 3D printer: flat cuts, with a peg and a socket across each; what is too large for the bed is
split further; and what is to be printed is checked. By manifold3d. Lengths are millimetres."""

from typing import NamedTuple, Optional

import numpy as np

from ..compatible import sample_triangles
from ..library import Error
from ..rays import RayTarget
from ..requirements import load_module
from .borders import from_root, tree
from .names import named

SIDES = 6  # of a peg, so that it can't turn
ROUND = 48  # of what is round
SHARE = 0.5  # a peg's radius, of that of the largest circle in the cut
LEAST = 0.8  # no peg is thinner
SHORTER = 2.0, 1.5, 1.0, 0.7  # lengths of a peg, in radii, the first that fits
ROOT = 0.25  # of its radius: so deep a peg begins inside its own part
TINY = 1e-6  # of a volume that is taken for none: results are rounded
MOVED = 0.3  # of the smaller part: where a flat cut would move more, it stays as it is
REACHES = 1.25, 1.05, 1.6  # so far about the middle of a cut, in its radii, it is made flat: the first that works
SAMPLES = 1000  # points of a solid where its walls are measured
OPPOSITE = -0.7  # cosine between the two sides of a wall


class PrintError(Error):
    """Parts that can't be made ready for a printer; str() says why."""

    name = "printing"


class Options(NamedTuple):
    """scale: so many millimetres is a unit of the model. pegs: their clearance, on every side; None: flat cuts without
    any. wall: what stays around a socket, and how thick walls are to be. bed (3,): the printer's; None: large enough."""

    scale: float = 1.0
    pegs: Optional[float] = None
    wall: float = 1.2
    bed: Optional[tuple] = None


class Peg(NamedTuple):
    """A peg of one part in a socket of another: center (3,) on the cut, direction (3,) into the other part, radius (to
    the corners) and length; the socket leaves a gap on all sides but at the cut itself."""

    part: int
    into: int
    center: np.ndarray
    direction: np.ndarray
    radius: float
    length: float


class Printable(NamedTuple):
    """cut: with what the bed made necessary; names of its parts; solids: {part: (vertices (V,3), triangles (T,3))};
    pegs; notes: sentences on what could not be done, and on what is too thin or too large."""

    cut: object
    names: list
    solids: dict
    pegs: list
    notes: list


def printable(cut, vertices, triangles, faces, options=Options(), word="Part", named_by=None):
    """A Printable. vertices (V,3), triangles (T,3), faces (T,) the source face of each: the surface that the cut's
    hierarchy is of. word: that names begin with; named_by: names instead, of the cut that fits. Raises PrintError without
    manifold3d."""
    manifold = load_module("manifold3d", "Making parts ready for a 3D printer")
    cut, notes = _fitting(cut, options), []
    names = named_by(cut) if named_by else named(cut, vertices, triangles, faces, word)
    labels = cut.labels[faces]
    hung = tree(cut, vertices, triangles, labels)
    solids = cut.solids()
    bodies = {}
    for part, solid in enumerate(solids):
        if solid is None:
            notes.append(f"{names[part]} has nothing left inside.")
            continue
        bodies[part] = _body(manifold, solid.vertices * options.scale, solid.triangles)
        if bodies[part].status() != manifold.Error.NoError:
            raise PrintError(f"{names[part]} is no solid for manifold3d: {bodies[part].status().name}.")
    joints = []
    for part in from_root(hung):
        other = hung[part].parent
        if part in bodies and other in bodies and hung[part].border:
            joint = _Joint.of(manifold, cut, solids[part], part, other, options.scale)
            if joint:
                joints.append(joint)
                if not joint.flatten(bodies):
                    notes.append(f"The cut between {names[part]} and {names[other]} stays as it is: a flat one would take "
                                 "them apart.")
    pegs = []
    if options.pegs is not None:
        for joint in joints:
            peg = joint.peg(bodies, options)
            if peg:
                pegs.append(peg)
            else:
                notes.append(f"There is no room for a peg between {names[joint.part]} and {names[joint.other]}.")
    made = {}
    for part, body in bodies.items():
        mesh = body.to_mesh64()
        made[part] = np.array(mesh.vert_properties[:, :3]), np.array(mesh.tri_verts, np.int32)
        notes += _checked(names[part], body, *made[part], options)
    return Printable(cut, names, made, pegs, notes)


def thickness(vertices, triangles, samples=SAMPLES):
    """(n,) how thick the walls of a solid are, at points that are spread over it evenly: straight through, to where the
    surface faces the other way. Where it does not, as at edges, there is no wall."""
    corners = vertices[triangles]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(across, axis=1)
    normals = across / np.maximum(areas, 1e-300)[:, None]
    target, found = RayTarget(vertices, triangles), []
    for point, triangle in zip(*sample_triangles(corners, areas, samples)):
        away = -normals[triangle]
        hit = target.first_hit(point, away, 1e-6 * np.sqrt(areas.sum()))
        if hit and normals[hit[0]] @ normals[triangle] < OPPOSITE:
            found.append(hit[1])
    return np.array(found)


def _body(manifold, vertices, triangles):
    return manifold.Manifold(manifold.Mesh64(np.array(vertices, order="C"), np.array(triangles, np.uint64, order="C")))


def _fitting(cut, options):
    """The cut with parts that are larger than the bed split along the tree, until they fit as they stand, or turned by
    right angles."""
    if options.bed is None:
        return cut
    bed = np.sort(options.bed)
    hierarchy = cut.hierarchy

    def large(part):
        corners = np.concatenate([hierarchy.vertices[hierarchy.tetrahedra[first:last]].reshape(-1, 3)
                                  for first, last in zip(*cut.slices(part))])
        return (np.sort(np.ptp(corners, axis=0)) * options.scale > bed).any()

    part = 0
    while part < len(cut):
        split = cut.split(part) if large(part) else cut
        if split is cut:
            part += 1
        cut = split
    return cut


class _Joint:
    """Where a part hangs on another one: in a space of its own, whose z axis points from the part into the other, and
    whose origin is the middle of the cut."""

    def __init__(self, manifold, part, other, corners, rim):
        self.manifold, self.part, self.other = manifold, part, other
        across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        self.middle = np.average(rim.mean(axis=1), axis=0, weights=np.linalg.norm(rim[:, 1] - rim[:, 0], axis=1))
        z = across.sum(axis=0) / np.linalg.norm(across.sum(axis=0))  # which the rim alone decides
        x = np.cross(np.eye(3)[abs(z).argmin()], z)
        x /= np.linalg.norm(x)
        self.axes = np.array([x, np.cross(z, x), z])
        own = (corners.reshape(-1, 3) - self.middle) @ self.axes.T
        self.radius = np.linalg.norm(own[:, :2], axis=1).max()
        self.height = 1.05 * max(abs(own[:, 2]).max(), 1e-3 * self.radius)

    @classmethod
    def of(cls, manifold, cut, solid, part, other, scale):
        """None: they have no cap in common, or one without a rim."""
        beyond = np.zeros(len(cut.hierarchy.tetrahedra), bool)
        for first, last in zip(*cut.slices(other)):
            beyond[first:last] = True
        cap = solid.triangles[(solid.beyond >= 0) & beyond[solid.beyond]]
        corners = solid.vertices[cap] * scale
        across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        if np.linalg.norm(across.sum(axis=0)) <= 1e-3 * np.linalg.norm(across, axis=1).sum():
            return None
        edges, times = np.unique(np.sort(cap[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1), axis=0,
                                 return_counts=True)
        return cls(manifold, part, other, corners, solid.vertices[edges[times == 1]] * scale)

    def _outside(self, tool):
        """Tools are moved, not bodies: where two of these meet their corners have the same digits, and stay so."""
        return tool.transform(np.column_stack([self.axes.T, self.middle]))

    def flatten(self, bodies):
        """Makes the cut the plane z = 0: what each of the two has beyond it, near the cut, becomes the other's. Whether
        that could be."""
        one, other = bodies[self.part], bodies[self.other]
        counts = [len(_pieces(each)[0]) for each in (one, other)]
        for reach in REACHES:
            above = self.manifold.Manifold.cylinder(self.height, reach * self.radius, circular_segments=ROUND)
            above, below = map(self._outside, (above, above.mirror((0, 0, 1))))
            gone, come = one ^ above, other ^ below
            if gone.volume() + come.volume() > MOVED * min(one.volume(), other.volume()):
                continue
            new = [_pieces((one - above) + come), _pieces((other - below) + gone)]
            # What comes off one is the other's.
            after = [self._united(mine[:count], holes, theirs[rest:])
                     for (mine, holes), (theirs, _), count, rest in zip(new, new[::-1], counts, counts[::-1])]
            if [len(_pieces(each)[0]) for each in after] == counts:
                bodies[self.part], bodies[self.other] = after
                return True
        return False

    def _united(self, apart, hollows, more):
        """Pieces that don't meet, with hollows, and others added to them."""
        whole = self.manifold.Manifold.compose(apart)  # which leaves out hollows
        for hollow in hollows:
            mesh = hollow.to_mesh64()
            whole -= _body(self.manifold, mesh.vert_properties, mesh.tri_verts[:, ::-1])
        for piece in more:
            whole += piece
        return whole

    def peg(self, bodies, options):
        """Adds a Peg to the part and takes its socket out of the other one; None where there is no room."""
        one, other = bodies[self.part], bodies[self.other]
        small = 1e-3 * self.radius
        place, room = _widest(self._slice(one, -small) ^ self._slice(other, small))
        # From a corner's distance to a side's: of a peg, and of a round column.
        straight, nearly = np.cos(np.pi / SIDES), np.cos(np.pi / ROUND)
        gap = options.pegs
        more = gap / straight
        radius = min(SHARE * room, nearly * room - more - options.wall)

        def column(bottom, top, wide, sides=SIDES):
            return self._outside(self.manifold.Manifold.cylinder(
                top - bottom, wide, circular_segments=sides).translate((*place, bottom)))

        while radius >= LEAST:
            for length in (radius * each for each in SHORTER):
                around = column(0, length + gap + options.wall, (radius + more + options.wall) / nearly, ROUND)
                root = column(-ROOT * radius, 0, radius)
                if (around - other).volume() > TINY * around.volume() or (
                        root - one).volume() > TINY * root.volume():
                    continue
                bodies[self.part] = one + column(-ROOT * radius, length, radius)
                bodies[self.other] = other - column(-small, length + gap, radius + more)
                center = self.middle + self.axes.T @ (*place, 0)
                return Peg(self.part, self.other, center, self.axes[2], radius, length)
            radius *= 0.8
        return None

    def _slice(self, body, height):
        return body.transform(np.column_stack([self.axes, -self.axes @ self.middle])).slice(height)


def _pieces(body):
    """(the connected pieces of a body, the largest first, its hollows): without crumbs and bubbles left by rounding."""
    least = TINY * body.volume()
    pieces = sorted(body.decompose(), key=lambda piece: -piece.volume())
    return [piece for piece in pieces if piece.volume() > least], [piece for piece in pieces if piece.volume() < -least]


def _widest(section):
    """(center (2,), radius) of the largest circle in a CrossSection."""
    if section.is_empty():
        return np.zeros(2), 0.0
    low, high = 0.0, float(np.ptp(np.reshape(section.bounds(), (2, 2)), axis=0).min()) / 2 + 1e-9
    inner = section
    while high - low > 1e-3 * high:
        middle = (low + high) / 2
        smaller = section.offset(-middle)
        if smaller.is_empty():
            high = middle
        else:
            low, inner = middle, smaller
    contour = max(inner.to_polygons(), key=len)
    return np.asarray(contour).mean(axis=0), low


def _checked(name, body, vertices, triangles, options):
    """Sentences on what is wrong with a solid."""
    pieces = len(_pieces(body)[0])
    if pieces != 1:
        yield f"{name} is in {pieces} pieces."
    if options.bed is not None and (np.sort(np.ptp(vertices, axis=0)) > np.sort(options.bed)).any():
        size = " x ".join(f"{length:.1f}" for length in np.ptp(vertices, axis=0))
        yield f"{name} is too large for the bed: {size} mm."
    walls = thickness(vertices, triangles)
    thin = walls < options.wall
    if thin.any():
        yield (f"{name} has walls thinner than {options.wall:g} mm on {thin.sum() / SAMPLES:.1%} of its surface, the "
               f"thinnest {walls.min():.2f} mm.")
