"""Steps of the test tiers: setup, builds, test runs, results.

Each command writes to build/test/NAME.log; the end of the log of a failed command is also printed.
"""

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
import threading
import xml.etree.ElementTree

ROOT = pathlib.Path(__file__).resolve().parents[1]
OUTPUT = ROOT / "build" / "test"
VENV = ROOT / "build" / "venv"
TIME_LIMIT = 4 * 3600  # seconds for one command, many times what any takes, so that nothing hangs forever
PRINTED_LINES = 60  # of a failed command's log


class CouldNotRun(Exception):
    """The requirements of a tier could not be installed or built. The message says why."""


@dataclasses.dataclass
class Result:
    passed: int = 0
    failed: int = 0
    skipped: list = dataclasses.field(default_factory=list)  # "test: why" of each
    failures: list = dataclasses.field(default_factory=list)
    times: list = dataclasses.field(default_factory=list)  # (seconds, test) if known
    tiers: list = dataclasses.field(default_factory=list)  # a summary line for each

    def __iadd__(self, other):
        for field in dataclasses.fields(self):
            setattr(self, field.name, getattr(self, field.name) + getattr(other, field.name))
        return self


def run_parallel(run, arguments, count):
    """Calls run(argument) for each argument, count calls at a time; returns the sum of the Results in the arguments'
    order."""
    total = Result()
    with concurrent.futures.ThreadPoolExecutor(count) as pool:
        for result in pool.map(run, arguments):
            total += result
    return total


# ---- Steps of the tiers


def set_up(function):
    """Waits until this function of setup.sh has run; starts it unless start_setup() did. It runs once only."""
    if function not in setup_futures:
        start_setup(function)
    setup_futures[function].result()


def start_setup(*functions):
    """Starts functions of setup.sh in a background thread, one after another."""
    for function in functions:
        if function not in setup_futures:
            log = re.sub(r"\W+", "-", function)
            setup_futures[function] = setup_pool.submit(require, log, "bash", "-euc", f". scripts/setup.sh; {function}")


setup_pool = concurrent.futures.ThreadPoolExecutor(1)
setup_futures = {}  # function of setup.sh -> its Future


def build(log, preset, *targets):
    with compiling:
        require(log, "scripts/build", preset, *targets)


def make_packages():
    """Builds the add-on, once for all tiers; returns the paths of the extension for Blender 4.2+ and of the legacy
    add-on."""
    with compiling:
        return _cached_packages()


@functools.cache
def _cached_packages():
    require("package", "scripts/package")
    return tuple(map(pathlib.Path, (OUTPUT / "package.log").read_text().splitlines()[-2:]))


compiling = threading.Lock()  # one build at a time, so that the next finds its results in the compiler cache


def install_wheel(venv):
    """Installs the wheel into a new folder; returns its path."""
    packages = OUTPUT / f"packages-{venv}"
    shutil.rmtree(packages, ignore_errors=True)
    require(venv, "/usr/bin/python3", "-m", "pip", "install", "--no-deps", "--target", packages,
            *(ROOT / "build/package").glob("*.whl"))
    return str(packages)


def ctest(log, preset, *options, **environment):
    report = new_report(log)
    code = run(log, ["ctest", "--preset", preset, "--parallel", str(os.cpu_count()), "--output-junit", report,
                     *options], os.environ | environment)
    return read_junit(log, report, code)


def count_gtests(log):
    """The number of GoogleTest's tests that passed. ctest's own count is of programs if starting them takes long."""
    report = OUTPUT / f"{log}.xml"  # missing if ctest was stopped
    text = report.read_text(errors="replace") if report.exists() else ""
    return sum(map(int, re.findall(r"\[  PASSED  \] (\d+) test", text)))


def pytest(log, *tests, venv="core", dist=None, **environment):
    """Runs pytest. dist: how pytest-xdist distributes the tests to one process per core; None: one process."""
    report = new_report(log)
    command = [VENV / venv / "bin/python", "-m", "pytest", "-rs", "-p", "no:cacheprovider", "--capture=sys",
               f"--junitxml={report}", *tests]  # sys, so that the log has what a crashing library prints
    if dist:
        command += ["--numprocesses", str(os.cpu_count()), "--dist", dist]
    code = run(log, command, os.environ | environment)
    return read_junit(log, report, code)


def pre_commit():
    """Runs pre-commit; each check counts as a test."""
    # For any owner of the clone.
    safe = {"GIT_CONFIG_COUNT": "1", "GIT_CONFIG_KEY_0": "safe.directory", "GIT_CONFIG_VALUE_0": "*"}
    code = run("sources", [VENV / "hooks/bin/pre-commit", "run", "--all-files", "--color", "never"],
               os.environ | safe | {"PRE_COMMIT_HOME": str(ROOT / "build/deps/hooks")})
    outcomes = re.findall(r"^(.+?)\.{3,}(?:\(.*\))?(Passed|Failed)$", (OUTPUT / "sources.log").read_text(), re.MULTILINE)
    failures = [f"sources: {check}" for check, outcome in outcomes if outcome == "Failed"]
    return check_result("sources", code, Result(len(outcomes) - len(failures), len(failures), failures=failures))


def run_reporting(log, command, environment, report):
    """Runs tests/addon/run.py or tests/gui/run.py, which write {"passed": n, "failed": n, "failures": [...],
    "skipped": [...], "seconds": {test: s}} to the report."""
    report.unlink(missing_ok=True)
    code = run(log, command, environment)
    if not report.exists():
        return broken(f"{log} ended with code {code} and no result, see {log_of(log)}")
    values = json.loads(report.read_text())
    return check_result(log, code, Result(
        values["passed"], values["failed"], failures=[f"{log}: {failure}" for failure in values["failures"]],
        skipped=[f"{log}: {skip}" for skip in values["skipped"]],
        times=[(seconds, f"{log}: {test}") for test, seconds in values["seconds"].items()]))


# ---- Running and reading


def read_junit(log, report, code):
    if not report.exists():
        return broken(f"{log} ended with code {code} and no result, see {log_of(log)}")
    result = Result()
    for case in xml.etree.ElementTree.parse(report).iter("testcase"):
        test = f"{log}: {case.get('classname')} {case.get('name')}"
        result.times.append((float(case.get("time")), test))
        if case.find("failure") is not None or case.find("error") is not None:
            result.failed += 1
            result.failures.append(test)
        elif (skip := case.find("skipped")) is not None:
            result.skipped.append(f"{test}: {skip.get('message', '')}")
        else:
            result.passed += 1
    return check_result(log, code, result)


def check_result(log, code, result):
    """The result; a failure if it contradicts the exit code or has no tests."""
    if not result.passed + result.failed + len(result.skipped):
        return broken(f"{log} ran no test, see {log_of(log)}")
    if code and not result.failed:
        return broken(f"{log} ended with code {code}, though no test failed, see {log_of(log)}")
    return result


def broken(sentence):
    """The result of a run without a report."""
    return Result(failed=1, failures=[sentence])


def new_report(log):
    """The path of a report, without the old file."""
    path = OUTPUT / f"{log}.xml"
    path.unlink(missing_ok=True)
    return path


def log_of(log):
    return (OUTPUT / f"{log}.log").relative_to(ROOT)


def require(log, *command):
    code = run(log, command)
    if code:
        raise CouldNotRun(f"{' '.join(map(str, command))} ended with code {code}, see {log_of(log)}")


def run(log, command, environment=None):
    """Runs a command, at most for the time limit; returns its exit code. numpy gets one thread: the test processes
    share the cores, and threads for tiny matrices make some tests ten times as slow."""
    environment = {**(os.environ if environment is None else environment), "OPENBLAS_NUM_THREADS": "1"}
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
        lines = path.read_text(errors="replace").splitlines()[-PRINTED_LINES:]
        print(f"   {log} ended with code {code}:\n" + "".join(f"   | {line}\n" for line in lines), end="")
    return code


def output_of(*command):
    return subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout.strip()
