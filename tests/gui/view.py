"""Where things are in the 3D viewport: from 3D to window pixels, and which face a pixel shows.

Plain projection with numpy, on purpose nothing that an add-on would pick with: the tests compare with it.
"""
import functools

import bpy
import numpy


class View:
    """A 3D viewport and a mesh object in it. Built anew after every change of the view: nothing is kept up to date.

    quarter: in the quad view the number of the quarter, 0 bottom left (front), 1 top left (top), 2 bottom right
    (right), 3 top right (the user's own view).
    """

    def __init__(self, area, object, vertices, triangles, quarter=None):
        windows = [region for region in area.regions if region.type == "WINDOW"]
        self.region = windows[quarter or 0]
        space = area.spaces.active
        view = space.region_3d if quarter is None else space.region_quadviews[quarter]
        matrix = view.perspective_matrix @ object.matrix_world
        points = numpy.c_[vertices, numpy.ones(len(vertices))] @ numpy.array(matrix).T
        size = numpy.array([self.region.width, self.region.height])
        self._pixels = (points[:, :2] / points[:, 3:] + 1) / 2 * size + [self.region.x, self.region.y]
        self._depths = points[:, 2] / points[:, 3]
        self._triangles = triangles
        # The planes of the clipping region, in the object's own space: a point p is shown where p1 . planes >= 0.
        self._vertices = vertices
        self._planes = numpy.zeros((4, 0))
        if view.use_clip_planes:
            self._planes = (numpy.array([list(plane) for plane in view.clip_planes])[:4]
                            @ numpy.array(object.matrix_world)).T

    def centers(self):
        """(T,2) window pixels of the triangles' centers."""
        return self._pixels[self._triangles].mean(axis=1)

    @functools.cached_property
    def _reach(self):
        """The pixels between which each triangle lies: left, right, below, above (T,)."""
        corners = self._pixels[self._triangles]
        low, high = corners.min(axis=1), corners.max(axis=1)
        return [numpy.ascontiguousarray(column) for column in (low[:, 0], high[:, 0], low[:, 1], high[:, 1])]

    def face_at(self, x, y):
        """The triangle that window position x, y shows: of those that lie under it, the nearest that is not clipped, or
        None. (With perspective the place where one is clipped is not quite exact.)"""
        left, right, below, above = self._reach
        near = numpy.flatnonzero((left <= x) & (x <= right) & (below <= y) & (y <= above))
        a, b, c = (self._pixels[self._triangles[near, k]] - [x, y] for k in range(3))
        weights = numpy.c_[_cross(b, c), _cross(c, a), _cross(a, b)]
        hit = ((weights >= 0).all(axis=1) | (weights <= 0).all(axis=1)) & (weights.sum(axis=1) != 0)
        hits, weights = near[hit], weights[hit]
        if not len(hits):
            return None
        shares = weights / weights.sum(axis=1, keepdims=True)
        places = numpy.einsum("hk,hkc->hc", shares, self._vertices[self._triangles[hits]])
        is_visible = (numpy.c_[places, numpy.ones(len(places))] @ self._planes >= 0).all(axis=1)
        hits, shares = hits[is_visible], shares[is_visible]
        if not len(hits):
            return None
        return int(hits[(shares * self._depths[self._triangles[hits]]).sum(axis=1).argmin()])

    def face_around(self, x, y, margin=1):
        """face_at(x, y) if everything within margin pixels shows the same face, so that rounding can't matter."""
        faces = {self.face_at(x + dx, y + dy) for dx in (-margin, 0, margin) for dy in (-margin, 0, margin)}
        return faces.pop() if len(faces) == 1 else None

    def spot(self, x, y, is_wanted=lambda face: True):
        """The pixel nearest to x, y with one face, which must be wanted, and no other around it: (x, y, face)."""
        centers = self.centers()
        for center in centers[((centers - [x, y]) ** 2).sum(axis=1).argsort()]:
            px, py = (int(v) for v in center.round())
            face = self.face_around(px, py)
            if face is not None and is_wanted(face):
                return px, py, face
        raise AssertionError("No such face of the model is large enough on the screen to be clicked safely.")

    def visible_centers(self, faces):
        """(n,2) window pixels of the centers of those of the faces that can be seen there."""
        centers = self.centers()
        return numpy.array([centers[face] for face in faces if self.face_at(*centers[face]) == face]).reshape(-1, 2)


def _cross(a, b):
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]


def picture(path):
    """A picture file as (height, width, 4) values 0..1, origin bottom left as in the window."""
    image = bpy.data.images.load(str(path))
    try:
        pixels = numpy.empty(len(image.pixels), numpy.float32)
        image.pixels.foreach_get(pixels)
        return pixels.reshape(image.size[1], image.size[0], 4)
    finally:
        bpy.data.images.remove(image)
