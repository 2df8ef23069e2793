# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes a model of an archive of assets as an OFF file. The archive has NAME.npz with V (V, 3) and F (T, 3).

usage: asset.py ARCHIVE NAME OUT.off
"""

import sys
import tarfile

import numpy as np


def main():
    archive, name, out = sys.argv[1:]
    with tarfile.open(archive) as files, files.extractfile(f"tune/{name}.npz") as file:
        arrays = np.load(file)
        vertices, triangles = arrays["V"], arrays["F"]
    with open(out, "w", encoding="ascii") as target:
        print(f"OFF\n{len(vertices)} {len(triangles)} 0", file=target)
        np.savetxt(target, vertices, "%.9g")
        np.savetxt(target, np.insert(triangles, 0, 3, axis=1), "%d")


if __name__ == "__main__":
    main()
