"""Builds everything that a release contains, for all platforms or some: libraries, wheels, Blender extensions, legacy add-ons,
a repository folder, the source distribution, and notes and pictures for the release page. Checks it, and prints a table of the
results. scripts/package runs it in build/venv/package.

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
import release_page
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
        library = build_library(platform)
        table[platform] = {**checks.check(library, platform), "twice": "same bytes"}
        wheels.append(build_wheel(platform))
    print("package: running the libraries, where possible", flush=True)
    for platform, result in runs.run(platforms).items():
        table[platform]["run"] = result
    print("package: add-ons and repositories for Blender", flush=True)
    for wheel in wheels:
        zips.legacy(wheel)
    blender.extensions(wheels, SHIP)
    blender.repository(wheels, SHIP, SHIP / "repository")
    if "linux-x64" in platforms:
        print("package: the source distribution", flush=True)
        source.distribution(SHIP, [ROOT / "build" / platform for platform in platforms])
    release_page.write(SHIP)
    run_logged("twine", "check", "--strict", *SHIP.glob("*.whl"), *SHIP.glob("*.tar.gz"))
    run_logged("check-wheel-contents", *SHIP.glob("*.whl"))
    sums = "".join(f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}\n"
                   for path in sorted(SHIP.iterdir()) if path.suffix in {".whl", ".zip", ".gz"})
    (SHIP / "SHA256SUMS").write_text(sums)
    print(format_table(table))
    print(f"All packages are in {SHIP}.")


def build_library(platform):
    """Builds the library and links it twice, to check that linking is reproducible; returns its path. Each time, zig's cache of
    linked files is empty. zig keeps system libraries in another cache."""
    libraries = []
    run_logged("cmake", "--preset", platform)
    for _ in range(2):
        cache = tempfile.TemporaryDirectory()
        os.environ["ZIG_LOCAL_CACHE_DIR"] = cache.name
        for old in (ROOT / "build" / platform).glob("*partwheel.*"):
            if old.suffix in {".so", ".dll", ".dylib"} or ".so." in old.name or old.name.endswith(".dylib"):
                old.unlink()
        run_logged("cmake", "--build", "--preset", platform, "--target", "partwheel", "--parallel", str(os.cpu_count()))
        stage = ROOT / "build" / platform / "stage"
        run_logged("cmake", "--install", ROOT / "build" / platform, "--component", "python", "--prefix", stage)
        libraries.append((stage / library_of(platform)).read_bytes())
        cache.cleanup()
    del os.environ["ZIG_LOCAL_CACHE_DIR"]
    if libraries[0] != libraries[1]:
        raise SystemExit(f"Linking the library for {platform} is not reproducible.")
    return stage / library_of(platform)


def build_wheel(platform):
    """Builds the wheel with the library that build_library() built; returns its path."""
    folder = SHIP / "untagged"
    define = "--config-settings=cmake.define."
    run_logged("pip", "wheel", "--no-deps", "--no-build-isolation", "--wheel-dir", folder, ROOT,
               f"--config-settings=build-dir=build/{platform}",
               f"{define}CMAKE_TOOLCHAIN_FILE={ROOT / 'cmake/cross/zig.cmake'}", f"{define}PARTWHEEL_PLATFORM={platform}")
    run_logged("wheel", "tags", "--remove", "--python-tag", "py3", "--abi-tag", "none", "--platform-tag", TAGS[platform],
               *folder.glob("*.whl"))
    (wheel,) = folder.glob("*.whl")
    wheel = wheel.replace(SHIP / wheel.name)
    folder.rmdir()
    with zipfile.ZipFile(wheel) as archive:
        packed = archive.read(f"partwheel/{library_of(platform)}")
    if packed != (ROOT / "build" / platform / "stage" / library_of(platform)).read_bytes():
        raise SystemExit(f"{wheel.name} does not contain the library that was checked.")
    return wheel


def format_table(table):
    columns = ["exports", "minimum", "needs", "signed", "twice", "run"]
    rows = [["platform", *columns]] + [[platform, *(results.get(column) or "-" for column in columns)]
                                       for platform, results in table.items()]
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    return "\n".join("  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in rows)


def run_logged(*command):
    """Runs a command with its output in the log; ends the program with the end of the log if it fails."""
    with LOG.open("a") as log:
        print("\n$", *command, file=log, flush=True)
        if subprocess.run(list(map(str, command)), cwd=ROOT, stdout=log, stderr=subprocess.STDOUT).returncode:
            sys.exit("".join(LOG.read_text().splitlines(keepends=True)[-40:]) + f"{command[0]} failed, see {LOG}")


if __name__ == "__main__":
    main()
