# SPDX-License-Identifier: GPL-3.0-or-later
"""A library compiled anew at another path has the same bytes: all of it, without ccache, which would hide a difference.
Some minutes a platform, so only of those that PARTWHEEL_ANEW names, as "linux-arm64 windows-x64"."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "scripts" / "package_parts"))
from platforms import TAGS, library_of  # noqa: E402

ANEW = os.environ.get("PARTWHEEL_ANEW", "").split()


@pytest.mark.parametrize("platform", TAGS)
def test_builds_at_another_path_have_the_same_bytes(platform, tmp_path):
    if platform not in ANEW:
        pytest.skip(f"PARTWHEEL_ANEW does not name {platform}")
    place = tmp_path / "sources"
    place.mkdir()
    names = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True).stdout
    files = subprocess.run(["tar", "-c", "--null", "-T", "-"], cwd=ROOT, check=True, capture_output=True, input=names)
    subprocess.run(["tar", "-x"], cwd=place, check=True, input=files.stdout)
    (place / "build").mkdir()
    for shared in ("deps", "venv"):
        (place / "build" / shared).symlink_to((ROOT / "build" / shared).resolve())
    # zig remembers what it has compiled, too: all but the systems' own libraries.
    alone = {**os.environ, "CCACHE_DISABLE": "1", "ZIG_LOCAL_CACHE_DIR": str(tmp_path / "zig")}
    for command in (f"--preset {platform}",
                    f"--build --preset {platform} --target partwheel --parallel {os.cpu_count()}",
                    f"--install build/{platform} --component python --prefix stage"):
        process = subprocess.run(["cmake", *command.split()], cwd=place, env=alone, capture_output=True, text=True)
        assert process.returncode == 0, process.stdout[-5000:] + process.stderr[-2000:]
    first = ROOT / "build" / platform / "stage" / library_of(platform)
    assert (place / "stage" / library_of(platform)).read_bytes() == first.read_bytes()
