"""The test tiers, one function each: builds what it needs, runs it, returns what passed and failed.

Called by scripts/test. What all of them need to be set up is set up in that order, while the first tests run. Two tiers run
at once: each waits now and then, for a window, a link or its last test.
"""

import argparse
import os
import re
import shutil
import sys
import time

from test_steps import (OUTPUT, ROOT, VENV, CouldNotRun, Result, begin_setting_up, broken, build, ctest, gtests, installed,
                        make_packages, output_of, own_runner, pre_commit, pytest, require, set_up, side_by_side)

BENCHMARK = ROOT.parent / "shared" / "psb" / "tune.tar.xz"  # of which the tier quality scores a part
HAS_BENCHMARK = bool(os.environ.get("PARTWHEEL_PSB")) or BENCHMARK.exists()
SUITES = os.environ.get("PARTWHEEL_SUITES", "sid").split()
# The oldest Blender plays all scenarios, the newest these.
IN_NEWEST = ("adjust", "anything", "beyond", "blender_itself", "bones", "cage", "commands", "compose_finger",
             "confirm_enter", "convex_parts", "creases", "deform", "deform_keys", "deform_more", "deform_within",
             "duplicate", "empty_space", "finds_first", "frames", "gather", "hands", "imports", "industry", "left_out",
             "limits", "linked", "menu", "modes", "move", "navigate", "open_mesh", "overlays", "panel",
             "panel_solids", "parts_to", "pick_and_click", "picked_objects", "quad_view", "recover", "related",
             "restore", "seen", "select_modes", "similar_across", "three_clicks", "tool", "tool_keys", "ways",
             "wheel_at_click", "while_building", "windows", "words")
THREADED = "[Tt]hread|ProgressNever"  # the names of tests in which threads meet
# What the sanitizers have seen already: native tests that build the same once more to compare or count, and shapes by formula
# beside real models; and files of core about what the package does with numbers and texts, where the library is called as in
# the other files, or as in the native tests: "border", "convex", "progress", "regroup", which take long.
COMPARED = r"Invariance\.|SameTree|OrderOfTheInput|PowersOfTwo|SameOnEachRun|SameBytes|TheSameForAny|AreFew|AreBounded" \
           r"|SurfacesByFormula|OfShapesByFormula|KeepTheError"
PACKAGES_OWN = ("bones", "border", "command_line", "compatible", "convex", "cut", "docs", "docs_commands", "layers",
                "interpreter", "joint", "likeness", "locale", "meshes", "primitives", "printing", "progress", "regroup", "seams",
                "shipping", "symmetry", "versions", "words", "worker")
LIGHT = {"PARTWHEEL_TEST_LIGHT": "1"}  # fewer models that take the same code, smaller sizes
GATE_BPY = ("5.0", "4.2")  # the newest and the oldest; the first one runs the tests that are for one Blender only
# Click and wheel in each mode, parts to objects, an import, and the whole job.
GATE_SCENARIOS = ("tool", "modes", "picked_objects", "parts_to", "imports", "three_clicks")
TEN_MODELS = "tests/quality/test_floors.py::test_ten_models_of_the_benchmark"
AT_ONCE = 2  # tiers
SLOWEST = 10  # tests that are named at the end

PACKAGES = ("setup_build", "setup_package")  # what make_packages() needs
WINDOWS = (*PACKAGES, "setup_core", "setup_blender", "setup_display")  # what in_windows() needs


def needs(*functions, begins=()):
    """What of setup.sh a tier waits for; and what is begun likewise, but asked after by the tier itself."""
    def noted(tier):
        tier.needs, tier.begins = functions, (*functions, *begins)
        return tier
    return noted


@needs("setup_build")
def native(**environment):
    """GoogleTest through CTest, as shipped."""
    build("native", "release")
    return ctest("native", "release", **environment)


@needs("setup_build", "setup_core")
def sanitizers():
    """Native and core tests again, watched by AddressSanitizer and UndefinedBehaviorSanitizer: all but what is the same
    code on the same models once more. The latter in a host program whose numbers have a comma."""
    build("sanitizers", "asan")
    result = ctest("sanitizers-native", "asan", "--exclude-regex", COMPARED)
    tests = [path for path in sorted((ROOT / "tests/core").glob("test_*.py")) if path.stem[5:] not in PACKAGES_OWN]
    result += pytest("sanitizers-core", *tests, shared="loadfile", LD_PRELOAD=runtimes(), ASAN_OPTIONS="detect_leaks=0",
                     UBSAN_OPTIONS="print_stacktrace=1", PARTWHEEL_TEST_COMMA="1",
                     PARTWHEEL_LIBRARY=str(ROOT / "build/asan/libpartwheel.so"), **LIGHT)
    return result


def runtimes():
    """Of the sanitizers. Python isn't linked with them, so they are loaded before it; its own leaks are not looked at."""
    return " ".join(output_of("clang++", f"-print-file-name={name}")
                    for name in ("libclang_rt.asan-x86_64.so", "libstdc++.so"))


@needs("setup_build")
def threads():
    """The native tests that use threads, watched by ThreadSanitizer."""
    programs = [path.stem for path in sorted((ROOT / "tests" / "native").glob("*_test.cpp"))
                if re.search(THREADED, path.stem + "".join(re.findall(r"^TEST.*", path.read_text(), re.MULTILINE)))]
    build("threads", "tsan", *programs)
    return ctest("threads", "tsan", "--tests-regex", THREADED)


@needs("setup_build", "setup_core")
def fuzz():
    """The fuzzers of the C API's three entrances, for a hundred inputs each, watched by the sanitizers."""
    build("fuzz", "asan", "mesh_fuzzer", "saved_fuzzer", "surface_fuzzer")  # and the release, which makes the seeds
    return pytest("fuzz", "tests/fuzz", shared="worksteal")


@needs("setup_build", "setup_core")
def determinism():
    """The same bits as shipped, in one thread or three, and from another compiler with the sanitizers."""
    for preset in ("release", "asan"):
        build("determinism", preset, "partwheel")
    return pytest("determinism", "tests/determinism", PARTWHEEL_RUNTIMES=runtimes())


@needs(*PACKAGES, "setup_core")
def core(**environment):
    """The Python package as installed from its wheel, and the installed library, without Blender."""
    build("core", "release", "partwheel", "partwheel_checks")
    make_packages()
    return pytest("core", "tests/core", shared="loadfile", PARTWHEEL_PACKAGES=installed("core"), **environment)


@needs(*PACKAGES, "setup_batch")
def batch():
    """partwheel batch as installed from the wheel: hostile files, kills, Ctrl-C, its report in a browser."""
    make_packages()
    return pytest("batch", "tests/batch", venv="batch", PARTWHEEL_PACKAGES=installed("batch"))


@needs("setup_build", "setup_core", "setup_blender")  # whose primitives are among the models
def reliability():
    """Every model there is: built, or a sheet and named so, and no crash; a table in build/test."""
    build("reliability", "release", "partwheel")
    return pytest("reliability", "tests/reliability", shared="loadfile")


@needs("setup_build", "setup_core", *(["setup_psb"] if HAS_BENCHMARK else []))
def quality():
    """How well parts are selected: 24 models of the benchmark where it is, and mirror images, against floors."""
    build("quality", "release", "partwheel")
    build("quality", "bench", "quality_trace")
    return pytest("quality", "tests/quality", "--deselect", TEN_MODELS, shared="loadfile")


@needs(*PACKAGES, "setup_core", "setup_blender", "setup_bpy")
def addon():
    """The add-on as installed from the zip, without a window, in the distribution's Blender and in bpy from PyPI."""
    extension, legacy = make_packages()
    versions = output_of("bash", "-c", ". scripts/setup.sh && echo $bpy_versions").split()
    blender = ["blender", "-b", "-noaudio", "--factory-startup", "--python-exit-code", "9", "--python"]
    # The longest first: the oldest and the newest run all tests.
    runs = [lambda: in_blender("blender", blender, legacy),
            *(lambda version=version: in_bpy(version, extension) for version in reversed(versions))]
    return side_by_side(lambda run: run(), runs, os.cpu_count())


def in_bpy(version, package):
    return in_blender(f"bpy-{version}", [VENV / f"bpy-{version}/bin/python"], package)


def in_blender(name, interpreter, package):
    """The tests of the add-on in one Blender."""
    home = OUTPUT / "home" / name  # a new one, so that nothing installed before is there
    shutil.rmtree(home, ignore_errors=True)
    home.mkdir(parents=True)
    clean = {"PATH": os.environ["PATH"], "HOME": str(home), "LANG": "C.UTF-8"}
    clean |= {name: value for name, value in os.environ.items()
              if name in {"PARTWHEEL_UNITES", "PARTWHEEL_UNITES_SEED", "PARTWHEEL_EVENTS"}}
    report = OUTPUT / f"addon-{name}.json"
    return own_runner(f"addon-{name}", [*interpreter, "tests/addon/run.py", "--", package, report], clean, report)


@needs(*WINDOWS)
def gui():
    """Blender's own window under Xvfb, driven by mouse and key events, in the distribution's Blender."""
    return in_windows("gui")


def in_windows(log, *scenarios):
    _, legacy = make_packages()
    report = OUTPUT / f"{log}.json"
    return own_runner(log, [VENV / "core/bin/python", "tests/gui/run.py", legacy, report, *scenarios], dict(os.environ), report)


@needs(*WINDOWS, begins=[f"setup_newest {suite}" for suite in SUITES])
def newest():
    """More of it in the newest Blender that Debian has, which moves; where that can't be had, in the distribution's."""
    result = Result()
    for suite in SUITES:
        result += in_suite(suite)
    if not result.passed + result.failed:
        result += in_windows("newest", *IN_NEWEST)
    return result


def in_suite(suite):
    """In another Debian's Blender."""
    extension, _ = make_packages()
    log = f"newest-{suite}"
    if not has_suite(suite):
        return Result(skipped=[f"newest: {name}: there is no Blender of Debian {suite}" for name in IN_NEWEST])
    inside = ROOT / f"build/deps/blender-{suite}"
    room = inside / "partwheel"  # nothing is mounted: what the scenarios need is copied
    shutil.rmtree(room, ignore_errors=True)
    for tests in ("tests/gui", "tests/faults"):
        shutil.copytree(ROOT / tests, room / tests)
    shutil.copytree(ROOT / "build/deps/meshes", room / "build/deps/meshes")
    shutil.copy(extension, room)
    clean = {"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "HOME": "/root", "LANG": "C.UTF-8"}
    command = ["chroot", inside, "python3", "/partwheel/tests/gui/run.py", f"/partwheel/{extension.name}",
               "/partwheel/result.json", *IN_NEWEST]
    return own_runner(log, command, clean, room / "result.json")


def has_suite(suite):
    try:
        set_up(f"setup_newest {suite}")
    except CouldNotRun as reason:
        print(f"   The Blender of Debian {suite} could not be installed: {reason}")
        return False
    return True


@needs("setup_hooks")
def sources():
    """The checks of .pre-commit-config.yaml, on all files."""
    return pre_commit("sources")


@needs(*native.needs)
def gate_native():
    """GoogleTest through CTest, as shipped, on fewer models."""
    return native(**LIGHT)


@needs(*core.needs)
def gate_core():
    """The Python package as installed from its wheel, on fewer models."""
    return core(**LIGHT)


@needs(*PACKAGES, *(f"setup_bpy {version}" for version in GATE_BPY))
def gate_addon():
    """The add-on as installed from the zip, without a window, in the newest and the oldest bpy."""
    return side_by_side(lambda version: in_bpy(version, make_packages()[0]), GATE_BPY, os.cpu_count())


@needs(*WINDOWS)
def gate_gui():
    """Six scenarios in the distribution's Blender, driven by mouse and key events."""
    return in_windows("gui", *GATE_SCENARIOS)


@needs(*quality.needs)
def gate_quality():
    """How well parts are selected, on ten models."""
    build("gate_quality", "release", "partwheel")
    return pytest("gate_quality", TEN_MODELS)


@needs(*PACKAGES, "setup_core", "setup_bpy", "setup_workflows", begins=["setup_newest sid"])
def ship():
    """The packages for all platforms, made, run where they can be, and installed as strangers do; and the native tests of
    this machine and of the two that are for others, by wine and qemu. An hour of compiling: only when it is named."""
    require("ship-package", "scripts/package", "all")
    print((OUTPUT / "ship-package.log").read_text().split("distribution\n")[-1], end="")
    has_suite("sid")
    result = pytest("ship", "tests/ship")
    for preset in ("release", "windows-x64", "linux-arm64"):  # the first: how long this machine takes of itself
        build(f"ship-{preset}", preset)
        began = time.monotonic()
        native = ctest(f"ship-{preset}", preset, "--test-output-truncation", "head")
        print(f"   {preset}: {gtests(f'ship-{preset}')} native tests passed in {time.monotonic() - began:.0f} s")
        result += native
    return result


GATE = {function.__name__: function
        for function in (gate_native, gate_core, gate_addon, gate_gui, gate_quality, sources)}
ALL = {function.__name__: function
       for function in (native, sanitizers, threads, determinism, fuzz, core, batch, quality, reliability, addon, gui, newest,
                        sources, ship)}
TIERS = GATE | ALL


def set_up_and_run(tests):
    for function in tests.needs:
        set_up(function)
    return tests()


def run(name):
    """A tier's Result, told when it is there."""
    print(f"== {name}: {TIERS[name].__doc__}\n", end="")  # in one piece, beside another tier's
    began = time.monotonic()
    try:
        result = set_up_and_run(TIERS[name])
    except CouldNotRun as reason:
        result = broken(f"{name} could not run: {reason}")
    skipped = f", {len(result.skipped)} skipped" if result.skipped else ""
    result.tiers = [f"{name:<12}{result.passed} passed, {result.failed} failed{skipped}, {time.monotonic() - began:.0f} s"]
    told = [*(f"FAILED {failure}" for failure in result.failures), *result.tiers]
    print("".join(f"   {line}\n" for line in told), end="")
    return result


def main():
    parser = argparse.ArgumentParser(prog="scripts/test", description="Runs the gate, all tiers, or the tiers named.")
    parser.add_argument("tier", nargs="*", metavar="all | TIER", help=" ".join(TIERS))
    names = parser.parse_args().tier or list(GATE)
    if names == ["all"]:
        names = list(ALL)
    for name in names:
        if name not in TIERS:
            parser.error(f"there is no tier {name}: {', '.join(TIERS)}")

    OUTPUT.mkdir(parents=True, exist_ok=True)
    begin_setting_up(*(function for name in names for function in TIERS[name].begins))
    total = side_by_side(run, names, AT_ONCE)
    print("== the slowest tests")
    for seconds, test in sorted(total.times, reverse=True)[:SLOWEST]:
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
