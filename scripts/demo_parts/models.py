"""The demo's models: where they come from, how they stand before the camera, and where the mouse clicks."""

import sys
from typing import NamedTuple

MONKEY = "Blender's monkey"


class Click(NamedTuple):
    """A click with the mouse. at: where in the rectangle that the model fills, seen from the camera: from the left and
    from the top, 0..1."""

    name: str
    at: tuple


class Model(NamedTuple):
    """source: MONKEY or a file in build/deps/meshes.  voxel: the size for Blender's voxel remesh, which makes a closed
    surface of any, in the file's unit; 0 leaves the surface as it is.  up: the axis that points up in the file.
    azimuth, elevation: where the camera stands, degrees; 0, 0 is Blender's front view.  parts: the numbers of convex
    parts to cut the dendrogram into, growing.  ways: the number of parts to compare the ways of building by; 0 does not.
    A model without clicks is a sheet, there to be refused.  main: shown also when not all are asked for."""

    name: str
    source: str
    voxel: float
    up: str
    azimuth: float
    elevation: float
    clicks: tuple
    parts: tuple = (8, 24, 96)
    ways: int = 0
    main: bool = False


MODELS = (
    Model("man", "man.off", 0, "Z", 20, 6,
          (Click("finger tip", (0.05, 0.554)), Click("toe", (0.929, 0.982)))),
    Model("man-remeshed", "man.off", 0.004, "Z", 20, 6,
          (Click("finger tip", (0.05, 0.554)), Click("toe", (0.929, 0.982)))),
    Model("armadillo", "armadillo.off", 0, "Y", 165, 6,
          (Click("finger tip", (0.125, 0.071)), Click("claw", (0.715, 0.929))), ways=12, main=True),
    Model("hand", "hand.off", 0, "Z", -20, 8,
          (Click("thumb", (0.798, 0.321)), Click("finger", (0.381, 0.143))), main=True),
    Model("dino", "dino.off", 0, "Z", 55, 6,
          (Click("nose", (0.024, 0.071)), Click("toe", (0.369, 0.911)))),
    Model("elephant", "elephant.off", 0, "Y", 18, 6,
          (Click("trunk", (0.679, 0.053)), Click("foot", (0.94, 0.786)))),
    Model("suzanne", MONKEY, 0, "Z", 25, 6,
          (Click("ear", (0.952, 0.321)),)),
    Model("landscape", "horizons.off", 0, "Y", 25, 30, ()),
)

if __name__ == "__main__":
    print(*(model.name for model in MODELS if model.main or "--all" in sys.argv))
