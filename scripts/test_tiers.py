"""The test tiers, one function each: sets up what it needs, runs it, returns what passed and failed.

Called by scripts/test. Everything that runs writes to build/test/TIER*.log; the screen shows the end of what failed.
"""

import argparse
import concurrent.futures
import dataclasses
import functools
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time
import xml.etree.ElementTree

ROOT = pathlib.Path(__file__).resolve().parents[1]
OUTPUT = ROOT / "build" / "test"
VENV = ROOT / "build" / "venv"
BENCHMARK = ROOT.parent / "shared" / "psb" / "tune.tar.xz"  # of which the tier quality scores a part
TIME_LIMIT = 4 * 3600  # seconds for any one command, so that nothing hangs for ever; many times what any takes
SHOWN = 60  # lines of a failed command's output
# The scenarios that the newest Blender plays: those where Blenders differed, and each way of use once. With
# PARTWHEEL_NEWEST=all these too: all but those that build large models, measure, or only make pictures.
NEWEST = ("bones", "cage", "compose_finger", "deform_keys", "deform_more", "gather", "hands", "industry", "linked", "modes",
          "move", "navigate", "panel", "parts_to", "picked_objects", "related", "seen", "three_clicks", "tool",
          "ways", "wheel_at_click", "windows")
MORE_OF_NEWEST = ("adjust", "anything", "beyond", "blender_itself", "confirm_enter", "creases", "deform",
                  "deform_within", "duplicate", "empty_space", "left_out", "limits", "menu", "open_mesh", "overlays",
                  "pick_and_click", "quad_view", "restore", "select_modes", "while_building")
THREADED = "[Tt]hread|Cancel|Progress"  # the names of tests in which threads meet


class CouldNotRun(Exception):
    """What a tier needs could not be set up or built. The message says why."""


@dataclasses.dataclass
class Result:
    passed: int = 0
    failed: int = 0
    skipped: int = 0
    failures: list = dataclasses.field(default_factory=list)

    def __iadd__(self, other):
        self.passed += other.passed
        self.failed += other.failed
        self.skipped += other.skipped
        self.failures += other.failures
        return self


def native():
    """GoogleTest through CTest, as shipped."""
    build("native", "release")
    return ctest("native", "release")


def sanitizers():
    """The native tests and the core tests again, watched by AddressSanitizer and UndefinedBehaviorSanitizer; the latter
    in a host program whose numbers have a comma."""
    build("sanitizers", "asan")
    result = ctest("sanitizers-native", "asan")
    # Python isn't linked with the runtimes, so they are loaded before it; its own leaks are not looked at.
    runtimes = " ".join(output_of("g++", f"-print-file-name={name}") for name in ("libasan.so", "libstdc++.so"))
    result += pytest("sanitizers-core", "tests/core", LD_PRELOAD=runtimes, ASAN_OPTIONS="detect_leaks=0",
                     UBSAN_OPTIONS="print_stacktrace=1", PARTWHEEL_TEST_LIGHT="1", PARTWHEEL_TEST_COMMA="1",
                     PARTWHEEL_LIBRARY=str(ROOT / "build/asan/libpartwheel.so"))
    return result


def threads():
    """The native tests that use threads, watched by ThreadSanitizer."""
    programs = [path.stem for path in sorted((ROOT / "tests" / "native").glob("*_test.cpp"))
                if re.search(THREADED, path.stem + "".join(re.findall(r"^TEST.*", path.read_text(), re.MULTILINE)))]
    build("threads", "tsan", *programs)
    return ctest("threads", "tsan", "--tests-regex", THREADED)


def fuzz():
    """The fuzzers of the C API's three entrances, for some seconds each, watched by the sanitizers."""
    build("fuzz", "fuzz", "mesh_fuzzer", "saved_fuzzer", "surface_fuzzer")
    build("fuzz", "release", "partwheel")  # makes the seeds
    return pytest("fuzz", "tests/fuzz")


def determinism():
    """The same bits from g++ and clang, optimized or not, with AVX2 or without, in one thread or two."""
    for preset in ("release", "clang", "avx2", "unoptimized"):
        build("determinism", preset, "partwheel")
    return pytest("determinism", "tests/determinism")


def core():
    """The Python package as installed from its wheel, and the installed library, without Blender."""
    setup("core", "setup_core")
    build("core", "release", "partwheel", "partwheel_checks")
    make_packages()
    return pytest("core", "tests/core", PARTWHEEL_PACKAGES=installed("core"))


def batch():
    """partwheel batch as installed from the wheel: hostile files, kills, Ctrl-C, its report in a browser."""
    setup("batch", "setup_batch")
    make_packages()
    return pytest("batch", "tests/batch", "batch", PARTWHEEL_PACKAGES=installed("batch"))


def reliability():
    """Every model there is: built, or a sheet and named so, and no crash; a table in build/test."""
    build("reliability", "release", "partwheel")
    setup("reliability", "setup_blender")  # whose primitives are among the models
    return pytest("reliability", "tests/reliability")


def quality():
    """How well parts are selected: 24 models of the benchmark where it is, and mirror images, against floors."""
    build("quality", "release", "partwheel")
    build("quality", "bench", "quality_trace")
    if os.environ.get("PARTWHEEL_PSB") or BENCHMARK.exists():
        setup("quality", "setup_psb")
    else:
        print(f"   SKIPPED all but libcgal-demo's symmetric models: {BENCHMARK} is not here")
    return pytest("quality", "tests/quality")


def addon():
    """The add-on as installed from the zip, without a window, in the distribution's Blender and in bpy from PyPI."""
    extension, legacy = make_packages()
    setup("addon", "setup_core", "setup_blender", "setup_bpy")
    versions = output_of("bash", "-c", ". scripts/setup.sh && echo $bpy_versions").split()
    interpreters = {"blender": ["blender", "-b", "-noaudio", "--factory-startup", "--python-exit-code", "9", "--python",
                                "tests/addon/run.py", "--"]}
    for version in versions:
        interpreters[f"bpy-{version}"] = [VENV / f"bpy-{version}/bin/python", "tests/addon/run.py", "--"]

    def one(name):
        home = OUTPUT / "home" / name  # a new one, so that nothing installed before is there
        shutil.rmtree(home, ignore_errors=True)
        home.mkdir(parents=True)
        clean = {"PATH": os.environ["PATH"], "HOME": str(home), "LANG": "C.UTF-8"}
        clean |= {name: value for name, value in os.environ.items()
                  if name in {"PARTWHEEL_UNITES", "PARTWHEEL_UNITES_SEED", "PARTWHEEL_EVENTS"}}
        return own_runner(f"addon-{name}", [*interpreters[name], legacy if name == "blender" else extension],
                          clean)

    result = Result()
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for each in pool.map(one, interpreters):
            result += each
    return result


def gui():
    """Blender's own window under Xvfb, driven by mouse and key events."""
    _, legacy = make_packages()
    setup("gui", "setup_core", "setup_blender", "setup_display")
    return own_runner("gui", [VENV / "core/bin/python", "tests/gui/run.py", legacy], dict(os.environ))


def newest():
    """Scenarios of the GUI tier in the newest Blender that Debian has. It moves: without it they are skipped."""
    extension, _ = make_packages()
    result = Result()
    for suite in os.environ.get("PARTWHEEL_SUITES", "sid").split():
        result += in_suite(suite, extension)
    return result


def in_suite(suite, package):
    """The same in another Debian's Blender."""
    log = f"newest-{suite}"
    scenarios = NEWEST + (MORE_OF_NEWEST if os.environ.get("PARTWHEEL_NEWEST") == "all" else ())
    try:
        setup(log, "setup_core", "setup_build", f"setup_newest {suite}")
    except CouldNotRun as reason:
        print(f"   SKIPPED the Blender of Debian {suite}: {reason}")
        return Result(skipped=len(scenarios))
    inside = ROOT / f"build/deps/blender-{suite}"
    room = inside / "partwheel"  # nothing is mounted: what the scenarios need is copied
    shutil.rmtree(room, ignore_errors=True)
    for tests in ("tests/gui", "tests/faults"):
        shutil.copytree(ROOT / tests, room / tests)
    shutil.copytree(ROOT / "build/deps/meshes", room / "build/deps/meshes")
    shutil.copy(package, room)
    clean = {"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "HOME": "/root", "LANG": "C.UTF-8"}
    command = ["chroot", inside, "python3", "/partwheel/tests/gui/run.py", f"/partwheel/{package.name}",
               "/partwheel/result.json", *scenarios]
    return own_runner(log, command, clean, room / "result.json")


def ship():
    """The packages for all platforms, made, run where they can be, and installed as strangers do; and the native tests of
    this machine and of the two that are for others, by wine and qemu. An hour of compiling: only when it is named."""
    require("ship-package", "scripts/package", "all")
    print((OUTPUT / "ship-package.log").read_text().split("distribution\n")[-1], end="")
    setup("ship", "setup_bpy", "setup_workflows")
    result = pytest("ship", "tests/ship")
    for preset in ("release", "windows-x64", "linux-arm64"):  # the first: how long this machine takes of itself
        build(f"ship-{preset}", preset)
        began = time.monotonic()
        native = ctest(f"ship-{preset}", preset, "--test-output-truncation", "head")
        print(f"   {preset}: {gtests(f'ship-{preset}')} native tests passed in {time.monotonic() - began:.0f} s")
        result += native
    return result


TIERS = {function.__name__: function
         for function in (native, sanitizers, threads, determinism, fuzz, core, batch, quality, reliability, addon, gui,
                          newest, ship)}


def main():
    parser = argparse.ArgumentParser(prog="scripts/test", description="Runs the test tiers but ship, or only those named.")
    parser.add_argument("tier", nargs="*", help=" ".join(TIERS))
    names = parser.parse_args().tier or [name for name in TIERS if name != "ship"]
    for name in names:
        if name not in TIERS:
            parser.error(f"there is no tier {name}: {', '.join(TIERS)}")

    OUTPUT.mkdir(parents=True, exist_ok=True)
    total = Result()
    lines = []
    for name in names:
        print(f"== {name}: {TIERS[name].__doc__}")
        began = time.monotonic()
        try:
            result = TIERS[name]()
        except CouldNotRun as reason:
            result = broken(f"{name} could not run: {reason}")
        for failure in result.failures:
            print(f"   FAILED {failure}")
        skipped = f", {result.skipped} skipped" if result.skipped else ""
        lines.append(f"{name:<12}{result.passed} passed, {result.failed} failed{skipped}, "
                     f"{time.monotonic() - began:.0f} s")
        print(f"   {lines[-1]}")
        total += result

    print("== all tiers")
    print("".join(f"   {line}\n" for line in lines), end="")
    print(f"{total.passed} passed, {total.failed} failed")
    return 1 if total.failed else 0


# ---- Steps of the tiers


def setup(log, *functions):
    require(log, "bash", "-euc", f". scripts/setup.sh; {'; '.join(functions)}")


def build(log, preset, *targets):
    require(log, "scripts/build", preset, *targets)


@functools.cache
def make_packages():
    """The add-on for Blender 4.2 and later, and the legacy one: made once for all tiers that need them."""
    require("package", "scripts/package")
    return tuple(map(pathlib.Path, (OUTPUT / "package.log").read_text().splitlines()[-2:]))


def installed(venv):
    """A folder with the package in it as its wheel has it."""
    packages = OUTPUT / f"packages-{venv}"
    shutil.rmtree(packages, ignore_errors=True)
    require(venv, VENV / venv / "bin/python", "-m", "pip", "install", "--no-deps", "--target", packages,
            *(ROOT / "build/package").glob("*.whl"))
    return str(packages)


def ctest(log, preset, *options):
    report = fresh(log, "xml")
    code = run(log, ["ctest", "--preset", preset, "--parallel", str(os.cpu_count()), "--output-junit", report,
                     *options])
    return read_junit(log, report, code)


def gtests(log):
    """How many of GoogleTest's tests passed: ctest runs whole programs where it takes long to start one."""
    passed = re.findall(r"\[  PASSED  \] (\d+) test", (OUTPUT / f"{log}.xml").read_text(errors="replace"))
    return sum(map(int, passed))


def pytest(log, tests, venv="core", **environment):
    setup(log, f"setup_{venv}")
    report = fresh(log, "xml")
    command = [VENV / venv / "bin/python", "-m", "pytest", "-rs", "-p", "no:cacheprovider", "--capture=sys",
               f"--junitxml={report}", tests]  # what a dying library writes reaches the log
    code = run(log, command, os.environ | environment)
    return read_junit(log, report, code)


def own_runner(log, command, environment, report=None):
    """Runs tests/addon/run.py or tests/gui/run.py, which write {"passed": n, "failed": n, "failures": [...]}. report:
    where the command writes it, if it isn't to be told."""
    if report is None:
        report = fresh(log, "json")
        command = [*command, report]
    code = run(log, command, environment)
    if not report.exists():
        return broken(f"{log} ended with code {code} and no result, see {log_of(log)}")
    values = json.loads(report.read_text())
    return checked(log, code, Result(values["passed"], values["failed"],
                                     failures=[f"{log}: {failure}" for failure in values["failures"]]))


# ---- Running and reading


def read_junit(log, report, code):
    if not report.exists():
        return broken(f"{log} ended with code {code} and no result, see {log_of(log)}")
    result = Result()
    for case in xml.etree.ElementTree.parse(report).iter("testcase"):
        if case.find("failure") is not None or case.find("error") is not None:
            result.failed += 1
            result.failures.append(f"{log}: {case.get('classname')} {case.get('name')}")
        elif case.find("skipped") is not None:
            result.skipped += 1
        else:
            result.passed += 1
    return checked(log, code, result)


def checked(log, code, result):
    """The result, if it agrees with the exit code and holds any test at all."""
    if not result.passed + result.failed:
        return broken(f"{log} ran no test, see {log_of(log)}")
    if code and not result.failed:
        return broken(f"{log} ended with code {code}, though no test failed, see {log_of(log)}")
    return result


def broken(sentence):
    """The result of a run that could not say which tests passed."""
    return Result(failed=1, failures=[sentence])


def fresh(log, kind):
    path = OUTPUT / f"{log}.{kind}"
    path.unlink(missing_ok=True)
    return path


def log_of(log):
    return (OUTPUT / f"{log}.log").relative_to(ROOT)


def require(log, *command):
    code = run(log, command)
    if code:
        raise CouldNotRun(f"{' '.join(map(str, command))} ended with code {code}, see {log_of(log)}")


def run(log, command, environment=None):
    """Runs a command to its end or the time limit; returns its exit code."""
    path = OUTPUT / f"{log}.log"
    with path.open("w") as output:
        process = subprocess.Popen(command, cwd=ROOT, env=environment, stdin=subprocess.DEVNULL, stdout=output,
                                   stderr=subprocess.STDOUT, start_new_session=True)
        try:
            code = process.wait(TIME_LIMIT)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            code = process.wait()
            output.write(f"\nstopped after {TIME_LIMIT} s\n")
    if code:
        shown = path.read_text(errors="replace").splitlines()[-SHOWN:]
        print("".join(f"   | {line}\n" for line in shown), end="")
    return code


def output_of(*command):
    return subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout.strip()


if __name__ == "__main__":
    sys.exit(main())
