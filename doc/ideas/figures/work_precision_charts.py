"""Two of the charts with what to look at marked in them, drawn from the data in
doc/charts/data; nothing is run."""

import numpy as np

from chart import (BLUE, GREY, ORANGE, RED, Table, crossing, exponent, grid, plt,
                   times)
from convergence import curves
from drawing_of_ideas import DOC

DATA = DOC / "charts" / "data"
STYLES = {"uniform": (RED, "s"), "adaptive": (BLUE, "o")}
SOLVERS = {"algorithm 3": ("Algorithm 3", BLUE, "o", "left"),
           "newton gmres": ("Newton, GMRES", ORANGE, "P", "right")}


def table(name):
    return Table(DATA / f"{name}.csv", ())


def draw_errors(axes, quantity, title):
    tables = {name: table(f"work-precision-hertz-{name}") for name in STYLES}
    axes.set_xscale("log")
    axes.set_yscale("log")
    for name, (color, marker) in STYLES.items():
        axes.plot(tables[name]["total_seconds"], tables[name][quantity],
                  marker + "-", color=color, label=name)
    # The smallest error that both have reached, and the seconds for that.
    error = (1 + 1e-9) * max(known[quantity].min() for known in tables.values())
    seconds = {name: crossing(known["total_seconds"], known[quantity], error)
               for name, known in tables.items()}
    axes.annotate("", (seconds["adaptive"], error), (seconds["uniform"], error),
                  arrowprops={"arrowstyle": "->", "color": "k",
                              "linewidth": 1.3, "shrinkA": 4, "shrinkB": 2})
    axes.annotate(f"{times(seconds['uniform'] / seconds['adaptive'])} times",
                  (seconds["adaptive"], error), xytext=(-8, 0), ha="right",
                  va="center", textcoords="offset points", fontsize=10)
    slope = exponent(tables["adaptive"]["total_seconds"],
                     tables["adaptive"][quantity])
    axes.text(0.03, 0.05, "a tenth of the error:\n"
              f"{times(10 ** (-1 / slope))} times the seconds", color=BLUE,
              transform=axes.transAxes, fontsize=10)
    axes.set_title(title, fontsize=10, loc="left")
    axes.set_xlabel("seconds", fontsize=10)
    grid(axes)


def draw_iterates(axes):
    known = table("convergence-hertz")
    error = known.remark("discretisation_error")
    lines = curves(known)
    axes.set_yscale("log")
    axes.axhspan(1e-12, error, color="0.93", zorder=0)
    axes.axhline(error, color=GREY, linewidth=1.2)
    for solver, (name, color, marker, side) in SOLVERS.items():
        seconds, errors = lines[solver]
        axes.plot(seconds, errors, marker + "-", color=color)
        shown = np.flatnonzero(errors > 1e-7)[-1]
        axes.annotate(name, (seconds[shown], errors[shown]), color=color,
                      xytext=(7 if side == "left" else -7, 0), ha=side,
                      textcoords="offset points", va="center", fontsize=10)
    axes.annotate("error of the mesh", (1, error), xytext=(-2, 5),
                  xycoords=("axes fraction", "data"), ha="right",
                  textcoords="offset points", fontsize=10, color="0.3")
    axes.set_ylim(1e-8, 0.3)
    axes.set_xlim(left=-0.1)
    axes.set_xlabel("seconds", fontsize=10)
    axes.set_ylabel("error of the iterate", fontsize=10)
    grid(axes)


def draw(workshop):
    figure = plt.figure(figsize=(6.3, 5.8))
    left, right, lower = (figure.add_axes(box) for box in (
        [0.11, 0.57, 0.39, 0.38], [0.60, 0.57, 0.39, 0.38],
        [0.11, 0.085, 0.88, 0.33]))
    draw_errors(left, "energy_error", "displacement, energy norm")
    draw_errors(right, "pressure_error", "contact pressure")
    left.set_ylabel("relative error", fontsize=10)
    left.legend(fontsize=10, loc="upper right", borderaxespad=0,
                handletextpad=0.4)
    draw_iterates(lower)
    for axes in figure.axes:
        axes.tick_params(labelsize=9)
    workshop.save(figure, "work-precision-charts")
