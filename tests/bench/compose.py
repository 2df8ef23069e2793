# SPDX-License-Identifier: GPL-3.0-or-later
"""What copying parts and uniting solids cost in Blender. Called by scripts/bench_compose: in plain Python it prepares
the models in a directory, in Blender it prints a row of a table."""

import importlib.util
import sys
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
SHARES, REPEATS = (0.02, 0.35), 5
sys.path.insert(0, str(ROOT / "native" / "python"))


def read(name):
    words = (ROOT / "build" / "deps" / "meshes" / name).read_text().split()
    v, f = int(words[1]), int(words[2])
    return (np.array(words[4:4 + 3 * v], float).reshape(v, 3),
            np.array(words[4 + 3 * v:4 + 3 * v + 4 * f], int).reshape(f, 4)[:, 1:])


def subdivided(vertices, triangles):
    """Each triangle as four."""
    edges = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    unique, of = np.unique(edges, axis=0, return_inverse=True)
    ab, bc, ca = (len(vertices) + of.reshape(-1, 3)).T
    a, b, c = triangles.T
    split = np.stack([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]).transpose(2, 0, 1).reshape(-1, 3)
    return np.concatenate([vertices, vertices[unique].mean(axis=1)]), split


def prepare(directory):
    from partwheel import Hierarchy

    directory.mkdir(parents=True, exist_ok=True)
    if (directory / "bear.partwheel").exists():
        return
    vertices, triangles = subdivided(*read("bear.off"))
    vertices = vertices.astype(np.float32).astype(float)
    np.savez(directory / "bear.npz", vertices=vertices, triangles=triangles)
    (directory / "bear.partwheel").write_bytes(Hierarchy.build(vertices, triangles).save())


def seconds(action):
    """Median of its processor time; each action prepares, then returns what is measured."""
    seconds = []
    for _ in range(REPEATS):
        measured = action()
        start_time = time.process_time()
        measured()
        seconds.append(time.process_time() - start_time)
    return float(np.median(seconds))


def measure(directory):
    import bpy
    from mathutils import Matrix
    from partwheel import Hierarchy

    # The add-on from the checkout, under the name that it has where it is installed.
    spec = importlib.util.spec_from_file_location("partwheel_addon", ROOT / "addon" / "partwheel" / "__init__.py")
    sys.modules[spec.name] = importlib.util.module_from_spec(spec)
    solids, union = (importlib.import_module(f"partwheel_addon.{name}") for name in ("solid.solids", "compose.union"))

    def clear():
        for items in (bpy.data.objects, bpy.data.meshes):
            for item in list(items):
                items.remove(item)
        bpy.context.view_layer.update()

    def add(vertices, triangles):
        mesh = bpy.data.meshes.new("model")
        mesh.from_pydata(vertices.tolist(), [], triangles.tolist())
        obj = bpy.data.objects.new("model", mesh)
        bpy.context.collection.objects.link(obj)
        return obj

    def weigh(obj, vertices):
        """Three vertex groups that overlap along x, as of a rigged limb: most vertices are in two of them."""
        along = (vertices[:, 0] - vertices[:, 0].min()) / np.ptp(vertices[:, 0])
        for number in range(3):
            group = obj.vertex_groups.new(name=f"bone {number}")
            weights = np.clip(1.2 - 2.2 * abs(along - number / 2), 0, 1)
            for vertex in np.flatnonzero(weights > 0).tolist():
                group.add([vertex], float(weights[vertex]), "REPLACE")

    clear()
    bear = np.load(directory / "bear.npz")
    obj = add(bear["vertices"], bear["triangles"])
    hierarchy = Hierarchy.load((directory / "bear.partwheel").read_bytes())
    sizes = hierarchy.last - hierarchy.first
    hierarchy.solid(len(sizes) - 1)  # how the tetrahedra meet is worked out once
    nodes = [int(np.abs(sizes - share * len(bear["triangles"])).argmin()) for share in SHARES]
    slices = [(int(hierarchy.tet_first[node]), int(hierarchy.tet_last[node])) for node in nodes]
    slices.append(slices[0][::-1])  # and all but the small one
    copies = [seconds(lambda ends=ends: lambda: solids.create_meshes(obj, hierarchy, [ends])) for ends in slices]
    weigh(obj, bear["vertices"])
    weighed = [seconds(lambda ends=ends: lambda: solids.create_meshes(obj, hierarchy, [ends])) for ends in slices]
    clear()

    vertices, triangles = read("armadillo.off")
    vertices = (vertices - vertices.mean(axis=0)) / np.ptp(vertices, axis=0).max()
    known = bpy.types.BooleanModifier.bl_rna.properties["solver"].enum_items.keys()
    solver = "MANIFOLD" if "MANIFOLD" in known else "EXACT"

    def pair():
        clear()
        target, other = add(vertices, triangles), add(vertices, triangles)
        other.matrix_world = Matrix.Translation((0.11, 0.07, 0.05)) @ Matrix.Rotation(0.7, 4, (1, 2, 3))
        bpy.context.view_layer.update()
        for operand in (target, other):
            operand.select_set(True)
        bpy.context.view_layer.objects.active = target
        return target, other

    def own():
        target, other = pair()

        def apply():
            modifier = target.modifiers.new("union", "BOOLEAN")
            modifier.operation, modifier.object, modifier.solver = "UNION", other, solver
            bpy.ops.object.modifier_apply(modifier="union")

        return apply

    def ours():
        target, other = pair()
        return lambda: union.unite(target, [other])

    times = seconds(own), seconds(ours)
    plain, grouped = (", ".join(f"{value:.3f}" for value in of) for of in (copies, weighed))
    print(f"| {bpy.app.version_string} | {plain} | {grouped} | ≤ 0.2 | {times[1]:.2f} | "
          f"{times[0]:.2f} ({solver.title()}) | {times[1] / times[0]:.2f} | ≤ 1.2 |")


if "--" in sys.argv:
    measure(Path(sys.argv[sys.argv.index("--") + 1]))
else:
    prepare(Path(sys.argv[1]))
