# SPDX-License-Identifier: GPL-3.0-or-later
"""What refuses a library that must not be shipped. All else is the tier ship."""

import os
import subprocess
import sys

import pytest
from conftest import ROOT

sys.path.append(str(ROOT / "scripts" / "package_parts"))
import checks  # noqa: E402
import release_page  # noqa: E402

LIBRARY = ROOT / "build" / "release" / "libpartwheel.so"
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


def test_the_release_page_has_the_newest_notes_and_all_pictures(tmp_path):
    release_page.write(tmp_path)
    assert {path.name for path in (tmp_path / "pictures").iterdir()} == set(release_page.PICTURES)
    changelog = "# Changelog\n\n## 0.2.0\n\nNew.\n\n- One.\n\n## 0.1.0\n\nOld.\n"
    assert release_page.notes(changelog) == "New.\n\n- One.\n"
    text = (tmp_path / "NOTES.md").read_text()
    assert text.strip() and "\n## " not in text and text in (ROOT / "CHANGELOG.md").read_text()
