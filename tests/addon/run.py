# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on tier: installs the zip into this Blender, then tests what was installed, without a window.

    blender -b --factory-startup --python-exit-code 9 --python tests/addon/run.py -- ZIP RESULT.json [NAME ...]
    build/venv/bpy-X/bin/python tests/addon/run.py -- ZIP RESULT.json [NAME ...]

With names only the tests that have one of them in their own. Start it with a HOME of its own: it installs into the
user's directories. RESULT.json: {"passed": n, "failed": n, "failures": [sentence, ...], "skipped": ["test: why",
...], "seconds": {test: s}}. Exit code: 0 if all passed or were skipped, 1 if a test failed.
"""

import json
import os
import sys
import time
import traceback
import unittest
from pathlib import Path

import bpy

SLOW = 3  # seconds

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "faults")]


def installed(zip_path):
    """Installs and enables the add-on the way this Blender's users do, also over another: the name of its module."""
    if bpy.app.version >= (4, 2, 0):
        module, root = "bl_ext.user_default.partwheel", bpy.utils.user_resource("EXTENSIONS")
        bpy.ops.extensions.package_install_files(filepath=zip_path, repo="user_default", enable_on_install=True)
    else:
        module, root = "partwheel_addon", bpy.utils.user_resource("SCRIPTS")
        bpy.ops.preferences.addon_install(filepath=zip_path)
        bpy.ops.preferences.addon_enable(module=module)
    if module not in bpy.context.preferences.addons:
        raise RuntimeError(f"{zip_path} did not install as {module}.")
    package = sys.modules[module]
    if Path(root).resolve() not in Path(package.__file__).resolve().parents:
        raise RuntimeError(f"{module} was imported from {package.__file__}, not from what was installed in {root}.")
    print(f"Blender {bpy.app.version_string}: {module} from {package.__file__}", flush=True)
    return module


def for_this_blender(suite):
    """The tests of a suite: those that are for this Blender, see common.only_in."""
    light = os.environ.get("PARTWHEEL_TEST_LIGHT") == "1"  # without what is slow and for few Blenders
    this = ("between" if light or (4, 0, 0) <= bpy.app.version < (5, 0, 0)
            else "newest" if bpy.app.version >= (5, 0, 0) else "oldest")
    for test in suite:
        if isinstance(test, unittest.TestSuite):
            yield from for_this_blender(test)
        elif all(this in getattr(marked, "blenders", (this,))
                 for marked in (test, getattr(test, test.id().rsplit(".")[-1], None))):
            yield test


class Timed(unittest.TextTestResult):
    """Says which tests take long."""

    seconds = {}  # of each test

    def startTest(self, test):
        self.began = time.monotonic()
        super().startTest(test)

    def stopTest(self, test):
        super().stopTest(test)
        seconds = self.seconds[test.id()] = time.monotonic() - self.began
        if seconds > SLOW:
            self.stream.writeln(f"({seconds:.1f} s: {test.id()})")


def main():
    zip_path, result_path, *names = sys.argv[sys.argv.index("--") + 1:]
    result_path = Path(result_path).resolve()
    result = {"passed": 0, "failed": 1, "failures": [], "skipped": [], "seconds": {}}
    try:
        import common

        common.ZIP = str(Path(zip_path).resolve())
        common.MODULE = installed(common.ZIP)
        unittest.defaultTestLoader.testNamePatterns = [f"*{name}*" for name in names] or None
        tests = list(for_this_blender(unittest.defaultTestLoader.discover(str(HERE), "test_*.py")))
        missing = [name for name in names if not any(name in test.id() for test in tests)]
        if missing:
            raise LookupError(f"No test of this Blender is named {', '.join(missing)}.")
        suite = unittest.TestSuite(tests)
        run = unittest.TextTestRunner(stream=sys.stdout, verbosity=2, resultclass=Timed).run(suite)
        failures = [f"{test.id()}: {text.strip().splitlines()[-1]}" for test, text in run.failures + run.errors]
        skipped = [f"{test.id()}: {reason}" for test, reason in run.skipped]
        others = {getattr(test, "test_case", test) for test, _ in (*run.failures, *run.errors, *run.skipped)}  # of subtests: all
        result = {"passed": run.testsRun - len(others), "failed": len(failures), "failures": failures,
                  "skipped": skipped, "seconds": run.seconds}
    except Exception as error:  # whatever it is, the result must say so
        traceback.print_exc()
        result["failures"].append(f"The add-on could not be tested: {error}")
    result_path.write_text(json.dumps(result, indent=1))
    print(f"{result['passed']} passed, {result['failed']} failed", flush=True)
    return 1 if result["failed"] else 0


if __name__ == "__main__":
    sys.exit(main())
