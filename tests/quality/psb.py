# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds hierarchies of meshes and writes what the Princeton Segmentation Benchmark's score reads: one .npz a mesh.

usage: psb.py MESH_DIR OUT_DIR [--mode paper] [--sdf PROGRAM] [--fill-methods N] [--jobs N] [--again]

MESH_DIR/<id>.off -> OUT_DIR/<id>.npz: order, first, last, parent, leaf, start, counts, cuts, auto, as the benchmark's
score.py documents them. Through the public Python API, one process a core, with default settings. A mesh that can't be
built is named and gets no file: the score counts it as a failure. Meshes that have a file already are passed over,
unless --again.

--mode paper: the paper's tree, wheel and cuts.
--fill-methods: the allowed fill methods, a sum. 4, from points alone, beside the default shows what that costs.
--sdf: not Partwheel's hierarchies but CGAL's segmentation by the shape diameter function, made by the program given
(sdf_bench, built by scripts/bench), as hierarchies of two levels: what a click on one of its segments would take.
"""

import argparse
import os
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "native" / "python"))

from partwheel import Hierarchy, Mode, PartwheelError, meshes  # noqa: E402  (found only now)

COUNTS = np.arange(2, 41)


def paths_as_tree(hierarchy, face_count):
    """The wheel of every face, as one tree: (parent, first, last, leaf, start). The nodes of a path that two faces
    share count once from the root down to where the paths part, so each path is exactly that of the wheel; but for
    stops that add no face to the one before, as mode paper has them and the benchmark does not."""
    parent, first, last, known = [], [], [], {}
    leaf, start = np.empty(face_count, np.int64), np.empty(face_count, np.int64)
    of_leaf = {}
    for face in range(face_count):
        # All faces of one leaf have one wheel.
        tetrahedron = int(hierarchy.leaf[face])
        if tetrahedron not in of_leaf:
            stops, at = hierarchy.wheel(face)
            faces = hierarchy.last[stops] - hierarchy.first[stops]
            at = len(np.unique(faces[:at + 1])) - 1
            stops = stops[np.flatnonzero(np.diff(faces, prepend=0))]
            previous, nodes = -1, []
            for stop in reversed(stops.tolist()):
                node = known.setdefault((previous, stop), len(parent))
                if node == len(parent):
                    parent.append(previous)
                    first.append(hierarchy.first[stop])
                    last.append(hierarchy.last[stop])
                nodes.append(node)
                previous = node
            nodes.reverse()
            of_leaf[tetrahedron] = nodes[0], nodes[at]
        leaf[face], start[face] = of_leaf[tetrahedron]
    return np.array(parent), np.array(first), np.array(last), leaf, start


def build(path, mode, fill_methods=0):
    """(mesh, hierarchy)"""
    mesh = meshes.read(path)
    return mesh, Hierarchy.build(mesh.vertices, mesh.triangles, mesh.faces, mesh.face_count, threads=1, mode=mode,
                                 fill_methods=fill_methods)


def arrays(hierarchy, face_count):
    """What the benchmark's score reads."""
    parent, first, last, leaf, start = paths_as_tree(hierarchy, face_count)
    counts = COUNTS[COUNTS <= len(hierarchy.tetrahedra)]
    cuts = [hierarchy.face_labels(hierarchy.cut_parts(k)) for k in counts]
    return {"order": hierarchy.order, "first": first, "last": last, "parent": parent, "leaf": leaf, "start": start,
            "counts": counts, "cuts": np.array(cuts, np.int16).reshape(len(counts), face_count),
            "auto": hierarchy.face_labels(hierarchy.cut_automatic())}


def sdf(path, program):
    with tempfile.NamedTemporaryFile(suffix=".txt") as file:
        subprocess.run([program, path, file.name], check=True, stdout=subprocess.DEVNULL)
        labels = np.unique(np.loadtxt(file.name, int), return_inverse=True)[1]
    order = np.argsort(labels, kind="stable")
    sizes = np.bincount(labels)
    ends = np.concatenate([[0], np.cumsum(sizes)])
    parts = len(sizes)
    if parts == 1:
        return {"order": order, "first": np.array([0]), "last": ends[-1:], "parent": np.array([-1]), "leaf": labels,
                "start": labels, "counts": np.array([1]), "cuts": labels[None], "auto": labels}
    return {"order": order, "first": np.append(ends[:-1], 0), "last": np.append(ends[1:], ends[-1]),
            "parent": np.append(np.full(parts, parts), -1), "leaf": labels, "start": labels,
            "counts": np.array([parts]), "cuts": labels[None], "auto": labels}


def write(path, target, program, mode, fill_methods):
    if program:
        written = sdf(path, program)
    else:
        mesh, hierarchy = build(path, mode, fill_methods)
        written = arrays(hierarchy, mesh.face_count)
    partial = target.with_suffix(".partial.npz")
    np.savez_compressed(partial, **written)
    partial.rename(target)


def in_a_process(path, arguments):
    """None, or why there is no file: a crash costs one mesh and no other."""
    process = subprocess.run([sys.executable, __file__, str(path), *arguments], stderr=subprocess.PIPE, text=True)
    return None if process.returncode == 0 else (process.stderr.strip() or f"exit code {process.returncode}").splitlines()[-1]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", type=Path, help="a directory of .off files, or one such file")
    parser.add_argument("out", type=Path)
    parser.add_argument("--mode", choices=[mode.name.lower() for mode in Mode], default=Mode(0).name.lower())
    parser.add_argument("--sdf", metavar="PROGRAM")
    parser.add_argument("--fill-methods", type=int, default=0, help="see pw_build_options")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--again", action="store_true", help="also those that have a file")
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    if args.meshes.is_file():
        try:
            write(args.meshes, args.out / f"{args.meshes.stem}.npz", args.sdf,
                  Mode[args.mode.upper()], args.fill_methods)
        except (PartwheelError, meshes.MeshFileError, subprocess.CalledProcessError) as error:
            sys.exit(str(error))
        return
    todo = [path for path in sorted(args.meshes.glob("*.off"))
            if args.again or not (args.out / f"{path.stem}.npz").exists()]
    arguments = [str(args.out), "--mode", args.mode, "--fill-methods", str(args.fill_methods),
                 *(["--sdf", args.sdf] if args.sdf else [])]
    with ThreadPoolExecutor(args.jobs) as pool:
        results = [(path, pool.submit(in_a_process, path, arguments)) for path in todo]
        for i, (path, result) in enumerate(results, 1):
            why = result.result()
            print(f"{i}/{len(todo)} {path.stem}" + (f": {why}" if why else ""), flush=True)


if __name__ == "__main__":
    main()
