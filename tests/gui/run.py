"""The GUI tier, seen from outside Blender: installs the zip, runs each scenario in a Blender window, collects results.

    build/venv/core/bin/python tests/gui/run.py [--large] ZIP RESULT.json [SCENARIO ...]

Every file of scenarios/ is one scenario and runs in a Blender process and an X server (Xvfb, software GL) of its own,
with the add-on installed from ZIP into a home directory of its own (Blender saves preferences when it quits). A
scenario passes if it reports no failure and at least one check, Blender quits without a crash, and the log holds no
traceback. Screenshots and logs go to build/gui, and so does Blender's own report of a crash, which is printed as well.
RESULT.json: {"passed": n, "failed": n, "failures": [sentence, ...], "skipped": ["scenario: why", ...], "seconds": {scenario: s}}.
Exit code: 0 if all passed or were skipped.

PARTWHEEL_BLENDER names another Blender than the one on the PATH.
"""
import argparse
import concurrent.futures
import contextlib
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import zipfile

import numpy

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
OUTPUT = ROOT / "build" / "gui"
MESHES = ROOT / "build" / "deps" / "meshes"
MODELS = {"hand": "hand.off", "homer": "homer.off", "bear": "bear.off", "armadillo": "armadillo.off",
          "elephant": "refined_elephant.off", "dino": "dino.off", "figure": "figure", "dog": "dog", "character": "figure",
          "large": "armadillo.off", "million": "lion-head.off", "shells": "shells"}  # files, or names of examples
SUBDIVIDED = {"large": 1, "million": 3}  # so often: 208,000 and 1,067,000 faces
FINER = {"character": 0.0126}  # the size of an example's faces: 50,000 faces
ONLY_SHAPE = {"character", "million"}  # what its parts are is not compared with
PATH = "/usr/sbin:/usr/bin:/sbin:/bin"
BLENDER = os.environ.get("PARTWHEEL_BLENDER", "blender")
PROGRAMS = (BLENDER, "Xvfb", "xdotool", "import")
TIME_LIMIT = 3600  # seconds a scenario, so that nothing hangs forever: a hundred times what most take
# Scenarios that run a second time with real input: X events made by xdotool instead of Blender's event_simulate.
# Those that measure take long on a busy machine: scripts/bench_latency. The
# repository is for newer Blenders.
ONLY_BY_NAME = ("front", "latency", "latency_million", "latency_modes", "latency_shells", "repository")
ALSO_WITH_XDOTOOL = ("assembly", "cancel_convex", "pick_and_click", "empty_space", "navigate")
# Pixels of a window. Most of a scenario's time goes into drawing, by the processor: a third less in a small one, in
# which not all texts fit; and half of the rest if nothing is drawn that no test looks at, see Stage.
SMALL, LARGE = (960, 640), (1280, 800)
ALWAYS_LARGE = ("industry_keymap", "picked_objects", "related", "tool_keys", *ONLY_BY_NAME)

sys.path.insert(0, str(HERE))
from model import read_off, small_shells, subdivided  # noqa: E402


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("zip", type=pathlib.Path, help="the add-on as made by scripts/package")
    parser.add_argument("result", type=pathlib.Path, help="where to write the result (JSON)")
    parser.add_argument("scenario", nargs="*", help="run only these (names of files in scenarios/)")
    parser.add_argument("--large", action="store_true", help="large windows in which all is drawn, as for pictures")
    arguments = parser.parse_args()

    known = sorted(path.stem for path in (HERE / "scenarios").glob("*.py"))
    unknown = sorted({*arguments.scenario, *ALSO_WITH_XDOTOOL} - {*known})
    if unknown:
        parser.error(f"no such scenario: {', '.join(unknown)}")
    missing = [program for program in PROGRAMS if not shutil.which(program, path=PATH)]
    if missing:
        sys.exit(f"Install {', '.join(missing)} first: scripts/test gui does that.")
    names = arguments.scenario or [name for name in known if name not in ONLY_BY_NAME]
    runs = [(name, driver) for name in names for driver in ("simulate", "xdotool")
            if driver == "simulate" or name in ALSO_WITH_XDOTOOL]

    OUTPUT.mkdir(parents=True, exist_ok=True)
    if not arguments.scenario:
        for old in (*OUTPUT.glob("*.png"), *OUTPUT.glob("*.log")):
            old.unlink()
    with tempfile.TemporaryDirectory(prefix="partwheel-gui-") as work:
        work = pathlib.Path(work)
        environment = clean_environment(work)
        prepare_models(arguments.zip, work, names)
        install(arguments.zip, environment)
        # Twice as many at once as there are cores: each waits half of the time for its own window.
        with concurrent.futures.ThreadPoolExecutor(2 * os.cpu_count()) as pool:
            plays = list(pool.map(lambda run: played(*run, arguments.large, work, environment), runs))
    failures = [f"{title}: {failure}" for title, failure, _, _ in plays if failure]
    skipped = [f"{title}: {reason}" for title, failure, reason, _ in plays if reason and not failure]
    result = {"passed": len(runs) - len(failures) - len(skipped), "failed": len(failures), "failures": failures,
              "skipped": skipped, "seconds": {title: seconds for title, _, _, seconds in plays}}
    arguments.result.write_text(json.dumps(result, indent=1) + "\n")
    print(f"GUI: {result['passed']} passed, {result['failed']} failed")
    return 1 if failures else 0


class Failed(Exception):
    """A scenario failed. The message says how."""


def played(name, driver, large, work, environment):
    """Runs a scenario and says how it went; returns (its title, what failed or "", why it was skipped or "", seconds)."""
    start_time = time.monotonic()
    size = LARGE if large or name in ALWAYS_LARGE else SMALL
    looks = "full" if large or name in ONLY_BY_NAME else "plain"
    title, failure, skipped = f"{name} ({driver})", "", ""
    try:
        checks, skipped = run_scenario(name, driver, size, looks, work, environment)
        outcome = f"skipped, {skipped}" if skipped else f"ok, {checks} checks"
    except Failed as error:
        failure = outcome = str(error)
    seconds = time.monotonic() - start_time
    print(f"{title}: {outcome}, {seconds:.1f} s", flush=True)
    return title, failure, skipped, seconds


def clean_environment(work):
    """Nothing of the caller's environment but our own switches reaches Blender: another Python on the PATH would break
    it."""
    for name in ("home", "tmp"):
        (work / name).mkdir()
    cache = OUTPUT / "shader-cache"
    cache.mkdir(exist_ok=True)
    own_variables = {name: value for name, value in os.environ.items() if name.startswith("PARTWHEEL_")}
    one_thread = {"OPENBLAS_NUM_THREADS": "1", "LP_NUM_THREADS": "1"}  # numpy, and Mesa's drawing: several run at once
    return {**own_variables, **one_thread, "PATH": PATH, "HOME": str(work / "home"), "TMPDIR": str(work / "tmp"),
            "LIBGL_ALWAYS_SOFTWARE": "1", "MESA_SHADER_CACHE_DIR": str(cache), "LANG": "C.UTF-8"}


def prepare_models(zip_path, work, names):
    """Writes what these scenarios compare with: the hierarchies, built outside Blender by the package that the zip holds.

    MODEL.npz: order, first, last as in partwheel.h; the wheel stops of all faces one after the other in stops, those of
    face f being stops[offset[f]:offset[f + 1]]; start (F,). Coordinates are rounded to what a Blender mesh can hold.
    Of ONLY_SHAPE: vertices and triangles alone.
    """
    with zipfile.ZipFile(zip_path) as archive:
        archive.extractall(work / "zip")
    for wheel in (work / "zip").glob("*/wheels/*.whl"):
        with zipfile.ZipFile(wheel) as archive:
            archive.extractall(wheel.parents[1] / "packages")
    sys.path.insert(0, str(next((work / "zip").glob("*/packages"))))
    from partwheel import Hierarchy, examples

    scripts = "".join((HERE / "scenarios" / f"{name}.py").read_text() for name in names)
    for name in (name for name in MODELS if f'"{name}"' in scripts):
        if name == "shells":
            vertices, triangles = small_shells()
        elif MODELS[name] in examples.EXAMPLES:
            example = examples.EXAMPLES[MODELS[name]](*filter(None, [FINER.get(name)]))
            vertices, triangles = example.vertices, example.triangles
        else:
            vertices, triangles = read_off(MESHES / MODELS[name])
        for _ in range(SUBDIVIDED.get(name, 0)):
            vertices, triangles = subdivided(vertices, triangles)
        if name in ONLY_SHAPE:
            numpy.savez(work / f"{name}.npz", vertices=vertices, triangles=triangles)
            continue
        hierarchy = Hierarchy.build(vertices.astype(numpy.float32).astype(float), triangles)
        wheels = [hierarchy.wheel(face) for face in range(len(triangles))]
        numpy.savez(work / f"{name}.npz", vertices=vertices, triangles=triangles,
                    order=hierarchy.order, first=hierarchy.first, last=hierarchy.last,
                    stops=numpy.concatenate([stops for stops, _ in wheels]),
                    offset=numpy.cumsum([0] + [len(stops) for stops, _ in wheels]),
                    start=numpy.array([start for _, start in wheels]))


def install(zip_path, environment):
    log = OUTPUT / "install.log"
    with log.open("w") as output:
        command = [BLENDER, "-b", "-noaudio", "--python-exit-code", "9", "--python", HERE / "install.py", "--",
                   zip_path.resolve()]
        code = subprocess.run(command, env=environment, stdout=output, stderr=output, timeout=TIME_LIMIT).returncode
    if code or "Traceback" in log.read_text():
        sys.exit(f"The add-on could not be installed from {zip_path}: see {log}.")


def run_scenario(name, driver, size, looks, work, environment):
    """Returns (number of checks made, why it was skipped or ""). Raises Failed."""
    title = name if driver == "simulate" else f"{name}-{driver}"
    result_path, log_path = work / f"{title}.json", OUTPUT / f"{title}.log"
    command = [BLENDER, "-noaudio", "--window-geometry", "0", "0", *map(str, size), "--python-exit-code", "9",
               *(["--enable-event-simulate"] if driver == "simulate" else []),
               "--python", HERE / "inside.py", "--", name, driver, looks, work, OUTPUT / title, result_path]
    home, temporary = work / "homes" / title, work / "tmp" / title
    shutil.copytree(environment["HOME"], home, symlinks=True)
    temporary.mkdir()
    with x_server(size, environment) as display, log_path.open("w") as log:
        try:
            scenario_environment = environment | {"HOME": str(home), "TMPDIR": str(temporary), "DISPLAY": display}
            code = subprocess.run(command, env=scenario_environment, stdout=log, stderr=log, stdin=subprocess.DEVNULL, cwd=work,
                                  timeout=TIME_LIMIT).returncode
        except subprocess.TimeoutExpired:
            raise Failed(f"Blender was still running after {TIME_LIMIT} s, see {log_path}") from None
    for report in temporary.glob("*.crash.txt"):
        print(report.read_text(errors="replace"), flush=True)
        report.rename(OUTPUT / f"{title}.crash.txt")
    result = json.loads(result_path.read_text()) if result_path.exists() else None
    if "Traceback" in log_path.read_text(errors="replace"):
        raise Failed(f"a traceback in {log_path}")
    if result is None:
        raise Failed(f"Blender ended with code {code} and no result, see {log_path}")
    if result["failure"]:
        raise Failed(result["failure"])
    if code not in (0, 1):  # 1 is Blender's answer to quitting after a real Esc key: its flag for "break" is still set
        raise Failed(f"Blender ended with code {code}, see {log_path}")
    if not result["checks"]:
        raise Failed("the scenario checked nothing")
    return result["checks"], result["skipped"]


@contextlib.contextmanager
def x_server(size, environment):
    """An X server that picks a free display number itself; yields its name."""
    reading, writing = os.pipe()
    screen = "{}x{}x24".format(*size)
    server = subprocess.Popen(["Xvfb", "-displayfd", str(writing), "-screen", "0", screen, "-nolisten", "tcp"],
                              env=environment, pass_fds=[writing], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    os.close(writing)
    try:
        with os.fdopen(reading) as pipe:
            number = pipe.readline().strip()
        if not number:
            raise SystemExit("Xvfb did not start.")
        yield f":{number}"
    finally:
        server.terminate()
        server.wait()


if __name__ == "__main__":
    sys.exit(main())
