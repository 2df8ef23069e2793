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


def extension(wheel, folder, version=None):
    """Writes the extension for Blender 4.2 and later to a folder; returns its path. version: another one in its manifest."""
    platform = platform_of(wheel)
    wheels = [wheel, *bundled.wheels(platform, bundled.EXTENSION)]
    path = folder / f"partwheel-{version or agreed_version()}-{platform}.zip"
    write(path, {**addon_files(), MANIFEST.name: manifest_for(platform, wheels, version or agreed_version()),
                 **{f"wheels/{wheel.name}": wheel.read_bytes() for wheel in wheels}})
    return path


def legacy(wheel):
    """Writes the add-on for Blender 3.4 to 4.1, next to the wheel."""
    package = {}
    for path in [wheel, *bundled.wheels(platform_of(wheel), bundled.LEGACY)]:
        with zipfile.ZipFile(path) as archive:
            package |= {f"packages/{name}": archive.read(name) for name in archive.namelist()
                        if (path != wheel or name.startswith("partwheel/")) and not name.endswith(("/", "/RECORD"))}
    # The folder's name becomes that of the module, which must differ from the package's.
    # Before an update, Blender removes the old add-on only if the zip has an entry for its folder. Otherwise it overwrites the
    # library while it is in use, and crashes.
    write(wheel.with_name(f"partwheel-{agreed_version()}-{platform_of(wheel)}-legacy.zip"), {
        "partwheel_addon/": b"", **{f"partwheel_addon/{name}": data for name, data in {**addon_files(), **package}.items()}})


def addon_files():
    """{name: bytes} of the add-on, without the manifest and the Python package. One dictionary replaces the .po files."""
    files = {path.relative_to(ADDON).as_posix(): path.read_bytes() for path in ADDON.rglob("*") if is_shipped(path)}
    return {**files, "translations/dictionary.json": dictionary(ADDON.glob("translations/*.po")),
            "LICENSE": (ROOT / "LICENSE").read_bytes()}


def write(target, files):
    """Writes a zip of files {name: bytes}; a folder's name ends with a slash."""
    partial = target.with_suffix(".partial")
    with zipfile.ZipFile(partial, "w") as archive:
        for name in sorted(files):
            info = zipfile.ZipInfo(name, EPOCH)
            info.external_attr = (0o040755 if name.endswith("/") else 0o100644) << 16
            archive.writestr(info, files[name], zipfile.ZIP_DEFLATED, 9)
    partial.replace(target)
    print(target)


def is_shipped(path):
    is_hidden = any(part.startswith((".", "__pycache__")) for part in path.relative_to(ADDON).parts)
    return path.is_file() and path != MANIFEST and path.suffix != ".po" and not is_hidden


def manifest_for(platform, wheels, version):
    """The manifest for a platform with these wheels."""
    lines = f"platforms = {json.dumps([platform])}\nwheels = {json.dumps([f'./wheels/{wheel.name}' for wheel in wheels])}"
    text, count = re.subn(r"^platforms = .*$", lines, MANIFEST.read_text(), flags=re.M)
    if count != 1:
        sys.exit(f"{MANIFEST} must have one line that begins with platforms.")
    return re.sub(r'^version = ".*"', f'version = "{version}"', text, flags=re.M).encode()


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
        built = pathlib.Path(sys.argv[1])
        extension(built, built.parent)
        legacy(built)
