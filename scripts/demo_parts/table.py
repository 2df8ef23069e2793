"""Prints the demo's table of sizes and times from perform.py's reports.

Run as: python table.py FOLDER MODEL...   Writes FOLDER/table.md and FOLDER/table.csv and prints the first. The last
line of the output is a summary.
"""

import csv
import json
import sys
from pathlib import Path

STAGES = ("surface", "repair", "tetrahedra", "cluster", "dendrogram", "hierarchy")
COLUMNS = ("model", "from", "shells", "faces", "tets", "nodes", "saved kB", *(f"{stage} s" for stage in STAGES), "build s",
           "stops", "notch ms", "parts", "result")


def row(report):
    """The cells of one model, in the order of COLUMNS."""
    seconds, clicks = report["seconds"], report["clicks"]
    return [*(report[name] for name in ("model", "source", "shells", "faces", "tetrahedra", "nodes")),
            round(report["saved_bytes"] / 1000), *(f"{seconds[stage]:.3f}" for stage in STAGES),
            f"{seconds['whole']:.2f}", ", ".join(str(click["hidden"] + len(click["stops"])) for click in clicks),
            ", ".join(f"{1000 * click['seconds_per_stop']:.0f}" for click in clicks), report.get("parts", ""),
            report["fill_method"]]


def markdown(rows):
    cells = [[str(cell) for cell in line] for line in rows]
    widths = [max(len(line[column]) for line in cells) for column in range(len(COLUMNS))]
    lines = ["| " + " | ".join(cell.ljust(width) for cell, width in zip(line, widths)) + " |" for line in cells]
    lines.insert(1, "|" + "|".join("-" * (width + 2) for width in widths) + "|")
    return "\n".join(lines)


def main():
    folder = Path(sys.argv[1])
    reports = [json.loads((folder / f"{name}.json").read_text("utf-8")) for name in sys.argv[2:]]
    rows = [COLUMNS, *map(row, reports)]
    notes = [f"{report['model']}: {report['notes']}" for report in reports if report.get("notes")]
    text = "\n".join([markdown(rows), "", *notes])
    (folder / "table.md").write_text(text + "\n", "utf-8")
    with open(folder / "table.csv", "w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows(rows)
    print(text)
    stops = sum(click["hidden"] + len(click["stops"]) for report in reports for click in report["clicks"])
    print(f"{len(reports)} models, {stops} wheel stops selected and checked, "
          f"{sum(report.get('parts', 0) for report in reports)} objects made")


if __name__ == "__main__":
    main()
