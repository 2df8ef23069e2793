# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of convex parts, as the docs have them, from what has been measured so far."""

from statistics import median

import models

TOOLS = "CoACD", "CoACD, fast", "V-HACD", "ours"
NUMBERS = {"CoACD": "CoACD's", "CoACD, fast": "CoACD's, fast", 8: "8", 16: "16", 32: "32"}


def show(results, clean):
    broken = list(models.broken(clean))
    summary(results, "clean", list(clean))
    for number in "CoACD", "CoACD, fast":
        each(results, "clean", list(clean), number)
    summary(results, "broken", broken)
    each(results, "broken", broken, "CoACD, fast")


def known(results, table, names, number, tool):
    """{name: figures} of those that were measured and did not fail."""
    results_of = {name: results.of(table, name, number, tool) for name in names}
    return {name: figures for name, figures in results_of.items() if figures and "failed" not in figures}


def failures(results, table, names, number, tool):
    return sum("failed" in (results.of(table, name, number, tool) or {}) for name in names)


def summary(results, table, names):
    """A line for each tool and number of hulls: medians over the models that it was run on, and beside ours on the same."""
    print(f"\n| hulls | {table} models | made | volume | ours is no larger on | hulls beyond: most, 99 % | missed: most, 99 % | "
          "s | times ours | wall s | times ours | MB | failed |")
    print("|---" * 13 + "|")
    for number, called in NUMBERS.items():
        own_row = known(results, table, names, number, "ours")
        for tool in TOOLS:
            rows = known(results, table, names, number, tool)
            if not rows:
                continue
            both = [name for name in rows if name in own_row]
            fewer = sum(own_row[name]["volume"] <= rows[name]["volume"] for name in both)
            middle = {column: median(row[column] for row in rows.values()) for column in next(iter(rows.values()))}
            comparison = "", "", ""
            if both and tool != "ours":
                times, wall = (median(rows[name][key] / own_row[name][key] for name in both) for key in ("seconds", "wall"))
                comparison = f"{fewer} of {len(both)}", f"{times:.1f}", f"{wall:.1f}"
            print(f"| {called} | {tool}, {len(rows)} | {middle['hulls']:.0f} | {middle['volume']:.3f} | {comparison[0]} | "
                  f"{middle['beyond']:.2%}, {middle['beyond 99']:.2%} | {middle['missed']:.2%}, {middle['missed 99']:.2%} | "
                  f"{middle['seconds']:.2f} | {comparison[1]} | {middle['wall']:.2f} | {comparison[2]} | {middle['memory'] / 1e6:.0f} | "
                  f"{failures(results, table, names, number, tool)} |")


def each(results, table, names, number):
    """A line for each model."""
    tools = [tool for tool in TOOLS if known(results, table, names, number, tool)]
    if not tools:
        return
    print(f"\n| {table} model | hulls | " + " | ".join(f"{tool}: volume, s" for tool in tools) + " |")
    print("|---" * (len(tools) + 2) + "|")
    for name in names:
        rows = [results.of(table, name, number, tool) for tool in tools]
        if not any(rows):
            continue
        hulls = next((row["hulls"] for row in rows if row and "hulls" in row), "")
        cells = ["" if not row else "failed" if "failed" in row else f"{row['volume']:.3f}, {row['seconds']:.2f}"
                 for row in rows]
        print(f"| {name} | {hulls} | " + " | ".join(cells) + " |")
