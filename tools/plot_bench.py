#!/usr/bin/env python3
"""Plots the growth of the cost for docs/performance.md from the output of the benchmarks.

    ./dev bench
    /usr/bin/python3 tools/plot_bench.py build/bench/sinew.json build/bench/steps.json \\
        --out docs/images

The first file is that of `sinew bench --json`, with meshes of several sizes in it. The second, of
sinew_bench --benchmark_filter=ConjugateGradients, is optional. Needs matplotlib (./dev setup
docs). Writes

    performance-size.png      ns a tet and a spring of an explicit step, against the mesh's size
    performance-implicit.png  whole frames and conjugate gradients, against size and iterations
"""

import argparse
import json
import pathlib
import re

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

# Okabe and Ito's colours, which suit any colour vision. Markers differ too.
BLUE, ORANGE, GREEN, RED, PURPLE, GREY = (
    "#0072B2", "#E69F00", "#009E73", "#D55E00", "#CC79A7", "#777777")
STYLE = {("single", 1): (BLUE, "o", "-"), ("single", 2): (BLUE, "s", "--"),
         ("double", 1): (RED, "^", "-"), ("double", 2): (RED, "v", "--")}

plt.rcParams.update({"font.size": 10, "axes.grid": True, "grid.color": "#dddddd",
                     "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False,
                     "lines.markersize": 5, "savefig.dpi": 130})


def series(result, kernel, precision, threads):
    """The rows of a kernel on the beams W(k), from small to large."""
    rows = [r for r in result["rows"] if r["kernel"] == kernel and r["precision"] == precision
            and r["threads"] == threads and r["mesh"].startswith("W(")]
    return sorted(rows, key=lambda r: r["tets"])


def thread_counts(result):
    return sorted({r["threads"] for r in result["rows"]})


def draw(axes, rows, value, label, colour, marker, line="-"):
    if rows:
        axes.plot([r["tets"] for r in rows], [value(r) for r in rows], color=colour, marker=marker,
                  linestyle=line, label=label)


def bound(row):
    return row["ns_per_item"] * row["share_of_bound"]


def threads_text(n):
    return f"{n} thread" if n == 1 else f"{n} threads"


def logarithmic(axes, x, y):
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel(x)
    axes.set_ylabel(y)
    axes.yaxis.set_major_formatter(lambda v, _: f"{v:,g}")
    axes.xaxis.set_major_formatter(lambda v, _: f"{v:,.0f}")
    axes.yaxis.set_minor_formatter(lambda v, _: f"{v:,g}" if f"{v:e}"[0] in "25" else "")


def legend(axes):
    """Below the axes, where no curve is."""
    axes.legend(fontsize=8, loc="upper center", bbox_to_anchor=(0.5, -0.14), ncol=2,
                handlelength=3.5)


def draw_steps(axes, result, kernel, unit):
    for threads in thread_counts(result):
        for precision in ("double", "single"):
            colour, marker, line = STYLE.get((precision, threads), (PURPLE, "D", ":"))
            draw(axes, series(result, kernel, precision, threads), lambda r: r["ns_per_item"],
                 f"{precision}, {threads_text(threads)}", colour, marker, line)
    draw(axes, series(result, kernel, "single", 1), bound, "the machine's limit, single, 1 thread",
         GREY, "", ":")
    logarithmic(axes, "tets", f"time of a step [ns per {unit}]")


def plot_size(result, path):
    figure, (network, springs) = plt.subplots(1, 2, figsize=(10, 5), layout="constrained")
    draw_steps(network, result, "network step", "tet")
    network.set_title("Network law and volume")
    draw_steps(springs, result, "spring step", "spring")
    draw(springs, series(result, "bullet links", "single", 1), lambda r: r["ns_per_item"],
         "Bullet 3.24, links alone, 1 thread", ORANGE, "x")
    draw(springs, series(result, "bullet step", "single", 1), lambda r: r["ns_per_item"],
         "Bullet 3.24, step, 1 thread", GREEN, "+")
    springs.set_title("Springs with dashpots")
    for axes in (network, springs):
        legend(axes)
    figure.savefig(path, bbox_inches="tight")


def gradients(steps):
    """{k: [(iterations, ms)]} of the benchmark ConjugateGradients at rest."""
    found = {}
    for b in steps["benchmarks"]:
        match = re.fullmatch(r"ConjugateGradients/(\d+)/\d+/0", b["name"])
        if match:
            factor = {"ns": 1e-6, "us": 1e-3, "ms": 1.0}[b["time_unit"]]
            found.setdefault(int(match[1]), []).append((b["iterations"],
                                                        b["real_time"] * factor))
    return found


def plot_implicit(result, steps, path):
    figure, panels = plt.subplots(1, 3 if steps else 2, figsize=(13.5 if steps else 10, 5),
                                  layout="constrained")
    frames, products = panels[0], panels[1]
    for kernel, precision, name, colour, marker in (
            ("rest state", "", "rest state", GREEN, "D"),
            ("implicit frame", "", "implicit frame", BLUE, "o"),
            ("network frame", "single", "explicit frame, single", ORANGE, "^")):
        for threads in thread_counts(result):
            draw(frames, series(result, kernel, precision, threads),
                 lambda r: 1e3 * r["time"]["median_s"], f"{name}, {threads_text(threads)}", colour,
                 marker, "-" if threads == 1 else "--")
    frames.axhline(1e3 / 60, color=GREY, linestyle=":")
    frames.annotate("real time", (1, 1e3 / 60), xycoords=("axes fraction", "data"), ha="right",
                    va="bottom", color=GREY, fontsize=8)
    logarithmic(frames, "tets", "time of 1/60 s, or of a rest state [ms]")
    frames.set_title("Whole frames, E = 15 kPa, ν = 0.45")
    legend(frames)

    def per_tet(r):
        return 1e9 * r["time"]["median_s"] / r["tets"] / (r["products"] or 1)

    for kernel, precision, name, colour, marker in (
            ("tangent assembly", "", "assembly of the tangent", RED, "v"),
            ("gradients iteration", "single", "iteration of conjugate gradients", BLUE, "o"),
            ("tangent product", "single", "product with the tangent", PURPLE, "s")):
        draw(products, series(result, kernel, precision, 1), per_tet, name, colour, marker)
    draw(products, series(result, "gradients iteration", "single", 1),
         lambda r: per_tet(r) * r["share_of_bound"], "the machine's limit for an iteration", GREY,
         "", ":")
    logarithmic(products, "tets", "time [ns per tet]")
    products.set_title("Parts of a Newton step, 1 thread")
    legend(products)

    if steps:
        solves = panels[2]
        for (k, points), colour, marker in zip(sorted(gradients(steps).items()),
                                               (BLUE, ORANGE, GREEN, RED), "o^sD"):
            points.sort()
            solves.plot([p[0] for p in points], [p[1] for p in points], color=colour, marker=marker,
                        label=f"W({k})")
        logarithmic(solves, "iterations to a residual of 1e-3, ν = 0.3 to 0.499",
                    "time of a solve [ms]")
        solves.set_title("Conjugate gradients at rest, 1 thread")
        solves.xaxis.set_minor_formatter(lambda v, _: f"{v:.0f}" if f"{v:e}"[0] in "25" else "")
        legend(solves)
    figure.savefig(path, bbox_inches="tight")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bench", type=pathlib.Path, help="JSON of sinew bench")
    parser.add_argument("steps", type=pathlib.Path, nargs="?", help="JSON of sinew_bench")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("docs/images"))
    arguments = parser.parse_args()
    result = json.loads(arguments.bench.read_text(encoding="utf-8"))
    steps = json.loads(arguments.steps.read_text(encoding="utf-8")) if arguments.steps else None
    arguments.out.mkdir(parents=True, exist_ok=True)
    plot_size(result, arguments.out / "performance-size.png")
    plot_implicit(result, steps, arguments.out / "performance-implicit.png")


if __name__ == "__main__":
    main()
