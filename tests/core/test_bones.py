# SPDX-License-Identifier: GPL-3.0-or-later
"""Bones of a cut, beside shapes whose bones are known."""

import functools

import numpy as np
import pytest
import trimesh
from conftest import ROOT
from partwheel import Hierarchy, meshes
from partwheel.cut import Cut, bones, link_parts, mirror_planes, name_parts, part_borders, part_tree, skin_weights
from solid_checks import volume

SIDES, RADIUS = 24, 0.5


def tube(lengths, sides=SIDES, radius=RADIUS, step=0.25):
    """(vertices, triangles, labels) of a closed cylinder along z, in parts of these lengths."""
    ends = np.cumsum([0, *lengths])
    heights = np.unique(np.concatenate([np.linspace(a, b, round((b - a) / step) + 1) for a, b in zip(ends, ends[1:])]))
    angle = 2 * np.pi * np.arange(sides) / sides
    rings = [np.column_stack([radius * np.cos(angle), radius * np.sin(angle), np.full(sides, z)]) for z in heights]
    vertices = np.vstack([*rings, [[0, 0, ends[0]], [0, 0, ends[-1]]]])
    triangles = []
    for ring in range(len(heights) - 1):
        for k in range(sides):
            a, b = ring * sides + k, ring * sides + (k + 1) % sides
            triangles += [(a, b, a + sides), (b, b + sides, a + sides)]
    last = (len(heights) - 1) * sides
    for k in range(sides):
        triangles += [(len(vertices) - 2, (k + 1) % sides, k),
                      (len(vertices) - 1, last + k, last + (k + 1) % sides)]
    triangles = np.array(triangles)
    z = vertices[triangles].mean(axis=1)[:, 2]
    return vertices, triangles, np.searchsorted(ends[1:-1], z, side="right")


class Volumes:
    """What link_parts() asks of a cut: parts in a row, joined from the first on."""

    def __init__(self, volumes):
        self.volumes = volumes

    def __len__(self):
        return len(self.volumes)

    def volume(self, part):
        return self.volumes[part]

    def common_ancestor(self, one, other):
        return max(one, other)


def bones_of(vertices, triangles, labels, volumes):
    middles = np.array([vertices[triangles[labels == part]].mean(axis=(0, 1)) for part in range(len(volumes))])
    return bones(vertices, triangles, labels, link_parts(
        Volumes(volumes), part_borders(vertices, triangles, labels), middles),
                 skin_weights(vertices, triangles, labels, len(volumes)))


def assert_ends(bone, head, tail, close=1e-9):
    assert abs(bone.head - head).max() < close and abs(bone.tail - tail).max() < close, bone


@pytest.mark.parametrize("turn", [np.eye(3), trimesh.transformations.rotation_matrix(2, (1, 2, 3))[:3, :3]])
def test_a_chain_of_cylinders(turn):
    vertices, triangles, labels = tube((2, 4, 3, 1))
    at = {z: turn @ (0, 0, z) for z in (0, 2, 6, 9, 10)}
    chain = bones_of(vertices @ turn.T, triangles, labels, (2, 4, 3, 1))
    assert [bone.parent for bone in chain] == [1, -1, 1, 2]
    up = at[10] if (turn @ (0, 0, 1))[abs(turn @ (0, 0, 1)).argmax()] > 0 else at[0]
    head, tail = (at[2], at[6]) if (up == at[10]).all() else (at[6], at[2])
    assert_ends(chain[1], head, tail)  # through it from end to end
    assert_ends(chain[0], at[2], at[0])
    assert_ends(chain[2], at[6], at[9])
    assert_ends(chain[3], at[9], at[10])
    assert chain[3].is_connected and not chain[1].is_connected
    assert chain[2].is_connected == bool((tail == at[6]).all()) and chain[0].is_connected == bool((tail == at[2]).all())


def bent(vertices, bone, axis, angle, share):
    """vertices, each turned about the bone's head by its share of an angle, as bones with "Preserve Volume" do."""
    turn = 2 * np.arctan2(share * np.sin(angle / 2), 1 - share + share * np.cos(angle / 2))[:, None]
    from_head = vertices - bone.head
    return (bone.head + from_head * np.cos(turn) + np.cross(axis, from_head) * np.sin(turn)
            + (from_head @ axis)[:, None] * axis * (1 - np.cos(turn)))


def test_bending_keeps_the_volume():
    vertices, triangles, labels = tube((4, 4), sides=48, step=0.0625)
    # A limb with a ridge along one side, and a lump before the joint: the middle of the border is not where it turns best.
    angle, z = np.arctan2(vertices[:, 1], vertices[:, 0]), vertices[:, 2]
    grown = 1 + 0.6 * np.maximum(np.cos(angle - 0.5), 0) ** 4 + 0.5 * np.exp(-((z - 3.6) / 0.3) ** 2) * np.cos(angle + 1)
    vertices[:, :2] *= grown[:, None]
    border = part_borders(vertices, triangles, labels)[0]
    for open_end in (False, True):  # holes elsewhere don't matter
        remaining = triangles[:-48] if open_end else triangles
        head = bones_of(vertices, remaining, labels[:len(remaining)], (2, 1))[1]
        assert np.linalg.norm(head.head - border.center) > 0.03 * border.radius
        share = np.zeros(len(vertices))
        weighted, values = skin_weights(vertices, remaining, labels[:len(remaining)], 2)[1]
        share[weighted] = values
        before, middle = volume(vertices, triangles), head._replace(head=border.center)
        for axis in (np.eye(3)[0], np.eye(3)[1], np.array([-0.8, 0.6, 0])):
            changed, at_middle = (abs(volume(bent(vertices, bone, axis, np.pi / 3, share), triangles) / before - 1)
                                  for bone in (head, middle))
            assert changed < 0.002, (axis, changed, at_middle)
        assert changed < 0.2 * at_middle


def blocks(cells, label_of):
    """(vertices, triangles, labels) of the surface of unit cubes, cells (X,Y,Z) bool. label_of(x, y): of a cube."""
    quads, labels = [], []
    for cell in np.argwhere(cells):
        for axis in range(3):
            for side in (0, 1):
                neighbor = cell.copy()
                neighbor[axis] += 2 * side - 1
                inside = (neighbor >= 0).all() and (neighbor < cells.shape).all() and cells[tuple(neighbor)]
                if not inside:
                    corner = cell.copy()
                    corner[axis] += side
                    u, v = np.eye(3, dtype=int)[[(axis + 1) % 3, (axis + 2) % 3]]
                    ring = [corner, corner + u, corner + u + v, corner + v]
                    quads.append(ring if side else ring[::-1])
                    labels.append(label_of(*cell[:2]))
    vertices, index = np.unique(np.array(quads).reshape(-1, 3), axis=0, return_inverse=True)
    index = index.reshape(-1, 4)
    return vertices.astype(float), np.vstack([index[:, :3], index[:, [0, 2, 3]]]), np.tile(labels, 2)


def test_a_leg_ends_at_its_toes():
    cells = np.zeros((8, 14, 2), bool)
    cells[0:2] = True
    cells[2:8, 12:14] = True  # the foot
    bones_found = bones_of(*blocks(cells, lambda x, y: int(y >= 5)), (50, 40))
    assert_ends(bones_found[0], (1, 0, 1), (1, 5, 1))
    assert_ends(bones_found[1], (1, 5, 1), (8, 13, 1), 1.5)


def test_the_roots_bone_lies_in_a_mirror_plane():
    vertices, triangles, labels = tube((4,))
    leaning = vertices + vertices[:, 2:] * (0.2, 0.1, 0)
    root = link_parts(Volumes((4,)), [], np.zeros((1, 3)))
    whole = skin_weights(leaning, triangles, labels, 1)
    free, = bones(leaning, triangles, labels, root, whole)
    assert (free.tail - free.head)[:2] == pytest.approx((0.8, 0.4), abs=0.15)
    bone, = bones(leaning, triangles, labels, root, whole, [(np.array([1.0, 0, 0]), 0.35)])
    assert (bone.head[0], bone.tail[0]) == pytest.approx((0.35, 0.35)) and (bone.head[1:] == free.head[1:]).all()
    far, = bones(leaning, triangles, labels, root, whole, [(np.array([1.0, 0, 0]), 2.0), (np.array([0, 0, 1.0]), 2.0)])
    assert (far.head == free.head).all() and (far.tail == free.tail).all()


@functools.cache
def real(name):
    """(Mesh, Cut, its Links, its Bones)"""
    mesh = meshes.read(ROOT / "build" / "deps" / "meshes" / f"{name}.off")
    cut = Cut.automatic(Hierarchy.build(mesh.vertices, mesh.triangles, mesh.faces, mesh.face_count))
    labels = cut.labels[mesh.faces]
    links = part_tree(cut, mesh.vertices, mesh.triangles, labels)
    shares = skin_weights(mesh.vertices, mesh.triangles, labels, len(cut))
    return mesh, cut, links, bones(mesh.vertices, mesh.triangles, labels, links, shares,
                                  mirror_planes(mesh.vertices, mesh.triangles))


@pytest.mark.parametrize("name", ["homer", "elephant", "cow", "pig"])
def test_real_models(name):
    mesh, _, hung, found = real(name)
    assert [bone.parent for bone in found] == [link.parent for link in hung]
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    slack = 0.05 * np.linalg.norm(high - low)
    for bone, link in zip(found, hung):
        assert link.border is None or np.linalg.norm(bone.head - link.border.center) <= 0.501 * link.border.radius
        assert (np.minimum(bone.head, bone.tail) > low - slack).all()
        assert (np.maximum(bone.head, bone.tail) < high + slack).all()
        assert np.linalg.norm(bone.tail - bone.head) > 1e-3 * np.linalg.norm(high - low)
        assert not bone.is_connected or np.linalg.norm(found[bone.parent].tail - bone.head) < 0.01 * slack / 0.05


def test_mirror_images_have_mirrored_bones():
    mesh, cut, _, found = real("homer")
    names = name_parts(cut, *mesh[:3])
    (normal, offset), = mirror_planes(mesh.vertices, mesh.triangles)
    size = np.linalg.norm(np.ptp(mesh.vertices, axis=0))
    pairs = [(names.index(name), names.index(name.replace(".L", ".R"))) for name in names if ".L" in name]
    assert len(pairs) >= 3  # legs, arms, eyes
    parent_names = [names[bone.parent].removesuffix(".L").removesuffix(".R") for bone in found]
    assert all(parent_names[left] == parent_names[right] for left, right in pairs)
    for left, right in pairs:
        # Of a part that is as wide as long which end is the farthest is a matter of a triangle.
        for one, other, near in zip(found[left][:2], found[right][:2], (0.01, 0.07)):
            assert np.linalg.norm(one - 2 * (one @ normal - offset) * normal - other) < near * size
