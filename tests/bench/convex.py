# SPDX-License-Identifier: GPL-3.0-or-later
"""Convex parts beside CoACD and V-HACD: how much more than the model their hulls have, and processor seconds.

Run as: python convex.py PEERS_PYTHON KNOWN.json MODEL.off ...   Ours is all from arrays to hulls: the hierarchy (mode paper, one
thread) and its convex parts. Hulls of all are measured by scipy, as the hulls of the
vertices that each gives, joggled: some of V-HACD's are flat."""

import json
import subprocess
import sys
import time
from pathlib import Path
from statistics import median

import numpy as np
from scipy.spatial import ConvexHull

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "native" / "python"), str(ROOT / "scripts" / "bench_parts")]

PEER = """
import json, os, sys, time
import numpy as np
sys.path.insert(0, sys.argv[1])
from peer import read
name, hulls = sys.argv[2], int(sys.argv[4])
vertices, triangles = read(sys.argv[3])
answer = os.fdopen(os.dup(1), "w")
os.dup2(2, 1)
if name == "V-HACD":
    import vhacdx
    work = lambda: vhacdx.compute_vhacd(vertices, triangles.astype(np.uint32), maxConvexHulls=hulls)
else:
    import coacd
    coacd.set_log_level("error")
    mesh = coacd.Mesh(vertices, triangles)
    fast = {} if name == "CoACD" else dict(mcts_iterations=60, mcts_max_depth=2, mcts_nodes=10, resolution=1000)
    work = lambda: coacd.run_coacd(mesh, max_convex_hull=hulls or -1, **fast)
start = time.process_time()
parts = work()
seconds = time.process_time() - start
print(json.dumps({"seconds": seconds, "hulls": [np.asarray(part[0]).tolist() for part in parts]}), file=answer)
"""


def ours(model, hulls):
    from partwheel import Hierarchy, Mode, meshes

    mesh = meshes.read(model)
    start = time.process_time()
    hierarchy = Hierarchy.build(mesh.vertices, mesh.triangles, mesh.faces, mesh.face_count, mode=Mode.PAPER, threads=1)
    parts = hierarchy.convex_parts(hulls)
    return measured(time.process_time() - start, [part.vertices for part in parts], hierarchy.summary.volume)


def peer(python, name, model, hulls, volume):
    done = subprocess.run([python, "-c", PEER, ROOT / "scripts" / "bench_parts", name, model, str(hulls)],
                          stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True)
    answer = json.loads(done.stdout)
    return measured(answer["seconds"], answer["hulls"], volume)


def measured(seconds, hulls, volume):
    return {"seconds": seconds, "hulls": len(hulls),
            "volume": sum(ConvexHull(np.asarray(points), qhull_options="QJ").volume for points in hulls) / volume}


def main():
    python, known, *models = sys.argv[1:]
    known = Path(known)
    table = json.loads(known.read_text()) if known.exists() else {}
    from partwheel import meshes

    names = "CoACD", "CoACD, fast", "V-HACD", "ours"
    print("| model | hulls | " + " | ".join(f"{name}: volume, s" for name in names) + " |")
    print("|---" * (len(names) + 2) + "|")
    rows = []
    for model in map(Path, models):
        mesh = meshes.read(model)
        corners = mesh.vertices[mesh.triangles]
        volume = float((np.cross(corners[:, 0], corners[:, 1]) * corners[:, 2]).sum() / 6)
        row = table.setdefault(model.stem, {})
        for name in names[:3]:
            if name not in row:
                row[name] = peer(python, name, model, 0 if name == "CoACD" else row["CoACD"]["hulls"], volume)
                known.write_text(json.dumps(table, indent=1))
        row["ours"] = ours(model, row["CoACD"]["hulls"])
        rows.append(row)
        print(f"| {model.stem} | {row['CoACD']['hulls']} | " + " | ".join(
            f"{row[name]['volume']:.3f}, {row[name]['seconds']:.2f}" for name in names) + " |", flush=True)
    print("| median | | " + " | ".join(
        ", ".join(f"{median(row[name][what] for row in rows):.{digits}f}" for what, digits in (("volume", 3), ("seconds", 2)))
        for name in names) + " |")
    fewer = sum(row["ours"]["volume"] <= row["CoACD"]["volume"] for row in rows)
    print(f"\nOurs is no larger than CoACD's on {fewer} of {len(rows)}.")


if __name__ == "__main__":
    main()
