"""Measures the time of clustering and dendrogram relative to TetGen's, on real models with 10,000 to 60,000 faces."""

from statistics import median

import models
from programs import Failure, stages

HTC = ("cluster", "dendrogram")
PIPELINE = ("solid", "cluster", "dendrogram", "hierarchy")
CPU = 1  # the index of processor time in a stage's (wall, processor) seconds


def measure(quick):
    files, source = models.real_models(10_000, 60_000)
    if quick:
        files = models.evenly_spaced(files, 12)
    print(f"   {len(files)} models of {source}")
    built, refused = [], {}
    for file in files:
        report, reason = stages(file, 3 if quick else 5)
        if report is None:
            refused[file.stem] = reason
            continue
        built.append({"model": file.stem, **report, **ratios(report)})
        model = built[-1]
        print(f"   {file.stem}: {model['faces']} faces, HTC/TetGen {model['htc']:.2f}, pipeline/TetGen "
              f"{model['pipeline']:.2f}")
    if not built:
        raise Failure("no model could be built")
    print(f"   {len(built)} built, {len(refused)} refused")
    return {"source": source, "models": built, "refused": refused,
            **{name: median(model[name] for model in built) for name in ("htc", "pipeline", "merge_policy")}}


def ratios(report):
    """Medians over the repetitions. They compare processor time, which depends little on the machine's load."""
    def ratio(numerator, denominator):
        return median(sum(run[stage][CPU] for stage in numerator) / sum(run[stage][CPU] for stage in denominator)
                      for run in report["seconds"])

    return {"htc": ratio(HTC, ["tetgen"]), "pipeline": ratio(PIPELINE, ["tetgen"]),
            "merge_policy": ratio(["merge_policy"], PIPELINE)}
