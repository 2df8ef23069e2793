# SPDX-License-Identifier: GPL-3.0-or-later
"""Models with the properties of those that generators make from pictures: one closed surface of 40,000 triangles of one
size, with thin limbs, strands of hair, fins, fur."""

import numpy as np

SPIKES, SPIKE_RADIUS, SPIKE_LENGTH = 400, 0.05, 0.08  # of the fur; meters


def doll():
    """The example figure."""
    from partwheel import examples

    shape = examples.figure(0.01406)
    return shape.vertices, shape.triangles


def mermaid():
    """Twelve strands of hair around the head, arms, a tail with a fluke of rays."""
    from partwheel.examples import mirrored

    strands = [(angle, 0.17 * np.cos(angle), 0.12 + 0.15 * np.sin(angle)) for angle in np.linspace(0.1, np.pi / 2, 6)]
    return _melt(mirrored([
        ((0.15, 0, 1.30), 0.062, (0.30, -0.06, 1.08), 0.048),  # arm
        ((0.30, -0.06, 1.08), 0.048, (0.36, -0.26, 0.95), 0.036),
        ((0.36, -0.30, 0.94), 0.045, (0.37, -0.36, 0.93), 0.040),  # hand
        *[((0.37 + 0.03 * finger, -0.38, 0.93), 0.018, (0.37 + 0.05 * finger, -0.47, 0.92), 0.014) for finger in (-1, 0, 1)],
        *[cone for angle, x, y in strands for cone in (
            ((x, y, 1.70), 0.040, (1.3 * x, 1.4 * y, 1.35), 0.034),
            ((1.3 * x, 1.4 * y, 1.35), 0.034, (1.5 * x + 0.03 * np.sin(5 * angle), 1.5 * y, 0.95), 0.018))],
        *[((0.03, 0.42, 0.13), 0.035, (0.03 + 0.30 * np.sin(angle), 0.42 + 0.35 * np.cos(angle), 0.10), 0.016)
          for angle in (0.4, 0.8, 1.2, 1.6)],  # rays of the fluke
        ((0.16, 0.02, 0.62), 0.030, (0.28, 0.10, 0.48), 0.014),  # fin
    ]) + [
        ((0, -0.01, 1.62), 0.150, (0, 0.0, 1.70), 0.150),  # head
        ((0, 0, 1.36), 0.055, (0, 0, 1.48), 0.055),
        ((0, 0, 0.95), 0.120, (0, 0, 1.25), 0.130),  # body
        ((0, 0, 0.95), 0.135, (0, 0.02, 0.70), 0.160),
        ((0, 0.02, 0.70), 0.160, (0, 0.00, 0.42), 0.110),  # tail
        ((0, 0.00, 0.42), 0.110, (0, 0.18, 0.20), 0.070),
        ((0, 0.18, 0.20), 0.070, (0, 0.42, 0.13), 0.040),
    ], 0.0161)


def fox():
    """A sitting fox whose fur is hundreds of spikes."""
    from partwheel.examples import mirrored

    vertices, triangles = _melt(mirrored([
        ((0.14, -0.18, 0.62), 0.085, (0.15, -0.26, 0.10), 0.060),  # front leg
        ((0.15, -0.28, 0.07), 0.065, (0.16, -0.38, 0.06), 0.055),
        ((0.24, 0.20, 0.26), 0.170, (0.28, -0.02, 0.18), 0.110),  # hind leg
        ((0.29, -0.04, 0.07), 0.070, (0.30, -0.22, 0.06), 0.060),
        ((0.14, -0.18, 1.28), 0.080, (0.22, -0.15, 1.52), 0.030),  # ear
    ]) + [
        ((0, 0.18, 0.32), 0.260, (0, -0.10, 0.78), 0.190),  # body
        ((0, -0.12, 0.85), 0.140, (0, -0.20, 1.05), 0.130),
        ((0, -0.22, 1.14), 0.200, (0, -0.26, 1.18), 0.195),  # head
        ((0, -0.40, 1.09), 0.110, (0, -0.62, 1.06), 0.060),
        ((0, 0.45, 0.25), 0.080, (0.20, 0.70, 0.40), 0.150),  # tail
        ((0.20, 0.70, 0.40), 0.150, (0.25, 0.75, 0.85), 0.060),
    ], 0.017)
    normals = np.zeros_like(vertices)
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    for corner in range(3):
        np.add.at(normals, triangles[:, corner], np.cross(b - a, c - a))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    tips = np.random.default_rng(1).choice(len(vertices), SPIKES, replace=False)
    distances = np.array([np.linalg.norm(vertices - vertices[tip], axis=1) for tip in tips])
    heights = SPIKE_LENGTH * np.maximum(1 - distances.min(axis=0) / SPIKE_RADIUS, 0)
    return vertices + heights[:, None] * normals[tips[distances.argmin(axis=0)]], triangles


def _melt(cones, step):
    from partwheel.examples import melt

    vertices, quads = melt(cones, step)
    return vertices, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]).astype(np.int32)


MODELS = {"doll": doll, "mermaid": mermaid, "furry fox": fox}
