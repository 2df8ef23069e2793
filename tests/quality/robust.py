# SPDX-License-Identifier: GPL-3.0-or-later
"""Prints how much "best" falls when models are made worse, as Markdown: the paper's claim of robustness, measured.

usage: robust.py MESH_DIR SEG_DIR [--every 5] [--jobs N] [--only MODEL]

Each model is built as it is and in these ways, with default settings, and scored by the benchmark's own clicks:
  noise P %       every vertex moved by a normal deviate of P % of the bounding box's diagonal, in each direction
  half decimated  the half beyond the middle of the longest side with a quarter of its faces, by quadric edge collapse
                  (pyfqmr): sampling that is not uniform
  half the faces  the whole with half of its faces, the same way
  points inside   quality 1.4: points inside the solid
A face of the benchmark takes the part of the nearest face that is left.

Then, for an edit of one place: the vertices within 5 % of the diagonal of one vertex moved outward by up to 2 %. Of the
nodes at or above the parts with at least 1 % of the area that have no face within 10 % of the diagonal of that vertex,
"stay" is the share that the edited model has as well, but for 2 % of their area.

--every: takes every so-manieth model. Exits with 1 where a limit is passed. Needs numpy, scipy, pyfqmr.
"""

import argparse
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pyfqmr
from scipy.spatial import cKDTree

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "native" / "python"), str(Path(__file__).parent)]

from fit import People  # noqa: E402  (found only now)
from partwheel import PartwheelError, meshes  # noqa: E402
from partwheel.worker import Job  # noqa: E402

LIMITS = {"noise 0.1 %": 0.01, "noise 0.3 %": 0.02, "noise 1 %": 0.05, "half decimated": 0.03, "half the faces": 0.03,
          "points inside": 0.02}
LEFT_OF_THE_FAR_HALF = 0.25


def diagonal(vertices):
    return np.linalg.norm(np.ptp(vertices, axis=0))


def noisy(vertices, percent):
    spread = percent / 100 * diagonal(vertices)
    return vertices + np.random.default_rng(1).normal(0, spread, vertices.shape)


def decimated(vertices, triangles, share):
    """(vertices, triangles) with that share of the triangles; open borders stay."""
    simplifier = pyfqmr.Simplify()
    simplifier.setMesh(vertices, triangles)
    simplifier.simplify_mesh(target_count=int(share * len(triangles)), aggressiveness=3, preserve_border=True,
                             verbose=False)
    return simplifier.getMesh()[:2]


def half_decimated(vertices, triangles):
    axis = int(np.ptp(vertices, axis=0).argmax())
    far = (vertices[:, axis] > (vertices[:, axis].min() + vertices[:, axis].max()) / 2)[triangles].all(axis=1)
    used_vertices, numbers = np.unique(triangles[far], return_inverse=True)
    points, left = decimated(vertices[used_vertices], numbers.reshape(-1, 3), LEFT_OF_THE_FAR_HALF)
    both = np.concatenate([vertices[triangles[~far]].reshape(-1, 3), points[left].reshape(-1, 3)])
    return stitched(both)


def stitched(corners):
    """(vertices, triangles) of corners (3 T, 3), equal ones being one vertex."""
    vertices, numbers = np.unique(corners, axis=0, return_inverse=True)
    return vertices, numbers.reshape(-1, 3)


def build(vertices, triangles, quality=0.0):
    """In a process of its own: what is made worse may not be a surface any more."""
    return Job(vertices, triangles, quality=quality, threads=1).result()


def best(hierarchy, people, face_of):
    """The mean over the clicks of the best overlap on the wheel's path. face_of: the hierarchy's face for each face of
    the benchmark's mesh."""
    leaf = hierarchy.leaf[face_of]
    order = np.argsort(leaf, kind="stable")
    area, leaf = people.area[order], leaf[order]
    total = np.concatenate([[0], np.cumsum(area)])
    overlaps = []
    for face, label in people.clicks:
        inside = (people.labels == label).any(axis=0)[order]
        expected = np.concatenate([[0], np.cumsum(area * inside)])
        stops = hierarchy.wheel(int(face_of[face]))[0]
        first = np.searchsorted(leaf, hierarchy.tet_first[stops])
        last = np.searchsorted(leaf, hierarchy.tet_last[stops])
        hit = expected[last] - expected[first]
        overlaps.append((hit / (total[last] - total[first] + expected[-1] - hit)).max())
    return np.mean(overlaps)


def staying(plain, vertices, triangles, area):
    """The share of the nodes far from an edited place that are there after the edit; NaN if there are none."""
    size = diagonal(vertices)
    place = vertices[np.random.default_rng(2).integers(len(vertices))]
    far = np.linalg.norm(vertices - place, axis=1)
    out = place - vertices.mean(axis=0)
    moved = np.maximum(0, 1 - far / (0.05 * size))[:, None] * 0.02 * size * out / np.linalg.norm(out)
    near = far[triangles].min(axis=1) < 0.1 * size

    def sets(hierarchy):
        large = hierarchy.area >= 0.01 * hierarchy.area[-1]
        for node in np.flatnonzero((hierarchy.score > 0) & large):
            is_chosen = np.zeros(len(triangles), bool)
            is_chosen[hierarchy.faces(node)] = True
            if not (is_chosen & near).any():
                yield is_chosen

    after = np.array(list(sets(build(vertices + moved, triangles)))).reshape(-1, len(triangles))
    stay = [len(after) > 0 and ((after ^ selection) @ area).min() <= 0.02 * area[selection].sum() for selection in sets(plain)]
    return np.mean(stay) if stay else np.nan


def measured(model, mesh_dir, seg_dir):
    """Best as it is, in each way of LIMITS, and what stays; NaN where it can't be built so."""
    mesh, people = meshes.read(mesh_dir / f"{model}.off"), People(model, mesh_dir, seg_dir)
    vertices, triangles, same = mesh.vertices, mesh.triangles, np.arange(len(mesh.triangles))
    middles = vertices[triangles].mean(axis=1)

    def attempt(vertices, triangles, quality=0.0):
        moved = len(triangles) == len(same)
        face_of = same if moved else cKDTree(vertices[triangles].mean(axis=1)).query(middles)[1]
        try:
            return best(build(vertices, triangles, quality), people, face_of)
        except PartwheelError as error:
            print(f"{model}: {error}", file=sys.stderr)
            return np.nan

    plain = build(vertices, triangles)
    return [best(plain, people, same),
            *(attempt(noisy(vertices, percent), triangles) for percent in (0.1, 0.3, 1)),
            attempt(*half_decimated(vertices, triangles)),
            attempt(*decimated(vertices, triangles, 0.5)),
            attempt(vertices, triangles, 1.4),
            staying(plain, vertices, triangles, people.area)]


def in_a_process(model, args):
    process = subprocess.run([sys.executable, __file__, args.meshes, args.segmentations, "--only", str(model)],
                          stdout=subprocess.PIPE, text=True, check=True)
    print(model, process.stdout.strip(), file=sys.stderr, flush=True)
    return [float(word) for word in process.stdout.split()]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", type=Path)
    parser.add_argument("segmentations", type=Path)
    parser.add_argument("--every", type=int, default=5)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--only", type=int, metavar="MODEL", help="prints one model's numbers")
    args = parser.parse_args()
    if args.only:
        print(*(f"{x:.4f}" for x in measured(args.only, args.meshes, args.segmentations)))
        return
    models = sorted(int(path.stem) for path in args.meshes.glob("*.off"))[::args.every]
    with ThreadPoolExecutor(args.jobs) as pool:
        rows = np.array(list(pool.map(lambda model: in_a_process(model, args), models)))
    print(f"best of {len(models)} models as they are: {rows[:, 0].mean():.3f}\n\n"
          "| made worse by | models built | best falls by | at most |\n|---|---|---|---|")
    worse = False
    for i, (defect, limit) in enumerate(LIMITS.items(), 1):
        built = ~np.isnan(rows[:, i])
        fall = (rows[built, 0] - rows[built, i]).mean()
        worse |= not fall <= limit
        print(f"| {defect} | {built.sum()} | {fall:.3f} | {limit} |")
    print(f"\nnodes far from a local edit that stay: {np.nanmean(rows[:, -1]):.1%}")
    sys.exit(worse)


if __name__ == "__main__":
    main()
