# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading mesh files: nothing merged, polygons kept, corners welded only where a format keeps them apart."""

import numpy as np
import pytest
import shapes
import trimesh
from partwheel.core import Hierarchy, meshes, polygons


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


def test_every_concave_polygon_is_cut_without_overlap():
    random = np.random.default_rng(5)
    turn = np.linalg.qr(random.normal(size=(3, 3)))[0]
    for _ in range(100):
        count = random.integers(4, 30)
        angles = np.sort(random.uniform(0, 2 * np.pi, count))
        if np.diff(angles, append=angles[0] + 2 * np.pi).max() > 3:
            continue  # its centre would be outside
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
