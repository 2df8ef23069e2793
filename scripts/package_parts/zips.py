"""Writes the add-on with a wheel of the Python package inside: the same bytes for the same files.

    zips.py build/package/partwheel-VERSION-py3-none-TAG.whl

Beside the wheel come partwheel-VERSION-PLATFORM.zip, an extension for Blender 4.2 and later, which installs the wheel;
and -legacy.zip for 3.4 to 4.1, in which it is unpacked. zips.py --version prints the version that all files agree on.
"""

import ast
import json
import pathlib
import re
import sys
import zipfile

from platforms import ROOT, platform_of

ADDON = ROOT / "addon" / "partwheel"
MANIFEST = ADDON / "blender_manifest.toml"
EPOCH = (1980, 1, 1, 0, 0, 0)  # the earliest time that a zip can hold


def main(wheel):
    here = platform_of(wheel)
    write(wheel.with_name(f"partwheel-{agreed_version()}-{here}.zip"), "partwheel",
          {**addon_files(), MANIFEST.name: manifest_for([here], [wheel.name]),
           f"wheels/{wheel.name}": wheel.read_bytes()})
    legacy(wheel)


def legacy(wheel):
    """The add-on for Blender 3.4 to 4.1."""
    with zipfile.ZipFile(wheel) as archive:
        package = {f"packages/{name}": archive.read(name) for name in archive.namelist()
                   if name.startswith("partwheel/") and not name.endswith("/")}
    # The folder's name becomes the module's, which must not be the package's.
    write(wheel.with_name(f"partwheel-{agreed_version()}-{platform_of(wheel)}-legacy.zip"), "partwheel_addon",
          {**addon_files(), **package})


def addon_files():
    """Name -> bytes, without a manifest and the Python package."""
    files = {path.relative_to(ADDON).as_posix(): path.read_bytes() for path in ADDON.rglob("*") if wanted(path)}
    return {**files, "LICENSE": (ROOT / "LICENSE").read_bytes()}


def write(target, folder, files):
    """A zip of these files in one folder, as both installers want them."""
    partial = target.with_suffix(".partial")
    with zipfile.ZipFile(partial, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        # Blender before 4.2 removes what an update replaces only if the zip names its folder. Else it would write over
        # the library while that is in use, and crash.
        archive.writestr(entry(f"{folder}/", 0o040755), b"")
        for name in sorted(files):
            archive.writestr(entry(f"{folder}/{name}", 0o100644), files[name])
    partial.replace(target)
    print(target)


def entry(name, mode):
    info = zipfile.ZipInfo(name, EPOCH)
    info.external_attr = mode << 16
    info.compress_type = zipfile.ZIP_DEFLATED
    return info


def wanted(path):
    hidden = any(part.startswith((".", "__pycache__")) for part in path.relative_to(ADDON).parts)
    return path.is_file() and path != MANIFEST and not hidden


def manifest_for(platforms, wheels):
    """The manifest, with the platforms that the libraries in these wheels are for in place of those in the source."""
    text, count = re.subn(r"^platforms = .*$", f"platforms = {json.dumps(platforms)}\n"
                          f"wheels = {json.dumps([f'./wheels/{wheel}' for wheel in wheels])}", MANIFEST.read_text(), flags=re.M)
    if count != 1:
        sys.exit(f"{MANIFEST} must have one line that begins with platforms.")
    return text.encode()


def agreed_version():
    """The version, which the header, the binding, the manifest and bl_info must agree on."""
    header = re.search(r'^#define PW_VERSION "([^"]+)"', (ROOT / "native/include/partwheel.h").read_text(), re.M)
    binding = re.search(r'^VERSION = "([^"]+)"', (ROOT / "native/python/partwheel/library.py").read_text(), re.M)
    manifest = re.search(r'^version = "([^"]+)"', MANIFEST.read_text(), re.M)
    assignments = (node for node in ast.parse((ADDON / "__init__.py").read_text()).body if isinstance(node, ast.Assign))
    bl_info = next(ast.literal_eval(node.value) for node in assignments if node.targets[0].id == "bl_info")
    versions = {"partwheel.h": header[1], "library.py": binding[1], "blender_manifest.toml": manifest[1],
                "bl_info": ".".join(map(str, bl_info["version"]))}
    if len(set(versions.values())) > 1:
        sys.exit(f"The versions differ: {versions}.")
    return header[1]


if __name__ == "__main__":
    if sys.argv[1] == "--version":
        print(agreed_version())
    else:
        main(pathlib.Path(sys.argv[1]))
