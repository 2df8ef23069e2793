# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts drawn over the model with the gpu module: the triangles of a part are one slice of one array of indices.

Everything on the graphics card is made when it is first drawn: without a window there is none.
"""

from functools import cached_property

import bpy
import gpu
import numpy as np
from mathutils import Matrix, Vector

from ..mesh import arrays, kept
from ..preferences import preferences
from .seen import NO_FACE
from partwheel.cut import colors

HOVER = (1.0, 0.8, 0.25, 0.4)
PART = (1.0, 0.55, 0.1, 0.3)
NEXT = (0.25, 0.7, 1.0, 0.22)
GLASS = (0.75, 0.9, 1.0, 0.75)
CUT_OPACITY = 0.55
# How much nearer to the eye than the model the overlay is drawn, as a share of the distance, so that the model's own
# faces don't show through.
NEARER = 5e-4

# Layers of paint are flat, of glass clear where seen from the front. "planes" are those of the clipping region.
UNIFORMS = "struct PartwheelLayer { mat4 matrix; mat4 planes; vec4 eye; vec4 color; vec4 glass; };"
VERTEX = f"""
void main()
{{
  vec3 near = pos + (layer.eye.xyz - pos * layer.eye.w) * {NEARER};
  gl_Position = layer.matrix * vec4(near, 1.0);
  local = pos;
  tint = COLOR;
}}
"""
FRAGMENT = """
void main()
{
  if (any(lessThan(layer.planes * vec4(local, 1.0), vec4(0.0)))) {
    discard;
  }
  vec3 normal = normalize(cross(dFdx(local), dFdy(local)));
  float facing = abs(dot(normal, normalize(layer.eye.xyz - local * layer.eye.w)));
  fragColor = vec4(tint.rgb, tint.a * mix(1.0, 0.15 + 0.85 * pow(1.0 - facing, 2.0), layer.glass.x));
}
"""
_shaders = {}


def _shader(colored):
    """Of one colour, or with the attribute "color"."""
    if colored not in _shaders:
        info = gpu.types.GPUShaderCreateInfo()
        info.typedef_source(UNIFORMS)
        info.uniform_buf(0, "PartwheelLayer", "layer")
        info.vertex_in(0, "VEC3", "pos")
        if colored:
            info.vertex_in(1, "VEC4", "color")
        passed = gpu.types.GPUStageInterfaceInfo("partwheel_colored" if colored else "partwheel_flat")
        passed.smooth("VEC3", "local")
        passed.smooth("VEC4", "tint")
        info.vertex_out(passed)
        info.fragment_out(0, "VEC4", "fragColor")
        info.define("COLOR", "color" if colored else "layer.color")
        info.vertex_source(VERTEX)
        info.fragment_source(FRAGMENT)
        _shaders[colored] = gpu.shader.create_from_info(info)
    return _shaders[colored]


def _vertices(**attributes):
    """A buffer of these (n, width) attributes."""
    form = gpu.types.GPUVertFormat()
    for name, values in attributes.items():
        form.attr_add(id=name, comp_type="F32", len=values.shape[1], fetch_mode="FLOAT")
    buffer = gpu.types.GPUVertBuf(form, len(attributes["pos"]))
    for name, values in attributes.items():
        buffer.attr_fill(name, np.ascontiguousarray(values, np.float32))
    return buffer


class Parts:
    """What is seen of an object (a seen.Seen): its triangles in the order of its hierarchy's faces."""

    def __init__(self, seen, hierarchy):
        self.hierarchy, self.positions = hierarchy, seen.positions
        known = seen.faces != NO_FACE
        triangles, faces = seen.triangles[known], seen.faces[known]
        # Of each face together: sorted, but where they are so already, as ever without modifiers.
        by_face = np.arange(len(faces)) if (faces[1:] >= faces[:-1]).all() else np.argsort(faces, kind="stable")
        counts = np.bincount(faces, minlength=len(hierarchy.order))
        begin, counts = (np.cumsum(counts) - counts)[hierarchy.order], counts[hierarchy.order]
        self._start = np.concatenate([[0], np.cumsum(counts)])
        self.triangles = triangles[by_face[np.arange(len(faces)) + np.repeat(begin - self._start[:-1], counts)]]
        self._batches = {}

    def slice(self, node):
        """(first, last) of a node's triangles."""
        return (int(self._start[self.hierarchy.first[node]]), int(self._start[self.hierarchy.last[node]]))

    def shell(self, node, larger):
        """What the larger node has more than the node, as slices of triangles."""
        (first, last), (begin, end) = self.slice(node), self.slice(larger)
        return [piece for piece in ((begin, first), (last, end)) if piece[0] < piece[1]]

    def batch(self, piece):
        """(shader, batch) of a slice of triangles."""
        return _shader(False), self._kept(piece, lambda: _batch(self._buffer, self.triangles[slice(*piece)]))

    def of_faces(self, name, faces):
        """The same of the triangles of any faces, kept under a name."""
        def make():
            chosen = arrays.mask(len(self.hierarchy.order), faces)
            return _batch(self._buffer, self.triangles[np.repeat(chosen[self.hierarchy.order], np.diff(self._start))])
        return _shader(False), self._kept(name, make)

    def hull(self, node):
        """The same of a node's convex hull."""
        def make():
            vertices, triangles = self.hierarchy.hull(node)
            return _batch(_vertices(pos=vertices), np.ascontiguousarray(triangles))
        return _shader(False), self._kept(node, make)

    def cut(self, node):
        """The same of all triangles, coloured by the parts of the dendrogram cut at the node's height."""
        return self.painted(("cut", node), lambda: distinct(self.hierarchy.face_labels(
            self.hierarchy.cut_height(self.hierarchy.height[node]))))

    def painted(self, name, paint):
        """The same of all triangles, kept under a name; paint(): (F,4) the colour of each face."""
        def make():
            corners = self.positions[self.triangles.ravel()]
            shades = np.repeat(paint()[self.hierarchy.order], 3 * np.diff(self._start), axis=0)
            return gpu.types.GPUBatch(type="TRIS", buf=_vertices(pos=corners, color=shades))
        return _shader(True), self._kept(name, make)

    @cached_property
    def _buffer(self):
        return _vertices(pos=self.positions)

    def _kept(self, name, make):
        """Of what was drawn last, since the user goes back and forth."""
        if name not in self._batches:
            while len(self._batches) >= 12:
                del self._batches[next(iter(self._batches))]
            self._batches[name] = make()
        return self._batches[name]


def _batch(buffer, triangles):
    return gpu.types.GPUBatch(type="TRIS", buf=buffer, elem=gpu.types.GPUIndexBuf(type="TRIS", seq=triangles))


def distinct(labels, opacity=CUT_OPACITY):
    """(n,4) a colour for each label, far from those of the labels next to it."""
    return np.column_stack([colors(labels), np.broadcast_to(opacity, len(labels))])


def draw_held(context, obj, parts, node, larger, snapped):
    """The part that is held, what the next notch adds, and what else the preferences want. snapped: the part's faces
    where its border is not the node's own, else None."""
    wanted, layers = preferences(), []
    if wanted.show_cut:
        layers.append((*parts.cut(node), PART, 0.0))
    if wanted.show_next:
        layers += _shell(parts, node, larger, snapped)
    if wanted.show_part:
        layers += _layer(parts, node, PART, snapped)
    if wanted.show_hull:
        layers.append((*parts.hull(node), GLASS, 1.0))
    _draw(context, obj, layers)


def draw_painted(context, obj, parts, name, paint):
    """All faces, each in its colour: see Parts.painted()."""
    _draw(context, obj, [(*parts.painted(name, paint), PART, 0.0)])


def draw_faces(context, obj, parts, name, faces):
    """Any faces, kept under a name."""
    _draw(context, obj, [(*parts.of_faces(name, faces), PART, 0.0)])


def draw_hover(context, obj, parts, node, snapped):
    """The part that a click would take."""
    _draw(context, obj, _layer(parts, node, HOVER, snapped))


def _layer(parts, node, color, snapped):
    if snapped is not None:
        return [(*parts.of_faces(("snapped", node), snapped), color, 0.0)]
    piece = parts.slice(node)
    return [(*parts.batch(piece), color, 0.0)] if piece[0] < piece[1] else []


def _shell(parts, node, larger, snapped):
    if snapped is None:
        return [(*parts.batch(piece), NEXT, 0.0) for piece in parts.shell(node, larger)]
    if node == larger:
        return []
    more = np.setdiff1d(parts.hierarchy.faces(larger), snapped)
    return [(*parts.of_faces(("beyond", node, larger), more), NEXT, 0.0)]


def _draw(context, obj, layers):
    """layers: (shader, batch, colour, 1 for glass and 0 for paint), drawn one over the other in the context's view."""
    view = context.region_data
    to_local = obj.matrix_world.inverted_safe()
    if view.is_perspective:
        eye = (*(to_local @ view.view_matrix.inverted().translation), 1.0)
    else:
        away = view.view_matrix.inverted().to_3x3() @ Vector((0, 0, view.view_distance))
        eye = (*(to_local.to_3x3() @ away), 0.0)
    planes = Matrix([(0.0, 0.0, 0.0, 1.0)] * 4)
    if view.use_clip_planes:
        planes = Matrix(list(view.clip_planes)[:4]) @ obj.matrix_world
    before = gpu.state.blend_get(), gpu.state.depth_test_get(), gpu.state.depth_mask_get()
    gpu.state.blend_set("ALPHA")
    gpu.state.depth_test_set("LESS_EQUAL")
    gpu.state.depth_mask_set(False)
    matrix = view.perspective_matrix @ obj.matrix_world
    for shader, batch, color, glass in layers:
        values = np.concatenate([np.array(matrix.transposed()).ravel(), np.array(planes.transposed()).ravel(), eye,
                                 color, [glass] * 4]).astype(np.float32)
        shader.bind()
        uniforms = gpu.types.GPUUniformBuf(gpu.types.Buffer("FLOAT", len(values), values))  # alive until it is drawn
        shader.uniform_block("layer", uniforms)
        batch.draw(shader)
    gpu.state.blend_set(before[0])
    gpu.state.depth_test_set(before[1])
    gpu.state.depth_mask_set(before[2])


def visible(context, obj):
    """Whether this 3D view shows the object and overlays at all: not in another's local view, or hidden."""
    space = context.space_data
    return space.overlay.show_overlays and obj.visible_get(viewport=space)


class Shown:
    """Draws the held part in every 3D view for as long as it is on."""

    def __init__(self):
        self._handler = self._what = None

    @property
    def on(self):
        return self._handler is not None

    def show(self, drawing, obj, parts, node, larger, snapped):
        """drawing: InView._drawing of the operator that shows it."""
        self._what = obj.name_full, parts, node, larger, snapped
        if not self._handler:
            self._handler = bpy.types.SpaceView3D.draw_handler_add(drawing(self._draw), (), "WINDOW", "POST_VIEW")
        redraw()

    def hide(self):
        if self._handler:
            bpy.types.SpaceView3D.draw_handler_remove(self._handler, "WINDOW")
            redraw()
        self._handler = self._what = None

    def _draw(self):
        context, (name, *what) = bpy.context, self._what
        obj = kept.named(name)
        if obj and visible(context, obj):
            draw_held(context, obj, *what)


def redraw():
    """Of every 3D view."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


shown = Shown()  # what the picking operator that runs now shows; there is one at a time


def unregister():
    shown.hide()
    _shaders.clear()
