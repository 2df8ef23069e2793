"""The models that the GUI tier opens, and what their hierarchies say. No bpy: used inside and outside Blender."""
import numpy


def read_off(path):
    """Reads an OFF file of triangles: vertices (V,3) float64, triangles (T,3) int32."""
    lines = (line.split("#")[0] for line in path.read_text().splitlines())
    words = " ".join(lines).split()
    if words[0] != "OFF":
        raise ValueError(f"{path} does not start with OFF.")
    vertex_count, face_count = int(words[1]), int(words[2])
    end = 4 + 3 * vertex_count
    vertices = numpy.array(words[4:end], float).reshape(-1, 3)
    faces = numpy.array(words[end:end + 4 * face_count], numpy.int32).reshape(-1, 4)
    if (faces[:, 0] != 3).any():
        raise ValueError(f"{path} holds other polygons than triangles.")
    return vertices, numpy.ascontiguousarray(faces[:, 1:])


class Wheels:
    """The wheel stops of every face, from the file that run.py wrote (see prepare_models there)."""

    def __init__(self, path):
        with numpy.load(path) as data:
            self.vertices, self.triangles = data["vertices"], data["triangles"]
            self._order, self._first, self._last = data["order"], data["first"], data["last"]
            self._stops, self._offset, self._start = data["stops"], data["offset"], data["start"]

    def stops(self, face):
        """The parts that the wheel reaches from a face, growing (frozensets of faces), and the index of the first."""
        nodes = self._stops[self._offset[face]:self._offset[face + 1]]
        return [frozenset(self._order[self._first[n]:self._last[n]].tolist()) for n in nodes], int(self._start[face])
