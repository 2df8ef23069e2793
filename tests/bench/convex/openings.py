# SPDX-License-Identifier: GPL-3.0-or-later
"""Models with openings in hulls by each tool: how much of their openings stays free, and the volume of the hulls.

usage: openings.py PEERS_PYTHON"""

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "core"))

import open_models  # noqa: E402  (found only now)

TOOLS = "ours", "CoACD", "CoACD, fast", "V-HACD"
MODELS = {"house": open_models.house, "plate": lambda: open_models.plate(64), **open_models.MODELS}
MIN_HULLS = 12


def run(tool, python, shape, hulls, folder):
    """Corners of the hulls that a tool makes in its own process, or None."""
    source, target = folder / "model.npz", folder / "hulls.npz"
    np.savez(source, vertices=shape.vertices, triangles=shape.triangles)
    one = Path(__file__).with_name("one.py")
    if subprocess.run([python, one, tool, str(hulls), source, target], stderr=subprocess.DEVNULL).returncode:
        return None
    with np.load(target) as saved:
        return np.split(saved["points"], np.cumsum(saved["counts"])[:-1])


def main():
    peers = sys.argv[1]
    print("| model | hulls at most | " + " | ".join(f"{tool}: free, volume, hulls" for tool in TOOLS) + " |")
    print("|---" * (len(TOOLS) + 2) + "|", flush=True)
    for name, create in MODELS.items():
        shape = create()
        limit = max(MIN_HULLS, shape.exact)
        cells = []
        with tempfile.TemporaryDirectory() as folder:
            for tool in TOOLS:
                hulls = run(tool, sys.executable if tool == "ours" else peers, shape, limit, Path(folder))
                cells.append(f"{1 - open_models.covered(hulls, shape.openings).mean():.1%}, "
                             f"{open_models.volume_ratio(hulls, shape):.3f}, {len(hulls)}" if hulls else "failed")
        print(f"| {name} | {limit} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
