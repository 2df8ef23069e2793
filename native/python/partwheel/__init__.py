# SPDX-License-Identifier: GPL-3.0-or-later
"""The Python package of the native library: numpy arrays in, a Hierarchy out. It does not depend on Blender."""

from .border import Creases
from .deform import Deformation, surface_distances
from .duplicates import duplicate_faces, duplicates_within_shells
from .fair import fair_vertices
from .hierarchy import ConvexPart, Hierarchy, Solid, Summary
from .index import Index
from .library import Context, Error, FillMethod, LibraryError, Mode, PartwheelError, Stage, Status, version
from .marks import Marks
from .polygons import Faults, polygon_faults
from .rays import RayTarget

__all__ = ["Context", "ConvexPart", "Creases", "Deformation", "Error", "Faults", "FillMethod", "Hierarchy", "Index",
           "LibraryError", "Marks", "Mode", "PartwheelError", "RayTarget", "Solid", "Stage", "Status", "Summary",
           "duplicate_faces", "duplicates_within_shells", "fair_vertices", "polygon_faults", "surface_distances", "version"]
