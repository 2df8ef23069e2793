# SPDX-License-Identifier: GPL-3.0-or-later
"""Convex parts in Python and on the command line: their hulls by scipy's, their files by the readers that they are for."""

import json
from xml.etree import ElementTree

import numpy as np
import open_models
import pytest
import shapes
from conftest import built
from partwheel import Hierarchy, PartwheelError, convex, meshes
from partwheel.__main__ import main
from scipy.spatial.transform import Rotation
from solid_checks import volume

HAND = shapes.MESHES / "hand.off"


def hulls_of(shape, *arguments, **options):
    return [part.vertices for part in Hierarchy.build(shape.vertices, shape.triangles).convex_parts(*arguments, **options)]


@pytest.mark.parametrize("count", [10, 12, 16])
def test_door_and_window_of_a_house_stay_free(count):
    house = open_models.house()
    hulls = hulls_of(house, count)
    assert len(hulls) == 10 and not open_models.covered(hulls, house.openings).any()
    assert open_models.volume_ratio(hulls, house) == pytest.approx(1, abs=1e-6)


# Hulls around a hole leave at most a polygon with a side for each of them, and one hull can be at both holes.
@pytest.mark.parametrize("sides, count, free", [(64, 4, 0.3), (64, 8, 0.75), (64, 16, 0.94), (8, 11, 1), (6, 8, 0.91), (6, 9, 1)])
def test_holes_of_a_plate_stay_free(sides, count, free):
    plate = open_models.plate(sides)
    hulls = hulls_of(plate, count)
    assert len(hulls) <= count and 1 - open_models.covered(hulls, plate.openings).mean() >= free


@pytest.mark.parametrize("name", open_models.MODELS)
def test_convex_pieces_of_a_model_are_found(name):
    shape = open_models.MODELS[name]()
    hulls = hulls_of(shape, max(24, shape.exact))
    if shape.exact:
        assert len(hulls) <= shape.exact + 2 * (name == "frame")
        assert not open_models.covered(hulls, shape.openings).any()
        assert open_models.volume_ratio(hulls, shape) == pytest.approx(1, abs=1e-3)
    else:
        assert open_models.covered(hulls, shape.openings).mean() < 0.15


# Fewer than these are possible where a hull may leave the wall: the exact ones have one for each side.
@pytest.mark.parametrize("shape, most", [("tube(8)", 8), ("tube(64)", 10), ("beaker(16)", 10), ("beaker(64)", 11),
                                         ("bowl(24)", 15), ("bowl(48)", 15)])
def test_thin_walls_need_few_hulls(shape, most):
    check_error(eval(f"open_models.{shape}"), 0.2, most)


def test_dents_need_few_hulls():
    check_error(open_models.dented_ball(), 0.07, 8)


def check_error(shape, error, most):
    parts = Hierarchy.build(shape.vertices, shape.triangles).convex_parts(error=error)
    assert len(parts) <= most and max(part.error for part in parts) <= error


def test_hulls_of_a_part_and_of_the_rest():
    _, hierarchy = built("hand.off")
    size = np.ptp(hierarchy.vertices, axis=0).max()
    node = max(np.flatnonzero(hierarchy.volume < 0.1 * hierarchy.volume.max()), key=lambda n: hierarchy.volume[n])
    part = int(hierarchy.tet_first[node]), int(hierarchy.tet_last[node])
    rest = [(0, part[0])] * (part[0] > 0) + [(part[1], len(hierarchy.tetrahedra))] * (part[1] < len(hierarchy.tetrahedra))
    corners = hierarchy.vertices[hierarchy.tetrahedra]
    centers, volumes = corners.mean(axis=1), abs(np.linalg.det(corners[:, 1:] - corners[:, :1])) / 6
    inside = np.zeros(len(centers), bool)
    inside[slice(*part)] = True
    for slices, options, mine in (([part], {"error": 0.01 * size}, inside), (rest, {"hulls": 6}, ~inside)):
        hulls = hierarchy.convex_parts(slices=slices, **options)
        assert open_models.covered([hull.vertices for hull in hulls], centers)[mine].all()
        assert sum(hull.volume for hull in hulls) == pytest.approx(volumes[mine].sum())
    for wrong in ([(3, 3)], [(0, 5), (4, 8)], [(0, len(volumes) + 1)]):
        with pytest.raises(PartwheelError):
            hierarchy.convex_parts(2, slices=wrong)


def test_a_ball_passes_where_it_passes_the_model():
    """keep_open: where the ball fits, distances by libigl, no hull is, or one has a larger error."""
    igl = pytest.importorskip("igl")
    for shape, count, radius, enough in (("house", 12, 0.4, True), ("house", 4, 0.4, False), ("plate(32)", 14, 0.5, True),
                                         ("plate(32)", 3, 0.5, False), ("arcade", 8, 0.3, True)):
        shape = eval(f"open_models.{shape.rstrip(')')}" + ("" if ")" in shape else "(") + ")")
        parts = Hierarchy.build(shape.vertices, shape.triangles).convex_parts(count, keep_open=radius)
        squared = igl.point_mesh_squared_distance(shape.openings, shape.vertices, shape.triangles.astype(np.int64))[0]
        is_wide = squared > radius ** 2
        is_covered = open_models.covered([part.vertices for part in parts], shape.openings)
        assert is_wide.any() and len(parts) <= count
        assert (max(part.error for part in parts) <= radius) == enough
        assert enough is not (is_wide & is_covered).any()
        for part in parts:
            if (open_models.covered([part.vertices], shape.openings) & is_wide).any():
                assert part.error > radius


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    folder = tmp_path_factory.mktemp("hulls")
    model = folder / "my hand.off"
    model.write_bytes(HAND.read_bytes())
    formats = ",".join(convex.FORMATS)
    assert main(["convex", str(model), "-o", str(folder / "out"), "--hulls", "9", "--max-vertices", "64", "--formats",
                 formats, "--json"]) == 0
    mesh = meshes.read(HAND)
    parts = Hierarchy.build(mesh.vertices, mesh.triangles, mesh.faces, mesh.face_count).convex_parts(9, max_vertices=64)
    return folder / "out", [volume(*part[:2]) for part in parts]


@pytest.fixture(scope="module")
def expected_mass():
    """Mass, center and inertia of the hand at the default density, by trimesh, from its surface."""
    trimesh = pytest.importorskip("trimesh")
    hand = trimesh.Trimesh(*meshes.read(HAND)[:2], process=False)
    return 1000 * hand.volume, hand.center_mass, 1000 * hand.moment_inertia


def check_mass(actual, expected, tolerance=1e-6):
    for value, wanted in zip(actual, expected):
        np.testing.assert_allclose(value, wanted, rtol=tolerance, atol=tolerance * np.abs(wanted).max())


def test_mass_is_that_of_the_solid(expected_mass):
    _, hierarchy = built("hand.off")
    check_mass(convex.mass_properties(hierarchy), expected_mass, 1e-9)
    cube = shapes.cube()
    low, size = cube.vertices.min(axis=0), np.ptp(cube.vertices, axis=0)
    far = Hierarchy.build((cube.vertices - low) / size * [1, 2, 3] + 1000, cube.triangles)
    mass, center, inertia = convex.mass_properties(far, 2)
    assert mass == pytest.approx(12) and center == pytest.approx([1000.5, 1001, 1001.5])
    np.testing.assert_allclose(inertia, np.diag([13, 10, 5]), rtol=1e-9, atol=1e-9)  # m / 12 (b^2 + c^2), ...


def test_files_for_engines(written):
    trimesh = pytest.importorskip("trimesh")
    folder, volumes = written
    model = meshes.read(HAND)
    unreal = [f"UCX_my_hand_{number:02}" for number in range(9)]
    lines = (folder / "my_hand_hulls.obj").read_text().splitlines()
    assert [line[2:] for line in lines if line[0] == "o"] == unreal
    assert trimesh.load(folder / "my_hand_hulls.obj").volume == pytest.approx(sum(volumes), rel=1e-9)
    for name, names, has_model in (("my_hand_hulls.glb", unreal, False), ("my_hand_unreal.glb", unreal, True),
                             ("my_hand_godot.glb", [f"my_hand_{n:02}-convcolonly" for n in range(9)], True)):
        scene = trimesh.load(folder / name, force="scene")
        assert set(scene.geometry) == {*names, *(["my_hand"] if has_model else [])}
        for shape_name, expected in zip(names, volumes):
            assert scene.geometry[shape_name].is_watertight
            assert scene.geometry[shape_name].volume == pytest.approx(expected, rel=1e-4)  # glb has single precision
        if has_model:
            assert len(scene.geometry["my_hand"].faces) == len(model.triangles)


def rotation(quaternion):
    """The matrix of a quaternion w, x, y, z."""
    return Rotation.from_quat(np.roll(quaternion, -1)).as_matrix()


def test_mujoco_takes_the_hulls(written, mujoco, expected_mass):
    folder, volumes = written
    model = mujoco.MjModel.from_xml_path(str(folder / "my_hand.xml"))
    assert model.nmesh == model.ngeom == 10 and model.nbody == 2 and max(model.mesh_vertnum[1:]) <= 64
    assert list(model.geom_group) == [2, *[3] * 9] and list(model.geom_contype) == [0, *[1] * 9]
    axes = rotation(model.body_iquat[1])
    check_mass((model.body_mass[1], model.body_ipos[1], axes * model.body_inertia[1] @ axes.T), expected_mass)
    state = mujoco.MjData(model)
    mujoco.mj_step(model, state)
    assert state.qpos[2] < 0


def test_urdf_has_the_mass(written, expected_mass):
    inertial = ElementTree.parse(written[0] / "my_hand.urdf").find("link/inertial")
    inertia = {name: float(entry) for name, entry in inertial.find("inertia").items()}
    check_mass((float(inertial.find("mass").get("value")), np.array(inertial.find("origin").get("xyz").split(), float),
                np.array([[inertia["i" + "".join(sorted(a + b))] for b in "xyz"] for a in "xyz"])), expected_mass)


def test_usd_has_all_hulls(written, expected_mass):
    pytest.importorskip("pxr")
    from pxr import Usd, UsdGeom, UsdPhysics
    folder, volumes = written
    stage = Usd.Stage.Open(str(folder / "my_hand.usda"))
    body = stage.GetDefaultPrim()
    assert body.GetName() == "my_hand" and body.HasAPI(UsdPhysics.RigidBodyAPI)
    mass = UsdPhysics.MassAPI(body)
    turn = mass.GetPrincipalAxesAttr().Get()
    axes = rotation([turn.GetReal(), *turn.GetImaginary()])
    check_mass((mass.GetMassAttr().Get(), mass.GetCenterOfMassAttr().Get(),
                axes * np.array(mass.GetDiagonalInertiaAttr().Get()) @ axes.T), expected_mass, 1e-5)  # single precision
    assert UsdGeom.GetStageMetersPerUnit(stage) == 1 and UsdGeom.GetStageUpAxis(stage) == UsdGeom.Tokens.z
    bodies = UsdPhysics.UsdPhysicsLoadStageFromPrimRange(stage, ["/"])[UsdPhysics.ObjectType.RigidBody]
    assert [len(mesh_body.collisions) for mesh_body in bodies[1]] == [9]  # what a simulator finds
    shapes = [UsdGeom.Mesh(prim) for prim in body.GetChildren()]
    assert [shape.GetPath().name for shape in shapes] == ["model", *(f"hull_{number:02}" for number in range(9))]
    meshes_of = [(np.array(shape.GetPointsAttr().Get(), float), np.array(shape.GetFaceVertexIndicesAttr().Get()).reshape(-1, 3))
                 for shape in shapes]
    for shape, (vertices, triangles) in zip(shapes, meshes_of):
        assert list(shape.GetFaceVertexCountsAttr().Get()) == [3] * len(triangles)
        assert shape.GetSubdivisionSchemeAttr().Get() == "none"
        np.testing.assert_array_equal(shape.GetExtentAttr().Get(), [vertices.min(axis=0), vertices.max(axis=0)])
    for shape, (vertices, triangles), expected in zip(shapes[1:], meshes_of[1:], volumes):
        assert shape.GetPrim().HasAPI(UsdPhysics.CollisionAPI) and shape.GetPurposeAttr().Get() == "guide"
        assert UsdPhysics.MeshCollisionAPI(shape).GetApproximationAttr().Get() == "convexHull"
        assert volume(vertices, triangles) == pytest.approx(expected, rel=1e-4)
    model = meshes.read(HAND)
    np.testing.assert_array_equal(meshes_of[0][0], model.vertices.astype(np.float32))
    np.testing.assert_array_equal(meshes_of[0][1], model.triangles)
    assert not shapes[0].GetPrim().HasAPI(UsdPhysics.CollisionAPI)


def test_command_line(tmp_path, capsys):
    model = str(HAND)
    size = np.ptp(meshes.read(HAND).vertices, axis=0).max()
    assert main(["convex", model, "-o", str(tmp_path), "--error", str(size / 10), "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["hulls"] > 1 and report["files"] == [str(tmp_path / "hand_hulls.obj")]
    model_of = {}
    for value in ("0", str(size)):
        assert main(["convex", model, "-o", str(tmp_path), "--hulls", "4", "--primitives", value, "--formats", "mjcf"]) == 0
        capsys.readouterr()
        model_of[value] = (tmp_path / "hand.xml").read_text()
    assert ['mesh="hull_00"' in text for text in model_of.values()] == [True, False]
    house = tmp_path / "house.obj"
    convex.write_obj(house, [("house", *open_models.house()[:2])])
    for count, covers in (("3", True), ("12", False)):
        assert main(["convex", str(house), "-o", str(tmp_path), "--hulls", count, "--keep-open", "0.4", "--json"]) == 0
        assert bool(json.loads(capsys.readouterr().out)["covering_hulls"]) == covers
    assert main(["convex", model, "-o", str(tmp_path), "--max-vertices", "5", "--json"]) == 1
    assert "at least 8" in json.loads(capsys.readouterr().out)["error"]["message"]
    for wrong in (["--hulls", "3", "--error", "1"], ["--formats", "fbx"]):
        with pytest.raises(SystemExit) as stopped:
            main(["convex", model, "-o", str(tmp_path), *wrong])
        assert stopped.value.code == 2


@pytest.fixture
def towers(tmp_path):
    """Two towers on a slab in one shell, of two materials and groups, and a box apart, in the first ones."""
    box = open_models.box
    pieces = [box((0, 0, 0), (5, 1, 1)), box((0, 0, 1), (1, 1, 3)), box((4, 0, 1), (5, 1, 3)), box((7, 0, 0), (8, 1, 1))]
    shape = open_models.model(pieces, passages=pieces)
    centers = shape.vertices[shape.triangles].mean(axis=1)
    is_tower = centers[:, 2] > 1 + 1e-9
    path = tmp_path / "towers.obj"
    lines = ["v {} {} {}".format(*vertex) for vertex in shape.vertices.tolist()]
    for number, chosen in enumerate((~is_tower, is_tower)):
        lines += [f"o group{number}", f"usemtl material{number}"]
        lines += ["f {} {} {}".format(*triangle) for triangle in (shape.triangles[chosen] + 1).tolist()]
    path.write_text("\n".join(["mtllib towers.mtl", *lines]) + "\n")
    path.with_suffix(".mtl").write_text("".join(f"newmtl material{number}\nKd {number} 0 0\n" for number in range(2)))
    path.with_suffix(".txt").write_text("\n".join(map(str, np.sort(is_tower).astype(int))))
    return path


@pytest.mark.parametrize("options, counts", [(["--each", "materials"], [2, 2]), (["--each", "groups"], [2, 2]),
                                             (["--each", "loose"], [3, 1]), (["--labels", "towers.txt"], [2, 2])])
def test_hulls_of_each_part_by_label(towers, options, counts, capsys):
    options = [str(towers.parent / option) if option.endswith(".txt") else option for option in options]
    assert main(["convex", str(towers), "-o", str(towers.parent), "--hulls", "3", "--json", *options]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["hulls_of_parts"] == counts
    hulls = meshes.read(towers.parent / "towers_hulls.obj")
    names = {name: hulls.vertices[hulls.triangles[hulls.nodes == number]].reshape(-1, 3)
             for number, name in enumerate(hulls.node_names)}
    boxes = sorted((tuple(points.min(axis=0)), tuple(points.max(axis=0))) for points in names.values())
    expected = [((0, 0, 0), (5, 1, 1)), ((0, 0, 1), (1, 1, 3)), ((4, 0, 1), (5, 1, 3)), ((7, 0, 0), (8, 1, 1))]
    # Tetrahedra at a border belong to one side, so the towers may reach into the slab.
    np.testing.assert_allclose(boxes, expected, atol=1e-5 if "loose" in options else 0.5)


def test_a_model_without_materials_has_no_hulls_by_material(tmp_path, capsys):
    assert main(["convex", str(HAND), "-o", str(tmp_path), "--each", "materials", "--json"]) == 1
    assert "--each loose" in json.loads(capsys.readouterr().out)["error"]["message"]


# shape, options, radius of a ball, where it starts, its velocity, and the box in which its center is in the end
BALLS = {
    "beaker": (open_models.beaker, {"error": 0.2}, 0.3, (0.2, 0, 3), (0, 0, 0), ((-0.7, -0.7, 0.1), (0.7, 0.7, 0.8))),
    "box": (open_models.open_box, {"error": 0.2}, 0.3, (0.2, 0.1, 3), (0, 0, 0), ((-0.7, -0.7, 0.1), (0.7, 0.7, 0.8))),
    "bowl": (open_models.bowl, {"error": 0.2}, 0.3, (0.1, 0, 1), (0, 0, 0), ((-0.4, -0.4, -0.9), (0.4, 0.4, 0))),
    "plate": (lambda: open_models.plate(32), {"hulls": 16}, 0.7, (3, 3, 2), (0, 0, 0), ((2, 2, -99), (4, 4, -1))),
    "kept open": (lambda: open_models.plate(32), {"hulls": 12, "keep_open": 0.6}, 0.5, (7, 3, 2), (0, 0, 0),
                  ((6, 2, -99), (8, 4, -1))),
    "door": (open_models.house, {"hulls": 12}, 0.4, (3.5, -0.45, 0.41), (0, 3, 0), ((0.3, 0.3, 0), (7.7, 5.7, 1)))}


@pytest.mark.parametrize("name", BALLS)
def test_a_ball_in_mujoco_passes_or_stays(name, mujoco):
    create, options, radius, start, velocity, (low, high) = BALLS[name]
    spec = mujoco.MjSpec()
    for number, points in enumerate(hulls_of(create(), **options)):
        spec.add_mesh(name=f"{number}", uservert=points.ravel(), inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_CONVEX)
        spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname=f"{number}")
    body = spec.worldbody.add_body(name="ball", pos=start)
    body.add_freejoint()
    body.add_geom(type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[radius, 0, 0], condim=6, friction=[1, 0.1, 0.1])
    model = spec.compile()
    state = mujoco.MjData(model)
    state.qvel[:3] = velocity
    for _ in range(1500):
        mujoco.mj_step(model, state)
    assert (np.array(low) < state.qpos[:3]).all() and (state.qpos[:3] < np.array(high)).all(), state.qpos[:3]
