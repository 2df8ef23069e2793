#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What marks cost, in processor seconds: reading a texture of 4096 x 4096 texels for 100,000 faces, and builds.

usage: tests/bench/mark_costs.py TEXTURES [SCORE ASSETS] [--every N]    (partwheel importable; numpy, Pillow)

TEXTURES: a folder for the textures, which are made there. In Blender's Python the add-on reads them: for the first time, when
Blender decodes the file, and again. SCORE, ASSETS: as of tests/quality/marks.py; then each Nth asset is built without marks and
with its borders of materials as hints, in turn.
"""

import argparse
import importlib.util
import io
import sys
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
SIDE, FACES, REPEATS = 4096, 100_000, 5
sys.path += [str(ROOT / "native" / "python"), str(ROOT / "tests" / "quality")]


def seconds(action):
    start_time = time.process_time()
    action()
    return time.process_time() - start_time


def write_textures(folder):
    """One color per field, as hand-painted models have; and smooth colors without and with noise."""
    import PIL.Image

    folder.mkdir(parents=True, exist_ok=True)
    random = np.random.default_rng(0)
    fields = PIL.Image.fromarray(random.integers(0, 256, (16, 16, 3), np.uint8)).resize((SIDE, SIDE), PIL.Image.NEAREST)
    smooth = PIL.Image.fromarray(random.integers(0, 256, (64, 64, 3), np.uint8)).resize((SIDE, SIDE), PIL.Image.BICUBIC)
    noisy = PIL.Image.fromarray((np.asarray(smooth) + random.normal(0, 4, (SIDE, SIDE, 1))).clip(0, 255).astype(np.uint8))
    for name, image in {"fields": fields, "smooth": smooth, "noisy": noisy}.items():
        image.save(folder / f"{name}.png")
        image.save(folder / f"{name}.jpg")


def grid():
    """(vertices, triangles, texture coordinates of each corner) of a square."""
    n = int((FACES / 2) ** 0.5) + 1
    y, x = np.mgrid[:n + 1, :n + 1] / n
    vertices = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    corner = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()[:, None]
    triangles = np.concatenate([corner + [0, 1, n + 2], corner + [0, n + 2, n + 1]])
    return vertices, triangles, vertices[triangles][..., :2]


def read_in_package(path):
    import PIL.Image
    from partwheel.appearance import Appearance, Image

    data, coordinates = path.read_bytes(), grid()[2]
    look = Appearance({"TEXCOORD_0": coordinates}, np.zeros(len(coordinates), int),
                      [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}], [{"source": 0}], [], [Image("a", data)])
    both = [(seconds(look.mean_colors), seconds(PIL.Image.open(io.BytesIO(data)).load)) for _ in range(REPEATS)]
    total, decoding = np.median(both, axis=0)
    return f"{total:.3f} s, decoding alone {decoding:.3f}"


def read_in_blender(path):
    import bpy

    spec = importlib.util.spec_from_file_location("partwheel_addon", ROOT / "addon" / "partwheel" / "__init__.py")
    sys.modules[spec.name] = importlib.util.module_from_spec(spec)
    marks = importlib.import_module("partwheel_addon.mesh.marks")
    vertices, triangles, coordinates = grid()
    mesh = bpy.data.meshes.new("grid")
    mesh.from_pydata(vertices.tolist(), [], triangles.tolist())
    mesh.uv_layers.new().data.foreach_set("uv", coordinates.ravel())
    material = bpy.data.materials.new("painted")
    material.use_nodes = True
    nodes = material.node_tree.nodes
    image_node, shader = nodes.new("ShaderNodeTexImage"), next(node for node in nodes if node.type == "BSDF_PRINCIPLED")
    image_node.image = bpy.data.images.load(str(path))
    material.node_tree.links.new(image_node.outputs["Color"], shader.inputs["Base Color"])
    mesh.materials.append(material)
    first, *others = [seconds(lambda: marks._read_face_colors(mesh)) for _ in range(REPEATS + 1)]
    return f"{first:.3f} s with Blender's decoding, then {np.median(others):.3f}"


def measure_builds(score_folder, paths):
    sys.path.insert(0, str(score_folder))
    from marks import material_borders
    from partwheel import Hierarchy, Marks

    ratios = []
    for path in paths:
        model = np.load(path, allow_pickle=False)
        vertices, triangles = model["V"].astype(float), model["F"].astype(np.int64)
        edges = material_borders(vertices, triangles, model["material"])
        if not len(edges):
            continue
        marks = [Marks("materials", edges, np.full(len(edges), 0.9))]
        times = [[seconds(lambda: Hierarchy.build(vertices, triangles, threads=1, marks=used)) for used in ([], marks)]
                 for _ in range(REPEATS)]
        without, with_marks = np.median(times, axis=0)
        ratios.append(with_marks / without)
        print(f"{path.stem}: {without:.3f} s without marks, {with_marks:.3f} with")
    print(f"{len(ratios)} assets: builds take {np.mean(ratios):.2f} times as long with marks (median {np.median(ratios):.2f})")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("textures", type=Path)
    parser.add_argument("score", type=Path, nargs="?")
    parser.add_argument("assets", type=Path, nargs="?")
    parser.add_argument("--every", type=int, default=12)
    args = parser.parse_args(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else None)
    in_blender = importlib.util.find_spec("bpy")
    if not in_blender:
        write_textures(args.textures)
    for path in sorted(args.textures.glob("*.*")):
        text = read_in_blender(path) if in_blender else read_in_package(path)
        print(f"{path.name}, {path.stat().st_size / 1e6:.1f} MB: {text}")
    if args.assets:
        measure_builds(args.score, sorted(args.assets.glob("*.npz"))[::args.every])


if __name__ == "__main__":
    main()
