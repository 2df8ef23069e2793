# SPDX-License-Identifier: GPL-3.0-or-later
"""Input files and their keys: hashes of the content, the settings and the versions of the programs."""

import hashlib
import json
import mmap
import os
import re
import stat
import urllib.parse
from importlib import metadata
from pathlib import Path
from typing import Any, Callable, Dict, Iterable, Iterator, List, Optional, Tuple

from . import blend
from .. import library

# The mesh files of a folder. A file that is named itself may have any suffix.
SUFFIXES = {".3mf", ".blend", ".dae", ".glb", ".gltf", ".obj", ".off", ".ply", ".stl"}
RESULT_VERSION = 1  # increment when the same input and options give other files


def expand_inputs(names: Iterable[str]) -> List[str]:
    """The files that the names stand for: files; folders, searched recursively; @FILE, a list of names, one per line. Sorted
    within each folder, without duplicates. Raises OSError if a list can't be read."""
    paths: Dict[str, None] = {}
    for name in names:
        if name.startswith("@"):
            lines = Path(name[1:]).read_text("utf-8").splitlines()
            paths.update(dict.fromkeys(expand_inputs([line for line in map(str.strip, lines) if line])))
        elif os.path.isdir(name):
            for folder, folders, files in os.walk(name):
                folders.sort()
                paths.update((os.path.join(folder, file), None) for file in sorted(files)
                             if os.path.splitext(file)[1].lower() in SUFFIXES)
        else:
            paths[name] = None
    return list(paths)


def shard_files(paths: Iterable[str], index: int, count: int) -> List[str]:
    """The files of shard index, 1 <= index <= count, of a run. A hash of its path decides, so a file keeps its shard when
    files are added."""
    def path_hash(path: str) -> int:
        return int.from_bytes(hashlib.sha256(os.fsencode(path)).digest()[:8], "big")
    return [path for path in paths if path_hash(path) % count == index - 1]


def tool_versions(settings: Dict[str, Any]) -> Dict[str, str]:
    """The programs that results depend on: {name: version}."""
    packages = ["trimesh", "plyfile"] + ["embreex", "pillow"] * ("preview" in settings["outputs"])
    path = os.environ.get("PARTWHEEL_LIBRARY") or library.LIBRARY
    versions = {"results": str(RESULT_VERSION), "partwheel": library.VERSION,
                # The library changes between releases, its version number does not.
                "library": hashlib.sha256(Path(path).read_bytes()).hexdigest()[:16]}
    for name in packages:
        try:
            versions[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            versions[name] = "none"
    return versions


class Input:
    """A file as it was when it was hashed.

    settings, versions : see command.settings(), tool_versions()
    is_stopped : polled while the file is hashed; if it returns True, hashing ends and the Input must not be used
    key : 64 hexadecimal digits
    size : in bytes
    error : why the file can't be read, or None"""

    def __init__(self, path: str, settings: Dict[str, Any], versions: Dict[str, str],
                 is_stopped: Callable[[], bool] = lambda: False) -> None:
        self.path, self.suffix, self._settings = path, os.path.splitext(path)[1].lower(), settings
        self.versions = {**versions, "blender": blend.version()} if self.suffix == ".blend" else versions
        self.size = 0
        self.sha256: Optional[str] = None
        self.error: Optional[str] = None
        try:
            self._stamp = _stamp(path)
            self.size = self._stamp[0]
            self.sha256 = _hash_file(path, is_stopped)
            references = _referenced_files(path) if self.suffix == ".gltf" else []
            content: List[Any] = [self.sha256, [(name, _hash_file(file, is_stopped)) for name, file in references]]
        except OSError as error:
            self.error = f"{error.strerror or error}: {path}"
            content = ["unreadable", path, self.error]
        text = json.dumps([content, self.suffix, settings, self.versions], sort_keys=True)
        self.key = hashlib.sha256(text.encode("utf-8", "surrogateescape")).hexdigest()

    def report(self) -> Dict[str, Any]:
        """The entries of model.json that describe the input."""
        return {"key": self.key, "sha256": self.sha256, "bytes": self.size, "format": self.suffix[1:],
                "settings": self._settings, "versions": self.versions, "error": None}

    def has_changed(self) -> bool:
        """Whether the file was changed since it was hashed."""
        try:
            return self.error is None and _stamp(self.path) != self._stamp
        except OSError:
            return True


def _stamp(path: str) -> Tuple[int, int, int]:
    """(size, modification time, inode). Raises OSError for anything but a regular file."""
    status = os.stat(path)
    if not stat.S_ISREG(status.st_mode):
        raise OSError(0, "This is not a regular file")  # reading a pipe would block
    return status.st_size, status.st_mtime_ns, status.st_ino


def _hash_file(path: str, is_stopped: Callable[[], bool]) -> str:
    digest = hashlib.sha256()
    with open(path, "rb") as file:
        while (chunk := file.read(2**20)) and not is_stopped():
            digest.update(chunk)
    return digest.hexdigest()


def _referenced_files(path: str) -> Iterator[Tuple[str, str]]:
    """(name, path) of each existing file that a glTF refers to. Found by a pattern in the mapped file, so memory stays
    small."""
    with open(path, "rb") as file:
        if not os.fstat(file.fileno()).st_size:
            return
        with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as text:
            names = sorted({match[1] for match in re.finditer(rb'"uri"\s*:\s*"((?!data:)[^"]{1,1024})"', text)})
    for uri in names:
        name = urllib.parse.unquote(uri.decode("utf-8", "replace"))
        referenced = os.path.join(os.path.dirname(path), name)
        if os.path.isfile(referenced):
            yield name, referenced
