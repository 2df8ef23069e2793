# SPDX-License-Identifier: GPL-3.0-or-later
"""Models dropped in MuJoCo on a bed of fixed balls: where they come to rest as hulls, and as they are; and what a step costs.

MuJoCo takes a mesh for its hull, so the exact model is a shell of tiny balls, evenly over its surface: about a hundredth of
the diagonal apart, so that a ball of the bed sinks in between them by some thousandth. Mass and inertia are the closed model's
for all: shapes alone differ."""

import time

import mujoco
import numpy as np
from measures import sampled, volume
from scipy.spatial.transform import Rotation

# Lengths are of the model's diagonal, which is 1 m.
SHELL, RADIUS = 6_000, 0.0005  # tiny balls
BED = 0.12  # radius of a fixed ball
APART = 0.2  # their middles, in a grid; heights differ by up to a ball's radius
ROWS = 13
HEIGHT, SET_DOWN = 0.3, 0.01  # from which it drops; and how far over where it lay it is set down again
STEP, SECONDS = 0.002, 6.0
TIMED = 300  # steps at rest


def inertia(vertices, triangles):
    """Mass, middle, and the six numbers of the inertia about it, of a solid of density 1000."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    six = np.einsum("ij,ij->i", np.cross(a, b), c)
    mass = six.sum() / 6
    middle = ((a + b + c) * six[:, None]).sum(axis=0) / 24 / mass
    corners = np.stack([a, b, c]) - middle
    six = np.einsum("ij,ij->i", np.cross(corners[0], corners[1]), corners[2])
    total = corners.sum(axis=0)
    second = (np.einsum("kni,knj,n->ij", corners, corners, six) + np.einsum("ni,nj,n->ij", total, total, six)) / 120
    tensor = np.trace(second) * np.eye(3) - second
    return 1000 * mass, middle, 1000 * tensor[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]


def scene(mass, middle, tensor, add_body):
    """A bed, and a body that add_body(spec, body) gives its geometry."""
    spec = mujoco.MjSpec()
    spec.option.timestep = STEP
    draw = np.random.default_rng(0)
    for x in range(ROWS):
        for y in range(ROWS):
            place = [(x - ROWS // 2) * APART, (y - ROWS // 2) * APART, draw.uniform(-1, 0) * BED]
            spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[BED, 0, 0], pos=place)
    body = spec.worldbody.add_body(name="model", mass=mass, ipos=middle, fullinertia=tensor, explicitinertial=True)
    body.add_freejoint()
    add_body(spec, body)
    return spec.compile()


def of_hulls(hulls):
    def add(spec, body):
        for number, points in enumerate(hulls):
            spec.add_mesh(name=f"hull {number}", uservert=points.ravel(), inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_CONVEX)
            body.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname=f"hull {number}")
    return add


def of_shell(points):
    def add(spec, body):
        for point in points:
            body.add_geom(type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[RADIUS, 0, 0], pos=point)
    return add


def rest(model, pose):
    """Where it is after a while: place and quaternion; and milliseconds a step there."""
    state = mujoco.MjData(model)
    state.qpos[:] = pose
    for _ in range(round(SECONDS / STEP)):
        mujoco.mj_step(model, state)
    start = time.process_time()
    for _ in range(TIMED):
        mujoco.mj_step(model, state)
    return state.qpos.copy(), 1000 * (time.process_time() - start) / TIMED


def between(pose, other, middle):
    """How far the middle of mass has moved, and the angle in degrees."""
    turns = [Rotation.from_quat(state[[4, 5, 6, 3]]) for state in (pose, other)]
    places = [state[:3] + turn.apply(middle) for state, turn in zip((pose, other), turns)]
    return np.linalg.norm(places[1] - places[0]), np.degrees((turns[0].inv() * turns[1]).magnitude())


def dropped(vertices, triangles, decompositions):
    """decompositions: {name: hulls, points of each}. The exact model comes to rest, and each is set down there: how far it has
    then moved, {name: (meters, degrees, milliseconds a step)}; "exact" tells what that says."""
    scale = 1 / np.linalg.norm(np.ptp(vertices, axis=0))
    middle = (vertices.min(axis=0) + vertices.max(axis=0)) / 2

    def scaled(points):
        return scale * (np.asarray(points) - middle)

    solid = scaled(vertices)
    assert volume(solid, triangles) > 0
    of = inertia(solid, triangles)
    points = sampled(solid, triangles)[:SHELL]
    exact = scene(*of, of_shell(points))
    lying, _ = rest(exact, np.array([0, 0, HEIGHT - solid[:, 2].min(), 1, 0, 0, 0]))
    reset = lying + [0, 0, SET_DOWN, 0, 0, 0, 0]
    results = {}
    for name, model in {"exact": exact, **{name: scene(*of, of_hulls([scaled(points) for points in hulls]))
                                           for name, hulls in decompositions.items()}}.items():
        pose, step = rest(model, reset)
        results[name] = *map(float, between(lying, pose, of[1])), step
    return results
