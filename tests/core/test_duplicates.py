# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces that are there several times count once, and walls between cells close them: volumes are those counted by hand."""

import numpy as np
import pytest
import shapes
from partwheel import Hierarchy, Index, PartwheelError, duplicate_faces
from partwheel.cut import Cut
from solid_checks import check_solid, tetrahedra_volume, volume

HALF = 1029  # of the house's quads


def half_of(quads, seed=0):
    return [quads[i] for i in np.random.default_rng(seed).permutation(len(quads))[:HALF]]


def with_own_vertices(vertices, polygons, added):
    """Polygons that have none of their vertices in common with the others."""
    used_corners = sorted({corner for polygon in added for corner in polygon})
    number = {old: len(vertices) + new for new, old in enumerate(used_corners)}
    return (vertices + [vertices[old] for old in used_corners],
            polygons + [[number[corner] for corner in polygon] for polygon in added])


def randomly_flipped(polygons, seed=1):
    flips = np.random.default_rng(seed).random(len(polygons)) < 0.3
    return [polygon[::-1] if flip else polygon for polygon, flip in zip(polygons, flips)]


def two_triangles(quads):
    """By the other diagonal than shapes.polygons() takes."""
    return [triangle for a, b, c, d in quads for triangle in ([d, a, b], [b, c, d])]


def with_fans(vertices, polygons, quads):
    """Some quads again, as four triangles around their middle."""
    middles = [np.mean([vertices[corner] for corner in quad], axis=0).tolist() for quad in quads]
    fans = [[quad[k], quad[(k + 1) % 4], len(vertices) + n] for n, quad in enumerate(quads) for k in range(4)]
    return [*vertices, *middles], polygons + fans


VERTICES, QUADS = shapes.house()
COPIES = half_of(QUADS)
TURNED = [quad[2:] + quad[:2] for quad in COPIES]
FANS = with_fans(VERTICES, QUADS, COPIES)
CASES = {
    "on the same vertices": (VERTICES, QUADS + COPIES),
    "turned": (VERTICES, QUADS + TURNED),
    "wound the other way": (VERTICES, QUADS + [quad[::-1] for quad in COPIES]),
    "first": (VERTICES, COPIES + QUADS),
    "on vertices of their own": with_own_vertices(VERTICES, QUADS, COPIES),
    "on vertices of their own, wound the other way":
        with_own_vertices(VERTICES, QUADS, [quad[::-1] for quad in COPIES]),
    "three times": (VERTICES, QUADS + COPIES + TURNED),
    "as two triangles": (VERTICES, QUADS + two_triangles(COPIES)),
    "as fans": FANS,
    "as fans, on vertices of their own": with_own_vertices(FANS[0], QUADS, FANS[1][len(QUADS):]),
    "the whole shell, on vertices of its own": with_own_vertices(VERTICES, QUADS, QUADS),
    "the whole shell, inside out": with_own_vertices(VERTICES, QUADS, [quad[::-1] for quad in QUADS]),
    "randomly flipped": (VERTICES, randomly_flipped(QUADS + COPIES)),
}


def check_parts(hierarchy, cut, whole):
    solids = [solid for solid in cut.solids() if solid]
    for solid in solids:
        check_solid(solid)
    parts = sum(volume(solid.vertices, solid.triangles) for solid in solids)
    for total in (parts, hierarchy.summary.volume, tetrahedra_volume(hierarchy)):
        assert abs(total - whole) < 1e-6 * whole
    return solids


@pytest.mark.parametrize("name", CASES)
def test_duplicates_count_once(name):
    shape = shapes.polygons(*CASES[name])
    hierarchy = Hierarchy.build(*shape)
    original = duplicate_faces(*shape)
    count = int((original != np.arange(len(original))).sum())
    assert count == shape.face_count - len(QUADS)
    assert hierarchy.summary.fill_method == "repaired" and hierarchy.summary.deviation == 0
    assert f"{count:,} faces are duplicates of others, and were counted once." in hierarchy.notes
    assert (hierarchy.leaf == hierarchy.leaf[original]).all()
    alone = Hierarchy.build(*shapes.polygons(VERTICES, QUADS))
    assert abs(hierarchy.area[-1] - alone.area[-1]) < 1e-9 * alone.area[-1]
    cut = Cut.automatic(hierarchy)
    assert len(cut) > 2 and (cut.labels == cut.labels[original]).all()
    outer = np.concatenate([solid.source_faces[solid.neighbor_tets < 0] for solid in check_parts(hierarchy, cut, shapes.HOUSE_VOLUME)])
    assert sorted(np.unique(outer)) == sorted(np.unique(original))
    reloaded = Hierarchy.load(hierarchy.save())
    assert reloaded.notes == hierarchy.notes and (reloaded.leaf == hierarchy.leaf).all()


def test_unique_faces_are_no_duplicates():
    for name, make in shapes.SHAPES.items():
        if not name.endswith(".off"):
            shape = make()
            assert (duplicate_faces(*shape) == np.arange(shape.face_count)).all(), name


def test_a_tetrahedron_of_a_bent_quad_and_two_triangles_is_a_solid():
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 1), (0, 1, 0)]
    shape = shapes.polygons(corners, [[0, 1, 2, 3], [1, 0, 3], [3, 2, 1]])
    assert (duplicate_faces(*shape) == np.arange(3)).all()
    assert abs(Hierarchy.build(*shape).summary.volume - 1 / 6) < 1e-12


def test_polygons_of_many_corners_are_the_sum_of_smaller_ones():
    """A prism over a star, whose lid is there as an n-gon, as quads and triangles, and as triangles."""
    star = shapes.star()
    lid = [tuple(t) for t in star.triangles[star.faces == 0]]
    extended = np.array([*star.triangles, *lid], np.int32)
    faces = np.array([*star.faces, *(star.face_count + k for k in range(len(lid)))], np.int32)
    shape = shapes.Shape(star.vertices, extended, faces, star.face_count + len(lid))
    assert (duplicate_faces(*shape)[star.face_count:] == 0).all()
    hierarchy = Hierarchy.build(*shape)
    check_parts(hierarchy, Cut.automatic(hierarchy), Hierarchy.build(*star).summary.volume)
    assert (hierarchy.leaf[star.face_count:] == hierarchy.leaf[0]).all()


def test_duplicates_of_large_meshes_count_once():
    """Parts are found on a coarser copy."""
    shape = shapes.polygons(*CASES["on the same vertices"])
    hierarchy = Hierarchy.build(*shape, exact_triangles=2000)
    assert hierarchy.summary.proxy_triangles and "1,029 faces are duplicates" in hierarchy.notes
    assert (hierarchy.leaf == hierarchy.leaf[duplicate_faces(*shape)]).all()
    assert abs(hierarchy.summary.volume - shapes.HOUSE_VOLUME) < 0.05 * shapes.HOUSE_VOLUME


def test_duplicates_count_once_from_points():
    shape = shapes.polygons(*CASES["on the same vertices"])
    hierarchy = Hierarchy.build(*shape, fill_methods=4)
    assert (hierarchy.leaf == hierarchy.leaf[duplicate_faces(*shape)]).all()
    assert abs(hierarchy.summary.volume - shapes.HOUSE_VOLUME) < 0.02 * shapes.HOUSE_VOLUME


def test_bad_meshes_have_no_duplicates():
    with pytest.raises(PartwheelError):
        duplicate_faces(np.zeros((3, 3)), [[0, 1, 7]])


# ---- Faces that overlap partly: they are no duplicates, but add no volume


def with_decals(quads):
    """(vertices, polygons): the house and, on some quads, a smaller quad."""
    vertices, polygon_list = [*map(list, VERTICES)], [list(quad) for quad in QUADS]
    for quad in quads:
        corners = np.array([VERTICES[corner] for corner in quad])
        middle, first = corners.mean(axis=0), len(vertices)
        vertices.extend((middle + 0.5 * (corners - middle)).tolist())
        polygon_list.append([first, first + 1, first + 2, first + 3])
    return vertices, polygon_list


def test_faces_that_overlap_partly_add_no_volume():
    hierarchy = Hierarchy.build(*shapes.polygons(*with_decals(half_of(QUADS)[:200])))
    solids = [solid for solid in Cut.automatic(hierarchy).solids() if solid]
    total = sum(volume(solid.vertices, solid.triangles) for solid in solids)
    assert abs(total - hierarchy.summary.volume) < 1e-6 * total
    assert abs(total - shapes.HOUSE_VOLUME) < 3e-4 * shapes.HOUSE_VOLUME
    assert hierarchy.notes


def test_a_low_pyramid_is_a_solid():
    vertices = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 0.5, 1e-3)]
    sides = [[k, (k + 1) % 4, 4] for k in range(4)]
    shape = shapes.polygons(vertices, [[3, 2, 1, 0], *sides])
    assert (duplicate_faces(*shape) == np.arange(5)).all()
    assert abs(Hierarchy.build(*shape).summary.volume - 1e-3 / 3) < 1e-9


def test_a_wall_that_is_there_twice_with_other_diagonals():
    two = shapes.polycube([(0, 0, 0), (1, 0, 0)])
    number = {tuple(place): index for index, place in enumerate(two.vertices.tolist())}
    wall = [number[1.0, y, z] for y, z in ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))]
    halves = [[wall[k] for k in corners] for corners in ((0, 1, 2), (0, 2, 3), (0, 1, 3), (1, 2, 3))]
    triangles = np.vstack([two.triangles, halves]).astype(np.int32)
    hierarchy = Hierarchy.build(two.vertices, triangles, np.r_[two.faces, 10:14], 14)
    assert abs(hierarchy.summary.volume - 2) < 1e-9
    assert "2 faces are walls" in hierarchy.notes and "2 faces are duplicates" in hierarchy.notes


def tessellated_box(seed, around=6):
    """A box with a side that is covered twice: by quads, and by rings of triangles within the same outline. The vertices and
    polygons, the triangles last, and their number."""
    steps = np.linspace(0, 1, around + 1)
    number = {}

    def add(place):
        return number.setdefault(tuple(np.round(place, 12)), len(number))

    quads = []
    for axis in range(3):
        for end in (0.0, 1.0):
            for i in range(around):
                for j in range(around):
                    corners = [(steps[i + di], steps[j + dj]) for di, dj in ((0, 0), (1, 0), (1, 1), (0, 1))]
                    quad = [add(np.insert(corner, axis, end)) for corner in corners]
                    quads.append(quad if (end == 1.0) == (axis != 1) else quad[::-1])
    rim = np.array([*((s, 0) for s in steps[:-1]), *((1, s) for s in steps[:-1]), *((s, 1) for s in steps[:0:-1]),
                    *((0, s) for s in steps[:0:-1])])
    turn = np.random.default_rng(seed).uniform(-0.1, 0.1)
    ring = 0.5 + 0.6 * (rim - 0.5) @ [[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]]
    outer, inner = ([add((*place, 1.0)) for place in places] for places in (rim, ring))
    triangles = []
    for k in range(len(rim)):
        after = (k + 1) % len(rim)
        triangles += [[outer[k], outer[after], inner[k]], [outer[after], inner[after], inner[k]],
                      [inner[k], inner[after], add((0.5, 0.5, 1.0))]]
    return [np.array(place) for place in number], quads + triangles, len(triangles)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("flipped", [False, True])
def test_a_side_in_two_tessellations_counts_once(seed, flipped):
    vertices, polygons, added = tessellated_box(seed)
    shape = shapes.polygons(vertices, randomly_flipped(polygons) if flipped else polygons)
    original = duplicate_faces(*shape)
    assert (np.flatnonzero(original != np.arange(len(original))) == np.arange(len(polygons) - added, len(polygons))).all()
    centroids = np.array([np.mean([vertices[v] for v in polygon], axis=0) for polygon in polygons])
    assert (abs(centroids - centroids[original]).max(axis=1) < 1 / 6).all()  # in the quad that the triangle's centroid is in
    hierarchy = Hierarchy.build(*shape)
    assert abs(hierarchy.summary.volume - 1) < 1e-9
    assert (hierarchy.leaf == hierarchy.leaf[original]).all()
    cut = Cut.automatic(hierarchy)
    assert (cut.labels == cut.labels[original]).all()
    check_parts(hierarchy, cut, 1)


# ---- Walls


def as_row(count=12):
    """Hexagonal prisms in a row, each welded to the next."""
    return shapes.prisms(columns=count, rows=1)


@pytest.mark.parametrize("count", [13, 30, 40])
def test_a_row_of_prisms_adds_up_to_the_whole(count):
    hierarchy = Hierarchy.build(*shapes.polygons(*as_row(count)))
    check_parts(hierarchy, Cut.into(hierarchy, count), shapes.PRISMS_VOLUME * count / 12)


@pytest.mark.parametrize("model", [shapes.prisms(), as_row()], ids=["honeycomb", "row"])
@pytest.mark.parametrize("parts", [1, 5, 12])
def test_walls_close_the_cells_on_both_sides(model, parts):
    vertices, polygons = model
    shape = shapes.polygons(vertices, polygons)
    hierarchy = Hierarchy.build(*shape)
    walls = 12 * 8 - shape.face_count
    assert hierarchy.summary.fill_method == "repaired" and hierarchy.summary.deviation == 0
    assert hierarchy.summary.components == 12 and hierarchy.summary.cavities == 0
    assert f"{walls} faces are walls inside the solid" in hierarchy.notes
    solids = check_parts(hierarchy, Cut.into(hierarchy, parts), shapes.PRISMS_VOLUME)
    faces = np.concatenate([solid.source_faces for solid in solids])
    counts = np.bincount(faces[faces >= 0], minlength=shape.face_count)
    assert (counts == np.bincount(shape.faces)).all()  # each triangle of the mesh once
    reloaded = Hierarchy.load(hierarchy.save())
    check_parts(reloaded, Cut.into(reloaded, parts), shapes.PRISMS_VOLUME)


def test_walls_with_a_window_and_fins_enclose_nothing():
    """The two prisms beside the window are one solid; the fins are in none."""
    vertices, polygons, walls, sheets = shapes.prisms_with_window_and_fins()
    shape = shapes.polygons(vertices, polygons)
    hierarchy = Hierarchy.build(*shape)
    assert hierarchy.summary.components == 11 and hierarchy.summary.fill_method == "repaired"
    assert f"{walls} faces are walls inside the solid" in hierarchy.notes
    assert f"{sheets} faces enclose nothing, and were left out of the solid." in hierarchy.notes
    assert 0.01 < hierarchy.summary.deviation < 0.1
    solids = check_parts(hierarchy, Cut.into(hierarchy, 11), shapes.PRISMS_VOLUME)
    faces = np.concatenate([solid.source_faces for solid in solids])
    counts = np.bincount(faces[faces >= 0], minlength=shape.face_count)
    assert (counts == np.where(np.arange(shape.face_count) < shape.face_count - sheets, np.bincount(shape.faces), 0)).all()
    reloaded = Hierarchy.load(hierarchy.save())
    assert (reloaded.leaf == hierarchy.leaf).all() and reloaded.notes == hierarchy.notes


@pytest.mark.parametrize("seed", range(24))
def test_cells_with_any_walls_have_the_volume_of_all_cells(seed):
    """Each cell is solid, whichever squares between the cells are missing."""
    rng = np.random.default_rng(seed)
    cells = [(x, y, z) for x in range(3) for y in range(3) for z in range(3) if rng.random() < (1, 0.7)[seed % 2]]
    vertices, quads = shapes.walled_cells(cells, (0.3, 0.7, 1)[seed % 3], seed)
    hierarchy = Hierarchy.build(*shapes.polygons(vertices, quads))
    check_parts(hierarchy, Cut.automatic(hierarchy), len(cells))
    assert abs(hierarchy.summary.volume - len(cells)) < 1e-9 * len(cells)


def test_a_sheet_that_is_welded_to_a_solid_is_left_out():
    vertices, polygons = shapes.prisms()
    edge = next(polygon for polygon in polygons if len(polygon) == 6 and vertices[polygon[0]][2] > 0)[:2]
    flag = [*edge, len(vertices) + 1, len(vertices)]
    raised = vertices + [[vertices[corner][0], vertices[corner][1], 2.5] for corner in edge]
    hierarchy = Hierarchy.build(*shapes.polygons(raised, [*polygons, flag]))
    assert "1 face encloses nothing" in hierarchy.notes
    check_parts(hierarchy, Cut.into(hierarchy, 12), shapes.PRISMS_VOLUME)


def test_each_prism_is_a_part():
    shape = shapes.polygons(*shapes.prisms())
    cut = Cut.into(Hierarchy.build(*shape), 12)
    volumes = [cut.volume(part) for part in range(len(cut))]
    assert np.allclose(volumes, shapes.PRISMS_VOLUME / 12)
    index = Index(cut.hierarchy, cut.hierarchy.cut_parts(12))
    assert len(set(index.locate(np.array([[0, 0, 0.5], [0.75, 0.5 * 3 ** 0.5 / 2, 0.5]])).tolist())) == 2


@pytest.mark.parametrize("flipped", [False, True])
def test_which_way_walls_wind_does_not_matter(flipped):
    vertices, polygons = shapes.prisms()
    polygons = randomly_flipped(polygons) if flipped else [polygon[::-1] for polygon in polygons]
    hierarchy = Hierarchy.build(*shapes.polygons(vertices, polygons))
    check_parts(hierarchy, Cut.into(hierarchy, 12), shapes.PRISMS_VOLUME)


def test_walls_that_are_there_twice():
    vertices, polygons = shapes.prisms()
    shape = shapes.polygons(vertices, polygons + [polygon[::-1] for polygon in polygons[10:40]])
    hierarchy = Hierarchy.build(*shape)
    assert "walls inside" in hierarchy.notes and "30 faces are duplicates" in hierarchy.notes
    check_parts(hierarchy, Cut.into(hierarchy, 12), shapes.PRISMS_VOLUME)


def test_cavities_beside_walls_stay_cavities():
    """Two boxes with one wall, one of which has a box taken out of it."""
    two = shapes.polycube([(0, 0, 0), (1, 0, 0)])
    numbers = {tuple(place): number for number, place in enumerate(two.vertices.tolist())}
    wall = [numbers[1.0, y, z] for y, z in ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))]
    wall = shapes.polygons(two.vertices, [wall])
    hole = shapes.turned_inside_out(shapes.moved(shapes.cube(), (0.25, 0.25, 0.25), 0.5))
    both = shapes.Shape(two.vertices, np.vstack([two.triangles, wall.triangles]), np.r_[two.faces, 10, 10], 11)
    hierarchy = Hierarchy.build(*shapes.merged(both, hole))
    assert hierarchy.summary.cavities == 1 and hierarchy.summary.components == 2
    check_parts(hierarchy, Cut.into(hierarchy, 2), 2 - 0.125)


def test_two_closed_boxes_with_a_wall_each():
    """Unwelded: the two walls are at the same place, and each box keeps its own."""
    shape = shapes.merged(shapes.cube(), shapes.moved(shapes.cube(), (1, 0, 0)))
    hierarchy = Hierarchy.build(*shape)
    cut = Cut.into(hierarchy, 2)
    assert [sorted(np.flatnonzero(cut.labels == part)) for part in (0, 1)] in (
        [list(range(6)), list(range(6, 12))], [list(range(6, 12)), list(range(6))])
    volumes = [volume(solid.vertices, solid.triangles) for solid in cut.solids()]
    assert abs(sum(volumes) - hierarchy.summary.volume) < 1e-9 and abs(sum(volumes) - 2) < 0.01


def test_the_notes_of_an_assembly_count_the_faces_of_all_shells():
    """Prisms with fins, a house with duplicates, a cube and a copy of it."""
    vertices, polygons, walls, sheets = shapes.prisms_with_window_and_fins()
    cube = shapes.moved(shapes.cube(), (40, 0, 0))
    hierarchy = Hierarchy.build(*shapes.merged(
        shapes.polygons(vertices, polygons), shapes.moved(shapes.polygons(*CASES["turned"]), (10, 0, 0)), cube, cube))
    assert hierarchy.summary.shells == 3
    assert hierarchy.notes == (
        "3 shells: 3 filled after repair."
        f" {walls} faces are walls inside the solid, which was cut apart there."
        f" {sheets} faces enclose nothing, and were left out of the solid."
        f" {HALF + 6:,} faces are duplicates of others, and were counted once.")
    assert Hierarchy.load(hierarchy.save()).notes == hierarchy.notes
