# SPDX-License-Identifier: GPL-3.0-or-later
"""The quick part of shipping: what refuses a library that must not be shipped, and the workflow files of public CI. All the
rest is the tier ship."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import ROOT

sys.path.append(str(ROOT / "scripts" / "package_parts"))
import checks  # noqa: E402
from platforms import TAGS  # noqa: E402

LIBRARY = ROOT / "build" / "release" / "libpartwheel.so"
WORKFLOWS = sorted((ROOT / ".github" / "workflows").glob("*.yml"))
HERE = f"linux-{'arm64' if os.uname().machine == 'aarch64' else 'x64'}"


def compiled(tmp_path, *options, exported=True):
    """A library that has all functions of the headers, without their code."""
    source = tmp_path / "stub.c"
    source.write_text("".join(f"void {name}(void) {{}}\n" for name in sorted(checks._declared_functions())) +
                      "int puts(const char *);\nint other(void) { return puts(\"\"); }\n")
    library = tmp_path / "libstub.so"
    keep = tmp_path / "stub.map"
    keep.write_text("{ global: pw_*; local: *; };" if exported else "{ global: *; };")
    subprocess.run(["cc", "-shared", "-fPIC", f"-Wl,--version-script={keep}", "-o", library, source, *options], check=True)
    return library


def test_a_compiler_for_this_machine_alone_is_noticed():
    """g++'s library needs this machine's glibc, which is newer than what is promised."""
    with pytest.raises(checks.Refused, match="needs glibc"):
        checks.check(LIBRARY, HERE)


def test_symbols_that_are_not_ours_are_noticed(tmp_path):
    with pytest.raises(checks.Refused, match=r"exports \['other'\] too many, \[\] too few"):
        checks.check(compiled(tmp_path, "-nostartfiles", exported=False), HERE)


def test_foreign_libraries_are_noticed(tmp_path):
    with pytest.raises(checks.Refused, match=r"needs \['libstdc\+\+.so.6'\]"):
        checks.check(compiled(tmp_path, "-Wl,--no-as-needed", "-lstdc++"), HERE)


@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.name)
def test_workflows_are_what_they_must_be(path):
    process = subprocess.run([Path(sys.executable).with_name("check-jsonschema"), "--builtin-schema",
                           "vendor.github-workflows", path], capture_output=True, text=True)
    assert process.returncode == 0, process.stdout
    paths = re.findall(r"(?:\bscripts|\.github)/[\w/.]+", re.sub(r"^#.*", "", path.read_text(), flags=re.M))
    assert all((ROOT / name).is_file() for name in paths)


def test_each_platform_has_a_system_in_public_ci():
    (systems,) = re.findall(r"system: \[(.*)\]", (ROOT / ".github/workflows/check.yml").read_text())
    assert len(systems.split(",")) == len(TAGS)
