# SPDX-License-Identifier: GPL-3.0-or-later
"""Solids in files: 2-manifold after equal vertices in single precision are merged, as slicers and importers merge them."""

import manifold3d
import numpy as np
import pytest
import shapes
import trimesh
from partwheel import Hierarchy, convex, meshes
from partwheel.cut import Cut, files
from partwheel.separation import separate
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

BODY = manifold3d.Manifold


def beads():
    body = BODY.cylinder(200, 6, circular_segments=24).rotate((0, 90, 0))
    for x in (20, 100, 180):
        body += BODY.sphere(20, 48).translate((x, 0, 0))
    return body


def plate_with_holes():
    body = BODY.cube((90, 60, 8))
    for x, y in ((20, 20), (45, 40), (70, 20)):
        body -= BODY.cylinder(20, 8, circular_segments=16).translate((x, y, -5))
    return body


BUILT = {
    "beads": beads,
    "frame": lambda: BODY.cube((200, 200, 20)) - BODY.cube((160, 160, 30)).translate((20, 20, -5)),
    "U": lambda: BODY.cube((200, 120, 20)) - BODY.cube((180, 80, 30)).translate((20, 20, -5)),
    "bar": lambda: BODY.cylinder(200, 10, circular_segments=32).rotate((0, 90, 0)),
    "plate": plate_with_holes,
    "cross": lambda: BODY.cube((90, 10, 10), True) + BODY.cube((10, 90, 10), True) + BODY.cube((10, 10, 90), True),
    "ring": lambda: BODY.revolve(manifold3d.CrossSection.circle(5, 12).translate((30, 0)), 24),
    "hollow": lambda: BODY.sphere(30, 32) - BODY.sphere(20, 24),
    "far": lambda: beads().translate((50000, 0, 0)),
    "tiny": lambda: beads().scale((1e-4, 1e-4, 1e-4)),
}
MODELS = [*BUILT, *shapes.lighter(["homer", "elephant", "cow", "hand", "anchor", "cactus", "elk", "couplingdown", "bones",
                                   "handle"], 2)]


def surface_of(body):
    mesh = body.to_mesh64()
    return np.array(mesh.vert_properties[:, :3]), np.array(mesh.tri_verts, np.int32)


def check_manifold(vertices, triangles):
    """Asserts that each edge has two triangles, wound alike, and each body a volume. Returns the volume."""
    points, triangles = np.unique(np.asarray(vertices).astype(np.float32)[np.asarray(triangles)].reshape(-1, 3), axis=0,
                                  return_inverse=True)
    points, triangles = points.astype(np.float64), triangles.reshape(-1, 3).astype(np.int64)
    directed = triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    assert (directed[:, 0] != directed[:, 1]).all(), "a triangle is degenerate"
    ahead, back = (directed @ numbers for numbers in ([len(points), 1], [1, len(points)]))
    assert len(np.unique(ahead)) == len(ahead), "an edge has more than two triangles"
    assert np.array_equal(np.sort(ahead), np.sort(back)), "an edge is open"
    count, body = connected_components(coo_matrix((np.ones(len(directed)), directed.T), (len(points),) * 2), directed=False)
    corners = points[triangles] - points.mean(axis=0)
    volumes = np.bincount(body[triangles[:, 0]], np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6,
                          minlength=count)
    assert (abs(volumes) > 1e-9 * volumes.sum()).all(), "a body has no volume"
    return volumes.sum()


def box(x, y, z):
    return shapes.polycube([(x, y, z)])[:2]


def joined(*surfaces):
    offsets = np.cumsum([0] + [len(vertices) for vertices, _ in surfaces])
    return np.vstack([vertices for vertices, _ in surfaces]), np.vstack(
        [triangles + offset for (_, triangles), offset in zip(surfaces, offsets)])


@pytest.mark.parametrize("origin", [0, 1000])
@pytest.mark.parametrize("boxes", [[(0, 0, 0), (1, 1, 0)], [(0, 0, 0), (1, 1, 1)], [(0, 0, 0), (0, 0, 0), (1, 1, 0)],
                                   [(0, 0, 0), (1, 1, 0), (2, 0, 0), (1, -1, 0)]])
def test_boxes_that_touch_are_moved_apart(boxes, origin):
    vertices, triangles = joined(*(box(*corner) for corner in boxes))
    surface = separate(vertices + origin, triangles)
    assert check_manifold(*surface[:2]) == pytest.approx(len(boxes), rel=2e-5 * max(origin, 1))
    assert len(surface.triangles) == len(triangles)
    assert abs(surface.vertices[surface.triangles] - origin - vertices[triangles]).max() < 1e-4 * max(origin, 1)


def test_an_edge_whose_ends_are_connected_elsewhere():
    # Two cubes that touch in an edge, each end of which is in a third cube: the fans at the ends are whole.
    vertices, triangles, *_ = shapes.polycube([(0, 0, 1), (1, 1, 1), (0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 0, 2), (1, 0, 2), (1, 1, 2)])
    edges = np.unique(np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1), axis=0, return_counts=True)[1]
    assert (edges > 2).sum() == 1
    hierarchy = Hierarchy.build(vertices, triangles)
    solid = Cut.into(hierarchy, 1).solids()[0]
    assert check_manifold(*separate(solid.vertices, solid.triangles)[:2]) == pytest.approx(8, rel=1e-5)


def test_bodies_without_volume_are_removed():
    cube = box(0, 0, 0)
    double = np.array([(3.0, 0, 0), (4, 0, 0), (3, 1, 0)]), np.array([(0, 1, 2), (2, 1, 0)])
    flat = np.array([(3.0, 0, 0), (4, 0, 0), (4, 1, 0), (3, 1, 0)]), np.array([(0, 1, 2), (0, 2, 3), (1, 0, 3), (1, 3, 2)])
    for body in (double, flat):
        surface = separate(*joined(cube, body))
        assert check_manifold(*surface[:2]) == pytest.approx(1) and len(surface.triangles) == 12


def test_triangles_that_single_precision_flattens_are_removed():
    # A needle whose two ends are one in single precision, and a pyramid that becomes flat.
    ball = trimesh.creation.icosphere(2)
    vertices, triangles = np.array(ball.vertices) + 4096, np.array(ball.faces)
    vertices[triangles[0, 1]] = vertices[triangles[0, 0]] + 1e-6
    surface = separate(vertices, triangles)
    assert len(surface.triangles) == len(triangles) - 2
    check_manifold(*surface[:2])
    good = np.array(ball.vertices, np.float32)
    assert np.array_equal(separate(good, triangles).vertices[separate(good, triangles).triangles], good[triangles])  # where nothing touches, nothing moves


@pytest.mark.parametrize("name", MODELS)
def test_files_of_solids_are_manifold(tmp_path, name):
    if name in BUILT:
        vertices, triangles = surface_of(BUILT[name]())
        mesh = meshes.Mesh(vertices, triangles, np.arange(len(triangles), dtype=np.int32), len(triangles), 0)
    else:
        mesh = meshes.read(shapes.MESHES / f"{name}.off")
    hierarchy = Hierarchy.build(mesh.vertices, mesh.triangles, mesh.faces, mesh.face_count)
    cut = Cut.into(hierarchy, 5)
    paths = files.write(tmp_path, name, mesh, cut, ["stl", "glb", "3mf"])
    solids = [cut.volume(part) for part, solid in enumerate(cut.solids()) if solid]
    for suffix in ("stl", "glb", "3mf"):
        loaded = [solid for path in paths if path.suffix == f".{suffix}"
                  for solid in trimesh.load(path, process=False, force="scene").geometry.values()]
        volumes = [check_manifold(solid.vertices, solid.faces) for solid in loaded]
        assert sum(volumes) == pytest.approx(sum(solids), rel=1e-3) and len(volumes) == len(solids)
    hulls = hierarchy.convex_parts(hulls=4)
    obj, glb = convex.write(tmp_path, name, mesh, hulls, ["obj", "glb"])
    for hull in trimesh.load(glb, process=False, force="scene").geometry.values():
        check_manifold(hull.vertices, hull.faces)
    lines = list(map(str.split, obj.read_text().splitlines()))
    vertices = np.array([line[1:] for line in lines if line[0] == "v"], float)
    starts = [number for number, line in enumerate(lines) if line[0] == "o"]
    for first, last in zip(starts, [*starts[1:], None]):
        check_manifold(vertices, np.array([line[1:] for line in lines[first:last] if line[0] == "f"], int) - 1)
