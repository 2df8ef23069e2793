"""Writes build/package/partwheel-VERSION-PLATFORM.zip from addon/partwheel: the same bytes for the same files.

Called by scripts/package, which builds the library first.
"""

import ast
import pathlib
import platform
import re
import sys
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
ADDON = ROOT / "addon" / "partwheel"
MANIFEST = ADDON / "blender_manifest.toml"
PACKAGES = ROOT / "build" / "package"
PACKAGE = ROOT / "native" / "python" / "partwheel"
LIBRARY = PACKAGE / "libpartwheel.so"
MACHINES = {"x86_64": "x64", "aarch64": "arm64"}
ROOM = "partwheel_addon"  # in the zip
EPOCH = (1980, 1, 1, 0, 0, 0)  # the earliest time that a zip can hold


def main():
    version = agreed_version()
    if not LIBRARY.exists():
        sys.exit(f"{LIBRARY} is missing: run scripts/build.")
    here = f"linux-{MACHINES.get(platform.machine(), platform.machine())}"
    target = PACKAGES / f"partwheel-{version}-{here}.zip"
    target.parent.mkdir(parents=True, exist_ok=True)

    # Both installers want all files in one folder: for a legacy add-on its name becomes the module's.
    # That name must not be the Python package's, which the add-on brings and finds beside its own files.
    files = {f"{ROOM}/{prefix}{path.relative_to(tree).as_posix()}": path.read_bytes()
             for tree, prefix in ((ADDON, ""), (PACKAGE, "packages/partwheel/"))
             for path in tree.rglob("*") if wanted(path.relative_to(tree)) and path.is_file()}
    files[f"{ROOM}/LICENSE"] = (ROOT / "LICENSE").read_bytes()
    files[f"{ROOM}/blender_manifest.toml"] = manifest_for(here)
    partial = target.with_suffix(".partial")
    with zipfile.ZipFile(partial, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        # Blender before 4.2 removes what an update replaces only if the zip names its folder. Else it would write over
        # the library while that is in use, and crash.
        archive.writestr(entry(f"{ROOM}/", 0o040755), b"")
        for name in sorted(files):
            archive.writestr(entry(name, 0o100644), files[name])
    partial.replace(target)
    print(target)


def entry(name, mode):
    info = zipfile.ZipInfo(name, EPOCH)
    info.external_attr = mode << 16
    info.compress_type = zipfile.ZIP_DEFLATED
    return info


def wanted(path):
    return not any(part.startswith((".", "__pycache__")) for part in path.parts)


def manifest_for(here):
    """The manifest, with the platform that the library in the zip is for in place of that in the source."""
    text, count = re.subn(r"^platforms = .*$", f'platforms = ["{here}"]', MANIFEST.read_text(), flags=re.M)
    if count != 1:
        sys.exit(f"{MANIFEST} must have one line that begins with platforms.")
    return text.encode()


def agreed_version():
    """The version, which the header, the binding, the manifest and bl_info must agree on."""
    header = re.search(r'^#define PW_VERSION "([^"]+)"', (ROOT / "native/include/partwheel.h").read_text(), re.M)
    binding = re.search(r'^VERSION = "([^"]+)"', (PACKAGE / "library.py").read_text(), re.M)
    manifest = re.search(r'^version = "([^"]+)"', MANIFEST.read_text(), re.M)
    assignments = (node for node in ast.parse((ADDON / "__init__.py").read_text()).body if isinstance(node, ast.Assign))
    bl_info = next(ast.literal_eval(node.value) for node in assignments if node.targets[0].id == "bl_info")
    versions = {"partwheel.h": header[1], "library.py": binding[1], "blender_manifest.toml": manifest[1],
                "bl_info": ".".join(map(str, bl_info["version"]))}
    if len(set(versions.values())) > 1:
        sys.exit(f"The versions differ: {versions}.")
    return header[1]


if __name__ == "__main__":
    main()
