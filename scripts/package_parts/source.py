"""Builds the source distribution. It has everything that `pip install` needs besides g++ and CMake, including the
headers of CGAL, Boost and Eigen that the library includes, and TetGen's source."""

import pathlib
import re
import shutil
import subprocess
import tempfile

from platforms import ROOT

DEPS = ROOT / "build" / "deps"
INCLUDED = ("CMakeLists.txt", "CMakePresets.json", "cmake", "native/CMakeLists.txt", "native/include", "native/src",
        "native/python", "native/partwheel.map", "pyproject.toml", "scripts/package_parts/description.py", "LICENSE", "README.md",
        "CHANGELOG.md")
# Boost has other headers for each compiler: all of these are included.
COMPILER_HEADERS = ("root/usr/include/boost/config", "root/usr/include/boost/predef")


def distribution(target, builds):
    """Writes partwheel-VERSION.tar.gz to target. builds: build directories of the library; the headers used there are
    included."""
    with tempfile.TemporaryDirectory() as directory:
        folder = pathlib.Path(directory) / "partwheel"
        for name in INCLUDED:
            if (ROOT / name).is_dir():
                shutil.copytree(ROOT / name, folder / name, ignore=shutil.ignore_patterns("__pycache__", "*.so", "*.dll"))
            else:
                folder.joinpath(name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(ROOT / name, folder / name)
        names = {name for build in builds for name in _included(build)} | _included_by_gcc()
        names |= {path.relative_to(DEPS) for name in COMPILER_HEADERS for path in (DEPS / name).rglob("*") if path.is_file()}
        names |= {path.relative_to(DEPS) for path in (DEPS / "root/usr/share/doc").glob("*/copyright") if path.is_file()}
        names |= {path.relative_to(DEPS) for path in (DEPS / "tetgen-0.8.0").rglob("*")
                  if path.suffix in {".h", ".cxx"} or path.name.startswith("LICENSE")}
        for name in names:
            (folder / "build/deps" / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(DEPS / name, folder / "build/deps" / name)
        subprocess.run(["pyproject-build", "--sdist", "--no-isolation", "--outdir", target, folder], check=True,
                       capture_output=True)


def _included(build):
    """The headers under build/deps that a build included, from ninja's log."""
    output = subprocess.run(["ninja", "-C", build, "-t", "deps"], check=True, capture_output=True, text=True).stdout
    for name in set(re.findall(r"^\s+(?:\S*/)?build/deps/(\S+)$", output, re.M)):
        yield pathlib.Path(name)


def _included_by_gcc():
    """The headers under build/deps that g++ includes: Boost's headers differ by compiler."""
    sources = [*(ROOT / "native/src").rglob("*.cpp"), *(DEPS / "tetgen-0.8.0/src").glob("*.cxx")]
    options = [option for folder in ("root/usr/include", "root/usr/include/eigen3", "tetgen-0.8.0/src")
              for option in ("-isystem", DEPS / folder)]
    output = subprocess.run(["g++", "-std=c++20", "-M", "-fno-canonical-system-headers", "-DNDEBUG", "-DTETLIBRARY",
                             "-DCGAL_DISABLE_GMP=1", "-DCGAL_DISABLE_MPFR=1", "-I", ROOT / "native/include",
                             "-I", ROOT / "native/src", *options, *sources], check=True, capture_output=True, text=True).stdout
    return {pathlib.Path(name) for name in re.findall(rf"{re.escape(str(DEPS))}/(\S+)", output)}
