# SPDX-License-Identifier: GPL-3.0-or-later
"""A limb turned at its joint: on real models, on limbs that people marked; where the joint is, on shapes that are known.
"""

import math
import os

import numpy as np
import pytest
import shapes
from partwheel.deform import FIXED, FREE, Deformation, surface_distances
from partwheel.joint import REACH, find_borders, find_joint
from test_deform import cylinder, edges_of, lengths, normals, turn

# A limb is what lies within half of a way along the surface from its tip: (model, the direction in which it ends, that
# way as a share of the model's diagonal). Away from the joint: farther from its border than 2.5 radii of the limb there.
AWAY = 2.5
LIMBS = [("man", (-1, 0, 0), 0.3), ("man", (0, 1, 0), 0.4), ("man", (0, 0, -1), 0.3), ("homer", (1, 0, 0), 0.3),
         ("elephant", (0, 0, -1), 0.4), ("elephant", (0, 1, 0), 0.3), ("diplodocus", (1, 0, 0), 0.2),
         ("diplodocus", (-1, 0, 0), 0.3), ("diplodocus", (0, 0, -1), 0.3), ("dino", (-1, 0, 0), 0.3),
         ("armadillo", (0, 0, 1), 0.3), ("armadillo", (1, 0, 0), 0.3), ("bull", (0, 0, -1), 0.3),
         ("bull", (0, 1, 0), 0.2), ("camel", (0, -1, 0), 0.2), ("homer", (0, 0, 1), 0.3)]
if "libasan" in os.environ.get("LD_PRELOAD", ""):  # the smaller ones do there
    LIMBS = LIMBS[3:6]


def folds(rest, bent, triangles):
    """How many edges were folded over: between two faces less than 90 degrees apart that are more than 150 apart now."""
    side = np.sort(np.vstack([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]))
    order = np.lexsort(side.T[::-1])
    same = np.flatnonzero((side[order[1:]] == side[order[:-1]]).all(axis=1))
    one, other = order[same] % len(triangles), order[same + 1] % len(triangles)

    def cosine(points):
        n = normals(points, triangles)
        n = n / np.maximum(np.linalg.norm(n, axis=1), 1e-30)[:, None]
        return (n[one] * n[other]).sum(axis=1)

    return ((cosine(rest) > 0) & (cosine(bent) < math.cos(math.radians(150)))).sum()


def turned(vertices, triangles, joint, degrees):
    """Where the vertices are after the part was turned at its joint, about an axis across the limb."""
    roles = joint.roles()
    axis = np.cross(vertices[roles == 0].mean(axis=0) - joint.center, (0.3, 0.5, 0.8))
    deformation = Deformation(vertices, triangles, roles)
    deformation.move_in_steps([turn(axis, degrees, joint.center)])
    return deformation.positions()


@pytest.mark.parametrize("name, direction, share", LIMBS)
def test_a_limb_keeps_its_lengths(name, direction, share):
    """By 90 degrees: edges away from the joint within 5 %. By 45: no face turned over."""
    vertices, triangles, *_ = shapes.off(name)
    length = share * np.linalg.norm(np.ptp(vertices, axis=0))
    along = surface_distances(vertices, triangles, [(vertices @ np.array(direction, float)).argmax()])
    at_joint = np.abs(along - length / 2) < 0.05 * length
    middle = vertices[at_joint].mean(axis=0)
    radius = np.linalg.norm(vertices[at_joint] - middle, axis=1).mean()
    joint = find_joint(vertices, triangles, (along[triangles] < length / 2).any(axis=1))
    assert np.linalg.norm(joint.center - middle) < radius
    assert 0.7 < joint.radius / radius < 1.3
    edges = edges_of(triangles)
    border = np.intersect1d(triangles[(along[triangles] < length / 2).any(axis=1)],
                            triangles[(along[triangles] >= length / 2).all(axis=1)])
    is_far = (surface_distances(vertices, triangles, border)[edges] > AWAY * radius).all(axis=1)
    limb = is_far & (along[edges] < length / 2).all(axis=1)
    assert limb.sum() > 100
    bent = turned(vertices, triangles, joint, 90)
    change = np.abs(lengths(bent, edges) / lengths(vertices, edges) - 1)
    assert change[is_far].max() < 0.05
    assert np.percentile(change[~is_far], 99.9) > 0.1  # it did bend
    assert np.linalg.norm(bent - vertices, axis=1)[edges[limb]].min() > 0.5 * radius  # and the limb went along
    assert folds(vertices, turned(vertices, triangles, joint, 45), triangles) == 0


def test_where_the_joint_of_a_tube_is():
    vertices, triangles = cylinder()
    middle = vertices[triangles].mean(axis=1)[:, 2]
    joint = find_joint(vertices, triangles, middle > 6)
    np.testing.assert_allclose(joint.center, (0, 0, 6), atol=1e-9)
    assert len(find_borders(vertices, triangles, middle > 6)) == 1
    assert joint.radius == pytest.approx(1, rel=0.02)
    assert joint.distance[joint.inner].max() == pytest.approx(4, rel=0.01)
    taller = vertices * np.where(vertices[:, 2:] > 6, (1, 1, 3), 1) - np.where(vertices[:, 2:] > 6, (0, 0, 12), 0)
    np.testing.assert_allclose(find_joint(taller, triangles, middle > 6).center, (0, 0, 6), atol=1e-9)  # of the border alone
    z, roles = vertices[:, 2], joint.roles()
    assert (roles[z > 6 + REACH + 0.2] == 0).all() and (z[roles == 0] > 6 + REACH - 0.2).all()
    assert (roles[z < 6 - REACH - 0.2] == FIXED).all() and (z[roles == FIXED] < 6 - REACH + 0.2).all()
    roles = find_joint(vertices, triangles, middle > 9).roles(5)  # a stump keeps half of itself, the other side is deep
    assert (z[roles == 0].min(), z[roles == FREE].min()) == pytest.approx((9.5, 4.5), abs=0.2)
