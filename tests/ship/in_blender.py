# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs in a Blender with a HOME of its own: serves a copy of a repository's folder, adds it, installs Partwheel from it,
does the main job, updates it while its library is in use, and removes it.

    PYTHON tests/ship/in_blender.py -- FOLDER
"""

import contextlib
import functools
import http.server
import importlib
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import zipfile
from pathlib import Path

import bpy

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests" / "addon"), str(ROOT / "tests" / "faults")]
MODULE = "bl_ext.partwheel.partwheel"
HERE = "linux-arm64" if os.uname().machine == "aarch64" else "linux-x64"


def main(folder):
    with tempfile.TemporaryDirectory() as directory:
        served = Path(directory) / "served"
        shutil.copytree(folder, served)
        with serving(served) as url:
            used(url, served)
    print("installed, used, updated in use, removed")


@contextlib.contextmanager
def serving(folder):
    """The folder's address, while it is served on this machine."""
    handler = functools.partial(http.server.SimpleHTTPRequestHandler, directory=str(folder))
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}"
        server.shutdown()


def used(url, served):
    preferences = bpy.context.preferences
    preferences.system.use_online_access = True
    repository = preferences.extensions.repos.new(name="Partwheel", module="partwheel", remote_url=f"{url}/index.json")
    index = list(preferences.extensions.repos).index(repository)
    bpy.ops.extensions.repo_sync(repo_index=index)
    bpy.ops.extensions.package_install(repo_index=index, pkg_id="partwheel", enable_on_install=True)
    before = main_job()

    newer(served)
    bpy.ops.extensions.repo_sync(repo_index=index)
    bpy.ops.extensions.package_upgrade_all()
    updated = importlib.import_module(f"{MODULE}.parts.registry")
    assert getattr(updated, "UPDATED", False), "the update is not what runs"
    assert manifest(updated)["version"] == "0.1.1"
    assert main_job() == before

    bpy.ops.extensions.package_uninstall(repo_index=index, pkg_id="partwheel")
    assert MODULE not in preferences.addons and not Path(updated.__file__).parents[1].exists(), "it is still there"
    assert not hasattr(bpy.types, "MESH_OT_partwheel_select")


def main_job():
    """A click on a face: how many faces are selected."""
    assert MODULE in bpy.context.preferences.addons, "it is not installed and enabled"
    from common import read_off

    vertices, faces = read_off("hand")
    mesh = bpy.data.meshes.new("model")
    mesh.from_pydata(vertices, [], faces)
    obj = bpy.data.objects.new("model", mesh)
    bpy.context.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.mode_set(mode="EDIT")
    assert bpy.ops.mesh.partwheel_select(face_index=100) == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    selected = sum(polygon.select for polygon in mesh.polygons)
    assert 0 < selected < len(mesh.polygons)
    return selected


def newer(served):
    """Replaces all packages in the folder by the next version of this platform's, and the folder's index."""
    import bl_pkg  # found once bpy is imported
    from test_registration import add_updated

    (package,) = served.glob(f"*-{HERE}.zip")
    partial = served / "partial"
    with zipfile.ZipFile(package) as old, zipfile.ZipFile(partial, "w") as new:
        add_updated(old, new)
    for old in served.glob("*.zip"):
        old.unlink()
    with zipfile.ZipFile(partial) as old, zipfile.ZipFile(served / f"partwheel-0.1.1-{HERE}.zip", "w") as new:
        for name in old.namelist():
            data = old.read(name)
            if name == "blender_manifest.toml":
                data = re.sub(rb'^version = ".*"', b'version = "0.1.1"', data, flags=re.M)
            new.writestr(name, data)
    partial.unlink()
    tool = Path(bl_pkg.__file__).parent / "cli" / "blender_ext.py"
    subprocess.run([sys.executable, tool, "server-generate", "--repo-dir", served], check=True)
    (entry,) = json.loads((served / "index.json").read_text())["data"]
    assert entry["version"] == "0.1.1"


def manifest(module):
    import tomllib

    return tomllib.loads((Path(module.__file__).parents[1] / "blender_manifest.toml").read_text())


if __name__ == "__main__":
    main(sys.argv[-1])
