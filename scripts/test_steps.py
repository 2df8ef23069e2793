"""What the test tiers are made of: setting up, building, running what tests, reading what it says.

Everything that runs writes to build/test/NAME.log; the screen shows the end of what failed.
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
TIME_LIMIT = 4 * 3600  # seconds for any one command, so that nothing hangs for ever; many times what any takes
SHOWN = 60  # lines of a failed command's output


class CouldNotRun(Exception):
    """What a tier needs could not be set up or built. The message says why."""


@dataclasses.dataclass
class Result:
    passed: int = 0
    failed: int = 0
    skipped: list = dataclasses.field(default_factory=list)  # "test: why" of each
    failures: list = dataclasses.field(default_factory=list)
    times: list = dataclasses.field(default_factory=list)  # (seconds, the test) of those that tell
    tiers: list = dataclasses.field(default_factory=list)  # a line for each, which says how it went

    def __iadd__(self, other):
        self.passed += other.passed
        self.failed += other.failed
        self.skipped += other.skipped
        self.failures += other.failures
        self.times += other.times
        self.tiers += other.tiers
        return self


def side_by_side(tests, arguments, count):
    """The sum, in their order, of the Results of a function called with each argument, so many calls at once."""
    total = Result()
    with concurrent.futures.ThreadPoolExecutor(count) as pool:
        for result in pool.map(tests, arguments):
            total += result
    return total


# ---- Steps of the tiers


def set_up(function):
    """Waits until this function of setup.sh has run; begins it unless begin_setting_up() did. Only its first call takes
    anything."""
    if function not in set_ups:
        begin_setting_up(function)
    set_ups[function].result()


def begin_setting_up(*functions):
    """Runs functions of setup.sh, one after another, while tests run."""
    for function in functions:
        if function not in set_ups:
            log = re.sub(r"\W+", "-", function)
            set_ups[function] = one_at_a_time.submit(require, log, "bash", "-euc", f". scripts/setup.sh; {function}")


one_at_a_time = concurrent.futures.ThreadPoolExecutor(1)
set_ups = {}  # function of setup.sh -> its Future


def build(log, preset, *targets):
    with compiling:
        require(log, "scripts/build", preset, *targets)


def make_packages():
    """The add-on for Blender 4.2 and later, and the legacy one: made once for all tiers that need them."""
    with compiling:
        return made_packages()


@functools.cache
def made_packages():
    require("package", "scripts/package")
    return tuple(map(pathlib.Path, (OUTPUT / "package.log").read_text().splitlines()[-2:]))


compiling = threading.Lock()  # one at a time: what was compiled once, the next finds in the compiler's cache


def installed(venv):
    """A folder with the package in it as its wheel has it."""
    packages = OUTPUT / f"packages-{venv}"
    shutil.rmtree(packages, ignore_errors=True)
    require(venv, "/usr/bin/python3", "-m", "pip", "install", "--no-deps", "--target", packages,
            *(ROOT / "build/package").glob("*.whl"))
    return str(packages)


def ctest(log, preset, *options, **environment):
    report = fresh(log, "xml")
    code = run(log, ["ctest", "--preset", preset, "--parallel", str(os.cpu_count()), "--output-junit", report,
                     *options], os.environ | environment)
    return read_junit(log, report, code)


def gtests(log):
    """How many of GoogleTest's tests passed: ctest runs whole programs where it takes long to start one."""
    report = OUTPUT / f"{log}.xml"  # not there where ctest was stopped
    text = report.read_text(errors="replace") if report.exists() else ""
    return sum(map(int, re.findall(r"\[  PASSED  \] (\d+) test", text)))


def pytest(log, *tests, venv="core", shared=None, **environment):
    """shared: what pytest-xdist calls the way in which the tests are shared between as many processes as there are
    cores; None: one process."""
    report = fresh(log, "xml")
    command = [VENV / venv / "bin/python", "-m", "pytest", "-rs", "-p", "no:cacheprovider", "--capture=sys",
               f"--junitxml={report}", *tests]  # what a dying library writes reaches the log
    if shared:
        command += ["--numprocesses", str(os.cpu_count()), "--dist", shared]
    code = run(log, command, os.environ | environment)
    return read_junit(log, report, code)


def pre_commit(log):
    """Each of its checks counts as a test."""
    safe = {"GIT_CONFIG_COUNT": "1", "GIT_CONFIG_KEY_0": "safe.directory", "GIT_CONFIG_VALUE_0": "*"}  # whoever owns the clone
    code = run(log, [VENV / "hooks/bin/pre-commit", "run", "--all-files", "--color", "never"],
               os.environ | safe | {"PRE_COMMIT_HOME": str(ROOT / "build/deps/hooks")})
    outcomes = re.findall(r"^(.+?)\.{3,}(?:\(.*\))?(Passed|Failed)$", (OUTPUT / f"{log}.log").read_text(), re.MULTILINE)
    failures = [f"{log}: {check}" for check, outcome in outcomes if outcome == "Failed"]
    return checked(log, code, Result(len(outcomes) - len(failures), len(failures), failures=failures))


def own_runner(log, command, environment, report):
    """Runs tests/addon/run.py or tests/gui/run.py, which write to report {"passed": n, "failed": n, "failures": [...],
    "seconds": {test: s}}."""
    report.unlink(missing_ok=True)
    code = run(log, command, environment)
    if not report.exists():
        return broken(f"{log} ended with code {code} and no result, see {log_of(log)}")
    values = json.loads(report.read_text())
    return checked(log, code, Result(values["passed"], values["failed"],
                                     failures=[f"{log}: {failure}" for failure in values["failures"]],
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
    """Runs a command to its end or the time limit; returns its exit code. numpy gets one thread: processes share the cores,
    and threads of matrices of two rows that wait for each other make some tests take ten times as long."""
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
        shown = path.read_text(errors="replace").splitlines()[-SHOWN:]
        print(f"   {log} ended with code {code}:\n" + "".join(f"   | {line}\n" for line in shown), end="")
    return code


def output_of(*command):
    return subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout.strip()
