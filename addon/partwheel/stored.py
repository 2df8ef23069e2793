# SPDX-License-Identifier: GPL-3.0-or-later
"""A hierarchy as it travels with its mesh in a .blend file: packed into bytes, and refused if not wholly sound.

The bytes are a custom property of the mesh, there only while a file is written or has just been read: otherwise every
undo step and every copy of the mesh that Blender makes for drawing would drag them along. No bpy here.
"""

import hashlib
import struct
import zlib

from .core import Hierarchy, PartwheelError
from .mesh_arrays import Fingerprint

PROPERTY = "partwheel"
MAGIC, VERSION = b"PWPARTS\0", 1
HEADER = struct.Struct("<8sI16s16s16sQ")  # magic, version, hash of all that follows, fingerprint, unpacked size
HASHED_FROM = struct.calcsize("<8sI16s")
# Saved hierarchies shrink to 0.6; what promises to grow more than this is made to fill the memory.
MOST_GROWTH = 64


class Refused(Exception):
    """Bytes that are not a hierarchy of this mesh. str() says why, as the end of a sentence."""


def pack(fingerprint, hierarchy):
    saved = hierarchy.save()
    rest = HEADER.pack(b"", 0, b"", *fingerprint, len(saved))[HASHED_FROM:] + zlib.compress(saved, 1)
    return struct.pack("<8sI16s", MAGIC, VERSION, _hash(rest)) + rest


def unpack(data, topology, face_count):
    """(Fingerprint when it was built, Hierarchy). Raises Refused."""
    if not isinstance(data, bytes) or len(data) < HEADER.size or not data.startswith(MAGIC):
        raise Refused("it is not ours")
    _, version, digest, *fingerprint, size = HEADER.unpack_from(data)
    fingerprint = Fingerprint(*fingerprint)
    if version != VERSION:
        raise Refused("it is of another version")
    if digest != _hash(data[HASHED_FROM:]) or size > MOST_GROWTH * len(data):
        raise Refused("it is damaged")
    if fingerprint.topology != topology:
        raise Refused("the mesh has changed since")
    try:
        saved = zlib.decompressobj().decompress(memoryview(data)[HEADER.size:], size)
        hierarchy = Hierarchy.load(saved)
    except (zlib.error, PartwheelError) as error:
        raise Refused("it is damaged, or of another version") from error
    if len(saved) != size or len(hierarchy.order) != face_count:
        raise Refused("it is damaged")
    return fingerprint, hierarchy


def _hash(data):
    return hashlib.blake2b(data, digest_size=16).digest()
