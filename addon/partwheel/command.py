# SPDX-License-Identifier: GPL-3.0-or-later
"""blender --command partwheel: hierarchies of whole files without a window, in Blender 4.2 and later.

    blender --command partwheel build scene.blend
    blender --command partwheel cut scene.blend --parts 8 --attribute part --output cut.blend"""

import argparse

import bpy

from . import api
from partwheel import Error

COMMAND = "partwheel"
_registration = None


def run(arguments: list[str]) -> int:
    """Runs the command with these arguments, without its name. Returns the exit code: 0, or 1 if any object failed."""
    options = _create_parser().parse_args(arguments)
    bpy.ops.wm.open_mainfile(filepath=options.file, load_ui=False)
    objects = [obj for obj in bpy.data.objects if obj.type == "MESH" and not obj.library
               and options.object in (None, obj.name)]
    if not objects:
        print(f"{options.file} contains no mesh object" + (f" named {options.object}" if options.object else ""))
        return 1
    failed = 0
    for obj in {obj.data: obj for obj in objects}.values():
        try:
            print(options.do(obj, options), flush=True)
        except Error as error:
            print(f"{obj.name}: {error}", flush=True)
            failed += 1
    bpy.ops.wm.save_as_mainfile(filepath=options.output or options.file)
    print(f"{len(objects) - failed} of {len(objects)} objects, saved in {options.output or options.file}", flush=True)
    return 1 if failed else 0


def _build(obj: bpy.types.Object, options: argparse.Namespace) -> str:
    hierarchy = api.build(obj, options.quality, full_resolution=options.full_resolution or None)
    return f"{obj.name}: {len(hierarchy.order)} faces, their parts found. {hierarchy.notes}".rstrip()


def _cut(obj: bpy.types.Object, options: argparse.Namespace) -> str:
    labels = api.cut(obj, options.parts, options.height, options.least_concavity).labels
    attributes = obj.data.attributes
    if options.attribute in attributes:
        attributes.remove(attributes[options.attribute])
    attributes.new(options.attribute, "INT", "FACE").data.foreach_set("value", labels)
    return f"{obj.name}: {len(set(labels.tolist()))} parts in the face attribute {options.attribute}"


def _create_parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog=f"blender --command {COMMAND}",
                                     description="Finds the parts of the meshes in a .blend file and saves it.")
    commands = parser.add_subparsers(required=True, metavar="build | cut")
    for name, function, help_text in (("build", _build, "find the parts and save them in the file"),
                                      ("cut", _cut, "write the part of each face as a face attribute")):
        command = commands.add_parser(name, help=help_text, description=help_text)
        command.set_defaults(do=function)
        command.add_argument("file", help="the .blend file")
        command.add_argument("--object", help="only this object (default: all meshes)")
        command.add_argument("--output", help="save to this file (default: overwrite the file)")
        if name == "build":
            command.add_argument("--quality", type=float, default=0.0,
                                 help="0: add no points inside (default); 1.1 or more: better tetrahedra, slower")
            command.add_argument("--full-resolution", action="store_true",
                                 help="use all triangles of large meshes, not a coarser copy")
        else:
            group = command.add_mutually_exclusive_group(required=True)
            group.add_argument("--parts", type=int, help="number of parts; the last merges are undone")
            group.add_argument("--least-concavity", type=int, metavar="PARTS",
                               help="number of parts, chosen for the least total concavity")
            group.add_argument("--height", type=float, help="cut the dendrogram at this height")
            command.add_argument("--attribute", default="part", help="name of the attribute (default: part)")
    return parser


def register() -> None:
    global _registration
    if hasattr(bpy.utils, "register_cli_command"):
        _registration = bpy.utils.register_cli_command(COMMAND, run)


def unregister() -> None:
    global _registration
    if _registration is not None:
        bpy.utils.unregister_cli_command(_registration)
        _registration = None
