# SPDX-License-Identifier: GPL-3.0-or-later
"""Optional packages and programs that a command needs; checked before it reads any model."""

import importlib
import shutil
from pathlib import Path
from types import ModuleType
from typing import Any, Dict, Iterable, Iterator, List, Tuple

from .library import Error

# Module -> the extra of pyproject.toml that installs it.
EXTRAS = {"trimesh": "meshes", "networkx": "meshes", "lxml": "meshes", "collada": "meshes", "manifold3d": "printing",
          "embreex": "batch", "PIL": "batch", "ray": "ray", "fsspec": "ray"}
PACKAGES = {"PIL": "pillow", "collada": "pycollada"}  # module -> package, where the names differ
READERS = {".off": (), ".obj": (), ".urdf": (), ".3mf": ("trimesh", "networkx", "lxml"), ".dae": ("trimesh", "collada")}
WRITERS = {"stl": ("trimesh",), "ply": ("trimesh",)}  # other formats need numpy alone
PRINTING, PREVIEWS, RAY = ("manifold3d",), ("trimesh", "embreex", "PIL"), ("ray", "fsspec")

Need = Tuple[str, str]  # (the use, as the subject of a sentence; the module)


class RequirementError(Error):
    """An optional package or program is missing; str() says what needs it, and how to install it."""

    name = "package"


def load_module(name: str, use: str) -> ModuleType:
    """Imports an optional package where it is used.

    Parameters
    ----------
    name : the module, a key of EXTRAS
    use : what needs it, such as "Writing glb files"

    Raises
    ------
    RequirementError : it is not installed
    """
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise RequirementError(f"{_sentence(use, [name])} ({error})") from error


def check(needs: Iterable[Need]) -> None:
    """Checks that all modules can be imported.

    Raises
    ------
    RequirementError : lists all missing packages, one sentence per use
    """
    missing: Dict[str, List[str]] = {}
    causes: Dict[str, Any] = {}
    for use, name in needs:
        try:
            load_module(name, use)
        except RequirementError as error:
            missing.setdefault(use, []).append(name)
            causes[name] = error.__cause__
    if missing:
        sentences = [_sentence(use, names) for use, names in missing.items()]
        raise RequirementError(f"{' '.join(sentences)} ({'; '.join(map(str, causes.values()))})")


def check_command(options: Any, paths: Iterable[str]) -> List[Need]:
    """Checks the requirements of a command for its options and input files.

    Parameters
    ----------
    options : see __main__.parse()
    paths : the input files

    Returns
    -------
    the requirements, for check() on another machine

    Raises
    ------
    RequirementError : something is missing
    """
    suffixes = sorted({Path(path).suffix.lower() for path in paths})
    if options.command == "batch" and ".blend" in suffixes and not shutil.which("blender"):
        raise RequirementError("Reading .blend files needs Blender, and there is no program blender on the PATH. Install "
                               "it, or leave these files out.")
    needs = [*_reading_needs(suffixes, options.command), *_writing_needs(options)]
    check(needs)
    return needs


def check_ray() -> None:
    """Checks the requirements of a run on a Ray cluster. Raises RequirementError."""
    check(_needs("Running on Ray", RAY))


def _reading_needs(suffixes: Iterable[str], command: str) -> Iterator[Need]:
    for suffix in suffixes:
        if suffix != ".blend" or command != "batch":
            yield from _needs(f"Reading {suffix or 'such'} files", READERS.get(suffix, ("trimesh",)))


def _writing_needs(options: Any) -> Iterator[Need]:
    for name in getattr(options, "formats", None) or ():
        yield from _needs(f"Writing {name} files", WRITERS.get(name, ()))
    if getattr(options, "printing", False):
        yield from _needs("Making parts ready for a 3D printer", PRINTING)
    outputs = getattr(options, "make", ())
    if "preview" in outputs:
        yield from _needs("Drawing previews", PREVIEWS)


def _needs(use: str, names: Iterable[str]) -> Iterator[Need]:
    return ((use, name) for name in names)


def _sentence(use: str, names: Iterable[str]) -> str:
    packages = [PACKAGES.get(name, name) for name in names]
    extras = sorted({EXTRAS[name] for name in names})
    noun = "packages" if len(packages) > 1 else "package"
    verb = "are" if len(packages) > 1 else "is"
    return (f"{use} needs the Python {noun} {' and '.join(packages)}, which {verb} not installed: pip install "
            f"\"partwheel[{','.join(extras)}]\".")
