# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line: python3 -m partwheel build, parts, convex, batch, report. --help lists the options of each.

Exit codes: 0 success, 1 a named error, 2 wrong usage or a file that can't be opened or written, 141 the reader of the output has
ended, as head does."""

import argparse
import json
import os
import sys
from collections import Counter
from pathlib import Path
from typing import Any, Dict, Optional, Sequence

import numpy as np

from . import argument_types as types, contents, convex, meshes, requirements
from .batch import command as batch
from .cut import Cut, files, name_parts, printing
from .cut.names import find_names
from .cut.orientation import upright
from .hierarchy import Hierarchy
from .labels import read_labels
from .library import Error, Mode
from .marks import find_face_pairs, marks_of_labels, marks_of_model
from .output import whole_file
from .worker import read_memory

BUILT, NAMED_ERROR, USAGE, BROKEN_PIPE = 0, 1, 2, 141


def peak_memory() -> Optional[int]:
    """Peak memory of this process in bytes; None if unknown."""
    if sys.platform == "linux":  # where getrusage() includes the parent's memory at the fork
        return read_memory("VmHWM") or None
    try:
        import resource
    except ImportError:  # Windows
        return None
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)


def parse(arguments: Optional[Sequence[str]]) -> argparse.Namespace:
    """Parses the command line; None: sys.argv. Exits with code 2 if it is invalid."""
    parser = argparse.ArgumentParser(prog="partwheel", description="Partwheel without Blender.")
    commands = parser.add_subparsers(dest="command", required=True)
    build = commands.add_parser("build", help="build the hierarchy of parts of a surface")
    build.add_argument("-o", "--output", type=Path, metavar="FILE", help="save the hierarchy here")
    parts = commands.add_parser("parts", help="write the parts of a model: closed objects, labels, colors")
    _add_parts_options(parts)
    hulls = commands.add_parser("convex", help="write a convex decomposition of the model, for engines")
    _add_hull_options(hulls)
    for command in (build, parts, hulls):
        command.add_argument("model", type=Path, help="a mesh file: OFF, OBJ, or any other format that trimesh reads"
                             + "; or a robot's URDF file, whose collision meshes become hulls" * (command is hulls))
        command.add_argument("--json", action="store_true", help="print the report as JSON on one line")
        types.add_build_options(command)
    batch.add_to(commands)
    options = parser.parse_args(arguments)
    if options.command == "convex" and is_robot(options) and (options.primitives is not None or options.formats != ["obj"]):
        parser.error("a URDF file becomes a URDF file with hulls: leave out --primitives and --formats")
    if options.command == "convex" and is_robot(options) and (options.each or options.labels):
        parser.error("the links of a URDF file have hulls of their own: leave out --each and --labels")
    if options.command == "parts":
        if (options.inserts or options.joint != "peg") and options.pegs is None:
            options.pegs = printing.CLEARANCES["pla"]
        options.printing = bool(options.pegs is not None or options.flat or options.numbers or options.bed or options.size)
        options.formats = options.formats or (["3mf", "stl"] if options.printing else ["glb", "ply"])
    return options


def _add_parts_options(parts: argparse.ArgumentParser) -> None:
    parts.add_argument("-o", "--output", type=Path, metavar="FOLDER", required=True, help="write the files here")
    division = parts.add_mutually_exclusive_group()
    division.add_argument("--parts", type=int, default=0, metavar="N", help="number of parts (default: automatic)")
    division.add_argument("--labels", type=Path, metavar="FILE",
                          help="take the parts from a file: a text file with an integer for each face, a PLY file whose faces "
                               "have a property part or label, a GLB file with one node per part")
    parts.add_argument("--formats", type=types.some_of(files.FORMATS), metavar="F,...",
                       help="glb, obj, 3mf: all parts as objects of one file; stl: one file per part; ply: the model "
                            "with labels and colors (default: glb,ply; for 3D printing 3mf,stl)")
    _add_print_options(parts.add_argument_group("for a 3D printer", "needs pip install partwheel[printing]"))


def _add_hull_options(hulls: argparse.ArgumentParser) -> None:
    hulls.add_argument("-o", "--output", type=Path, metavar="FOLDER", required=True, help="write the files here")
    limit = hulls.add_mutually_exclusive_group()
    limit.add_argument("--hulls", type=int, default=16, metavar="N", help="number of hulls (default: 16)")
    limit.add_argument("--error", type=types.length, default=0, metavar="E",
                       help="use as few hulls as possible that stay within distance E of the model, in its unit")
    hulls.add_argument("--max-vertices", type=int, default=0, metavar="N",
                       help="per hull, 8 or more; PhysX allows 64 or 255 (default: any number)")
    hulls.add_argument("--keep-open", type=types.length, default=0, metavar="R",
                       help="keep openings free that a ball of radius R passes, as far as there are enough hulls")
    groups = hulls.add_mutually_exclusive_group()
    groups.add_argument("--each", choices=meshes.LABEL_KINDS,
                        help="as many hulls, or this error, for each material, each group (object or node) or each loose part")
    groups.add_argument("--labels", type=Path, metavar="FILE", help="the same for each label of a file, as for parts")
    hulls.add_argument("--primitives", type=types.length, default=None, metavar="D",
                       help="replace a hull by a box, sphere, capsule or cylinder that stays within distance D of it, in the "
                            "model's unit; only for glb, unreal, urdf, mjcf and usd, and only shapes that the format has")
    hulls.add_argument("--density", type=types.density, metavar="KG",
                       help="per cubic meter, for the mass and inertia in urdf, mjcf and usd; the model is in meters "
                            "(default: 1000; for a URDF file: mass and inertia stay)")
    hulls.add_argument("--formats", type=types.some_of(convex.FORMATS), default=["obj"], metavar="F,...",
                       help="obj, glb: the hulls; unreal, godot: glb with the model and its hulls, named for that engine; "
                            "urdf, mjcf, usd: for robot simulators (default: obj)")


def _add_print_options(group: Any) -> None:
    group.add_argument("--pegs", type=types.clearance, metavar="MM",
                       help="planar cuts with pegs and sockets, with this clearance in millimeters, or that of a material: "
                            + ", ".join(f"{name} ({gap:g})" for name, gap in printing.CLEARANCES.items()))
    group.add_argument("--flat", action="store_true", help="planar cuts without pegs")
    joints = group.add_mutually_exclusive_group()
    joints.add_argument("--snap-pins", dest="joint", action="store_const", const="snap pin", default="peg",
                        help="where the cut is large enough, pins of two halves with bumps that snap into their sockets, instead of pegs")
    joints.add_argument("--dovetails", dest="joint", action="store_const", const="dovetail",
                        help="where the cut is large enough, dovetails, which slide into their sockets from one side, instead of pegs")
    joints.add_argument("--dowels", dest="inserts", type=types.dowel, metavar="DxL",
                        help="instead of pegs, holes on both sides of each cut for dowels or pieces of filament of this diameter "
                             "and length, in millimeters: 1.75x12")
    joints.add_argument("--magnets", dest="inserts", type=types.magnet, metavar="DxH",
                        help="instead of pegs, a pocket on each side of each cut for a magnet of this diameter and height: 6x3")
    group.add_argument("--numbers", action="store_true", help="engrave the same number into the two sides of each cut")
    group.add_argument("--wall", type=types.length, default=1.2, metavar="MM",
                       help="minimum wall around a socket; thinner walls are reported (default: 1.2)")
    group.add_argument("--size", type=types.length, metavar="MM",
                       help="length of the model's longest side (default: the model is in millimeters)")
    group.add_argument("--bed", type=types.bed, metavar="X,Y,Z",
                       help="size of the print bed in millimeters; larger parts are cut")


# ---- Commands


def show_progress(fraction: float, stage: str) -> None:
    """Overwrites the line of progress on the terminal."""
    print(f"\r{fraction:4.0%} {stage:<12}", end="", file=sys.stderr, flush=True)


def build(options: argparse.Namespace, report: Dict[str, Any]) -> None:
    """Runs build, parts or convex. Fills the report as far as the run gets. Raises Error, OSError."""
    requirements.check_command(options, [options.model])
    if options.command == "convex" and is_robot(options):
        convert_robot(options, report)
        return
    mesh = meshes.read(options.model)
    report.update(vertices=len(mesh.vertices), triangles=len(mesh.triangles), faces=mesh.face_count,
                  welded_vertices=mesh.welded)
    report_losses(options, mesh, report)
    labels = chosen_labels(options, mesh)
    marks = marks_of_model(mesh, options.use)
    if labels is not None:  # so that parts end exactly at their borders
        marks.append(marks_of_labels(find_face_pairs(mesh.vertices, mesh.triangles, mesh.faces), labels, "labels", chosen=True))
    turn = upright(mesh.vertices, mesh.triangles) if getattr(options, "printing", False) else np.eye(3)
    try:
        hierarchy = Hierarchy.build(mesh.vertices @ turn.T, mesh.triangles, mesh.faces, mesh.face_count, threads=options.threads,
                                    marks=marks, progress=show_progress if sys.stderr.isatty() else None,
                                    **{**types.build_options(options), "mode": Mode[options.mode.upper()]})
    finally:
        if sys.stderr.isatty():
            print("\r" + " " * 20, end="\r", file=sys.stderr, flush=True)
    report.update(tets=len(hierarchy.tetrahedra), nodes=len(hierarchy.parent), seconds=hierarchy.seconds,
                  notes=hierarchy.notes, **hierarchy.summary._asdict())
    if options.command == "parts":
        write_parts(options, mesh, hierarchy, labels, turn, report)
    elif options.command == "convex":
        write_hulls(options, mesh, hierarchy, labels, report)
    elif options.output:
        with whole_file(options.output):
            options.output.write_bytes(hierarchy.save())


def report_losses(options: argparse.Namespace, mesh: meshes.Mesh, report: Dict[str, Any]) -> None:
    """Reports what no output will have, before the work starts. Raises RequirementError."""
    hulls_only = ("obj", "glb") if options.command == "convex" else ()
    formats = [name for name in getattr(options, "formats", ()) if name not in hulls_only]
    if mesh.appearance:
        requirements.check(files.image_needs(mesh.appearance, formats))
    losses = contents.find_losses(mesh.dropped, mesh.kinds, formats)
    report.update(dropped=contents.find_dropped(losses), dropped_by_format=losses)
    if options.command != "build" and not options.json:
        print(*contents.describe_losses(losses), sep="\n", end="\n" * any(losses.values()), flush=True)


def chosen_labels(options: argparse.Namespace, mesh: meshes.Mesh) -> Optional[np.ndarray]:
    """(F,) the labels that the options name, or None. Raises MeshFileError."""
    if getattr(options, "labels", None):
        return read_labels(options.labels, mesh)
    kind = getattr(options, "each", None)
    labels = mesh.face_labels(kind) if kind else None
    if kind and labels is None:
        raise meshes.MeshFileError(f"{options.model.name} has no {kind}. Leave out --each, or use --each loose.")
    return labels


def write_parts(options: argparse.Namespace, mesh: meshes.Mesh, hierarchy: Hierarchy, labels: Optional[np.ndarray],
                turn: np.ndarray, report: Dict[str, Any]) -> None:
    """Writes the files of parts. turn : (3, 3) the rotation of the mesh before the hierarchy was built"""
    cut = (Cut.from_labels(hierarchy, labels) if labels is not None else
           Cut.into(hierarchy, options.parts) if options.parts > 0 else Cut.automatic(hierarchy))
    printable = prepare_for_printer(options, mesh, cut, turn) if options.printing else None
    if printable:
        cut = printable.cut
        report.update(pegs=len(printable.pegs), joints=Counter(f"{peg.kind}s" for peg in printable.pegs),
                      beds=len(printable.beds), print_notes=printable.notes)
    paths = files.write(options.output, options.model.stem, mesh, cut, options.formats, printable=printable)
    report.update(parts=len(printable.solids if printable else cut), files=list(map(str, paths)))


def write_hulls(options: argparse.Namespace, mesh: meshes.Mesh, hierarchy: Hierarchy, labels: Optional[np.ndarray],
                report: Dict[str, Any]) -> None:
    """Writes the files of convex."""
    if labels is None:
        hulls = hierarchy.convex_parts(**hull_options(options))
    else:
        of_parts = Cut.from_labels(hierarchy, labels).convex_parts(**hull_options(options))
        hulls = [hull for of_part in of_parts for hull in of_part]
        report["hulls_of_parts"] = list(map(len, of_parts))
    report["covering_hulls"] = [number for number, hull in enumerate(hulls)
                                if options.keep_open and (hull.error or 0) > options.keep_open]
    has_mass = set(options.formats) & {"urdf", "mjcf", "usd"}
    mass = convex.mass_properties(hierarchy, options.density or convex.DEFAULT_DENSITY) if has_mass else None
    paths = convex.write(options.output, options.model.stem, mesh, hulls, options.formats, options.primitives, mass)
    report.update(hulls=len(hulls), files=list(map(str, paths)))


def is_robot(options: argparse.Namespace) -> bool:
    """Whether the model is a URDF file."""
    return options.model.suffix.lower() == ".urdf"


def hull_options(options: argparse.Namespace) -> Dict[str, Any]:
    """The arguments of Hierarchy.convex_parts()."""
    count = {"error": options.error} if options.error else {"hulls": options.hulls}
    return {**count, "max_vertices": options.max_vertices, "keep_open": options.keep_open, "threads": options.threads}


def convert_robot(options: argparse.Namespace, report: Dict[str, Any]) -> None:
    """Runs convex for a URDF file."""
    robot = convex.convert_urdf(options.model, options.output, options.density, **hull_options(options))
    report.update(links=robot.hulls, hulls=sum(robot.hulls.values()), covering_links=robot.covering,
                  files=list(map(str, robot.files)))


def prepare_for_printer(options: argparse.Namespace, mesh: meshes.Mesh, cut: Cut, turn: np.ndarray) -> printing.Printable:
    """Scales the cut's parts and cuts them flat, as the options say. The cut is of the mesh after a rotation; the
    pieces are not."""
    longest = float(np.ptp(mesh.vertices, axis=0).max())
    scale = options.size / longest if options.size and longest > 0 else 1.0
    print_options = printing.PrintOptions(scale, options.pegs, options.wall, options.bed, options.parts, options.inserts,
                                          options.numbers, options.joint)
    cut = printing.split_parts(cut, print_options)
    names = name_parts(cut, mesh.vertices, mesh.triangles, mesh.faces, known=find_names(cut, mesh))
    printable = printing.prepare_parts(cut, mesh.vertices @ turn.T, mesh.triangles, mesh.faces, print_options, names=names)
    return printable.turned(turn.T)


def describe(report: Dict[str, Any]) -> str:
    """The report as text."""
    if report["error"]:
        return f"{report['model']}: {report['error']['name']}. {report['error']['message']}"
    if "links" in report:
        covering = report["covering_links"]
        return "\n".join([f"{report['files'][0]}: {report['hulls']} hulls",
                          *(f"  {link}: {count}" for link, count in report["links"].items()),
                          *(["These links may cover openings that the ball passes. Ask for more hulls: " + ", ".join(covering)]
                            if covering else [])])
    lines = [f"{report['model']}: {report['faces']} faces, {report['tets']} tets, components: {report['components']}, "
             f"cavities: {report['cavities']}, nodes: {report['nodes']}, {report['fill_method']}"
             + (f", on a copy with {report['proxy_triangles']} triangles" if report["proxy_triangles"] else "")]
    if report["notes"]:
        lines.append(report["notes"])
    if report["welded_vertices"]:
        lines.append(f"This format does not share vertices: {report['welded_vertices']} identical vertices were welded.")
    if report.get("files"):
        lines += [f"{report['parts']} parts:" if "parts" in report else f"{report['hulls']} hulls:",
                  *(f"  {name}" for name in report["files"])]
    if report.get("covering_hulls"):
        lines.append("These hulls may cover openings that the ball passes. Ask for more hulls: "
                     + ", ".join(f"{number:02}" for number in report["covering_hulls"]))
    if "pegs" in report:
        joints = ", ".join(f"{count} {kind}" for kind, count in report["joints"].items())
        lines += [f"Joints: {joints or 'none'}", *([f"Beds: {report['beds']}"] if report["beds"] else []), *report["print_notes"]]
    lines += [f"  {stage:<12} {seconds:9.3f} s" for stage, seconds in report["seconds"].items()]
    if report["peak_memory_bytes"] is not None:
        lines.append(f"  peak memory  {report['peak_memory_bytes'] / 2**20:9.1f} MiB")
    return "\n".join(lines)


def main(arguments: Optional[Sequence[str]] = None) -> int:
    """Runs the command line; returns the exit code."""
    try:
        try:
            return run(parse(arguments))
        finally:
            sys.stdout.flush()
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # Python flushes it once more at exit
        return BROKEN_PIPE


def run(options: argparse.Namespace) -> int:
    """Runs the parsed command; returns the exit code."""
    if options.command == "batch":
        return batch.run(options)
    if options.command == "report":
        return batch.write_report(options)
    report: Dict[str, Any] = {"model": str(options.model), "error": None, "faces": None, "tets": None, "components": None,
                              "seconds": {}}
    code = BUILT
    try:
        build(options, report)
    except Error as error:
        code = NAMED_ERROR
        report["error"] = {"name": error.name, "message": str(error)}
        report["seconds"] = error.seconds
    except BrokenPipeError:
        raise
    except OSError as error:
        code = USAGE
        report["error"] = {"name": "file", "message": f"{error.strerror}: {error.filename}"}
    report["peak_memory_bytes"] = peak_memory()
    text = json.dumps(report) if options.json else describe(report)
    print(text, file=sys.stderr if code and not options.json else sys.stdout)
    return code


if __name__ == "__main__":
    sys.exit(main())
