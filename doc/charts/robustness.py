#!/usr/bin/env python3
"""Draws how fast and how reliably solvers solve problems drawn at random:

    robustness.py TABLE OUTPUT

a performance profile as of Dolan and Moré (Math. Program. 91, 2002): the share of
problems that a solver solves in at most a given multiple of the time of whichever
is the fastest on each."""

import csv
import sys
from collections import defaultdict
from pathlib import Path

import numpy as np

from chart import DataError, SOLVERS, axes_below, grid, headline, plt, save

BLACK = ("k", "", "-")
STYLES = {"default": BLACK, **SOLVERS}


def read(path):
    """Seconds by dimension, problem and solver, infinite if it failed; unknowns by
    dimension and problem, none if no solver was tried."""
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    seconds, dofs = defaultdict(lambda: defaultdict(dict)), defaultdict(int)
    for row in rows:
        dim, seed = int(row["dim"]), int(row["seed"])
        solved = row["converged"] == "1"
        seconds[dim][seed][row["solver"]] = (
            float(row["seconds"]) if solved else np.inf)
        dofs[dim, seed] = max(dofs[dim, seed], int(row["dofs"] or 0))
    if not seconds:
        raise DataError(f"{path}: there are no data.")
    return seconds, dofs


def profile(problems, solver):
    """Sorted ratios to the fastest; problems that no solver solves count as unsolved."""
    ratios = []
    for of_solver in problems.values():
        fastest = min(of_solver.values())
        ratios.append(of_solver[solver] / fastest if np.isfinite(fastest)
                      else np.inf)
    return np.sort(ratios)


def is_first(of_solver):
    """Whether the default solves a problem sooner than Newton's method does,
    whichever way that solves its linear systems."""
    others = [s for name, s in of_solver.items() if name.startswith("newton")]
    return np.isfinite(of_solver["default"]) and of_solver["default"] <= min(others)


def message(seconds):
    parts = []
    for dim, problems in sorted(seconds.items()):
        all_of = problems.values()
        solved = sum(np.isfinite(of["default"]) for of in all_of)
        first = sum(is_first(of) for of in all_of)
        parts.append(f"{solved} of {len(problems)} problems in {dim}D, and sooner "
                     f"than both of Newton's in "
                     f"{100 * first / len(problems):.0f} %")
    return "The default solves " + "; ".join(parts)


def print_by_size(seconds, dofs):
    """Small problems take a millisecond or two, whatever the solver."""
    print("dim  unknowns      problems  solved  sooner than Newton's method")
    for dim, problems in sorted(seconds.items()):
        for low, high in ((0, 1000), (1000, 3000), (3000, None)):
            those = [of for seed, of in problems.items()
                     if low <= dofs[dim, seed] < (high or np.inf)]
            solved = sum(np.isfinite(of["default"]) for of in those)
            first = sum(is_first(of) for of in those)
            print(f"{dim:3}  {low:5} to {high or '':5} {len(those):8} {solved:7} "
                  f"{first:8}")


def draw(table, output):
    seconds, dofs = read(table)
    print_by_size(seconds, dofs)
    figure, axes = plt.subplots(1, len(seconds), figsize=(7, 3.4), sharey=True,
                                squeeze=False)
    figure.subplots_adjust(left=0.075, right=0.985, bottom=0.28, wspace=0.12)
    for panel, (dim, problems) in zip(axes[0], sorted(seconds.items())):
        solvers = list(dict.fromkeys(name for of in problems.values()
                                     for name in of))
        for solver in solvers:
            ratios = profile(problems, solver)
            color, marker, line = STYLES[solver]
            finite = ratios[np.isfinite(ratios)]
            share = np.arange(1, len(finite) + 1) / len(ratios)
            panel.step(np.append(finite, 1e4), np.append(share, share[-1:]),
                       line, where="post", color=color, label=solver)
        panel.set_xscale("log")
        panel.set_xlim(1, 1000)
        panel.set_ylim(0, 1.02)
        panel.set_title(f"{dim}D, {len(problems)} problems")
        panel.set_xlabel("time, in multiples of the fastest")
        grid(panel)
    axes[0, 0].set_ylabel("share solved")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncol=5, fontsize=8)
    axes_below(figure, headline(figure, message(seconds),
                                "Random problems, the same for all solvers: "
                                "share solved within a multiple of the time of "
                                "the fastest."), 0.27)
    save(figure, output, "robustness.svg")


if __name__ == "__main__":
    try:
        draw(Path(sys.argv[1]), Path(sys.argv[2]))
    except DataError as error:
        sys.exit(str(error))
