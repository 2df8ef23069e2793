# SPDX-License-Identifier: GPL-3.0-or-later
"""A hierarchy as it travels with its mesh in a .blend file: packed into bytes, and refused if not wholly sound.

The bytes are a custom property of the mesh, there only while a file is written or has just been read: otherwise every
undo step and every copy of the mesh that Blender makes for drawing would drag them along. No bpy here.
"""

import hashlib
import struct
import threading
import zlib

from .core import Hierarchy, PartwheelError
from .mesh_arrays import Fingerprint

PROPERTY = "partwheel"
MAGIC, VERSION = b"PWPARTS\0", 1
# Magic, version, fingerprint, unpacked size, hash of these. What follows has hashes of its own: zlib's, and that of the
# saved hierarchy.
HEADER = struct.Struct("<8sI16s16sQ")
HASH_SIZE = 16
# Saved hierarchies shrink to 0.6; what promises to grow more than this is made to fill the memory.
MOST_GROWTH = 64


class Refused(Exception):
    """Bytes that are not a hierarchy of this mesh. str() says why, as the end of a sentence."""


def pack(fingerprint, hierarchy):
    saved = hierarchy.save()
    header = HEADER.pack(MAGIC, VERSION, *fingerprint, len(saved))
    return header + _hash(header) + zlib.compress(saved, 1)


class Unpacking:
    """Bytes that are being unpacked in a thread, while the caller finds out which mesh they must fit."""

    def __init__(self, data):
        self._opened = self._error = None
        self._thread = threading.Thread(target=self._run, args=[data], name="partwheel-unpack")
        self._thread.start()

    def _run(self, data):
        try:
            self._opened = unpack(data)
        except Exception as error:  # whatever it is, result() raises it
            self._error = error

    def result(self, topology, face_count):
        """(Fingerprint when it was built, Hierarchy). Raises Refused, also when they are of another mesh."""
        self._thread.join()
        if self._error:
            raise self._error
        fingerprint, hierarchy = self._opened
        if fingerprint.topology != topology:
            raise Refused("the mesh has changed since")
        if len(hierarchy.order) != face_count:
            raise Refused("it is damaged")
        return fingerprint, hierarchy


def unpack(data):
    """(Fingerprint when it was built, Hierarchy). Raises Refused."""
    start = HEADER.size + HASH_SIZE
    if not isinstance(data, bytes) or len(data) < start or not data.startswith(MAGIC):
        raise Refused("it is not ours")
    _, version, *fingerprint, size = HEADER.unpack_from(data)
    fingerprint = Fingerprint(*fingerprint)
    if version != VERSION:
        raise Refused("it is of another version")
    if _hash(data[:HEADER.size]) != data[HEADER.size:start] or size > MOST_GROWTH * len(data):
        raise Refused("it is damaged")
    try:
        inflate = zlib.decompressobj()
        saved = inflate.decompress(memoryview(data)[start:], size)
        # Only the end of the stream brings zlib's own check.
        more = inflate.decompress(inflate.unconsumed_tail, 1)
        if len(saved) != size or more or not inflate.eof or inflate.unused_data:
            raise Refused("it is damaged")
        hierarchy = Hierarchy.load(saved)
    except (zlib.error, PartwheelError) as error:
        raise Refused("it is damaged, or of another version") from error
    return fingerprint, hierarchy


def _hash(data):
    return hashlib.blake2b(data, digest_size=HASH_SIZE).digest()
