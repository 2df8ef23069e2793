# SPDX-License-Identifier: GPL-3.0-or-later
"""What scripts/package all has left in build/ship: installed as strangers do, from files, from the repository, from source."""

import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SHIP = ROOT / "build" / "ship"
sys.path.append(str(ROOT / "scripts" / "package_parts"))
import elsewhere  # noqa: E402
import runs  # noqa: E402
import zips  # noqa: E402
from platforms import TAGS, library_of  # noqa: E402

VERSION = zips.agreed_version()
MADE = [platform for platform in TAGS if (SHIP / f"partwheel-{VERSION}-{platform}.zip").exists()]
HERE = "linux-arm64" if os.uname().machine == "aarch64" else "linux-x64"
MESHES = ROOT / "build" / "deps" / "meshes"
MODEL = MESHES / "hand.off"
SID = ROOT / "build" / "deps" / "blender-sid"  # the newest Blender, in a Debian of its own
HEADLESS = ["-b", "-noaudio", "--factory-startup", "--python-exit-code", "9", "--python"]
# Name -> what runs a script. The distribution's is from before extensions.
BLENDERS = {"blender": ["blender", *HEADLESS],
            **{venv.name: [venv / "bin/python"] for venv in sorted((ROOT / "build" / "venv").glob("bpy-*"))},
            **({"sid": ["chroot", SID, "blender", *HEADLESS]} if SID.exists() else {})}
WINDOWS = ROOT / "build" / "deps" / "windows-python"
# Any Python of this machine's that is neither the tests' nor a part of it: pyenv's too.
PYTHONS = sorted({python.resolve() for place in ("/usr/bin", Path.home() / ".pyenv/versions")
                  for python in [*Path(place).glob("python3.*"), *Path(place).glob("3.*/bin/python3.*")]
                  if re.fullmatch(r"python3\.(9|[1-9]\d)", python.name)}, key=lambda python: int(python.name[8:]))


def run(*command, **options):
    process = subprocess.run(list(map(str, command)), capture_output=True, text=True, **options)
    assert process.returncode == 0, process.stdout + process.stderr
    return process.stdout


def wheel(platform):
    return SHIP / f"partwheel-{VERSION}-py3-none-{TAGS[platform]}.whl"


def test_the_folder_has_all_packages_and_what_a_release_page_needs():
    assert MADE == list(TAGS)
    packages = {f"partwheel-{VERSION}.tar.gz", *(wheel(platform).name for platform in TAGS),
                *(f"partwheel-{VERSION}-{platform}{kind}.zip" for platform in TAGS for kind in ("", "-legacy"))}
    others = {"repository", "pictures", "NOTES.md", "SHA256SUMS", "ship.log"}
    assert {path.name for path in SHIP.iterdir()} == packages | others
    sums = dict(reversed(line.split("  ")) for line in (SHIP / "SHA256SUMS").read_text().splitlines())
    assert sums == {name: hashlib.sha256((SHIP / name).read_bytes()).hexdigest() for name in packages}


@pytest.mark.parametrize("platform", MADE)
def test_extension_legacy_and_wheel_have_one_library(platform):
    with zipfile.ZipFile(wheel(platform)) as archive:
        library = archive.read(f"partwheel/{library_of(platform)}")
        assert f"Tag: py3-none-{TAGS[platform]}" in archive.read(f"partwheel-{VERSION}.dist-info/WHEEL").decode()
    with zipfile.ZipFile(SHIP / f"partwheel-{VERSION}-{platform}.zip") as archive:
        inside = [name for name in archive.namelist() if name.endswith(".whl")]
        ours = f"wheels/{wheel(platform).name}"
        others = sorted(re.fullmatch(r"wheels/manifold3d-.*-(cp\d+)-cp\d+-.*\.whl", name)[1] for name in inside if name != ours)
        assert others == ["cp311", "cp312", "cp313", "cp314"] and len(inside) == 5
        assert archive.read(ours) == wheel(platform).read_bytes()
    with zipfile.ZipFile(SHIP / f"partwheel-{VERSION}-{platform}-legacy.zip") as archive:
        assert archive.read(f"partwheel_addon/packages/partwheel/{library_of(platform)}") == library


@pytest.mark.parametrize("channel", ["stable", "latest"])
def test_the_repository_lists_a_package_for_each_platform(channel):
    folder = SHIP / "repository" / channel
    listed = json.loads((folder / "index.json").read_text())["data"]
    assert sorted(platform for entry in listed for platform in entry["platforms"]) == sorted(MADE)
    assert all((folder / entry["archive_url"]).is_file() for entry in listed)
    assert {entry["version"] == VERSION for entry in listed} == {channel == "stable"}


def run_in(blender, tmp_path, script, *arguments, files=()):
    """Runs a script of the tests' in a Blender with a home of its own: what was printed. The files, which are among the
    arguments, are where it sees them."""
    root, home = ROOT, tmp_path / "home"
    if blender == "sid":  # nothing is mounted: what it needs is copied
        root, home = Path("/partwheel-ship"), Path("/partwheel-ship/home")
        inside = SID / "partwheel-ship"
        shutil.rmtree(inside, ignore_errors=True)
        (inside / "home").mkdir(parents=True)
        for folder in ("tests/addon", "tests/core", "tests/faults", "tests/ship", "docs", "build/deps/meshes"):
            shutil.copytree(ROOT / folder, inside / folder)
        for path in files:
            (shutil.copytree if path.is_dir() else shutil.copy)(path, inside / path.name)
        arguments = [root / argument.name if argument in files else argument for argument in arguments]
    else:
        home.mkdir(exist_ok=True)
    output = run(*BLENDERS[blender], root / "tests" / script, "--", *arguments, cwd=ROOT,
               env={"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "HOME": str(home), "LANG": "C.UTF-8"})
    assert "Traceback" not in output, output
    return output


@pytest.mark.parametrize("blender", BLENDERS)
def test_installed_and_updated_from_a_file(blender, tmp_path):
    """Also over itself, with the library in use; and it does the main job."""
    package = SHIP / f"partwheel-{VERSION}-{HERE}{'-legacy' if blender == 'blender' else ''}.zip"
    result = Path("/partwheel-ship/result.json") if blender == "sid" else tmp_path / "result.json"
    output = run_in(blender, tmp_path, "addon/run.py", package, result, "an_update_is_used_at_once",
                  "hidden_faces_are_never_selected", files=[package])
    assert "2 passed, 0 failed" in output


@pytest.mark.parametrize("channel", ["stable", "latest"])
@pytest.mark.parametrize("blender", sorted({*BLENDERS} - {"blender"}))
def test_installed_and_updated_from_the_repository(blender, channel, tmp_path):
    folder = SHIP / "repository" / channel
    output = run_in(blender, tmp_path, "ship/in_blender.py", folder, files=[folder])
    assert "installed, used, updated in use, removed" in output


@pytest.mark.skipif(HERE != "linux-x64", reason="wine runs programs of its own kind of machine only")
def test_the_core_tests_on_windows(tmp_path):
    """By a Python for Windows, under wine: those that need no compiler."""
    packages = tmp_path / "packages"
    with zipfile.ZipFile(wheel("windows-x64")) as archive:
        archive.extractall(packages)
    runner, prefix = runs.RUNNERS["windows-x64"]
    on_windows = {"PYTHONPATH": seen_by_wine(WINDOWS / "packages"), "PARTWHEEL_PACKAGES": seen_by_wine(packages)}
    process = subprocess.run([*runner, WINDOWS / "python/python.exe", "-m", "pytest", "-q", "-p", "no:cacheprovider",
                           *(f"tests/core/test_{name}.py" for name in elsewhere.CORE)], cwd=ROOT, text=True,
                          env={**os.environ, **prefix, **on_windows}, stdin=subprocess.DEVNULL, capture_output=True)
    assert process.returncode == 0, process.stdout[-5000:] + process.stderr[-2000:]
    assert int(re.search(r"(\d+) passed", process.stdout)[1]) > 100 and "failed" not in process.stdout


def seen_by_wine(path):
    return "Z:" + str(path).replace("/", "\\")


def environment(place, python=sys.executable):
    """The Python of a new environment."""
    run(python, "-m", "venv", place)
    return place / "bin" / "python"


def without_numpy_1(python):
    return int(python.name[8:]) > 12


@pytest.mark.parametrize("numpy", ["1", "2"])
@pytest.mark.parametrize("python", PYTHONS, ids=lambda python: python.name)
def test_the_wheel_with_either_numpy(python, numpy, tmp_path):
    if numpy == "1" and without_numpy_1(python):
        pytest.skip(f"there is no numpy 1 for {python.name}")
    inside = environment(tmp_path / "venv", python)
    run(inside, "-m", "pip", "install", f"numpy=={numpy}.*", wheel(HERE))
    assert json.loads(run(tmp_path / "venv/bin/partwheel", "build", MODEL, "--json"))["faces"] == 2390


@pytest.mark.skipif(not SID.exists(), reason="there is no newer Debian: scripts/test newest makes it")
def test_the_wheel_with_the_newest_python(tmp_path):
    """Of Debian sid, which has no pip; numpy is its own."""
    inside = SID / "partwheel-ship"
    shutil.rmtree(inside, ignore_errors=True)
    with zipfile.ZipFile(wheel(HERE)) as archive:
        archive.extractall(inside)
    shutil.copy(MODEL, inside)
    output = run("chroot", SID, "env", "PYTHONPATH=/partwheel-ship", "python3", "-m", "partwheel", "build",
               "/partwheel-ship/hand.off", "--json")
    assert json.loads(output)["faces"] == 2390


@pytest.mark.parametrize("python", PYTHONS, ids=lambda python: python.name)
def test_the_source_distribution_builds_and_gives_the_same(python, tmp_path):
    """In an empty environment: all that it needs beside g++ and CMake is in it, and it doesn't look at this checkout.
    What it compiles is the same for each Python, so ccache has it from the first on."""
    (source,) = SHIP.glob("*.tar.gz")
    with tarfile.open(source) as archive:
        names = archive.getnames()
    assert not any(name.endswith((".so", ".dll", ".pyc")) for name in names)
    inside = environment(tmp_path / "venv", python)
    ccache = Path(os.environ.get("CCACHE_DIR") or Path.home() / ".cache/ccache")
    run(inside, "-m", "pip", "install", source, cwd=tmp_path,
        env={"PATH": "/usr/bin:/bin", "HOME": str(tmp_path), "TMPDIR": str(tmp_path), "CCACHE_DIR": str(ccache),
             "CCACHE_BASEDIR": str(tmp_path), "CCACHE_NOHASHDIR": "1"})
    save = "import sys, partwheel.meshes as m, partwheel as p; x = m.read(sys.argv[1]); " \
           "h = p.Hierarchy.build(x.vertices, x.triangles, x.faces, x.face_count); open(sys.argv[2], 'wb').write(h.save())"
    other = environment(tmp_path / "wheel", python)
    run(other, "-m", "pip", "install", wheel(HERE))
    for model in runs.MODELS:
        saved = [tmp_path / name / "saved" for name in ("venv", "wheel")]
        for mesh, target in zip((inside, other), saved):
            run(mesh, "-c", save, MESHES / model, target, cwd=tmp_path)
        assert saved[0].read_bytes() == saved[1].read_bytes(), model
