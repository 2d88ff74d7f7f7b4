"""Algorithms 2 and 3 on one level of the Hertz scene, cycle by cycle."""

import numpy as np

from chart import BLUE, GREY, PINK, grid, plt

ALGORITHMS = {2: "fixed point", 3: "Gauss-Seidel like"}


class Cycles:
    """The cycles of a run on one level: their increments, and how far the energy
    is from `end`, as parts of it."""

    def __init__(self, run, level):
        here = run.cycles["level"] == level
        self.increment = run.cycles["increment"][here]
        self.energy = run.cycles["energy"][here]
        self.changes = None
        if run.outer:
            self.changes = run.outer["change"][run.outer["level"] == level]
        self.number = 1 + np.arange(len(self.increment))

    def parts(self):
        """One slice for each outer iteration: it ends with the first increment
        that is small enough."""
        ends = 1 + np.flatnonzero(self.increment <= 1e-9)
        return [slice(begin, end) for begin, end in zip((0, *ends[:-1]), ends)]


def draw_increments(axes, two, three):
    axes.axhline(1e-9, color=GREY, linewidth=0.8, linestyle=":")
    for part in two.parts():
        axes.plot(two.number[part], two.increment[part], "v-", color=PINK)
    axes.plot(three.number, three.increment, "o-", color=BLUE)
    ends = [part.stop for part in two.parts()]
    axes.plot(ends, two.changes, "s", color="k", markersize=5,
              markerfacecolor="white", zorder=4)
    axes.set_ylabel("relative change")
    axes.text(ends[0] + 0.7, two.changes[0], "normal forces of Algorithm 2",
              va="center", fontsize=10)
    axes.text(three.number[-1] + 0.7, three.increment[-1] * 0.45,
              "Algorithm 3", color=BLUE, va="center", fontsize=10,
              bbox={"facecolor": "white", "edgecolor": "none", "pad": 1})
    axes.text(two.number[ends[0]] + 0.7, two.increment[ends[0]], "Algorithm 2",
              color=PINK, va="center", fontsize=10)
    axes.set_ylim(5e-11, 1)


def draw_energies(axes, two, three):
    end = two.energy[-1]
    for run, parts, style, color in ((two, two.parts(), "v-", PINK),
                                     (three, [slice(None)], "o-", BLUE)):
        error = (run.energy - end) / abs(end)
        for part in parts:
            axes.plot(run.number[part], np.abs(error[part]), style[-1],
                      color=color, linewidth=0.9)
        for below, face in ((False, color), (True, "white")):
            chosen = (error < 0) == below
            axes.plot(run.number[chosen], np.abs(error[chosen]), style[0],
                      color=color, markerfacecolor=face, zorder=3)
    axes.set_ylim(2e-11, 3e-3)
    axes.set_ylabel("energy: distance\nto the last value")
    axes.set_xlabel("cycle")
    axes.text(0.97, 0.85, "open: below the last value", ha="right",
              transform=axes.transAxes, fontsize=10)


def draw(workshop):
    level = 3 if workshop.quick else 6
    two, three = (Cycles(workshop.history(
        2, "hertz", f"two-algorithms-{number}", f"Refinement/Levels={level}",
        "Solver/Safeguards=false", f"Solver/Algorithm={name}"), level)
        for number, name in ALGORITHMS.items())
    figure, axes = plt.subplots(2, 1, figsize=(6.3, 5.2), sharex=True)
    figure.subplots_adjust(left=0.14, right=0.985, top=0.985, bottom=0.09,
                           hspace=0.08)
    for panel in axes:
        panel.set_yscale("log")
        panel.tick_params(labelsize=9)
        grid(panel)
    draw_increments(axes[0], two, three)
    draw_energies(axes[1], two, three)
    for panel in axes:
        panel.yaxis.label.set_size(10)
        panel.xaxis.label.set_size(10)
    workshop.save(figure, "two-algorithms")
