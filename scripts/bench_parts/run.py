"""Runs benchmark sections, writes each report to build/bench/SECTION.json, and prints the table of all reports.

Called by scripts/bench, which documents the arguments.
"""

import argparse
import datetime
import json
import sys

import any_mesh
import assets
import deform
import large
import plot
import points
import queries
import ratio
import scale
import table
import worst
from programs import BUILD, ROOT, Failure, machine

SECTIONS = {"any": any_mesh,
            **{module.__name__: module for module in (assets, points, ratio, scale, worst, queries, deform, large)}}


def main():
    parser = argparse.ArgumentParser(prog="scripts/bench", description="Measures, and prints which goals are met.")
    parser.add_argument("section", nargs="*", help=" ".join(SECTIONS))
    parser.add_argument("--quick", action="store_true", help="fewer and smaller models, some 3 minutes")
    parser.add_argument("--docs", action="store_true", help="also update docs/benchmarks.md and docs/images")
    arguments = parser.parse_args()
    for name in arguments.section:
        if name not in SECTIONS:
            parser.error(f"there is no section {name}: {', '.join(SECTIONS)}")

    for name in arguments.section or SECTIONS:
        print(f"== {name}: {SECTIONS[name].__doc__.splitlines()[0]}")
        start = datetime.datetime.now()
        measured = SECTIONS[name].measure(arguments.quick)
        seconds = (datetime.datetime.now() - start).total_seconds()
        report = {"quick": arguments.quick, "date": f"{start:%Y-%m-%d}", "seconds": round(seconds), **machine(),
                  **measured}
        path = BUILD / f"{name}.json"
        path.write_text(json.dumps(report, indent=1) + "\n")
        print(f"   {seconds:.0f} s, {path.relative_to(ROOT)}")

    reports = {name: json.loads((BUILD / f"{name}.json").read_text()) for name in SECTIONS
               if (BUILD / f"{name}.json").exists()}
    text = table.text(reports)
    (BUILD / "table.md").write_text(text)
    if "scale" in reports:
        plot.draw(reports["scale"], BUILD / "scale.png")
    print(f"\n{text}")
    if arguments.docs:
        table.into_docs(text, reports)
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except Failure as reason:
        print(f"bench: FAILED: {reason}", file=sys.stderr)
        sys.exit(1)
