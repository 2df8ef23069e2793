# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading mesh files: nothing merged, polygons kept, corners welded only where a format keeps them apart."""

import struct

import numpy as np
import pytest
import shapes
import trimesh
from partwheel import Hierarchy, meshes


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


def test_shapes_of_this_directory_are_closed():
    for name, make in shapes.SHAPES.items():
        shape = make()
        mesh = trimesh.Trimesh(shape.vertices, shape.triangles, process=False)
        assert mesh.is_watertight and mesh.is_winding_consistent and mesh.volume > 0, name
        assert np.array_equal(np.unique(shape.faces), np.arange(shape.face_count)), name
