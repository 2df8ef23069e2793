# SPDX-License-Identifier: GPL-3.0-or-later
"""A GLB file in which any one value is wrong is read, or refused with one clean error that says what to do."""

import copy
import json
import re
import struct
import warnings

import pytest
from partwheel import gltf, meshes, threemf, wavefront
from partwheel.library import Error
from test_appearance import write_textured

MISSING = object()
WRONG = [MISSING, None, "x", -1, 10 ** 9, 1.5, [], {}, [None], float("inf")]  # types, and numbers out of range


@pytest.fixture(scope="module")
def model(tmp_path_factory):
    """(JSON, binary chunk) of a valid file."""
    path = tmp_path_factory.mktemp("valid") / "model.glb"
    write_textured(path)
    data = path.read_bytes()
    size = int.from_bytes(data[12:16], "little")
    tree = json.loads(data[20:20 + size])
    tree["materials"][0].update(emissiveFactor=[1, 1, 0], emissiveTexture={"index": 1, "texCoord": 0}, normalTexture={
        "index": 0, "extensions": {"KHR_texture_transform": {"offset": [0.5, 0.5], "rotation": 1.5, "scale": [2, 1], "texCoord": 0}}})
    tree["textures"][1] = {"extensions": {"EXT_texture_webp": tree["textures"][1]}}
    return tree, data[20 + size:]


def write(path, tree, rest):
    text = json.dumps(tree).encode()
    text += b" " * (-len(text) % 4)
    path.write_bytes(struct.pack("<4s3I4s", b"glTF", 2, 20 + len(text) + len(rest), len(text), b"JSON") + text + rest)
    return path


def places(value, place=()):
    """The keys that lead to each value inside."""
    for key in value if isinstance(value, dict) else range(len(value)) if isinstance(value, list) else ():
        yield (*place, key)
        yield from places(value[key], (*place, key))


def with_wrong(tree, place, wrong):
    """A copy in which one value is another one, or missing."""
    tree = copy.deepcopy(tree)
    *outer, last = place
    inside = tree
    for key in outer:
        inside = inside[key]
    if wrong is MISSING:
        del inside[last]
    else:
        inside[last] = wrong
    return tree


def read_and_write(path):
    """Uses all that is read of a file's appearance."""
    mesh = meshes.read(path)
    if mesh.appearance is not None:
        nodes = [gltf.Node("whole", -1, mesh.vertices, mesh.triangles, mesh.appearance)]
        gltf.write_glb(nodes)
        threemf.write_3mf(nodes)
        wavefront.write_obj("whole", nodes)
        mesh.appearance.mean_colors()
    return mesh


def test_a_wrong_value_is_no_traceback(model, tmp_path):
    tree, rest = model
    assert read_and_write(write(tmp_path / "model.glb", tree, rest)).appearance.images
    refused = 0
    for number, place in enumerate(places(tree)):
        for wrong in WRONG[number % 5::5]:
            path = write(tmp_path / "model.glb", with_wrong(tree, place, wrong), rest)
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                try:
                    read_and_write(path)
                except Error as error:
                    refused += 1
                    assert re.search("model.glb|The texture|Vertex", str(error)), (place, wrong)
                except Exception as error:
                    raise AssertionError(f"{wrong!r} at {place}") from error
    assert refused > 100


@pytest.mark.parametrize("place, wrong, message", [
    (("materials", 1, "pbrMetallicRoughness", "baseColorFactor"), [1, 0, 0],
     "materials[1].pbrMetallicRoughness.baseColorFactor is not 4 numbers. Correct it"),
    (("materials", 1, "pbrMetallicRoughness"), [], "materials[1].pbrMetallicRoughness is not an object. Correct it"),
    (("materials", 0, "normalTexture", "index"), 2, "materials[0].normalTexture.index is not one of the file's textures. Correct it"),
    (("meshes",), {}, "it is glTF 1.0. Convert it"),
    (("extensionsRequired",), ["KHR_draco_mesh_compression"], "it is compressed (KHR_draco_mesh_compression). Export it without"),
    (("nodes", 1, "translation", 0), float("inf"), "has a coordinate that is not a number, or is too large. Delete or"),
    (("accessors", 0, "count"), 10 ** 9, "Export it again"),
    (("images", 0, "bufferView"), 0, "can't be decoded. Save it as PNG again"),
])
def test_the_error_says_what_is_wrong(place, wrong, message, model, tmp_path):
    tree, rest = model
    tree = {"extensionsRequired": [], **tree}
    with warnings.catch_warnings(), pytest.raises(Error) as caught:
        warnings.simplefilter("error")
        read_and_write(write(tmp_path / "model.glb", with_wrong(tree, place, wrong), rest))
    assert message in str(caught.value)


def test_null_counts_as_missing(model, tmp_path):
    tree, rest = model
    tree = with_wrong(with_wrong(tree, ("materials", 0, "name"), None), ("nodes", 0, "name"), None)
    assert read_and_write(write(tmp_path / "model.glb", tree, rest)).node_names.count("m") == 1


def test_the_error_names_a_missing_file(model, tmp_path):
    tree, _ = model
    path = tmp_path / "model.gltf"
    path.write_text(json.dumps({**tree, "buffers": [{"uri": "model.bin", "byteLength": tree["buffers"][0]["byteLength"]}]}))
    with pytest.raises(Error, match="needs the file .*model.bin, which is missing. Put it"):
        meshes.read(path)
