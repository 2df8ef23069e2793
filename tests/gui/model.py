"""The models that the GUI tier opens, and what their hierarchies say. No bpy: used inside and outside Blender."""
import numpy


def read_off(path):
    """Reads an OFF file of triangles: vertices (V,3) float64, triangles (T,3) int32."""
    lines = (line.split("#")[0] for line in path.read_text().splitlines())
    words = " ".join(lines).split()
    if words[0] not in {"OFF", "COFF"}:
        raise ValueError(f"{path} does not start with OFF.")
    width = 3 if words[0] == "OFF" else 7  # COFF: each vertex has a color too
    vertex_count, face_count = int(words[1]), int(words[2])
    end = 4 + width * vertex_count
    vertices = numpy.array(words[4:end], float).reshape(-1, width)[:, :3].copy()
    faces = numpy.array(words[end:end + 4 * face_count], numpy.int32).reshape(-1, 4)
    if (faces[:, 0] != 3).any():
        raise ValueError(f"{path} holds other polygons than triangles.")
    return vertices, numpy.ascontiguousarray(faces[:, 1:])


def subdivided(vertices, triangles):
    """Each triangle cut into four at the middles of its sides."""
    sides = numpy.sort(numpy.vstack([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]))
    sides, middle = numpy.unique(sides, axis=0, return_inverse=True)
    (a, b, c), (ab, bc, ca) = triangles.T, len(vertices) + middle.reshape(3, -1)
    corners = [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
    return (numpy.vstack([vertices, vertices[sides].mean(axis=1)]),
            numpy.vstack([numpy.column_stack(three) for three in corners]).astype(numpy.int32))


def small_shells(columns=100, rows=50):
    """A cloth of double pyramids that touch: 5,000 shells of ten triangles."""
    turn = 2 * numpy.pi / 5 * numpy.arange(5)
    rim = numpy.column_stack([numpy.cos(turn), numpy.sin(turn), numpy.zeros(5)])
    sides = [(k, (k + 1) % 5) for k in range(5)]
    one = numpy.array([(a, b, 5) for a, b in sides] + [(b, a, 6) for a, b in sides], numpy.int32)
    places = numpy.array([(x, y, 0) for y in range(rows) for x in range(columns)])
    vertices = 0.6 * numpy.vstack([rim, [(0, 0, 0.5), (0, 0, -0.5)]]) + places[:, None]
    return vertices.reshape(-1, 3), (one + 7 * numpy.arange(len(places), dtype=numpy.int32)[:, None, None]).reshape(-1, 3)


class Wheels:
    """The wheel stops of every face, from the file that run.py wrote (see prepare_models there)."""

    def __init__(self, path):
        with numpy.load(path) as data:
            self.vertices, self.triangles = data["vertices"], data["triangles"]
            if "stops" in data:
                self._order, self._first, self._last = data["order"], data["first"], data["last"]
                self._stops, self._offset, self._start = data["stops"], data["offset"], data["start"]

    def stops(self, face):
        """The parts that the wheel reaches from a face, growing (frozensets of faces), and the index of the first."""
        nodes = self._stops[self._offset[face]:self._offset[face + 1]]
        return [frozenset(self._order[self._first[n]:self._last[n]].tolist()) for n in nodes], int(self._start[face])
