# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading mesh files: nothing merged, polygons kept, corners welded only where a format keeps them apart."""

import base64
import json
import os
import struct
import subprocess
import sys

import numpy as np
import pytest
import shapes
import trimesh
from conftest import PACKAGES
from partwheel import Hierarchy, meshes, polygons


def test_off_keeps_polygons_and_vertices(tmp_path):
    path = tmp_path / "house.off"
    path.write_text("# a pentagon prism, with comments\nOFF # here too\n10 7 0\n" + "\n".join(
        f"{x} {y} {z} 255 0 0" for z in (0, 1) for x, y in ((0, 0), (2, 0), (2, 2), (1, 1), (0, 2)))
        + "\n5 4 3 2 1 0\n5 5 6 7 8 9 0.5 0.5 0.5\n"
        + "\n".join(f"4 {i} {(i + 1) % 5} {5 + (i + 1) % 5} {5 + i}" for i in range(5)) + "\n")
    mesh = meshes.read(path)
    assert mesh.face_count == 7 and np.bincount(mesh.faces).tolist() == [3, 3, 2, 2, 2, 2, 2] and mesh.welded == 0
    h = Hierarchy.build(*mesh[:4])
    assert len(h.order) == 7 and h.summary.volume == pytest.approx(3.0)  # the roof's notch is not filled


def test_counts_on_the_first_line_and_other_headers(tmp_path):
    points = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n"
    for header in ("OFF 4 4 0\n", "OFF\n4 4 0\n\n", "COFF\n4 4 6\n", "off\n4 4\n"):
        (tmp_path / "t.off").write_text(header + points)
        assert meshes.read(tmp_path / "t.off").triangles.shape == (4, 3)


def test_equal_vertices_stay_apart_in_off(tmp_path):
    (tmp_path / "t.off").write_text("OFF\n6 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 5 4 3\n")
    assert len(meshes.read(tmp_path / "t.off").vertices) == 6


@pytest.mark.parametrize("suffix", ["stl", "ply", "obj", "glb"])
def test_other_formats_through_trimesh(suffix, tmp_path, build_shape):
    shape, h = build_shape("hand.off")
    path = tmp_path / f"hand.{suffix}"
    trimesh.Trimesh(shape.vertices, shape.triangles, process=False).export(path)
    mesh = meshes.read(path)
    assert len(mesh.vertices) == len(shape.vertices) and len(mesh.triangles) == len(shape.triangles)
    assert (mesh.welded > 0) == (suffix == "stl")
    # The coordinates were rounded on the way, so only the volume must be the same.
    assert Hierarchy.build(*mesh[:4]).summary.volume == pytest.approx(h.summary.volume, rel=1e-5)


POINTS = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
TETRAHEDRON = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]


def corners(vertices, triangles):
    """The triangles as a set of points, each turned so that its least point is first: whatever the order in a file."""
    points = [[tuple(vertices[corner]) for corner in triangle] for triangle in triangles]
    return {tuple(triangle[triangle.index(min(triangle)):] + triangle[:triangle.index(min(triangle))])
            for triangle in points}


def ply(form, elements, *values):
    """A file with the tetrahedron's points and more elements; values: (format for numpy, numbers)."""
    header = ["ply", f"format {form} 1.0", "comment TextureFile skin.png", "element vertex 4",
              *(f"property float {axis}" for axis in "xyz"), *elements, "end_header", ""]
    rows = [*(("f4", point) for point in POINTS), *values]
    if form == "ascii":
        body = "".join(" ".join(map(str, row)) + "\n" for _, row in rows).encode()
    else:
        order = {"binary_little_endian": "<", "binary_big_endian": ">"}[form]
        body = b"".join(np.array(row, order + kind).tobytes() for kind, row in rows)
    return "\n".join(header).encode() + body


def test_textures_are_not_looked_at(tmp_path):
    """Python's package for pictures may be missing, and so may the pictures, or be none."""
    seams = "".join(f"f {' '.join(f'{corner + 1}/{side + 1}' for corner in triangle)}\n"
                    for side, triangle in enumerate(TETRAHEDRON))
    points = "".join(f"v {x} {y} {z}\n" for x, y, z in POINTS)
    model = f"{points}vt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\nusemtl skin\n{seams}"
    (tmp_path / "skin.mtl").write_text("newmtl skin\nKd 1 1 1\nmap_Kd skin.png\n")
    (tmp_path / "skin.png").write_bytes(b"\x89PNG\r\n\x1a\n")
    (tmp_path / "a.obj").write_text(f"mtllib skin.mtl\n{model}")
    (tmp_path / "b.obj").write_text(f"mtllib missing.mtl\n{model}")
    (tmp_path / "c.obj").write_text(model)
    (tmp_path / "d.ply").write_bytes(ply(
        "ascii", ["element face 4", "property list uchar int vertex_indices", "property list uchar float texcoord"],
        *((None, (3, *triangle, 6, *range(6 * side, 6 * side + 6))) for side, triangle in enumerate(TETRAHEDRON))))
    (tmp_path / "PIL.py").write_text("raise ImportError('none here')")
    script = ("import json, sys\nfrom partwheel import meshes\n"
              "for path in sys.argv[1:]:\n"
              "    mesh = meshes.read(path)\n"
              "    print(json.dumps([mesh.vertices.tolist(), mesh.triangles.tolist()]))")
    files = sorted([*tmp_path.glob("*.obj"), *tmp_path.glob("*.ply")])
    run = subprocess.run([sys.executable, "-c", script, *files], capture_output=True, text=True,
                         env={**os.environ, "PYTHONPATH": os.pathsep.join([str(tmp_path), PACKAGES])})
    assert run.returncode == 0, run.stderr
    for file, line in zip(files, run.stdout.splitlines(), strict=True):
        vertices, triangles = json.loads(line)
        assert len(vertices) == 4 and corners(vertices, triangles) == corners(POINTS, TETRAHEDRON), file


STANFORD = [[0, 2, 1, 3, -1, 2, 0, 3, -1]]
SEVERAL = [[0, 2, 1, 3], [2, 0, 3, 3]]  # with a triangle that is none


@pytest.mark.parametrize(("form", "strips"), [
    ("ascii", STANFORD), ("binary_little_endian", STANFORD), ("binary_big_endian", STANFORD), ("ascii", SEVERAL),
    ("binary_little_endian", SEVERAL), ("ascii", [[0, 2, 1, 3], [2, 0, 3]])])
def test_ply_with_strips_of_triangles(form, strips, tmp_path):
    path = tmp_path / "strips.ply"
    path.write_bytes(ply(form, [f"element tristrips {len(strips)}", "property list int int vertex_indices"],
                         *(("i4", [len(strip), *strip]) for strip in strips)))
    mesh = meshes.read(path)
    triangles = [(0, 2, 1), (1, 2, 3), (2, 0, 3)]
    assert len(mesh.triangles) == 3 and corners(mesh.vertices, mesh.triangles) == corners(POINTS, triangles)


PYRAMID = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 0.5, 1), (0, 0, -1), (1, 0, -1), (1, 1, -1), (0, 1, -1)]
SIDES = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]
BOX = [[0, 5, 6, 1], [1, 6, 7, 2], [2, 7, 8, 3], [3, 8, 5, 0], [5, 8, 7, 6]]


@pytest.mark.parametrize("form", ["binary_little_endian", "binary_big_endian"])
@pytest.mark.parametrize("polygons", [SIDES + BOX, BOX + SIDES, [SIDES[0], BOX[0], [1, 6, 7, 2, 4], *SIDES[2:], *BOX[2:]]])
def test_polygons_of_several_sizes_in_a_binary_ply(form, polygons, tmp_path):
    """trimesh 1911."""
    def content(kind):
        order = {"binary_little_endian": "<", "binary_big_endian": ">", "ascii": ""}[kind]
        header = ["ply", f"format {kind} 1.0", f"element vertex {len(PYRAMID)}",
                  *(f"property float {axis}" for axis in "xyz"), f"element face {len(polygons)}",
                  "property uchar red", "property list uchar int vertex_indices", "property double quality", "end_header", ""]
        text = "\n".join(header).encode()
        if kind == "ascii":
            rows = [*PYRAMID, *([7, len(polygon), *polygon, 0.5] for polygon in polygons)]
            return text + "".join(" ".join(map(str, row)) + "\n" for row in rows).encode()
        faces = (struct.pack(f"{order}BB{len(polygon)}id", 7, len(polygon), *polygon, 0.5) for polygon in polygons)
        return text + np.array(PYRAMID, order + "f4").tobytes() + b"".join(faces)

    read = []
    for kind in ("ascii", form):
        path = tmp_path / f"{kind}.ply"
        path.write_bytes(content(kind))
        mesh = meshes.read(path)
        read.append(corners(mesh.vertices, mesh.triangles))
    assert read[0] == read[1] and len(read[0]) == sum(len(polygon) - 2 for polygon in polygons)


def gltf(primitives, suffix, **more):
    """A file with the tetrahedron's points (accessor 0) and triangles (accessor 1)."""
    binary = np.array(POINTS, "<f4").tobytes() + np.array(TETRAHEDRON, "<u4").tobytes()
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": primitives}], "buffers": [{"byteLength": len(binary)}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 48}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]},
                      {"bufferView": 1, "componentType": 5125, "count": 12, "type": "SCALAR"}], **more}
    if suffix == ".gltf":
        document["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(binary).decode()
        return json.dumps(document).encode()
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    return (struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary)) + struct.pack("<I4s", len(text), b"JSON") + text
            + struct.pack("<I4s", len(binary), b"BIN\0") + binary)


TETRAHEDRON_PRIMITIVE = {"attributes": {"POSITION": 0}, "indices": 1}


@pytest.mark.parametrize("suffix", [".glb", ".gltf"])
def test_only_triangle_fans_are_refused_as_such(suffix, tmp_path):
    """Not a property of that name elsewhere in the file."""
    path = tmp_path / f"model{suffix}"
    path.write_bytes(gltf([TETRAHEDRON_PRIMITIVE], suffix, extras={"mode": 6, "note": '"mode": 6'}))
    assert len(meshes.read(path).triangles) == 4
    path.write_bytes(gltf([TETRAHEDRON_PRIMITIVE, {**TETRAHEDRON_PRIMITIVE, "mode": 6}], suffix))
    with pytest.raises(meshes.MeshFileError, match="has triangle fans"):
        meshes.read(path)


@pytest.mark.parametrize("suffix", [".glb", ".gltf"])
def test_primitives_without_positions_are_empty(suffix, tmp_path):
    """trimesh 2316."""
    path = tmp_path / f"model{suffix}"
    path.write_bytes(gltf([{"attributes": {}}, TETRAHEDRON_PRIMITIVE], suffix))
    mesh = meshes.read(path)
    assert corners(mesh.vertices, mesh.triangles) == corners(POINTS, TETRAHEDRON)
    path.write_bytes(gltf([{"attributes": {}}], suffix))
    with pytest.raises(meshes.MeshFileError, match="no triangles"):
        meshes.read(path)


def test_instances_stand_where_the_scene_has_them(tmp_path):
    """A glTF file's nodes turn, scale and mirror the same triangles; a mirror image is turned outside out."""
    box = trimesh.creation.box()
    scene = trimesh.Scene()
    scene.add_geometry(box, geom_name="box", transform=trimesh.transformations.translation_matrix((3, 0, 0)))
    scene.graph.update("mirrored", geometry="box", matrix=np.diag([-2.0, 1, 1, 1]))
    scene.export(tmp_path / "boxes.glb")
    mesh = meshes.read(tmp_path / "boxes.glb")
    whole = trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False)
    assert sorted(part.volume for part in whole.split()) == pytest.approx([1, 2])
    assert whole.bounds.tolist() == [[-1, -0.5, -0.5], [3.5, 0.5, 0.5]]


def test_every_concave_polygon_is_cut_without_overlap():
    random = np.random.default_rng(5)
    turn = np.linalg.qr(random.normal(size=(3, 3)))[0]
    for _ in range(100):
        count = random.integers(4, 30)
        angles = np.sort(random.uniform(0, 2 * np.pi, count))
        if np.diff(angles, append=angles[0] + 2 * np.pi).max() > 3:
            continue  # its center would be outside
        flat = random.uniform(0.2, 1, count)[:, None] * np.column_stack([np.cos(angles), np.sin(angles)])
        triangles = np.array(polygons.triangulate(np.column_stack([flat, np.zeros(count)]) @ turn, range(count)))
        a, b, c = (flat[triangles[:, i]] for i in range(3))
        areas = np.cross(np.pad(b - a, ((0, 0), (0, 1))), np.pad(c - a, ((0, 0), (0, 1))))[:, 2] / 2
        whole = (flat[:, 0] * np.roll(flat[:, 1], -1) - flat[:, 1] * np.roll(flat[:, 0], -1)).sum() / 2
        assert len(triangles) == count - 2 and areas.min() > 0 and areas.sum() == pytest.approx(whole)


def test_points_on_a_polygons_sides_give_no_triangle_without_area():
    points = [(0, 0), (1, 0), (2, 0), (2, 1), (2, 2), (1, 2), (1, 1), (0, 1)]
    triangles = np.array(polygons.triangulate(np.array([(x, y, 0.0) for x, y in points]), range(8)))
    corners = np.array(points, float)[triangles]
    doubled = np.linalg.det(np.dstack([corners, np.ones(corners.shape[:2])]))
    assert doubled.min() > 0.5 and doubled.sum() == pytest.approx(6)


def test_quads_of_a_real_mesh_are_single_faces(meshes_directory):
    mesh = meshes.read(meshes_directory / "cube_quad.off")
    assert mesh.face_count == 6 and len(mesh.triangles) == 12
    assert len(Hierarchy.build(*mesh[:4]).order) == 6


def test_shapes_of_this_directory_are_closed():
    for name, make in shapes.SHAPES.items():
        shape = make()
        mesh = trimesh.Trimesh(shape.vertices, shape.triangles, process=False)
        assert mesh.is_watertight and mesh.is_winding_consistent and mesh.volume > 0, name
        assert np.array_equal(np.unique(shape.faces), np.arange(shape.face_count)), name
