# SPDX-License-Identifier: GPL-3.0-or-later
"""The hierarchies that came with meshes from files, until they are opened, or refused, at their first use."""

import numpy as np

from ..mesh import arrays
from ..mesh.kept import PerMesh, key
from ..view.background import Background
from . import stored

unopened = PerMesh()  # packed
newer = PerMesh()  # True: those that came with it are of a version after this one, which the user hasn't been told


def waits(mesh):
    """Whether one is there."""
    return key(mesh) in unopened or stored.PROPERTY in mesh


def carried(mesh):
    """What an appended or linked mesh has brought along, packed, or None; taken off it, if it can be changed."""
    packed = mesh.get(stored.PROPERTY)
    if packed is not None and not mesh.library:
        del mesh[stored.PROPERTY]
    return packed


class Opening:
    """The hierarchy, if any, that came with the mesh, being opened while the caller does other things."""

    def __init__(self, mesh):
        self.mesh, self.packed = mesh, unopened.pop(key(mesh), None) or carried(mesh)
        self._opened = None
        self._task = None if self.packed is None else Background(self._unpack)

    def _unpack(self, _stop):
        self._opened = stored.unpack(self.packed)

    def result(self, now):
        """(Fingerprint when it was built, Hierarchy), or None. now: the Fingerprint of the mesh."""
        if not self._task:
            return None
        try:
            self._task.finish()
            built, hierarchy = self._opened
            if built.topology != now.topology:
                raise stored.Refused("the mesh has changed since")
            corners = arrays.read(self.mesh.loops, "vertex_index", np.int32)
            if not stored.fits(hierarchy, arrays.read(self.mesh.vertices, "co", np.float32, 3),
                               arrays.polygon_sizes(self.mesh)[0], corners, built.positions != now.positions):
                raise stored.Refused("it is of another mesh")
            return self._opened
        except stored.Older:
            return None  # they are found anew, as any that aren't there
        except stored.Newer:
            newer[key(self.mesh)] = True
            return None
        except stored.Refused as reason:
            print(f"Partwheel: the parts saved with {self.mesh.name} are left aside, for {reason}.")
            return None
