"""The layers of one image of the demo, which Blender renders (studio.py) and paint.py combines."""

from typing import NamedTuple

import numpy

OVERSAMPLING = 2  # pixels of a layer per pixel of the final image, along each axis


class Layers(NamedTuple):
    """light: (h, w, 3) linear irradiance. gloss: (h, w, 3) specular light, added after coloring. shown: (h, w) int32 id
    of the polygon that each pixel shows, -1 for the backdrop."""

    light: numpy.ndarray
    gloss: numpy.ndarray
    shown: numpy.ndarray

    def save(self, path):
        numpy.savez(path, light=self.light.astype(numpy.float16), gloss=self.gloss.astype(numpy.float16),
                    shown=self.shown)


def load(path):
    with numpy.load(path) as file:
        return Layers(file["light"].astype(numpy.float32), file["gloss"].astype(numpy.float32), file["shown"])
