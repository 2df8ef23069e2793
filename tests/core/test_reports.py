# SPDX-License-Identifier: GPL-3.0-or-later
"""Public bug reports of comparable tools, each as the smallest input that models it. The comment before a test names the
reports: repository and number."""

import io
import json
import os
import resource
import struct
import subprocess
import sys
import zipfile

import mujoco
import numpy as np
import pytest
import shapes
import trimesh
from conftest import PACKAGES
from partwheel import Error, Hierarchy, meshes
from partwheel.cut import Cut, seams

CUBE = trimesh.creation.box()
ELL = shapes.polycube([(0, 0, 0), (1, 0, 0), (0, 0, 1)])


def volume(mesh):
    corners = np.asarray(mesh.vertices, float)[np.asarray(mesh.triangles)]
    return np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6


def off(vertices, polygons, header="OFF\n"):
    return (f"{header}{len(vertices)} {len(polygons)} 0\n" + "".join("{!r} {!r} {!r}\n".format(*map(float, v)) for v in vertices)
            + "".join(f"{len(p)} {' '.join(map(str, p))}\n" for p in polygons))


def save(path, data):
    path.write_bytes(data if isinstance(data, bytes) else data.encode())
    return path


def run(*arguments, limit=None):
    """limit: bytes that a file may have, as on a disk that is full."""
    def set_limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

    return subprocess.run([sys.executable, "-m", "partwheel", *map(str, arguments)], capture_output=True, text=True,
                          timeout=600, env={**os.environ, "PYTHONPATH": PACKAGES}, preexec_fn=limit and set_limit)


# ---- Files that are read


# mikedh/trimesh 2364 and 1448
@pytest.mark.parametrize("corner", ["{0}", "{0}//{0}", "{0}/{0}", "{0}/{0}/{0}"])
def test_negative_indices_of_obj_count_from_their_face(corner, tmp_path):
    text = ""
    for place in range(3):
        for point in CUBE.vertices + (3 * place, 0, 0):
            text += "v {} {} {}\nvt 0 0\nvn 0 0 1\n".format(*point)
        text += "".join("f " + " ".join(corner.format(index - 8) for index in face) + "\n" for face in CUBE.faces)
    mesh = meshes.read(save(tmp_path / "three.obj", text))
    assert len(mesh.vertices) == 24 and volume(mesh) == pytest.approx(3)
    assert Hierarchy.build(*mesh[:4]).summary.components == 3


PENTAGON = [(2, 2), (1, 0.5), (0, 2), (0, 0), (2, 0)]  # a fan around its first corner folds
PRISM = [(*point, z) for z in (0, 1) for point in PENTAGON]
SIDES = [(4, 3, 2, 1, 0), (5, 6, 7, 8, 9), *((i, (i + 1) % 5, (i + 1) % 5 + 5, i + 5) for i in range(5))]


def polygon_file(form):
    if form == "obj":
        return ("".join("v {} {} {}\n".format(*p) for p in PRISM)
                + "".join(f"f {' '.join(str(i + 1) for i in p)}\n" for p in SIDES)).encode()
    head = ("ply\nformat ascii 1.0\nelement vertex 10\nproperty float x\nproperty float y\nproperty float z\n"
            "element face 7\nproperty list uchar int vertex_indices\nend_header\n")
    return (head + "".join("{} {} {}\n".format(*p) for p in PRISM)
            + "".join(f"{len(p)} {' '.join(map(str, p))}\n" for p in SIDES)).encode()


# kip-hart/MicroStructPy 34, cnr-isti-vclab/corto 32, tinyobjloader/tinyobjloader 18
@pytest.mark.parametrize("form", ["obj", "ply"])
def test_concave_polygons_are_filled_without_folds(form, tmp_path):
    mesh = meshes.read(save(tmp_path / f"prism.{form}", polygon_file(form)))
    h = Hierarchy.build(*mesh[:4])
    assert h.summary.is_exact and h.summary.volume == pytest.approx(2.5)


# mikedh/trimesh 37: the field is called vertex_index
def test_big_endian_ply_with_doubles(tmp_path):
    head = (b"ply\nformat binary_big_endian 1.0\nelement vertex 8\nproperty double x\nproperty double y\nproperty double z\n"
            b"element face 12\nproperty list uchar int vertex_index\nend_header\n")
    data = CUBE.vertices.astype(">f8").tobytes() + b"".join(struct.pack(">Biii", 3, *face) for face in CUBE.faces)
    assert volume(meshes.read(save(tmp_path / "cube.ply", head + data))) == 1


STL = CUBE.export(file_type="stl_ascii")


# nschloe/meshio 530, mrdoob/three.js 14522, Ultimaker/Cura 12675
@pytest.mark.parametrize("data", [
    b"solid facet normal".ljust(80) + CUBE.export(file_type="stl")[80:], b"\xef\xbb\xbf" + STL.encode(),
    STL.replace("solid", "solid \u96f6\u4ef61", 1).encode("gbk"), STL.replace("\n", "\r\n").encode(),
], ids=["binary that begins with solid", "byte order mark", "name that is not UTF-8", "CRLF"])
def test_stl_of_any_header(data, tmp_path):
    assert volume(meshes.read(save(tmp_path / "cube.stl", data))) == 1


# alextsui05/blender-off-addon 19, libigl/libigl 480, mikedh/trimesh 542
@pytest.mark.parametrize("header", ["OFF", "COFF", "\ufeffOFF\n", "# made by\n\nOFF", "OFF\r\n", "OFF # cube\n\n"])
def test_off_of_any_header(header, tmp_path):
    text = off(CUBE.vertices, CUBE.faces, header).replace("\n", "\r\n" if "\r" in header else "\n")
    assert volume(meshes.read(save(tmp_path / "cube.off", text))) == 1


# mikedh/trimesh 2591, google/draco 356, inducer/meshpy 26, elalish/manifold 1348, mikedh/trimesh 236
@pytest.mark.parametrize("name, text, words", [
    ("e.off", "", "does not start with OFF"), ("c.off", "OFF\n", "how many vertices and faces"),
    ("t.off", off(CUBE.vertices, CUBE.faces)[:-30], "ends before"),
    ("n.off", off(CUBE.vertices, CUBE.faces).replace("0.5", "nan", 1), "Vertex 0 has a coordinate"),
    ("n.obj", "v 0 0 0\nv 1 0 0\nv 0 1 1e999\nf 1 2 3\n", "Vertex 2 has a coordinate"),
    ("i.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "face 1 refers to a vertex"),
    ("z.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 0 1 2\n", "face 2 refers to a vertex"),
    ("s.obj", "v 0 0 0\nv 0 0 0\nv 0 0 0\nf 3 2 1\n", "at the same place"),
    ("o.obj", "v 0 0 0\nv 2 0 0\nv 4 0 0\nf 1 2 3\n", "no area"), ("p.obj", "v 0 0 0\n", "no triangles"),
    ("l.obj", "v 0 0 0\nv 1 0 0\nl 1 2\nf 1 2\n", "no triangles"), ("x.obj", "v 0 0\nf 1 1 1\n", "not a valid OBJ"),
    ("t.stl", CUBE.export(file_type="stl")[:-30], "no triangles"),
])
def test_files_that_hold_no_solid_are_refused_in_a_sentence(name, text, words, tmp_path):
    with pytest.raises(Error, match=words) as error:
        Hierarchy.build(*meshes.read(save(tmp_path / name, text))[:4])
    assert "index out of" not in str(error.value) and str(error.value).endswith(".")


def threemf(unit, move):
    points = "".join('<vertex x="{}" y="{}" z="{}"/>'.format(*point) for point in ELL.vertices)
    corners = "".join('<triangle v1="{}" v2="{}" v3="{}"/>'.format(*triangle) for triangle in ELL.triangles)
    model = (f'<?xml version="1.0"?><model unit="{unit}" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">'
             f'<resources><object id="1" type="model"><mesh><vertices>{points}</vertices><triangles>{corners}</triangles>'
             f'</mesh></object></resources><build><item objectid="1" transform="1 0 0 0 1 0 0 0 1 {move} 0 0"/></build></model>')
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w") as archive:
        archive.writestr("3D/3dmodel.model", model)
    return data.getvalue()


# prusa3d/PrusaSlicer 15842 and 15545, Snapmaker/Luban 2077
@pytest.mark.parametrize("unit, length", [("millimeter", 1), ("inch", 25.4), ("foot", 304.8), ("micron", 0.001)])
def test_3mf_keeps_its_size_and_place(unit, length, tmp_path):
    source = save(tmp_path / "ell.3mf", threemf(unit, 5))
    mesh = meshes.read(source)
    assert mesh.vertices.min(axis=0) == pytest.approx([5 * length, 0, 0])
    assert volume(mesh) == pytest.approx(3 * length ** 3)
    if unit == "inch":
        assert run("parts", source, "-o", tmp_path / "out", "--parts", 2, "--formats", "3mf").returncode == 0
        reread = meshes.read(tmp_path / "out" / "ell.3mf")
        assert volume(reread) == pytest.approx(3 * length ** 3, rel=1e-5) and np.ptp(reread.vertices, axis=0).max() == pytest.approx(50.8)


def glb(primitives, points, nodes=({"mesh": 0},)):
    """primitives: [(mode, indices or None), ...]"""
    data, views, accessors = b"", [], []

    def add(array, **options):
        nonlocal data
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": array.nbytes})
        data += array.tobytes()
        accessors.append({"bufferView": len(views) - 1, "count": len(array), **options})
        return len(accessors) - 1

    points = np.array(points, np.float32)
    add(points, componentType=5126, type="VEC3", min=points.min(axis=0).tolist(), max=points.max(axis=0).tolist())
    parts = [{"attributes": {"POSITION": 0}, "mode": mode} | (
        {} if indices is None else {"indices": add(np.array(indices, np.uint32).ravel(), componentType=5125, type="SCALAR")})
        for mode, indices in primitives]
    tree = json.dumps({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}],
                       "nodes": nodes, "meshes": [{"name": "m", "primitives": parts}], "accessors": accessors,
                       "bufferViews": views, "buffers": [{"byteLength": len(data)}]}).encode()
    tree += b" " * (-len(tree) % 4)
    return (struct.pack("<III", 0x46546C67, 2, 28 + len(tree) + len(data)) + struct.pack("<II", len(tree), 0x4E4F534A) + tree
            + struct.pack("<II", len(data), 0x004E4942) + data)


# mikedh/trimesh 840, 1216, 831, 1440 and 1235, mmatl/pyrender 135, iory/scikit-robot 770
@pytest.mark.parametrize("primitives, nodes, expected", [
    ([(4, CUBE.faces[:6]), (4, CUBE.faces[6:])], [{"mesh": 0}], 1),
    ([(0, None), (4, CUBE.faces), (1, [0, 1])], [{"mesh": 0}], 1),
    ([(4, CUBE.faces)], [{"mesh": 0, "name": "x", "translation": [5, 0, 0]}, {"mesh": 0, "name": "x"},
                         {"mesh": 0, "name": "x", "translation": [-5, 0, 0], "scale": [-1, 2, 1]}], 4),
    ([(4, CUBE.faces)], [{"mesh": 0, "children": [1]}, {"mesh": 0, "translation": [0, 3, 0], "scale": [1, 1, -3]}], 4),
], ids=["two primitives", "points and lines beside", "instances of one name, one mirrored", "a child"])
def test_glb_scenes_are_read_whole(primitives, nodes, expected, tmp_path):
    data = glb(primitives, CUBE.vertices, nodes)
    if "children" in nodes[0]:
        data = data.replace(b'"nodes": [0, 1]', b'"nodes": [0]   ')
    assert volume(meshes.read(save(tmp_path / "scene.glb", data))) == pytest.approx(expected)


# mikedh/trimesh 2316
@pytest.mark.parametrize("rest", [[(4, CUBE.faces)], []], ids=["beside a cube", "alone"])
def test_a_primitive_without_positions_is_empty(rest, tmp_path):
    primitive = b'{"attributes": {"POSITION": 0}, "mode": 0}'
    data = glb([(0, None), *rest], CUBE.vertices)
    path = save(tmp_path / "empty.glb", data.replace(primitive, b'{"attributes": {}, "mode": 4}'.ljust(len(primitive))))
    assert path.read_bytes() != data
    if rest:
        assert volume(meshes.read(path)) == pytest.approx(1)
    else:
        with pytest.raises(meshes.MeshFileError, match="no triangles"):
            meshes.read(path)


TETRAHEDRON = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]


# mikedh/trimesh 2106, DiligentGraphics/DiligentFX 264
def test_no_primitive_of_a_glb_is_dropped_silently(tmp_path):
    strip = glb([(5, [0, 2, 1, 3, 0, 2])], TETRAHEDRON)
    assert volume(meshes.read(save(tmp_path / "strip.glb", strip))) == pytest.approx(1 / 6)
    fan = glb([(6, [3, 0, 1, 2, 0]), (4, [0, 2, 1])], TETRAHEDRON)
    with pytest.raises(meshes.MeshFileError, match="triangle fans.*Export"):
        meshes.read(save(tmp_path / "fan.glb", fan))


# ---- Files that are written


# openscad/openscad 766, slic3r/Slic3r 1718, prusa3d/PrusaSlicer 12176
@pytest.mark.parametrize("arguments, name", [
    (["build"], "saved"), (["parts", "--formats", "glb"], "ell.glb"), (["parts", "--formats", "ply"], "ell.ply"),
    (["convex", "--formats", "obj"], "ell_hulls.obj"), (["convex", "--formats", "usd"], "ell.usda"),
    (["convex", "--formats", "mjcf"], "ell_hulls/00.obj"),
])
def test_a_full_disk_leaves_no_file_cut_short(arguments, name, tmp_path):
    model = save(tmp_path / "ell.off", off(ELL.vertices, ELL.triangles))
    folder = tmp_path / "out"
    folder.mkdir()
    output = folder / name if arguments == ["build"] else folder
    result = run(*arguments, model, "-o", output, limit=100)
    assert result.returncode == 2 and str(folder / name) in result.stderr and "Traceback" not in result.stderr
    assert not (folder / name).exists()


def test_an_impossible_folder_is_reported(tmp_path):
    model = save(tmp_path / "ell.off", off(ELL.vertices, ELL.triangles))
    for command, output in (("build", tmp_path / "none" / "saved"), ("parts", model), ("convex", model / "in")):
        result = run(command, model, "-o", output)
        assert result.returncode == 2 and str(output) in result.stderr and "Traceback" not in result.stderr


# ksami/QRemeshify 2, Roblox/roblox-blender-plugin 67, mattedicksoncom/blender-xatlas 13, rlguy/Blender-FLIP-Fluids 462,
# serhatadik/OpenGERT 1, assimp/assimp 3479
@pytest.mark.parametrize("name", ["\u96f6\u4ef6 \u00e4", "Test-Test 10x20x30mm [1234]", "q\"&<x>'*|?:#%", "-dash", "a..b", ".dot"])
def test_any_name_of_a_file(name, tmp_path):
    model = save(tmp_path / f"{name}.off", off(ELL.vertices, ELL.triangles))
    folder = tmp_path / f"out {name}"
    for command, formats in ("parts", "glb,3mf,stl,ply"), ("convex", "obj,glb,unreal,godot,urdf,mjcf,usd"):
        result = run(command, "-o", folder, "--formats", formats, "--json", "--", model)
        assert result.returncode == 0, result.stderr
        files = json.loads(result.stdout)["files"]
        assert all(os.path.dirname(file).startswith(str(folder)) and os.path.getsize(file) for file in files)
    for file in files:
        if file.endswith(".xml"):
            assert mujoco.MjModel.from_xml_path(file).nbody == 2
    assert volume(meshes.read(folder / f"{name}.glb")) == pytest.approx(3)


# ---- Sizes and shapes


@pytest.mark.parametrize("scale", [1e-300, 1e300])
def test_sizes_beyond_floating_point_are_refused(scale):
    with pytest.raises(Error, match="too small|too large"):
        Hierarchy.build(ELL.vertices * scale, *ELL[1:])


# google-deepmind/mujoco 759, Genesis-Embodied-AI/genesis-world 1392
@pytest.mark.parametrize("scale", [1, 0.01, 0.001])
def test_simulators_load_small_bodies(scale, tmp_path):
    model = save(tmp_path / "ell.off", off(ELL.vertices * scale, ELL.triangles))
    assert run("convex", model, "-o", tmp_path, "--formats", "mjcf", "--hulls", 2).returncode == 0
    mass = mujoco.MjModel.from_xml_path(str(tmp_path / "ell.xml")).body_mass[1]
    assert mass == pytest.approx(3 * 1000 * scale ** 3, rel=1e-6)


# google-deepmind/mujoco 3260
def test_a_flat_mesh_is_thickened_or_refused(tmp_path):
    model = save(tmp_path / "flat.obj", "v -5 -5 0\nv 5 -5 0\nv -5 5 0\nv 5 5 0\nf 1 2 3\nf 2 4 3\n")
    refused = run("convex", model, "-o", tmp_path, "--formats", "mjcf", "--no-open-surfaces")
    assert refused.returncode == 1 and "Solidify" in refused.stderr
    assert run("convex", model, "-o", tmp_path, "--formats", "mjcf", "--hulls", 1).returncode == 0
    assert mujoco.MjModel.from_xml_path(str(tmp_path / "flat.xml")).nmesh == 2  # the model and its hull


# kmammou/v-hacd 149, dimforge/ncollide 191 and 346
@pytest.mark.parametrize("requested", [1, 2, 16, 1000])
def test_no_more_hulls_than_gain_something(requested, tmp_path):
    vertices, triangles = ELL.vertices[ELL.triangles].reshape(-1, 3), np.arange(3 * len(ELL.triangles)).reshape(-1, 3)
    model = tmp_path / "ell.stl"
    trimesh.Trimesh(vertices, triangles, process=False).export(model)
    hulls = Hierarchy.build(*meshes.read(model)[:4]).convex_parts(requested)
    volumes = [trimesh.Trimesh(*hull[:2]).volume for hull in hulls]
    assert len(hulls) <= min(requested, 4) and all(volume > 0 for volume in volumes)
    assert sum(volumes) == pytest.approx(3.5 if requested == 1 else 3)


# kmammou/v-hacd 147
@pytest.mark.parametrize("options", [{"hulls": 1}, {"hulls": 2}, {"hulls": 4}, {"hulls": 16}, {"error": 0.01}], ids=str)
def test_a_flat_quad_is_one_hull(options):
    corners = np.array([(-5, -5, 0), (5, -5, 0), (5, 5, 0), (-5, 5, 0)], float)
    assert len(Hierarchy.build(corners, [(0, 1, 2), (0, 2, 3)]).convex_parts(**options)) == 1


# prusa3d/PrusaSlicer 11740 and 12509, OrcaSlicer/OrcaSlicer 10880
@pytest.mark.parametrize("parts", [1, 2, 5, 10 ** 6])
def test_every_part_is_closed_and_they_make_the_whole(parts):
    shape = shapes.polycube([(x, y, 0) for x in range(3) for y in range(3) if (x, y) != (1, 1)] + [(0, 0, 1)])
    cut = Cut.into(Hierarchy.build(*shape), parts)
    solids = [trimesh.Trimesh(*solid[:2], process=False) for solid in cut.solids() if solid is not None]
    assert all(solid.is_watertight and solid.is_winding_consistent for solid in solids)
    assert sum(solid.volume for solid in solids) == pytest.approx(9) and len(cut) <= len(shape.triangles)


# prusa3d/PrusaSlicer 14462 and 14840, OrcaSlicer/OrcaSlicer 4985
def test_pegs_belong_to_their_part(tmp_path):
    dumbbell = shapes.polycube([(x, y, z) for x in range(9) for y in range(3) for z in range(3)
                                if x < 3 or x > 5 or (y, z) == (1, 1)])
    model = save(tmp_path / "dumbbell.off", off(dumbbell.vertices * 10, dumbbell.triangles))
    result = run("parts", model, "-o", tmp_path / "out", "--parts", 3, "--pegs", 0.2, "--formats", "stl", "--json")
    report = json.loads(result.stdout)
    solids = [trimesh.load(file) for file in report["files"] if file.endswith(".stl")]
    assert len(solids) == report["parts"] and all(solid.is_watertight and solid.body_count == 1 for solid in solids)
    assert sum(solid.volume for solid in solids) == pytest.approx(57000, rel=0.05)


# danielboxer/UVgami 5 and 10, leukbaars/DreamUV 27
@pytest.mark.parametrize("move", [0, 6, 1e6])
def test_low_poly_shells_get_seams(move):
    shape = shapes.merged(*(shapes.Shape(np.array(TETRAHEDRON, float) + (3 * i + move, move, 0),
                                         np.array([(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)], np.int32),
                                         np.arange(4, dtype=np.int32), 4) for i in range(8)))
    cut = Cut.automatic(Hierarchy.build(*shape))
    assert len(seams(*shape, cut))
