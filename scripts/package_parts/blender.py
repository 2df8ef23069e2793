"""Builds and validates extensions and their repositories with Blender's own tool, which bpy from PyPI contains."""

import hashlib
import json
import os
import pathlib
import re
import subprocess
import tempfile
import zipfile

import bundled
import zips
from platforms import ROOT, platform_of


def extensions(wheels, target, version=None):
    """Builds an extension for each wheel in the directory target. version: overrides the version in the files."""
    with tempfile.TemporaryDirectory() as directory:
        folder = pathlib.Path(directory) / "partwheel"
        platforms = [platform_of(wheel) for wheel in wheels]
        contents = wheels + [path for platform in platforms for path in bundled.wheels(platform, bundled.EXTENSION)]
        manifest = zips.manifest_for(platforms, contents)
        if version:
            manifest = re.sub(rb'^version = ".*"', f'version = "{version}"'.encode(), manifest, flags=re.M)
        files = {**zips.addon_files(), **zips.wheel_files(contents), zips.MANIFEST.name: manifest}
        for name, data in files.items():
            path = folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(data)
        _blender("build", "--split-platforms", "--source-dir", folder, "--output-dir", target)
    for wheel in wheels:
        name = f"partwheel-{version or zips.agreed_version()}-{platform_of(wheel)}.zip"
        path = (target / name.replace(platform_of(wheel), platform_of(wheel).replace("-", "_"))).rename(target / name)
        _remove_timestamps(path)
        _blender("validate", path)


def _remove_timestamps(path):
    """Rewrites a zip without timestamps, so that it is reproducible."""
    with zipfile.ZipFile(path) as archive:
        files = {name: archive.read(name) for name in archive.namelist()}
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name in sorted(files):
            archive.writestr(zips.entry(name, 0o100644), files[name])


def repository(wheels, packages, target):
    """Builds a folder with two repositories for Blender, each with the extensions and an index.json, to be served
    anywhere.

    stable has the extensions in the directory packages. latest has the same with a version that contains a hash of
    their content, since Blender updates an extension when its version differs."""
    stable, latest = target / "stable", target / "latest"
    stable.mkdir(parents=True)
    latest.mkdir()
    for package in packages.glob("partwheel-*.zip"):
        if not package.stem.endswith("-legacy"):
            os.link(package, stable / package.name)
    parts = {**zips.addon_files(), **{wheel.name: wheel.read_bytes() for wheel in wheels}}
    digest = hashlib.sha256(b"".join(hashlib.sha256(parts[name]).digest() for name in sorted(parts))).hexdigest()
    extensions(wheels, latest, f"{zips.agreed_version()}-latest.x{digest[:8]}")
    for channel in (stable, latest):
        _blender("server-generate", "--html", "--repo-dir", channel)
        listed = json.loads((channel / "index.json").read_text())["data"]
        if len(listed) != len(wheels):
            raise SystemExit(f"Blender lists {len(listed)} of {len(wheels)} extensions in {channel}.")


def _blender(*command):
    """Runs the program behind `blender --command extension ...`."""
    (venv, *_) = sorted((ROOT / "build" / "venv").glob("bpy-*"), reverse=True)
    (tool,) = venv.glob("lib/python3*/site-packages/bpy/*/scripts/addons_core/bl_pkg/cli/blender_ext.py")
    process = subprocess.run([venv / "bin/python", tool, *map(str, command)], capture_output=True, text=True)
    if process.returncode or "FATAL_ERROR" in process.stdout:
        raise SystemExit(f"Blender's {command[0]} failed:\n{process.stdout}{process.stderr}")
