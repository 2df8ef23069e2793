"""The test tiers. Each is a function that builds what it needs, runs its tests and returns a Result.

scripts/test calls this. The requirements of all tiers are installed in the tiers' order while the first tests run. Two
tiers run at a time, because each is idle now and then, waiting for a window, the linker or its last test.
"""

import argparse
import os
import re
import shutil
import sys
import time

from test_steps import (OUTPUT, ROOT, VENV, CouldNotRun, Result, broken, build, count_gtests, ctest, install_wheel,
                        make_packages, output_of, pre_commit, pytest, require, run_parallel, run_reporting, set_up, start_setup)

BENCHMARK = ROOT.parent / "shared" / "psb" / "tune.tar.xz"  # the tier quality uses a part of it
HAS_BENCHMARK = bool(os.environ.get("PARTWHEEL_PSB")) or BENCHMARK.exists()
MODELS = ROOT.parent / "shared" / "assets" / "files"  # of some scenarios
SUITES = os.environ.get("PARTWHEEL_SUITES", "sid").split()
# The scenarios that the newest Blender runs; the oldest one runs all.
NEWEST_SCENARIOS = ("assembly", "bones", "builds_first", "cage", "cancel_convex", "commands", "compose_finger",
                    "convex_parts", "creases", "deform", "deform_keys", "deform_more", "empty_space", "frames",
                    "gather", "hidden_parts", "imports", "industry_keymap", "linked", "modes", "move", "navigate",
                    "other_inputs", "overlays", "panel", "panel_solids", "parts_to", "pick_and_click", "picked_objects",
                    "quad_view", "recover", "related", "restore", "similar_across", "three_clicks", "tool", "tool_keys",
                    "visible_surface", "wheel_at_click", "while_building", "windows")
THREADED = "[Tt]hread|Concurrent"  # names of tests that use threads
# Tests that add nothing under the sanitizers. Native: tests that build the same model again to compare, or count steps, whose
# names say so; and one that limits the address space, which AddressSanitizer exceeds.
REDUNDANT_NATIVE = r"Invariance\.|SameBytes|AreBounded|IsBounded|GrowAsNLogN|NeedsNoMemory"
# Core: files about Python code and about workers with a memory limit, whose calls of the library other files make, too; and
# "convex", "progress", "merge_policy", which take long and whose calls the native tests make.
REDUNDANT_CORE = ("assets", "bones", "command_line", "compatible", "contents", "convex", "cut", "docs", "docs_commands",
                  "layers", "interpreter", "joint", "likeness", "meshes", "primitives", "printing", "progress",
                  "merge_policy", "reports", "requirements", "seams", "symmetry", "versions", "worker")
LIGHT = {"PARTWHEEL_TEST_LIGHT": "1"}  # fewer and smaller models that run the same code
GATE_BPY = ("5.0", "4.2")  # the newest and the oldest
# Click and wheel in each mode, parts to objects, an import, and a complete session.
GATE_SCENARIOS = ("tool", "modes", "picked_objects", "parts_to", "imports", "three_clicks")
# Files of tests/core that take long and compare with references in Python, scipy or libigl, or use real assets: not in the gate.
NOT_IN_GATE = ("assets", "compatible", "docs_commands", "joint", "likeness", "primitives", "merge_policy")
TEN_MODELS = "tests/quality/test_selection_quality.py::test_ten_models_of_the_benchmark"
PARALLEL_TIERS = 2
SLOWEST_TESTS = 10  # number of tests listed at the end

PACKAGES = ("setup_build", "setup_package")  # required by make_packages()
WINDOWS = (*PACKAGES, "setup_core", "setup_blender", "setup_display")  # required by gui()


def needs(*functions, optional=()):
    """Declares the functions of setup.sh that a tier requires, and those that are started, too, but awaited by the tier
    itself."""
    def decorate(tier):
        tier.needs, tier.setup = functions, (*functions, *optional)
        return tier
    return decorate


@needs("setup_build")
def native(**environment):
    """GoogleTest through CTest, as shipped. The benchmarks are compiled, too."""
    build("native", "release", "all", "benchmarks")
    return ctest("native", "release", **environment)


@needs("setup_build", "setup_core")
def sanitizers():
    """Native and core tests, without redundant ones, under AddressSanitizer and UndefinedBehaviorSanitizer; the core
    tests in a host program with a decimal comma."""
    build("sanitizers", "asan")
    result = ctest("sanitizers-native", "asan", "--exclude-regex", REDUNDANT_NATIVE)
    tests = [path for path in sorted((ROOT / "tests/core").glob("test_*.py")) if path.stem[5:] not in REDUNDANT_CORE]
    result += pytest("sanitizers-core", *tests, dist="loadfile", LD_PRELOAD=sanitizer_runtimes(), ASAN_OPTIONS="detect_leaks=0",
                     UBSAN_OPTIONS="print_stacktrace=1", PARTWHEEL_TEST_COMMA="1",
                     PARTWHEEL_LIBRARY=str(ROOT / "build/asan/libpartwheel.so"), **LIGHT)
    return result


def sanitizer_runtimes():
    """The libraries to preload into Python, which isn't linked with the sanitizers."""
    return " ".join(output_of("clang++", f"-print-file-name={name}")
                    for name in ("libclang_rt.asan-x86_64.so", "libstdc++.so"))


@needs("setup_build")
def threads():
    """The native tests that use threads, under ThreadSanitizer."""
    programs = [path.stem for path in sorted((ROOT / "tests" / "native").glob("*_test.cpp"))
                if re.search(THREADED, path.stem + "".join(re.findall(r"^TEST.*", path.read_text(), re.MULTILINE)))]
    build("threads", "tsan", *programs)
    return ctest("threads", "tsan", "--tests-regex", THREADED)


@needs("setup_build", "setup_core")
def fuzz():
    """The fuzzers of the C API's three entry points, with a hundred inputs each, under the sanitizers."""
    build("fuzz", "asan", "mesh_fuzzer", "saved_fuzzer", "surface_fuzzer")  # and the release build, which generates the seeds
    return pytest("fuzz", "tests/fuzz", dist="worksteal")


@needs("setup_build", "setup_core")
def determinism():
    """Bit-identical results with one and three threads, and from another compiler with the sanitizers."""
    for preset in ("release", "asan"):
        build("determinism", preset, "partwheel")
    return pytest("determinism", "tests/determinism", PARTWHEEL_RUNTIMES=sanitizer_runtimes())


@needs(*PACKAGES, "setup_core")
def core(*options, **environment):
    """The Python package as installed from its wheel, and the installed library, without Blender."""
    build("core", "release", "partwheel", "partwheel_checks")
    make_packages()
    return pytest("core", "tests/core", *options, dist="loadfile", PARTWHEEL_PACKAGES=install_wheel("core"), **environment)


@needs(*PACKAGES, "setup_batch")
def batch():
    """partwheel batch as installed from the wheel: hostile files, kills, Ctrl-C, its report in a browser."""
    make_packages()
    return pytest("batch", "tests/batch", venv="batch", PARTWHEEL_PACKAGES=install_wheel("batch"))


@needs("setup_build", "setup_core", "setup_blender")  # Blender's primitives are among the models
def reliability():
    """Every available model: it is built or recognized as a sheet, and nothing crashes. Writes a table to
    build/test."""
    build("reliability", "release", "partwheel")
    return pytest("reliability", "tests/reliability", dist="loadfile")


@needs("setup_build", "setup_core", *(["setup_psb"] if HAS_BENCHMARK else []))
def quality(*tests):
    """The quality of selected parts: 24 models of the benchmark, if it is available, and mirror images, against minimum
    scores."""
    build("quality", "release", "partwheel")
    return pytest("quality", *(tests or ("tests/quality", "--deselect", TEN_MODELS)), dist="loadfile")


@needs(*PACKAGES, "setup_core", "setup_blender", "setup_bpy")
def addon():
    """The add-on as installed from the zip, without a window, in the distribution's Blender and in bpy from PyPI."""
    extension, legacy = make_packages()
    versions = output_of("bash", "-c", ". scripts/setup.sh && echo $bpy_versions").split()
    blender = ["blender", "-b", "-noaudio", "--factory-startup", "--python-exit-code", "9", "--python"]
    # The longest runs first: the oldest and the newest version run all tests.
    runs = [lambda: in_blender("blender", blender, legacy),
            *(lambda version=version: in_bpy(version, extension) for version in reversed(versions))]
    return run_parallel(lambda run: run(), runs, os.cpu_count())


def in_bpy(version, package, **environment):
    return in_blender(f"bpy-{version}", [VENV / f"bpy-{version}/bin/python"], package, **environment)


def in_blender(name, interpreter, package, **environment):
    """The tests of the add-on in one Blender."""
    home = OUTPUT / "home" / name  # empty, so that no installed add-on is found
    shutil.rmtree(home, ignore_errors=True)
    home.mkdir(parents=True)
    clean = {"PATH": os.environ["PATH"], "HOME": str(home), "LANG": "C.UTF-8"} | environment
    clean |= {name: value for name, value in os.environ.items()
              if name in {"PARTWHEEL_UNITES", "PARTWHEEL_UNITES_SEED"}}
    report = OUTPUT / f"addon-{name}.json"
    return run_reporting(f"addon-{name}", [*interpreter, "tests/addon/run.py", "--", package, report], clean, report)


@needs(*WINDOWS)
def gui(*scenarios, log="gui"):
    """Scenarios in a window of the distribution's Blender under Xvfb, driven by mouse and key events."""
    _, legacy = make_packages()
    report = OUTPUT / f"{log}.json"
    command = [VENV / "core/bin/python", "tests/gui/run.py", legacy, report, *scenarios]
    return run_reporting(log, command, dict(os.environ), report)


@needs(*WINDOWS, optional=[f"setup_newest {suite}" for suite in SUITES])
def newest():
    """More scenarios in the newest Blender that Debian has; if it can't be installed, in the distribution's."""
    result = Result()
    for suite in SUITES:
        result += run_in_suite(suite)
    if not result.passed + result.failed:
        result += gui(*NEWEST_SCENARIOS, log="newest")
    return result


def run_in_suite(suite):
    """Runs the scenarios in the Blender of another Debian release."""
    extension, _ = make_packages()
    log = f"newest-{suite}"
    if not install_suite(suite):
        return Result(skipped=[f"newest: {name}: there is no Blender of Debian {suite}" for name in NEWEST_SCENARIOS])
    chroot = ROOT / f"build/deps/blender-{suite}"
    folder = chroot / "partwheel"  # a copy of the files that the scenarios need, since nothing is mounted
    shutil.rmtree(folder, ignore_errors=True)
    for tests in ("tests/gui", "tests/faults"):
        shutil.copytree(ROOT / tests, folder / tests)
    shutil.copytree(ROOT / "build/deps/meshes", folder / "build/deps/meshes")
    if MODELS.exists():
        shutil.copytree(MODELS, chroot / MODELS.relative_to(ROOT.parent), dirs_exist_ok=True)
    shutil.copy(extension, folder)
    clean = {"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "HOME": "/root", "LANG": "C.UTF-8"}
    command = ["chroot", chroot, "python3", "/partwheel/tests/gui/run.py", f"/partwheel/{extension.name}",
               "/partwheel/result.json", *NEWEST_SCENARIOS]
    return run_reporting(log, command, clean, folder / "result.json")


def install_suite(suite):
    """Installs another Debian release; returns whether that worked."""
    try:
        set_up(f"setup_newest {suite}")
    except CouldNotRun as reason:
        print(f"   The Blender of Debian {suite} could not be installed: {reason}")
        return False
    return True


@needs("setup_hooks")
def sources():
    """The checks of .pre-commit-config.yaml, on all files."""
    return pre_commit()


@needs("setup_build", "setup_core", "setup_docs", optional=["setup_recipes"])
def docs():
    """The recipes, with the commands of their pages, also in Godot and a slicer; the site in a browser."""
    build("docs", "release", "partwheel")
    return pytest("docs", "tests/docs")


@needs(*PACKAGES, *(f"setup_bpy {version}" for version in GATE_BPY))
def gate_addon():
    """The add-on as installed from the zip, without a window, in the newest and the oldest bpy."""
    return run_parallel(lambda version: in_bpy(version, make_packages()[0], **LIGHT), GATE_BPY, os.cpu_count())


@needs(*PACKAGES, "setup_core", "setup_bpy", optional=["setup_newest sid"])
def ship():
    """The packages for all platforms: built, run as far as possible, and installed as users do; and the native tests of
    this platform and of two others, by wine and qemu. Compiles for an hour, so it must be named."""
    require("ship-package", "scripts/package", "all")
    print((OUTPUT / "ship-package.log").read_text().split("distribution\n")[-1], end="")
    install_suite("sid")
    result = pytest("ship", "tests/ship")
    for preset in ("release", "windows-x64", "linux-arm64"):  # the first, for comparison of times
        build(f"ship-{preset}", preset)
        start_time = time.monotonic()
        native = ctest(f"ship-{preset}", preset, "--test-output-truncation", "head")
        print(f"   {preset}: {count_gtests(f'ship-{preset}')} native tests passed in {time.monotonic() - start_time:.0f} s")
        result += native
    return result


def part_of_gate(tier, description, *arguments, **environment):
    """The tier, but for these arguments."""
    def gate_tier():
        return tier(*arguments, **environment)
    gate_tier.__doc__, gate_tier.needs, gate_tier.setup = description, tier.needs, tier.setup
    return gate_tier


GATE = {"gate_native": part_of_gate(native, "GoogleTest through CTest, as shipped, on fewer models.", **LIGHT),
        "gate_core": part_of_gate(core, "The Python package as installed from its wheel, on fewer models.",
                                  *(f"--ignore=tests/core/test_{name}.py" for name in NOT_IN_GATE), **LIGHT),
        "gate_addon": gate_addon,
        "gate_gui": part_of_gate(gui, "Six scenarios in the distribution's Blender, driven by mouse and key events.", *GATE_SCENARIOS),
        "gate_quality": part_of_gate(quality, "The quality of selected parts, on ten models.", TEN_MODELS), "sources": sources}
ALL = {function.__name__: function
       for function in (native, sanitizers, threads, determinism, fuzz, core, batch, quality, reliability, addon, gui, newest,
                        sources, docs, ship)}
TIERS = GATE | ALL


def run(name):
    """Runs a tier, prints and returns its Result."""
    print(f"== {name}: {TIERS[name].__doc__}\n", end="")  # one write, since another tier prints, too
    start_time = time.monotonic()
    try:
        for function in TIERS[name].needs:
            set_up(function)
        result = TIERS[name]()
    except CouldNotRun as reason:
        result = broken(f"{name} could not run: {reason}")
    skipped = f", {len(result.skipped)} skipped" if result.skipped else ""
    result.tiers = [f"{name:<12}{result.passed} passed, {result.failed} failed{skipped}, {time.monotonic() - start_time:.0f} s"]
    lines = [*(f"FAILED {failure}" for failure in result.failures), *result.tiers]
    print("".join(f"   {line}\n" for line in lines), end="")
    return result


def main():
    parser = argparse.ArgumentParser(prog="scripts/test", description="Runs the gate, all tiers, or the given tiers.")
    parser.add_argument("tier", nargs="*", metavar="all | TIER", help=" ".join(TIERS))
    names = parser.parse_args().tier or list(GATE)
    if names == ["all"]:
        names = list(ALL)
    for name in names:
        if name not in TIERS:
            parser.error(f"there is no tier {name}: {', '.join(TIERS)}")

    OUTPUT.mkdir(parents=True, exist_ok=True)
    start_setup(*(function for name in names for function in TIERS[name].setup))
    total = run_parallel(run, names, PARALLEL_TIERS)
    print("== the slowest tests")
    for seconds, test in sorted(total.times, reverse=True)[:SLOWEST_TESTS]:
        print(f"   {seconds:6.1f} s  {test}")
    if total.skipped:
        print("== skipped")
        print("".join(f"   {reason}\n" for reason in total.skipped), end="")
    print("== tiers")
    print("".join(f"   {line}\n" for line in total.tiers), end="")
    print(f"{total.passed} passed, {total.failed} failed")
    return 1 if total.failed else 0


if __name__ == "__main__":
    sys.exit(main())
