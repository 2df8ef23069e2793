# SPDX-License-Identifier: GPL-3.0-or-later
"""Optional packages and programs that a command needs; checked before it reads any model."""

import importlib
import shutil
from pathlib import Path
from types import ModuleType
from typing import Any, Dict, Iterable, List, Tuple

from .library import Error

# Module -> the extra of pyproject.toml that installs it.
EXTRAS = {"manifold3d": "printing", "embreex": "batch", "PIL": "batch", "ray": "ray", "fsspec": "ray",
          **dict.fromkeys(("trimesh", "plyfile", "networkx", "lxml", "collada"), "meshes")}
PACKAGES = {"PIL": "pillow", "collada": "pycollada"}  # module -> package, where the names differ
READERS = {".off": (), ".obj": (), ".urdf": (), ".ply": ("plyfile",), ".3mf": ("trimesh", "networkx", "lxml"),
           ".dae": ("trimesh", "collada")}
WRITERS = {"stl": ("trimesh",), "ply": ("trimesh",)}  # other formats need numpy alone
PRINTING, PREVIEWS, RAY = ("manifold3d",), ("trimesh", "embreex", "PIL"), ("ray", "fsspec")

Need = Tuple[str, str]  # (the use, as the subject of a sentence; the module)


class RequirementError(Error):
    """An optional package or program is missing; str() says what needs it, and how to install it."""

    name = "package"


def load_module(name: str, use: str) -> ModuleType:
    """Imports an optional package, a key of EXTRAS, where it is used. use : what needs it, such as "Writing glb files".
    Raises RequirementError."""
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise RequirementError(f"{_sentence(use, [name])} ({error})") from error


def check(needs: Iterable[Need]) -> None:
    """Checks that all modules can be imported. Raises RequirementError, which lists all missing packages, one sentence per
    use."""
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
    """The requirements of a command, see __main__.parse(), for its options and input files, for check() on another machine.
    Raises RequirementError if something is missing here."""
    suffixes = sorted({Path(path).suffix.lower() for path in paths})
    if options.command == "batch" and ".blend" in suffixes and not shutil.which("blender"):
        raise RequirementError("Reading .blend files needs Blender, and there is no program blender on the PATH. Install "
                               "it, or leave these files out.")
    uses = {f"Reading {suffix or 'such'} files": READERS.get(suffix, ("trimesh",)) for suffix in suffixes
            if suffix != ".blend" or options.command != "batch"}
    uses.update((f"Writing {name} files", WRITERS.get(name, ())) for name in getattr(options, "formats", None) or ())
    if getattr(options, "printing", False):
        uses["Making parts ready for a 3D printer"] = PRINTING
    if "preview" in getattr(options, "make", ()):
        uses["Drawing previews"] = PREVIEWS
    needs = [(use, name) for use, names in uses.items() for name in names]
    check(needs)
    return needs


def _sentence(use: str, names: Iterable[str]) -> str:
    packages = [PACKAGES.get(name, name) for name in names]
    extras = sorted({EXTRAS[name] for name in names})
    noun = "packages" if len(packages) > 1 else "package"
    verb = "are" if len(packages) > 1 else "is"
    return (f"{use} needs the Python {noun} {' and '.join(packages)}, which {verb} not installed: pip install "
            f"\"partwheel[{','.join(extras)}]\".")
