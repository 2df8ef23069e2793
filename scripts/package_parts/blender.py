"""Validates extensions and builds their repositories with Blender's own tool, which bpy from PyPI contains."""

import hashlib
import json
import os
import subprocess

import zips
from platforms import ROOT


def extensions(wheels, target, version=None):
    """Writes and validates an extension for each wheel in the directory target."""
    for wheel in wheels:
        _blender("validate", zips.extension(wheel, target, version))


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
