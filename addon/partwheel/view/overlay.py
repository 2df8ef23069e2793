# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts drawn over the model. The triangles of a node are one slice of one index array."""

from collections.abc import Callable, Hashable, Sequence
from functools import cached_property
from typing import NamedTuple

import bpy
import gpu
import numpy as np

from ..mesh import arrays, find_object
from ..preferences import preferences
from . import layers
from .layers import Drawable, Layer
from .visible_surface import NO_FACE, VisibleSurface
from partwheel import cut, Hierarchy
from partwheel.triangles import side_ends

CUT_OPACITY = 0.55
GLASS = (0.75, 0.9, 1.0, 0.75)
OUTLINE_CASING = (0.0, 0.0, 0.0, 0.55)  # around an outline, visible on any color and for color-blind users
MAX_CACHED_BATCHES = 24


class OverlayColors(NamedTuple):
    """Colors of the part under the mouse, the picked part, and what the next notch adds."""

    hover: tuple
    part: tuple
    next: tuple


def get_theme_colors() -> OverlayColors:
    """Return the theme's colors of active, selected and secondary elements, with opacity."""
    theme = bpy.context.preferences.themes[0]
    return OverlayColors((*theme.view_3d.object_active, 0.35), (*theme.view_3d.object_selected, 0.35),
                         (*theme.user_interface.gizmo_secondary, 0.22))


class PartTriangles:
    """The visible triangles of an object (VisibleSurface), in the order of its hierarchy's faces."""

    def __init__(self, surface: VisibleSurface, hierarchy: Hierarchy) -> None:
        self.hierarchy, self.positions = hierarchy, surface.positions
        has_face = surface.faces != NO_FACE
        triangles, faces = surface.triangles[has_face], surface.faces[has_face]
        # Group by face. Without modifiers, they are already sorted.
        by_face = np.arange(len(faces)) if (faces[1:] >= faces[:-1]).all() else np.argsort(faces, kind="stable")
        counts = np.bincount(faces, minlength=len(hierarchy.order))
        begin, counts = (np.cumsum(counts) - counts)[hierarchy.order], counts[hierarchy.order]
        self._start = np.concatenate([[0], np.cumsum(counts)])
        self.triangles = triangles[by_face[np.arange(len(faces)) + np.repeat(begin - self._start[:-1], counts)]]
        self._batches = {}
        self._neighbor_steps = layers.find_neighbor_triangles(self.triangles)

    def slice(self, node: int) -> tuple[int, int]:
        """Return (first, last) of a node's triangles."""
        return (int(self._start[self.hierarchy.first[node]]), int(self._start[self.hierarchy.last[node]]))

    def slice_batch(self, piece: tuple[int, int]) -> Drawable:
        def create() -> gpu.types.GPUBatch:
            return layers.create_batch(self._buffer, self.triangles[slice(*piece)])
        return layers.get_shader("flat"), self._cached(piece, create)

    def face_batch(self, name: Hashable, faces: np.ndarray) -> Drawable:
        """Return (shader, batch) of the triangles of any faces, cached under a name."""
        def create():
            return layers.create_batch(self._buffer, self.triangles[self._triangles_of(faces)])
        return layers.get_shader("flat"), self._cached(name, create)

    def outline_batch(self, node: int, faces: np.ndarray | None) -> Drawable | None:
        """Return (shader, batch) of the border of a node, or of these faces, as lines; None without a border."""
        def create():
            edges = self.border_edges(node, faces)
            return layers.create_line_batch(self.positions, edges) if len(edges) else None
        return self._cached(("outline", node, faces is None), create)

    def border_edges(self, node: int, faces: np.ndarray | None = None) -> np.ndarray:
        """Return the border edges (n, 2) of a node, or of these faces, by their vertices."""
        members = np.arange(*self.slice(node)) if faces is None else self._triangles_of(faces)
        return layers.find_border_edges(self.triangles, self.neighbors, members)

    @cached_property
    def neighbors(self) -> np.ndarray:
        """The neighbors of all triangles, (T, 3). The slowest step of the first outline, so it is prepared while hovering."""
        *_, result = self._neighbor_steps
        return result

    @property
    def is_complete(self) -> bool:
        """Whether the neighbors are computed."""
        return "neighbors" in vars(self)

    def prepare_next(self) -> None:
        """Run the next step of computing the neighbors."""
        result = None if self.is_complete else next(self._neighbor_steps)
        if result is not None:
            self.neighbors = result

    def _triangles_of(self, faces: np.ndarray) -> np.ndarray:
        is_member = arrays.make_mask(len(self.hierarchy.order), faces)
        return np.flatnonzero(np.repeat(is_member[self.hierarchy.order], np.diff(self._start)))

    def hull_batch(self, node: int) -> Drawable:
        def create():
            vertices, triangles = self.hierarchy.hull(node)
            return layers.create_batch(layers.create_vertex_buffer(pos=vertices), np.ascontiguousarray(triangles))
        return layers.get_shader("flat"), self._cached(node, create)

    def cut_batch(self, node: int) -> Drawable:
        """Return (shader, batch) of all triangles, colored by the parts of the dendrogram cut at the node's height."""
        return self.colored_batch(("cut", node), lambda: make_distinct_colors(self.hierarchy.face_labels(
            self.hierarchy.cut_height(self.hierarchy.height[node]))))

    def colored_batch(self, name: Hashable, paint: Callable[[], np.ndarray]) -> Drawable:
        """Return (shader, batch) of all triangles, cached under a name. paint(): color of each face, (F, 4)."""
        def create():
            corners = self.positions[self.triangles.ravel()]
            shades = np.repeat(paint()[self.hierarchy.order], 3 * np.diff(self._start), axis=0)
            return gpu.types.GPUBatch(type="TRIS", buf=layers.create_vertex_buffer(pos=corners, color=shades))
        return layers.get_shader("colored"), self._cached(name, create)

    @cached_property
    def _buffer(self) -> gpu.types.GPUVertBuf:
        return layers.create_vertex_buffer(pos=self.positions)

    def _cached(self, name: Hashable, create: Callable[[], object]) -> object:
        """Return the batch of this name, one of the last MAX_CACHED_BATCHES, because the user goes back and forth."""
        if name not in self._batches:
            while len(self._batches) >= MAX_CACHED_BATCHES:
                del self._batches[next(iter(self._batches))]
            self._batches[name] = create()
        return self._batches[name]


class ObjectTriangles:
    """All displayed triangles of a whole object. fits(object): whether they still are."""

    def __init__(self, positions: np.ndarray, triangles: np.ndarray, fits: Callable[[bpy.types.Object], bool]) -> None:
        self.positions, self.triangles, self.fits = positions, triangles, fits

    @cached_property
    def drawable(self) -> Drawable:
        buffer = layers.create_vertex_buffer(pos=self.positions)
        return layers.get_shader("flat"), layers.create_batch(buffer, self.triangles)

    @cached_property
    def wireframe(self) -> Drawable:
        """The edges as lines of constant width, so that triangles smaller than a pixel are visible."""
        return layers.create_line_batch(self.positions, np.unique(side_ends(self.triangles), axis=0))


def make_distinct_colors(labels: np.ndarray, opacity: float = CUT_OPACITY) -> np.ndarray:
    """Return a color (n, 4) float32 for each label, far from the colors of neighboring labels."""
    return np.column_stack([cut.colors(labels), np.broadcast_to(opacity, len(labels))]).astype(np.float32)


def draw_picked_part(context: bpy.types.Context, obj: bpy.types.Object, parts: PartTriangles, node: int, larger: int,
                     snapped: np.ndarray | None, selected: np.ndarray | None = None) -> None:
    """Draw the picked part, what the next notch adds, and what else the preferences show. snapped: the part's faces if
    its border is snapped, else None. selected: the faces to which the part is added, or None."""
    settings, drawn_layers, colors = preferences(), [], get_theme_colors()
    if settings.show_cut:
        drawn_layers.append(Layer(parts.cut_batch(node), colors.part))
    if settings.show_next:
        drawn_layers += _make_next_part_layers(parts, node, larger, snapped, selected, colors.next)
    if settings.show_part:
        drawn_layers += _make_part_layers(parts, node, colors.part, snapped)
    if settings.show_hull:
        drawn_layers.append(Layer(parts.hull_batch(node), GLASS, glass=True))
    layers.draw_layers(context, obj, drawn_layers)


def draw_whole_objects(context: bpy.types.Context, triangles: dict[str, ObjectTriangles], picked: frozenset,
                       larger: frozenset) -> None:
    """Draw the objects with the full names in picked like a picked part, and the rest of larger as what the next notch
    adds."""
    settings, colors = preferences(), get_theme_colors()
    names = (picked if settings.show_part else frozenset()) | (larger - picked if settings.show_next else frozenset())
    for name in names & triangles.keys():
        obj = find_object(name)
        if obj and is_visible(context, obj) and triangles[name].fits(obj):
            color = colors.part if name in picked else colors.next
            layers.draw_layers(context, obj, [Layer(triangles[name].drawable, color)])


def draw_triangles(context: bpy.types.Context, obj: bpy.types.Object, drawable: Drawable) -> None:
    """Draw triangles on an object like the picked part, or in colors of their own."""
    layers.draw_layers(context, obj, [Layer(drawable, get_theme_colors().part)])


def draw_object(context: bpy.types.Context, obj: bpy.types.Object, triangles: ObjectTriangles) -> None:
    """Draw these triangles of an object, and their edges."""
    color = get_theme_colors().part
    layers.draw_layers(context, obj, [Layer(triangles.drawable, color), *_make_line_layers(triangles.wireframe, color)])


def draw_hover(context: bpy.types.Context, obj: bpy.types.Object, parts: PartTriangles, node: int,
               snapped: np.ndarray | None) -> None:
    """Draw the part that a click would take."""
    layers.draw_layers(context, obj, _make_part_layers(parts, node, get_theme_colors().hover, snapped))


def _make_part_layers(parts: PartTriangles, node: int, color: tuple, snapped: np.ndarray | None) -> list[Layer]:
    """Return the layers of a part: tint and outline."""
    piece = parts.slice(node)
    if snapped is not None:
        tint = parts.face_batch(("snapped", node), snapped)
    else:
        tint = parts.slice_batch(piece) if piece[0] < piece[1] else None
    lines = parts.outline_batch(node, snapped)
    return [Layer(tint, color)] * bool(tint) + (_make_line_layers(lines, color) if lines else [])


def create_lines(ends: Sequence) -> Drawable | None:
    """Return (shader, batch) of lines between pairs of places; None without lines."""
    places = np.array(ends, np.float32).reshape(-1, 3)
    return layers.create_line_batch(places, np.arange(len(places)).reshape(-1, 2)) if len(places) else None


def draw_lines(context: bpy.types.Context, obj: bpy.types.Object, lines: Drawable) -> None:
    """Draw lines on an object, such as borders that the user has drawn."""
    layers.draw_layers(context, obj, _make_line_layers(lines, bpy.context.preferences.themes[0].user_interface.gizmo_primary))


def _make_line_layers(lines: Drawable, color: tuple) -> list[Layer]:
    """Return the layers of lines as wide as Blender's outlines."""
    pixel = bpy.context.preferences.system.pixel_size  # of this screen
    width = (0.5 + bpy.context.preferences.themes[0].view_3d.outline_width) * pixel
    return [Layer(lines, OUTLINE_CASING, width=width + 2 * pixel), Layer(lines, (*color[:3], 1.0), width=width)]


def _make_next_part_layers(parts: PartTriangles, node: int, larger: int, snapped: np.ndarray | None,
                           selected: np.ndarray | None, color: tuple) -> list[Layer]:
    if snapped is None and selected is None:
        (first, last), (begin, end) = parts.slice(node), parts.slice(larger)
        return [Layer(parts.slice_batch(piece), color) for piece in ((begin, first), (last, end)) if piece[0] < piece[1]]
    if node == larger:
        return []
    is_added = arrays.make_mask(len(parts.hierarchy.order), parts.hierarchy.faces(larger))
    is_added[parts.hierarchy.faces(node) if snapped is None else snapped] = False
    if selected is not None:
        is_added[selected] = False
    added = np.flatnonzero(is_added)
    return [Layer(parts.face_batch(("added", node, larger, hash(added.tobytes())), added), color)]


def is_visible(context: bpy.types.Context, obj: bpy.types.Object) -> bool:
    """Return whether this 3D view shows overlays and the object: not hidden, not outside its local view."""
    space = context.space_data
    return space.overlay.show_overlays and obj.visible_get(viewport=space)


def redraw_views() -> None:
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()
