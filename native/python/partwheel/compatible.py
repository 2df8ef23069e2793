# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts that can take each other's place: how alike two are, and where one goes to stand in for the other. By numpy.

Kreavoy, Julius, Sheffer: Model composition from interchangeable components (2007) exchange parts of models that
correspond. Here the part to be replaced is known, and others are compared with it by what matters at the seam and
beyond: the borders where they were cut off, and the shape as seen from there, in the border's own size. One is brought
to the other's place by its border (middle, normal, radius), turned about the normal until it fits best (the principal
axes say which turns to try), and refined by the iterative closest point method, point to plane (Chen, Medioni 1992),
trimmed (Chetverikov et al. 2002), with the border held.
"""

import copy
from typing import NamedTuple

import numpy as np

from .deform import crossing, rotation_by
from .joint import groups

SAMPLES, COARSE = 800, 4  # points on the part that stays, and of how many one is looked at on the one that moves
CAP_SAMPLES = 300
KEPT = 0.7  # of the pairs of closest points, the nearest: the parts need not be alike everywhere
STEPS = 12  # of refinement at most
TURNS = 16  # about the normal that are tried
TILT = np.cos(np.radians(30))  # the borders' normals stay this near to each other
ALIKE = 0.3  # of the border's radius: surfaces that are farther apart after refining are not fitted to each other
BENEATH = 0.15  # of the radius: points of two caps this near to each other across the normal are compared
DEEPEST = 0.5  # radii that a part is sunk in at most to close gaps
CLOSED = 0.05  # of the area of caps that touch, what is seen along their normal: those with less enclose a hollow
SMALL_BORDER = 0.25  # of the largest one's radius: those below don't count
LEAST_SHARE, LARGEST_SHARE = 0.004, 0.7  # of the whole's area that a part offered has
CUT = 200  # parts, into which the whole is cut to find what the wheel stops at
ALIGNED = 16  # of the parts that are most alike by measure are fitted
SCORE_DIGITS = 9
SAME = 0.6  # overlap from which two nodes of one hierarchy are offered as one part


class Border(NamedTuple):
    """Where a part was cut off: caps that touch. normal (3,) out of the solid; middle (3,) and radius, of a disk of the
    same area, as seen along the normal: the rim's, however the caps between are creased (but for the middle's
    height)."""

    middle: np.ndarray
    normal: np.ndarray
    radius: float


class Fit(NamedTuple):
    """matrix (4,4): a similarity, from where a part is to another's place. distance: between the two surfaces then, the
    mean over both, relative to the size of the one that is replaced."""

    matrix: np.ndarray
    distance: float


class Match(NamedTuple):
    """key: of the part, as it was given. score: 1 for the same shape down to 0. matrix: as in Fit."""

    key: object
    score: float
    matrix: np.ndarray


def borders(vertices, triangles, matrix):
    """The Borders of caps, the largest first. vertices (n,3); triangles (T,3) of the caps, wound outwards; matrix (4,4)
    from there to where the borders are wanted. They are told apart by place: where caps only touch, a part may have two
    vertices and the rest one, or the other way round."""
    if not len(triangles):
        return []
    own = vertices[triangles]
    corners = moved(own, matrix)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2
    areas, middles = np.linalg.norm(normals, axis=1), corners.mean(axis=1)
    found = []
    if np.linalg.det(matrix[:3, :3]) < 0:
        normals = -normals
    for group in _groups(own):
        area, normal = areas[group].sum(), normals[group].sum(axis=0)
        length = np.linalg.norm(normal)
        if length > CLOSED * area:
            seen = normals[group] @ normal / length  # their sum is the same for all caps with this rim
            found.append(Border(seen @ middles[group] / length, normal / length, float(np.sqrt(length / np.pi))))
    return sorted(found, key=lambda each: -each.radius)


def _groups(corners):
    """Indices of triangles (T,3,3) in groups that share corners."""
    _, triangles = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    triangles = triangles.reshape(-1, 3)
    of = groups(triangles[:, [[0, 1], [1, 2]]].reshape(-1, 2))[::2]
    return [np.flatnonzero(of == group) for group in range(of.max() + 1)]


def moved(points, matrix):
    """Points (...,3) under a matrix (4,4)."""
    return points @ matrix[:3, :3].T + matrix[:3, 3]


class Shape:
    """A part's closed surface as it is compared with others."""

    def __init__(self, vertices, triangles, caps, matrix, size):
        """vertices (n,3), triangles (m,3) wound outwards, caps (m,) bool: which close it where it was cut; matrix (4,4)
        from there to where parts are compared; size there of the whole that it is a part of, say half the diagonal of
        its bounding box."""
        self.borders = borders(vertices, triangles[caps], matrix)
        if not self.borders:
            return
        self.main = self.borders[0]
        self.borders = [each for each in self.borders if each.radius >= SMALL_BORDER * self.main.radius]
        corners = moved(vertices, matrix)[triangles] - self.main.middle
        self.volume = abs(np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))) / 6
        cut = corners[caps]
        self.cap_points = spread_over(cut, np.linalg.norm(
            np.cross(cut[:, 1] - cut[:, 0], cut[:, 2] - cut[:, 0]), axis=1), CAP_SAMPLES)[0] + self.main.middle
        outer = corners[~caps]
        normals = np.cross(outer[:, 1] - outer[:, 0], outer[:, 2] - outer[:, 0])
        if np.linalg.det(matrix[:3, :3]) < 0:
            normals = -normals
        lengths = np.linalg.norm(normals, axis=1)
        self.area = lengths.sum() / 2
        if self.area > 0:
            self.points, chosen = spread_over(outer, lengths, SAMPLES)
            self.points += self.main.middle
            self.normals = normals[chosen] / lengths[chosen, None]
        self.share = self.main.radius / size
        self._features = None

    @property
    def usable(self):
        """Whether it has a border and a surface and can be compared."""
        return bool(self.borders) and self.area > 0

    def reflection(self):
        """(4,4) across a plane through the border's middle, along its normal."""
        across, middle = _frame(self)[0], self.main.middle
        flip = np.eye(4)
        flip[:3, :3] -= 2 * np.outer(across, across)
        flip[:3, 3] = middle - flip[:3, :3] @ middle
        return flip

    def reflected(self, flip):
        """The Shape under a reflection (4,4)."""
        turn, image = flip[:3, :3], copy.copy(self)
        image.points, image.cap_points = moved(self.points, flip), moved(self.cap_points, flip)
        image.normals = self.normals @ turn.T
        image.borders = [each._replace(middle=moved(each.middle, flip), normal=turn @ each.normal)
                         for each in self.borders]
        image.main = image.borders[0]
        return image

    def features(self):
        """(n,) weighted numbers that are the same for similar shapes (moved, turned, scaled): their distance says how
        unlike two parts are. Lengths are in radii of the border, as logarithms."""
        if self._features is None:
            radius = self.main.radius
            points = (self.points - self.main.middle) / radius
            height, middle = points @ self.main.normal, points.mean(axis=0)
            across = points - height[:, None] * self.main.normal
            axes = np.sqrt(np.maximum(np.linalg.eigvalsh(np.cov(points.T)), 1e-9))
            lateral = np.sqrt(np.maximum(np.linalg.eigvalsh(np.cov(across.T))[1:], 1e-9))
            towards = middle @ self.main.normal
            aside = np.linalg.norm(middle - towards * self.main.normal)
            # How thick it is near the border, half way, and near the far end; the same for a part that is nearly flat.
            along = (height.max() - height) / max(np.ptp(height), 0.1)
            thick = [np.average(np.linalg.norm(across - np.average(across, axis=0, weights=weight), axis=1),
                                weights=weight)
                     for weight in 1e-3 + np.maximum([1 - 2 * along, 1 - abs(2 * along - 1), 2 * along - 1], 0)]
            self._features = np.concatenate([
                [np.log(self.volume / radius ** 3) / 3, np.log(self.area / radius ** 2) / 2],
                np.log(axes), np.log(lateral), [np.log(max(height.std(), 1e-9))],
                [np.arcsinh(towards), np.arcsinh(aside)], 0.5 * np.log(np.maximum(thick, 1e-9)),
                [0.3 * np.log(self.share), 0.7 * (len(self.borders) - 1)]])
        return self._features


def spread_over(corners, weights, count):
    """((count,3) points evenly on triangles (T,3,3), (count,) which triangle each is on): always the same ones."""
    total = np.cumsum(weights)
    number = np.arange(count)
    chosen = np.minimum(np.searchsorted(total, (number + 0.5) / count * total[-1]), len(corners) - 1)
    # Of low discrepancy, by the powers of the plastic number; folded into the triangle.
    u, v = (0.5 + number * 0.7548776662466927) % 1, (0.5 + number * 0.5698402909980532) % 1
    beyond = u + v > 1
    u, v = np.where(beyond, 1 - u, u), np.where(beyond, 1 - v, v)
    a, b, c = corners[chosen].transpose(1, 0, 2)
    return a + u[:, None] * (b - a) + v[:, None] * (c - a), chosen


def unlikeness(one, other):
    """How far the features of two Shapes are from each other; 0 for the same shape."""
    return float(np.linalg.norm(one.features() - other.features()))


# ---- One part to the other's place


def fit(place, part, mirror=False):
    """The Fit that brings the Shape part to the Shape place: border onto border, of its size. mirror: the part's mirror
    image; the matrix then reflects."""
    if mirror:
        flip = part.reflection()
        found = fit(place, part.reflected(flip))
        return found._replace(matrix=found.matrix @ flip)
    scale = place.main.radius / part.main.radius
    frame, own = _frame(place), _frame(part)
    moving = ((part.points - part.main.middle) * scale) @ own.T  # in the border's frame, z along the normal
    staying = (place.points - place.main.middle) @ frame.T
    tries = []
    for angle in _turns(moving, staying, frame, own):
        turn = _about_z(angle)
        tries.append((_apart(moving[::2 * COARSE] @ turn.T, staying[::3]), angle))
    tries.sort()
    found = []
    for _, angle in tries[:2]:
        turn = frame.T @ _about_z(angle) @ own
        found.append(_refined(place, part, scale, turn))
        if found[-1].distance < 1e-6:
            break
    return min(found, key=lambda each: each.distance)


def gap(place, part, matrix):
    """How far the Shape part under a similarity (4,4) is to go along the border's normal until its caps leave no gap
    to what the Shape place was cut off from, in radii of the border. Caps that are flat, or alike, need 0."""
    frame, own = _frame(place), place.main
    theirs, ours = (((points - own.middle) / own.radius) @ frame.T
                    for points in (moved(part.cap_points, matrix), place.cap_points))
    apart = _distances(ours[:, :2], theirs[:, :2])
    nearest = apart.argmin(axis=1)
    beneath = apart[np.arange(len(ours)), nearest] < BENEATH ** 2
    if not beneath.any():
        return 0.0
    return float(np.clip(np.quantile((ours[:, 2] - theirs[nearest, 2])[beneath], 0.95), 0, DEEPEST))


def _frame(shape):
    """(3,3) rows: two directions across the border's normal, and the normal."""
    normal = shape.main.normal
    across = np.cross(normal, np.eye(3)[np.argmin(abs(normal))])
    across /= np.linalg.norm(across)
    return np.array([across, np.cross(normal, across), normal])


def _about_z(angle):
    sine, cosine = np.sin(angle), np.cos(angle)
    return np.array([[cosine, -sine, 0], [sine, cosine, 0], [0, 0, 1.0]])


def _turns(moving, staying, frame, own):
    """Angles about the normal to try: that bring the longer principal axes across the normal together, either way, and
    the middles to the same side; that leave the part as upright as it was; and all round."""
    def axis(points):
        return np.linalg.eigh(np.cov(points[:, :2].T))[1][:, 1]

    def angle(direction):
        return np.arctan2(direction[1], direction[0])

    by_axes = angle(axis(staying)) - angle(axis(moving))
    by_middles = angle(staying.mean(axis=0)) - angle(moving.mean(axis=0))
    upright = frame @ own.T  # what turns least is the rotation about z that is nearest to this
    upright = np.arctan2(upright[1, 0] - upright[0, 1], upright[0, 0] + upright[1, 1])
    return [by_axes, by_axes + np.pi, by_middles, upright, *(upright + np.arange(1, TURNS) * (2 * np.pi / TURNS))]


def _distances(moving, staying):
    """(n,m) squared; by one product of matrices. By rounding some may be a little below 0."""
    left = np.column_stack([-2 * moving, (moving ** 2).sum(axis=1), np.ones(len(moving))])
    right = np.column_stack([staying, np.ones(len(staying)), (staying ** 2).sum(axis=1)])
    return left.astype(np.float32) @ right.astype(np.float32).T


def _apart(moving, staying):
    """Mean distance of each point to the other surface's nearest, from both sides."""
    squared = _distances(moving, staying)
    return sum(np.sqrt(np.maximum(squared.min(axis=axis), 0)).mean() for axis in (0, 1)) / 2


def _refined(place, part, scale, turn):
    """The Fit after refining; as it is where the shapes differ too much, or would tilt too far. turn (3,3): from the
    part's directions to the place's."""
    radius, size = place.main.radius, np.sqrt(place.area)
    staying = (place.points - place.main.middle) / radius
    start = ((part.points - part.main.middle)[::COARSE] * (scale / radius)) @ turn.T
    ends = np.array([(each.middle - part.main.middle) * (scale / radius) for each in part.borders]) @ turn.T
    matrix, lever = np.eye(4), (start ** 2).sum(axis=1).mean()
    normal = turn @ part.main.normal
    points = start
    last = np.inf
    for _ in range(STEPS):
        squared = _distances(points, staying)
        nearest = squared.argmin(axis=1)
        least = np.maximum(squared[np.arange(len(points)), nearest], 0)
        kept = least <= np.partition(least, int(KEPT * (len(least) - 1)))[int(KEPT * (len(least) - 1))]
        error = least[kept].mean()
        if error > last * 0.999:
            break
        last = error
        step = _step(points[kept], staying[nearest[kept]], place.normals[nearest[kept]],
                     _held(place, matrix, ends, normal, lever))
        matrix = step @ matrix
        points = moved(start, matrix)
    tilted = (matrix[:3, :3] @ normal) @ place.main.normal < TILT or np.linalg.norm(matrix[:3, 3]) > 0.5
    if tilted or np.sqrt(last) > ALIKE * max(1.0, np.sqrt(lever) / 3):
        matrix = np.eye(4)
    turn = matrix[:3, :3] @ turn
    whole = np.eye(4)
    whole[:3, :3] = scale * turn
    whole[:3, 3] = place.main.middle + radius * matrix[:3, 3] - scale * turn @ part.main.middle
    points = (moved(part.points, whole) - place.main.middle) / radius
    return Fit(whole, float(_apart(points, staying) * radius / size))


def _held(place, matrix, ends, normal, lever):
    """What keeps borders together, as (points, their targets, weight) and (normal, its target, weight)."""
    targets = np.array([(each.middle - place.main.middle) / place.main.radius for each in place.borders])
    ends = moved(ends, matrix)
    nearest = np.linalg.norm(ends[:, None] - targets, axis=2).argmin(axis=1)
    nearest[0] = 0
    near = np.linalg.norm(ends - targets[nearest], axis=1) < 1
    near[0] = True
    return (ends[near], targets[nearest[near]], 4.0), (matrix[:3, :3] @ normal, place.main.normal, lever)


def _step(points, onto, normals, held):
    """(4,4) the small rigid motion that brings points nearest to the planes through onto, with what is held, by least
    squares on rotations taken for small."""
    (ends, targets, end_weight), (normal, wanted, normal_weight) = held
    share = 1 / np.sqrt(len(points))
    rows = [np.hstack([np.cross(points, normals), normals]) * share]
    sides = [np.einsum("ij,ij->i", normals, onto - points) * share]
    for end, target in zip(ends, targets):
        rows.append(np.sqrt(end_weight) * np.hstack([-crossing(end), np.eye(3)]))
        sides.append(np.sqrt(end_weight) * (target - end))
    rows.append(np.sqrt(normal_weight) * np.hstack([-crossing(normal), np.zeros((3, 3))]))
    sides.append(np.sqrt(normal_weight) * (wanted - normal))
    solution = np.linalg.lstsq(np.vstack(rows), np.concatenate(sides), rcond=None)[0]
    motion = np.eye(4)
    motion[:3, :3] = rotation_by(solution[:3])
    motion[:3, 3] = solution[3:]
    return motion


# ---- Among many


def ranked(place, parts, same=lambda one, other: False):
    """Matches, the most compatible first. place: a Shape; parts: (key, Shape) pairs, of which only the most alike by
    measure are fitted and returned; same(key, key): whether two are nearly one part, of which the better is enough."""
    near = sorted(((unlikeness(place, shape), number) for number, (_, shape) in enumerate(parts) if shape.usable))
    found = []
    for unlike, number in near:
        key, shape = parts[number]
        if any(same(match.key, key) for match in found):
            continue
        fitted = fit(place, shape)
        # Products of matrices differ in their last bits with where these lie in memory: that is no part of a score.
        score = round(float(np.exp(-(0.5 * unlike + 4 * fitted.distance))), SCORE_DIGITS)
        found.append(Match(key, score, fitted.matrix))
        if len(found) == ALIGNED:
            break
    return sorted(found, key=lambda each: -each.score)


def parts_offered(hierarchy):
    """Nodes that are worth offering: where the wheel stops, neither specks nor nearly the whole."""
    bounds = hierarchy.cut_parts(min(CUT, len(hierarchy.tetrahedra)))
    labels = hierarchy.face_labels(bounds)
    examples = np.unique(labels, return_index=True)[1].tolist()
    stops = {stop for face in examples for stop in hierarchy.wheel(face)[0].tolist()}
    share = hierarchy.area / hierarchy.area[-1]
    return sorted(stop for stop in stops if LEAST_SHARE <= share[stop] <= LARGEST_SHARE)


def overlap(hierarchy, one, other):
    """Of two nodes: the area they have in common by that which they have together."""
    if hierarchy.tet_first[one] > hierarchy.tet_first[other] or hierarchy.tet_last[one] < hierarchy.tet_last[other]:
        one, other = other, one
    if hierarchy.tet_first[one] > hierarchy.tet_first[other] or hierarchy.tet_last[one] < hierarchy.tet_last[other]:
        return 0.0
    return float(hierarchy.area[other] / hierarchy.area[one])


def shape(hierarchy, node, positions, matrix, size, faces=None):
    """The Shape of a node, or None if it has nothing left where polygons are cut. positions (V,3) of the hierarchy's
    vertices; matrix (4,4) from there to where parts are compared; size: as in Shape. faces (F,) bool: those that it has
    in place of its own, see solid_of_faces()."""
    ends = int(hierarchy.tet_first[node]), int(hierarchy.tet_last[node])
    solid = hierarchy.solids([ends])[0] if faces is None else hierarchy.solid_of_faces(*ends, faces)
    if solid is None:
        return None
    return Shape(positions[solid.ends].mean(axis=1), solid.triangles, solid.beyond >= 0, matrix, size)
