# SPDX-License-Identifier: GPL-3.0-or-later
"""Cuts a solid by planes: along the borders of its parts, or into equal pieces. With manifold3d. Each cut removes a plate of
thickness KERF, only where the solid should come apart, so that other limbs that the plane meets stay whole."""

from __future__ import annotations

from itertools import product
from typing import Any, Iterator, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from ..components import components
from ..triangles import doubled_area_vectors

KERF = 2e-5  # mm, far below a printer's precision
MARGINS = 0.2, 0.05, 0.01, 0.002  # of the plate around the section, in radii of the border; the first that cuts nothing else is used
# Planes that are tried at a border
TILTS = 0.0, 0.2, 0.45  # radians
OFFSETS = 0.0, -0.12, 0.12, -0.3, 0.3  # radii of the border
MAX_ATTEMPTS = 10  # of the planes, by score
SECTION_WEIGHT, THIN_WEIGHT = 0.25, 1.0  # of the section's radius, and of its thin area, against the distance from the border
MAX_WRONG_AREA = 0.5  # of the smaller side's surface, on the wrong side of a cut
MIN_REGION_SHARE = 0.1  # of a border's points that are nearest to a region of the section that is cut
MIN_LOOP_RATIO = 0.2  # of the longest loop of a border: shorter ones are cut only if that is necessary
MIN_OPEN_SPREAD = 0.15  # second to first principal spread: flatter borders say nothing about the plane
# Equal pieces
ELONGATION = 1.5  # a solid so much longer than wide is cut across its own axis, others across an axis of the bed
SHIFTS = 0.0, -0.05, 0.05, -0.1, 0.1, -0.15, 0.15  # of the planes, in lengths of a piece
MIN_PIECE_VOLUME = 0.02  # of the mean piece's: smaller ones are slivers, to be avoided
TOOL_ID = 1 << 30  # added to the face ids of pegs and sockets
MIN_VOLUME = 1e-7  # of a body: smaller components are rounding errors


class Plane(NamedTuple):
    """A plane with a frame.

    center : (3,)
    axes : (3, 3) rows x, y, z; z is the normal
    """

    center: np.ndarray
    axes: np.ndarray

    @classmethod
    def create(cls, center: np.ndarray, normal: np.ndarray) -> Plane:
        """The plane through a point."""
        z = normal / np.linalg.norm(normal)
        x = np.cross(np.eye(3)[abs(z).argmin()], z)
        x /= np.linalg.norm(x)
        return cls(center, np.array([x, np.cross(z, x), z]))

    def to_local(self, points: np.ndarray) -> np.ndarray:
        """(n, 3) points in the frame."""
        return (points - self.center) @ self.axes.T

    def to_model(self, tool: Any) -> Any:
        """A tool in the model's frame. Tools are transformed, not bodies, so that common corners of bodies stay equal."""
        return tool.transform(np.column_stack([self.axes.T, self.center]))

    def section(self, body: Any, height: float = 0.0) -> Any:
        """The CrossSection of a body at a height above the plane."""
        return body.transform(np.column_stack([self.axes, -self.axes @ self.center])).slice(height)


class FlatCutter:
    """Cuts the bodies of a labeled surface.

    planes : of the cuts so far; the triangles of cut number k have the face id triangle_count + k
    """

    def __init__(self, manifold: Any, vertices: np.ndarray, triangles: np.ndarray, labels: np.ndarray) -> None:
        """vertices : (V, 3), triangles : (T, 3), closed; labels : (T,) the part of each triangle"""
        self.manifold, self.labels, self.triangle_count = manifold, labels.copy(), len(triangles)
        self.planes: List[Plane] = []
        edges = triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
        order = np.lexsort([edges[:, 0] > edges[:, 1], edges.max(axis=1), edges.min(axis=1)])
        ahead, back = order[::2], order[1::2]  # the two half-edges of each edge
        is_border = labels[ahead // 3] != labels[back // 3]
        self.border_triangles = np.column_stack([ahead, back])[is_border] // 3
        self.border_vertices = edges[ahead[is_border]]
        self.vertices = vertices
        self.whole = self.make_body(vertices, triangles, np.arange(len(triangles)))

    def make_body(self, vertices: np.ndarray, triangles: np.ndarray, face_ids: np.ndarray) -> Any:
        """A Manifold whose triangles have ids."""
        return self.manifold.Manifold(self.manifold.Mesh64(np.array(vertices, np.float64, order="C"), np.array(
            triangles, np.uint64, order="C"), face_id=np.array(face_ids, np.uint64)))

    def make_tool(self, body: Any) -> Any:
        """A body whose triangles have ids that are no triangles of the surface."""
        mesh = body.to_mesh64()
        return self.make_body(mesh.vert_properties, mesh.tri_verts, np.asarray(mesh.face_id) + np.uint64(TOOL_ID))

    def find_sources(self, mesh: Any, sources: np.ndarray) -> np.ndarray:
        """Of each triangle of a body's mesh what belongs to the triangle of the surface that it is a part of.

        Parameters
        ----------
        sources : (triangle_count + 1,); the last one is for triangles of cuts and tools
        """
        return sources[np.minimum(np.asarray(mesh.face_id), np.uint64(self.triangle_count)).astype(np.int64)]

    def components(self, body: Any) -> List[Any]:
        """The connected components of a body with their cavities, largest first, without rounding errors."""
        tolerance = MIN_VOLUME * abs(body.volume())
        pieces = sorted((piece for piece in body.decompose() if abs(piece.volume()) > tolerance),
                        key=lambda piece: -piece.volume())
        cavities = [piece for piece in pieces if piece.volume() < 0]
        pieces = pieces[:len(pieces) - len(cavities)]
        for cavity in cavities:
            mesh = cavity.to_mesh64()
            filling = self.make_body(mesh.vert_properties, mesh.tri_verts[:, ::-1], mesh.face_id)
            number = max(range(len(pieces)), key=lambda k: ((pieces[k] ^ filling).volume() > 0.5 * filling.volume(), k))
            pieces[number] -= filling
        return pieces

    def areas(self, body: Any) -> np.ndarray:
        """(parts,) the area of each part on a body's surface."""
        mesh = body.to_mesh64()
        ids = np.asarray(mesh.face_id)
        area = np.linalg.norm(doubled_area_vectors(np.asarray(mesh.vert_properties)[:, :3][np.asarray(mesh.tri_verts)]), axis=1)
        is_source = ids < self.triangle_count
        return np.bincount(self.labels[ids[is_source].astype(np.int64)], area[is_source] / 2,
                           minlength=self.labels.max() + 1)

    def sides(self, body: Any, number: int) -> Tuple[bool, bool]:
        """(whether the body has caps of a cut that face along the plane's normal, whether against it)"""
        mesh = body.to_mesh64()
        caps = np.asarray(mesh.tri_verts)[np.asarray(mesh.face_id) == self.triangle_count + number]
        along = doubled_area_vectors(np.asarray(mesh.vert_properties)[:, :3][caps]) @ self.planes[number].axes[2]
        return bool((along > KERF).any()), bool((along < -KERF).any())

    # ---- Along borders

    def cut_off(self, body: Any, part: int, others: Sequence[int]) -> Optional[Tuple[List[Any], Any]]:
        """Cut a part off a body.

        Parameters
        ----------
        others : the other parts that the body still has

        Returns
        -------
        (components of the part, the rest); None if no planes do that
        """
        loops = self._loops(part, others)
        main = [loop for loop in loops if _length(loop) >= MIN_LOOP_RATIO * max(map(_length, loops))]
        for chosen in [main] + [loops] * (len(main) < len(loops)):
            ranked = [self._ranked_plates(body, loop) for loop in chosen]
            if not all(ranked):
                continue
            for attempt in range(min(MAX_ATTEMPTS, max(map(len, ranked)))):
                result = self._cut_by_plates(body, [plates[min(attempt, len(plates) - 1)] for plates in ranked], part, others)
                if result:
                    return result
        return None

    def merge(self, part: int, other: int) -> None:
        """Count a part as another one from now on."""
        self.labels[self.labels == part] = other

    def _loops(self, part: int, others: Sequence[int]) -> List[np.ndarray]:
        """The connected components of the part's border, (n, 2, 3) each, wound around the part."""
        labels = self.labels[self.border_triangles]
        is_own = labels == part
        edges = np.where(is_own[:, :1], self.border_vertices, self.border_vertices[:, ::-1])
        is_used = is_own.any(axis=1) & ~is_own.all(axis=1)
        with_others = is_used & np.isin(labels, others).any(axis=1)
        if not with_others.any():
            return []
        component = components(len(self.vertices), edges[is_used])[edges[:, 0]]
        loops = []
        for number in np.unique(component[with_others]):
            loop = self.vertices[edges[with_others & (component == number)]]
            spread = np.linalg.svd(loop.mean(axis=1) - loop.mean(axis=(0, 1)), compute_uv=False)
            if len(spread) < 2 or spread[1] < MIN_OPEN_SPREAD * spread[0]:
                loop = self.vertices[edges[is_used & (component == number)]]
            loops.append(loop)
        return loops

    def _ranked_plates(self, body: Any, loop: np.ndarray) -> List[Tuple[Plane, Any]]:
        """(plane, plate in the model's frame) of the planes that suit a border, best first."""
        middles, lengths = loop.mean(axis=1), np.linalg.norm(loop[:, 1] - loop[:, 0], axis=1) + 1e-12
        center = np.average(middles, axis=0, weights=lengths)
        radius = np.average(np.linalg.norm(middles - center, axis=1), weights=lengths)
        around = np.cross(loop[:, 1] - center, loop[:, 0] - center).sum(axis=0)  # out of the part
        flat = np.linalg.svd((middles - center) * np.sqrt(lengths)[:, None])[2][2]
        flat = flat * (1 if flat @ around >= 0 else -1)
        bases = [flat]
        if np.linalg.norm(around) > 1e-3 * radius * lengths.sum():
            around /= np.linalg.norm(around)
            bases += [around, flat + around]
        planes = []
        for base, tilt, turn, offset in product(bases, TILTS, np.arange(4) * np.pi / 2, OFFSETS):
            if (tilt == 0 and turn > 0) or (tilt and (base is not bases[-1] or abs(offset) > 0.2)):
                continue
            frame = Plane.create(center, base).axes
            normal = np.cos(tilt) * frame[2] + np.sin(tilt) * (np.cos(turn) * frame[0] + np.sin(turn) * frame[1])
            planes.append(Plane.create(center + offset * radius * normal, normal))
        sample = middles[np.linspace(0, len(middles) - 1, min(len(middles), 100)).astype(int)]
        scored = []
        for number, plane in enumerate(planes):
            regions = plane.section(body).decompose()
            local = plane.to_local(sample)
            if not regions:
                continue
            distances = np.array([_distances(local[:, :2], region) for region in regions])
            share = np.bincount(distances.argmin(axis=0), minlength=len(regions)) / len(sample)
            chosen = [region for region, of_region in zip(regions, share) if of_region >= MIN_REGION_SHARE]
            rest = [region for region, of_region in zip(regions, share) if of_region < MIN_REGION_SHARE]
            area = sum(region.area() for region in chosen)
            if not area:
                continue
            width = 0.1 * np.sqrt(area)
            thin = 1 - sum(region.offset(-width).offset(width).area() for region in chosen) / area
            score = (np.hypot(distances.min(axis=0), local[:, 2]).mean() / radius + THIN_WEIGHT * max(thin, 0)
                     + SECTION_WEIGHT * np.sqrt(area / np.pi) / radius)
            scored.append((score, number, plane, chosen, rest))
        plates = []
        for _, _, plane, chosen, rest in sorted(scored, key=lambda item: item[:2])[:MAX_ATTEMPTS]:
            if plate := self._plate(chosen, rest, radius):
                plates.append((plane, plate))
        return plates

    def _plate(self, regions: Sequence[Any], rest: Sequence[Any], radius: float) -> Optional[Any]:
        """A plate over regions of a section that does not reach the rest of it; None if they are too close."""
        section = self.manifold.CrossSection
        inside, outside = section.compose(list(regions)), section.compose(list(rest)) if rest else None
        for margin in MARGINS:
            plate = inside.offset(margin * radius, self.manifold.JoinType.Square)
            if outside is None or (plate.offset(margin * radius) ^ outside).is_empty():
                return self.manifold.Manifold.extrude(plate, KERF).translate((0, 0, -KERF / 2))
        return None

    def _cut_by_plates(self, body: Any, plates: Sequence[Tuple[Plane, Any]], part: int,
                       others: Sequence[int]) -> Optional[Tuple[List[Any], Any]]:
        first = len(self.planes)
        own: List[Any] = []
        rest: List[Any] = []
        wrong, total = 0.0, np.zeros(2)
        for piece in self.components(self._subtract(body, plates)):
            areas = self.areas(piece)
            both = np.array([areas[part], areas[list(others)].sum()])
            total += both
            wrong += both.min()
            (own if both[0] > both[1] else rest).append(piece)
        if len(rest) == 1 and 1 <= len(own) <= len(plates) and wrong <= MAX_WRONG_AREA * total.min():
            return own, rest[0]
        del self.planes[first:]
        return None

    def _subtract(self, body: Any, plates: Sequence[Tuple[Plane, Any]]) -> Any:
        """A body minus plates, whose planes are those of cuts from now on."""
        for plane, plate in plates:
            mesh = plane.to_model(plate).to_mesh64()
            number = self.triangle_count + len(self.planes)
            body -= self.make_body(mesh.vert_properties, mesh.tri_verts, np.full(len(mesh.tri_verts), number))
            self.planes.append(plane)
        return body

    # ---- Equal pieces

    def divide(self, body: Any, count: int) -> List[Any]:
        """Cut a body across its long axis into pieces of equal length, and more where a plane meets several limbs."""
        direction = _long_axis(body)
        along = _vertices(body) @ direction
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
            slivers = sum(piece.volume() < limit for piece in pieces)
            if best is None or slivers < best[0]:
                best = slivers, pieces, self.planes[first:]
            del self.planes[first:]
            if not slivers:
                break
        assert best is not None
        self.planes += best[2]
        return best[1]

    def fit_to_bed(self, body: Any, bed: np.ndarray) -> Iterator[Any]:
        """The pieces of a body that is cut until each fits the bed, as it stands or turned by right angles.

        Parameters
        ----------
        bed : (3,), ascending
        """
        if fits_bed(_vertices(body), bed):
            yield body
            return
        extents = np.sort(np.ptp(_vertices(body), axis=0))
        along = np.ptp(_vertices(body) @ _long_axis(body))
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


def fits_bed(vertices: np.ndarray, bed: np.ndarray) -> bool:
    """Whether a piece fits the bed (3,), ascending, as it stands or turned by right angles."""
    return bool((np.sort(np.ptp(vertices[:, :3], axis=0)) <= bed + 2 * KERF).all())


def _vertices(body: Any) -> np.ndarray:
    return np.asarray(body.to_mesh64().vert_properties)[:, :3]


def _long_axis(body: Any) -> np.ndarray:
    """(3,) the direction across which to cut a body: its own axis if it is long, otherwise the longest side of its box."""
    mesh = body.to_mesh64()
    corners = np.asarray(mesh.vert_properties)[:, :3][np.asarray(mesh.tri_verts)]
    weights = np.linalg.norm(doubled_area_vectors(corners), axis=1)
    middles = corners.mean(axis=1) - np.average(corners.mean(axis=1), axis=0, weights=weights)
    axes = np.linalg.svd((middles * np.sqrt(weights)[:, None]), full_matrices=False)[2]
    lengths = np.ptp(_vertices(body) @ axes.T, axis=0)
    boxed = np.ptp(_vertices(body), axis=0)
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
