# SPDX-License-Identifier: GPL-3.0-or-later
"""Sources of marks: borders of labels and of colors. Compared with brute force, and with the colors that a test painted."""

import json

import numpy as np
import pytest
import rendering
import trimesh
from partwheel import gltf, marks, meshes, wavefront
from partwheel.appearance import Appearance, Image, from_bytes, to_linear
from partwheel.components import components
from test_appearance import RED, dumbbell, side_coordinates, texture, write_two_materials
from test_command_line import run

SKIN, SHIRT, HAIR = (0.85, 0.62, 0.52), (0.24, 0.36, 0.62), (0.25, 0.17, 0.12)  # sRGB


def edge_set(points, edges):
    return {frozenset(map(tuple, points[edge])) for edge in edges}


def brute_force_border(points, triangles, labels):
    """The edges between triangles of different labels, as pairs of positions; by every pair of triangles at an edge."""
    at_edge = {}
    for triangle, label in zip(triangles.tolist(), labels):
        for a, b in zip(triangle, triangle[1:] + triangle[:1]):
            at_edge.setdefault(frozenset([tuple(points[a]), tuple(points[b])]), set()).add(label)
    return {edge for edge, found in at_edge.items() if len(found) > 1}


def split(mesh):
    """Each triangle has vertices of its own, as in a flat-shaded file."""
    return mesh.triangles.reshape(-1, 3), np.arange(3 * len(mesh.faces)).reshape(-1, 3)


@pytest.mark.parametrize("is_split", [False, True])
def test_borders_of_labels_are_the_edges_between_them(is_split):
    ball = trimesh.creation.icosphere(3)
    points, triangles = split(ball) if is_split else (np.asarray(ball.vertices), np.asarray(ball.faces))
    labels = np.floor(ball.triangles_center @ [2, 1, 0]).astype(int)
    found = marks.marks_of_labels(marks.find_face_pairs(points, triangles), labels, "materials")
    assert found.name == "materials" and len(found.edges) == len(found.strengths) == len(edge_set(points, found.edges)) > 50
    assert edge_set(points, found.edges) == brute_force_border(points, triangles, labels)


def test_edges_within_a_polygon_are_no_pairs():
    box = trimesh.creation.box()
    quads = np.unique(np.round(box.face_normals), axis=0, return_inverse=True)[1].ravel()
    pairs = marks.find_face_pairs(box.vertices, box.faces, quads)
    assert len(pairs.edges) == 12 and (pairs.sides[:, 0] != pairs.sides[:, 1]).all()


def test_oklab_of_known_colors():
    """The table on Björn Ottosson's page, but for the light that a screen adds."""
    known = {(1, 1, 1): (1, 0, 0), (1, 0, 0): (0.628, 0.225, 0.126), (0, 1, 0): (0.866, -0.234, 0.179),
             (0, 0, 1): (0.452, -0.032, -0.312)}
    assert np.abs(marks.to_oklab(np.array(list(known))) - list(known.values())).max() < 0.04


def paint(mesh, noise, seed=0):
    """(labels, linear colors): a figure in three colors, with noise of this standard deviation."""
    height = mesh.triangles_center[:, 0]
    labels = np.digitize(height, [-1.5, 1.0])
    colors = np.array([SKIN, SHIRT, HAIR])[labels]
    return labels, to_linear(np.clip(colors + np.random.default_rng(seed).normal(0, noise, colors.shape), 0, 1))


@pytest.mark.parametrize("noise", [0, 0.02, 0.05])
def test_borders_of_noisy_colors_are_those_of_the_colors(noise):
    mesh = dumbbell()
    labels, colors = paint(mesh, noise)
    found = marks.marks_of_colors(marks.find_face_pairs(mesh.vertices, mesh.faces), colors, mesh.area_faces)
    border = brute_force_border(mesh.vertices, mesh.faces, labels)
    edges = edge_set(mesh.vertices, found.edges)
    assert len(edges & border) >= 0.95 * len(border) and len(edges - border) <= 0.05 * len(border)
    assert found.strengths.min() > 0.6


def test_noise_and_slow_changes_are_no_borders():
    mesh = dumbbell()
    pairs = marks.find_face_pairs(mesh.vertices, mesh.faces)
    share = (mesh.triangles_center[:, :1] - mesh.triangles_center[:, 0].min()) / np.ptp(mesh.triangles_center[:, 0])
    noise = np.random.default_rng(1).normal(0, 0.06, (len(mesh.faces), 3))
    for colors in (np.clip(SKIN + noise, 0, 1), SKIN * (1 - share) + np.array(SHIRT) * share):
        assert len(marks.marks_of_colors(pairs, to_linear(colors), mesh.area_faces).edges) == 0


def test_faces_that_a_border_crosses_join_one_side():
    """Their colors are mixtures."""
    mesh = dumbbell()
    weights = np.random.default_rng(2).dirichlet([1, 1, 1], 200)
    at = np.einsum("sc,tc->ts", weights, mesh.triangles[:, :, 0] - mesh.triangles[:, :, 1])  # a slanted cut
    patch = np.digitize(at, [-1.5, 1.0])
    colors = to_linear(np.array([SKIN, SHIRT, HAIR]))[patch].mean(axis=1)
    is_mixed = (patch != patch[:, :1]).any(axis=1)
    pairs = marks.find_face_pairs(mesh.vertices, mesh.faces)
    found = {frozenset(edge) for edge in marks.marks_of_colors(pairs, colors, mesh.area_faces).edges.tolist()}
    assert is_mixed.sum() > 50
    whole = components(len(colors), pairs.sides[[frozenset(edge) not in found for edge in pairs.edges.tolist()]])
    assert len(np.unique(whole)) == 3
    for number in range(3):
        assert len(np.unique(patch[~is_mixed & (whole == number), 0])) == 1


def test_a_single_face_is_no_region():
    mesh = dumbbell()
    colors = np.tile(to_linear(np.array(SKIN)), (len(mesh.faces), 1))
    colors[np.argmin(mesh.area_faces)] = 0
    assert len(marks.marks_of_colors(marks.find_face_pairs(mesh.vertices, mesh.faces), colors, mesh.area_faces).edges) == 0


def test_similar_colors_make_weaker_marks():
    mesh = dumbbell()
    pairs, is_right = marks.find_face_pairs(mesh.vertices, mesh.faces), mesh.triangles_center[:, :1] > 0
    strengths = []
    for other in (np.array(SKIN) * 0.85, np.array(SKIN) * 0.7, np.array(SHIRT)):
        colors = to_linear(np.where(is_right, SKIN, other))
        strengths.append(marks.marks_of_colors(pairs, colors, mesh.area_faces).strengths)
    means = [values.mean() for values in strengths]
    assert 0.5 < means[0] < means[1] < means[2] < 0.91


@pytest.mark.parametrize("scale", [4, 32])  # also larger than appearance.MEAN_TEXTURE_SIZE
def test_mean_colors_of_a_texture_are_those_of_its_texels(scale):
    """Compared with the mean of the texels whose centers lie in each triangle."""
    image = np.kron(texture(), np.ones((scale, 2 * scale, 1), np.uint8))  # twice as wide as high
    mesh = trimesh.creation.icosphere(1)
    coordinates = side_coordinates(mesh.vertices)[mesh.faces]
    look = Appearance({"TEXCOORD_0": coordinates}, np.zeros(len(mesh.faces), int),
                      [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "baseColorFactor": [0.5, 1, 1, 1]}}],
                      [{"source": 0}], [], [Image("a.png", rendering.png(image))])
    found, (height, width, _) = look.mean_colors(), image.shape
    rows, columns = np.mgrid[:height:scale // 4, :width:scale // 4]
    centers = (np.stack([columns, rows], axis=-1).reshape(-1, 2) + 0.5) / (width, height)
    for corners, color in zip(coordinates, found):
        a, sides = corners[0], (corners[1:] - corners[0]).T
        if abs(np.linalg.det(sides)) < 1e-6:
            continue
        v, w = np.linalg.solve(sides, (centers - a).T)
        is_inside = (v >= 0) & (w >= 0) & (v + w <= 1)
        if is_inside.sum() > 50:
            expected = from_bytes(image[rows.ravel()[is_inside], columns.ravel()[is_inside]]).mean(axis=0) * (0.5, 1, 1, 1)
            assert np.abs(color - expected).max() < 0.03


TOP_LEFT, TOP_RIGHT, BOTTOM_LEFT, BOTTOM_RIGHT = np.array([(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1)])
QUARTER = np.pi / 2


@pytest.mark.parametrize("info, expected", [
    ({}, TOP_LEFT),  # at (0.25, 0.25) of the first texture coordinates, v pointing down
    ({"texCoord": 1}, BOTTOM_RIGHT),  # at (0.75, 0.75) of the others
    ({"offset": [0.5, 0]}, TOP_RIGHT),
    ({"offset": [0, 0.5]}, BOTTOM_LEFT),
    ({"scale": [3, 1]}, TOP_RIGHT),
    ({"scale": [1, 3]}, BOTTOM_LEFT),
    ({"rotation": QUARTER}, BOTTOM_LEFT),  # counterclockwise, to (0.25, -0.25)
    ({"rotation": -QUARTER}, TOP_RIGHT),
    ({"scale": [3, 1], "rotation": QUARTER, "offset": [0.5, 0]}, TOP_RIGHT),  # (0.75, 0.25), (0.25, -0.75), (0.75, -0.75)
    ({"texCoord": 1, "offset": [-0.5, 0]}, BOTTOM_LEFT)])
def test_materials_select_and_transform_texture_coordinates(tmp_path, info, expected):
    """The extension's texCoord counts; an OBJ file has coordinates that are transformed already."""
    image = Image("a.png", rendering.png(np.uint8([[TOP_LEFT, TOP_RIGHT], [BOTTOM_LEFT, BOTTOM_RIGHT]]) * 255))
    corners = np.array([[[0, 0], [0.01, 0], [0, 0.01]]])
    texture = {"index": 0, "texCoord": 0, "extensions": {"KHR_texture_transform": info}} if info else {"index": 0}
    look = Appearance({"TEXCOORD_0": corners + 0.25, "TEXCOORD_1": corners + 0.75}, np.zeros(1, int),
                      [{"name": "a", "pbrMetallicRoughness": {"baseColorTexture": texture}}], [{"source": 0}], [], [image])
    assert np.allclose(look.mean_colors(), [*expected, 1])
    node = gltf.Node("a", -1, np.eye(3), np.arange(3)[None], look)
    for name, data in {**wavefront.write_obj("model", [node]), "model.glb": gltf.write_glb([node])}.items():
        (tmp_path / name).write_bytes(data)
    for name in ("model.obj", "model.glb"):
        assert np.allclose(meshes.read(tmp_path / name).appearance.mean_colors(), [*expected, 1])


def test_what_is_transparent_hardly_counts():
    look = Appearance({"COLOR_0": np.ones((1, 3, 4))}, np.zeros(1, int),
                      [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}], [{"source": 0}])
    image = np.zeros((8, 8, 4), np.uint8)
    image[:, :4] = (255, 0, 0, 255)
    look.attributes["TEXCOORD_0"] = np.array([[[0, 0], [1, 0], [0, 1.0]]])
    look = look._replace(images=[Image("a.png", rendering.png(image))])
    assert look.mean_colors()[0, 0] > 0.99


def test_marks_of_a_file_are_its_materials_groups_and_colors(tmp_path):
    write_two_materials(tmp_path / "model.obj")
    mesh = meshes.read(tmp_path / "model.obj")
    border = brute_force_border(mesh.vertices, mesh.triangles, mesh.appearance.face_materials)
    found = {kind.name: kind for kind in marks.marks_of_model(mesh, marks.KINDS)}
    assert set(found) == {"materials", "colors"}  # a single object
    assert edge_set(mesh.vertices, found["materials"].edges) == border
    assert len(edge_set(mesh.vertices, found["colors"].edges) & border) > 0.9 * len(border)
    assert marks.marks_of_model(mesh, ()) == []
    red = mesh._replace(appearance=mesh.appearance._replace(materials=[RED, RED]), nodes=np.arange(len(mesh.triangles)) % 2)
    assert [kind.name for kind in marks.marks_of_model(red, ("groups", "colors"))] == ["groups"]


def test_the_command_line_uses_the_requested_marks(tmp_path):
    write_two_materials(tmp_path / "model.obj")
    notes = {use: json.loads(run("build", tmp_path / "model.obj", "--json", "--use", use).stdout)["notes"]
             for use in ("none", "materials", "materials,colors")}
    assert "Marks" not in notes["none"]
    assert "Marks: the materials divide the surface into 2 patches" in notes["materials"]
    assert "the colors" not in notes["materials"] and "the colors" in notes["materials,colors"]
    wrong = run("build", tmp_path / "model.obj", "--use", "paint")
    assert wrong.returncode == 2 and "choose from materials, groups, colors" in wrong.stderr
