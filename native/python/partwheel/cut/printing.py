# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of a cut for a 3D printer: flat cuts with pegs and sockets; parts that are too large for the bed are split;
walls are checked. With manifold3d. Lengths are in millimeters."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Callable, Dict, Iterator, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from ..library import Error
from ..rays import RayTarget
from ..requirements import load_module
from ..separation import separate
from ..triangles import doubled_area_vectors, sample_triangles
from .borders import parents_first, part_tree
from .names import name_parts

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ..hierarchy import Solid
    from .cut import Cut

# Pegs
PEG_SIDES = 6  # a prism, so that it can't turn
PEG_RADIUS_FRACTION = 0.5  # of the radius of the largest circle in the cut
MIN_PEG_RADIUS = 0.8  # mm
PEG_LENGTHS = 2.0, 1.5, 1.0, 0.7  # in radii of the peg; the first that fits is used
PEG_ROOT_DEPTH = 0.25  # in radii of the peg: how far it reaches into its own part
# Flat cuts
CYLINDER_SIDES = 48
MAX_MOVED_FRACTION = 0.3  # of the smaller part's volume: a cut that would move more stays as it is
CUT_REACHES = 1.25, 1.05, 1.6  # radii around the cut's center, in radii of the cut, to flatten; the first that works is used
# Checks
RELATIVE_TOLERANCE = 1e-6  # volumes below this fraction are rounding errors
WALL_SAMPLES = 1000  # points where the thickness of a solid's walls is measured
MAX_WALL_COSINE = -0.7  # between the normals of the two sides of a wall


class PrintError(Error):
    """Parts can't be prepared for a printer; str() says why."""

    name = "printing"


class PrintOptions(NamedTuple):
    """How parts are prepared for a printer.

    scale : millimeters per unit of the model
    pegs : clearance of pegs on every side; None for flat cuts without pegs
    wall : minimum thickness of walls, also around sockets
    bed : (3,) size of the printer's bed and height; None if it is large enough
    """

    scale: float = 1.0
    pegs: Optional[float] = None
    wall: float = 1.2
    bed: Optional[Sequence[float]] = None


class Peg(NamedTuple):
    """A peg of one part in a socket of another. The socket leaves a gap on all sides except at the cut.

    part : the part with the peg
    into : the part with the socket
    center : (3,) on the cut
    direction : (3,) unit, into the other part
    radius : to the corners
    length
    """

    part: int
    into: int
    center: np.ndarray
    direction: np.ndarray
    radius: float
    length: float


class Printable(NamedTuple):
    """Parts that are ready for a printer.

    cut : after the splits for the bed
    names : of its parts
    solids : {part: (vertices (V, 3), triangles (T, 3))}
    pegs
    notes : sentences on what could not be done, and on parts that are too thin or too large
    """

    cut: Cut
    names: List[str]
    solids: Dict[int, Tuple[np.ndarray, np.ndarray]]
    pegs: List[Peg]
    notes: List[str]


def prepare_parts(cut: Cut, vertices: np.ndarray, triangles: np.ndarray, faces: np.ndarray,
                  options: PrintOptions = PrintOptions(), word: str = "Part",
                  name_cut: Optional[Callable[[Cut], List[str]]] = None) -> Printable:
    """Prepare the parts of a cut for a 3D printer.

    Parameters
    ----------
    vertices : (V, 3), triangles : (T, 3), faces : (T,) the source face of each triangle: the surface of the hierarchy
    word : what names of parts begin with
    name_cut : returns the names of a cut's parts, instead of name_parts(); called with the cut that fits the bed

    Raises
    ------
    PrintError : manifold3d rejects a part
    RequirementError : manifold3d is not installed
    """
    manifold: Any = load_module("manifold3d", "Making parts ready for a 3D printer")
    notes: List[str] = []
    cut = _split_to_bed(cut, options)
    names = name_cut(cut) if name_cut else name_parts(cut, vertices, triangles, faces, word)
    labels = cut.labels[faces]
    links = part_tree(cut, vertices, triangles, labels)
    solids = cut.solids()
    bodies: Dict[int, Any] = {}
    for part, solid in enumerate(solids):
        if solid is None:
            notes.append(f"{names[part]} has nothing left inside.")
            continue
        bodies[part] = _make_manifold(manifold, solid.vertices * options.scale, solid.triangles)
        if bodies[part].status() != manifold.Error.NoError:
            raise PrintError(f"{names[part]} is no solid for manifold3d: {bodies[part].status().name}.")
    joints: List[_PrintJoint] = []
    for part in parents_first(links):
        parent, solid = links[part].parent, solids[part]
        if solid is not None and parent in bodies and links[part].border:
            joint = _PrintJoint.create(manifold, cut, solid, part, parent, options.scale)
            if joint:
                joints.append(joint)
                if not joint.flatten(bodies):
                    notes.append(f"The cut between {names[part]} and {names[parent]} stays as it is: a flat one would take "
                                 "them apart.")
    pegs: List[Peg] = []
    if options.pegs is not None:
        for joint in joints:
            peg = joint.add_peg(bodies, options.pegs, options.wall)
            if peg:
                pegs.append(peg)
            else:
                notes.append(f"There is no room for a peg between {names[joint.part]} and {names[joint.other]}.")
    result: Dict[int, Tuple[np.ndarray, np.ndarray]] = {}
    for part, body in bodies.items():
        mesh = body.to_mesh64()
        result[part] = separate(mesh.vert_properties[:, :3], mesh.tri_verts)[:2]
        notes += _check_solid(names[part], body, *result[part], options)
    return Printable(cut, names, result, pegs, notes)


def wall_thickness(vertices: np.ndarray, triangles: np.ndarray, sample_count: int = WALL_SAMPLES) -> np.ndarray:
    """Thickness of a solid's walls at evenly distributed points of its surface: the distance straight through to a surface
    that faces the other way. Points without one, as at edges, are left out.

    Parameters
    ----------
    vertices : (V, 3)
    triangles : (T, 3), wound outward
    sample_count : number of points

    Returns
    -------
    (n,), n <= sample_count
    """
    corners = vertices[triangles]
    normals = doubled_area_vectors(corners)
    doubled_areas = np.linalg.norm(normals, axis=1)
    normals /= np.maximum(doubled_areas, 1e-300)[:, None]
    target, thicknesses = RayTarget(vertices, triangles), []
    for point, triangle in zip(*sample_triangles(corners, doubled_areas, sample_count)):
        hit = target.first_hit(point, -normals[triangle], 1e-6 * np.sqrt(doubled_areas.sum()))
        if hit and normals[hit[0]] @ normals[triangle] < MAX_WALL_COSINE:
            thicknesses.append(hit[1])
    return np.array(thicknesses)


def _make_manifold(manifold: Any, vertices: ArrayLike, triangles: ArrayLike) -> Any:
    return manifold.Manifold(manifold.Mesh64(np.array(vertices, order="C"), np.array(triangles, np.uint64, order="C")))


def _split_to_bed(cut: Cut, options: PrintOptions) -> Cut:
    """The cut with parts that are too large split along the tree, until each fits the bed as it stands or turned by right
    angles."""
    if options.bed is None:
        return cut
    bed = np.sort(options.bed)
    hierarchy = cut.hierarchy

    def is_too_large(part: int) -> bool:
        corners = np.concatenate([hierarchy.vertices[hierarchy.tetrahedra[first:last]].reshape(-1, 3)
                                  for first, last in zip(*cut.slices(part))])
        return bool((np.sort(np.ptp(corners, axis=0)) * options.scale > bed).any())

    part = 0
    while part < len(cut):
        split = cut.split(part) if is_too_large(part) else cut
        if split is cut:
            part += 1
        cut = split
    return cut


class _PrintJoint:
    """The cut between a part and its parent, with a frame: origin at the center of the cut's rim, z from the part into the
    parent."""

    def __init__(self, manifold: Any, part: int, other: int, corners: np.ndarray, rim: np.ndarray) -> None:
        """corners : (n, 3, 3) of the cut's triangles; rim : (m, 2, 3) of its boundary edges"""
        self.manifold, self.part, self.other = manifold, part, other
        area_vectors = doubled_area_vectors(corners)
        self.center = np.average(rim.mean(axis=1), axis=0, weights=np.linalg.norm(rim[:, 1] - rim[:, 0], axis=1))
        z = area_vectors.sum(axis=0) / np.linalg.norm(area_vectors.sum(axis=0))  # depends only on the rim
        x = np.cross(np.eye(3)[abs(z).argmin()], z)
        x /= np.linalg.norm(x)
        self.axes = np.array([x, np.cross(z, x), z])
        local = (corners.reshape(-1, 3) - self.center) @ self.axes.T
        self.radius = np.linalg.norm(local[:, :2], axis=1).max()
        self.height = 1.05 * max(abs(local[:, 2]).max(), 1e-3 * self.radius)

    @classmethod
    def create(cls, manifold: Any, cut: Cut, solid: Solid, part: int, other: int, scale: float) -> Optional[_PrintJoint]:
        """The joint of two parts; None if they have no common cap, or a closed one."""
        in_other = np.zeros(len(cut.hierarchy.tetrahedra), bool)
        for first, last in zip(*cut.slices(other)):
            in_other[first:last] = True
        cap = solid.triangles[(solid.neighbor_tets >= 0) & in_other[solid.neighbor_tets]]
        corners = solid.vertices[cap] * scale
        area_vectors = doubled_area_vectors(corners)
        if np.linalg.norm(area_vectors.sum(axis=0)) <= 1e-3 * np.linalg.norm(area_vectors, axis=1).sum():
            return None
        edges, counts = np.unique(np.sort(cap[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1), axis=0,
                                  return_counts=True)
        return cls(manifold, part, other, corners, solid.vertices[edges[counts == 1]] * scale)

    def _to_model(self, tool: Any) -> Any:
        """A tool in the model's frame. Tools are transformed, not bodies, so that common corners of bodies stay equal."""
        return tool.transform(np.column_stack([self.axes.T, self.center]))

    def flatten(self, bodies: Dict[int, Any]) -> bool:
        """Move the cut to the plane z = 0: what either part has beyond the plane, near the cut, goes to the other part.

        Returns
        -------
        whether that is possible; if not, bodies don't change
        """
        one, other = bodies[self.part], bodies[self.other]
        counts = [len(_components(body)[0]) for body in (one, other)]
        for reach in CUT_REACHES:
            upper = self.manifold.Manifold.cylinder(self.height, reach * self.radius, circular_segments=CYLINDER_SIDES)
            upper, lower = map(self._to_model, (upper, upper.mirror((0, 0, 1))))
            removed, added = one ^ upper, other ^ lower
            if removed.volume() + added.volume() > MAX_MOVED_FRACTION * min(one.volume(), other.volume()):
                continue
            flat = [_components((one - upper) + added), _components((other - lower) + removed)]
            # Components that come off one part go to the other.
            flat_bodies = [self._compose(components[:count], cavities, other_components[other_count:])
                           for (components, cavities), (other_components, _), count, other_count
                           in zip(flat, flat[::-1], counts, counts[::-1])]
            if [len(_components(body)[0]) for body in flat_bodies] == counts:
                bodies[self.part], bodies[self.other] = flat_bodies
                return True
        return False

    def _compose(self, components: Sequence[Any], cavities: Sequence[Any], additions: Sequence[Any]) -> Any:
        """A body of disjoint components, minus cavities, united with additions."""
        body = self.manifold.Manifold.compose(components)  # ignores cavities
        for cavity in cavities:
            mesh = cavity.to_mesh64()
            body -= _make_manifold(self.manifold, mesh.vert_properties, mesh.tri_verts[:, ::-1])
        for addition in additions:
            body += addition
        return body

    def add_peg(self, bodies: Dict[int, Any], clearance: float, wall: float) -> Optional[Peg]:
        """Add a peg to the part and cut its socket into the other part. None if there is no room."""
        one, other = bodies[self.part], bodies[self.other]
        epsilon = 1e-3 * self.radius
        center_2d, free_radius = _largest_circle(self._slice(one, -epsilon) ^ self._slice(other, epsilon))
        # Inner radius / outer radius of the peg's prism, and of the prism that stands for a cylinder.
        peg_ratio, cylinder_ratio = np.cos(np.pi / PEG_SIDES), np.cos(np.pi / CYLINDER_SIDES)
        corner_clearance = clearance / peg_ratio
        radius = min(PEG_RADIUS_FRACTION * free_radius, cylinder_ratio * free_radius - corner_clearance - wall)

        def column(bottom: float, top: float, column_radius: float, sides: int = PEG_SIDES) -> Any:
            return self._to_model(self.manifold.Manifold.cylinder(
                top - bottom, column_radius, circular_segments=sides).translate((*center_2d, bottom)))

        while radius >= MIN_PEG_RADIUS:
            for length in (radius * relative for relative in PEG_LENGTHS):
                socket_wall = column(0, length + clearance + wall,
                                     (radius + corner_clearance + wall) / cylinder_ratio, CYLINDER_SIDES)
                root = column(-PEG_ROOT_DEPTH * radius, 0, radius)
                if (socket_wall - other).volume() > RELATIVE_TOLERANCE * socket_wall.volume() or (
                        root - one).volume() > RELATIVE_TOLERANCE * root.volume():
                    continue
                bodies[self.part] = one + column(-PEG_ROOT_DEPTH * radius, length, radius)
                bodies[self.other] = other - column(-epsilon, length + clearance, radius + corner_clearance)
                center = self.center + self.axes.T @ (*center_2d, 0)
                return Peg(self.part, self.other, center, self.axes[2], radius, length)
            radius *= 0.8
        return None

    def _slice(self, body: Any, height: float) -> Any:
        return body.transform(np.column_stack([self.axes, -self.axes @ self.center])).slice(height)


def _components(body: Any) -> Tuple[List[Any], List[Any]]:
    """(connected components of a body, largest first; its cavities), without those that are rounding errors."""
    tolerance = RELATIVE_TOLERANCE * body.volume()
    components = sorted(body.decompose(), key=lambda component: -component.volume())
    return ([component for component in components if component.volume() > tolerance],
            [component for component in components if component.volume() < -tolerance])


def _largest_circle(section: Any) -> Tuple[np.ndarray, float]:
    """(center (2,), radius) of the largest circle in a CrossSection, by bisection on its inward offset."""
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


def _check_solid(name: str, body: Any, vertices: np.ndarray, triangles: np.ndarray, options: PrintOptions) -> Iterator[str]:
    """Sentences on what is wrong with a solid."""
    component_count = len(_components(body)[0])
    if component_count != 1:
        yield f"{name} is in {component_count} pieces."
    if options.bed is not None and (np.sort(np.ptp(vertices, axis=0)) > np.sort(options.bed)).any():
        size = " x ".join(f"{length:.1f}" for length in np.ptp(vertices, axis=0))
        yield f"{name} is too large for the bed: {size} mm."
    walls = wall_thickness(vertices, triangles)
    is_thin = walls < options.wall
    if is_thin.any():
        yield (f"{name} has walls thinner than {options.wall:g} mm on {is_thin.sum() / WALL_SAMPLES:.1%} of its surface, the "
               f"thinnest {walls.min():.2f} mm.")
