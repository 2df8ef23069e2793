# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of a cut for a 3D printer: planar cuts with pegs, snap pins or dovetails, or holes for dowels or magnets;
parts that are too large for the bed are cut into equal pieces; walls are checked. With manifold3d. Lengths are in millimeters."""

from __future__ import annotations

from itertools import permutations
from typing import Any, Dict, Iterator, List, NamedTuple, Optional, Sequence, Set, Tuple

import numpy as np

from ..hierarchy import Solid
from ..library import Context, Error
from ..rays import RayTarget
from ..requirements import load_module
from ..separation import separate
from ..triangles import doubled_area_vectors, sample_triangles, unit_vectors
from .beds import place_on_beds
from .borders import ParentLink, parents_first, part_tree
from .cut import Cut
from .flat_cuts import FlatCutter, fits_bed, read_body
from .joints import CLEARANCES, KINDS, Insert, CutJoint, Peg
from .names import name_parts
from .sources import find_source_faces

__all__ = ["CLEARANCES", "Insert", "Peg", "PrintError", "PrintOptions", "Printable", "prepare_parts", "split_parts",
           "wall_thickness"]

# Splits along the tree
MAX_CONCAVITY = 0.03  # volume between a nearly convex part and its hull, by the part's
MIN_SPLIT_SHARE = 0.1  # of a part's volume, in the smallest part that a split for the bed makes
# Checks
WALL_SAMPLES = 1000  # points where the thickness of a solid's walls is measured
MAX_WALL_COSINE = -0.7  # between the normals of the two sides of a wall
CUTS_SHARE, PEGS_SHARE = 0.8, 0.9  # fraction of the time until the end of the cuts, and of the pegs


class PrintError(Error):
    """Parts can't be prepared for a printer; str() says why."""

    name = "printing"


class PrintOptions(NamedTuple):
    """How parts are prepared for a printer."""

    scale: float = 1.0  # millimeters per unit of the model
    pegs: Optional[float] = None  # clearance of pegs and other joints on every side; None for flat cuts without joints
    wall: float = 1.2  # minimum thickness of walls, also around sockets
    bed: Optional[Sequence[float]] = None  # (3,) size of the printer's bed and height; None if it is large enough
    # Divide the model into so many pieces, instead of the cut's parts: along the tree while parts are not convex, then the
    # largest into equal pieces. 0: the cut's parts
    piece_count: int = 0
    # Dowels or magnets that the user has, for which both sides of a cut get holes instead of pegs
    inserts: Optional[Insert] = None
    numbers: bool = False  # engrave the number of each cut into its two sides
    joint: str = "peg"  # "peg"; or "snap pin" or "dovetail" where these fit, and pegs elsewhere


class Printable(NamedTuple):
    """Pieces that are ready for a printer. Piece number n < len(cut) is part n, or what is left of it; further pieces of
    divided parts come last."""

    cut: Cut  # after splits along the tree for the bed
    names: List[str]  # of the pieces
    parts: List[int]  # the part that each piece is of
    solids: Dict[int, Tuple[np.ndarray, np.ndarray]]  # {piece: (vertices (V, 3), triangles (T, 3))}
    pegs: List[Peg]  # also snap pins, dovetails, and the holes for dowels and magnets
    notes: List[str]  # sentences on what could not be done, and on pieces that are too thin or too large
    source_faces: Dict[int, np.ndarray]  # {piece: (T,) the source face of each triangle; -1 in cuts, pegs and sockets}
    scale: float  # millimeters per unit of the model
    beds: List[Dict[int, np.ndarray]]  # of each print bed {piece: (3, 4) matrix that places it there}; [] if no bed is given

    def turned(self, turn: np.ndarray) -> Printable:
        """The same pieces after a rotation (3, 3) of the model, in the same places on the beds."""
        return self._replace(
            solids={piece: (vertices @ turn.T, triangles) for piece, (vertices, triangles) in self.solids.items()},
            pegs=[peg._replace(center=turn @ peg.center, direction=turn @ peg.direction, outline=peg.outline @ turn.T)
                  for peg in self.pegs],
            beds=[{piece: np.column_stack([place[:, :3] @ turn.T, place[:, 3]]) for piece, place in bed.items()}
                  for bed in self.beds])


def prepare_parts(cut: Cut, vertices: np.ndarray, triangles: np.ndarray, faces: np.ndarray,
                  options: PrintOptions = PrintOptions(), names: Optional[List[str]] = None,
                  context: Optional[Context] = None) -> Printable:
    """Prepare the parts of a cut, of a surface with a source face for each triangle, for a 3D printer.

    names : of the parts of a cut from split_parts(); None: the cut is split, and its parts get names
    context : to cancel from another thread and to read the progress

    Raises PrintError if manifold3d rejects a part, RequirementError without it, PartwheelError after cancellation."""
    if options.joint not in KINDS:
        raise ValueError(f"joint must be one of {', '.join(KINDS)}.")
    context = context or Context()
    manifold: Any = load_module("manifold3d", "Making parts ready for a 3D printer")
    notes: List[str] = []
    if names is None:
        cut = split_parts(cut, options, context)
        names = name_parts(cut, vertices, triangles, faces)
    solid = cut.hierarchy.solid_of_slice(0, len(cut.hierarchy.tetrahedra))
    cutter = FlatCutter(manifold, solid.vertices * options.scale, solid.triangles, _solid_labels(cut, solid))
    if cutter.whole.status() != manifold.Error.NoError:
        raise PrintError(f"manifold3d can't use the model as a solid: {cutter.whole.status().name}. Remesh it.")
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
    pegs = list(_join_pieces(cutter, bodies, names, notes, options))
    result: Dict[int, Tuple[np.ndarray, np.ndarray]] = {}
    solid_faces = find_source_faces(solid, RayTarget(vertices, triangles), faces)
    source_faces: Dict[int, np.ndarray] = {}
    for number, (piece, body) in enumerate(sorted(bodies.items())):
        context.start_step(PEGS_SHARE + (1 - PEGS_SHARE) * number / len(bodies))
        body_vertices, body_triangles, ids = read_body(body)
        surface = separate(body_vertices, body_triangles)
        result[piece] = surface[:2]
        # The last one is for triangles of cuts and tools.
        source_faces[piece] = np.append(solid_faces, -1)[np.minimum(ids, cutter.triangle_count)][surface.sources]
        notes += _check_solid(names[piece], cutter, body, *result[piece], options)
    beds = place_on_beds(result, options.bed, manifold) if options.bed else []
    return Printable(cut, names, parts, result, pegs, notes, source_faces, options.scale, beds)


def wall_thickness(vertices: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """(n,) thickness of a solid's walls at WALL_SAMPLES evenly distributed points of its surface, wound outward: the distance
    straight through to a surface that faces the other way. Points without one, as at edges, are left out."""
    corners = vertices[triangles]
    vectors = doubled_area_vectors(corners)
    normals, areas = unit_vectors(vectors), np.linalg.norm(vectors, axis=1) / 2
    target, thicknesses = RayTarget(vertices, triangles), []
    for point, triangle in zip(*sample_triangles(corners, areas, WALL_SAMPLES)):
        hit = target.first_hit(point, -normals[triangle], 1e-6 * np.sqrt(2 * areas.sum()))
        if hit and normals[hit[0]] @ normals[triangle] < MAX_WALL_COSINE:
            thicknesses.append(hit[1])
    return np.array(thicknesses)


def _corners(cut: Cut, part: int) -> np.ndarray:
    """(n, 3) corners of a part's tetrahedra."""
    return cut.hierarchy.vertices[np.unique(cut.tetrahedra(part))]


def split_parts(cut: Cut, options: PrintOptions, context: Optional[Context] = None) -> Cut:
    """The cut with its parts split along the tree until there are piece_count, and each fits the bed. Nearly convex parts
    have no parts of their own and stay whole. Raises as prepare_parts() does."""
    manifold: Any = load_module("manifold3d", "Making parts ready for a 3D printer")
    context, count = context or Context(), options.piece_count
    if count:
        cut = Cut.into(cut.hierarchy, 1)
    convex_keys: Set[int] = set()
    while True:
        context.start_step(0)
        too_large = [part for part in range(len(cut)) if not fits_bed(_corners(cut, part) * options.scale, options.bed)]
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
    notes += [f"{name} is missing: the other parts took all of it." for part, name in enumerate(names)
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


def _join_pieces(cutter: FlatCutter, bodies: Dict[int, Any], names: Sequence[str], notes: List[str],
                 options: PrintOptions) -> Iterator[Peg]:
    """Add pegs, holes and numbers to the pieces on the two sides of each cut. All cuts come before, so none meets a socket, and
    each socket keeps its wall from all others."""
    sides = {piece: [cutter.sides(body, number) for number in range(len(cutter.planes))] for piece, body in bodies.items()}
    kinds = ["hole"] if options.inserts else list(dict.fromkeys([options.joint, "peg"]))
    free = dict(bodies)
    joined: Dict[Tuple[int, int], Set[str]] = {}
    for cut, plane in enumerate(cutter.planes):
        for part, other in permutations(sides, 2):
            if not (sides[part][cut][0] and sides[other][cut][1]):
                continue
            joint = CutJoint(cutter, plane, part, other, free, options.wall, options.bed)
            pair = min(part, other), max(part, other)
            done = joined.setdefault(pair, set())
            for kind in kinds:
                if options.pegs is None or (kind != "dovetail" and "dovetail" in done):
                    continue  # a peg would keep the dovetail from sliding
                if pegs := joint.join(bodies, options.pegs, kind, options.inserts):
                    yield from pegs
                    done.add(kind)
                    break
            if options.numbers and joint.engrave(bodies, list(joined).index(pair) + 1):
                done.add("number")
    for (one, other), done in joined.items():
        between = f"between {names[one]} and {names[other]}"
        if options.pegs is not None and kinds[0] not in done:
            notes.append(f"There is no room for a {kinds[0]} {between}" + ("; they have a peg." if "peg" in done else "."))
        if options.numbers and "number" not in done:
            notes.append(f"There is no room for a number {between}.")


def _check_solid(name: str, cutter: FlatCutter, body: Any, vertices: np.ndarray, triangles: np.ndarray,
                 options: PrintOptions) -> Iterator[str]:
    """Sentences on what is wrong with a solid."""
    component_count = len(cutter.components(body))
    if component_count != 1:
        yield f"{name} is in {component_count} pieces."
    if not fits_bed(vertices, options.bed):
        size = " x ".join(f"{length:.1f}" for length in np.ptp(vertices, axis=0))
        yield f"{name} is too large for the bed: {size} mm."
    walls = wall_thickness(vertices, triangles)
    is_thin = walls < options.wall
    if is_thin.any():
        yield (f"{name} has walls thinner than {options.wall:g} mm on {is_thin.sum() / WALL_SAMPLES:.1%} of its surface, the "
               f"thinnest {walls.min():.2f} mm.")
