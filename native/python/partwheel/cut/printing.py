# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of a cut for a 3D printer: planar cuts with pegs and sockets; parts that are too large for the bed are cut into
equal pieces; walls are checked. With manifold3d. Lengths are in millimeters."""

from __future__ import annotations

from itertools import permutations
from typing import TYPE_CHECKING, Any, Dict, Iterator, List, NamedTuple, Optional, Sequence, Set, Tuple

import numpy as np

from ..library import Context, Error
from ..rays import RayTarget
from ..requirements import load_module
from ..separation import separate
from ..triangles import doubled_area_vectors, sample_triangles
from .beds import place_on_beds
from .borders import ParentLink, parents_first, part_tree
from .cut import Cut
from .flat_cuts import KERF, FlatCutter, Plane, fits_bed
from .names import name_parts
from .sources import find_source_faces

if TYPE_CHECKING:
    from ..hierarchy import Solid

# Pegs
CLEARANCES = {"pla": 0.2, "petg": 0.3, "resin": 0.1}  # mm, by the material that is printed
PEG_SIDES = 6  # a prism, so that it can't turn
PEG_RADIUS_FRACTION = 0.5  # of the radius of the largest circle in the cut
MIN_PEG_RADIUS = 0.8  # mm
PEG_LENGTHS = 2.0, 1.5, 1.0, 0.7  # in radii of the peg; the first that fits is used
PEG_ROOT_DEPTH = 0.25  # in radii of the peg: how far it reaches into its own part
PEG_RATIO = np.cos(np.pi / PEG_SIDES)  # inner radius / outer radius of the peg's prism
MIN_PEG_DISTANCE = 4.0  # in radii of the peg, between the centers of two pegs in a wide cut
CYLINDER_SIDES = 48
CYLINDER_RATIO = np.cos(np.pi / CYLINDER_SIDES)  # inner radius / outer radius of the prism that stands for a cylinder
SECTION_HEIGHT = 1e-3  # mm from a cut, where its two sides are measured
# Splits along the tree
MAX_CONCAVITY = 0.03  # volume between a nearly convex part and its hull, by the part's
MIN_SPLIT_SHARE = 0.1  # of a part's volume, in the smallest part that a split for the bed makes
# Checks
RELATIVE_TOLERANCE = 1e-6  # volumes below this fraction are rounding errors
WALL_SAMPLES = 1000  # points where the thickness of a solid's walls is measured
MAX_WALL_COSINE = -0.7  # between the normals of the two sides of a wall
CUTS_SHARE, PEGS_SHARE = 0.8, 0.9  # fraction of the time until the end of the cuts, and of the pegs


class PrintError(Error):
    """Parts can't be prepared for a printer; str() says why."""

    name = "printing"


class PrintOptions(NamedTuple):
    """How parts are prepared for a printer.

    piece_count : divide the model into so many pieces, instead of the cut's parts: along the tree while parts are not
        convex, then the largest into equal pieces. 0: the cut's parts
    scale : millimeters per unit of the model
    pegs : clearance of pegs on every side; None for flat cuts without pegs
    wall : minimum thickness of walls, also around sockets
    bed : (3,) size of the printer's bed and height; None if it is large enough
    """

    scale: float = 1.0
    pegs: Optional[float] = None
    wall: float = 1.2
    bed: Optional[Sequence[float]] = None
    piece_count: int = 0


class Peg(NamedTuple):
    """A peg of one part in a socket of another. The socket leaves a gap on all sides except at the cut.

    part : the piece with the peg
    into : the piece with the socket
    center : (3,) on the cut
    direction : (3,) unit, into the other piece
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
    """Pieces that are ready for a printer. Piece number n < len(cut) is part n, or what is left of it; further pieces of
    divided parts come last.

    cut : after splits along the tree for the bed
    names : of the pieces
    parts : the part that each piece is of
    solids : {piece: (vertices (V, 3), triangles (T, 3))}
    pegs
    notes : sentences on what could not be done, and on pieces that are too thin or too large
    source_faces : {piece: (T,) the source face of each triangle; -1 in cuts, pegs and sockets}
    scale : millimeters per unit of the model
    beds : of each print bed {piece: (3, 4) matrix that places it there}; [] if no bed is given
    """

    cut: Cut
    names: List[str]
    parts: List[int]
    solids: Dict[int, Tuple[np.ndarray, np.ndarray]]
    pegs: List[Peg]
    notes: List[str]
    source_faces: Dict[int, np.ndarray]
    scale: float
    beds: List[Dict[int, np.ndarray]]


def prepare_parts(cut: Cut, vertices: np.ndarray, triangles: np.ndarray, faces: np.ndarray,
                  options: PrintOptions = PrintOptions(), word: str = "Part", names: Optional[List[str]] = None,
                  context: Optional[Context] = None) -> Printable:
    """Prepare the parts of a cut for a 3D printer.

    Parameters
    ----------
    vertices : (V, 3), triangles : (T, 3), faces : (T,) the source face of each triangle: the surface of the hierarchy
    word : what names of parts begin with
    names : of the parts of a cut from split_parts(); None: the cut is split, and its parts get names from name_parts()
    context : to cancel from another thread and to read the progress

    Raises
    ------
    PrintError : manifold3d rejects a part
    RequirementError : manifold3d is not installed
    PartwheelError : the call was canceled
    """
    context = context or Context()
    manifold: Any = load_module("manifold3d", "Making parts ready for a 3D printer")
    notes: List[str] = []
    if names is None:
        cut = split_parts(cut, options, context)
        names = name_parts(cut, vertices, triangles, faces, word)
    solid = cut.hierarchy.solid_of_slice(0, len(cut.hierarchy.tetrahedra))
    cutter = FlatCutter(manifold, solid.vertices * options.scale, solid.triangles, _solid_labels(cut, solid))
    if cutter.whole.status() != manifold.Error.NoError:
        raise PrintError(f"The model is no solid for manifold3d: {cutter.whole.status().name}.")
    bodies = _cut_along_borders(cutter, part_tree(cut, vertices, triangles, cut.labels[faces]), names, notes,
                                context)
    context.start_step(CUTS_SHARE)
    parts = list(range(len(cut)))
    for part, pieces in _divide(cutter, bodies, options).items():
        bodies[part] = pieces[0]
        for piece in pieces[1:]:
            bodies[len(parts)] = piece
            parts.append(part)
    names = [name if parts.count(part) == 1 else f"{names[part]}-{parts[:piece + 1].count(part)}"
             for piece, (part, name) in enumerate((part, names[part]) for part in parts)]
    pegs = [] if options.pegs is None else list(_add_pegs(cutter, bodies, names, notes, options))
    result: Dict[int, Tuple[np.ndarray, np.ndarray]] = {}
    solid_faces = find_source_faces(solid, RayTarget(vertices, triangles), faces)
    source_faces: Dict[int, np.ndarray] = {}
    for number, (piece, body) in enumerate(sorted(bodies.items())):
        context.start_step(PEGS_SHARE + (1 - PEGS_SHARE) * number / len(bodies))
        mesh = body.to_mesh64()
        surface = separate(mesh.vert_properties[:, :3], mesh.tri_verts)
        result[piece] = surface[:2]
        source_faces[piece] = cutter.find_sources(mesh, np.append(solid_faces, -1))[surface.sources]
        notes += _check_solid(names[piece], cutter, body, *result[piece], options)
    beds = place_on_beds(result, options.bed, manifold) if options.bed else []
    return Printable(cut, names, parts, result, pegs, notes, source_faces, options.scale, beds)


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


def _corners(cut: Cut, part: int) -> np.ndarray:
    """(n, 3) corners of a part's tetrahedra."""
    hierarchy = cut.hierarchy
    tets = np.concatenate([hierarchy.tetrahedra[first:last] for first, last in zip(*cut.slices(part))])
    return hierarchy.vertices[np.unique(tets)]


def split_parts(cut: Cut, options: PrintOptions, context: Optional[Context] = None) -> Cut:
    """The cut with its parts split along the tree until there are piece_count, and each fits the bed. Nearly convex parts
    have no parts of their own and stay whole.

    Raises
    ------
    RequirementError : manifold3d is not installed
    PartwheelError : the call was canceled
    """
    manifold: Any = load_module("manifold3d", "Making parts ready for a 3D printer")
    context, count = context or Context(), options.piece_count
    if count:
        cut = Cut.into(cut.hierarchy, 1)
    convex_keys: Set[int] = set()
    while True:
        context.start_step(0)
        too_large = [part for part in range(len(cut)) if not _fits(_corners(cut, part) * options.scale, options)]
        candidates = [part for part in (range(len(cut)) if len(cut) < count else too_large) if cut.keys[part] not in convex_keys]
        if not candidates:
            return cut
        part = max(candidates, key=lambda part: max(cut.parts[part]))  # the last merge
        hull = manifold.Manifold.hull_points(_corners(cut, part))
        split = cut.split(part) if hull.volume() > (1 + MAX_CONCAVITY) * cut.volume(part) else cut
        smallest = min(map(split.volume, range(len(cut), len(split))), default=0.0)
        if split is cut or (len(cut) >= count and smallest < MIN_SPLIT_SHARE * cut.volume(part)):
            convex_keys.add(cut.keys[part])
        else:
            cut = split


def _solid_labels(cut: Cut, solid: Solid) -> np.ndarray:
    """(T,) the part of each triangle of the whole solid; triangles that no source face has are like their neighbors."""
    labels = np.where(solid.source_faces >= 0, cut.labels[solid.source_faces], -1)
    while (is_unknown := labels < 0).any():
        of_vertex = np.full(len(solid.vertices), -1)
        of_vertex[solid.triangles[~is_unknown]] = labels[~is_unknown][:, None]
        spread = of_vertex[solid.triangles[is_unknown]].max(axis=1)
        labels[is_unknown] = spread if (spread >= 0).any() else 0  # 0: no triangle of their component has a source face
    return labels


def _cut_along_borders(cutter: FlatCutter, links: Sequence[ParentLink], names: Sequence[str],
                       notes: List[str], context: Context) -> Dict[int, Any]:
    """{part: body}. Each part is cut off what is left of the model, from the tips of the tree of parts to its root."""
    order = parents_first(links)[::-1]
    pieces: Dict[int, List[Any]] = {}
    for body in cutter.components(cutter.whole):
        areas = cutter.areas(body)
        here = [part for part in order if part < len(areas) and areas[part] > 0]
        for number, part in enumerate(here[:-1]):
            context.start_step(CUTS_SHARE * number / len(here))
            result = cutter.cut_off(body, part, here[number + 1:])
            if result:
                pieces.setdefault(part, []).extend(result[0])
                body = result[1]
                continue
            parent = links[part].parent
            other = parent if parent in here[number + 1:] else here[-1]
            cutter.merge(part, other)
            notes.append(f"{names[part]} stays joined to {names[other]}: no plane separates the two.")
        pieces.setdefault(here[-1], []).append(body)
    notes += [f"{name} has nothing left inside." for part, name in enumerate(names)
              if part not in pieces and not any(note.startswith(f"{name} stays") for note in notes)]
    return {part: cutter.manifold.Manifold.compose(of_part) if len(of_part) > 1 else of_part[0]
            for part, of_part in pieces.items()}


def _divide(cutter: FlatCutter, bodies: Dict[int, Any], options: PrintOptions) -> Dict[int, List[Any]]:
    """{part: its pieces, which fit the bed}, of parts that are divided."""
    counts = dict.fromkeys(bodies, 1)
    while sum(counts.values()) < options.piece_count:
        counts[max(bodies, key=lambda part: bodies[part].volume() / counts[part])] += 1
    result = {}
    for part, body in bodies.items():
        pieces = cutter.divide(body, counts[part]) if counts[part] > 1 else cutter.components(body)
        if options.bed is not None:
            pieces = [small for piece in pieces for small in cutter.fit_to_bed(piece, np.sort(options.bed))]
        if len(pieces) > 1:
            result[part] = pieces
    return result


def _add_pegs(cutter: FlatCutter, bodies: Dict[int, Any], names: Sequence[str], notes: List[str],
              options: PrintOptions) -> Iterator[Peg]:
    """Add pegs and sockets to the pieces on the two sides of each cut."""
    sides = {piece: [cutter.sides(body, number) for number in range(len(cutter.planes))] for piece, body in bodies.items()}
    has_peg: Dict[Tuple[int, int], bool] = {}
    for number, plane in enumerate(cutter.planes):
        for part, other in permutations(sides, 2):
            if sides[part][number][0] and sides[other][number][1]:
                joint = _PrintJoint(cutter, plane, part, other)
                pegs = joint.add_pegs(bodies, options)
                yield from pegs
                pair = min(part, other), max(part, other)
                has_peg[pair] = has_peg.get(pair, False) or bool(pegs)
    notes += [f"There is no room for a peg between {names[one]} and {names[other]}."
              for (one, other), is_pegged in has_peg.items() if not is_pegged]


class _PrintJoint:
    """The planar cut between two pieces; its normal points from the first one into the other."""

    def __init__(self, cutter: FlatCutter, plane: Plane, part: int, other: int) -> None:
        self.cutter, self.plane, self.part, self.other = cutter, plane, part, other

    def add_pegs(self, bodies: Dict[int, Any], options: PrintOptions) -> Sequence[Peg]:
        """Add one peg or, in a wide cut, two to the first piece, and cut their sockets into the other. [] if none
        fits."""
        one, other = bodies[self.part], bodies[self.other]
        region = self.plane.section(one, -SECTION_HEIGHT) ^ self.plane.section(other, SECTION_HEIGHT)
        if region.area() < np.pi * MIN_PEG_RADIUS ** 2:
            return []
        clearance = options.pegs or 0.0
        center, free_radius = _largest_circle(region)
        corner_clearance = clearance / PEG_RATIO
        radius = min(PEG_RADIUS_FRACTION * free_radius, CYLINDER_RATIO * free_radius - corner_clearance - options.wall)
        while radius >= MIN_PEG_RADIUS:
            free = region.offset(-1.01 * (radius + corner_clearance + options.wall) / CYLINDER_RATIO)
            pair = _farthest_pair(free)
            pegs: List[Peg] = []
            if np.linalg.norm(pair[1] - pair[0]) > MIN_PEG_DISTANCE * radius:
                pegs = [peg for end in pair if (peg := self._add_peg(bodies, end, radius, options))]
            if pegs:
                return pegs
            if peg := self._add_peg(bodies, center, radius, options):
                return [peg]
            radius *= 0.8
        return []

    def _add_peg(self, bodies: Dict[int, Any], center: np.ndarray, radius: float, options: PrintOptions) -> Optional[Peg]:
        """Add a peg at a place (2,) in the plane's frame; None if it does not fit."""
        one, other = bodies[self.part], bodies[self.other]
        clearance, wall = options.pegs or 0.0, options.wall
        corner_clearance = clearance / PEG_RATIO

        def column(bottom: float, top: float, column_radius: float, sides: int = PEG_SIDES) -> Any:
            return self.cutter.make_tool(self.plane.to_model(self.cutter.manifold.Manifold.cylinder(
                top - bottom, column_radius, circular_segments=sides).translate((*center, bottom))))

        for length in (radius * relative for relative in PEG_LENGTHS):
            socket_wall = column(KERF, length + clearance + wall, (radius + corner_clearance + wall) / CYLINDER_RATIO,
                                 CYLINDER_SIDES)
            root = column(-PEG_ROOT_DEPTH * radius, -KERF, radius)
            if (socket_wall - other).volume() > RELATIVE_TOLERANCE * socket_wall.volume() or (
                    root - one).volume() > RELATIVE_TOLERANCE * root.volume():
                continue
            with_peg = one + column(-PEG_ROOT_DEPTH * radius, length, radius)
            if options.bed is not None and not _fits(np.asarray(with_peg.to_mesh64().vert_properties), options):
                continue
            bodies[self.part] = with_peg
            bodies[self.other] = other - column(-SECTION_HEIGHT, length + clearance, radius + corner_clearance)
            place = self.plane.center + self.plane.axes.T @ (*center, 0)
            return Peg(self.part, self.other, place, self.plane.axes[2], radius, length)
        return None


def _fits(vertices: np.ndarray, options: PrintOptions) -> bool:
    return options.bed is None or fits_bed(vertices, np.sort(options.bed))


def _farthest_pair(section: Any) -> Tuple[np.ndarray, np.ndarray]:
    """The two corners of a CrossSection that are farthest apart; twice the same if it is empty."""
    contours = section.to_polygons()
    if not contours:
        return np.zeros(2), np.zeros(2)
    corners = np.vstack(contours)
    first = corners[np.linalg.norm(corners - corners.mean(axis=0), axis=1).argmax()]
    return first, corners[np.linalg.norm(corners - first, axis=1).argmax()]


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


def _check_solid(name: str, cutter: FlatCutter, body: Any, vertices: np.ndarray, triangles: np.ndarray,
                 options: PrintOptions) -> Iterator[str]:
    """Sentences on what is wrong with a solid."""
    component_count = len(cutter.components(body))
    if component_count != 1:
        yield f"{name} is in {component_count} pieces."
    if not _fits(vertices, options):
        size = " x ".join(f"{length:.1f}" for length in np.ptp(vertices, axis=0))
        yield f"{name} is too large for the bed: {size} mm."
    walls = wall_thickness(vertices, triangles)
    is_thin = walls < options.wall
    if is_thin.any():
        yield (f"{name} has walls thinner than {options.wall:g} mm on {is_thin.sum() / WALL_SAMPLES:.1%} of its surface, the "
               f"thinnest {walls.min():.2f} mm.")
