"""The table of results in Markdown: each figure, its goal, whether it is met."""

import pathlib
import shutil
import textwrap

from programs import BUILD, ROOT, Failure

BEGIN, END = "<!-- scripts/bench --docs: from here", "<!-- to here -->"
PLOT = pathlib.Path("docs/images/scale.png")


def text(reports):
    """The table of all sections that have reports."""
    makers = {"ratio": ratio, "scale": scale, "worst": worst, "queries": queries, "deform": deform,
              "any": any_mesh, "assets": assets, "points": points, "large": large}
    rows = [("", "measured", "goal", "holds")]
    for name, rows_of in makers.items():
        if name in reports:
            rows += rows_of(reports[name])
    lines = ["| " + " | ".join(cells) + " |" for cells in rows]
    lines.insert(1, "|---" * len(rows[0]) + "|")
    return "\n".join([*lines, "", footnote(reports)]) + "\n"


def ratio(report):
    count = len(report["models"])
    over = f"median of {count} models of 10k to 60k faces"
    return [
        row(f"clustering + dendrogram / TetGen, one thread, {over}", report["htc"], 0.6, "{:.2f}"),
        row("arrays to saved hierarchy, all stages, one thread / TetGen", report["pipeline"], 1.6, "{:.2f}"),
        row("what the merge policy adds / the stages above", report["merge_policy"], 0.5, "{:.2f}"),
    ]


def scale(report):
    sizes = report["sizes"]
    low, high = sizes[0], sizes[-1]
    span = f"{low['faces'] // 1000}k to {high['faces'] // 1000}k faces"
    # Growth relative to log^2, at the size where it is largest.
    relative_growth = max(size["growth"] / size["log2_growth"] for size in sizes[1:])
    over = max(size["over_tetgen"] for size in sizes) / 1000
    return [
        row(f"time a tetrahedron, {span}: growth / growth of log²", relative_growth, 1.0, "{:.2f}"),
        row("peak memory over TetGen's own, kB a tetrahedron", over, 1.5, "{:.2f}"),
        (f"{high['faces']:,} faces, one thread",
         f"{high['htc_seconds']:.1f} s clustering, {high['tetgen_seconds']:.1f} s TetGen, {high['peak'] / 1e9:.2f} GB",
         "finishes", "yes" if high["faces"] >= 1_000_000 else "not tried"),
    ]


def worst(report):
    rows = []
    for case in report["cases"]:
        name = f"time a tetrahedron / a natural model's: {case['case']}"
        if "error" in case:
            rows.append((name, case["error"], "≤ 5", "**no**"))
        else:
            rows.append(row(f"{name}, {case['faces']:,} faces", case["ratio"], 5, "{:.2f}"))
    return rows


def queries(report):
    faces = f"{report['faces']:,} faces"
    return [
        row(f"longest path, wheel or faces of a node in {report['clicks']:,} clicks, {faces}, ms",
            1000 * report["longest"], 1.0, "{:.3f}"),
        row("loading a saved hierarchy / building it", report["load_over_build"], 0.05, "{:.3f}"),
    ]


def deform(report):
    rows = []
    for size in report["sizes"]:
        move = f"a mouse move that deforms a part of {size['count']:,} vertices"
        rows.append(row(f"{move}, the library alone, ms", 1000 * size["move"]["median"], size["goal"], "{:.1f}"))
        rows += [row(f"{move}, all that Blender {run['blender']} does for it, ms", 1000 * run["whole"],
                     size["goal"], "{:.1f}") for run in size["blenders"]]
    return rows


def any_mesh(report):
    methods = ", ".join(f"{count} {method}" for method, count in report["fill_methods"])
    return [
        row(f"the longest of {len(report['models'])} models ({methods}) / 10 s, or 5 s for each 100,000 faces",
            report["longest"], 1, "{:.2f}"),
        row(f"time of a broken model / of clean ones with as many faces, median of {report['broken']}",
            report["broken_over_clean"], 3, "{:.2f}"),
        row("refused although no sheet, or lost", report["refused"], 0, "{}"),
    ]


def assets(report):
    subject = f"{len(report['models'])} assets as artists have them, s per 100,000 triangles"
    rows = [row(f"{subject}, processor", report["rate"], 3, "{:.1f}"),
            row(f"{subject}, by the clock on {report['cores']} cores", report["rate_all_cores"], 3, "{:.1f}")]
    if report["speedup"]:
        name = f"assets of several shells on {report['cores']} cores / on one, times as fast, median of {report['several']}"
        rows.append(row(name, report["speedup"], 1.8, "{:.2f}", at_least=True))
    return rows


def points(report):
    return [row(f"filled from points: {model['model']}, {model['faces']:,} triangles, s", model["seconds"], model["goal"],
                "{:.1f}") for model in report["models"]]


# Number of faces -> limits on processor seconds and bytes.
LARGE_GOALS = {1_000_000: (5, 1e9), 4_000_000: (20, None), 10_000_000: (None, 8e9)}


def large(report):
    rows = []
    for size in report["sizes"]:
        seconds, max_peak = LARGE_GOALS[size["faces"]]
        name = f"{size['faces']:,} faces on a coarser copy, all stages"
        if seconds:
            rows.append(row(f"{name}, processor s", size["seconds"], seconds, "{:.1f}"))
        if max_peak:
            rows.append(row(f"{name}, peak memory, GB", size["peak"] / 1e9, max_peak / 1e9, "{:.2f}"))
        if "full_resolution" in size:
            rows.append(("the same mesh exactly, processor s", f"{size['full_resolution']['seconds']:.1f}", "", ""))
            rows.append(row(f"overlap of a wheel stop with an exact one, median of {size['overlap']['stops']:,}",
                            size["overlap"]["median"], 0.95, "{:.2f}", at_least=True))
            rows.append(("the same of two exact trees, vertices moved by 1e-6 of the size",
                         f"{size['jittered']['median']:.2f}", "", ""))
    return rows


def row(name, value, goal, form, at_least=False):
    is_met = value >= goal if at_least else value <= goal
    return name, form.format(value), f"{'≥' if at_least else '≤'} {goal:g}", "yes" if is_met else "**no**"


def footnote(reports):
    some = next(iter(reports.values()))
    quick = sorted(name for name, report in reports.items() if report["quick"])
    commits = sorted({report["commit"] for report in reports.values()})
    sentences = [f"{some['processor']}, {some['cores']} cores; {some['date']}, commit {', '.join(commits)}."]
    if "ratio" in reports:
        sentences.append(f"Models: {reports['ratio']['source']}; scale and worst cases against libcgal-demo's bear, "
                         "subdivided.")
    if quick:
        sentences.append(f"Measured with --quick, which is not conclusive: {', '.join(quick)}.")
    return textwrap.fill(" ".join(sentences), 120)


def into_docs(table, reports):
    """Replaces the text between the two marks in docs/benchmarks.md, and the plot."""
    page = ROOT / "docs" / "benchmarks.md"
    before, begin, rest = page.read_text("utf-8").partition(BEGIN)
    mark, end, after = rest.partition(END)
    if not begin or not end:
        raise Failure(f"{page} has no marks '{BEGIN} ...' and '{END}'")
    plot = f"![Time and memory against size]({PLOT.relative_to('docs')})\n\n" if "scale" in reports else ""
    page.write_text(f"{before}{BEGIN}{mark.splitlines()[0]}\n\n{plot}{table}\n{END}{after}", "utf-8")
    if plot:
        shutil.copyfile(BUILD / "scale.png", ROOT / PLOT)
