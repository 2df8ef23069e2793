"""Clustering and dendrogram against TetGen, on real models of 10,000 to 60,000 faces."""

from statistics import median

import models
from programs import Failure, stages

OURS = ("cluster", "dendrogram")
PIPELINE = ("solid", "cluster", "dendrogram", "hierarchy")
CPU, WALL = 1, 0

# A machine has two whole cores for us while two clusterings at once, a thread each, take at most so many times as long
# as one alone at its fastest. A virtual machine often has less.
WHOLE = 1.1


def measure(quick):
    files, source = models.real(10_000, 60_000)
    if quick:
        files = models.spread(files, 12)
    print(f"   {len(files)} models of {source}")
    built, refused = [], {}
    for file in files:
        report, why_not = stages(file, 3 if quick else 5)
        if report is None:
            refused[file.stem] = why_not
            continue
        built.append({"model": file.stem, **report, **ratios(report)})
        now = built[-1]
        print(f"   {file.stem}: {now['faces']} faces, HTC/TetGen {now['htc']:.2f}, two threads/one "
              f"{now['two_threads']:.2f}, pipeline/TetGen {now['pipeline']:.2f}")
    if not built:
        raise Failure("no model could be built")
    print(f"   {len(built)} built, {len(refused)} refused")
    return {"source": source, "models": built, "refused": refused,
            **{name: median(model[name] for model in built)
               for name in ("htc", "two_threads", "pipeline", "regrouping")},
            "two_cores": on_two_cores(built)}


def ratios(report):
    """Each the median over the repetitions. Stages of one thread are counted in processor time, which others on the
    machine disturb least; two threads against one in wall time, which is what they are there to save."""
    def over_tetgen(parts):
        return median(sum(r[part][CPU] for part in parts) / r["tetgen"][CPU] for r in report["seconds"])

    return {"htc": over_tetgen(OURS), "pipeline": over_tetgen(PIPELINE),
            "regrouping": median(r["regroup"][CPU] / sum(r[part][CPU] for part in PIPELINE) for r in report["seconds"]),
            "two_threads": median(map(two_over_one, report["seconds"]))}


def two_over_one(turn):
    return turn["cluster_two_threads"][WALL] / turn["cluster"][WALL]


def on_two_cores(built):
    """Two threads against one in those turns in which there were two whole cores; how many these are; and of all turns
    how long two clusterings at once took."""
    ratios, at_once, turns = [], [], 0
    for report in built:
        alone = min(turn["cluster"][WALL] for turn in report["seconds"])
        longer = [turn["cluster_twice"][WALL] / alone for turn in report["seconds"]]
        whole = [two_over_one(turn) for turn, at in zip(report["seconds"], longer, strict=True) if at <= WHOLE]
        ratios += [median(whole)] if whole else []
        at_once += longer
        turns += len(whole)
    return {"two_threads": median(ratios) if ratios else None, "models": len(ratios), "turns": turns,
            "of": len(at_once), "at_once": median(at_once), "whole": WHOLE}
