"""The cost of a mouse move while a part of 20,000 or 100,000 vertices is deformed: in the library, and in Blender."""

import json
import os
import subprocess

import models
import numpy as np
from programs import PROGRAMS, ROOT, Failure, required, run

PARTS = {20_000: 33, 100_000: 100}  # number of vertices of the part -> goal in ms
MOVES, ITERATIONS = 60, 1  # iterations per mouse move, as in the add-on for parts of these sizes
AXIS = 1
SCRIPT = ROOT / "scripts/bench_parts/deform_in_blender.py"
BLENDERS = (["blender", "-b", "-noaudio", "--factory-startup", "--python-exit-code", "9", "--python", SCRIPT],
            [ROOT / "build/venv/bpy-5.0/bin/python", SCRIPT])
CLEAN = {"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "HOME": os.environ.get("HOME", "/"), "LANG": "C.UTF-8"}


def measure(quick):
    """Deforms the same region as the add-on: the part and the faces around it."""
    moves = MOVES // 3 if quick else MOVES
    sizes = []
    for count, goal in PARTS.items():
        vertices, triangles = models.subdivide(models.read(models.NATURAL), round(count * 2.5))
        part = np.argsort(-vertices[:, AXIS], kind="stable")[:count]
        inside = np.zeros(len(vertices), bool)
        inside[part] = True
        region = triangles[inside[triangles].any(axis=1)]
        region_vertices, region = np.unique(region, return_inverse=True)
        path = models.write(f"part-{count}", (vertices[region_vertices], region.reshape(-1, 3)))
        report = required(f"the part of {count} vertices", run(PROGRAMS / "deform_bench", path, AXIS, count, moves, ITERATIONS))
        print(f"   {count} vertices: {1000 * report['move']['median']:.1f} ms a move (processor: "
              f"{1000 * report['move']['median_cpu']:.1f} ms), {report['create'][0]:.2f} s to begin")
        mesh_file = path.with_suffix(".npz")
        np.savez(mesh_file, vertices=vertices, triangles=triangles, part=part)
        sizes.append({"count": count, "goal": goal, **report,
                      "blenders": [in_blender(blender, mesh_file, moves) for blender in BLENDERS]})
    return {"iterations": ITERATIONS, "sizes": sizes}


def in_blender(blender, mesh_file, moves):
    """The report of deform_in_blender.py."""
    result = mesh_file.with_suffix(".json")
    result.unlink(missing_ok=True)
    process = subprocess.run([*blender, "--", mesh_file, str(moves), result], env=CLEAN, capture_output=True, text=True)
    if not result.exists():
        raise Failure(f"{blender[0]} ended with code {process.returncode}: {process.stderr.strip()[-300:]}")
    report = json.loads(result.read_text())
    whole, follow, write = (1000 * report[name] for name in ("whole", "follow", "write"))
    print(f"     in Blender {report['blender']}: {whole:.1f} ms a move ({follow:.1f} to follow, {write:.1f} to write), "
          f"{report['begin']:.2f} s to begin, {report['prepare']:.2f} s in the background")
    return report
