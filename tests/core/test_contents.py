# SPDX-License-Identifier: GPL-3.0-or-later
"""What a file has beside its surface is found, and what of it no output has is said. Files are written by trimesh, or by hand."""

import json

import numpy as np
import pytest
import trimesh
from partwheel import contents, meshes
from PIL import Image
from test_command_line import run

POINTS = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], float)
TRIANGLES = np.array([(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)])
OBJ = "".join("v {} {} {}\n".format(*point) for point in POINTS) + "{}" + "".join(
    "f {} {} {}\n".format(*corners) for corners in TRIANGLES + 1)
PLY = "ply\nformat ascii 1.0\n{}element vertex 4\nproperty float x\nproperty float y\nproperty float z\n{}" \
      "element face 4\nproperty list uchar int vertex_indices\nend_header\n"


def textured():
    """As painted models are exchanged: a picture, where each corner is in it, and a name."""
    material = trimesh.visual.material.PBRMaterial(name="Paint", baseColorTexture=Image.new("RGB", (2, 2)))
    visual = trimesh.visual.TextureVisuals(uv=POINTS[:, :2], material=material)
    return trimesh.Scene({"Body": trimesh.Trimesh(POINTS, TRIANGLES, visual=visual, process=False)})


def plain(**extra):
    return trimesh.Trimesh(POINTS, TRIANGLES, process=False, **extra)


def obj(folder, extra=""):
    text = OBJ.format(extra)
    (folder / "model.obj").write_text(text)
    (folder / "paint.mtl").write_text("newmtl Paint\nmap_Kd paint.png\n")


def ply(folder, header="", properties="", values=""):
    rows = ["{} {} {}".format(*point) + values for point in POINTS] + ["3 {} {} {}".format(*triangle) for triangle in TRIANGLES]
    (folder / "model.ply").write_text(PLY.format(header, properties) + "\n".join(rows) + "\n")


def off(folder, header="OFF", point="", face=""):
    rows = ["{} {} {}".format(*numbers) + point for numbers in POINTS] + ["3 {} {} {}".format(*triangle) + face for triangle in TRIANGLES]
    (folder / "model.off").write_text("\n".join([header, "4 4 0", *rows, ""]))


WRITERS = {
    "glb textured": (lambda folder: textured().export(folder / "model.glb"),
                     {"texture coordinates", "textures", "materials", "names"}),
    "gltf textured": (lambda folder: [(folder / name.replace("model.gltf", "model.gltf")).write_bytes(data) for name, data
                                      in trimesh.exchange.gltf.export_gltf(textured()).items()],
                      {"texture coordinates", "textures", "materials", "names"}),
    "glb colors": (lambda folder: plain(vertex_colors=np.full((4, 4), 9)).export(folder / "model.glb"), {"colors", "names"}),
    "obj plain": (obj, set()),
    "obj mtl": (lambda folder: obj(folder, "mtllib paint.mtl\no Body\nvt 0 0\nusemtl Paint\n"),
                {"texture coordinates", "textures", "materials", "names"}, {"texture coordinates", "textures"}),
    "obj without its mtl": (lambda folder: obj(folder, "mtllib none.mtl\nusemtl Paint\n"), {"materials"}),
    "obj mtl elsewhere": (lambda folder: obj(folder, "mtllib ../../..\nmtllib .\n"), set()),
    "obj colors": (lambda folder: obj(folder, "v 5 5 5 0.5 0.5 1e-1\n"), {"colors"}, {"colors"}),
    "ply plain": (ply, set()),
    "ply colors": (lambda folder: ply(folder, "", "property uchar red\nproperty uchar green\nproperty uchar blue\n", " 1 2 3"),
                   {"colors"}),
    "ply textured": (lambda folder: ply(folder, "comment TextureFile a.png\n", "property float s\nproperty float t\n", " 0 1"),
                     {"texture coordinates", "textures"}, {"textures"}),
    "off plain": (off, set()),
    "off colors": (lambda folder: off(folder, "COFF", " 1 0 0 1"), {"colors"}, {"colors"}),
    "off face colors": (lambda folder: off(folder, face=" 255 0 0"), {"colors"}, {"colors"}),
    "stl plain": (lambda folder: plain().export(folder / "model.stl"), set()),
    "3mf": (lambda folder: trimesh.Scene({"Body": plain()}).export(folder / "model.3mf"), {"names"}),
    "dae": (lambda folder: plain().export(folder / "model.dae"), {"names", "materials"}, {"materials"}),
}


@pytest.mark.parametrize("case", WRITERS)
def test_the_contents_of_a_file_are_listed(case, tmp_path):
    write, expected, *dropped = WRITERS[case]
    write(tmp_path)
    path = tmp_path / f"model.{case.split()[0]}"
    assert list(contents.find_contents(path)) == [kind for kind in contents.KINDS if kind in expected]
    mesh = meshes.read(path)
    assert set(mesh.dropped) == set(*dropped) and set(mesh.dropped).isdisjoint(mesh.kinds)


@pytest.mark.parametrize(("command", "options", "dropped"), [
    ("parts", ["--parts", 1], []), ("parts", ["--parts", 1, "--flat"], ["texture coordinates"]),
    ("parts", ["--parts", 1, "--formats", "stl"], ["texture coordinates", "textures", "materials"]),
    ("convex", [], ["texture coordinates", "textures", "materials", "names"]), ("convex", ["--formats", "unreal,mjcf"], []),
    ("convex", ["--formats", "usd"], ["texture coordinates", "textures", "materials"])])
def test_commands_that_write_geometry_say_what_is_lost(command, options, dropped, tmp_path):
    textured().export(tmp_path / "model.glb")
    result = run(command, tmp_path / "model.glb", "-o", tmp_path / "out", *options)
    assert result.returncode == 0, result.stderr
    sentence = "Not in the output, though the file has them: " + " and ".join(", ".join(dropped).rsplit(", ", 1)) + "."
    assert (sentence in result.stdout) == bool(dropped), result.stdout
    result = run(command, tmp_path / "model.glb", "-o", tmp_path / "out", *options, "--json")
    assert json.loads(result.stdout)["dropped"] == dropped
