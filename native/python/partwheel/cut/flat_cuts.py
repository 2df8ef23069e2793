# SPDX-License-Identifier: GPL-3.0-or-later
"""Cuts a solid by planes: along the borders of its parts, or into equal pieces. With manifold3d. Each cut removes a plate of
thickness KERF, only where the solid should come apart, so that other limbs that the plane meets stay whole."""

from __future__ import annotations

from itertools import product
from typing import Any, Iterator, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np
from numpy.typing import ArrayLike

from ..components import components, triangle_components
from ..deform import orthonormal_pair
from ..triangles import doubled_area_vectors, triangle_areas

KERF = 2e-5  # mm, far below a printer's precision
# Margins of the plate around the section, in radii of the border; the first that cuts nothing else is used.
MARGINS = 0.2, 0.05, 0.01, 0.002
# Planes that are tried at a border
TILTS = 0.0, 0.2, 0.45  # radians
OFFSETS = 0.0, -0.12, 0.12, -0.3, 0.3  # radii of the border
MAX_ATTEMPTS = 10  # of the planes, by score
SECTION_WEIGHT, THIN_WEIGHT = 0.25, 1.0  # of the section's radius and of its thin area, relative to the distance from the border
WRONG_WEIGHT = 2.0  # of the share of the smaller side's surface that is on the wrong side of a cut
MAX_WRONG_AREA = 0.5  # the limit of this share
MIN_NEIGHBOR_SHARE = 0.1  # of a border's length: if the border with a second neighbor has more, it may get a plane of its own
MIN_WEDGE_SPREAD = 1e-6  # least spread of edges around the common line of two planes
WEDGE_COST = 0.15  # added to the score of two planes: the second one may be in the way of later cuts
MAX_CAP_PLANES = 3  # of cuts that meet
MIN_REGION_SHARE = 0.1  # of a border's points that are nearest to a region of the section that is cut
MIN_LOOP_RATIO = 0.2  # of the longest loop of a border: shorter ones are cut only if that is necessary
MAX_LOOPS = 5  # of a border: with more long loops it is not cut
MIN_OPEN_SPREAD = 0.15  # second to first principal spread: flatter borders say nothing about the plane
# Equal pieces
ELONGATION = 1.5  # length / width from which a solid is cut across its own axis, not across an axis of the bed
SHIFTS = 0.0, -0.05, 0.05, -0.1, 0.1, -0.15, 0.15  # of the planes, in lengths of a piece
MIN_PIECE_VOLUME = 0.02  # relative to the mean piece: smaller ones are slivers, to be avoided
TOOL_ID = 1 << 30  # added to the face ids of pegs and sockets
MIN_VOLUME = 1e-7  # of a body: smaller components are rounding errors


class Plane(NamedTuple):
    """A plane with a frame."""

    center: np.ndarray  # (3,)
    axes: np.ndarray  # (3, 3) rows x, y, z; z is the normal

    @classmethod
    def create(cls, center: np.ndarray, normal: np.ndarray) -> Plane:
        """The plane through a point."""
        z = normal / np.linalg.norm(normal)
        return cls(center, np.array([*orthonormal_pair(z), z]))

    def moved(self, center: np.ndarray, along: np.ndarray = np.array((1.0, 0.0))) -> Plane:
        """The same plane with the center at a point (2,) of its frame, and the axis x along a direction (2,)."""
        x = self.axes[:2].T @ (along / np.linalg.norm(along))
        return Plane(self.center + self.axes[:2].T @ center, np.array([x, np.cross(self.axes[2], x), self.axes[2]]))

    def to_local(self, points: np.ndarray) -> np.ndarray:
        """(n, 3) points in the frame."""
        return (points - self.center) @ self.axes.T

    def to_model(self, tool: Any) -> Any:
        """A tool in the model's frame. Tools are transformed, not bodies, so that common corners of bodies stay equal."""
        return tool.transform(np.column_stack([self.axes.T, self.center]))

    def section(self, body: Any, height: float = 0.0) -> Any:
        """The CrossSection of a body at a height above the plane."""
        return body.transform(np.column_stack([self.axes, -self.axes @ self.center])).slice(height)


class _CutPlanes(NamedTuple):
    """A plane at a border, or two that share a line."""

    plates: List[Tuple[Any, ...]]  # (plane, plate in its frame) of each
    score: float  # 0 is perfect


class _Loop(NamedTuple):
    """A connected component of a part's border."""

    edges: np.ndarray  # (n, 2, 3), wound around the part
    neighbors: np.ndarray  # (n,) the part on the other side of each

    def ring(self) -> Tuple[np.ndarray, np.ndarray, np.ndarray, float]:
        """(middles of the edges (n, 3), their lengths (n,), the loop's center (3,), its radius)"""
        middles, lengths = self.edges.mean(axis=1), np.linalg.norm(self.edges[:, 1] - self.edges[:, 0], axis=1) + 1e-12
        center = np.average(middles, axis=0, weights=lengths)
        return middles, lengths, center, float(np.average(np.linalg.norm(middles - center, axis=1), weights=lengths))

    def planes(self) -> Iterator[Plane]:
        """Planes to try; their normals point out of the part."""
        middles, lengths, center, radius = self.ring()
        around = np.cross(self.edges[:, 1] - center, self.edges[:, 0] - center).sum(axis=0)
        flat = np.linalg.svd((middles - center) * np.sqrt(lengths)[:, None])[2][2]
        flat = flat * (1 if flat @ around >= 0 else -1)
        bases = [flat]
        if np.linalg.norm(around) > 1e-3 * radius * lengths.sum():
            around /= np.linalg.norm(around)
            bases += [around, flat + around]
        for base, tilt, turn, offset in product(bases, TILTS, np.arange(4) * np.pi / 2, OFFSETS):
            if (tilt == 0 and turn > 0) or (tilt and (base is not bases[-1] or abs(offset) > 0.2)):
                continue
            frame = Plane.create(center, base).axes
            normal = np.cos(tilt) * frame[2] + np.sin(tilt) * (np.cos(turn) * frame[0] + np.sin(turn) * frame[1])
            yield Plane.create(center + offset * radius * normal, normal)

    def wedges(self) -> Iterator[Tuple[List[Plane], np.ndarray]]:
        """(two planes, the one of each edge): one plane for the border with a neighbor, one for the rest of the border. They
        share the line through the two points where these borders meet; of each the half where y >= 0 is used."""
        lengths = np.linalg.norm(self.edges[:, 1] - self.edges[:, 0], axis=1)
        for neighbor in np.unique(self.neighbors):
            group = (self.neighbors == neighbor).astype(int)
            if not MIN_NEIGHBOR_SHARE < lengths[group == 1].sum() / lengths.sum() < 1 - MIN_NEIGHBOR_SHARE:
                continue
            ends = [set(map(tuple, self.edges[group == side].reshape(-1, 3).tolist())) for side in (0, 1)]
            common = sorted(ends[0] & ends[1])
            if len(common) != 2:
                continue
            low, high = np.array(common)
            line = (high - low) / np.linalg.norm(high - low)
            planes = []
            for side in (0, 1):
                edges = self.edges[group == side] - low
                middles = edges.mean(axis=1)
                middles -= np.outer(middles @ line, line)
                _, spread, axes = np.linalg.svd(middles * np.sqrt(lengths[group == side])[:, None], full_matrices=False)
                if spread[0] < MIN_WEDGE_SPREAD * lengths.sum() ** 1.5:
                    break  # these edges are on the line, so no plane is theirs
                away = axes[0] * (1 if axes[0] @ middles.sum(axis=0) >= 0 else -1)
                normal = np.cross(line, away)
                along = line * (1 if normal @ np.cross(edges[:, 1], edges[:, 0]).sum(axis=0) >= 0 else -1)
                planes.append(Plane((low + high) / 2, np.array([along, away, np.cross(along, away)])))
            else:
                yield planes, group


class FlatCutter:
    """Cuts the bodies of a labeled surface.

    planes : of the cuts so far; the triangles of cut number k have the face id triangle_count + k
    """

    def __init__(self, manifold: Any, vertices: np.ndarray, triangles: np.ndarray, labels: np.ndarray) -> None:
        """vertices : (V, 3), triangles : (T, 3), closed; labels : (T,) the part of each triangle"""
        self.manifold, self.labels, self.triangle_count = manifold, labels.copy(), len(triangles)
        self.planes: List[Plane] = []
        self.whole = self.make_body(vertices, triangles, np.arange(len(triangles)))
        shells = self.components(self.whole)
        if len(shells) > 1:  # where shells overlap, they become one
            self.whole = manifold.Manifold.batch_boolean(shells, manifold.OpType.Add)
        self.vertices, triangles, ids = read_body(self.whole)
        labels = self.labels[ids]
        edges = triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
        order = np.lexsort([edges[:, 0] > edges[:, 1], edges.max(axis=1), edges.min(axis=1)])
        ahead, back = order[::2], order[1::2]  # the two half-edges of each edge
        is_border = labels[ahead // 3] != labels[back // 3]
        self.border_triangles = ids[np.column_stack([ahead, back])[is_border] // 3]
        self.border_vertices = edges[ahead[is_border]]

    def make_body(self, vertices: np.ndarray, triangles: np.ndarray, face_ids: np.ndarray) -> Any:
        """A Manifold whose triangles have ids."""
        return self.manifold.Manifold(self.manifold.Mesh64(np.array(vertices, np.float64, order="C"), np.array(
            triangles, np.uint64, order="C"), face_id=np.array(face_ids, np.uint64)))

    def make_tool(self, body: Any) -> Any:
        """A body whose triangles have ids that are no triangles of the surface."""
        vertices, triangles, ids = read_body(body)
        return self.make_body(vertices, triangles, ids + TOOL_ID)

    def components(self, body: Any) -> List[Any]:
        """The connected components of a body with their cavities, largest first, without rounding errors."""
        tolerance = MIN_VOLUME * abs(body.volume())
        pieces = sorted((piece for piece in body.decompose() if abs(piece.volume()) > tolerance),
                        key=lambda piece: -piece.volume())
        cavities = [piece for piece in pieces if piece.volume() < 0]
        pieces = pieces[:len(pieces) - len(cavities)]
        for cavity in cavities:
            vertices, triangles, ids = read_body(cavity)
            filling = self.make_body(vertices, triangles[:, ::-1], ids)
            number = max(range(len(pieces)), key=lambda k: ((pieces[k] ^ filling).volume() > 0.5 * filling.volume(), k))
            pieces[number] -= filling
        return pieces

    def areas(self, body: Any) -> np.ndarray:
        """(parts,) the area of each part on a body's surface."""
        vertices, triangles, ids = read_body(body)
        is_source = ids < self.triangle_count
        return np.bincount(self.labels[ids[is_source]], triangle_areas(vertices[triangles[is_source]]),
                           minlength=self.labels.max() + 1)

    def sides(self, body: Any, number: int) -> Tuple[bool, bool]:
        """(whether the body has caps of a cut that face along the plane's normal, whether against it)"""
        vertices, triangles, ids = read_body(body)
        caps = vertices[triangles[ids == self.triangle_count + number]]
        along = doubled_area_vectors(caps) @ self.planes[number].axes[2]
        return bool((along > KERF).any()), bool((along < -KERF).any())

    # ---- Along borders

    def cut_off(self, body: Any, part: int, others: Sequence[int]) -> Optional[Tuple[List[Any], Any]]:
        """Cut a part off a body that still has these other parts: (components of the part, the rest); None if no planes do
        that."""
        loops = self._loops(part, others)
        if not loops:  # a sliver of the part is left, away from what it bordered on
            return None
        main = [loop for loop in loops if _length(loop.edges) >= MIN_LOOP_RATIO * max(_length(loop.edges) for loop in loops)]
        for chosen in [main] + [loops] * (len(main) < len(loops)):
            ranked = [self._rank_planes(body, loop) for loop in chosen] if len(chosen) <= MAX_LOOPS else [[]]
            if not all(ranked):
                continue
            best: Optional[Tuple[float, List[Any], Any, List[Plane]]] = None
            for attempt in range(max(map(len, ranked))):
                choices = [of_loop[min(attempt, len(of_loop) - 1)] for of_loop in ranked]
                score = float(np.mean([choice.score for choice in choices]))
                if best and score >= best[0]:
                    break
                first = len(self.planes)
                result = self._cut_by_plates(body, choices, part, others)
                if result and (best is None or score + WRONG_WEIGHT * result[0] < best[0]):
                    best = score + WRONG_WEIGHT * result[0], *result[1:], self.planes[first:]
                del self.planes[first:]
            if best:
                self.planes += best[3]
                return best[1:3]
        return None

    def merge(self, part: int, other: int) -> None:
        """Count a part as another one from now on."""
        self.labels[self.labels == part] = other

    def _loops(self, part: int, others: Sequence[int]) -> List[_Loop]:
        """The connected components of the part's border."""
        labels = self.labels[self.border_triangles]
        is_own = labels == part
        edges = np.where(is_own[:, :1], self.border_vertices, self.border_vertices[:, ::-1])
        is_used = is_own.any(axis=1) & ~is_own.all(axis=1)
        with_others = is_used & np.isin(labels, others).any(axis=1)
        if not with_others.any():
            return []
        component = components(len(self.vertices), edges[is_used])[edges[:, 0]]
        loops = []
        neighbors = np.where(is_own, -1, labels).max(axis=1)
        for number in np.unique(component[with_others]):
            chosen = with_others & (component == number)
            middles = self.vertices[edges[chosen]].mean(axis=1)
            spread = np.linalg.svd(middles - middles.mean(axis=0), compute_uv=False)
            if len(spread) < 2 or spread[1] < MIN_OPEN_SPREAD * spread[0]:
                chosen = is_used & (component == number)
            loops.append(_Loop(self.vertices[edges[chosen]], neighbors[chosen]))
        return loops

    def _rank_planes(self, body: Any, loop: _Loop) -> List[_CutPlanes]:
        """The planes that suit a border, best first."""
        middles, lengths, _, radius = loop.ring()
        sample = np.linspace(0, len(middles) - 1, min(len(middles), 100)).astype(int)
        choices = []
        for planes, group in [*(([plane], np.zeros(len(middles), int)) for plane in loop.planes()), *loop.wedges()]:
            choice = _CutPlanes([], WEDGE_COST * (len(planes) - 1))
            for number, plane in enumerate(planes):
                scored = self._score_plane(body, plane, middles[sample][group[sample] == number], radius, len(planes) > 1)
                if scored is None:
                    break
                share = np.average(group == number, weights=lengths)
                choice = _CutPlanes([*choice.plates, (plane, *scored[1:])], choice.score + scored[0] * share)
            else:
                choices.append(choice)
        result = []
        for choice in sorted(choices, key=lambda choice: choice.score)[:MAX_ATTEMPTS]:
            plates = [(plane, self._plate(chosen, rest, radius, len(choice.plates) > 1)) for plane, chosen, rest in choice.plates]
            if all(plate for _, plate in plates):
                result.append(_CutPlanes(plates, choice.score))
        return result

    def _score_plane(self, body: Any, plane: Plane, sample: np.ndarray, radius: float,
                     is_half: bool) -> Optional[Tuple[float, List[Any], List[Any]]]:
        """How far from perfect a plane is for points of a border, its section's regions that are to be cut, and the others;
        None if it misses the body. is_half : only the half of the plane where y >= 0 is used"""
        section = plane.section(body)
        regions = (section ^ self._half(0.0, section)).decompose() if is_half else section.decompose()
        if not regions or not len(sample):
            return None
        local = plane.to_local(sample)
        distances = np.array([_distances(local[:, :2], region) for region in regions])
        is_chosen = np.bincount(distances.argmin(axis=0), minlength=len(regions)) >= MIN_REGION_SHARE * len(sample)
        chosen = [region for region, is_cut in zip(regions, is_chosen) if is_cut]
        area = sum(region.area() for region in chosen)
        if not area:
            return None
        width = 0.1 * np.sqrt(area)
        thin = 1 - sum(region.offset(-width).offset(width).area() for region in chosen) / area
        score = (np.hypot(distances.min(axis=0), local[:, 2]).mean() / radius + THIN_WEIGHT * max(thin, 0)
                 + SECTION_WEIGHT * np.sqrt(area / np.pi) / radius)
        return score, chosen, [region for region, is_cut in zip(regions, is_chosen) if not is_cut]

    def _half(self, bottom: float, section: Any) -> Any:
        """The half-plane y >= bottom, as far as a section reaches."""
        size = 2 * np.abs(section.bounds()).max() + 1
        return self.manifold.CrossSection.square((2 * size, size)).translate((-size, bottom))

    def _plate(self, regions: Sequence[Any], rest: Sequence[Any], radius: float, is_half: bool = False) -> Optional[Any]:
        """A plate over regions of a section that does not reach the rest of it; None if they are too close. is_half : the
        plate ends where y is 0, or a bit below, where it meets that of another plane"""
        section = self.manifold.CrossSection
        inside, outside = section.compose(list(regions)), section.compose(list(rest)) if rest else None
        for margin in MARGINS:
            plate = inside.offset(margin * radius, self.manifold.JoinType.Square)
            if is_half:
                plate ^= self._half(-KERF, plate)
            if outside is None or (plate.offset(margin * radius) ^ outside).is_empty():
                return self.manifold.Manifold.extrude(plate, KERF).translate((0, 0, -KERF / 2))
        return None

    def _cut_by_plates(self, body: Any, choices: Sequence[_CutPlanes], part: int,
                       others: Sequence[int]) -> Optional[Tuple[float, List[Any], Any]]:
        """(the share of the smaller side's surface that is on the wrong side, components of the part, the rest); None if the
        planes don't separate them"""
        own: List[Any] = []
        rest: List[Any] = []
        wrong, total = 0.0, np.zeros(2)
        for piece in self.components(self._subtract(body, [plate for choice in choices for plate in choice.plates])):
            areas = self.areas(piece)
            both = np.array([areas[part], areas[list(others)].sum()])
            total += both
            wrong += both.min()
            (own if both[0] > both[1] else rest).append(piece)
        if len(rest) == 1 and 1 <= len(own) <= len(choices) and wrong <= MAX_WRONG_AREA * total.min() and max(
                map(self._cap_plane_count, own + rest)) <= MAX_CAP_PLANES:
            return wrong / total.min(), own, rest[0]
        return None

    def _cap_plane_count(self, body: Any) -> int:
        """The most planes that meet in a connected cap of a body."""
        _, triangles, ids = read_body(body)
        is_cap = (ids >= self.triangle_count) & (ids < TOOL_ID)
        cap = triangle_components(triangles[is_cap])
        pairs = np.unique(np.column_stack([cap, ids[is_cap]]), axis=0)
        return int(np.unique(pairs[:, 0], return_counts=True)[1].max(initial=0))

    def _subtract(self, body: Any, plates: Sequence[Tuple[Plane, Any]]) -> Any:
        """A body minus plates, whose planes are those of cuts from now on."""
        for plane, plate in plates:
            vertices, triangles, _ = read_body(plane.to_model(plate))
            body -= self.make_body(vertices, triangles, np.full(len(triangles), self.triangle_count + len(self.planes)))
            self.planes.append(plane)
        return body

    # ---- Equal pieces

    def divide(self, body: Any, count: int) -> List[Any]:
        """Cut a body across its long axis into pieces of equal length, and more where a plane meets several limbs."""
        direction = _long_axis(body)
        along = read_body(body)[0] @ direction
        low, length = along.min(), np.ptp(along) / count
        first, best = len(self.planes), None
        for shift in SHIFTS:
            plates = []
            for k in range(1, count):
                plane = Plane.create(direction * (low + (k + shift) * length), direction)
                if plate := self._plate([plane.section(body)], [], length):
                    plates.append((plane, plate))
            pieces = self.components(self._subtract(body, plates))
            limit = MIN_PIECE_VOLUME * body.volume() / len(pieces)
            faults = sum(piece.volume() < limit or self._cap_plane_count(piece) > MAX_CAP_PLANES for piece in pieces)
            if best is None or faults < best[0]:
                best = faults, pieces, self.planes[first:]
            del self.planes[first:]
            if not faults:
                break
        assert best is not None
        self.planes += best[2]
        return best[1]

    def fit_to_bed(self, body: Any, bed: np.ndarray) -> Iterator[Any]:
        """The pieces of a body that is cut until each fits the bed (3,), ascending, as it stands or turned by right
        angles."""
        vertices = read_body(body)[0]
        if fits_bed(vertices, bed):
            yield body
            return
        extents = np.sort(np.ptp(vertices, axis=0))
        along = np.ptp(vertices @ _long_axis(body))
        # The longest side may be within the bed while the second is not.
        is_over = extents > bed
        limit = bed[is_over].max()
        if along <= limit:
            limit = bed[is_over].min()
        count = max(2, int(np.ceil(along / limit - 1e-6)))
        pieces = self.divide(body, count)
        if len(pieces) < 2:
            yield body
            return
        for piece in pieces:
            yield from self.fit_to_bed(piece, bed)


def read_body(body: Any) -> Tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(vertices (n, 3), triangles (m, 3), their face ids (m,)) of a Manifold."""
    mesh = body.to_mesh64()
    return np.asarray(mesh.vert_properties)[:, :3], np.asarray(mesh.tri_verts, np.int64), np.asarray(mesh.face_id, np.int64)


def fits_bed(vertices: np.ndarray, bed: Optional[ArrayLike]) -> bool:
    """Whether a piece fits the bed (3,), as it stands or turned by right angles; always if there is None."""
    return bed is None or bool((np.sort(np.ptp(vertices, axis=0)) <= np.sort(bed) + 2 * KERF).all())


def _long_axis(body: Any) -> np.ndarray:
    """(3,) the direction across which to cut a body: its own axis if it is long, otherwise the longest side of its box."""
    vertices, triangles, _ = read_body(body)
    corners = vertices[triangles]
    weights = np.linalg.norm(doubled_area_vectors(corners), axis=1)
    middles = corners.mean(axis=1) - np.average(corners.mean(axis=1), axis=0, weights=weights)
    axes = np.linalg.svd((middles * np.sqrt(weights)[:, None]), full_matrices=False)[2]
    lengths, boxed = np.ptp(vertices @ axes.T, axis=0), np.ptp(vertices, axis=0)
    if lengths[0] > ELONGATION * lengths[1:].max() and lengths[0] > boxed.max():
        return axes[0]
    return np.eye(3)[boxed.argmax()]


def _length(loop: np.ndarray) -> float:
    return float(np.linalg.norm(loop[:, 1] - loop[:, 0], axis=1).sum())


def _distances(points: np.ndarray, region: Any) -> np.ndarray:
    """(n,) distances of points (n, 2) from the contours of a CrossSection."""
    best = np.full(len(points), np.inf)
    for contour in region.to_polygons():
        starts = np.asarray(contour)
        sides = np.roll(starts, -1, axis=0) - starts
        offsets = points[:, None] - starts
        t = np.clip((offsets * sides).sum(axis=2) / np.maximum((sides ** 2).sum(axis=1), 1e-300), 0, 1)
        best = np.minimum(best, np.linalg.norm(offsets - t[:, :, None] * sides, axis=2).min(axis=1))
    return best
