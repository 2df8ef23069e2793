# SPDX-License-Identifier: GPL-3.0-or-later
"""Which files are to be done, and the key of each: what it holds, and what it is to be made into, by which versions."""

import hashlib
import json
import mmap
import os
import re
import stat
import urllib.parse
from importlib import metadata
from pathlib import Path

from . import blend
from .. import library

# Of folders these are taken; a file that is named is taken whatever its name ends with.
SUFFIXES = {".3mf", ".blend", ".dae", ".glb", ".gltf", ".obj", ".off", ".ply", ".stl"}
RESULTS = 1  # grows when the same input and options give other files


def found(names):
    """The files, sorted within each folder, each once. names: files, folders (taken with all below), @FILE (a list of
    names, one a line). Raises OSError for a list that can't be read."""
    seen = {}
    for name in names:
        if name.startswith("@"):
            lines = Path(name[1:]).read_text("utf-8").splitlines()
            seen.update(dict.fromkeys(found([line for line in map(str.strip, lines) if line])))
        elif os.path.isdir(name):
            for folder, folders, files in os.walk(name):
                folders.sort()
                seen.update((os.path.join(folder, file), None) for file in sorted(files)
                            if os.path.splitext(file)[1].lower() in SUFFIXES)
        else:
            seen[name] = None
    return list(seen)


def of_shard(paths, index, count):
    """Those of a shard, 1 <= index <= count: by a hash of the path, so that a file stays in its shard when others come."""
    def number(path):
        return int.from_bytes(hashlib.sha256(os.fsencode(path)).digest()[:8], "big")
    return [path for path in paths if number(path) % count == index - 1]


def versions(settings):
    """What the results depend on beside input and settings: {name: version}."""
    needed = ["trimesh"] + ["embreex", "pillow"] * ("preview" in settings["outputs"])
    path = os.environ.get("PARTWHEEL_LIBRARY") or library.LIBRARY
    found = {"results": str(RESULTS), "partwheel": library.VERSION,
             # Between releases the number stays; what is compiled doesn't.
             "library": hashlib.sha256(Path(path).read_bytes()).hexdigest()[:16]}
    for name in needed:
        try:
            found[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            found[name] = "none"
    return found


class Input:
    """A file as it was when it was hashed. key: 64 hex digits. size: bytes. error: why it can't be read, or None.
    stopped: asked on the way; when it says so what comes out is not to be used."""

    def __init__(self, path, settings, versions, stopped=lambda: False):
        self.path, self.suffix, self._settings = path, os.path.splitext(path)[1].lower(), settings
        self.versions = {**versions, "blender": blend.version()} if self.suffix == ".blend" else versions
        self.size, self.sha256, self.error = 0, None, None
        try:
            self._stamp = _stamp(path)
            self.size = self._stamp[0]
            self.sha256 = _hashed(path, stopped)
            beside = [(name, _hashed(file, stopped)) for name, file in _beside(path)] if self.suffix == ".gltf" else []
            content = [self.sha256, beside]
        except OSError as error:
            self.error = f"{error.strerror or error}: {path}"
            content = ["unreadable", path, self.error]
        told = json.dumps([content, self.suffix, settings, self.versions], sort_keys=True)
        self.key = hashlib.sha256(told.encode("utf-8", "surrogateescape")).hexdigest()

    def report(self):
        """What model.json says of it before anything was made of it."""
        return {"key": self.key, "sha256": self.sha256, "bytes": self.size, "format": self.suffix[1:],
                "settings": self._settings, "versions": self.versions, "error": None}

    def changed(self):
        """Whether the file is another than it was."""
        try:
            return self.error is None and _stamp(self.path) != self._stamp
        except OSError:
            return True


def _stamp(path):
    status = os.stat(path)
    if not stat.S_ISREG(status.st_mode):
        raise OSError(0, "This is no regular file")  # a pipe would be waited for
    return status.st_size, status.st_mtime_ns, status.st_ino


def _hashed(path, stopped):
    digest = hashlib.sha256()
    with open(path, "rb") as file:
        while (piece := file.read(2**20)) and not stopped():
            digest.update(piece)
    return digest.hexdigest()


def _beside(path):
    """(name, file) of the files that a glTF names and that are there. By its text: whatever is in it takes no memory."""
    with open(path, "rb") as file:
        if not os.fstat(file.fileno()).st_size:
            return
        with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as text:
            names = sorted({match[1] for match in re.finditer(rb'"uri"\s*:\s*"((?!data:)[^"]{1,1024})"', text)})
    for name in names:
        name = urllib.parse.unquote(name.decode("utf-8", "replace"))
        beside = os.path.join(os.path.dirname(path), name)
        if os.path.isfile(beside):
            yield name, beside
