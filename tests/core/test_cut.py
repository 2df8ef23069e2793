# SPDX-License-Identifier: GPL-3.0-or-later
"""Cuts as values, their borders, names and weights, and files of the parts: against the tree's own merges, scipy's
graphs, mirror images and what trimesh reads."""

import functools
import json

import numpy as np
import pytest
import shapes
import trimesh
from conftest import ROOT
from partwheel import Hierarchy, PartwheelError, meshes
from partwheel.cut import Cut, files, link_parts, mirror_planes, name_parts, part_borders, skin_weights
from partwheel.library import Status
from partwheel.marks import find_face_pairs, marks_of_labels
from partwheel.worker import Job
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from solid_checks import volume
from test_command_line import run


@functools.cache
def model(name):
    """(Mesh, Hierarchy): homer is used exactly, and symmetric but for his pose; of the elephant one part of the
    automatic cut has no face; the cow is filled from points."""
    mesh = meshes.read(ROOT / "build" / "deps" / "meshes" / f"{name}.off")
    return mesh, Hierarchy.build(mesh.vertices, mesh.triangles, mesh.faces, mesh.face_count)


MODELS = "homer", "elephant", "cow"


@pytest.fixture(params=MODELS)
def cut(request):
    return Cut.automatic(model(request.param)[1])


def same_division(one, other):
    return len({*zip(one.tolist(), other.tolist())}) == len({*one.tolist()}) == len({*other.tolist()})


def test_each_tetrahedron_is_in_one_part(cut):
    for candidate in (cut, cut.merge(0, len(cut) - 1), cut.resize(25)):
        count = np.zeros(len(cut.hierarchy.tetrahedra), int)
        for part in range(len(candidate)):
            for first, last in zip(*candidate.slices(part)):
                count[first:last] += 1
        assert (count == 1).all()


def test_splits_along_the_tree_and_joins_back(cut):
    h = cut.hierarchy
    leaves = len(h.tetrahedra)

    def under(cluster):
        clusters, todo = [], [cluster]
        while todo:
            cluster = todo.pop()
            todo += h.merges[cluster - leaves].tolist() if cluster >= leaves else []
            clusters += [cluster] if cluster < leaves else []
        return clusters

    for part in range(len(cut)):
        before = cut.labels == part
        split = cut.split(part)
        if len(np.unique(h.leaf[before])) == 1:  # a tetrahedron is not to be split
            assert split == cut
            continue
        if len(cut.parts[part]) == 1:
            # Down from the part's cluster to the first merge with faces on both sides.
            (cluster,) = cut.parts[part]
            while True:
                sides = [np.isin(h.leaf, under(child)) for child in h.merges[cluster - leaves]]
                if all(side.any() for side in sides):
                    break
                cluster = h.merges[cluster - leaves][int(sides[1].any())]
            assert same_division(split.labels[before], sides[0][before].astype(int))
        assert (split.labels[~before] == cut.labels[~before]).all() and set(split.labels[before]) == {part, len(cut)}
        assert split.join(part) == cut and split.join(len(cut)) == cut
        assert split.keys[:len(cut)] == cut.keys and split.keys[-1] not in cut.keys


def test_merges_any_two_parts_and_parts_them_again(cut):
    for one, other in ((0, len(cut) - 1), (2, 1)):
        merged = cut.merge(one, other)
        both = np.isin(cut.labels, [one, other])
        assert len(merged) == len(cut) - 1 and len(np.unique(merged.labels[both])) == 1
        assert same_division(merged.labels[~both], cut.labels[~both])
        split_again = merged.split(merged.labels[both][0])
        assert len(split_again) >= len(cut) and Cut.from_labels(cut.hierarchy, merged.labels) == merged
    assert cut.merge(3, 3) is cut
    # What was merged across a node that is joined keeps what lies beyond.
    merged = cut.merge(0, len(cut) - 1)
    rejoined = merged.join(1)
    assert len(np.unique(rejoined.labels)) == len(rejoined)


def test_the_label_of_most_faces_of_a_tetrahedron_counts():
    points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0.3, 0.3, 1), (0.3, 0.3, -1)]  # two tetrahedra
    triangles = [(0, 1, 3), (1, 2, 3), (2, 0, 3), (1, 0, 4), (2, 1, 4), (0, 2, 4)]
    h = Hierarchy.build(points, triangles)
    assert Cut.from_labels(h, [0, 0, 1, 1, 0, 1]).labels.tolist() == [0, 0, 0, 1, 1, 1]
    assert len(Cut.from_labels(h, [0] * 6)) == 1


def test_labels_that_were_marks_are_exact():
    shape, plain = model("homer")
    height = shape.vertices[shape.triangles].mean(axis=1)[:, 1]
    labels = np.digitize(height, np.quantile(height, [0.3, 0.7]))
    pairs = find_face_pairs(shape.vertices, shape.triangles)
    marked = Hierarchy.build(shape.vertices, shape.triangles, marks=[marks_of_labels(pairs, labels, "labels", chosen=True)])
    assert (Cut.from_labels(plain, labels).labels != labels).any()
    assert (Cut.from_labels(marked, labels).labels == labels).all()


def test_faces_that_a_repair_removes_keep_their_labels():
    """Triangles of the fold that it cuts off are nearest to triangles of the other label."""
    shape = shapes.folded_torus(0.06)
    centers = shape.vertices[shape.triangles].mean(axis=1)
    pairs = find_face_pairs(shape.vertices, shape.triangles)
    for labels in centers[:, 1] > 0, centers[:, 1] > centers[:, 2]:
        marked = Hierarchy.build(shape.vertices, shape.triangles, marks=[marks_of_labels(pairs, labels, "labels", chosen=True)])
        assert marked.summary.fill_method == "repaired"
        assert (Cut.from_labels(marked, labels).labels == labels).all()


def test_many_labels_that_were_marks_are_exact():
    """Seams as many would be an atlas."""
    shape = model("bear")[0]
    corner = shape.vertices[shape.triangles].mean(axis=1)
    labels = np.digitize(corner[:, 1], np.quantile(corner[:, 1], np.arange(1, 120) / 120))
    pairs = find_face_pairs(shape.vertices, shape.triangles)
    for build in Hierarchy.build, lambda *args, **options: Job(*args, **options).result():
        marked = build(shape.vertices, shape.triangles, marks=[marks_of_labels(pairs, labels, "labels", chosen=True)])
        assert (Cut.from_labels(marked, labels).labels == labels).all()


def test_slices_of_a_solid_are_checked():
    h = model("elephant")[1]
    for slices in ([[0, 5], [4, 9]], [[3, 3]], [[-1, 2]], [[0, len(h.tetrahedra) + 1]]):
        with pytest.raises(PartwheelError) as refused:
            h.solid_of_slice(*np.array(slices).T)
        assert refused.value.status == Status.ARGUMENT
    one = h.solid_of_slice(10, 60)
    for slices in ([[10, 60]], [[30, 60], [10, 30]]):
        assert (h.solid_of_slice(*np.array(slices).T).vertices == one.vertices).all() or volume(*one) == pytest.approx(
            volume(*h.solid_of_slice(*np.array(slices).T)))


def test_mirror_images_are_left_and_right():
    mesh, h = model("homer")
    cut = Cut.automatic(h)
    names = name_parts(cut, *mesh[:3])
    assert len(set(names)) == len(cut)
    (normal, offset), = mirror_planes(mesh.vertices, mesh.triangles)
    middle = {name: mesh.vertices[mesh.triangles[cut.labels == part]].mean(axis=(0, 1))
              for part, name in enumerate(names)}
    left = [name for name in names if ".L" in name]
    assert len(left) >= 2  # arms and legs
    for name in left:
        image = middle[name.replace(".L", ".R")]
        image = image - 2 * (image @ normal - offset) * normal
        assert np.linalg.norm(image - middle[name]) < 0.02 * np.linalg.norm(np.ptp(mesh.vertices, axis=0))
        assert middle[name][0] > middle[name.replace(".L", ".R")][0]
    assert not any(".R" in name and name.replace(".R", ".L") not in names for name in names)


def test_borders_are_where_two_parts_meet():
    mesh, h = model("homer")
    cut = Cut.automatic(h)
    borders = part_borders(mesh.vertices, mesh.triangles, cut.labels)
    whole = trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False)
    pairs = cut.labels[whole.face_adjacency]
    is_border = pairs[:, 0] != pairs[:, 1]
    lengths = np.linalg.norm(np.diff(whole.vertices[whole.face_adjacency_edges[is_border]], axis=1)[:, 0], axis=1)
    assert sum(border.length for border in borders) == pytest.approx(lengths.sum())
    assert {border.parts for border in borders} == {tuple(sorted(pair)) for pair in pairs[is_border].tolist()}
    edges = whole.face_adjacency_edges[is_border]
    for pair in {border.parts for border in borders}:
        pair_edges = edges[(np.sort(pairs[is_border], axis=1) == pair).all(axis=1)]
        graph = coo_matrix((np.ones(len(pair_edges)), pair_edges.T), (len(whole.vertices),) * 2)
        loops = connected_components(graph, directed=False)[0] - (len(whole.vertices) - len(np.unique(pair_edges)))
        assert loops == sum(border.parts == pair for border in borders)


def test_the_tree_of_parts_reaches_all_of_them(cut):
    name = next(name for name in MODELS if model(name)[1] is cut.hierarchy)
    mesh = model(name)[0]
    labels = cut.labels[mesh.faces]
    middles = np.array([mesh.vertices[mesh.triangles[labels == part]].mean(axis=(0, 1)) for part in range(len(cut))])
    tree = link_parts(cut, part_borders(mesh.vertices, mesh.triangles, labels), middles)
    root, = [part for part, link in enumerate(tree) if link.parent < 0]
    assert cut.volume(root) == max(map(cut.volume, range(len(cut))))
    for part, link in enumerate(tree):
        steps = 0
        while part != root:
            part, steps = tree[part].parent, steps + 1
            assert steps < len(cut)
        if link.border:
            assert set(link.border.parts) == {tree.index(link), link.parent}


@pytest.mark.parametrize("name", MODELS)
def test_weights_add_up_and_fall_across_borders(name):
    mesh, h = model(name)
    cut = Cut.automatic(h)
    labels = cut.labels[mesh.faces]
    dense = np.zeros((len(cut), len(mesh.vertices)))
    for part, (vertices, values) in enumerate(skin_weights(mesh.vertices, mesh.triangles, labels, len(cut))):
        assert (values > 0).all() and (values <= 1).all() and len(np.unique(vertices)) == len(vertices)
        dense[part, vertices] = values
    assert abs(dense.sum(axis=0) - 1).max() < 1e-12
    places = np.unique(mesh.vertices, axis=0, return_index=True, return_inverse=True)[1:]
    triangles = places[0][places[1].ravel()][mesh.triangles]  # the broken one has several vertices at a place
    part_vertices = [np.unique(triangles[labels == part]) for part in range(len(cut))]
    parts_at = np.bincount(np.concatenate(part_vertices), minlength=len(mesh.vertices))
    borders = part_borders(mesh.vertices, mesh.triangles, labels)
    for part in range(len(cut)):
        inside = part_vertices[part][parts_at[part_vertices[part]] == 1]
        assert (dense[part, inside] >= dense[:, inside].max(axis=0)).all()
    assert dense.max() == 1
    for border in borders:
        two = border.vertices[parts_at[border.vertices] == 2]
        assert abs(dense[border.parts[0], two] - dense[border.parts[1], two]).max(initial=0) < 1e-9


def test_files_hold_the_parts(tmp_path):
    mesh, h = model("homer")
    cut = Cut.automatic(h)
    files.write(tmp_path, "homer", mesh, cut, files.FORMATS)
    report = json.loads((tmp_path / "homer.json").read_text())
    names = [part["name"] for part in report["parts"]]
    assert names == name_parts(cut, *mesh[:3]) and report["labels"] == cut.labels.tolist()
    assert sum(part["parent"] is None for part in report["parts"]) == 1
    for suffix in ("glb", "3mf"):
        scene = trimesh.load(tmp_path / f"homer.{suffix}", process=False)
        assert set(scene.geometry) == set(names)
        for part, name in enumerate(names):
            assert scene.geometry[name].is_watertight
            assert scene.geometry[name].volume == pytest.approx(cut.volume(part), rel=1e-4)
    parents = trimesh.load(tmp_path / "homer.glb").graph.transforms.parents
    assert all(parents[part["name"]] == (part["parent"] or "world") for part in report["parts"])
    for part, name in enumerate(names):
        assert trimesh.load(tmp_path / f"{name}.stl").volume == pytest.approx(cut.volume(part), rel=1e-4)
    whole = trimesh.load(tmp_path / "homer.ply", process=False)
    assert whole.metadata["_ply_raw"]["face"]["data"]["part"].tolist() == cut.labels.tolist()
    assert len(np.unique(whole.visual.face_colors, axis=0)) == len(cut)
    assert same_division(np.unique(whole.visual.face_colors, axis=0, return_inverse=True)[1].ravel(), cut.labels)


def test_the_command_takes_existing_labels(tmp_path):
    """Two halves of a row of four boxes, which the automatic segmentation does not have."""
    lengths, vertices, triangles = range(5), [], []
    for x in lengths:
        vertices += [(10.0 * x, y, z) for y, z in ((0, 0), (5, 0), (5, 5), (0, 5))]
    labels = []
    for box in range(4):
        for k in range(4):
            a, b = 4 * box + k, 4 * box + (k + 1) % 4
            triangles += [(a, b, a + 4), (b, b + 4, a + 4)]
            labels += [17 if box < 3 else -2] * 2
    triangles += [(0, 2, 1), (0, 3, 2), (16, 17, 18), (16, 18, 19)]
    labels += [17, 17, -2, -2]
    mesh = trimesh.Trimesh(vertices, triangles, process=False)
    mesh.export(tmp_path / "row.off")
    (tmp_path / "labels.txt").write_text("\n".join(map(str, labels)))
    (tmp_path / "reverse.txt").write_text("\n".join(str(-label) for label in labels))  # the root is the first part
    mesh.face_attributes["label"] = np.array(labels, np.int32)
    (tmp_path / "labels.ply").write_bytes(mesh.export(file_type="ply", include_attributes=True))
    scene = trimesh.Scene()
    for label in (17, -2):
        scene.add_geometry(mesh.submesh([np.flatnonzero(np.array(labels) == label)], append=True, repair=False),
                           node_name=f"part {label}")
    scene.export(tmp_path / "row.glb")
    for model, file in (("row.off", "labels.txt"), ("row.off", "reverse.txt"), ("row.off", "labels.ply"), ("row.glb", "row.glb")):
        out = tmp_path / file.replace(".", "_")
        result = run("parts", tmp_path / model, "-o", out, "--labels", tmp_path / file, "--formats", "stl")
        assert result.returncode == 0, result.stderr
        report = json.loads((out / "row.json").read_text())
        assert sorted(part["volume"] for part in report["parts"]) == pytest.approx([250, 750], rel=0.2)  # whole tetrahedra
        parents = {part["name"]: part["parent"] for part in report["parts"]}
        assert sum(parent is None for parent in parents.values()) == 1 and set(parents.values()) - {None} <= set(parents)
        assert len({tuple(sorted(set(np.array(report["labels"])[np.array(labels) == label]))) for label in (17, -2)}) == (
            2 if model == "row.off" else len(report["parts"]))
    (tmp_path / "short.txt").write_text("1 2 3")
    (tmp_path / "words.txt").write_text("arm leg")
    for file, words in (("short.txt", "3 labels, but the model has 36 faces"), ("words.txt", "nothing but integers"),
                        ("row.off", "nothing but integers")):
        result = run("parts", tmp_path / "row.off", "-o", tmp_path / "none", "--labels", tmp_path / file)
        assert result.returncode == 1 and words in result.stderr
    (tmp_path / "plain.ply").write_bytes(trimesh.Trimesh(vertices, triangles, process=False).export(file_type="ply"))
    result = run("parts", tmp_path / "row.off", "-o", tmp_path / "none", "--labels", tmp_path / "plain.ply")
    assert result.returncode == 1 and "has no labels" in result.stderr
    assert run("parts", tmp_path / "row.off", "-o", tmp_path, "--parts", 2, "--labels", tmp_path / "labels.txt").returncode == 2
