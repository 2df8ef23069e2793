"""The demo's models: their sources, view directions and mouse clicks."""

import sys
from typing import NamedTuple

EXAMPLE = "partwheel.examples"


class Model(NamedTuple):
    """A model of the demo, or of the pictures that only the docs show."""

    name: str
    source: str  # EXAMPLE: the function of partwheel.examples with this name; or a file in build/deps/meshes, with z up
    view: tuple  # the direction from which it is seen
    clicks: dict  # name -> the point on the model that is clicked, in its coordinates
    voxel: float = 0  # voxel size for Blender's voxel remesh, which makes any surface closed, in the file's unit; 0: no remesh
    convex: tuple = ()  # for the docs: increasing numbers of convex parts into which to cut the dendrogram
    compared_parts: int = 0  # for the docs: number of parts for the comparison of fill methods; 0: no comparison
    docs: bool = False  # whether only the docs show it


MODELS = {model.name: model for model in (
    Model("figure", EXAMPLE, (0.34, -0.93, 0.1), {"hand": (-0.84, -0.124, 0.987), "foot": (0.193, -0.196, 0.066)},
          convex=(8, 24, 96), compared_parts=12),
    Model("truck", EXAMPLE, (0.64, -0.77, 0.21), {"wheel": (0.52, -0.8, 0.24), "crate": (0.37, 0.45, 0.85)},
          convex=(6, 12, 24)),
    Model("man-remeshed", "man.off", (0.34, -0.93, 0.1), {"fingertip": (-0.191, 0.022, -0.07)}, voxel=0.004, docs=True),
)}

if __name__ == "__main__":
    print(*(model.name for model in MODELS.values() if not model.docs or "--docs" in sys.argv))
