"""Plots time and memory against size, with t log^2 t for comparison, like the paper's Figure 10."""

import matplotlib
import numpy as np

matplotlib.use("agg")
import matplotlib.pyplot as plt  # noqa: E402  (after the backend is chosen)


def draw(report, path):
    """report: what scale.measure() returns."""
    sizes = report["sizes"]
    tets = np.array([size["tets"] for size in sizes]) / 1e6
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 3.8), layout="constrained")

    left.plot(tets, [size["htc_seconds"] for size in sizes], "o-", color="tab:blue", label="clustering + dendrogram")
    left.plot(tets, [size["tetgen_seconds"] for size in sizes], "s-", color="tab:orange", label="TetGen")
    # The curve c t log^2 t through the first measurement.
    fine = np.linspace(tets[0], tets[-1], 200)
    per_tet = sizes[0]["htc_seconds"] / tets[0]
    growth = (np.log(1e6 * fine) / np.log(1e6 * tets[0])) ** 2
    left.plot(fine, per_tet * fine * growth, "--", color="gray", label="t log² t")
    left.set_ylabel("seconds, one thread")

    right.plot(tets, [size["cluster_peak"] / 1e9 for size in sizes], "o-", color="tab:blue", label="while clustering")
    right.plot(tets, [size["tetgen_peak"] / 1e9 for size in sizes], "s-", color="tab:orange", label="while TetGen runs")
    right.set_ylabel("peak memory, GB")

    for axes in (left, right):
        axes.set_xlabel("million tetrahedra")
        axes.set_xlim(left=0)
        axes.set_ylim(bottom=0)
        axes.grid(alpha=0.3)
        axes.legend(frameon=False)
    figure.savefig(path, dpi=100)
    plt.close(figure)
