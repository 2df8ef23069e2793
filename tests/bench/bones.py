# SPDX-License-Identifier: GPL-3.0-or-later
"""Joints bent with the weights of Parts to... and with Blender's automatic ones. Called by scripts/bench_bones: in
Blender it bends them and leaves what came of it in a directory, in plain Python it measures that and prints a table."""

import sys
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "native" / "python"))
DEGREES = 60
# Of each model its limbs: a place near the tip of each, and how far from there, along the surface, its joints are, in
# shares of the model's diagonal: the one that is bent, and the one by which the limb hangs on the body. man is broken
# and filled from points.
LIMBS = {
    "armadillo": {"elbow": ((49.5, 88.7, -38.6), 0.245, 0.33), "knee": ((33, -53, -5), 0.25, 0.38),
                  "finger": ((49.5, 88.7, -38.6), 0.05, None)},
    "figure": {"elbow": ((0.92, -0.035, 0.97), 0.185, 0.27), "knee": ((0.165, -0.2, 0.05), 0.235, 0.36),
               "finger": ((0.92, -0.035, 0.97), 0.05, None)},
    "man": {"elbow": ((-0.19, 0.03, -0.1), 0.22, 0.34), "knee": ((0.18, -0.146, -0.478), 0.30, 0.46),
            "finger": ((-0.19, 0.03, -0.1), 0.04, None)},
}
VIEWS = {"armadillo": ((0, 0, -1), (0, 1, 0)), "figure": ((0.5, -1, 0.1), (0, 0, 1)), "man": ((-0.5, -1, 0), (0, 0, 1))}


# ---- In Blender


def bend_all(directory):
    import importlib.util

    import bpy

    # The add-on from the checkout, under the name that it has where it is installed.
    spec = importlib.util.spec_from_file_location("partwheel_addon", ROOT / "addon" / "partwheel" / "__init__.py")
    addon = sys.modules[spec.name] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(addon)
    addon.register()
    for name in LIMBS:
        for obj in list(bpy.data.objects):
            bpy.data.objects.remove(obj)
        bend(directory, name)


def bend(directory, name):
    import bpy
    from partwheel import api, meshes
    from partwheel.cut import Cut, colors
    from partwheel.examples import EXAMPLES

    source = EXAMPLES[name]() if name in EXAMPLES else meshes.read(ROOT / "build" / "deps" / "meshes" / f"{name}.off")
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(source.vertices.tolist(), [], source.triangles.tolist())
    obj = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    vertices = np.array([vertex.co[:] for vertex in mesh.vertices])
    other = bpy.data.objects.new(f"{name} heat", mesh.copy())  # before it has any weights
    bpy.context.collection.objects.link(other)
    labels, beyond = divided(vertices, source.triangles, LIMBS[name])
    start_time = time.process_time()
    hierarchy = api.build(obj)
    built = time.process_time() - start_time
    cut = Cut.from_labels(hierarchy, labels)
    start_time = time.process_time()
    names = api.write(obj, cut, {"BONES"}).names
    seconds = {"ours": time.process_time() - start_time}
    rig = obj.find_armature()
    for selected in bpy.context.selected_objects:
        selected.select_set(False)
    other.select_set(True)
    rig.select_set(True)
    bpy.context.view_layer.objects.active = rig
    start_time = time.process_time()
    bpy.ops.object.parent_set(type="ARMATURE_AUTO")
    seconds["heat"] = time.process_time() - start_time
    bpy.context.view_layer.objects.active = obj
    results = {"rest": vertices, "triangles": source.triangles, "labels": cut.labels, "built": built,
               "fill_method": hierarchy.summary.fill_method}
    for method, thing in (("ours", obj), ("heat", other)):
        results[f"{method} seconds"] = seconds[method]
        results[f"{method} without"] = sum(not any(group.weight > 0 for group in vertex.groups)
                                        for vertex in thing.data.vertices)
    # Which part that is now: where labels divide a tetrahedron, most count.
    beyond = {joint: int(np.bincount(cut.labels[labels == beyond[joint]]).argmax()) for joint in LIMBS[name]}
    for joint, part in beyond.items():
        bone = rig.pose.bones[names[part]]
        results[f"{joint} parts"] = part, names.index(bone.parent.name)
        results[f"{joint} at"] = np.array(bone.bone.head_local)
        turn(bone, DEGREES)
        results[f"{joint} ours"], results[f"{joint} heat"] = posed(obj), posed(other)
        other.modifiers[0].use_deform_preserve_volume = True
        results[f"{joint} heat, preserved"] = posed(other)
        other.modifiers[0].use_deform_preserve_volume = False
        turn(bone, 0)
    np.savez(directory / f"{name}.npz", **results)
    for part in beyond.values():
        turn(rig.pose.bones[names[part]], DEGREES)
    picture(directory / f"{name}.png", ((obj, 0), (other, 1)), colors(cut.keys)[cut.labels], *VIEWS[name])


def divided(vertices, triangles, limbs):
    """((T,) a number of each triangle, {joint: the number beyond it}): what lies nearer to a tip than a joint, along
    the surface, is a part."""
    from partwheel.deform import surface_distances
    from partwheel.weld import weld_surface

    _, triangles = weld_surface(vertices, triangles)
    middles = vertices[triangles].mean(axis=1)
    size = np.linalg.norm(np.ptp(vertices, axis=0))
    rings = []
    for joint, (place, *shares) in limbs.items():
        tip = ((middles - place) ** 2).sum(axis=1).argmin()
        tip_distance = surface_distances(vertices, triangles, triangles[tip])[triangles].mean(axis=1) / size
        rings += [(share, name, tip_distance < share) for share, name in zip(shares, (joint, "")) if share]
    labels, beyond = np.zeros(len(triangles), int), {}
    for number, (_, joint, near) in enumerate(sorted(rings, key=lambda ring: -ring[0]), 1):
        labels[near] = number
        beyond[joint] = number
    return labels, beyond


def turn(bone, degrees):
    """As a hinge that bends further: about what is across this bone and the one that it hangs on."""
    from mathutils import Quaternion, Vector

    direction, before = ((posed.bone.tail_local - posed.bone.head_local).normalized() for posed in (bone, bone.parent))
    hinge = before.cross(direction)
    if hinge.length < 0.05:
        hinge = direction.orthogonal()
    bone.rotation_mode = "QUATERNION"
    bone.rotation_quaternion = Quaternion(bone.bone.matrix_local.to_3x3().inverted() @ Vector(hinge.normalized()),
                                          np.radians(degrees))


def posed(obj):
    import bpy

    bpy.context.view_layer.update()
    mesh = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    return np.array([vertex.co[:] for vertex in mesh.vertices])


def picture(path, objects, colors, towards, up):
    """The objects as they are posed, beside each other, in colors of their faces."""
    import bpy
    from mathutils import Matrix, Vector

    scene = bpy.context.scene
    back, up = Vector(towards).normalized(), Vector(up)
    right = up.cross(back).normalized()
    up = back.cross(right)
    corners = np.array([posed(obj) for obj, _ in objects]) @ np.array([right, up, back]).T
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    copies = []
    for obj, place in objects:
        mesh = bpy.data.meshes.new_from_object(obj.evaluated_get(bpy.context.evaluated_depsgraph_get()))
        paint = mesh.color_attributes.new("parts", "FLOAT_COLOR", "CORNER")
        paint.data.foreach_set("color", np.repeat(np.c_[colors, np.ones(len(colors))], 3, axis=0).ravel())
        mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
        mesh.attributes.active_color = paint
        each = bpy.data.objects.new("shown", mesh)
        each.location = right * (1.05 * place * (high - low)[0])
        bpy.context.collection.objects.link(each)
        copies.append(each)
    for each in bpy.data.objects:
        each.hide_render = each not in copies
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    bpy.context.collection.objects.link(camera)
    width, height = 2.1 * (high - low)[0], 1.05 * (high - low)[1]
    middle = (low + high) / 2 + (0.525 * (high - low)[0], 0, 0)
    far = 4 * max(width, height)
    camera.matrix_world = Matrix.Translation(right * middle[0] + up * middle[1] + back * (middle[2] + far)) @ Matrix(
        (right, up, back)).transposed().to_4x4()
    camera.data.type, camera.data.ortho_scale, camera.data.clip_end = "ORTHO", max(width, height), 3 * far
    scene.camera, scene.render.engine, scene.view_settings.view_transform = camera, "BLENDER_WORKBENCH", "Standard"
    scene.display.shading.light, scene.display.shading.color_type = "STUDIO", "VERTEX"
    scene.render.resolution_x, scene.render.resolution_y = 1000, round(1000 * height / width)
    scene.render.film_transparent = False
    scene.world.color = (1, 1, 1)
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)


# ---- In plain Python


def measure(directory):
    """Volume: how it changes, in shares of the part beyond the joint. Crossings: pairs of triangles of the two parts
    that meet there, beyond those at rest."""
    sys.path.insert(0, str(ROOT / "tests" / "core"))
    from solid_checks import count_crossings

    rows = [("", "volume", "bone heat", "preserving volume", "crossings", "bone heat", "preserving volume", "seconds",
             "bone heat")]
    for name, limbs in LIMBS.items():
        given = np.load(directory / f"{name}.npz")
        triangles, rest = given["triangles"], given["rest"]
        lost = int(given["heat without"])
        for joint in limbs:
            about, parts = given[f"{joint} at"], given[f"{joint} parts"]
            limb = volume(rest, triangles[given["labels"] == parts[0]], about)
            both = triangles[np.isin(given["labels"], parts)]
            before = count_crossings(rest, both)
            changed, crossed = [], []
            for method in ("ours", "heat", "heat, preserved"):
                after = given[f"{joint} {method}"]
                share = (volume(after, triangles, about) - volume(rest, triangles, about)) / limb
                fails = lost and method != "ours"
                changed.append("fails" if fails else f"{share:+.1%}")
                crossed.append("fails" if fails else f"{count_crossings(after, both) - before:,}")
            rows.append((f"{name}, {joint}", *changed, *crossed,
                         *(f"{float(given[f'{method} seconds']):.1f}" for method in ("ours", "heat"))))
        if given["ours without"] or lost:
            print(f"{name} ({given['fill_method']}): vertices without weights: ours {int(given['ours without']):,}, "
                  f"bone heat {lost:,}, of {len(rest):,}")
    lines = ["| " + " | ".join(row) + " |" for row in rows]
    lines.insert(1, "|---" * len(rows[0]) + "|")
    print("\n".join(lines))


def volume(vertices, triangles, about):
    a, b, c = (vertices - about)[triangles].transpose(1, 0, 2)
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


if __name__ == "__main__":
    if "--" in sys.argv:
        bend_all(Path(sys.argv[sys.argv.index("--") + 1]))
    else:
        measure(Path(sys.argv[1]))
