# SPDX-License-Identifier: GPL-3.0-or-later
"""What partwheel batch costs, see scripts/bench_batch. Prints tables in Markdown.

Runs to be compared take turns, so that what else the machine does hits both; figures are medians. Processor time is that
of a run's processes, all together.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(ROOT / "native" / "python")}
PARTWHEEL = [sys.executable, "-m", "partwheel"]
CLASSES = (1_000, 5_000, 20_000, 50_000, 200_000)  # faces; a class goes up to the next
MAKE = "hierarchy,cut,colliders,preview"
TINY = 100


def timed(command, stdin=None):
    """(seconds by the clock, seconds of processor time) of a command and all that it starts."""
    before, start_time = os.times(), time.monotonic()
    result = subprocess.run(command, input=stdin, text=True, stdout=subprocess.DEVNULL, env=ENVIRONMENT)
    wall, after = time.monotonic() - start_time, os.times()
    if result.returncode not in (0, 1):  # 1: some models are refused, by both
        sys.exit(f"{command} ended with {result.returncode}")
    return wall, after.children_user + after.children_system - before.children_user - before.children_system


def batch(models, folder, jobs=2, make="hierarchy"):
    return timed([*PARTWHEEL, "batch", *models, "-o", folder, "--jobs", str(jobs), "--make", make])


def parallel(models, folder, jobs=2):
    Path(folder).mkdir()
    return timed(["parallel", "--will-cite", f"-j{jobs}", *PARTWHEEL, "build", "{}", "-o", f"{folder}/{{/.}}", "--json"],
                 "\n".join(models))


def boxes(folder):
    paths = []
    for number in range(TINY):
        x = 1 + number / TINY
        paths.append(str(folder / f"{number}.off"))
        Path(paths[-1]).write_text(f"OFF\n4 4 0\n0 0 0\n{x} 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n")
    return paths


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("models", type=Path)
    parser.add_argument("--every", type=int, default=8)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--dollars", type=float, default=0.04)
    options = parser.parse_args()
    models = [str(path) for path in sorted(options.models.glob("*.off"))[::options.every]]
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        print(f"{len(models)} models, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f} when it began\n")
        beside(folder, models, options.rounds)
        scaling(folder, models, options.rounds)
        classes(folder, models, options.dollars)


def beside(folder, models, rounds):
    print("| beside GNU parallel over `partwheel build`, 2 at a time | batch | parallel | throughput |\n|---|---|---|---|")
    tiny = boxes(folder)
    for name, paths in (("the models", models), (f"{TINY} tetrahedra", tiny)):
        runs = [(batch(paths, folder / f"b{len(paths)}{index}"), parallel(paths, folder / f"p{len(paths)}{index}"))
                for index in range(rounds)]
        for measure, at in (("seconds by the clock", 0), ("processor seconds", 1)):
            one, other = (statistics.median(run[side][at] for run in runs) for side in (0, 1))
            ratio = statistics.median(run[1][at] / run[0][at] for run in runs)
            print(f"| {name}, {measure} | {one:.2f} | {other:.2f} | {ratio:.2f} |")
    start = statistics.median(batch(tiny[:1], folder / f"one{index}")[1] for index in range(rounds))
    print(f"\nA model that is nothing to build: {1000 * (one - start) / (TINY - 1):.0f} ms of processor time in batch (with its "
          f"worker process), {1000 * other / TINY:.0f} ms alone. Beginning: {start:.2f} s.\n")


def scaling(folder, models, rounds):
    print("| models at a time | seconds by the clock | of one at a time |\n|---|---|---|")
    runs = {jobs: [] for jobs in sorted({1, 2, 4, os.cpu_count()})}
    for index in range(rounds):
        for jobs in runs:
            runs[jobs].append(batch(models, folder / f"s{jobs}{index}", jobs)[0])
    for jobs, seconds in runs.items():
        speed = statistics.median(one / other for one, other in zip(runs[1], seconds))
        print(f"| {jobs} | {statistics.median(seconds):.1f} | {speed:.2f} |")
    print()


def classes(folder, models, dollars):
    _, processor = batch(models, folder / "all", 1, MAKE)
    reports = [json.loads(path.read_text()) for path in (folder / "all" / "models").rglob("model.json")]
    reports = [report for report in reports if not report["error"]]
    print(f"| faces ({MAKE}) | models | processor seconds | kB a model |\n|---|---|---|---|")
    for low, high in zip((0, *CLASSES), (*CLASSES, float("inf"))):
        those = [report for report in reports if low <= report["faces"] < high]
        if those:
            print(f"| {low:,} to {high:,} | {len(those)} | "
                  f"{statistics.median(report['processor_seconds'] for report in those):.2f} | "
                  f"{statistics.median(sum(report['files'].values()) for report in those) / 1000:.0f} |")
    hours = processor / len(models) * 1e6 / 3600
    disk = statistics.mean(sum(report["files"].values()) for report in reports)
    print(f"\nA million such models: {hours:,.0f} core hours of processor time, {disk * 1e6 / 1e12:.2f} TB in "
          f"{6e6:,.0f} files at most, {hours * dollars:,.0f} dollars at {dollars} a core hour.")


if __name__ == "__main__":
    main()
