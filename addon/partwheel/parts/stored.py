# SPDX-License-Identifier: GPL-3.0-or-later
"""A hierarchy as a property of its mesh in a .blend file: packed into bytes, and validated when it is loaded.

The bytes are a custom property of the mesh only while a file is written or has just been read. Otherwise every undo
step, and every copy of the mesh that Blender makes for drawing, would copy them, too. After reading, they are held
until their first use, in MeshState.stored."""

import hashlib
import struct

import bpy
import numpy as np

from partwheel import Hierarchy, PartwheelError
from partwheel.library import saved_format
from ..mesh import Fingerprint, MeshState, arrays, start_thread

PROPERTY = "partwheel"
MAGIC = b"PWPARTS\0"
# Magic, format of the saved hierarchy, fingerprint, hash of these. The saved hierarchy follows, with its own hash. It is not
# compressed: zlib would save a sixth of the size and double the loading time.
HEADER = struct.Struct("<8sI16s16s")
HASH_SIZE = 16
SPACING = 0.01  # of the points at which the deviation was measured, as a fraction of the diagonal


class UnsoundData(Exception):
    """Bytes that are not a hierarchy of this mesh. str() completes the sentence "..., because"."""


class OlderVersion(UnsoundData):
    """Bytes of an earlier version, which can't be read any more."""


class NewerVersion(UnsoundData):
    """Bytes of a later version."""


def pack(fingerprint: Fingerprint, hierarchy: Hierarchy) -> bytes:
    header = HEADER.pack(MAGIC, saved_format(), *fingerprint)
    return b"".join([header, _hash(header), hierarchy.save()])


def matches_mesh(hierarchy: Hierarchy, positions: np.ndarray, begin: np.ndarray, corners: np.ndarray,
                 moved: bool) -> bool:
    """Return whether a hierarchy can belong to a mesh: each vertex it names exists, each face lies at its tetrahedron.
    The hashes in the header can't tell this if the file was tampered with. positions (V, 3), first corner of each
    polygon (F,) and vertex of each corner (L,) of the mesh. moved: whether vertices were elsewhere when the hierarchy
    was built, so that only indices can be compared."""
    has_source = hierarchy.source >= 0
    source = hierarchy.source[has_source]
    if len(hierarchy.order) != len(begin) or source.max(initial=-1) >= len(positions):
        return False
    if not moved and (hierarchy.vertices[has_source] != positions[source]).any():
        return False
    tetrahedra = hierarchy.tetrahedra[hierarchy.leaf]
    if hierarchy.summary.is_exact:  # a facet of the tetrahedron is a triangle of the polygon
        tetrahedron_vertices = np.repeat(hierarchy.source[tetrahedra], np.diff(begin, append=len(corners)), axis=0)
        shared = (tetrahedron_vertices == corners[:, None]).any(axis=1)
        return (np.add.reduceat(shared, begin, dtype=np.int32) >= 3).all()
    if moved:
        return True
    low, high = np.minimum.reduceat(positions[corners], begin), np.maximum.reduceat(positions[corners], begin)
    corner_positions = [hierarchy.vertices[tetrahedra[:, end]] for end in range(4)]
    gap = np.maximum(np.minimum.reduce(corner_positions) - high, low - np.maximum.reduce(corner_positions)).clip(0)
    reach = (hierarchy.summary.deviation + SPACING) * np.linalg.norm(high.max(axis=0) - low.min(axis=0))
    return (np.linalg.norm(gap, axis=1) <= reach).all()


def unpack(data: object) -> tuple[Fingerprint, Hierarchy]:
    """Return (fingerprint of the mesh when it was built, hierarchy). Raises UnsoundData."""
    start = HEADER.size + HASH_SIZE
    if not isinstance(data, bytes) or len(data) < start or not data.startswith(MAGIC):
        raise UnsoundData("they are no data of Partwheel")
    _, version, *fingerprint = HEADER.unpack_from(data)
    if version > saved_format():
        raise NewerVersion("they are of a newer version")
    failure = OlderVersion if version < saved_format() else UnsoundData  # the oldest formats can't be read any more
    if _hash(data[:HEADER.size]) != data[HEADER.size:start]:
        raise failure("they are damaged")
    try:
        hierarchy = Hierarchy.load(memoryview(data)[start:])
    except PartwheelError as error:
        raise failure("they are damaged") from error
    return Fingerprint(*fingerprint), hierarchy


def _hash(data: bytes) -> bytes:
    return hashlib.blake2b(data, digest_size=HASH_SIZE).digest()


def has_stored(mesh: bpy.types.Mesh, state: MeshState) -> bool:
    """Return whether a hierarchy came with the mesh and was not loaded yet."""
    return state.stored is not None or PROPERTY in mesh


def take_property(mesh: bpy.types.Mesh) -> bytes | None:
    """Return the packed hierarchy of an appended or linked mesh, or None; remove the property if possible."""
    packed = mesh.get(PROPERTY)
    if packed is not None and not mesh.library:
        del mesh[PROPERTY]
    return packed


class PendingLoad:
    """The hierarchy that came with a mesh, if any, loaded in the background."""

    def __init__(self, mesh: bpy.types.Mesh, state: MeshState) -> None:
        self.mesh, self.packed, self._state, state.stored = mesh, state.stored or take_property(mesh), state, None
        self._task = None if self.packed is None else start_thread(lambda: unpack(self.packed))

    def result(self, fingerprint: Fingerprint) -> tuple[Fingerprint, Hierarchy] | None:
        """Return (fingerprint when it was built, hierarchy), or None if none fits the mesh's current fingerprint."""
        if not self._task:
            return None
        try:
            built, hierarchy = self._task.result()
            if built.topology != fingerprint.topology:
                raise UnsoundData("the mesh has changed since")
            if not matches_mesh(hierarchy, arrays.read_positions(self.mesh), arrays.read_polygon_sizes(self.mesh)[0],
                                arrays.read_corner_vertices(self.mesh), built.positions != fingerprint.positions):
                raise UnsoundData("they belong to another mesh")
            return built, hierarchy
        except OlderVersion:
            return None  # the parts are found again, as if there were none
        except NewerVersion:
            self._state.is_from_newer_version = True
            return None
        except UnsoundData as reason:
            print(f"Partwheel: the parts saved with {self.mesh.name} are ignored, because {reason}.")
            return None
