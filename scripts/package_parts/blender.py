"""Extensions and their repository, made and validated by Blender's own tool, which bpy from PyPI brings."""

import json
import os
import pathlib
import subprocess
import tempfile
import zipfile

import zips
from platforms import ROOT, TAGS, platform_of


def extensions(wheels, target):
    """A zip of the add-on for each of these wheels, in the directory target."""
    with tempfile.TemporaryDirectory() as directory:
        place = pathlib.Path(directory) / "partwheel"
        files = {**zips.addon_files(), **{f"wheels/{wheel.name}": wheel.read_bytes() for wheel in wheels},
                 zips.MANIFEST.name: zips.manifest_for([platform_of(wheel) for wheel in wheels],
                                                       [wheel.name for wheel in wheels])}
        for name, data in files.items():
            path = place / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(data)
        _blender("build", "--split-platforms", "--source-dir", place, "--output-dir", target)
    for wheel in wheels:
        name = f"partwheel-{zips.agreed_version()}-{platform_of(wheel)}.zip"
        made = (target / name.replace(platform_of(wheel), platform_of(wheel).replace("-", "_"))).rename(target / name)
        _same_each_time(made)
        _blender("validate", made)


def _same_each_time(path):
    """Writes a zip anew, without the time at which it was made."""
    with zipfile.ZipFile(path) as archive:
        files = {name: archive.read(name) for name in archive.namelist()}
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name in sorted(files):
            archive.writestr(zips.entry(name, 0o100644), files[name])


def repository(packages, target):
    """A folder that Blender installs and updates from, wherever it is served: the extensions and an index.json. A folder
    beside it for what is newer than the last release is made the same way."""
    target.mkdir()
    for platform in TAGS:
        for package in packages.glob(f"partwheel-*-{platform}.zip"):
            os.link(package, target / package.name)
    _blender("server-generate", "--html", "--repo-dir", target)
    listed = json.loads((target / "index.json").read_text())["data"]
    if len(listed) != len(list(target.glob("*.zip"))):
        raise SystemExit(f"Blender lists {len(listed)} of the extensions in {target}.")


def _blender(*command):
    """`blender --command extension ...`, the same program."""
    (venv, *_) = sorted((ROOT / "build" / "venv").glob("bpy-*"), reverse=True)
    (tool,) = venv.glob("lib/python3*/site-packages/bpy/*/scripts/addons_core/bl_pkg/cli/blender_ext.py")
    done = subprocess.run([venv / "bin/python", tool, *map(str, command)], capture_output=True, text=True)
    if done.returncode or "FATAL_ERROR" in done.stdout:
        raise SystemExit(f"Blender's {command[0]} failed:\n{done.stdout}{done.stderr}")
