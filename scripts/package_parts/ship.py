"""What is shipped, for all platforms or some: libraries, wheels, Blender's extensions, legacy add-ons, a repository folder,
the source distribution; and a table of what was checked. Called by scripts/package, in build/venv/package.

    ship.py all | PLATFORM ...
"""

import argparse
import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
import zipfile

import blender
import checks
import runs
import source
import zips
from platforms import ROOT, TAGS, library_of

SHIP = ROOT / "build" / "ship"
LOG = SHIP / "ship.log"


def main():
    parser = argparse.ArgumentParser(prog="scripts/package", description="Packages for all platforms, or some.")
    parser.add_argument("platform", nargs="+", help=f"all, or some of {' '.join(TAGS)}")
    platforms = parser.parse_args().platform
    platforms = list(TAGS) if platforms == ["all"] else platforms
    if set(platforms) - set(TAGS):
        parser.error(f"there is no platform {' '.join(set(platforms) - set(TAGS))}")
    shutil.rmtree(SHIP, ignore_errors=True)
    SHIP.mkdir(parents=True)

    table = {}
    wheels = []
    for platform in platforms:
        print(f"package: the library and the wheel for {platform}", flush=True)
        library = linked_twice(platform)
        table[platform] = {**checks.check(library, platform), "twice": "same bytes"}
        wheels.append(wheel_of(platform))
    print("package: what the libraries make of a model, where they can be run", flush=True)
    for platform, told in runs.run(platforms).items():
        table[platform]["run"] = told
    print("package: add-ons for Blender, and its repositories", flush=True)
    for wheel in wheels:
        zips.legacy(wheel)
    blender.extensions(wheels, SHIP)
    blender.repository(wheels, SHIP, SHIP / "repository")
    if "linux-x64" in platforms:
        print("package: the source distribution", flush=True)
        source.distribution(SHIP, [ROOT / "build" / platform for platform in platforms])
    logged("twine", "check", "--strict", *SHIP.glob("*.whl"), *SHIP.glob("*.tar.gz"))
    logged("check-wheel-contents", *SHIP.glob("*.whl"))
    sums = "".join(f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}\n"
                   for path in sorted(SHIP.iterdir()) if path.suffix in {".whl", ".zip", ".gz"})
    (SHIP / "SHA256SUMS").write_text(sums)
    print(written(table))
    print(f"All in {SHIP}.")


def linked_twice(platform):
    """The library, linked anew from objects that may be there already, twice: both must be the same. zig remembers what it
    has linked, so each time it gets an empty memory; what it has of the systems' libraries is elsewhere."""
    made = []
    logged("cmake", "--preset", platform)
    for _ in range(2):
        memory = tempfile.TemporaryDirectory()
        os.environ["ZIG_LOCAL_CACHE_DIR"] = memory.name
        for old in (ROOT / "build" / platform).glob("*partwheel.*"):
            if old.suffix in {".so", ".dll", ".dylib"} or ".so." in old.name or old.name.endswith(".dylib"):
                old.unlink()
        logged("cmake", "--build", "--preset", platform, "--target", "partwheel", "--parallel", str(os.cpu_count()))
        stage = ROOT / "build" / platform / "stage"
        logged("cmake", "--install", ROOT / "build" / platform, "--component", "python", "--prefix", stage)
        made.append((stage / library_of(platform)).read_bytes())
        memory.cleanup()
    del os.environ["ZIG_LOCAL_CACHE_DIR"]
    if made[0] != made[1]:
        raise SystemExit(f"The library for {platform} is another one each time that it is linked.")
    return stage / library_of(platform)


def wheel_of(platform):
    """The wheel, with the library that was built already."""
    made = SHIP / "made"
    define = "--config-settings=cmake.define."
    logged("pip", "wheel", "--no-deps", "--no-build-isolation", "--wheel-dir", made, ROOT,
           f"--config-settings=build-dir=build/{platform}",
           f"{define}CMAKE_TOOLCHAIN_FILE={ROOT / 'cmake/cross/zig.cmake'}", f"{define}PARTWHEEL_PLATFORM={platform}")
    logged("wheel", "tags", "--remove", "--python-tag", "py3", "--abi-tag", "none", "--platform-tag", TAGS[platform],
           *made.glob("*.whl"))
    (wheel,) = made.glob("*.whl")
    wheel = wheel.replace(SHIP / wheel.name)
    made.rmdir()
    with zipfile.ZipFile(wheel) as archive:
        inside = archive.read(f"partwheel/{library_of(platform)}")
    if inside != (ROOT / "build" / platform / "stage" / library_of(platform)).read_bytes():
        raise SystemExit(f"{wheel.name} holds another library than the one that was checked.")
    return wheel


def written(table):
    columns = ["exports", "least", "needs", "signed", "twice", "run"]
    rows = [["platform", *columns]] + [[platform, *(found.get(column) or "-" for column in columns)]
                                       for platform, found in table.items()]
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    return "\n".join("  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in rows)


def logged(*command):
    with LOG.open("a") as log:
        print("\n$", *command, file=log, flush=True)
        if subprocess.run(list(map(str, command)), cwd=ROOT, stdout=log, stderr=subprocess.STDOUT).returncode:
            sys.exit("".join(LOG.read_text().splitlines(keepends=True)[-40:]) + f"This failed: {command[0]}, see {LOG}")


if __name__ == "__main__":
    main()
