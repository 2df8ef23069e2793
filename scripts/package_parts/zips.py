"""Writes reproducible zips of the add-on that contain a wheel of the Python package.

    zips.py build/package/partwheel-VERSION-py3-none-TAG.whl

Next to the wheel it writes partwheel-VERSION-PLATFORM.zip, an extension for Blender 4.2 and later, which installs the
wheel and those of bundled.py; and -legacy.zip for 3.4 to 4.1, which has the wheels' content. zips.py --version prints
the version, which must be the same in all files.
"""

import ast
import json
import pathlib
import re
import sys
import zipfile

import bundled
from platforms import ROOT, platform_of
from translations import dictionary

ADDON = ROOT / "addon" / "partwheel"
MANIFEST = ADDON / "blender_manifest.toml"
EPOCH = (1980, 1, 1, 0, 0, 0)  # the earliest time that a zip can store


def main(wheel):
    platform = platform_of(wheel)
    wheels = [wheel, *bundled.wheels(platform, bundled.EXTENSION)]
    write(wheel.with_name(f"partwheel-{agreed_version()}-{platform}.zip"), "partwheel",
          {**addon_files(), MANIFEST.name: manifest_for([platform], wheels), **wheel_files(wheels)})
    legacy(wheel)


def legacy(wheel):
    """Writes the add-on for Blender 3.4 to 4.1."""
    package = {}
    for path in [wheel, *bundled.wheels(platform_of(wheel), bundled.LEGACY)]:
        with zipfile.ZipFile(path) as archive:
            package |= {f"packages/{name}": archive.read(name) for name in archive.namelist()
                        if (path != wheel or name.startswith("partwheel/")) and not name.endswith(("/", "/RECORD"))}
    # The folder's name becomes that of the module, which must differ from the package's.
    write(wheel.with_name(f"partwheel-{agreed_version()}-{platform_of(wheel)}-legacy.zip"), "partwheel_addon",
          {**addon_files(), **package})


def addon_files():
    """{name: bytes} of the add-on, without the manifest and the Python package. One dictionary replaces the .po files."""
    files = {path.relative_to(ADDON).as_posix(): path.read_bytes() for path in ADDON.rglob("*") if is_shipped(path)}
    return {**files, "translations/dictionary.json": dictionary(ADDON.glob("translations/*.po")),
            "LICENSE": (ROOT / "LICENSE").read_bytes()}


def wheel_files(wheels):
    """{name: bytes} of wheels in an extension."""
    return {f"wheels/{wheel.name}": wheel.read_bytes() for wheel in wheels}


def write(target, folder, files):
    """Writes a zip of files in one folder, as both installers require."""
    partial = target.with_suffix(".partial")
    with zipfile.ZipFile(partial, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        # Before an update, Blender older than 4.2 removes the old add-on only if the zip has an entry for its folder.
        # Otherwise it overwrites the library while it is in use, and crashes.
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


def is_shipped(path):
    is_hidden = any(part.startswith((".", "__pycache__")) for part in path.relative_to(ADDON).parts)
    return path.is_file() and path != MANIFEST and path.suffix != ".po" and not is_hidden


def manifest_for(platforms, wheels):
    """The manifest for these platforms and wheels."""
    lines = f"platforms = {json.dumps(platforms)}\nwheels = {json.dumps([f'./wheels/{wheel.name}' for wheel in wheels])}"
    text, count = re.subn(r"^platforms = .*$", lines, MANIFEST.read_text(), flags=re.M)
    if count != 1:
        sys.exit(f"{MANIFEST} must have one line that begins with platforms.")
    return text.encode()


def agreed_version():
    """The version. Exits unless the header, the binding, the manifest and bl_info have the same."""
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
