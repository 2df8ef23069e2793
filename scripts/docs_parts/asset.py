# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes an asset, NAME.npz with V (V, 3) and F (T, 3), as an OFF file.

usage: asset.py ASSETS NAME OUT.off

ASSETS: an archive that has tune/NAME.npz, or a folder that has NAME.npz.
"""

import contextlib
import sys
import tarfile
from pathlib import Path

import numpy as np


def main():
    assets, name, out = sys.argv[1:]
    with contextlib.ExitStack() as stack:
        if Path(assets).is_dir():
            file = Path(assets, f"{name}.npz")
        else:
            file = stack.enter_context(tarfile.open(assets)).extractfile(f"tune/{name}.npz")
        arrays = stack.enter_context(np.load(file))
        vertices, triangles = arrays["V"], arrays["F"]
    with open(out, "w", encoding="ascii") as target:
        print(f"OFF\n{len(vertices)} {len(triangles)} 0", file=target)
        np.savetxt(target, vertices, "%.9g")
        np.savetxt(target, np.insert(triangles, 0, 3, axis=1), "%d")


if __name__ == "__main__":
    main()
