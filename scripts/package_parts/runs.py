"""The libraries run, as far as this machine can, Windows' under wine and ARM's under qemu: the C example finds the parts of
real models with each, and all must save the same bytes."""

import hashlib
import os
import platform as machine
import subprocess
import time

from platforms import ROOT, library_of

RUN = ROOT / "build" / "run"
MESHES = ROOT / "build" / "deps" / "meshes"
# Taken exactly, repaired, and filled from points.
MODELS = ("hand.off", "bear.off", "lion-head.off", "elephant-with-holes.off")
FACE = 100
HERE = {"x86_64": "linux-x64", "aarch64": "linux-arm64"}[machine.machine()]
WINE = {"WINEPREFIX": str(RUN / "wine"), "WINEDEBUG": "-all"}
# What runs a platform's programs here; those of all others can't be run.
RUNNERS = {HERE: ([], {}), "windows-x64": (["/usr/lib/wine/wine64"], WINE)}
RUNNERS.setdefault("linux-arm64", (["qemu-aarch64-static", "-L", "/usr/aarch64-linux-gnu"], {}))


def run(platforms):
    """{platform: what became of it, for the table}. Raises SystemExit where bytes differ."""
    RUN.mkdir(parents=True, exist_ok=True)
    told, first = {}, None
    for platform in sorted(set(platforms), key=lambda each: each != HERE):
        if platform not in RUNNERS:
            told[platform] = "linked only, never run"
            continue
        program = example(platform)
        runner, environment = RUNNERS[platform]
        sums, seconds = [], 0
        for model in (MODELS[0], *MODELS):  # at its first start wine sets itself up
            saved = program.parent / "saved"
            saved.unlink(missing_ok=True)
            began = time.monotonic()
            subprocess.run([*runner, program, MESHES / model, str(FACE), saved], check=True, cwd=program.parent,
                           env={**os.environ, **environment, "LD_LIBRARY_PATH": str(program.parent)},
                           stdout=subprocess.DEVNULL)
            seconds = seconds + time.monotonic() - began if sums else 0
            sums.append(hashlib.sha256(saved.read_bytes()).hexdigest())
        first = first or (platform, sums)
        if sums != first[1]:
            raise SystemExit(f"{platform} saves other trees than {first[0]}: {sums} {first[1]}")
        how = f" by {os.path.basename(runner[0])}" if runner else ""
        same = "" if platform == first[0] else f", trees as {first[0]}'s"
        told[platform] = f"run{how}: {len(MODELS)} models{same}, {seconds:.1f} s"
    return told


def example(platform):
    """native/examples/wheel.c, compiled for the platform, beside the library."""
    place = RUN / platform
    place.mkdir(parents=True, exist_ok=True)
    build = ROOT / "build" / platform
    (zig,) = (ROOT / "build/venv/cross").glob("lib/python3*/site-packages/ziglang/zig")
    target = {"linux-x64": "x86_64-linux-gnu.2.28", "linux-arm64": "aarch64-linux-gnu.2.28",
              "windows-x64": "x86_64-windows-gnu"}[platform]
    libraries = [path for path in build.glob("libpartwheel.dll.a" if platform == "windows-x64" else "libpartwheel.so*")]
    for path in [*libraries, build / "stage" / library_of(platform)]:
        if not path.name.endswith(".a"):
            (place / path.name).write_bytes(path.read_bytes())
    program = place / ("wheel.exe" if platform == "windows-x64" else "wheel")
    subprocess.run([zig, "cc", "-target", target, "-std=c11", "-O2", "-Wall", "-Wextra", "-Werror", "-I",
                    ROOT / "native/include", ROOT / "native/examples/wheel.c", libraries[0], "-o", program], check=True)
    return program
