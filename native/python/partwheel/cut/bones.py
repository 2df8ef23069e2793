# SPDX-License-Identifier: GPL-3.0-or-later
"""Bones for the parts of a cut: where each begins and ends."""

from typing import List, NamedTuple, Sequence, Tuple

import numpy as np
from numpy.typing import ArrayLike

from ..deform import surface_distances
from ..triangles import second_moments, triangle_areas
from ..weld import weld_surface
from .borders import ParentLink, PartBorder, VertexWeights, parents_first

TIP_FRACTION = 0.9  # of the distance to a part's farthest point: what lies beyond is its tip
MIN_END_FRACTION = 0.5  # a border ends a bone if its distance / the part's depth and its radius / the largest radius reach this
MIN_LENGTH = 1e-3  # of a bone, in diagonals of the model's bounding box
# A root's bone is projected to a mirror plane within this distance, in lengths of the bone, and sine of the angle.
MAX_PLANE_DISTANCE, MAX_PLANE_SINE = 0.1, 0.5
MAX_OFFSET = 0.5  # largest distance of a hinge from the border's center, in its radii: with several loops it may be far off
MIN_VECTOR_AREA = 1e-3  # in squared radii of the border: below it the hinge is undetermined, and the center is used


class Bone(NamedTuple):
    """The bone of a part.

    head, tail : (3,)
    parent : the part whose bone is the parent; -1 for the root
    is_connected : whether the bone begins where its parent ends
    """

    head: np.ndarray
    tail: np.ndarray
    parent: int
    is_connected: bool


def bones(vertices: ArrayLike, triangles: np.ndarray, labels: np.ndarray, links: Sequence[ParentLink],
          weights: Sequence[VertexWeights], planes: Sequence[Tuple[np.ndarray, float]] = ()) -> List[Bone]:
    """The bones of the parts of a surface.

    A bone begins at the hinge in the part's border with its parent; that of a loose piece at the piece's center. It ends
    at the center of the borders with those children that end the part together (for a hand, the fingers), or else at the
    farthest point of the part. The root's bone spans the part along its longest axis, upward or in the positive direction
    of the dominant axis; if the root has a single child, it ends at the border with that.

    Parameters
    ----------
    vertices : (V, 3) float
    triangles : (T, 3) int, indices into vertices
    labels : (T,) the part of each triangle
    links : the tree of the parts, see part_tree()
    weights : that the surface bends with, see skin_weights()
    planes : mirror_planes() of the model; a root's bone that nearly lies in one is projected to it

    Returns
    -------
    the Bone of each part
    """
    vertices = np.asarray(vertices, np.float64)
    links = _center_borders_at_hinges(vertices, triangles, links, weights)
    _, triangles = weld_surface(vertices, triangles)
    low, high = (bound(vertices[triangles], axis=(0, 1)) for bound in (np.min, np.max))
    min_length = MIN_LENGTH * np.linalg.norm(high - low)
    surfaces = [_PartSurface(vertices, triangles[labels == part]) for part in range(len(links))]
    ends = []
    for part, (surface, link) in enumerate(zip(surfaces, links)):
        child_borders = [child.border for child in links if child.parent == part and child.border]
        if link.border:
            head, tail = link.border.center, surface.bone_end(link.border, child_borders)
        elif link.parent >= 0:
            head, tail = surface.center, surface.extreme(surface.center, surface.center - surfaces[link.parent].center)
        elif len(child_borders) == 1:
            head, tail = surface.bone_end(child_borders[0], []), child_borders[0].center
        else:
            head, tail = _project_to_plane(*surface.long_axis(), planes)
        length = np.linalg.norm(tail - head)
        if length < min_length:
            tail = head + ((tail - head) / length if length > 0 else np.array([0.0, 0.0, 1.0])) * min_length
        ends.append((head, tail))
    connected = [link.parent >= 0 and bool(np.linalg.norm(ends[link.parent][1] - head) < min_length)
                 for (head, _), link in zip(ends, links)]
    return [Bone(*head_tail, link.parent, is_connected) for head_tail, link, is_connected in zip(ends, links, connected)]


def _center_borders_at_hinges(vertices: np.ndarray, triangles: np.ndarray, links: Sequence[ParentLink],
                              weights: Sequence[VertexWeights]) -> List[ParentLink]:
    """The links, with borders whose centers are their hinges."""
    subtree_weights = np.zeros((len(links), len(vertices)))  # of each part with its descendants: they turn with it
    result = list(links)
    for part in parents_first(links)[::-1]:
        part_vertices, values = weights[part]
        subtree_weights[part, part_vertices] += values
        parent, border = links[part]
        if parent >= 0:
            subtree_weights[parent] += subtree_weights[part]
        if border:
            center = hinge(vertices, triangles, border, subtree_weights[part])
            result[part] = ParentLink(parent, border._replace(center=center))
    return result


def hinge(vertices: np.ndarray, triangles: np.ndarray, border: PartBorder, weight: np.ndarray) -> np.ndarray:
    """(3,) the center h of a joint's rotation that keeps the volume: for any axis exactly to first order in the angle, nearly
    so for large angles.

    If each vertex x turns by w(x), its weight from 0 to 1, times a small angle about an axis through h, the volume changes by
    the integral of grad w . (axis x (x - h)). This vanishes for all axes if h x G = M, with G the integral of grad w and M
    the integral of x x grad w. By Stokes, both are integrals along the level curves of w on the surface: G = 1/2 integral x x
    dl dw, M = -1/2 integral |x|^2 dl dw. So only triangles where w changes count, and holes elsewhere don't matter. The
    component of h along G is free; it is the border center's."""
    corner_weights = weight[triangles]
    is_changing = np.ptp(corner_weights, axis=1) > 0
    corners, corner_weights = vertices[triangles[is_changing]] - border.center, corner_weights[is_changing]
    opposite_edges = corners[:, [2, 0, 1]] - corners[:, [1, 2, 0]]
    line = (corner_weights[:, :, None] * opposite_edges).sum(axis=1) / 2  # integral of dl dw over each triangle
    mean_square = ((corners ** 2).sum(axis=(1, 2)) + (corners.sum(axis=1) ** 2).sum(axis=1)) / 12  # mean |x|^2
    area = np.cross(corners.mean(axis=1), line).sum(axis=0) / 2
    moment = -(mean_square[:, None] * line).sum(axis=0) / 2
    squared_area = area @ area
    if squared_area <= (MIN_VECTOR_AREA * border.radius ** 2) ** 2:
        return border.center
    offset = np.cross(area, moment) / squared_area
    return border.center + offset * min(1, MAX_OFFSET * border.radius / max(float(np.linalg.norm(offset)), 1e-300))


def _project_to_plane(head: np.ndarray, tail: np.ndarray,
                      planes: Sequence[Tuple[np.ndarray, float]]) -> Tuple[np.ndarray, np.ndarray]:
    """(head, tail), projected to the first plane that they are close to: a stump of a limb on the root would tilt its
    bone."""
    direction, center = tail - head, (head + tail) / 2
    length = np.linalg.norm(direction)
    for normal, offset in planes:
        if (abs(center @ normal - offset) <= MAX_PLANE_DISTANCE * length
                and abs(direction @ normal) <= MAX_PLANE_SINE * length):
            head, tail = (end - (end @ normal - offset) * normal for end in (head, tail))
            break
    return head, tail


class _PartSurface:
    """The surface of one part."""

    def __init__(self, vertices: np.ndarray, triangles: np.ndarray) -> None:
        old_vertices, self.triangles = np.unique(triangles, return_inverse=True)
        self.old_to_new = {vertex: number for number, vertex in enumerate(old_vertices.tolist())}
        self.vertices, self.triangles = vertices[old_vertices], self.triangles.reshape(-1, 3)
        self.corners = self.vertices[self.triangles]
        self.areas = triangle_areas(self.corners) + 1e-300
        self.center = np.average(self.corners.mean(axis=1), axis=0, weights=self.areas)

    def extreme(self, start: np.ndarray, direction: np.ndarray) -> np.ndarray:
        """The point on a ray where it leaves the part's extent in the ray's direction."""
        length = np.linalg.norm(direction)
        if length == 0:
            return start
        return start + direction / length * max(((self.vertices - start) @ direction).max() / length, 0)

    def bone_end(self, border: PartBorder, child_borders: Sequence[PartBorder]) -> np.ndarray:
        """Where a bone ends that begins at a border: at the child borders that end the part, or else at its tip."""
        distance = surface_distances(self.vertices, self.triangles, self._vertices_of(border))
        is_reached = np.isfinite(distance)
        if not is_reached.all():  # loose pieces: straight-line distance
            distance = np.where(is_reached, distance, np.linalg.norm(self.vertices - border.center, axis=1))
        far_borders = [child for child in child_borders
                       if distance[self._vertices_of(child)].mean() >= MIN_END_FRACTION * distance.max()]
        max_radius = max((child.radius for child in far_borders), default=0)
        wide = [child for child in far_borders if child.radius >= MIN_END_FRACTION * max_radius]
        if wide:
            return np.average([child.center for child in wide], axis=0, weights=[child.length for child in wide])
        triangle_distance = distance[self.triangles].mean(axis=1)
        tip = triangle_distance >= TIP_FRACTION * triangle_distance.max()
        tip_center = np.average(self.corners[tip].mean(axis=1), axis=0, weights=self.areas[tip])
        return self.extreme(border.center, tip_center - border.center)

    def long_axis(self) -> Tuple[np.ndarray, np.ndarray]:
        """(head, tail): the ends of the part along its first principal axis."""
        direction = np.linalg.eigh(second_moments(self.areas, self.corners - self.center))[1][:, -1]
        direction = direction * np.sign(direction[abs(direction).argmax()])
        return self.extreme(self.center, -direction), self.extreme(self.center, direction)

    def _vertices_of(self, border: PartBorder) -> List[int]:
        return [self.old_to_new[vertex] for vertex in border.vertices.tolist()]
