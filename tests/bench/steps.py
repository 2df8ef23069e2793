# SPDX-License-Identifier: GPL-3.0-or-later
"""How long each command of the add-on blocks Blender: a table of the longest step of its main thread, on ten models. Called
by scripts/bench_steps in bpy's Python, with the add-on's zip and, to measure only some, names of MODELS.

A step is what a command does between two computations in the background, in processor seconds of the main thread.
"""

import importlib
import statistics
import sys
import time
from pathlib import Path

import bpy
import numpy as np
from mathutils import Matrix

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests" / folder) for folder in ("addon", "bench", "gui")]

import generated  # noqa: E402
from model import read_off, subdivided  # noqa: E402
from run import installed  # noqa: E402

DEMO = {"armadillo": 0, "bunny00": 0, "refined_elephant": 0, "bear": 1, "man": 1, "homer": 2}  # how often subdivided
SHELLS = 3  # how often the truck is subdivided
SHARE = 0.2  # of the area, that the part has at most which commands for one part get
MODELS = *generated.MODELS, "truck", *DEMO


def read(name):
    """vertices (V, 3), triangles (T, 3)"""
    from partwheel import examples

    if name in generated.MODELS:
        return generated.MODELS[name]()
    if name == "truck":
        truck = examples.truck()
        vertices, triangles, times = truck.vertices, truck.triangles, SHELLS
    else:
        vertices, triangles = read_off(ROOT / "build" / "deps" / "meshes" / f"{name}.off")
        times = DEMO[name]
    for _ in range(times):
        vertices, triangles = subdivided(vertices, triangles)
    return vertices, triangles


class StepClock:
    """Measures the steps of commands: what runs in a Computation interrupts it."""

    def __init__(self, computation):
        self.steps, self._start = [], None
        create, clock = computation.__init__, self

        def created(self, *arguments, **options):
            create(self, *arguments, **options)
            run = self.run

            def interrupted():
                clock._stop()
                try:
                    return run()
                finally:
                    clock._start = time.thread_time()

            self.run = interrupted

        computation.__init__ = created

    def measure(self, command):
        """The longest step of a command, in seconds."""
        self.steps, self._start = [], time.thread_time()
        command()
        self._stop()
        return max(self.steps)

    def _stop(self):
        self.steps.append(time.thread_time() - self._start)


class Bench:
    """A model in an otherwise empty scene, and the commands."""

    def __init__(self, package):
        module = installed(package)
        self.api = importlib.import_module(f"{module}.api")
        self.error = importlib.import_module("partwheel").Error
        self.clock = StepClock(importlib.import_module(f"{module}.mesh.computation").Computation)

    def commands(self):
        """{name: a function that prepares and returns the command}"""
        parts, convex = bpy.ops.mesh.partwheel_parts, bpy.ops.mesh.partwheel_convex
        results = ("FACE_SETS", "VERTEX_GROUPS", "COLORS", "MATERIALS", "SEAMS", "OBJECTS", "BONES", "PRINT")
        return {
            "Find Parts": lambda: bpy.ops.mesh.partwheel_build,
            **{f"Parts to... {result}": lambda result=result: lambda: parts(to={result}) for result in results},
            "Split into Solids, nearly convex": lambda: lambda: bpy.ops.mesh.partwheel_split(by="LEAST_CONCAVITY"),
            "Convex Parts": lambda: convex,
            "Convex Parts by error": lambda: lambda: convex(by="ERROR"),
            "Convex Parts of This Part": self.picked(bpy.ops.mesh.partwheel_convex_part),
            "Copy Part as Solid": self.picked(bpy.ops.mesh.partwheel_copy),
            "Remove Part": self.picked(bpy.ops.mesh.partwheel_remove, "EDIT"),
            "Swap with Compatible Part, on Enter": self.to_swap,
            "Swap with Compatible Part, candidates": self.to_compare,
            "Unite Solids": self.to_unite,
            "Delete Loose Bits": lambda: lambda: bpy.ops.mesh.partwheel_loose(size=0.15),  # the truck has some
            "Select Similar Parts": self.picked(bpy.ops.mesh.partwheel_similar, "EDIT"),
            "Select Mirrored Part": self.picked(bpy.ops.mesh.partwheel_mirrored, "EDIT"),
            "Remember Part": self.picked(bpy.ops.mesh.partwheel_remember, "EDIT"),
        }

    def open(self, vertices, triangles):
        """The model as the only object, in Object Mode, without a cut."""
        if bpy.context.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
        for blocks in (bpy.data.objects, bpy.data.meshes, bpy.data.armatures, bpy.data.materials):
            bpy.data.batch_remove(list(blocks))
        self.obj = self.add(vertices, triangles)
        self.tip = int(np.linalg.norm(vertices - vertices.mean(axis=0), axis=1)[triangles].min(axis=1).argmax())

    def add(self, vertices, triangles):
        mesh = bpy.data.meshes.new("model")
        mesh.from_pydata(vertices.tolist(), [], triangles.tolist())
        obj = bpy.data.objects.new("model", mesh)
        bpy.context.collection.objects.link(obj)
        bpy.context.view_layer.objects.active = obj
        obj.select_set(True)
        return obj

    def picked(self, operator, mode="OBJECT"):
        """Prepares an operator of the picked part: at the tip that is farthest from the middle."""
        def prepare():
            bpy.ops.object.mode_set(mode=mode)
            self.api.select(self.obj, self.api.part(self.obj, self.tip, size=SHARE))
            return operator
        return prepare

    def copied(self, matrix=None):
        """A copy of the model, with parts."""
        other = self.obj.copy()
        other.data = other.data.copy()
        bpy.context.collection.objects.link(other)
        other.matrix_world = matrix or self.obj.matrix_world
        return other

    def to_compare(self):
        other, part = self.copied(), self.api.part(self.obj, self.tip, size=SHARE)
        return lambda: self.api.compatible(self.obj, part, other)

    def to_swap(self):
        other, part = self.copied(), self.api.part(self.obj, self.tip, size=SHARE)
        return self.picked(lambda: bpy.ops.mesh.partwheel_swap(other=other.name, other_node=part.node, build=False))()

    def to_unite(self):
        offset = Matrix.Translation(np.array([0.11, 0.07, 0.05]) * max(self.obj.dimensions))
        self.copied(offset @ Matrix.Rotation(0.7, 4, (1, 2, 3))).select_set(True)
        return lambda: bpy.ops.object.partwheel_unite(build=False)


def main(package, *names):
    bench = Bench(package)
    longest = {name: {} for name in bench.commands()}
    for model in names or MODELS:
        vertices, triangles = read(model)
        bench.open(vertices, triangles)
        bench.api.build(bench.obj)
        for command, prepare in bench.commands().items():
            bench.open(vertices, triangles)
            try:
                longest[command][model] = bench.clock.measure(prepare())
                took = f"{longest[command][model]:.2f} s"
            except (RuntimeError, bench.error) as error:  # the command refuses, with a reason
                took = str(error).strip()
            print(f"{model}, {len(triangles):,} faces, {command}: {took}", file=sys.stderr, flush=True)
    print("| longest step in the main thread, seconds | models | median | largest | on |\n|---|---|---|---|---|")
    for command, seconds in longest.items():
        if seconds:
            worst = max(seconds, key=seconds.get)
            print(f"| {command} | {len(seconds)} | {statistics.median(seconds.values()):.2f} | {seconds[worst]:.2f} | {worst} |")


main(*sys.argv[1:])
