# SPDX-License-Identifier: GPL-3.0-or-later
"""What an artist has marked on a Blender mesh, as Marks for a build: the kinds that the preferences say.

How Blender's versions store marks is known here only."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import NamedTuple

import bpy
import numpy as np
from mathutils import Matrix

from partwheel.appearance import mean_by_opacity, sample_places, sample_texels, to_linear
from partwheel.marks import Marks, find_face_pairs, marks_of_colors, marks_of_labels, mean_over_faces
from partwheel.triangles import triangle_areas
from ..preferences import MARK_ITEMS, preferences
from .elements import read, read_attribute, read_edge_vertices, read_positions

FACE_SET, CREASE = ".sculpt_face_set", "crease_edge"
DRAWN_BORDER = "partwheel_border"  # 1 on the edges of borders drawn with the tool, see pick/draw_border.py
COLOR_SOCKETS = "Base Color", "Color"  # of shaders
FIRST_TILE = 1001  # number of the UDIM tile of texture coordinates from 0 to 1; there are ten in a row
EDGE_STRENGTH = 0.8  # of seams, sharp edges and full creases, which may have other purposes than to divide


class BaseColor(NamedTuple):
    """What a material says about color."""

    factor: tuple[float, ...] = (1.0,) * 4  # linear RGBA
    image: bpy.types.Image | None = None
    uv_map: str = ""  # the name of its UV map; "": the one that is rendered
    transform: tuple[tuple[float, ...], ...] = ((1, 0, 0), (0, 1, 0))  # rows (u, v, offset) of what Mapping nodes do to UVs


def collect_marks(obj: bpy.types.Object, surface: tuple) -> list[Marks]:
    """Return the marks in use on the object's mesh, which is up to date. surface: its arrays.MeshSurface."""
    values = _read_values(obj.data, obj)
    if not values:
        return []
    pairs, edges = find_face_pairs(*surface[:3]), read_edge_vertices(obj.data)
    marks = []
    for kind, array in values.items():
        name = NAMES[kind]
        if kind == "COLORS":
            with readable_mesh(obj.data, obj) as mesh:
                marks.append(marks_of_colors(pairs, *_read_face_colors(mesh), name))
        elif kind in LABELS:
            marks.append(marks_of_labels(pairs, array, name))
        else:
            marks.append(Marks(name, edges[array > 0], (array[array > 0] * EDGE_STRENGTH).astype(np.float32),
                               chosen=kind == "DRAWN"))
        if kind in preferences().hard_marks:
            marks[-1] = marks[-1]._replace(strengths=None)
    return [kind for kind in marks if np.size(kind.edges)]


def describe_marks(mesh: bpy.types.Mesh, obj: bpy.types.Object | None = None) -> bytes:
    """Return bytes that differ if the marks in use do; b"" without any. obj: an object with the mesh, if it is in Edit
    Mode. Of textures only the names count: reading them takes too long."""
    values = _read_values(mesh, obj)
    hard = preferences().hard_marks
    return b"".join(b"%d %s " % (kind in hard, kind.encode()) + array.tobytes() for kind, array in values.items())


def list_settings() -> tuple:
    """Return the preferences that say what counts."""
    return frozenset(preferences().use_marks), frozenset(preferences().hard_marks)


# ---- Values of elements


def read_materials(mesh: bpy.types.Mesh, materials: Sequence[bpy.types.Material | None] | None = None) -> np.ndarray:
    """Return the slot of each face, (F,): the first of those with the same material. materials: of the slots; None: the mesh's."""
    materials = list(mesh.materials if materials is None else materials)
    first = np.array([materials.index(material) for material in materials] or [0], np.int32)
    return first[read(mesh.polygons, "material_index", np.int32).clip(0, len(first) - 1)]


def _read_creases(mesh: bpy.types.Mesh) -> np.ndarray | None:
    if bpy.app.version < (4, 0, 0):
        return read(mesh.edges, "crease", np.float32) if mesh.has_crease_edge else None
    return read_attribute(mesh, CREASE, "FLOAT", "EDGE")


def _read_colors(mesh: bpy.types.Mesh) -> np.ndarray | None:
    """Return what the colors of faces depend on; None if they are all equal."""
    used = np.unique(read_materials(mesh)).tolist()
    sources = [_find_base_color(mesh, slot) for slot in used]
    painted = _read_painted_colors(mesh)
    is_painted = painted is not None and len(painted) > 0 and (painted != painted[0]).any()
    if not is_painted and len(set(sources)) < 2 and not any(source.image for source in sources):
        return None
    text = repr([(slot, source.factor, source.image and source.image.name_full, *source[2:])
                 for slot, source in zip(used, sources)])
    return np.frombuffer(text.encode() + (painted.tobytes() if is_painted else b""), np.uint8)


NAMES = {kind: label.lower() for kind, label, _ in MARK_ITEMS}
LABELS = "MATERIALS", "FACE_SETS"
READERS: dict[str, Callable[[bpy.types.Mesh], np.ndarray | None]] = {
    "MATERIALS": read_materials,
    "COLORS": _read_colors,
    "FACE_SETS": lambda mesh: read_attribute(mesh, FACE_SET, "INT", "FACE"),
    "SEAMS": lambda mesh: read(mesh.edges, "use_seam", bool),
    "SHARP": lambda mesh: read(mesh.edges, "use_edge_sharp", bool),
    "CREASES": _read_creases,
    "DRAWN": lambda mesh: read_attribute(mesh, DRAWN_BORDER, "INT", "EDGE"),
}


def _read_values(mesh: bpy.types.Mesh, obj: bpy.types.Object | None) -> dict[str, np.ndarray]:
    """Return by kind in use what the marks depend on: a value per face or edge. Kinds without marks are left out."""
    use = preferences().use_marks
    # In Edit Mode the values of attributes can only be read from a copy.
    needs_copy = mesh.is_editmode and any(kind in use and has for kind, has in (
        ("FACE_SETS", FACE_SET in mesh.attributes), ("CREASES", CREASE in mesh.attributes),
        ("DRAWN", DRAWN_BORDER in mesh.attributes), ("COLORS", len(mesh.color_attributes) > 0)))
    with readable_mesh(mesh, obj if needs_copy else None) as readable:
        values = {kind: reader(readable) for kind, reader in READERS.items() if kind in use}
    return {kind: array for kind, array in values.items()
            if array is not None and len(array) and (kind == "COLORS" or (array != array[0]).any())}


@contextmanager
def readable_mesh(mesh: bpy.types.Mesh, obj: bpy.types.Object | None) -> Iterator[bpy.types.Mesh]:
    """Yield a mesh with readable attributes: in Edit Mode, if the object is given, a temporary copy."""
    if not obj or not mesh.is_editmode:
        yield mesh
        return
    try:
        yield obj.to_mesh(preserve_all_data_layers=True)
    finally:
        obj.to_mesh_clear()


# ---- Colors


def _find_base_color(mesh: bpy.types.Mesh, slot: int) -> BaseColor:
    """Return the color of the first shader of a material: its value, or the first image that it comes from."""
    material = mesh.materials[slot] if slot < len(mesh.materials) else None
    if not material or not material.node_tree:
        return BaseColor(tuple(material.diffuse_color)) if material else BaseColor()
    outputs = [node for node in material.node_tree.nodes if node.type == "OUTPUT_MATERIAL" and node.is_active_output]
    nodes = [node for output in outputs for node in _upstream_nodes(output.inputs["Surface"])]
    socket = next((node.inputs[name] for node in nodes for name in COLOR_SOCKETS if name in node.inputs), None)
    if not socket:
        return BaseColor()
    if not socket.is_linked:
        return BaseColor(tuple(socket.default_value))
    image = next((node for node in _upstream_nodes(socket) if node.type == "TEX_IMAGE" and node.image), None)
    if not image:
        return BaseColor()
    nodes = [*_upstream_nodes(image.inputs["Vector"])]
    matrix = Matrix()
    for node in nodes:
        if node.type == "MAPPING":
            matrix = matrix @ _find_mapping(node)
    return BaseColor(image=image.image, uv_map=next((node.uv_map for node in nodes if node.type == "UVMAP"), ""),
                     transform=tuple((row[0], row[1], row[3]) for row in matrix[:2]))


def _find_mapping(node: bpy.types.ShaderNodeMapping) -> Matrix:
    """Return what a Mapping node does to UVs. Of kind NORMAL, which maps directions: nothing."""
    rotation, scale = (node.inputs[name].default_value for name in ("Rotation", "Scale"))
    location = node.inputs["Location"].default_value if node.vector_type in {"POINT", "TEXTURE"} else None
    matrix = Matrix.LocRotScale(location, rotation, scale)
    return {"POINT": matrix, "VECTOR": matrix, "TEXTURE": matrix.inverted_safe()}.get(node.vector_type, Matrix())


def _upstream_nodes(socket: bpy.types.NodeSocket) -> Iterator[bpy.types.Node]:
    """Yield the nodes that a socket depends on, the nearest first."""
    sockets, names = [socket], set()
    for current in sockets:
        for link in current.links:
            if link.from_node.name not in names:
                names.add(link.from_node.name)
                sockets.extend(link.from_node.inputs)
                yield link.from_node


def _read_painted_colors(mesh: bpy.types.Mesh) -> np.ndarray | None:
    """Return the active color attribute, linear RGBA of each vertex or corner; None if there is none."""
    attribute = mesh.color_attributes.active_color
    return read(attribute.data, "color", np.float32, 4) if attribute else None


def _read_face_colors(mesh: bpy.types.Mesh) -> tuple[np.ndarray, np.ndarray]:
    """Return (mean linear RGBA of each polygon (F, 4), areas (F,)), of the material and the color attribute."""
    mesh.calc_loop_triangles()
    loops, faces = read(mesh.loop_triangles, "loops", np.int32, 3), read(mesh.loop_triangles, "polygon_index", np.int32)
    vertices = read(mesh.loop_triangles, "vertices", np.int32, 3)
    places = sample_places(len(loops))
    colors = np.ones((len(loops), len(places), 4))
    painted = _read_painted_colors(mesh)
    if painted is not None:
        corners = loops if len(painted) == len(mesh.loops) else vertices
        colors *= painted[corners].mean(axis=1, keepdims=True)
    slots = read_materials(mesh)[faces]
    for slot in np.unique(slots).tolist():
        triangles, source = np.flatnonzero(slots == slot), _find_base_color(mesh, slot)
        colors[triangles] *= source.factor
        layer = mesh.uv_layers.get(source.uv_map) or next((uv for uv in mesh.uv_layers if uv.active_render), None)
        if source.image and layer:
            (*rows, offset), uvs = np.transpose(source.transform), read(layer.data, "uv", np.float32, 2)[loops[triangles]]
            coordinates = uvs @ rows + offset
            colors[triangles] *= _sample_image(source.image, places @ coordinates)
    areas = triangle_areas(read_positions(mesh).astype(float)[vertices])
    return mean_over_faces(mean_by_opacity(colors), areas, faces)


def _sample_image(image: bpy.types.Image, coordinates: np.ndarray) -> np.ndarray:
    """Return linear RGBA (..., 4) at texture coordinates (..., 2); white where the image can't be read."""
    if image.source != "TILED":
        return _sample_picture(image, coordinates)
    colors = np.ones((*coordinates.shape[:-1], 4))
    column, row = np.moveaxis(np.floor(coordinates), -1, 0)
    numbers = np.where((column >= 0) & (column < 10) & (row >= 0), FIRST_TILE + column + 10 * row, 0)
    for number in (tile.number for tile in image.tiles):
        if (is_in_tile := numbers == number).any():
            with _open_tile(image, number) as picture:
                colors[is_in_tile] = _sample_picture(picture, coordinates[is_in_tile])
    return colors


@contextmanager
def _open_tile(image: bpy.types.Image, number: int) -> Iterator[bpy.types.Image]:
    """Yield an image with the texels of a tile: Python can read only the first one of an image with several."""
    if number == image.tiles[0].number:
        yield image
        return
    data = next((file.packed_file.data for file in image.packed_files if file.tile_number == number), None)
    picture = bpy.data.images.new("partwheel", 1, 1)
    try:
        if data is None:
            path = bpy.path.abspath(image.filepath_raw, library=image.library)
            row, column = divmod(number - FIRST_TILE, 10)
            picture.filepath_raw = path.replace("<UDIM>", str(number)).replace("<UVTILE>", f"u{column + 1}_v{row + 1}")
        else:
            picture.pack(data=data, data_len=len(data))
        picture.source = "FILE"
        picture.colorspace_settings.name = image.colorspace_settings.name
        yield picture
    finally:
        bpy.data.images.remove(picture)


def _sample_picture(image: bpy.types.Image, coordinates: np.ndarray) -> np.ndarray:
    """As _sample_image(), of an image that is one picture, which repeats."""
    width, height = image.size
    if not width * height:
        return np.ones((*coordinates.shape[:-1], 4))
    texels = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(texels)
    samples = sample_texels(texels.reshape(height, width, image.channels), coordinates).astype(np.float64)
    color = np.repeat(samples[..., :1], 3, axis=-1) if image.channels < 3 else samples[..., :3]
    opacity = samples[..., 3:] if image.channels == 4 else np.ones((*coordinates.shape[:-1], 1))
    if not image.is_float and image.colorspace_settings.name == "sRGB":
        color = to_linear(color)
    return np.concatenate([color, opacity], axis=-1)
