# SPDX-License-Identifier: GPL-3.0-or-later
"""The library as it is installed: a C program finds it through CMake and through pkg-config, and gets what Python gets."""

import os
import subprocess

import pytest
from conftest import ROOT

EXAMPLE, MODEL, FACE = ROOT / "native" / "examples", ROOT / "build" / "deps" / "meshes" / "hand.off", 100

pytestmark = pytest.mark.skipif("PARTWHEEL_LIBRARY" in os.environ, reason="it is the release that is installed")


def run(*command, **environment):
    process = subprocess.run(list(map(str, command)), capture_output=True, text=True, env={**os.environ, **environment})
    assert process.returncode == 0, process.stdout + process.stderr
    return process.stdout


@pytest.fixture(scope="module")
def prefix(tmp_path_factory):
    """An installed tree that has been moved since."""
    staged = tmp_path_factory.mktemp("staged")
    run("cmake", "--install", ROOT / "build" / "release", "--prefix", "/opt/partwheel", DESTDIR=str(staged))
    return (staged / "opt" / "partwheel").rename(staged / "moved")


@pytest.fixture
def expected(build_shape):
    _, hierarchy = build_shape("hand.off")
    stops, start = hierarchy.wheel(FACE)
    return "".join(f"node {node}: {len(hierarchy.faces(node))} faces{' *' * (place == start)}\n"
                   for place, node in enumerate(stops))


def test_only_declared_files_are_installed(prefix):
    installed = {path.relative_to(prefix).as_posix() for path in prefix.rglob("*") if not path.is_dir()}
    assert installed == {
        "include/partwheel.h", "include/partwheel_edit.h", "include/partwheel_types.h", "lib/libpartwheel.so",
        "lib/libpartwheel.so.0.1", "lib/libpartwheel.so.0.1.0", "lib/pkgconfig/partwheel.pc",
        "lib/cmake/partwheel/partwheel-config.cmake", "lib/cmake/partwheel/partwheel-config-release.cmake",
        "lib/cmake/partwheel/partwheel-config-version.cmake"}
    assert "SONAME               libpartwheel.so.0.1\n" in run("objdump", "-p", prefix / "lib" / "libpartwheel.so")
    assert "no symbols" in run("objdump", "-t", prefix / "lib" / "libpartwheel.so")


def test_through_cmake(prefix, expected, build_shape, tmp_path):
    run("cmake", "-S", EXAMPLE, "-B", tmp_path, f"-DCMAKE_PREFIX_PATH={prefix}")
    run("cmake", "--build", tmp_path)
    assert run(tmp_path / "wheel", MODEL, FACE, tmp_path / "saved") == expected
    assert (tmp_path / "saved").read_bytes() == build_shape("hand.off")[1].save()


def test_through_pkg_config(prefix, expected, tmp_path):
    flags = run("pkg-config", "--cflags", "--libs", "partwheel", PKG_CONFIG_PATH=str(prefix / "lib" / "pkgconfig"))
    run("cc", "-std=c11", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-o", tmp_path / "wheel", EXAMPLE / "wheel.c",
        *flags.split())
    environment = {"LD_LIBRARY_PATH": str(prefix / "lib")}
    assert run(tmp_path / "wheel", MODEL, FACE, **environment) == expected
    refused = subprocess.run([tmp_path / "wheel", MODEL, "99999999"], env={**os.environ, **environment}, capture_output=True,
                             text=True)
    assert (refused.returncode, refused.stderr) == (1, "99999999: The hierarchy has no face of this index.\n")
