# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts keep how the model looks: materials, textures, texture coordinates, colors, names. Read back by trimesh, Pillow and
lib3mf, and compared with the source at points of the surface and in pictures."""

import json
import re
import struct
from pathlib import Path

import numpy as np
import pytest
import rendering
import trimesh
from conftest import ROOT
from partwheel import meshes
from partwheel.appearance import from_bytes, to_bytes
from scipy.spatial.transform import Rotation
from test_command_line import run

KNIGHT = ROOT.parent / "shared" / "assets" / "files" / "Knight.glb"
SHARPNESS = 64  # texels of a side


def dumbbell():
    """Two balls and a rod that pass into each other without seams: one closed surface with obvious parts."""
    ball = trimesh.creation.icosphere(3)
    points = ball.vertices * (3, 1, 1)
    radius = np.where(abs(points[:, 0]) < 1.2, 0.35, 1.0)
    return trimesh.Trimesh(points * np.column_stack([np.ones(len(points)), radius, radius]), ball.faces, process=False)


def texture(seed=0):
    """Smooth, so that neighboring texels differ little, and different everywhere."""
    y, x = np.mgrid[:SHARPNESS, :SHARPNESS] / SHARPNESS
    waves = [np.sin(2 * np.pi * (x + seed / 3)), np.cos(2 * np.pi * y), np.sin(2 * np.pi * (x + y))]
    return np.round(127 + 120 * np.stack(waves, axis=-1)).astype(np.uint8)


def side_coordinates(points):
    """(n, 2) texture coordinates: from the side, so that no triangle spans a seam."""
    return (points[:, :2] - points[:, :2].min(axis=0)) / np.ptp(points[:, :2], axis=0) * 0.9 + 0.05


def glb(tree, arrays, images=()):
    """A GLB file, written by hand. arrays : accessors by number; images : bytes"""
    data, views, accessors = b"", [], []
    for array in arrays:
        kind = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}[array.shape[1] if array.ndim > 1 else 1]
        component = {"float32": 5126, "uint32": 5125, "uint16": 5123, "uint8": 5121}[array.dtype.name]
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": array.nbytes})
        accessors.append({"bufferView": len(views) - 1, "componentType": component, "count": len(array), "type": kind})
        if array.dtype.name in ("uint8", "uint16"):
            accessors[-1]["normalized"] = True
        if kind == "VEC3":
            accessors[-1].update(min=array.min(axis=0).tolist(), max=array.max(axis=0).tolist())
        data += array.tobytes() + bytes(-array.nbytes % 4)
    for number, image in enumerate(images):
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(image)})
        tree["images"][number]["bufferView"] = len(views) - 1
        data += image + bytes(-len(image) % 4)
    tree.update(asset={"version": "2.0"}, scene=0, accessors=accessors, bufferViews=views, buffers=[{"byteLength": len(data)}])
    text = json.dumps(tree).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


PAINT = {"name": "Paint", "doubleSided": True, "pbrMetallicRoughness": {
    "baseColorTexture": {"index": 0}, "metallicFactor": 0.25, "roughnessFactor": 0.75},
    "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 0.5}}}
RED = {"name": "Red", "pbrMetallicRoughness": {"baseColorFactor": [0.75, 0.125, 0.0, 1.0], "metallicFactor": 0.0}}


def write_textured(path):
    """A node "Body" with two primitives: the right half is painted, the left one red; a node "Hat" above it, moved, turned
    inside out by a mirror and back by its winding, with its own picture and colors."""
    body, hat = dumbbell(), trimesh.creation.icosphere(2)
    points, uv = body.vertices.astype(np.float32), side_coordinates(body.vertices).astype(np.float32)
    is_right = body.triangles_center[:, 0] > 0
    colors = np.round(127 + 127 * hat.vertices).astype(np.uint8)
    arrays = [points, uv, body.vertex_normals.astype(np.float32), body.faces[is_right].astype(np.uint32).ravel(),
              body.faces[~is_right].astype(np.uint32).ravel(), hat.vertices.astype(np.float32),
              side_coordinates(hat.vertices).astype(np.float32), np.column_stack([colors, np.full(len(colors), 255, np.uint8)]),
              hat.faces[:, ::-1].astype(np.uint32).ravel()]
    attributes = {"POSITION": 0, "TEXCOORD_0": 1, "NORMAL": 2}
    tree = {
        "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"name": "Body", "mesh": 0}, {"name": "Hat", "mesh": 1, "translation": [0, 3, 0], "scale": [-1, 1, 1]}],
        "meshes": [{"name": "m", "primitives": [{"attributes": attributes, "indices": 3, "material": 0},
                                                {"attributes": attributes, "indices": 4, "material": 1}]},
                   {"name": "m", "primitives": [{"attributes": {"POSITION": 5, "TEXCOORD_0": 6, "COLOR_0": 7}, "indices": 8,
                                                 "material": 2}]}],
        "materials": [PAINT, RED, {"name": "Felt", "pbrMetallicRoughness": {"baseColorTexture": {"index": 1}}}],
        "textures": [{"source": 0, "sampler": 0}, {"source": 1}], "samplers": [{"magFilter": 9728, "wrapS": 33071}],
        "images": [{"mimeType": "image/png", "name": "paint"}, {"mimeType": "image/png", "name": "felt"}],
        "extensionsUsed": ["KHR_materials_clearcoat"]}
    images = [rendering.png(texture()), rendering.png(texture(1))]
    path.write_bytes(glb(tree, arrays, images))
    return images


def write_two_materials(path):
    """An OBJ file with quads, negative indices, two materials, one with a picture, and a material file with words of its own."""
    body = dumbbell()
    uv = side_coordinates(body.vertices)
    (path.parent / "paint picture.png").write_bytes(rendering.png(texture()))
    (path.parent / "colors.mtl").write_text("newmtl Paint\nKd 1 1 1\nNs 96.5\nillum 2\nmap_Kd paint picture.png\n\n"
                                            "newmtl Red\nKd 0.75 0.125 0\nd 1\n")
    lines = ["mtllib colors.mtl", "o Body", *("v {} {} {}".format(*point) for point in body.vertices),
             *("vt {} {}".format(*point) for point in uv)]
    is_right = body.triangles_center[:, 0] > 0
    count = len(body.vertices)
    for name, faces in (("Paint", body.faces[is_right] + 1), ("Red", body.faces[~is_right] - count)):
        lines += [f"usemtl {name}", *("f {0}/{0} {1}/{1} {2}/{2}".format(*face) for face in faces)]
    path.write_text("\n".join(lines))
    return [(path.parent / "paint picture.png").read_bytes()]


def write_colored(path):
    body = dumbbell()
    colors = np.round(127 + 120 * np.sin(body.vertices * (2, 3, 3))).astype(np.uint8)
    trimesh.Trimesh(body.vertices, body.faces, vertex_colors=colors, process=False).export(path)
    return []


def write_textured_ply(path):
    """Texture coordinates of vertices, as photogrammetry programs write them."""
    body = dumbbell()
    mesh = trimesh.Trimesh(body.vertices, body.faces, process=False)
    mesh.vertex_attributes["s"], mesh.vertex_attributes["t"] = side_coordinates(body.vertices).astype(np.float32).T.copy()
    data = mesh.export(file_type="ply", include_attributes=True)
    path.write_bytes(data.replace(b"element vertex", b"comment TextureFile scan.png\nelement vertex", 1))
    (path.parent / "scan.png").write_bytes(rendering.png(texture()))
    return [(path.parent / "scan.png").read_bytes()]


WRITERS = {"textured.glb": write_textured, "two.obj": write_two_materials, "colored.ply": write_colored, "scan.ply": write_textured_ply}


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """{model: (its file, its images, folder of its parts, report)}, each made when it is needed"""
    class Results(dict):
        def __missing__(self, name):
            folder = tmp_path_factory.mktemp(name.replace(".", "_"))
            images = WRITERS[name](folder / name)
            result = run("parts", folder / name, "-o", folder / "out", "--parts", 4, "--formats", "glb,obj,ply,3mf", "--json")
            assert result.returncode == 0, result.stderr + result.stdout
            self[name] = folder / name, images, folder / "out", json.loads(result.stdout)
            return self[name]
    return Results()


def sample(surfaces, count=300):
    """(surface, triangles (n,), weights (n, 3), points (n, 3)), evenly on each surface, without those of caps."""
    random = np.random.default_rng(5)
    for surface in surfaces:
        if (surface.material or "").replace("_", " ") == "Partwheel Cap":
            continue
        areas = np.linalg.norm(np.cross(*(surface.corners[:, k] - surface.corners[:, 0] for k in (1, 2))), axis=1)
        triangles = random.choice(len(areas), count, p=areas / areas.sum())
        weights = random.dirichlet((1, 1, 1), count)
        yield surface, triangles, weights, np.einsum("nc,nck->nk", weights, surface.corners[triangles])


def source_colors(source, points):
    """(colors (n, 3), uv (n, 2) or nan, distance (n,)) of the nearest points of the source."""
    best = np.full(len(points), np.inf)
    colors, coordinates = np.zeros((len(points), 3)), np.full((len(points), 2), np.nan)
    for surface in source:
        nearest, distance, triangle = trimesh.proximity.closest_point_naive(
            trimesh.Trimesh(surface.corners.reshape(-1, 3), np.arange(3 * len(surface.corners)).reshape(-1, 3), process=False), points)
        weights = trimesh.triangles.points_to_barycentric(surface.corners[triangle], nearest)
        is_nearer = distance < best
        best[is_nearer] = distance[is_nearer]
        colors[is_nearer] = surface.color_at(triangle, weights)[is_nearer]
        if surface.uv is not None:
            coordinates[is_nearer] = np.einsum("nc,nck->nk", weights, surface.uv[triangle])[is_nearer]
    return colors, coordinates, best


@pytest.mark.parametrize("form", ["glb", "obj"])
@pytest.mark.parametrize("name", WRITERS)
def test_points_of_the_parts_have_the_colors_of_the_source(results, name, form):
    path, _, folder, _ = results[name]
    source = rendering.load(path)
    for surface, triangles, weights, points in sample(rendering.load(folder / f"{path.stem}.{form}")):
        colors, coordinates, distance = source_colors(source, points)
        own, is_surface = surface.color_at(triangles, weights), distance < 1e-5
        assert is_surface.all() or (name == "colored.ply" and is_surface.sum() > 30)  # there, caps have no material
        own, colors = own[is_surface], colors[is_surface]
        if name == "colored.ply" and form == "glb":  # glTF's colors are linear
            own = to_bytes(np.column_stack([own, np.ones(len(own))]))[:, :3] / 255
        # A texel is 1 / 64 of a side of a picture with waves of amplitude 120 of 255. Colors of vertices are linear light in
        # glTF, and so is what is between them.
        assert np.percentile(abs(own - colors), 99) < (2 * np.pi * 120 / 255 / SHARPNESS if name != "colored.ply" else 0.06)
        if surface.image is not None:
            uv = np.einsum("nc,nck->nk", weights, surface.uv[triangles])
            assert abs(uv - coordinates).max() < 1e-3


def linear_to_srgb(surface):
    """The surface with its colors in sRGB; glTF's are linear."""
    def convert(colors):
        return None if colors is None else to_bytes(np.concatenate([colors, np.ones((*colors.shape[:-1], 1))], axis=-1))[..., :3] / 255
    return surface._replace(color=convert(surface.color), colors=convert(surface.colors))


@pytest.mark.parametrize("form", ["glb", "obj"])
@pytest.mark.parametrize("name", WRITERS)
def test_pictures_of_the_parts_are_those_of_the_source(results, name, form):
    path, _, folder, _ = results[name]
    source, parts = rendering.load(path), rendering.load(folder / f"{path.stem}.{form}")
    if name == "colored.ply" and form == "glb":
        parts = list(map(linear_to_srgb, parts))
    # Between two materials, rounding decides which one a pixel shows.
    assert rendering.difference(source, parts, 0.02 if name != "colored.ply" else 0.06) < 0.02


def test_pieces_for_a_printer_keep_their_look(tmp_path):
    write_textured(tmp_path / "model.glb")
    source = rendering.load(tmp_path / "model.glb")
    size = np.ptp(np.vstack([surface.corners.reshape(-1, 3) for surface in source]), axis=0).max()
    result = run("parts", tmp_path / "model.glb", "-o", tmp_path / "out", "--parts", 4, "--pegs", 0.2, "--size", 60, "--formats", "glb")
    assert result.returncode == 0 and "Joints: none" not in result.stdout, result.stderr + result.stdout
    pieces = rendering.load(tmp_path / "out" / "model.glb")
    assert {"Partwheel Cap", "Paint", "Red"} <= {piece.material for piece in pieces}
    for surface, triangles, weights, points in sample(pieces, 100):
        colors, _, distance = source_colors(source, points * size / 60)
        assert distance.max() < 1e-4 and np.percentile(abs(surface.color_at(triangles, weights) - colors), 95) < 0.1


@pytest.mark.parametrize("name", ["textured.glb", "two.obj", "colored.ply"])
def test_models_in_files_for_engines_keep_their_look(name, tmp_path):
    path, stem = tmp_path / name, name.split(".")[0]
    WRITERS[name](path)
    result = run("convex", path, "-o", tmp_path / "out", "--hulls", 2, "--formats", "unreal,godot,urdf")
    assert result.returncode == 0, result.stderr
    for file in (f"{stem}_unreal.glb", f"{stem}_godot.glb", f"{stem}_hulls/model.obj"):
        model = [surface for surface in rendering.load(tmp_path / "out" / file) if not re.search("UCX|convcol", surface.name)]
        if name == "colored.ply" and file.endswith("glb"):
            model = [linear_to_srgb(surface) for surface in model]
        assert rendering.difference(rendering.load(path), model, 0.02 if name != "colored.ply" else 0.06) < 0.02


def test_mujoco_shows_the_textures(tmp_path, mujoco):
    write_textured(tmp_path / "model.glb")
    result = run("convex", tmp_path / "model.glb", "-o", tmp_path / "out", "--hulls", 2, "--formats", "mjcf")
    assert result.returncode == 0, result.stderr
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "out" / "model.xml"))
    shown = [mujoco_surface(model, geom) for geom in np.flatnonzero(model.geom_group == 2)]
    source = [linear_to_srgb(surface._replace(colors=None)) for surface in rendering.load(tmp_path / "model.glb")]  # no colors of vertices
    assert len(shown) == 3 and rendering.difference(source, shown, 0.02) < 0.02


def mujoco_surface(model, geom):
    """What MuJoCo shows of a geom with a mesh, in the coordinates of its body."""
    mesh, material = model.geom_dataid[geom], model.geom_matid[geom]
    vertices, faces, places = (model.mesh_vertadr[mesh], model.mesh_faceadr[mesh], model.mesh_texcoordadr[mesh])
    triangles = slice(faces, faces + model.mesh_facenum[mesh])
    turn = Rotation.from_quat(np.roll(model.geom_quat[geom], -1)).as_matrix()
    corners = model.mesh_vert[vertices:][model.mesh_face[triangles]] @ turn.T + model.geom_pos[geom]
    texture, uv, image = model.mat_texid[material].max(), None, None
    if texture >= 0:
        height, width, channels = (int(array[texture]) for array in (model.tex_height, model.tex_width, model.tex_nchannel))
        start = model.tex_adr[texture]
        image = model.tex_data[start:start + height * width * channels].reshape(height, width, channels)[:, :, :3]
        uv = model.mesh_texcoord[places:][model.mesh_facetexcoord[triangles]] * (1, -1) + (0, 1)  # OpenGL's first row is at v = 0
    return rendering.Surface("", corners, uv, image, model.mat_rgba[material][:3], None, None)


def read_glb(path):
    data = path.read_bytes()
    length, = struct.unpack_from("<I", data, 12)
    return json.loads(data[20:20 + length]), data[28 + length:]


def test_materials_and_images_are_the_same_bytes(results):
    _, images, folder, report = results["textured.glb"]
    tree, data = read_glb(folder / "textured.glb")
    assert tree["materials"][:2] == [PAINT, RED] and tree["extensionsUsed"] == ["KHR_materials_clearcoat"]
    assert tree["materials"][3]["name"] == "Partwheel Cap" and tree["samplers"] == [{"magFilter": 9728, "wrapS": 33071}]
    views = [tree["bufferViews"][image["bufferView"]] for image in tree["images"]]
    assert [data[view["byteOffset"]:view["byteOffset"] + view["byteLength"]] for view in views] == images
    assert [(folder / name).read_bytes() for name in ("paint.png", "felt.png")] == images
    assert report["dropped"] == [] and report["dropped_by_format"]["glb"] == []
    _, images, folder, _ = results["two.obj"]
    assert (folder / "paint picture.png").read_bytes() == images[0]
    lines = (folder / "two.mtl").read_text().splitlines()
    assert lines[:6] == ["newmtl Paint", "Kd 1 1 1", "Ns 96.5", "illum 2", "map_Kd paint picture.png", ""]


def test_parts_have_the_names_of_nodes_and_materials(results):
    def names(model):
        report = json.loads(results[model][2].joinpath(f"{Path(model).stem}.json").read_text())
        return {re.split(r"\.[LR\d]", part["name"])[0] for part in report["parts"]}
    assert names("textured.glb") == {"Body", "Hat"}
    assert names("two.obj") == {"Paint", "Red"}  # one object, two materials
    assert names("colored.ply") <= {f"Part {number}" for number in range(1, 5)}


def test_normals_are_kept_and_meshes_closed(results):
    tree, data = read_glb(results["textured.glb"][2] / "textured.glb")
    body = dumbbell()
    for mesh in tree["meshes"]:
        corners = []
        for primitive in mesh["primitives"]:
            arrays = {}
            for name, number in {**primitive["attributes"], "INDEX": primitive["indices"]}.items():
                accessor = tree["accessors"][number]
                view = tree["bufferViews"][accessor["bufferView"]]
                kind = np.float32 if accessor["componentType"] == 5126 else np.uint32
                arrays[name] = np.frombuffer(data, kind, view["byteLength"] // 4, view["byteOffset"]).reshape(accessor["count"], -1)
            corners.append(arrays["POSITION"][arrays["INDEX"].ravel()])
            assert np.allclose(np.linalg.norm(arrays["NORMAL"], axis=1), 1, atol=1e-5)
            if primitive["material"] < 2:
                distance, vertex = trimesh.proximity.ProximityQuery(body).vertex(arrays["POSITION"])
                is_vertex = distance < 1e-6
                assert is_vertex.sum() > 20 and abs(arrays["NORMAL"] - body.vertex_normals[vertex])[is_vertex].max() < 1e-5
        points, index = np.unique(np.vstack(corners), axis=0, return_inverse=True)
        assert trimesh.Trimesh(points, index.reshape(-1, 3), process=False).is_watertight


def test_ply_has_colors_and_texture_coordinates(results):
    path, _, folder, _ = results["colored.ply"]
    vertices = trimesh.load(folder / "colored.ply", process=False).metadata["_ply_raw"]["vertex"]["data"]
    source = trimesh.load(path, process=False)
    for column, name in enumerate(("red", "green", "blue")):
        assert np.array_equal(np.ravel(vertices[name]), source.visual.vertex_colors[:, column])
    path, images, folder, _ = results["scan.ply"]
    result = trimesh.load(folder / "scan.ply", process=False, fix_texture=True)
    assert b"comment TextureFile scan.png\n" in (folder / "scan.ply").read_bytes() and (folder / "scan.png").read_bytes() == images[0]
    assert abs(result.visual.uv[result.faces] - side_coordinates(dumbbell().vertices)[dumbbell().faces]).max() < 1e-6
    # What is written can be read: the same appearance, and so on for ever.
    again = meshes.read(folder / "scan.ply")
    assert np.allclose(again.appearance.attributes["TEXCOORD_0"], meshes.read(path).appearance.attributes["TEXCOORD_0"], atol=1e-6)


def test_3mf_has_names_and_colors(results):
    lib3mf = pytest.importorskip("lib3mf", reason="pip install lib3mf")
    for name in WRITERS:
        path, _, folder, _ = results[name]
        source = rendering.load(path)
        model = lib3mf.get_wrapper().CreateModel()
        reader = model.QueryReader("3mf")
        reader.ReadFromFile(str(folder / f"{path.stem}.3mf"))
        # 32935: an attribute that plain files of trimesh have, too
        assert {reader.GetWarning(number)[0] for number in range(reader.GetWarningCount())} <= {32935}
        objects, names, points, colors = model.GetMeshObjects(), [], [], []
        while objects.MoveNext():
            mesh = objects.GetCurrentMeshObject()
            names.append(mesh.GetName())
            assert mesh.IsManifoldAndOriented() and mesh.GetObjectLevelProperty()[2]
            vertices = np.array([list(vertex.Coordinates) for vertex in mesh.GetVertices()])
            triangles = np.array([list(triangle.Indices) for triangle in mesh.GetTriangleIndices()])
            properties = mesh.GetAllTriangleProperties()
            groups = {}
            for corners, row in zip(vertices[triangles], properties):
                if row.ResourceID not in groups:
                    groups[row.ResourceID] = model.GetColorGroupByID(row.ResourceID)
                found = [groups[row.ResourceID].GetColor(number) for number in row.PropertyIDs]
                points.append(corners.mean(axis=0))
                colors.append(np.mean([(color.Red, color.Green, color.Blue) for color in found], axis=0))
        expected, _, distance = source_colors(source, np.array(points))
        is_surface = distance < 1e-4
        assert is_surface.sum() > 500
        if name in ("scan.ply", "colored.ply"):  # the others have factors in linear light
            difference = abs(np.array(colors) / 255 - expected)[is_surface]
            assert np.percentile(difference, 90) < 0.1 and np.median(difference) < 0.03
        assert set(names) == {part["name"] for part in json.loads((folder / f"{path.stem}.json").read_text())["parts"]}


def test_colors_in_bytes_stay_the_same():
    colors = np.arange(256, dtype=np.uint8)[:, None].repeat(4, axis=1)
    assert np.array_equal(to_bytes(from_bytes(colors)), colors)


def test_losses_are_announced_before_the_work(tmp_path):
    write_textured(tmp_path / "model.glb")
    result = run("parts", tmp_path / "model.glb", "-o", tmp_path / "out", "--formats", "stl,glb")
    lines = result.stdout.splitlines()
    assert result.returncode == 0 and lines[0] == "Not in stl files: texture coordinates, textures, materials and colors."
    assert {path.name for path in (tmp_path / "out").glob("*.stl")} >= {"Hat.stl"}


@pytest.mark.skipif(not KNIGHT.exists(), reason="the assets are not here")
def test_a_knight_keeps_its_look(tmp_path):
    result = run("parts", KNIGHT, "-o", tmp_path, "--parts", 30, "--formats", "glb")
    assert result.returncode == 0, result.stderr
    # The cape is an open shell, which becomes a closed one: it hides its inside.
    source, parts = ([surface for surface in rendering.load(path) if not surface.name.startswith("Knight_Cape")]
                     for path in (KNIGHT, tmp_path / "Knight.glb"))
    assert rendering.difference(source, parts, 0.04) < 0.04
    names = {re.split(r"\.\d", part["name"])[0] for part in json.loads((tmp_path / "Knight.json").read_text())["parts"]}
    assert names >= {"Knight_Helmet", "Knight_Head", "Knight_Body", "Knight_ArmLeft", "Knight_LegRight", "1H_Sword"}
