# SPDX-License-Identifier: GPL-3.0-or-later
"""A hierarchy as it travels with its mesh in a .blend file: packed into bytes, and refused if not wholly sound.

The bytes are a custom property of the mesh, there only while a file is written or has just been read: otherwise every
undo step and every copy of the mesh that Blender makes for drawing would drag them along. No bpy here.
"""

import hashlib
import struct

import numpy as np

from partwheel import Hierarchy, PartwheelError
from ..mesh.arrays import Fingerprint

PROPERTY = "partwheel"
MAGIC, VERSION = b"PWPARTS\0", 2  # grows with this form, and with the hierarchy's (format_version in hierarchy.cpp)
# Magic, version, fingerprint, hash of these. The saved hierarchy that follows has a hash of its own, and is compact as it
# is: zlib would make it a sixth smaller, and opening it would take twice as long.
HEADER = struct.Struct("<8sI16s16s")
HASH_SIZE = 16
SPACING = 0.01  # of the points that a hierarchy's deviation was measured at, as a share of the mesh's diagonal


class Refused(Exception):
    """Bytes that are not a hierarchy of this mesh. str() says why, as the end of a sentence."""


class Older(Refused):
    """Bytes of a version before this one, that it can't read any more."""


class Newer(Refused):
    """Bytes of a version after this one."""


def pack(fingerprint, hierarchy):
    header = HEADER.pack(MAGIC, VERSION, *fingerprint)
    return b"".join([header, _hash(header), hierarchy.save()])


def fits(hierarchy, positions, begin, corners, moved):
    """Whether a hierarchy can be of a mesh, which its hashes don't tell: the vertices that it names are there, and each
    face lies where its tetrahedron is.

    positions (V,3), begin (F,) the first corner of each polygon, corners (L,) their vertices; moved: whether vertices
    were elsewhere when it was built, so that only their numbers can tell."""
    known = hierarchy.source >= 0
    source = hierarchy.source[known]
    if len(hierarchy.order) != len(begin) or source.max(initial=-1) >= len(positions):
        return False
    if not moved and (hierarchy.vertices[known] != positions[source]).any():
        return False
    tetrahedra = hierarchy.tetrahedra[hierarchy.leaf]
    if hierarchy.summary.rung == "exact":  # a facet of the tetrahedron is a triangle of the polygon
        behind = np.repeat(hierarchy.source[tetrahedra], np.diff(begin, append=len(corners)), axis=0)
        shared = (behind == corners[:, None]).any(axis=1)
        return (np.add.reduceat(shared, begin, dtype=np.int32) >= 3).all()
    if moved:
        return True
    low, high = np.minimum.reduceat(positions[corners], begin), np.maximum.reduceat(positions[corners], begin)
    ends = [hierarchy.vertices[tetrahedra[:, end]] for end in range(4)]
    gap = np.maximum(np.minimum.reduce(ends) - high, low - np.maximum.reduce(ends)).clip(0)
    reach = (hierarchy.summary.deviation + SPACING) * np.linalg.norm(high.max(axis=0) - low.min(axis=0))
    return (np.linalg.norm(gap, axis=1) <= reach).all()


def unpack(data):
    """(Fingerprint when it was built, Hierarchy). Raises Refused."""
    start = HEADER.size + HASH_SIZE
    if not isinstance(data, bytes) or len(data) < start or not data.startswith(MAGIC):
        raise Refused("it is not ours")
    _, version, *fingerprint = HEADER.unpack_from(data)
    fingerprint = Fingerprint(*fingerprint)
    if version != VERSION:
        raise (Newer if version > VERSION else Older)("it is of another version")
    if _hash(data[:HEADER.size]) != data[HEADER.size:start]:
        raise Refused("it is damaged")
    try:
        hierarchy = Hierarchy.load(memoryview(data)[start:])
    except PartwheelError as error:
        raise Refused("it is damaged") from error
    return fingerprint, hierarchy


def _hash(data):
    return hashlib.blake2b(data, digest_size=HASH_SIZE).digest()
