# SPDX-License-Identifier: GPL-3.0-or-later
"""Why stops miss limbs: prints, for each kind of target of artists' models, how many are found, how many the initial parts
cross, and of the rest whether the best node lacks a piece or is too large; last, the best overlap if all that lies beyond a part were
a node as well.

usage: causes.py SCORE DIR TRACES [--fused]

SCORE: the folder of score.py. DIR: the assets, or with --fused what fuse.py made of them. TRACES: what fit.py left in WORK_DIR/before.
"""

import argparse
from pathlib import Path

import numpy as np
from assets import read_assets
from fit import Trace
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components

FOUND = 0.8  # overlap
CUTS = 4, 6, 8, 12, 16, 24, 32, 48  # parts
COLUMNS = "parts", "node", "precision", "recall", "beyond"


def beyond_parts(trace, triangles, parts):
    """(area in each label, area) of each component of the graph of adjacent parts without one of them, without and with that one."""
    nodes = trace.undone(parts)
    of_node = np.full(len(trace.area), -1)
    of_node[nodes] = np.arange(len(nodes))
    for j in range(len(trace.merges) - 1, -1, -1):
        if of_node[trace.parts + j] >= 0:
            of_node[trace.merges[j]] = of_node[trace.parts + j]
    edges = np.sort(np.concatenate([triangles[:, sides] for sides in ((0, 1), (1, 2), (2, 0))]), axis=1)
    face, order = np.tile(of_node[trace.part_of_face], 3), np.lexsort(edges.T)
    edges, face = edges[order], face[order]
    at = np.flatnonzero((edges[1:] == edges[:-1]).all(axis=1) & (face[1:] != face[:-1]))
    graph = csr_matrix((np.ones(len(at)), (face[at], face[at + 1])), shape=(len(nodes),) * 2)
    sums = np.column_stack([trace.area_in_label[nodes], trace.area[nodes]])
    result = []
    for part in range(len(nodes)):
        others = np.flatnonzero(np.arange(len(nodes)) != part)
        count, component = connected_components(graph[others][:, others], directed=False)
        if count > 1:
            totals = np.zeros((count, sums.shape[1]))
            np.add.at(totals, component, sums[others])
            result += [*totals, *(totals + sums[part])]
    result = np.reshape(result, (-1, sums.shape[1]))
    return result[:, :-1], result[:, -1]


def figures(trace, asset):
    """[(kind, COLUMNS...)] of each target"""
    inside_labels, total = trace.area_in_label, trace.area_in_label[-1]
    mostly = inside_labels[:trace.parts] > 0.5 * trace.area[:trace.parts, None]
    inside, size = (np.where(mostly, area, 0).sum(axis=0) for area in (inside_labels[:trace.parts], trace.area[:trace.parts, None]))
    node = trace.overlap.argmax(axis=0)
    best = trace.overlap.max(axis=0)
    in_node = inside_labels[node, np.arange(len(total))]
    beyond = best.copy()
    for parts in CUTS:
        within, area = beyond_parts(trace, asset.triangles, parts)
        beyond = np.maximum(beyond, (within / (area[:, None] + total - within)).max(axis=0, initial=0))
    columns = inside / (size + total - inside), best, in_node / trace.area[node], in_node / total, beyond
    return [(kind, *(column[2 * t + 1] for column in columns)) for t, kind in enumerate(asset.kinds)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("score", "assets", "traces"):
        parser.add_argument(name, type=Path)
    parser.add_argument("--fused", action="store_true")
    args = parser.parse_args()
    rows = [row for asset in read_assets(args.score, args.assets, args.fused)
            for row in figures(Trace(args.traces / f"{asset.name}.trace", asset), asset)]
    print(f"{'':32} share ", *(f"{name:>9}" for name in COLUMNS))
    for kind in sorted({row[0] for row in rows}):
        of_kind = np.array([row[1:] for row in rows if row[0] == kind])
        parts, best, precision, recall, _ = of_kind.T
        is_found, is_crossed = best > FOUND, parts < FOUND
        for name, chosen in (("all", best >= 0), ("found", is_found), ("initial parts cross it", ~is_found & is_crossed),
                             ("lacks a piece", ~is_found & ~is_crossed & (recall < precision)),
                             ("too large", ~is_found & ~is_crossed & (recall >= precision))):
            if chosen.any():
                print(f"{kind:8} {name:23} {chosen.mean():5.2f} ", *(f"{x:9.3f}" for x in of_kind[chosen].mean(axis=0)))


if __name__ == "__main__":
    main()
