"""The layers of one picture of the demo, on their way from Blender (studio.py) to the painter (paint.py)."""

from typing import NamedTuple

import numpy

OVERSAMPLING = 2  # layers have this many pixels a side for each pixel of the finished picture


class Layers(NamedTuple):
    """light: (h, w, 3) linear light that falls on what each pixel shows.  gloss: (h, w, 3) light to add after
    painting.  shown: (h, w) int32 number of the polygon that each pixel shows, -1 for the backdrop."""

    light: numpy.ndarray
    gloss: numpy.ndarray
    shown: numpy.ndarray

    def save(self, path):
        numpy.savez(path, light=self.light.astype(numpy.float16), gloss=self.gloss.astype(numpy.float16),
                    shown=self.shown)


def load(path):
    with numpy.load(path) as file:
        return Layers(file["light"].astype(numpy.float32), file["gloss"].astype(numpy.float32), file["shown"])
