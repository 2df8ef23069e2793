"""The demo's models: their sources, camera angles and mouse clicks."""

import sys
from typing import NamedTuple

MONKEY = "Blender's monkey"


class Click(NamedTuple):
    """A mouse click. at: (x from the left, y from the top), 0..1, in the model's bounding rectangle in the image."""

    name: str
    at: tuple


class Model(NamedTuple):
    """A model.

    source : MONKEY or a file in build/deps/meshes
    voxel : voxel size for Blender's voxel remesh, which makes any surface closed, in the file's unit; 0: no remesh
    up : the axis that points up in the file
    azimuth, elevation : of the camera, in degrees; 0, 0 is Blender's front view
    clicks : the mouse clicks
    parts : increasing numbers of convex parts into which to cut the dendrogram
    compared_parts : number of parts for the comparison of fill methods; 0: no comparison
    main : included also without --all
    """

    name: str
    source: str
    voxel: float
    up: str
    azimuth: float
    elevation: float
    clicks: tuple
    parts: tuple = (8, 24, 96)
    compared_parts: int = 0
    main: bool = False


MODELS = (
    Model("man", "man.off", 0, "Z", 20, 6,
          (Click("finger tip", (0.05, 0.554)), Click("toe", (0.929, 0.982)))),
    Model("man-remeshed", "man.off", 0.004, "Z", 20, 6,
          (Click("finger tip", (0.05, 0.554)), Click("toe", (0.929, 0.982)))),
    Model("armadillo", "armadillo.off", 0, "Y", 165, 6,
          (Click("finger tip", (0.125, 0.071)), Click("claw", (0.715, 0.929))), compared_parts=12, main=True),
    Model("hand", "hand.off", 0, "Z", -20, 8,
          (Click("thumb", (0.798, 0.321)), Click("finger", (0.381, 0.143))), main=True),
    Model("dino", "dino.off", 0, "Z", 55, 6,
          (Click("nose", (0.024, 0.071)), Click("toe", (0.369, 0.911)))),
    Model("elephant", "elephant.off", 0, "Y", 18, 6,
          (Click("trunk", (0.679, 0.053)), Click("foot", (0.94, 0.786)))),
    Model("suzanne", MONKEY, 0, "Z", 25, 6,
          (Click("ear", (0.952, 0.321)),)),
)

if __name__ == "__main__":
    print(*(model.name for model in MODELS if model.main or "--all" in sys.argv))
