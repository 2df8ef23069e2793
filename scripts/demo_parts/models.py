"""The demo's models: their sources, camera angles and mouse clicks."""

import sys
from typing import NamedTuple

EXAMPLE = "partwheel.examples"


class Click(NamedTuple):
    """A mouse click. at: (x from the left, y from the top), 0..1, in the model's bounding rectangle in the image."""

    name: str
    at: tuple


class Model(NamedTuple):
    """A model.

    source : EXAMPLE, which makes a model of that name, or a file in build/deps/meshes, with z up
    azimuth, elevation : of the camera, in degrees; 0, 0 is Blender's front view
    clicks : the mouse clicks
    voxel : voxel size for Blender's voxel remesh, which makes any surface closed, in the file's unit; 0: no remesh
    convex : for the docs: increasing numbers of convex parts into which to cut the dendrogram
    compared_parts : for the docs: number of parts for the comparison of fill methods; 0: no comparison
    docs : only for the docs
    """

    name: str
    source: str
    azimuth: float
    elevation: float
    clicks: tuple
    voxel: float = 0
    convex: tuple = ()
    compared_parts: int = 0
    docs: bool = False


MODELS = (
    Model("figure", EXAMPLE, 20, 6, (Click("hand", (0.03, 0.45)), Click("foot", (0.55, 0.965))), convex=(8, 24, 96),
          compared_parts=12),
    Model("truck", EXAMPLE, 40, 12, (Click("wheel", (0.51, 0.847)), Click("crate", (0.747, 0.256))), convex=(6, 12, 24)),
    Model("man-remeshed", "man.off", 20, 6, (Click("fingertip", (0.05, 0.554)),), voxel=0.004, docs=True),
)

if __name__ == "__main__":
    print(*(model.name for model in MODELS if not model.docs or "--docs" in sys.argv))
