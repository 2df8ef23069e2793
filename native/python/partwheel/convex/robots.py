# SPDX-License-Identifier: GPL-3.0-or-later
"""A robot's URDF file with the collision meshes of all links replaced by convex hulls."""

import copy
import os
import re
from functools import cache
from pathlib import Path
from typing import Any, Dict, List, NamedTuple, Optional, Tuple
from xml.etree import ElementTree

import numpy as np

from .. import meshes
from ..hierarchy import ConvexPart, Hierarchy
from ..library import Error
from ..output import whole_file
from ..separation import separate
from .files import write_obj
from .mass import MassProperties, mass_properties
from .simulators import rotation_matrix, set_inertial, write_xml


class UrdfError(Error):
    """A URDF file can't be used; str() says why."""

    name = "urdf"


class Robot(NamedTuple):
    """What convert_urdf() wrote."""

    files: List[Path]  # the robot first, then its hulls
    hulls: Dict[str, int]  # the number of hulls by the name of their link
    covering: List[str]  # links with hulls that leave the model by more than keep_open


def convert_urdf(source: Path, folder: Path, density: Optional[float] = None, **options: Any) -> Robot:
    """Writes a robot whose collision meshes are convex hulls. All else stays as it is: joints, names, visual meshes,
    collision primitives, elements of other programs. Paths are written relative to the new file.

    Parameters
    ----------
    source : a URDF file
    folder : receives NAME.urdf and NAME_hulls/LINK_0_00.obj; created if it does not exist
    density : kg / m^3; replaces mass and inertia of links whose collision geometry is nothing but meshes. None: they stay
    options : of Hierarchy.convex_parts(), for each mesh: hulls or error, max_vertices, keep_open, threads

    Raises
    ------
    UrdfError : the file is not URDF, or a mesh can't be found
    PartwheelError, OSError : as for a single mesh
    """
    robot = _read_robot(source)
    target, hull_folder = folder / source.name, folder / f"{source.stem}_hulls"
    hull_folder.mkdir(parents=True, exist_ok=True)
    result = Robot([target], {}, [])

    @cache  # links often share meshes
    def decompose(path: Path, scale: Tuple[float, ...]) -> Tuple[List[ConvexPart], MassProperties]:
        mesh = meshes.read(path)
        hierarchy = Hierarchy.build(mesh.vertices * scale, mesh.triangles, mesh.faces, mesh.face_count,
                                    threads=options.get("threads", 0))
        return hierarchy.convex_parts(**options), mass_properties(hierarchy, density or 1)

    def write_hull(name: str, hull: ConvexPart) -> str:
        path = hull_folder / (re.sub(r"[^\w.-]", "_", name) + ".obj")
        with whole_file(path):
            write_obj(path, [(name, *separate(hull.vertices, hull.triangles)[:2])])
        result.files.append(path)
        return f"{hull_folder.name}/{path.name}"

    for link in robot.iter("link"):
        link_name, masses, collisions = link.get("name", ""), [], link.findall("collision")
        for number, collision in enumerate(collisions):
            mesh = collision.find("geometry/mesh")
            if mesh is None:
                continue
            scale = tuple(map(float, mesh.get("scale", "1 1 1").split()))
            hulls, mass = decompose(find_file(mesh.get("filename", ""), source), scale)
            masses.append(_move(mass, collision.find("origin")))
            _replace_collision(link, collision, [write_hull(f"{link_name}_{number}_{k:02}", hull)
                                                 for k, hull in enumerate(hulls)])
            result.hulls[link_name] = result.hulls.get(link_name, 0) + len(hulls)
            if options.get("keep_open") and any((hull.error or 0) > options["keep_open"] for hull in hulls):
                result.covering.append(link_name)
        if density and masses and len(masses) == len(collisions):
            set_inertial(link, _add_up(masses))
    _move_paths(robot, source.parent, folder, hull_folder.name)
    with whole_file(target):
        write_xml(target, robot)
    return result


def _replace_collision(link: ElementTree.Element, collision: ElementTree.Element, files: List[str]) -> None:
    """Puts copies of a collision element, with these meshes, in its place."""
    place = list(link).index(collision)
    link.remove(collision)
    for number, file in enumerate(files):
        element = copy.deepcopy(collision)
        if "name" in element.attrib:  # names are unique
            element.set("name", f"{element.get('name')}_{number:02}")
        geometry = next(element.iter("mesh"))
        geometry.attrib.clear()  # the scale is in the hulls
        geometry.set("filename", file)
        link.insert(place + number, element)


def _move_paths(robot: ElementTree.Element, before: Path, after: Path, hull_folder: str) -> None:
    """Makes the paths of meshes and textures, except those of hulls, relative to another folder."""
    for element in robot.iter():
        filename = element.get("filename", "")
        if element.tag in ("mesh", "texture") and not filename.startswith(f"{hull_folder}/") and "://" not in filename:
            element.set("filename", Path(os.path.relpath(before / filename, after)).as_posix())


def _read_robot(source: Path) -> ElementTree.Element:
    try:
        tree = ElementTree.parse(source, ElementTree.XMLParser(target=ElementTree.TreeBuilder(insert_comments=True)))
    except ElementTree.ParseError as error:
        raise UrdfError(f"{source.name} is not an XML file: {error}.") from error
    if tree.getroot().tag != "robot":
        raise UrdfError(f"{source.name} has no <robot> element. Choose a URDF file; convert xacro files with xacro first.")
    return tree.getroot()


def find_file(filename: str, source: Path) -> Path:
    """The file that a URDF file names: relative to it, file://..., or package://NAME/..., where a folder above it has the
    package's name or contains it. Raises UrdfError."""
    scheme, _, rest = filename.rpartition("://")
    if scheme == "package":
        package, _, inside = rest.partition("/")
        candidates = [path for parent in source.resolve().parents
                      for path in (parent / rest, *([parent / inside] if parent.name == package else []))]
    else:
        candidates = [source.parent / rest]
    for path in candidates:
        if path.is_file():
            return path
    raise UrdfError(f"{source.name} refers to a mesh that does not exist: {filename}. Put it next to the file, or into a folder "
                    "with the package's name above it.")


def _move(mass: MassProperties, origin: Optional[ElementTree.Element]) -> MassProperties:
    """Mass properties in the link's frame."""
    def numbers(name: str) -> np.ndarray:
        return np.array((origin.get(name, "0 0 0") if origin is not None else "0 0 0").split(), float)
    rotation = rotation_matrix(*numbers("rpy"))
    return MassProperties(mass.mass, rotation @ mass.center + numbers("xyz"), rotation @ mass.inertia @ rotation.T)


def _add_up(masses: List[MassProperties]) -> MassProperties:
    """The mass properties of several bodies that are fixed to each other, by the parallel axis theorem."""
    total = sum(part.mass for part in masses)
    center = np.sum([part.mass * part.center for part in masses], axis=0) / total
    arms = [part.center - center for part in masses]
    inertia = np.sum([part.inertia + part.mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
                      for part, arm in zip(masses, arms)], axis=0)
    return MassProperties(total, center, inertia)
