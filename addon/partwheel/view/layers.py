# SPDX-License-Identifier: GPL-3.0-or-later
"""Drawing over a model with the gpu module: tints, glass, and lines of constant width on the screen.

GPU objects are created when they are first drawn, because there is no GPU context without a window. Lines are
rectangles that our own shader builds, so all backends draw them alike and the clipping region cuts them."""

from collections.abc import Iterable, Iterator
from typing import NamedTuple

import bpy
import gpu
import numpy as np
from mathutils import Matrix, Vector

from partwheel.components import to_mask

# Offsets of tints and lines toward the eye, as fractions of the distance, so that the model's faces don't hide them.
DEPTH_OFFSET, LINE_DEPTH_OFFSET = 5e-4, 2e-3

# planes: of the clipping region; size: of the region in pixels; kind: 1 for glass, half the line width, depth offset.
UNIFORMS = "struct PartwheelLayer { mat4 matrix; mat4 planes; vec4 eye; vec4 color; vec4 kind; vec4 size; };"
COMMON_VERTEX = """
vec4 to_clip_space(vec3 position)
{
  return layer.matrix * vec4(position + (layer.eye.xyz - position * layer.eye.w) * layer.kind.z, 1.0);
}
"""
PAINT_VERTEX = COMMON_VERTEX + """
void main()
{
  gl_Position = to_clip_space(pos);
  local = pos;
  tint = COLOR;
}
"""
LINE_VERTEX = COMMON_VERTEX + """
void main()
{
  vec4 start = to_clip_space(pos), end = to_clip_space(other_end);
  vec2 along = (end.xy / end.w - start.xy / start.w) * layer.size.xy;
  along *= layer.kind.y / max(length(along), 1e-6);
  start.xy += 2.0 * start.w / layer.size.xy * (vec2(-along.y, along.x) * side - along);
  gl_Position = start;
  local = pos;
  tint = layer.color;
}
"""
FRAGMENT = """
void main()
{
  if (any(lessThan(layer.planes * vec4(local, 1.0), vec4(0.0)))) {
    discard;
  }
  fragColor = tint;
  if (layer.kind.x > 0.0) {
    vec3 normal = normalize(cross(dFdx(local), dFdy(local)));
    float facing = abs(dot(normal, normalize(layer.eye.xyz - local * layer.eye.w)));
    fragColor.a *= 0.15 + 0.85 * pow(1.0 - facing, 2.0);
  }
}
"""
# Attributes other than "pos", and the vertex shader.
SHADER_KINDS = {"flat": ({}, PAINT_VERTEX), "colored": ({"color": 4}, PAINT_VERTEX),
                "line": ({"other_end": 3, "side": 1}, LINE_VERTEX)}
_shaders = {}
Drawable = tuple  # (gpu.types.GPUShader, gpu.types.GPUBatch)


class Layer(NamedTuple):
    """A batch to draw. glass: transparent where it faces the viewer. width: of lines, in pixels."""

    drawable: Drawable
    color: tuple
    glass: bool = False
    width: float = 0.0


def get_shader(kind: str) -> gpu.types.GPUShader:
    """Return one of SHADER_KINDS, created at its first use."""
    if kind not in _shaders:
        attributes, source = SHADER_KINDS[kind]
        info = gpu.types.GPUShaderCreateInfo()
        info.typedef_source(UNIFORMS)
        info.uniform_buf(0, "PartwheelLayer", "layer")
        info.vertex_in(0, "VEC3", "pos")
        for location, (name, width) in enumerate(attributes.items(), 1):
            info.vertex_in(location, "FLOAT" if width == 1 else f"VEC{width}", name)
        varyings = gpu.types.GPUStageInterfaceInfo(f"partwheel_{kind}")
        varyings.smooth("VEC3", "local")
        varyings.smooth("VEC4", "tint")
        info.vertex_out(varyings)
        info.fragment_out(0, "VEC4", "fragColor")
        info.define("COLOR", "color" if "color" in attributes else "layer.color")
        info.vertex_source(source)
        info.fragment_source(FRAGMENT)
        _shaders[kind] = gpu.shader.create_from_info(info)
    return _shaders[kind]


def create_vertex_buffer(**attributes: np.ndarray) -> gpu.types.GPUVertBuf:
    """Return a vertex buffer of these attributes, each (n, width)."""
    form = gpu.types.GPUVertFormat()
    for name, values in attributes.items():
        form.attr_add(id=name, comp_type="F32", len=values.shape[1], fetch_mode="FLOAT")
    buffer = gpu.types.GPUVertBuf(form, len(attributes["pos"]))
    for name, values in attributes.items():
        buffer.attr_fill(name, np.ascontiguousarray(values, np.float32))
    return buffer


def create_batch(buffer: gpu.types.GPUVertBuf, triangles: np.ndarray) -> gpu.types.GPUBatch:
    """Return a batch of these triangles (n, 3) of the buffer."""
    return gpu.types.GPUBatch(type="TRIS", buf=buffer, elem=gpu.types.GPUIndexBuf(type="TRIS", seq=triangles))


def create_line_batch(positions: np.ndarray, edges: np.ndarray) -> tuple[gpu.types.GPUShader, gpu.types.GPUBatch]:
    """Return (shader, batch) for edges (n, 2) of positions: one rectangle per edge, whose corners know both ends and
    their side."""
    ends = positions[edges]  # (n, 2, 3)
    corner_positions = ends[:, (0, 0, 1, 1)].reshape(-1, 3)
    other_ends = ends[:, (1, 1, 0, 0)].reshape(-1, 3)
    sides = np.tile([1.0, -1.0, 1.0, -1.0], len(edges))[:, None]
    corners = 4 * np.arange(len(edges), dtype=np.int32)[:, None, None] + np.array([(0, 1, 2), (0, 2, 3)], np.int32)
    buffer = create_vertex_buffer(pos=corner_positions, other_end=other_ends, side=sides)
    return get_shader("line"), create_batch(buffer, corners.reshape(-1, 3))


def find_neighbor_triangles(triangles: np.ndarray) -> Iterator[np.ndarray | None]:
    """Compute the triangle across each edge of triangles (T, 3), from edge 01 on; T where there is none. Edges of more
    than two triangles link each to the next. This takes a while, so it is a generator: it yields None after each step,
    and last the (T, 3) int32 result."""
    number = len(triangles)
    if not number:
        yield np.empty((0, 3), np.int32)
        return
    count = int(triangles.max()) + 1
    a, b, c = triangles.T.astype(np.int64)
    keys = np.concatenate([np.minimum(*ends) * count + np.maximum(*ends) for ends in ((a, b), (b, c), (c, a))])
    yield None
    order = np.argsort(keys, kind="stable")  # faster: neighbors have similar indices
    yield None
    differs = np.flatnonzero(np.diff(keys[order])) + 1
    first, end = np.concatenate([[0], differs]), np.concatenate([differs, [3 * number]])
    neighbors = np.roll(order, -1)
    neighbors[end - 1] = order[first]
    yield None
    neighbors %= number
    neighbors[first[end - first == 1]] = number
    result = np.empty(3 * number, np.int32)
    result[order] = neighbors
    yield result.reshape(3, number).T


def find_border_edges(triangles: np.ndarray, neighbors: np.ndarray, members: np.ndarray) -> np.ndarray:
    """Return the edges (n, 2) of member triangles (k,) without a member across. neighbors: of all triangles."""
    member, edge = np.nonzero(~to_mask(len(triangles) + 1, members)[neighbors[members]])
    ends = triangles[members[member]]
    rows = np.arange(len(ends))
    return np.column_stack([ends[rows, edge], ends[rows, (edge + 1) % 3]])


def is_see_through(context: bpy.types.Context) -> bool:
    """Return whether the view shows what lies behind surfaces: X-ray and wireframe. Then nothing hides the layers."""
    shading = context.space_data.shading if context.space_data else None
    return shading is not None and (shading.type == "WIREFRAME" or shading.type == "SOLID" and shading.show_xray)


def draw_layers(context: bpy.types.Context, obj: bpy.types.Object, layers: Iterable[Layer]) -> None:
    """Draw the layers in the context's view, one over the other."""
    view = context.region_data
    to_local = obj.matrix_world.inverted_safe()
    if view.is_perspective:
        eye = (*(to_local @ view.view_matrix.inverted().translation), 1.0)
    else:
        to_viewer = view.view_matrix.inverted().to_3x3() @ Vector((0, 0, view.view_distance))
        eye = (*(to_local.to_3x3() @ to_viewer), 0.0)
    planes = Matrix([(0.0, 0.0, 0.0, 1.0)] * 4)
    if view.use_clip_planes:
        planes = Matrix(list(view.clip_planes)[:4]) @ obj.matrix_world
    before = gpu.state.blend_get(), gpu.state.depth_test_get(), gpu.state.depth_mask_get()
    through = is_see_through(context)
    gpu.state.blend_set("ALPHA")
    gpu.state.depth_test_set("ALWAYS" if through else "LESS_EQUAL")
    gpu.state.depth_mask_set(False)
    matrix = view.perspective_matrix @ obj.matrix_world
    for (shader, batch), color, glass, width in layers:
        gpu.state.face_culling_set("BACK" if through and not width else "NONE")  # otherwise both sides add up
        kind = glass, width / 2, LINE_DEPTH_OFFSET if width else DEPTH_OFFSET, 0
        values = np.concatenate([np.array(matrix.transposed()).ravel(), np.array(planes.transposed()).ravel(), eye,
                                 color, kind, (context.region.width, context.region.height, 0, 0)]).astype(np.float32)
        shader.bind()
        uniforms = gpu.types.GPUUniformBuf(gpu.types.Buffer("FLOAT", len(values), values))  # referenced until drawn
        shader.uniform_block("layer", uniforms)
        batch.draw(shader)
    gpu.state.face_culling_set("NONE")
    gpu.state.blend_set(before[0])
    gpu.state.depth_test_set(before[1])
    gpu.state.depth_mask_set(before[2])


def unregister() -> None:
    _shaders.clear()
