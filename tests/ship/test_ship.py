# SPDX-License-Identifier: GPL-3.0-or-later
"""What scripts/package all has left in build/ship: installed as strangers do, from files, from the repository, from source."""

import functools
import http.server
import json
import os
import shutil
import subprocess
import sys
import tarfile
import threading
import venv
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SHIP = ROOT / "build" / "ship"
sys.path.append(str(ROOT / "scripts" / "package_parts"))
import zips  # noqa: E402
from platforms import TAGS, library_of  # noqa: E402

VERSION = zips.agreed_version()
MADE = [platform for platform in TAGS if (SHIP / f"partwheel-{VERSION}-{platform}.zip").exists()]
HERE = "linux-arm64" if os.uname().machine == "aarch64" else "linux-x64"
BLENDERS = sorted((ROOT / "build" / "venv").glob("bpy-*"))
MODEL = ROOT / "build" / "deps" / "meshes" / "hand.off"


def run(*command, **options):
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, **options)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def wheel(platform):
    return SHIP / f"partwheel-{VERSION}-py3-none-{TAGS[platform]}.whl"


def test_all_are_there():
    assert MADE == list(TAGS)


@pytest.mark.parametrize("platform", MADE)
def test_extension_legacy_and_wheel_have_one_library(platform):
    with zipfile.ZipFile(wheel(platform)) as archive:
        library = archive.read(f"partwheel/{library_of(platform)}")
        assert f"Tag: py3-none-{TAGS[platform]}" in archive.read(f"partwheel-{VERSION}.dist-info/WHEEL").decode()
    with zipfile.ZipFile(SHIP / f"partwheel-{VERSION}-{platform}.zip") as archive:
        inside = [name for name in archive.namelist() if name.endswith(".whl")]
        assert inside == [f"wheels/{wheel(platform).name}"]
        assert archive.read(inside[0]) == wheel(platform).read_bytes()
    with zipfile.ZipFile(SHIP / f"partwheel-{VERSION}-{platform}-legacy.zip") as archive:
        assert archive.read(f"partwheel_addon/packages/partwheel/{library_of(platform)}") == library


def test_the_repository_lists_a_package_for_each_platform():
    listed = json.loads((SHIP / "repository" / "index.json").read_text())["data"]
    assert sorted(platform for entry in listed for platform in entry["platforms"]) == sorted(MADE)
    assert all((SHIP / "repository" / entry["archive_url"]).is_file() for entry in listed)


@pytest.fixture
def served(tmp_path):
    """(URL, folder) of the repository on this machine."""
    folder = tmp_path / "served"
    shutil.copytree(SHIP / "repository", folder)
    handler = functools.partial(http.server.SimpleHTTPRequestHandler, directory=str(folder))
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}/index.json", folder
        server.shutdown()


@pytest.mark.parametrize("blender", BLENDERS, ids=lambda path: path.name)
def test_installed_and_updated_from_the_repository(blender, served, tmp_path):
    url, folder = served
    for other in folder.glob("*.zip"):
        if HERE not in other.name:
            other.unlink()
    home = tmp_path / "home"
    home.mkdir()
    said = run(blender / "bin/python", ROOT / "tests/ship/in_blender.py", url, folder,
               env={"PATH": "/usr/bin:/bin", "HOME": str(home), "LANG": "C.UTF-8"})
    assert "installed, used, updated in use, removed" in said and "Traceback" not in said


def environment(place, python=sys.executable):
    if python == sys.executable:
        venv.create(place, with_pip=True)
    else:
        run(python, "-m", "venv", place)
    return place / "bin" / "python"


@pytest.mark.parametrize("numpy", ["1", "2"])
def test_the_wheel_with_either_numpy(numpy, tmp_path):
    python = environment(tmp_path / "venv")
    run(python, "-m", "pip", "install", f"numpy=={numpy}.*", wheel(HERE))
    assert json.loads(run(tmp_path / "venv/bin/partwheel", "build", MODEL, "--json"))["faces"] == 2390


def test_the_source_distribution_builds_and_gives_the_same(tmp_path):
    """In an empty environment: all that it needs beside g++ and CMake is in it, and it doesn't look at this checkout."""
    (source,) = SHIP.glob("*.tar.gz")
    with tarfile.open(source) as archive:
        names = archive.getnames()
    assert not any(name.endswith((".so", ".dll", ".pyc")) for name in names)
    python = environment(tmp_path / "venv")
    run(python, "-m", "pip", "install", source, cwd=tmp_path, env={"PATH": "/usr/bin:/bin", "HOME": str(tmp_path)})
    save = "import sys, partwheel.meshes as m, partwheel as p; x = m.read(sys.argv[1]); " \
           "h = p.Hierarchy.build(x.vertices, x.triangles, x.faces, x.face_count); open(sys.argv[2], 'wb').write(h.save())"
    other = environment(tmp_path / "wheel")
    run(other, "-m", "pip", "install", wheel(HERE))
    for name, each in (("source", python), ("wheel", other)):
        run(each, "-c", save, MODEL, tmp_path / f"{name}.saved", cwd=tmp_path)
    assert (tmp_path / "source.saved").read_bytes() == (tmp_path / "wheel.saved").read_bytes()
