# SPDX-License-Identifier: GPL-3.0-or-later
"""partwheel batch, as the checkout has it or PARTWHEEL_PACKAGES; models that are small, and hostile ones."""

import json
import os
import signal
import struct
import subprocess
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
HAND = ROOT / "build" / "deps" / "meshes" / "hand.off"
PACKAGES = os.environ.get("PARTWHEEL_PACKAGES", str(ROOT / "native" / "python"))
sys.path[:0] = [PACKAGES, str(Path(__file__).parent)]

# A shell lets what it starts in its background ignore Ctrl C, which tests send.
signal.signal(signal.SIGINT, signal.default_int_handler)


def command(*arguments):
    return [sys.executable, "-m", "partwheel", "batch", *map(str, arguments)]


def environment(**changes):
    return {**os.environ, "PYTHONPATH": PACKAGES, **changes}


def run(*arguments, code=0, **options):
    """The totals of a run in a process of its own, which ends with that exit code; None: whether some failed or not."""
    result = subprocess.run([*command(*arguments), "--json"], capture_output=True, text=True, env=environment(**options))
    assert result.returncode in ([0, 1] if code is None else [code]), result.stderr
    return json.loads(result.stdout) if result.stdout else result.stderr


def reports(folder):
    """{path: its model.json}, of all files that were read."""
    from partwheel.batch.store import Store
    store = Store(folder)
    return {path: store.report(key) for path, key in store.inputs().items()}


def results(folder):
    """{path below models/: bytes} of all results; in model.json without what was measured."""
    results = {}
    for path in sorted((folder / "models").rglob("*")):
        if path.is_file():
            data = path.read_bytes()
            if path.name == "model.json":
                report = json.loads(data)
                for measured in ("seconds", "processor_seconds"):
                    report.pop(measured, None)
                data = json.dumps(report).encode()
            results[path.relative_to(folder).as_posix()] = data
    return results


def box(path, sizes):
    """An OFF file of a box."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]) * sizes
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    path.write_text("OFF\n8 6 0\n" + "".join("{} {} {}\n".format(*corner) for corner in corners.tolist()) +
                    "".join("4 {} {} {} {}\n".format(*face) for face in faces))
    return path


@pytest.fixture
def boxes(tmp_path):
    """A folder of 12 boxes, no two alike."""
    folder = tmp_path / "boxes"
    folder.mkdir()
    for number in range(12):
        box(folder / f"box{number:02}.off", [1, 1 + number, 2])
    return folder


def hostile(folder):
    """{path: the name of its failure}: what a library of a million files has in it as well."""
    expected = {}

    def write_file(name, data, failure):
        (folder / name).write_bytes(data)
        expected[str(folder / name)] = failure

    write_file("empty.off", b"", "mesh file")
    write_file("empty.stl", b"", "mesh file")
    write_file("text.obj", b"no mesh at all\n" * 9, "mesh file")
    write_file("ten_million.off", b"OFF\n5000000 10000000 0\n0 0 0\n", "mesh file")
    write_file("header.stl", b"\0" * 80 + struct.pack("<I", 0xFFFFFFFF) + b"\0" * 50, "mesh file")
    write_file("header.ply", b"ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\nproperty "
                      b"float y\nproperty float z\nelement face 10000000\nproperty list uchar int vertex_indices\n"
                      b"end_header\n" + b"\0" * 100, "mesh file")
    write_file("nan.off", b"OFF\n4 4 0\nnan 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n", "not finite")
    write_file("far.off", b"OFF\n4 1 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 99\n", "mesh file")
    write_file("deep.gltf", b"[" * 100000, "mesh file")
    write_file("torn.glb", b"glTF\x02\0\0\0\xff\xff\xff\x7f", "mesh file")
    (folder / "loop.off").symlink_to(folder / "loop.off")
    expected[str(folder / "loop.off")] = "file"
    os.mkfifo(folder / "pipe.off")
    expected[str(folder / "pipe.off")] = "file"
    return expected


def zip_bomb(path, size):
    """A small zip file of a glTF scene with a buffer of so many zeros."""
    scene = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
             "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
             "buffers": [{"byteLength": size, "uri": "zeros.bin"}], "bufferViews": [{"buffer": 0, "byteLength": size}],
             "accessors": [{"bufferView": 0, "componentType": 5126, "count": size // 12, "type": "VEC3"}]}
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        archive.writestr("scene.gltf", json.dumps(scene))
        with archive.open("zeros.bin", "w") as file:
            for _ in range(size // 2**20):
                file.write(bytes(2**20))
