# SPDX-License-Identifier: GPL-3.0-or-later
"""A character whose surface is one piece, as scans and generators make them: only its texture tells shirt, skin and hair."""

import bpy
import numpy

# sRGB, CC0
SKIN, SHIRT, HAIR = (0.85, 0.62, 0.52), (0.24, 0.36, 0.62), (0.25, 0.17, 0.12)
SKIN_PATCH, SHIRT_PATCH, HAIR_PATCH = 0, 1, 2
TEXELS = 512  # sides of the texture: the left half has the front, the right half the back
NOISE = 0.03  # of the texture
# Center, radii of the ellipsoids that the figure is united from; its height is 4.
SHAPE = [((0, 0, 2.35), (0.55, 0.36, 0.75)), ((0, 0, 1.75), (0.52, 0.34, 0.4)), ((0, 0, 3.05), (0.16, 0.16, 0.4)),
         ((0, 0, 3.55), (0.34, 0.36, 0.42))]
for SIDE in (-1, 1):
    SHAPE += [((SIDE * 0.72, 0, 2.75), (0.42, 0.2, 0.2)), ((SIDE * 1.15, 0, 2.72), (0.45, 0.14, 0.14)),
              ((SIDE * 1.55, 0, 2.7), (0.2, 0.12, 0.17)), ((SIDE * 0.27, 0, 1.2), (0.22, 0.24, 0.75)),
              ((SIDE * 0.27, 0, 0.55), (0.17, 0.19, 0.55)), ((SIDE * 0.27, -0.12, 0.1), (0.17, 0.32, 0.13))]


def paint_patch(x, z, is_front):
    """The patch at each place, of front and back."""
    hair = (z > numpy.where(is_front, 3.68, 3.3)) & (abs(x) < 0.6)
    shirt = (z > 1.62) & (z < 3.0) & (abs(x) < 1.0)
    return numpy.where(hair, HAIR_PATCH, numpy.where(shirt, SHIRT_PATCH, SKIN_PATCH))


def create_figure(name="figure", voxel=0.08):
    """A linked object, with a material and an image. Its polygons are quads."""
    import bmesh
    bm = bmesh.new()
    for center, radii in SHAPE:
        for vertex in bmesh.ops.create_uvsphere(bm, u_segments=24, v_segments=16, radius=1)["verts"]:
            vertex.co = [middle + radius * coordinate for middle, radius, coordinate in zip(center, radii, vertex.co)]
    mesh = bpy.data.meshes.new(name)
    bm.to_mesh(mesh)
    bm.free()
    obj = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    mesh.remesh_voxel_size = voxel
    bpy.ops.object.voxel_remesh()
    paint(obj)
    return obj


def paint(obj):
    """Gives the object a texture from front and back."""
    mesh = obj.data
    corners = numpy.empty(len(mesh.loops), numpy.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    points = numpy.empty(3 * len(mesh.vertices), numpy.float32)
    mesh.vertices.foreach_get("co", points)
    points = points.reshape(-1, 3)
    is_front = numpy.repeat([polygon.center.y < 0 for polygon in mesh.polygons], [polygon.loop_total for polygon in mesh.polygons])
    u, v = (points[corners, 0] + 2) / 8 + 0.5 * ~is_front, points[corners, 2] / 4.2 + 0.02
    mesh.uv_layers.new(name="Front and back").data.foreach_set("uv", numpy.column_stack([u, v]).astype(numpy.float32).ravel())
    v, u = (numpy.mgrid[:TEXELS, :TEXELS] + 0.5) / TEXELS
    is_left = u < 0.5
    patch = paint_patch((u - 0.5 * ~is_left) * 8 - 2, (v - 0.02) * 4.2, is_left)
    colors = numpy.array([SKIN, SHIRT, HAIR])[patch] + numpy.random.default_rng(0).normal(0, NOISE, (TEXELS, TEXELS, 3))
    image = bpy.data.images.new("figure", TEXELS, TEXELS)
    image.pixels.foreach_set(numpy.dstack([colors.clip(0, 1), numpy.ones_like(u)]).astype(numpy.float32).ravel())
    image.pack()
    material = bpy.data.materials.new("figure")
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    texture = nodes.new("ShaderNodeTexImage")
    texture.image = image
    shader = next(node for node in nodes if node.type == "BSDF_PRINCIPLED")
    links.new(texture.outputs["Color"], shader.inputs["Base Color"])
    mesh.materials.append(material)


def patches(obj):
    """(F,) the patch of each polygon, by its center."""
    centers = numpy.array([polygon.center for polygon in obj.data.polygons])
    return paint_patch(centers[:, 0], centers[:, 2], centers[:, 1] < 0)


# Names of patches: a number, and a place on the surface, all on the front but the hair.
PLACES = {"shirt": (SHIRT_PATCH, (0, -0.35, 2.4)), "face": (SKIN_PATCH, (0, -0.36, 3.5)), "hair": (HAIR_PATCH, (0, 0.36, 3.6)),
          "legs": (SKIN_PATCH, (0.27, -0.2, 0.8)), "hand": (SKIN_PATCH, (1.55, -0.12, 2.7))}


def connected_patch(obj, name):
    """(F,) bool: the polygons of the patch of this name, connected by edges."""
    number, place = PLACES[name]
    is_of_patch, at_edge = patches(obj) == number, {}
    for polygon in obj.data.polygons:
        for key in polygon.edge_keys:
            at_edge.setdefault(key, []).append(polygon.index)
    centers = numpy.array([polygon.center for polygon in obj.data.polygons])
    is_found = numpy.zeros(len(centers), bool)
    todo = [int(numpy.where(is_of_patch, numpy.linalg.norm(centers - place, axis=1), numpy.inf).argmin())]
    while todo:
        face = todo.pop()
        if is_of_patch[face] and not is_found[face]:
            is_found[face] = True
            todo += [other for key in obj.data.polygons[face].edge_keys for other in at_edge[key]]
    return is_found
