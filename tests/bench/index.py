# SPDX-License-Identifier: GPL-3.0-or-later
"""The hierarchy as an index: a million random points, rays and places against every tetrahedron and triangle; and its speed
beside Embree's, trimesh's, libigl's and FCL's on the same queries. Run by scripts/bench_index.

Run as: python index.py [--queries N] [--speed-only]    N: against all, a million by default.
"""

import argparse
import statistics
import sys
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "native" / "python"), str(ROOT / "tests" / "core")]

import shapes  # noqa: E402  (found only now)
from every_pair import Everything, hulls_of, placed  # noqa: E402

from partwheel import Hierarchy, Index  # noqa: E402

SIZED = "hand", "homer", "bear"  # the models whose speed is measured
SPEED, SLOW, PLACES = 100_000, 2_000, 3_000  # queries; of those that take long; of two models
RUNS = 5
AT_A_TIME = 50_000


def directed(draw, vertices, count):
    """Rays from around a model into its bounding box."""
    low, high = vertices.min(0), vertices.max(0)
    ways = draw.normal(size=(count, 3))
    origins = (low + high) / 2 + ways / np.linalg.norm(ways, axis=1)[:, None] * np.linalg.norm(high - low)
    directions = draw.uniform(low, high, (count, 3)) - origins
    return origins, directions / np.linalg.norm(directions, axis=1)[:, None]


def around(draw, vertices, count):
    low, high = vertices.min(0), vertices.max(0)
    return draw.uniform(low - (high - low) / 10, high + (high - low) / 10, (count, 3))


def unlike(everything, index, other, other_index, draw, count):
    """How many answers differ: (points, rays, nearest, places)."""
    points = around(draw, everything.vertices, count)
    located = index.locate(points)
    differ = [int((located != everything.locate(points)).sum())]
    origins, directions = directed(draw, everything.vertices, count)
    (parts, distances), (bodies, expected) = index.first_hits(origins, directions), everything.hits(origins, directions)
    met = (parts >= 0) & (bodies >= 0)
    differ.append(int(((parts >= 0) != (bodies >= 0)).sum() + (np.abs(distances - expected)[met] > 1e-9 * expected[met]).sum()))
    _, away, _ = index.nearest(points)
    expected = np.where(located >= 0, 0, everything.distances(points))
    differ.append(int((np.abs(away - expected) > 1e-9 * expected).sum()))
    matrices = placed(draw, everything.vertices, other.vertices, count)
    touch = index.intersects(other_index, matrices)[0][:, 0] >= 0
    differ.append(int((touch != everything.touch(other, matrices)).sum()))
    return differ, (np.mean(located >= 0), np.mean(parts >= 0), np.mean(located < 0), np.mean(touch))


def compare(count):
    """The table of answers that differ, of each resolution."""
    print("| parts | points | rays | nearest | places of another |\n|---|---|---|---|---|")
    one, other = (Hierarchy.build(*shapes.SHAPES[name]()) for name in ("torus", "jack"))
    for name in ("tetrahedra", "hulls of 6 parts"):
        if name == "tetrahedra":
            sides = [(Everything.of_tetrahedra(h), Index(h)) for h in (one, other)]
        else:
            cuts = [h.cut_parts(6) for h in (one, other)]
            sides = [(hulls_of(h, bounds), Index(h, bounds)) for h, bounds in zip((one, other), cuts)]
        draw, total, shares = np.random.default_rng(1), np.zeros(4, int), []
        for first in range(0, count, AT_A_TIME):
            differ, share = unlike(*sides[0], *sides[1], draw, min(AT_A_TIME, count - first))
            total += differ
            shares.append(share)
        print(f"| {name} | " + " | ".join(f"{n} of {count:,} ({share:.0%})" for n, share in zip(total, np.mean(shares, 0))) + " |",
              flush=True)


def alternately(count, *tools):
    """Microseconds a query of each, the processor's: medians of runs in turn."""
    seconds = [[] for _ in tools]
    for _ in range(RUNS):
        for spent, tool in zip(seconds, tools):
            start = time.process_time()
            tool()
            spent.append(time.process_time() - start)
    return [1e6 * statistics.median(spent) / count for spent in seconds]


def speeds(name, hierarchy, shape, draw):
    """Rows: what is asked, ours, theirs."""
    import igl
    import trimesh
    from trimesh.ray.ray_pyembree import RayMeshIntersector

    mesh = trimesh.Trimesh(shape.vertices, shape.triangles, process=False)
    start = time.process_time()
    index = Index(hierarchy, threads=1)
    own_seconds = time.process_time() - start
    start = time.process_time()
    rays = RayMeshIntersector(mesh)
    rays._scene.run(np.zeros((1, 3), np.float32), np.ones((1, 3), np.float32))
    embree_seconds = time.process_time() - start
    yield "made, ms", 1e3 * own_seconds, f"Embree {1e3 * embree_seconds:.1f}"
    points = around(draw, shape.vertices, SPEED)
    own_seconds, = alternately(SPEED, lambda: index.locate(points))
    few = points[:SLOW]
    contains, = alternately(SLOW, lambda: rays.contains_points(few))
    yield "which part holds a point", own_seconds, f"trimesh by Embree, in or out: {contains:.2f}"
    origins, directions = directed(draw, shape.vertices, SPEED)
    small = origins.astype(np.float32), directions.astype(np.float32)
    own_seconds, embree = alternately(SPEED, lambda: index.first_hits(origins, directions), lambda: rays._scene.run(*small))
    yield "a ray's first part", own_seconds, f"Embree, floats: {embree:.2f}"
    triangles = shape.triangles.astype(np.int64)
    tree = igl.AABB()
    tree.init(shape.vertices, triangles)
    outside = points[index.locate(points) < 0]
    few = outside[:SLOW]
    own_seconds, embree_seconds = alternately(len(outside), lambda: index.nearest(outside),
                               lambda: tree.squared_distance(shape.vertices, triangles, outside))
    slow, = alternately(len(few), lambda: trimesh.proximity.closest_point(mesh, few))
    yield "nearest part, from outside", own_seconds, f"libigl {embree_seconds:.2f}, trimesh {slow:.0f}"


def collision(vertices, triangles):
    import fcl

    model = fcl.BVHModel()
    model.beginModel(len(vertices), len(triangles))
    model.addSubModel(vertices, triangles)
    model.endModel()
    return fcl.CollisionObject(model, fcl.Transform())


def touching_speeds(first, second, first_mesh, second_mesh, draw):
    """Rows, as above, for places that are apart and such that touch."""
    import fcl

    one, other = collision(*first_mesh), collision(*second_mesh)
    request = fcl.CollisionRequest()

    def theirs(matrices):
        met = []
        for matrix in matrices:
            other.setTransform(fcl.Transform(matrix[:, :3], matrix[:, 3]))
            met.append(fcl.collide(one, other, request, fcl.CollisionResult()) > 0)
        return np.array(met)

    def calls(matrices):
        """What the same calls take that ask nothing: of two triangles far apart."""
        for matrix in matrices:
            far.setTransform(fcl.Transform(matrix[:, :3], matrix[:, 3]))
            fcl.collide(near, far, request, fcl.CollisionResult())

    triangle = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0.0]]), np.array([[0, 1, 2]])
    size = max(np.ptp(first_mesh[0]), np.ptp(second_mesh[0]))
    near, far = collision(triangle[0] + 1e3 * size, triangle[1]), collision(*triangle)
    matrices = placed(draw, first_mesh[0], second_mesh[0], PLACES, rigid=True)
    touch, met = first.intersects(second, matrices)[0][:, 0] >= 0, theirs(matrices)
    for name, is_chosen in (("apart", ~touch), ("touching", touch & met)):
        given = matrices[is_chosen]
        own_seconds, fcls, empty = alternately(len(given), lambda: first.intersects(second, given), lambda: theirs(given),
                                        lambda: calls(given))
        yield f"do two touch: {name}", own_seconds, f"FCL {fcls - empty:.2f} + {empty:.2f} for the call"
    yield "of these places FCL answers otherwise", int((touch != met).sum()), f"of {PLACES}"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--queries", type=int, default=1_000_000)
    parser.add_argument("--speed-only", action="store_true")
    given = parser.parse_args()
    if not given.speed_only:
        compare(given.queries)
        print()
    print("| model | asked | ours | beside it |\n|---|---|---|---|")

    def tell(name, rows):
        for asked, own_seconds, peer_seconds in rows:
            print(f"| {name} | {asked} | {own_seconds if isinstance(own_seconds, int) else format(own_seconds, '.2f')} | {peer_seconds} |", flush=True)
            name = ""

    draw, built = np.random.default_rng(2), {}
    for name in SIZED:
        shape = shapes.off(name)
        built[name] = shape, Hierarchy.build(*shape)
        tell(f"{name}, {len(shape.triangles):,} triangles", speeds(name, built[name][1], shape, draw))
    for first, second in (("hand", "hand"), ("homer", "bear")):
        ones = [Index(built[name][1], threads=1) for name in (first, second)]
        surfaces = [tuple(built[name][0][:2]) for name in (first, second)]
        tell(f"{first} and {second}", touching_speeds(*ones, *surfaces, draw))
    # Separated, nearly convex: two parts of the hand's automatic cut, as models of their own.
    hierarchy = built["hand"][1]
    bounds = hierarchy.cut_automatic()
    sizes = np.diff(bounds)
    solids = [hierarchy.solid_of_slice(bounds[k], bounds[k + 1]) for k in np.argsort(-sizes)[1:3]]
    ones = [Index(Hierarchy.build(solid.vertices, solid.triangles), threads=1) for solid in solids]
    tell("two fingers", touching_speeds(*ones, *((s.vertices, s.triangles) for s in solids), draw))
    ball = trimesh_ball()
    index = Index(Hierarchy.build(*ball), threads=1)
    tell("two balls, 5,120 triangles each", touching_speeds(index, index, ball, ball, draw))


def trimesh_ball():
    import trimesh

    ball = trimesh.creation.icosphere(4)
    return np.array(ball.vertices), np.array(ball.faces)


if __name__ == "__main__":
    main()
