# SPDX-License-Identifier: GPL-3.0-or-later
"""What is written in the header and in the binding says the same in both; scripts/package compares the version's other places."""

import ctypes
import re

import faults
import partwheel
import pytest
from conftest import ROOT
from partwheel import library

HEADER = "".join((ROOT / "native" / "include" / name).read_text() for name in
                 ("partwheel_types.h", "partwheel.h", "partwheel_edit.h"))
BARE = re.sub(r"/\*.*?\*/", "", HEADER, flags=re.S)


@pytest.mark.parametrize("declared_version, real, why", [
    ("0.0.9", True, f"it is 0.0.9, not {library.VERSION}"),
    (library.VERSION + ".1", True, f"it is {library.VERSION}.1, not {library.VERSION}"),
    (library.VERSION, False, "it has no function "),
])
def test_a_library_of_another_version_is_refused(declared_version, real, why, tmp_path, monkeypatch):
    """Be it the real one but for the version that it tells, or one that lacks functions."""
    source = tmp_path / "other.c"
    source.write_text(f'const char *pw_version(void) {{ return "{declared_version}"; }}')
    other = faults.compiled(source, tmp_path / "libother.so", real=library.load()._name if real else None)
    monkeypatch.delenv("PARTWHEEL_LIBRARY", raising=False)
    monkeypatch.setattr(library, "LIBRARY", other)
    with pytest.raises(partwheel.LibraryError) as refused:
        library.load.__wrapped__()
    assert other in str(refused.value) and why in str(refused.value)
    assert "Restart" in str(refused.value) and "again" in str(refused.value)


def test_every_function_is_bound_with_as_many_arguments():
    declared = {name: 0 if arguments.strip() == "void" else arguments.count(",") + 1
                for name, arguments in re.findall(r"PW_API [\w\s*]*?(pw_\w+)\(([^)]*)\)", BARE)}
    assert declared == {name: len(arguments) for name, (_, arguments) in library.declared_functions(HEADER).items()}


def test_statuses_and_stages_are_the_headers():
    statuses = dict(re.findall(r"PW_(?:ERROR_)?(\w+) = (\d+)", re.search(r"enum pw_status {(.*?)}", BARE, re.S)[1]))
    assert {status.name: str(status.value) for status in library.Status} == statuses
    stages = dict(re.findall(r"PW_STAGE_(\w+) = (\d+)", BARE))
    assert stages.pop("COUNT") == str(len(library.Stage))
    assert {stage.name: str(stage.value) for stage in library.Stage} == stages
    for stage in library.Stage:
        assert library.load().pw_stage_name(stage).decode() == stage.name.lower()
    names = [library.load().pw_status_name(status).decode() for status in library.Status]
    assert len(set(names)) == len(names) and all(name == name.lower() and name for name in names)


def test_structs_are_the_compilers(tmp_path):
    """Each field lies where the C compiler puts it."""
    library.load()
    structs = {re.sub("(?<!^)(?=[A-Z])", "_", struct.__name__).lower(): struct for struct in library._Sized.__subclasses__()}
    assert len(structs) == 7
    source = tmp_path / "offsets.c"
    source.write_text("#include <stddef.h>\n#include <partwheel.h>\n#include <partwheel_edit.h>\n" + "".join(
        f"size_t {name}_{field}(void) {{ return offsetof(pw_{name}, {field}); }}\n"
        for name, struct in structs.items() for field, _ in struct._fields_) + "".join(
        f"size_t size_of_{name}(void) {{ return sizeof(pw_{name}); }}\n" for name in structs))
    compiled = ctypes.CDLL(faults.compiled(source, tmp_path / "liboffsets.so", f"-I{ROOT / 'native/include'}"))
    for name, struct in structs.items():
        assert getattr(compiled, f"size_of_{name}")() == ctypes.sizeof(struct), name
        for field, _ in struct._fields_:
            assert getattr(compiled, f"{name}_{field}")() == getattr(struct, field).offset, (name, field)
