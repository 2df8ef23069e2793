# SPDX-License-Identifier: GPL-3.0-or-later
"""Assemblies: every shell of a mesh is a node, a click or two notches select it, and what is asked of the whole adds up."""

import numpy as np
import pytest
import shapes
from conftest import UNLIMITED
from partwheel import FillMethod, Hierarchy, Mode, PartwheelError, Status
from partwheel.cut import Cut
from partwheel.worker import Job
from solid_checks import check_solid, tetrahedra_volume, triangle_areas, volume


def ball(center=(0, 0, 0), radius=1.0, across=16):
    """A sphere of quads and triangles at the poles."""
    rows, columns = across // 2, across
    latitude = np.linspace(0, np.pi, rows + 1)[1:-1, None]
    longitude = np.arange(columns) * 2 * np.pi / columns
    ring = np.stack([np.sin(latitude) * np.cos(longitude), np.sin(latitude) * np.sin(longitude),
                     np.cos(latitude) + 0 * longitude], -1).reshape(-1, 3)
    vertices = np.vstack([ring, [(0, 0, 1), (0, 0, -1)]]) * radius + np.array(center, float)
    top, bottom = len(ring), len(ring) + 1
    quads = [(r * columns + c, (r + 1) * columns + c, (r + 1) * columns + (c + 1) % columns, r * columns + (c + 1) % columns)
             for r in range(rows - 2) for c in range(columns)]
    caps = [(top, c, (c + 1) % columns) for c in range(columns)]
    caps += [(bottom, (rows - 2) * columns + (c + 1) % columns, (rows - 2) * columns + c) for c in range(columns)]
    return shapes.polygons(vertices, quads + caps)


def box(low, high):
    cube = shapes.cube()
    return cube._replace(vertices=np.array(low) + cube.vertices * (np.array(high) - np.array(low)))


def cylinder(center, radius, height, axis=2, sides=20):
    angles = np.arange(sides) * 2 * np.pi / sides
    rim = np.stack([np.cos(angles), np.sin(angles)], -1) * radius
    vertices = np.vstack([np.column_stack([rim, np.full(sides, z)]) for z in (-height / 2, height / 2)])
    vertices = np.roll(vertices, axis - 2, axis=1) + np.array(center, float)
    walls = [(i, (i + 1) % sides, (i + 1) % sides + sides, i + sides) for i in range(sides)]
    return shapes.polygons(vertices, [tuple(range(sides))[::-1], tuple(range(sides, 2 * sides)), *walls])


def sheet(columns=6, rows=4, bend=0.0, offset=(0, 0, 0)):
    u, v = np.meshgrid(np.arange(columns + 1.0), np.arange(rows + 1.0), indexing="ij")
    vertices = np.stack([u, v, bend * np.sin(u)], -1).reshape(-1, 3) + np.array(offset, float)
    at = lambda i, j: i * (rows + 1) + j  # noqa: E731
    return shapes.polygons(vertices, [(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1))
                                      for i in range(columns) for j in range(rows)])


def tiles():
    parts = []
    for row in range(3):
        for column in range(4):
            center = 1.5 * column, np.sqrt(3) * (row + column % 2 / 2), 0
            parts.append(cylinder(center, 1.0, 0.3, sides=6))
    return parts


def snowman():
    return [ball((0, 0, 0), 1.0), ball((0, 0, 1.4), 0.7), ball((0, 0, 2.4), 0.45), cylinder((0, 0, 2.9), 0.35, 0.4),
            *(ball((0.15 * side, -0.42, 2.5), 0.05, 8) for side in (-1, 1))]


def car():
    return [box((-2, -1, 0.3), (2, 1, 1.2)), box((-1, -0.9, 1.1), (1, 0.9, 1.8)),
            *(cylinder((x, y, 0.4), 0.4, 0.5, axis=1) for x in (-1.3, 1.3) for y in (-1, 1))]


def dressed():
    """A body in a shirt, and a head in a cap: shells around shells, with a gap of 2 % of the size."""
    return [cylinder((0, 0, 0), 0.5, 2.0), cylinder((0, 0, 0.2), 0.58, 1.2), ball((0, 0, 1.5), 0.4),
            cylinder((0, 0, 1.75), 0.42, 0.35)]


def cubes():
    """Face to face: their surfaces have common places, but no vertices."""
    return [shapes.moved(shapes.cube(), (x, y, 0)) for x in range(3) for y in range(2)]


def lattice():
    struts = []
    for i in range(3):
        for j in range(3):
            for axis in range(3):
                low = np.roll([i - 0.1, j - 0.1, -0.3], axis)
                struts.append(box(low, low + np.roll([0.2, 0.2, 2.6], axis)))
    return struts


ASSEMBLIES = {function.__name__: function for function in (tiles, snowman, car, dressed, cubes, lattice)}
built = {}


def build(name):
    if name not in built:
        parts = ASSEMBLIES[name]()
        shape = shapes.merged(*parts)
        shell = np.repeat(np.arange(len(parts)), [part.face_count for part in parts])
        built[name] = parts, shell, Hierarchy.build(*shape)
    return built[name]


def node_of(hierarchy, faces):
    """The node that has exactly these faces, or None."""
    counts = hierarchy.last - hierarchy.first
    for node in hierarchy.path(int(faces[0])):
        if counts[node] == len(faces):
            return node if set(hierarchy.faces(int(node)).tolist()) == set(faces.tolist()) else None
    return None


@pytest.mark.parametrize("name", ASSEMBLIES)
def test_every_shell_is_a_node_that_a_click_and_two_notches_select(name):
    parts, shell, hierarchy = build(name)
    assert hierarchy.summary.shells == len(parts) and hierarchy.summary.is_exact and not hierarchy.notes
    clicks = 0
    for number in range(len(parts)):
        faces = np.flatnonzero(shell == number)
        node = node_of(hierarchy, faces)
        assert node is not None
        for face in faces:
            stops, start = hierarchy.wheel(int(face))
            assert node in stops
            assert abs(list(stops).index(node) - start) <= 2
            clicks += stops[start] == node
    assert clicks >= 0.8 * len(shell)


def test_a_click_takes_a_small_shell_whole_and_of_a_large_one_at_most_half_of_the_model():
    hand = shapes.off("hand")
    small = shapes.moved(hand, (3 * np.ptp(hand.vertices, axis=0).max(), 0, 0), 0.2)
    alone, both = Hierarchy.build(*hand), Hierarchy.build(*shapes.merged(hand, small))
    node = node_of(both, hand.face_count + np.arange(hand.face_count))
    half, parts, larger = both.area.max() / 2, 0, 0
    for face in range(0, hand.face_count, 97):
        stops, start = both.wheel(hand.face_count + face)
        assert stops[start] == node
        (stops, start), (of_alone, start_alone) = both.wheel(face), alone.wheel(face)
        if alone.area[of_alone[start_alone]] <= half:
            assert both.faces(stops[start]).size == alone.faces(of_alone[start_alone]).size
            parts += 1
        else:
            larger += 1
        assert both.area[stops[start]] <= half
        view = 100 * np.ptp(hand.vertices, axis=0).max()
        assert both.area[stops[both.wheel(face, view)[1]]] <= half
    assert parts > 5 and larger > 5


@pytest.mark.parametrize("name", ASSEMBLIES)
def test_volumes_and_areas_are_the_sums_of_the_shells(name):
    parts, shell, hierarchy = build(name)
    assert np.isclose(hierarchy.summary.volume, sum(volume(p.vertices, p.triangles) for p in parts))
    assert np.isclose(tetrahedra_volume(hierarchy), hierarchy.summary.volume)
    for number, part in enumerate(parts):
        corners = part.vertices[part.triangles]
        area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum() / 2
        node = node_of(hierarchy, np.flatnonzero(shell == number))
        assert np.isclose(hierarchy.area[node], area)
        assert np.isclose(hierarchy.volume[node], volume(part.vertices, part.triangles))


@pytest.mark.parametrize("name", ASSEMBLIES)
def test_solids_of_a_cut_are_closed_and_have_every_face_once(name):
    parts, shell, hierarchy = build(name)
    total, faces = 0.0, []
    bounds = hierarchy.cut_parts(len(parts))
    for number in range(len(parts)):
        solid = hierarchy.solid_of_slice(bounds[number], bounds[number + 1])
        check_solid(solid)
        total += volume(solid.vertices, solid.triangles)
        faces += sorted(set(solid.source_faces[solid.source_faces >= 0].tolist()))
    assert np.isclose(total, hierarchy.summary.volume)
    assert sorted(faces) == list(range(len(shell)))


def test_small_shells_join_what_they_touch():
    parts, shell, hierarchy = build("snowman")
    head, eyes = np.flatnonzero(shell == 2), np.flatnonzero(shell >= 4)
    for eye in (4, 5):
        node = node_of(hierarchy, np.flatnonzero(shell == eye))
        above = next(n for n in hierarchy.path(int(eyes[0])) if set(head.tolist()) <= set(hierarchy.faces(int(n)).tolist()))
        assert hierarchy.area[above] < 0.5 * hierarchy.area[-1], (eye, node)


def test_a_shell_joins_the_neighbor_with_most_contact_for_its_area():
    """The smallest box has a little more contact with the largest one, but that is nothing for its area."""
    hierarchy = Hierarchy.build(*shapes.merged(box((0, 0, 0), (1, 1, 1)), box((1, 0, 0.2), (3, 1, 1.2)),
                                               box((-5, -5, -10), (5, 5, 0))))
    assert node_of(hierarchy, np.arange(12)) is not None


def test_shells_with_vertices_in_the_same_place_join_before_others():
    """As Blender's merge by distance makes them one: a small box at the corner of another, sunk into a large one."""
    rounded = 1 + 1e-6  # as in files with single precision
    parts = [box((0, 0, 0), (1, 1, 1)), box((rounded, 1, 1), (3, 3, 3)), box((-4, -4, -4), (0.9, 0.9, 0.9))]
    hierarchy = Hierarchy.build(*shapes.merged(*parts))
    assert node_of(hierarchy, np.arange(parts[0].face_count + parts[1].face_count)) is not None


def test_the_result_does_not_depend_on_the_order_of_vertices_and_triangles():
    parts, shell, hierarchy = build("car")
    shape = shapes.merged(*parts)
    random = np.random.default_rng(3)
    vertices, triangles = random.permutation(len(shape.vertices)), random.permutation(len(shape.triangles))
    number = np.argsort(vertices)
    other = Hierarchy.build(shape.vertices[vertices], number[shape.triangles][triangles].astype(np.int32),
                            shape.faces[triangles], shape.face_count)
    for array in ("order", "parent", "first", "last", "volume", "area", "score"):
        assert np.array_equal(getattr(hierarchy, array), getattr(other, array)), array


def test_a_single_shell_is_built_as_before_beside_others():
    """Its subtree is the tree that it has alone."""
    torus = shapes.torus()
    alone = Hierarchy.build(*torus)
    both = Hierarchy.build(*shapes.merged(torus, shapes.moved(shapes.cube(), (9, 0, 0), 0.5)))
    for face in range(0, torus.face_count, 13):
        own = [set(alone.faces(int(stop)).tolist()) for stop in alone.wheel(face)[0]]
        beside = [set(both.faces(int(stop)).tolist()) for stop in both.wheel(face)[0]]
        assert beside[:len(own)] == own


def test_cavities_belong_to_the_shell_around_them():
    hollow = Hierarchy.build(*shapes.merged(shapes.box_with_cavity(), shapes.moved(shapes.cube(), (5, 0, 0))))
    assert (hollow.summary.shells, hollow.summary.cavities, hollow.summary.components) == (2, 1, 2)
    assert np.isclose(hollow.summary.volume, 27 - 1 + 1)
    # A solid inside a solid, oriented as one, is a shell of its own.
    inner = Hierarchy.build(*shapes.merged(shapes.moved(shapes.cube(), scale=3.0), shapes.moved(shapes.cube(), (1, 1, 1))))
    assert (inner.summary.shells, inner.summary.cavities) == (2, 0)
    assert np.isclose(inner.summary.volume, 27 + 1)


@pytest.mark.parametrize("bend", (0.0, 0.5, 3.0))
def test_sheets_become_thin_solids(bend):
    cloth = sheet(bend=bend)
    hierarchy = Hierarchy.build(*cloth)
    assert hierarchy.summary.fill_method == "sheet" and hierarchy.summary.sheets == hierarchy.summary.shells == 1
    assert "sheet" in hierarchy.notes and 0 < hierarchy.summary.volume < 0.01 * hierarchy.summary.hull_volume + 2
    assert len(hierarchy.order) == cloth.face_count
    check_solid(hierarchy.solid(len(hierarchy.parent) - 1))
    with pytest.raises(PartwheelError) as caught:
        Hierarchy.build(*cloth, open_surfaces=False)
    assert caught.value.status == Status.NOT_SOLID
    with pytest.raises(PartwheelError) as caught:
        Job(*cloth, open_surfaces=False, **UNLIMITED).result()
    assert caught.value.status == Status.NOT_SOLID


def test_a_shell_that_loses_surface_when_filled_from_points_becomes_a_thin_solid():
    """A box without a bottom, whose front goes on as open ground: from points, the ground is 71 % of the size away."""
    corners = [[x, y, z] for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))] + [[0, -3, 0], [1, -3, 0]]
    quads = [(4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7), (0, 1, 9, 8)]
    box = np.array(corners, float), np.array([triangle for a, b, c, d in quads for triangle in ((a, b, c), (a, c, d))])
    hierarchy = Hierarchy.build(*box)
    assert (hierarchy.summary.fill_method, hierarchy.summary.deviation) == ("sheet", 0)
    for options in ({"open_surfaces": False}, {"mode": Mode.PAPER}):  # there, this would be an error; the whole model
        from_points = Hierarchy.build(*box, **options).summary
        assert from_points.fill_method == "points" and from_points.deviation > 0.5


def test_belts_and_capes_are_not_closed_by_more_surface_than_they_have():
    belt = cylinder((0, 0, 0), 1.0, 0.2, sides=40)
    is_wall = np.ptp(belt.vertices[belt.triangles][:, :, 2], axis=1) > 0
    belt = belt._replace(triangles=belt.triangles[is_wall], faces=belt.faces[is_wall] - belt.faces[is_wall].min(),
                         face_count=40)
    hierarchy = Hierarchy.build(*belt)
    assert hierarchy.summary.fill_method == "sheet"
    assert hierarchy.summary.volume < 0.05  # its ends closed: 0.63
    drum = cylinder((0, 0, 0), 1.0, 2.0, sides=40)
    is_kept = drum.vertices[drum.triangles][:, :, 2].max(axis=1) > -1  # without one end
    hierarchy = Hierarchy.build(drum.vertices, drum.triangles[is_kept])
    assert hierarchy.summary.fill_method == "repaired" and hierarchy.summary.volume > 6


def test_awkward_sheets_are_built():
    """A Möbius strip, a book of five pages, a sheet folded flat, a bow tie, and a strip of needles."""
    angles = np.linspace(0, 2 * np.pi, 41)[:-1]
    edge = np.stack([np.cos(angles / 2) * np.cos(angles), np.cos(angles / 2) * np.sin(angles), np.sin(angles / 2)], -1)
    middle = np.stack([np.cos(angles), np.sin(angles), 0 * angles], -1) * 2
    n = len(angles)
    strip = shapes.polygons(np.vstack([middle + 0.4 * edge, middle - 0.4 * edge]),
                            [(i, i + n, i + 1 + n, i + 1) for i in range(n - 1)] + [(n - 1, 2 * n - 1, 0, n)])
    pages = [(0, 0, 0), (0, 0, 1)] + [(np.cos(a), np.sin(a), z) for a in np.arange(5) for z in (0, 1)]
    book = shapes.polygons(pages, [(0, 1, 3 + 2 * k, 2 + 2 * k) for k in range(5)])
    folded = shapes.polygons([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (1, 0.2, 1e-9), (0, 0.2, 1e-9)],
                             [(0, 1, 2, 3), (0, 5, 4, 1)])
    bow = shapes.polygons([(0, 0, 0), (1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0)], [(0, 1, 2), (0, 3, 4)])
    needles = shapes.polygons([(x * 1e-5, y, 0.0) for x in range(12) for y in (0, 1)],
                              [(2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1) for k in range(11)])
    for shape in (strip, book, folded, bow, needles):
        hierarchy = Hierarchy.build(*shape)
        assert hierarchy.summary.sheets == hierarchy.summary.shells
        assert sorted(hierarchy.order.tolist()) == list(range(shape.face_count))
        assert Hierarchy.load(hierarchy.save()).summary == hierarchy.summary


def test_copies_of_a_shell_count_once():
    parts = [*car()[:3], car()[2]]
    hierarchy = Hierarchy.build(*shapes.merged(*parts))
    assert hierarchy.summary.shells == 3
    assert np.isclose(hierarchy.summary.volume, sum(volume(p.vertices, p.triangles) for p in parts[:3]))
    first, copy = parts[0].face_count + parts[1].face_count, parts[0].face_count + parts[1].face_count + parts[2].face_count
    assert np.array_equal(hierarchy.leaf[first:copy], hierarchy.leaf[copy:])


def test_errors_of_a_shell_name_the_callers_faces():
    open_box = shapes.cube()
    open_box = open_box._replace(triangles=open_box.triangles[2:], faces=open_box.faces[2:] - 1, face_count=5)
    shape = shapes.merged(shapes.cube(), shapes.moved(open_box, (3, 0, 0)))
    with pytest.raises(PartwheelError) as caught:
        Hierarchy.build(*shape, fill_methods=FillMethod.EXACT)
    assert caught.value.status == Status.OPEN
    assert 6 <= caught.value.faces[0] < 11


def test_the_patches_of_one_surface_are_one_solid():
    """A box of six panels that don't quite meet, as CAD programs write them."""
    panels = []
    for axis in range(3):
        for side in (0, 1):
            grid = sheet(4, 4).vertices / 4 * 0.996 + 0.002
            vertices = np.roll(np.column_stack([grid[:, :2], np.full(len(grid), side)]), axis - 2, axis=1)
            panel = sheet(4, 4)._replace(vertices=vertices)
            panels.append(panel if side else shapes.turned_inside_out(panel))
    hierarchy = Hierarchy.build(*shapes.merged(*panels))
    assert hierarchy.summary.shells == 1 and hierarchy.summary.fill_method == "points"
    assert abs(hierarchy.summary.volume - 1) < 0.1


def test_loose_leaves_are_no_solid():
    """Their normals all point up, so that they wind around what is between them about as much as a solid would."""
    random = np.random.default_rng(0)
    leaves = [shapes.moved(sheet(1, 2, bend=0.1), offset) for offset in random.random((300, 3)) * 12]
    hierarchy = Hierarchy.build(*shapes.merged(*leaves))
    assert hierarchy.summary.shells == hierarchy.summary.sheets == 300


@pytest.mark.parametrize("exponent", (-120, 100))
def test_shells_join_alike_in_any_unit(exponent):
    shape = shapes.merged(*snowman())
    whole, scaled = (Hierarchy.build(*shape._replace(vertices=shape.vertices * unit)) for unit in (1.0, 2.0**exponent))
    assert np.array_equal(whole.parent, scaled.parent) and np.array_equal(whole.order, scaled.order)


def test_thousands_of_shells_are_built_and_loose_triangles_are_refused():
    links = [shapes.moved(box((0, 0, 0), (1, 1, 1)), (2 * (i % 30), 2 * (i // 30 % 30), 2 * (i // 900)), 0.7) for i in range(900)]
    hierarchy = Hierarchy.build(*shapes.merged(*links))
    assert hierarchy.summary.shells == 900
    depth = max(len(hierarchy.path(face)) for face in range(0, 900 * 6, 97))
    assert depth < 2 * np.log2(900)  # a notch takes the same time with many shells: they don't join one by one
    random = np.random.default_rng(0)
    triangles = np.arange(3 * 30000, dtype=np.int32).reshape(-1, 3)
    with pytest.raises(PartwheelError, match="30,000 loose pieces"):
        Hierarchy.build(random.random((90000, 3)), triangles)


# ---- Double walls


def corner_normals(vertices, triangles):
    corners = vertices[triangles]
    normals = np.zeros_like(vertices)
    np.add.at(normals, triangles.ravel(), np.repeat(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), 3, axis=0))
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)


def double_walled(shape, thickness, outward):
    """The shape with an inner wall at this share of its diagonal. outward: the inner wall winds as the outer one does."""
    vertices, triangles = shape.vertices, shape.triangles
    inner = triangles if outward else triangles[:, ::-1]
    moved = vertices - thickness * np.linalg.norm(np.ptp(vertices, axis=0)) * corner_normals(vertices, triangles)
    return np.vstack([vertices, moved]), np.vstack([triangles, inner + len(vertices)]).astype(np.int32)


def rand_error(a, b, weights):
    """1 - Rand index by area."""
    table = np.zeros((a.max() + 1, b.max() + 1))
    np.add.at(table, (a, b), weights)
    return ((table.sum(1) ** 2).sum() + (table.sum(0) ** 2).sum() - 2 * (table ** 2).sum()) / weights.sum() ** 2


@pytest.mark.parametrize("name, outward, thickness", (("homer", True, 0.005), ("elephant", False, 0.005), ("hand", False, 0.015)))
def test_a_double_wall_has_the_parts_of_the_solid(name, outward, thickness):
    shape = shapes.off(name)
    solid = Hierarchy.build(shape.vertices, shape.triangles)
    vertices, triangles = double_walled(shape, thickness, outward)
    hollow = Hierarchy.build(vertices, triangles)
    count = len(shape.triangles)
    assert hollow.summary.shells == 1 and "of the inner wall go with the outer wall" in hollow.notes
    labels = Cut.automatic(hollow).labels
    areas = triangle_areas(shape.vertices, shape.triangles)
    assert rand_error(Cut.automatic(solid).labels, labels[:count], areas) < 0.001
    assert (labels[:count] == labels[count:]).mean() > 0.9  # an inner face goes with the outer one in front of it
    for face in range(0, count, count // 20):
        expected = [set(solid.faces(int(stop)).tolist()) for stop in solid.wheel(face)[0]]
        actual = [{f for f in hollow.faces(int(stop)).tolist() if f < count} for stop in hollow.wheel(face)[0]]
        assert actual == expected and solid.wheel(face)[1] == hollow.wheel(face)[1]
    both = Hierarchy.build(vertices, triangles, keep_inner_walls=True)
    assert "inner wall" not in both.notes


def with_small_faces(shape, size):
    """The shape with a small face of this diameter, a share of its diagonal, inside each of five faces: the last five."""
    vertices, triangles = list(shape.vertices), shape.triangles
    around = np.array([1, 2, 4, 5, 6]) * len(triangles) // 7
    rings, small = [], []
    for corners in triangles[around]:
        places, first = shape.vertices[corners], len(vertices)
        arms = places - places.mean(axis=0)
        radius = size / 2 * np.linalg.norm(np.ptp(shape.vertices, axis=0))
        vertices += list(places.mean(axis=0) + arms * min(0.5, radius / np.linalg.norm(arms, axis=1).max()))
        for k, m in ((0, 1), (1, 2), (2, 0)):
            rings += [(corners[k], corners[m], first + m), (corners[k], first + m, first + k)]
        small.append((first, first + 1, first + 2))
    triangles = np.vstack([np.delete(triangles, around, axis=0), rings, small]).astype(np.int32)
    return shape._replace(vertices=np.array(vertices), triangles=triangles)


def leaky(triangles, vertex_count, leaks):
    """A double wall in which these outer faces, and the inner ones behind them, make way for the sides of a leak."""
    sides = []
    for a, b, c in triangles[leaks]:
        for k, m in ((a, b), (b, c), (c, a)):
            sides += [(k, m, m + vertex_count), (k, m + vertex_count, k + vertex_count)]
    return np.vstack([np.delete(triangles, [*leaks, *(leaks + len(triangles) // 2)], axis=0), sides]).astype(np.int32)


@pytest.mark.parametrize("name", ("homer", "elephant", "hand"))
@pytest.mark.parametrize("outward, thickness", ((False, 0.005), (True, 0.015)))
def test_a_double_wall_with_leaks_has_the_parts_of_the_solid(name, outward, thickness):
    shape = with_small_faces(shapes.off(name), 0.01)
    solid = Hierarchy.build(shape.vertices, shape.triangles)
    vertices, triangles = double_walled(shape, thickness, outward)
    count = len(shape.triangles) - 5
    hollow = Hierarchy.build(vertices, leaky(triangles, len(shape.vertices), np.arange(count, count + 5)))
    assert hollow.summary.shells == 1 and "of the inner wall go with the outer wall" in hollow.notes
    areas = triangle_areas(shape.vertices, shape.triangles)[:count]
    assert rand_error(Cut.automatic(solid).labels[:count], Cut.automatic(hollow).labels[:count], areas) <= 0.05
    overlaps = []
    for face in range(0, count, count // 50):
        (stops, start), (solid_stops, solid_start) = hollow.wheel(face), solid.wheel(face)
        actual, expected = (np.isin(np.arange(count), hierarchy.faces(int(node))) for hierarchy, node in
                            ((hollow, stops[start]), (solid, solid_stops[solid_start])))
        overlaps.append(areas[actual & expected].sum() / areas[actual | expected].sum())
    # Where a model is thinner than two such walls, as a quarter of the elephant is, the inner wall crosses itself.
    assert np.mean(overlaps) > {("homer", 0.015): 0.95, ("elephant", 0.015): 0.75}.get((name, thickness), 0.99)
