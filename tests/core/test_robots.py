# SPDX-License-Identifier: GPL-3.0-or-later
"""A whole URDF with hulls: read by yourdfpy and by MuJoCo, an arm of ten links."""

import json
import shutil
import xml.etree.ElementTree as ElementTree

import numpy as np
import open_models
import pytest
from partwheel.__main__ import main
from partwheel.convex import UrdfError, convert_urdf, write_obj
from scipy.spatial import ConvexHull

LINKS = 10


@pytest.fixture(scope="module")
def arm(tmp_path_factory):
    """A chain of ten links, of three meshes in turn, with origins, scales of which one mirrors, and what must stay."""
    folder = tmp_path_factory.mktemp("robot")
    (folder / "meshes").mkdir()
    for name, shape in (("stall", open_models.stall()), ("frame", open_models.frame()), ("tube", open_models.tube())):
        write_obj(folder / "meshes" / f"{name}.obj", [(name, shape.vertices, shape.triangles)])
    lines = ['<robot name="arm">', "<!-- by script -->",
             '<mujoco><compiler strippath="false" discardvisual="false"/></mujoco>',
             '<material name="red"><color rgba="1 0 0 1"/></material>']
    for number in range(LINKS):
        name = ("stall", "frame", "tube")[number % 3]
        scale = ("0.1 0.1 0.1", "-0.1 0.1 0.1")[number % 2]
        mesh = f'<origin xyz="0 0.02 {0.01 * number}" rpy="0.3 {0.1 * number} -0.5"/><geometry>' \
               f'<mesh filename="package://{folder.name}/meshes/{name}.obj" scale="{scale}"/></geometry>' \
            if number % 4 == 0 else f'<geometry><mesh filename="meshes/{name}.obj" scale="{scale}"/></geometry>'
        lines.append(f'<link name="link{number}"><inertial><origin xyz="0.1 0 {0.01 * number}"/><mass value="{1 + number}"/>'
                     '<inertia ixx="0.02" ixy="0" ixz="0" iyy="0.03" iyz="0" izz="0.04"/></inertial>'
                     f'<visual>{mesh}<material name="red"/></visual><collision name="c{number}">{mesh}</collision></link>')
        if number:
            lines.append(f'<joint name="joint{number}" type="revolute"><parent link="link{number - 1}"/>'
                         f'<child link="link{number}"/><origin xyz="0.4 0 0" rpy="0 0 0.2"/><axis xyz="0 1 0"/>'
                         '<limit lower="-1" upper="1" effort="5" velocity="2"/></joint>')
    lines.insert(-1, '<link name="tip"><collision><geometry><sphere radius="0.01"/></geometry></collision></link>'
                     '<joint name="fixed" type="fixed"><parent link="link0"/><child link="tip"/></joint>')
    source = folder / "arm.urdf"
    source.write_text("\n".join([*lines, "</robot>"]))
    return source


@pytest.fixture(scope="module")
def converted(arm, tmp_path_factory):
    return convert_urdf(arm, tmp_path_factory.mktemp("hulls"), hulls=8)


def without_collisions(path):
    """The text of a file without its collision meshes and paths."""
    root = ElementTree.parse(path).getroot()
    for link in root.iter("link"):
        for collision in link.findall("collision"):
            if collision.find("geometry/mesh") is not None:
                link.remove(collision)
    for element in root.iter():
        element.attrib.pop("filename", None)
        element.text, element.tail = (element.text or "").strip(), None
    return ElementTree.canonicalize(ElementTree.tostring(root))


def test_the_rest_of_the_robot_stays(arm, converted):
    assert without_collisions(arm) == without_collisions(converted.files[0])
    assert "by script" in converted.files[0].read_text() and set(converted.hulls) == {f"link{n}" for n in range(LINKS)}


def test_yourdfpy_finds_the_same_robot_with_hulls(arm, converted):
    yourdfpy = pytest.importorskip("yourdfpy")

    def load(path):
        def handler(fname):
            return str(arm.parent.parent / fname.split("://")[1] if "://" in fname else path.parent / fname)
        return yourdfpy.URDF.load(str(path), load_collision_meshes=True, build_collision_scene_graph=True,
                                  filename_handler=handler, force_collision_mesh=False)
    old, new = load(arm), load(converted.files[0])
    assert old.actuated_joint_names == new.actuated_joint_names and len(new.actuated_joint_names) == LINKS - 1
    pose = np.linspace(-0.9, 0.8, LINKS - 1)
    for robot in (old, new):
        robot.update_cfg(pose)
    for number in range(LINKS):
        np.testing.assert_array_equal(old.get_transform(f"link{number}"), new.get_transform(f"link{number}"))

    def points_of(robot, number):
        """The corners of each collision mesh of a link, in the world."""
        return [geometry.apply_transform(robot.collision_scene.graph.get(node)[0]).vertices
                for node in robot.collision_scene.graph.nodes_geometry
                for geometry in [robot.collision_scene.geometry[robot.collision_scene.graph.get(node)[1]].copy()]
                if robot.collision_scene.graph.transforms.parents[node] == f"link{number}"]
    for number in range(LINKS):
        before, after = np.concatenate(points_of(old, number)), points_of(new, number)
        assert len(after) == converted.hulls[f"link{number}"] > 1
        size = np.linalg.norm(np.ptp(before, axis=0))
        planes = [ConvexHull(points).equations for points in after]
        inside = np.array([(before @ plane[:, :3].T + plane[:, 3] < 1e-6 * size).all(axis=1) for plane in planes])
        assert inside.any(axis=0).all()  # all vertices of the mesh are in hulls
        np.testing.assert_allclose(np.concatenate(after).min(axis=0), before.min(axis=0), atol=1e-6 * size)
        np.testing.assert_allclose(np.concatenate(after).max(axis=0), before.max(axis=0), atol=1e-6 * size)


def test_the_arm_moves_as_before_in_mujoco(arm, converted, tmp_path, mujoco):
    ends = []
    for path in (arm, converted.files[0]):
        text = path.read_text().replace(f"package://{arm.parent.name}/", f"{arm.parent}/")  # MuJoCo has no packages
        local = path.with_name("local.urdf")
        local.write_text(text)
        model = mujoco.MjModel.from_xml_path(str(local))
        model.geom_contype[:] = 0  # the meshes themselves would be their own hulls
        state = mujoco.MjData(model)
        for _ in range(200):
            mujoco.mj_step(model, state)
        ends.append((state.qpos.copy(), state.xpos.copy(), [model.joint(i).name for i in range(model.njnt)]))
    assert ends[0][2] == ends[1][2]
    np.testing.assert_allclose(ends[1][0], ends[0][0], atol=1e-9)
    np.testing.assert_allclose(ends[1][1], ends[0][1], atol=1e-9)
    assert np.abs(ends[0][0]).max() > 0.01


# Of the arm at rest, in meters, seconds and kilograms. The arm is 4 m long.
DAMPING, FALL_STEPS = 8, 3000
SHELL, BALL_RADIUS = 800, 0.001  # tiny balls per link
BED_RADIUS, BED_STEP = 0.1, 0.25
REST_TOLERANCE = 0.02


def test_the_arm_rests_on_a_bed_of_balls_as_the_original_does(arm, converted, tmp_path, mujoco):
    """The original is a shell of tiny balls all over the surface of each link: MuJoCo takes a mesh for its hull."""
    trimesh = pytest.importorskip("trimesh")

    def rest(path, has_shell=False):
        """(links, 3) where the links are after a fall."""
        local = path.with_name("local.urdf")
        local.write_text(path.read_text().replace(f"package://{arm.parent.name}/", f"{arm.parent}/"))
        spec = mujoco.MjSpec.from_file(str(local))
        spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
        for geom in spec.geoms:
            geom.conaffinity = 0
            geom.contype = int(geom.contype and not has_shell)
        for number in range(1, LINKS) if has_shell else ():
            shape = getattr(open_models, ("stall", "frame", "tube")[number % 3])()
            surface = trimesh.Trimesh(shape.vertices, shape.triangles, process=False)
            points = surface.sample(SHELL, seed=0) * ([-0.1, 0.1, 0.1] if number % 2 else 0.1)
            if number % 4 == 0:
                turn = trimesh.transformations.euler_matrix(0.3, 0.1 * number, -0.5, "sxyz")
                points = points @ turn[:3, :3].T + [0, 0.02, 0.01 * number]
            body = spec.body(f"link{number}")
            for point in points:
                body.add_geom(type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[BALL_RADIUS, 0, 0], pos=point, contype=1, conaffinity=0)
        for x in np.arange(-1, 4.5, BED_STEP):
            for y in np.arange(-1.5, 3.5, BED_STEP):
                spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[BED_RADIUS, 0, 0], pos=[x, y, -0.7], contype=0,
                                        conaffinity=1)
        model = spec.compile()
        model.dof_damping[:] = DAMPING
        state = mujoco.MjData(model)
        for _ in range(FALL_STEPS):
            mujoco.mj_step(model, state)
        assert state.ncon > 3
        return np.array([state.body(f"link{number}").xpos for number in range(1, LINKS)])

    original = rest(arm, has_shell=True)
    assert original[-1, 2] < -0.3 and original[:, 2].max() - original[:, 2].min() > 0.3  # fallen, and held by the base
    assert np.linalg.norm(rest(converted.files[0]) - original, axis=1).max() < REST_TOLERANCE


def test_density_replaces_mass_and_inertia(arm, tmp_path):
    trimesh = pytest.importorskip("trimesh")
    robot = convert_urdf(arm, tmp_path, density=500, hulls=2)
    root = ElementTree.parse(robot.files[0]).getroot()
    for number, name in ((3, "stall"), (8, "tube")):  # mirrored without an origin; turned
        link = next(link for link in root.iter("link") if link.get("name") == f"link{number}")
        shape = getattr(open_models, name)()
        expected = trimesh.Trimesh(shape.vertices * ([-0.1, 0.1, 0.1] if number % 2 else 0.1),
                                   shape.triangles[:, ::-1] if number % 2 else shape.triangles, process=False)
        if number % 4 == 0:
            turn = trimesh.transformations.euler_matrix(0.3, 0.1 * number, -0.5, "sxyz")
            turn[:3, 3] = 0, 0.02, 0.01 * number
            expected.apply_transform(turn)
        inertial = link.find("inertial")
        assert float(inertial.find("mass").get("value")) == pytest.approx(500 * expected.volume, rel=1e-6)
        center = np.array(inertial.find("origin").get("xyz").split(), float)
        np.testing.assert_allclose(center, expected.center_mass, atol=1e-6)
        actual = [float(inertial.find("inertia").get(key)) for key in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")]
        np.testing.assert_allclose(actual, 500 * expected.moment_inertia[np.triu_indices(3)], rtol=1e-6, atol=1e-9)
    tip = next(link for link in root.iter("link") if link.get("name") == "tip")
    assert tip.find("inertial") is None


def test_the_command_line_adds_hulls_to_a_robot(arm, tmp_path, capsys):
    source = shutil.copytree(arm.parent, tmp_path / arm.parent.name) / "arm.urdf"
    assert main(["convex", str(source), "-o", str(tmp_path / "out"), "--hulls", "3", "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["hulls"] == sum(report["links"].values()) and len(report["links"]) == LINKS
    assert main(["convex", str(source), "-o", str(tmp_path / "out"), "--hulls", "3"]) == 0
    assert f"{report['hulls']} hulls" in capsys.readouterr().out
    for wrong in (["--formats", "glb"], ["--primitives", "1"]):
        with pytest.raises(SystemExit):
            main(["convex", str(source), "-o", str(tmp_path / "out"), *wrong])
    (source.parent / "meshes" / "tube.obj").unlink()
    assert main(["convex", str(source), "-o", str(tmp_path / "out"), "--json"]) == 1
    error = json.loads(capsys.readouterr().out)["error"]
    assert error["name"] == "urdf" and "tube.obj" in error["message"]


def test_files_that_are_no_robot(tmp_path):
    for text in ("<robot", "<sdf/>"):
        (tmp_path / "x.urdf").write_text(text)
        with pytest.raises(UrdfError):
            convert_urdf(tmp_path / "x.urdf", tmp_path / "out", hulls=4)
