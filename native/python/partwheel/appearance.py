# SPDX-License-Identifier: GPL-3.0-or-later
"""How a surface looks: materials, textures, and attributes of the corners of its triangles, in the terms of glTF 2.0."""

from __future__ import annotations

import io
from typing import Any, Callable, Dict, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from .library import Error
from .requirements import load_module
from .triangles import doubled_area_vectors, unit_vectors

CAP_COLOR = [0.6, 0.6, 0.6, 1.0]  # linear
CAP_MATERIAL: Dict[str, Any] = {"name": "Partwheel Cap", "pbrMetallicRoughness": {
    "baseColorFactor": CAP_COLOR, "metallicFactor": 0.0, "roughnessFactor": 0.8}}
WEIGHT_STEP = 2.0 ** -30  # barycentric coordinates are rounded to it, so that equal corners have equal attributes
SAMPLE_COUNT = 500_000  # about this many color samples in all triangles together, see sample_places()
MEAN_TEXTURE_SIZE = 1024  # texels along an image's shorter side for mean colors: larger images are read smaller
SAMPLE_INSET = 0.25  # samples of corners move this far toward the triangle's center, away from texels of neighbors


class TextureError(Error):
    """An image of a model can't be decoded; str() says which one."""

    name = "texture"


class Image(NamedTuple):
    """An image as it is in its file."""

    name: str  # of the file, with its ending
    data: bytes  # the file's bytes

    @property
    def mime_type(self) -> str:
        """"image/png" and the like, from the first bytes; empty for a format that is not part of glTF."""
        starts = {b"\x89PNG": "png", b"\xff\xd8\xff": "jpeg", b"RIFF": "webp", b"\xabKTX": "ktx2", b"DDS ": "vnd-ms.dds"}
        return next((f"image/{kind}" for start, kind in starts.items() if self.data.startswith(start)), "")


class Appearance(NamedTuple):
    """How a surface with T triangles looks."""

    # glTF's name -> (T, 3, k) float of each corner: TEXCOORD_0 (k = 2, v points down), COLOR_0 (RGBA, linear), NORMAL, ...
    attributes: Dict[str, np.ndarray]
    face_materials: np.ndarray  # (T,) int, index into materials; -1: none
    # materials, textures, samplers: JSON objects of glTF; a texture's source is an index into images
    materials: Sequence[Dict[str, Any]] = ()
    textures: Sequence[Dict[str, Any]] = ()
    samplers: Sequence[Dict[str, Any]] = ()
    images: Sequence[Image] = ()
    mtl: Sequence[str] = ()  # for each material its lines in an OBJ's material file; () if the model is from another format

    @property
    def kinds(self) -> Tuple[str, ...]:
        """The kinds of contents.KINDS that it has."""
        has = {"texture coordinates": any(name.startswith("TEXCOORD") for name in self.attributes), "textures": self.images,
               "materials": self.materials, "colors": "COLOR_0" in self.attributes}
        return tuple(kind for kind, value in has.items() if value)

    def transfer(self, source: np.ndarray, corners: np.ndarray, triangles: np.ndarray) -> Appearance:
        """The appearance of m triangles that were cut from this surface. Caps get CAP_MATERIAL, or CAP_COLOR if the surface
        has no materials.

        source : (T, 3, 3) corners of this surface's triangles
        corners : (m, 3, 3) of the new triangles
        triangles : (m,) for each new triangle the one of this surface that contains it or is nearest to it; -1: a cap
        """
        is_cap = triangles < 0
        weights = barycentric(source[triangles], corners)
        attributes = {name: np.einsum("tck,tka->tca", weights, values[triangles]) for name, values in self.attributes.items()}
        for name, values in attributes.items():
            if name == "NORMAL":
                values[:] = unit_vectors(values)
            values[is_cap] = default_attribute(name, corners[is_cap])
        if not self.materials:  # nothing but colors
            if "COLOR_0" in attributes:
                attributes["COLOR_0"][is_cap] = CAP_COLOR
            return self._replace(attributes=attributes, face_materials=np.full(len(triangles), -1))
        materials = np.where(is_cap, len(self.materials), self.face_materials[triangles])
        return self._replace(attributes=attributes, face_materials=materials, materials=[*self.materials, CAP_MATERIAL],
                             mtl=[*self.mtl, *describe_mtl([CAP_MATERIAL], [], [])] if self.mtl else ())

    def base_color(self, material: int) -> Optional[np.ndarray]:
        """(4,) linear RGBA of a material, without its texture; None if there is no such material."""
        return np.array(self._surface(material).get("baseColorFactor", [1.0] * 4)) if 0 <= material < len(self.materials) else None

    def base_image(self, material: int) -> Optional[int]:
        """The index of the image with a material's base color, or None."""
        info = self._surface(material).get("baseColorTexture")
        return find_source(self.textures[info["index"]]) if info else None

    def base_coordinates(self, material: int, faces: np.ndarray) -> Optional[np.ndarray]:
        """(n, 3, 2) where the corners of triangles (n,) are in the texture of a material's base color, which selects the texture
        coordinates, and may transform them (KHR_texture_transform). None if there are none."""
        info = self._surface(material).get("baseColorTexture", {})
        transform = info.get("extensions", {}).get("KHR_texture_transform", {})
        coordinates = self.attributes.get(f"TEXCOORD_{transform.get('texCoord', info.get('texCoord', 0))}")
        if coordinates is None:
            return None
        if not transform:
            return coordinates[faces]
        cosine, sine = np.cos(transform.get("rotation", 0)), np.sin(transform.get("rotation", 0))
        scaled = coordinates[faces] * transform.get("scale", [1, 1])
        return scaled @ [[cosine, -sine], [sine, cosine]] + transform.get("offset", [0, 0])

    def plain_coordinates(self) -> Optional[np.ndarray]:
        """(T, 3, 2) base_coordinates() of each triangle's material, for formats that have one set of them; None if there are none."""
        if not any(name.startswith("TEXCOORD") for name in self.attributes):
            return None
        result = np.zeros((len(self.face_materials), 3, 2))
        for material in np.unique(self.face_materials).tolist():
            faces = np.flatnonzero(self.face_materials == material)
            coordinates = self.base_coordinates(material, faces)
            result[faces] = 0 if coordinates is None else coordinates
        return result

    def _surface(self, material: int) -> Dict[str, Any]:
        return self.materials[material].get("pbrMetallicRoughness", {}) if 0 <= material < len(self.materials) else {}

    def base_colors(self) -> np.ndarray:
        """(T, 3, 4) linear RGBA of each corner: base color times texture times color. Needs the package for images if there
        are textures. Raises RequirementError."""
        return self._multiply_colors(self.attributes.get("COLOR_0", np.ones((1, 1, 4))), lambda coordinates: (
            coordinates * (1 - SAMPLE_INSET) + SAMPLE_INSET * coordinates.mean(axis=1, keepdims=True)), 3)

    def mean_colors(self) -> np.ndarray:
        """(T, 4) the mean linear RGBA of each triangle: base color times texture times color, by opacity. Needs the package
        for images if there are textures. Raises RequirementError."""
        places = sample_places(len(self.face_materials))
        colors = self.attributes.get("COLOR_0", np.ones((1, 3, 4))).mean(axis=1, keepdims=True)
        return mean_by_opacity(self._multiply_colors(colors, lambda coordinates: places @ coordinates,
                                                     len(places), MEAN_TEXTURE_SIZE))

    def _multiply_colors(self, colors: np.ndarray, sample: Callable[[np.ndarray], np.ndarray], count: int,
                         texture_size: int = 0) -> np.ndarray:
        """(T, n, 4) colors (T or 1, n or 1, 4) times base colors and textures at n = count places in each triangle.

        sample : the texture coordinates (m, n, 2) of the places, from those of the corners (m, 3, 2)
        texture_size : see read_texels()
        """
        factors = np.array([*map(self.base_color, range(len(self.materials))), [1.0] * 4])
        result = np.repeat(factors[self.face_materials][:, None], count, axis=1) * colors
        for number in range(len(self.materials)):
            image = self.base_image(number)
            if image is None:
                continue
            faces = np.flatnonzero(self.face_materials == number)
            coordinates = self.base_coordinates(number, faces)
            if coordinates is not None and len(faces):
                texels = read_texels(self.images[image], texture_size)
                result[faces] *= from_bytes(sample_texels(texels, sample(coordinates)))
        return result


def find_source(texture: Dict[str, Any]) -> Optional[int]:
    """The index of a texture's image; None if it is in a format of an extension that isn't read."""
    return texture.get("source", texture.get("extensions", {}).get("EXT_texture_webp", {}).get("source"))


def barycentric(triangles: np.ndarray, points: np.ndarray) -> np.ndarray:
    """(m, n, 3) barycentric coordinates of points (m, n, 3), n for each triangle (m, 3, 3), after projection to its plane.
    Those outside the triangle are clamped."""
    origin, sides = triangles[:, :1], triangles[:, 1:] - triangles[:, :1]
    gram = np.einsum("tik,tjk->tij", sides, sides)
    right = np.einsum("tik,tpk->tpi", sides, points - origin)
    determinant = (gram[:, 0, 0] * gram[:, 1, 1] - gram[:, 0, 1] ** 2)[:, None]
    determinant = np.where(determinant > 0, determinant, np.inf)  # flat triangles: the first corner
    v = (gram[:, 1, 1, None] * right[..., 0] - gram[:, 0, 1, None] * right[..., 1]) / determinant
    w = (gram[:, 0, 0, None] * right[..., 1] - gram[:, 0, 1, None] * right[..., 0]) / determinant
    weights = np.clip(np.stack([1 - v - w, v, w], axis=-1), 0, 1)
    return np.round(weights / weights.sum(axis=-1, keepdims=True) / WEIGHT_STEP) * WEIGHT_STEP


def default_attribute(name: str, corners: np.ndarray) -> np.ndarray:
    """(m, 3, k) an attribute of triangles (m, 3, 3) that have none: the normal, white, or the origin of the texture."""
    if name == "NORMAL":
        return np.repeat(unit_vectors(doubled_area_vectors(corners))[:, None], 3, axis=1)
    return np.ones((len(corners), 3, 4)) if name.startswith("COLOR") else np.zeros((len(corners), 3, 2))


def to_linear(srgb: np.ndarray) -> np.ndarray:
    """Linear colors of sRGB colors, 0 to 1 each."""
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def to_srgb(linear: np.ndarray) -> np.ndarray:
    """sRGB colors of linear colors, 0 to 1 each."""
    linear = np.clip(linear, 0, 1)
    return np.where(linear <= 0.0031308, linear * 12.92, 1.055 * linear ** (1 / 2.4) - 0.055)


def to_bytes(linear: np.ndarray) -> np.ndarray:
    """(..., 4) uint8 sRGB and alpha of linear colors (..., 4)."""
    return np.round(np.concatenate([to_srgb(linear[..., :3]), np.clip(linear[..., 3:], 0, 1)], axis=-1) * 255).astype(np.uint8)


def from_bytes(colors: np.ndarray) -> np.ndarray:
    """(..., 4) linear colors of sRGB with or without alpha, from 0 to 255 (..., 3 or 4)."""
    colors = np.asarray(colors)
    if colors.dtype == np.uint8:  # a table is faster
        table = from_bytes(np.repeat(np.arange(256.0)[:, None], 4, axis=1))
        opaque = np.full((*colors.shape[:-1], 1), 255, np.uint8)
        return table[np.concatenate([colors, opaque][:5 - colors.shape[-1]], axis=-1), [0, 0, 0, 3]]
    values = colors.astype(np.float64) / 255
    alpha = values[..., 3:] if values.shape[-1] == 4 else np.ones((*values.shape[:-1], 1))
    return np.concatenate([to_linear(values[..., :3]), alpha], axis=-1)


def read_texels(image: Image, size: int) -> np.ndarray:
    """(h, w, 4) uint8 sRGB and alpha of an image, the top row first. Raises RequirementError, TextureError.

    size : a larger image may be read at a lower resolution, but at least this one; 0: its own
    """
    def decode(opened: Any) -> np.ndarray:
        if size:
            opened.draft("RGB", (size, size))  # decodes JPEG files faster
            step = max(min(opened.size) // size, 1)
            opened = opened.resize((opened.width // step, opened.height // step), resample=0)  # the nearest texel
        return np.asarray(opened.convert("RGBA"))

    return _decode(image, "Turning textures into colors", decode)


def sample_texels(texels: np.ndarray, coordinates: np.ndarray) -> np.ndarray:
    """(..., k) the texels (h, w, k) at texture coordinates (..., 2), repeated in all directions; the second coordinate grows
    with the rows."""
    size = np.array(texels.shape[1::-1])
    column, row = np.moveaxis(np.floor(coordinates % 1.0 * size).astype(int) % size, -1, 0)
    return texels[row, column]


def sample_places(triangle_count: int) -> np.ndarray:
    """(n, 3) barycentric coordinates of evenly distributed places in a triangle: the centers of n = 4, 9, ... or 64 equal
    parts, so many that all triangles together have about SAMPLE_COUNT."""
    side = int(np.clip((SAMPLE_COUNT / max(triangle_count, 1)) ** 0.5, 2, 8))
    upright = [(i, j) for i in range(side) for j in range(side - i)]
    upside_down = [(i, j) for i in range(side - 1) for j in range(side - 1 - i)]
    v, w = np.concatenate([np.add(upright, 1 / 3), np.add(upside_down, 2 / 3)]).T / side
    return np.column_stack([1 - v - w, v, w])


def mean_by_opacity(colors: np.ndarray) -> np.ndarray:
    """(T, 4) the mean of n colors each (T, n, 4). What is transparent counts little, so that its color hardly matters."""
    opacity = np.maximum(colors[..., 3:], 1e-3)
    return np.concatenate([(colors[..., :3] * opacity).sum(axis=1) / opacity.sum(axis=1), colors[..., 3].mean(axis=1)[:, None]],
                          axis=1)


def to_png(image: Image) -> Image:
    """The same image as a PNG file. Raises RequirementError, TextureError."""
    data = io.BytesIO()
    _decode(image, f"Converting {image.name} to PNG", lambda opened: opened.save(data, "PNG"))
    return Image(f"{image.name.rsplit('.', 1)[0]}.png", data.getvalue())


def _decode(image: Image, use: str, decode: Callable[[Any], Any]) -> Any:
    """What decode() returns for the image as Pillow opens it. use : see load_module()"""
    pil: Any = load_module("PIL.Image", use)
    try:
        return decode(pil.open(io.BytesIO(image.data)))
    except Exception as error:  # Pillow's readers raise many types
        raise TextureError(f"The texture {image.name} can't be decoded. Save it as PNG again. ({error})") from error


def describe_mtl(materials: Sequence[Dict[str, Any]], textures: Sequence[Dict[str, Any]], images: Sequence[Image]) -> List[str]:
    """The lines of each material in an OBJ's material file, without its name."""
    result = []
    for material in materials:
        surface = material.get("pbrMetallicRoughness", {})
        color = surface.get("baseColorFactor", [1.0] * 4)
        lines = ["Kd {} {} {}".format(*color[:3]), f"d {color[3]}", f"Pr {surface.get('roughnessFactor', 1.0)}",
                 f"Pm {surface.get('metallicFactor', 1.0)}"]
        if "emissiveFactor" in material:
            lines.append("Ke {} {} {}".format(*material["emissiveFactor"]))
        for word, info in (("map_Kd", surface.get("baseColorTexture")), ("map_Ke", material.get("emissiveTexture")),
                           ("norm", material.get("normalTexture"))):
            source = find_source(textures[info["index"]]) if info else None
            if source is not None:
                lines.append(f"{word} {images[source].name}")
        result.append("\n".join(lines))
    return result
