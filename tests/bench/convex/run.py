# SPDX-License-Identifier: GPL-3.0-or-later
"""Convex parts beside CoACD and V-HACD: runs what has not been measured yet, and prints the tables.

usage: run.py [--anew TOOL]... [--only TOOL]... [--tables] [--picture FILE] PEERS_PYTHON BENCHMARK|-

What it measures is written to build/bench/convex as it comes: see scripts/bench_convex."""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import models
import numpy as np
import tables
from drop import dropped
from measures import measured
from tables import TOOLS

STORE = models.ROOT / "build" / "bench" / "convex"
EQUAL = 8, 16, 32
DROPPED = 10
PICTURE = 4, 12, 32
SPARE = 4  # CoACD, even fast, takes its time: for these numbers it is asked on every fourth model only


class Results:
    """A file of figures and one of hulls for each run of a tool. number: how many hulls, or whose own number that is."""

    def __init__(self, peers, only):
        self.peers, self.only = peers, only
        STORE.mkdir(parents=True, exist_ok=True)

    def of(self, table, model, number, tool):
        """The figures, or None."""
        path = self.path(table, model, number, tool, "json")
        figures = json.loads(path.read_text()) if path.exists() else None
        return figures if figures and ("wall" in figures or "failed" in figures) else None  # else of an older version

    def hulls(self, table, model, number, tool):
        with np.load(self.path(table, model, number, tool, "npz")) as saved:
            return np.split(saved["points"], np.cumsum(saved["counts"])[:-1])

    @staticmethod
    def path(table, model, number, tool, ending):
        return STORE / f"{table}, {model}, {number}, {tool}.{ending}"

    def measure(self, table, model, number, tool, hulls, load):
        """The figures. load() gives what the tool gets and what its hulls are held against: (vertices, triangles) each."""
        known = self.of(table, model, number, tool)
        if known or (self.only and tool not in self.only):
            return known
        mesh, whole = load()
        target, figures = (self.path(table, model, number, tool, ending) for ending in ("npz", "json"))
        python = sys.executable if tool == "ours" else self.peers
        with tempfile.TemporaryDirectory() as folder:
            source = Path(folder) / "model.npz"
            np.savez(source, vertices=mesh[0], triangles=mesh[1])
            process = subprocess.run([python, Path(__file__).with_name("one.py"), tool, str(hulls), source, target],
                                     stderr=subprocess.PIPE, text=True)
        if process.returncode:
            result = {"failed": (process.stderr.strip().splitlines() or [f"ended with {process.returncode}"])[-1]}
        else:
            with np.load(target) as saved:
                result = {"seconds": float(saved["seconds"]), "wall": float(saved["wall"]), "memory": int(saved["memory"])}
            result |= measured(self.hulls(table, model, number, tool), *whole)
        print(f"{table}, {model}, {number}, {tool}: {result}", file=sys.stderr, flush=True)
        partial = figures.with_suffix(".partial")
        partial.write_text(json.dumps(result, indent=1))
        partial.replace(figures)
        return result


def at_its_own(results, table, model, whose, load):
    """All tools, at the number of hulls that CoACD finds by its defaults, or fast."""
    its = results.measure(table, model, whose, whose, 0, load)
    if its and "hulls" in its:
        for tool in "V-HACD", "ours":
            results.measure(table, model, whose, tool, its["hulls"], load)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--anew", action="append", default=[], choices=TOOLS)
    parser.add_argument("--only", action="append", default=[], choices=TOOLS)
    parser.add_argument("--tables", action="store_true")
    parser.add_argument("--picture")
    parser.add_argument("peers")
    parser.add_argument("benchmark")
    options = parser.parse_args()
    results = Results(options.peers, options.only)
    for tool in options.anew:
        for path in STORE.glob(f"*, {tool}.json"):
            path.unlink()
    clean = models.clean(None if options.benchmark == "-" else options.benchmark)
    if options.picture:
        beside(results, options.picture)
        return
    if not options.tables:
        measure(results, clean)
    tables.show(results, clean)
    drops(results, clean)


def drops(results, clean):
    """A table: ten models dropped, of which both CoACD's parts and ours are there."""
    def has(name, tool):
        return "hulls" in (results.of("clean", name, "CoACD, fast", tool) or {})

    columns = "exact", *TOOLS[1:]
    print("\n| dropped | hulls | " + " | ".join(f"{tool}: moved, degrees, ms a step" for tool in columns) + " |")
    print("|---" * (len(columns) + 2) + "|")
    rows = []
    for name in [name for name in spread(clean) if has(name, "CoACD, fast") and has(name, "ours")][:DROPPED]:
        parts = {tool: results.hulls("clean", name, "CoACD, fast", tool) for tool in TOOLS[1:] if has(name, tool)}
        rows.append(dropped(*models.read(clean[name]), parts))
        print(f"| {name} | {len(parts['ours'])} | " + " | ".join(drop_cell(rows[-1].get(tool)) for tool in columns) + " |",
              flush=True)
    if rows:
        of = {tool: [row[tool] for row in rows if tool in row] for tool in columns}
        print("| median | | " + " | ".join(drop_cell(np.median(of[tool], axis=0) if of[tool] else None) for tool in columns)
              + " |")


def drop_cell(moved):
    return "" if moved is None else f"{moved[0]:.2%}, {moved[1]:.1f}, {moved[2]:.3f}"


def loads(path):
    return lambda: (models.read(path),) * 2


def beside(results, target):
    """Draws the parts of the example figure: CoACD's above, ours below."""
    sys.path[:0] = [str(models.ROOT / "scripts" / "docs_parts")]
    from draw import draw_bodies, read, save
    from scipy.spatial import ConvexHull
    figure = read(None, "figure")[:2]
    for number in PICTURE:
        for tool in "CoACD, fast", "ours":
            results.measure("picture", "figure", number, tool, number, lambda: (figure, figure))

    def bodies(number, tool):
        return [(points, ConvexHull(points).simplices) for points in results.hulls("picture", "figure", number, tool)]

    model = draw_bodies([figure], 420)
    save([[model, *(draw_bodies(bodies(number, tool), 420) for number in PICTURE)] for tool in ("CoACD, fast", "ours")],
         Path(target))


def spread(clean):
    """In an order in which the first few are of all kinds."""
    return [name for start in range(SPARE) for name in list(clean)[start::SPARE]]


def measure(results, clean):
    """What matters most first."""
    for name in spread(clean):
        for whose in "CoACD, fast", "CoACD":
            at_its_own(results, "clean", name, whose, loads(clean[name]))
    for name, recipe in models.broken(clean).items():
        at_its_own(results, "broken", name, "CoACD, fast", lambda recipe=recipe: (models.mutated(*recipe), models.read(recipe[0])))
    for place, name in enumerate(spread(clean)):
        for number in EQUAL:
            for tool in ("ours", "V-HACD", "CoACD, fast") if place < len(clean) // SPARE else ("ours", "V-HACD"):
                results.measure("clean", name, number, tool, number, loads(clean[name]))


if __name__ == "__main__":
    main()
