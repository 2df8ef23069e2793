# SPDX-License-Identifier: GPL-3.0-or-later
"""What seams of parts are worth, beside Smart UV Project and xatlas: a table of islands, stretch and time. Called by
scripts/bench_seams: in bpy's Python with the Python that has xatlas and model files or names of generated.MODELS; by that
Python with "xatlas" IN OUT."""

import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "native" / "python"), str(ROOT / "tests" / "addon")]


def by_xatlas(source, target):
    """(T,3,2) UVs and the seconds, from and to .npz files."""
    import xatlas

    with np.load(source) as mesh:
        vertices, triangles = mesh["vertices"].astype(np.float32), mesh["triangles"].astype(np.uint32)
    start_time = time.process_time()
    atlas = xatlas.Atlas()
    atlas.add_mesh(vertices, triangles)
    atlas.generate()
    seconds = time.process_time() - start_time
    _, indices, uv = atlas[0]
    np.savez(target, uv=(uv * [atlas.width, atlas.height])[indices], seconds=seconds)  # pixels: the atlas is no square


def main(python, names):
    import bpy
    import generated
    from partwheel import Hierarchy, meshes
    from partwheel.cut import Cut, refine_seams, seams
    from partwheel.cut.seams import MAX_REFINEMENTS
    from uv_measures import measured

    def unwrapped(vertices, triangles, ends, operator, **options):
        mesh = bpy.data.meshes.new("model")
        mesh.from_pydata(vertices.tolist(), [], triangles.tolist())
        obj = bpy.data.objects.new("model", mesh)
        bpy.context.scene.collection.objects.link(obj)
        bpy.context.view_layer.objects.active = obj
        edges = np.empty(2 * len(mesh.edges), np.int32)
        mesh.edges.foreach_get("vertices", edges)
        mesh.edges.foreach_set("use_seam", np.isin(np.sort(edges.reshape(-1, 2).astype(np.int64)) @ [len(vertices), 1],
                                                   ends.astype(np.int64) @ [len(vertices), 1]))
        mesh.uv_layers.new()
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_all(action="SELECT")
        start_time = time.process_time()
        operator(**options)
        seconds = time.process_time() - start_time
        bpy.ops.object.mode_set(mode="OBJECT")
        uv = np.empty(6 * len(triangles), np.float32)
        mesh.uv_layers.active.data.foreach_get("uv", uv)
        bpy.data.objects.remove(obj)
        bpy.data.meshes.remove(mesh)
        return uv.reshape(-1, 3, 2).astype(float), seconds

    bpy.ops.wm.read_factory_settings(use_empty=True)
    print("| model | faces | islands: ours, Smart UV, xatlas | angles | areas | covered twice, % | "
          "seconds: our seams, unwrapping, Smart UV, xatlas | holds |\n"
          "| --- | --- | --- | --- | --- | --- | --- | --- |", flush=True)
    n_held = 0
    for name in names:
        if name in generated.MODELS:
            vertices, triangles = generated.MODELS[name]()
            faces, face_count = None, None
        else:
            vertices, triangles, faces, face_count = meshes.read(Path(name))[:4]
        surface = vertices.astype(np.float32).astype(float), triangles, faces, face_count
        cut = Cut.automatic(Hierarchy.build(*surface))
        start_time, in_blender, unwrapping = time.process_time(), 0.0, 0.0

        def by_blender(ends):
            nonlocal in_blender, unwrapping
            start_time = time.process_time()
            uv, seconds = unwrapped(*surface[:2], ends, bpy.ops.uv.unwrap, method="ANGLE_BASED")
            in_blender += time.process_time() - start_time
            unwrapping += seconds
            return uv

        ends = seams(*surface, cut)
        uv = by_blender(ends)
        for _ in range(MAX_REFINEMENTS):
            before, ends = ends, refine_seams(*surface, cut, ends, uv)
            if np.array_equal(before, ends):
                break
            uv = by_blender(ends)
        maps = [(uv, time.process_time() - start_time - in_blender),
                unwrapped(*surface[:2], ends[:0], bpy.ops.uv.smart_project)]
        with tempfile.TemporaryDirectory() as folder:
            source, target = Path(folder) / "in.npz", Path(folder) / "out.npz"
            np.savez(source, vertices=surface[0], triangles=triangles)
            subprocess.run([python, __file__, "xatlas", source, target], check=True)
            with np.load(target) as result:
                maps.append((result["uv"], float(result["seconds"])))
        own_measures, smart, atlas = measures = [measured(*surface[:2], uv) for uv, _ in maps]
        holds = own_measures.islands < min(smart.islands, atlas.islands) and own_measures.angle <= smart.angle and own_measures.area <= smart.area
        n_held += holds
        cells = [", ".join(form % value for value in values) for form, values in (
            ("%d", [measure.islands for measure in measures]), ("%.3f", [measure.angle for measure in measures]),
            ("%.3f", [measure.area for measure in measures]), ("%.2f", [100 * measure.covered for measure in measures]),
            ("%.1f", [maps[0][1], unwrapping, *[seconds for _, seconds in maps[1:]]]))]
        print(f"| {Path(name).stem} | {len(triangles):,} | {' | '.join(cells)} | {'yes' if holds else 'no'} |", flush=True)
    print(f"\nFewer islands than both at no more stretch than Smart UV's, of angles and of areas: {n_held} of {len(names)}.")


if sys.argv[1] == "xatlas":
    by_xatlas(*sys.argv[2:])
else:
    main(sys.argv[1], sys.argv[2:])
