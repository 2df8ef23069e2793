"""Runs the C example with the libraries, for Windows under wine and for ARM under qemu, on real models. All libraries
must save the same bytes."""

import hashlib
import os
import platform as machine
import subprocess
import time

from platforms import ROOT, library_of

RUN = ROOT / "build" / "run"
MESHES = ROOT / "build" / "deps" / "meshes"
# Filled exactly, after repair, and from points.
MODELS = ("hand.off", "bear.off", "lion-head.off", "elephant-with-holes.off")
FACE = 100  # that the example clicks
THIS_PLATFORM = {"x86_64": "linux-x64", "aarch64": "linux-arm64"}[machine.machine()]
WINE = {"WINEPREFIX": str(RUN / "wine"), "WINEDEBUG": "-all"}
# Platform -> (emulator, environment variables). Programs for other platforms can't run here.
RUNNERS = {THIS_PLATFORM: ([], {}), "windows-x64": (["/usr/lib/wine/wine64"], WINE)}
RUNNERS.setdefault("linux-arm64", (["qemu-aarch64-static", "-L", "/usr/aarch64-linux-gnu"], {}))


def run(platforms):
    """{platform: result, for the table}. Raises SystemExit if the saved bytes differ."""
    RUN.mkdir(parents=True, exist_ok=True)
    results, first = {}, None
    for platform in sorted(set(platforms), key=lambda platform: platform != THIS_PLATFORM):
        if platform not in RUNNERS:
            results[platform] = "linked only, never run"
            continue
        program = example(platform)
        runner, environment = RUNNERS[platform]
        sums, seconds = [], 0
        for model in (MODELS[0], *MODELS):  # the first run is not timed, since wine initializes itself
            saved = program.parent / "saved"
            saved.unlink(missing_ok=True)
            start = time.monotonic()
            subprocess.run([*runner, program, MESHES / model, str(FACE), saved], check=True, cwd=program.parent,
                           env={**os.environ, **environment, "LD_LIBRARY_PATH": str(program.parent)},
                           stdout=subprocess.DEVNULL)
            seconds = seconds + time.monotonic() - start if sums else 0
            sums.append(hashlib.sha256(saved.read_bytes()).hexdigest())
        first = first or (platform, sums)
        if sums != first[1]:
            raise SystemExit(f"{platform} saves other trees than {first[0]}: {sums} {first[1]}")
        emulator = f" by {os.path.basename(runner[0])}" if runner else ""
        comparison = "" if platform == first[0] else f", trees as {first[0]}'s"
        results[platform] = f"run{emulator}: {len(MODELS)} models{comparison}, {seconds:.1f} s"
    return results


def example(platform):
    """Compiles native/examples/wheel.c for the platform, next to the library; returns its path."""
    folder = RUN / platform
    folder.mkdir(parents=True, exist_ok=True)
    build = ROOT / "build" / platform
    (zig,) = (ROOT / "build/venv/cross").glob("lib/python3*/site-packages/ziglang/zig")
    target = {"linux-x64": "x86_64-linux-gnu.2.28", "linux-arm64": "aarch64-linux-gnu.2.28",
              "windows-x64": "x86_64-windows-gnu"}[platform]
    libraries = [path for path in build.glob("libpartwheel.dll.a" if platform == "windows-x64" else "libpartwheel.so*")]
    for path in [*libraries, build / "stage" / library_of(platform)]:
        if not path.name.endswith(".a"):
            (folder / path.name).write_bytes(path.read_bytes())
    program = folder / ("wheel.exe" if platform == "windows-x64" else "wheel")
    subprocess.run([zig, "cc", "-target", target, "-std=c11", "-O2", "-Wall", "-Wextra", "-Werror", "-I",
                    ROOT / "native/include", ROOT / "native/examples/wheel.c", libraries[0], "-o", program], check=True)
    return program
