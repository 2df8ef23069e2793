"""Time of clustering and dendrogram relative to TetGen, on real models with 10,000 to 60,000 faces."""

from statistics import median

import models
from programs import Failure, stages

HTC = ("cluster", "dendrogram")
PIPELINE = ("solid", "cluster", "dendrogram", "hierarchy")
CPU = 1


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
    """Medians over the repetitions, of processor time, which depends least on the machine's load."""
    def over_tetgen(parts):
        return median(sum(r[part][CPU] for part in parts) / r["tetgen"][CPU] for r in report["seconds"])

    return {"htc": over_tetgen(HTC), "pipeline": over_tetgen(PIPELINE),
            "merge_policy": median(r["merge_policy"][CPU] / sum(r[part][CPU] for part in PIPELINE) for r in report["seconds"])}
