"""Chart 3: time and memory of all solvers against the number of unknowns."""

import numpy as np

from chart import (DataError, Table, exponent, grid, headline, labels_at_right,
                   plt, save, solver_style)

COLUMNS = ("dofs", "solver", "converged", "setup_seconds", "solve_seconds",
           "memory_bytes")


def growth(x, y):
    value = exponent(x, y) if len(x) > 1 else None
    return "" if value is None else f"{value:.2f}"


def message(growths):
    ours = growths.get("algorithm 3", "")
    newton = {name: value for name, value in growths.items()
              if name.startswith("newton") and value}
    if not ours:
        return "Algorithm 3 has not solved enough levels to speak of growth"
    text = f"The time of Algorithm 3 grows like $N^{{{ours}}}$"
    if newton:
        text += ", that of " + " and ".join(
            f"{name} like $N^{{{value}}}$" for name, value in newton.items())
    return text


def draw(data, output, name, subject):
    table = Table(data / f"scaling-{name}.csv", COLUMNS)
    solved = table["converged"] == 1
    seconds = table["setup_seconds"] + table["solve_seconds"]
    if np.any(seconds <= 0) or np.any(table["memory_bytes"] < 0):
        raise DataError(f"{table.path}: a time or memory that cannot be.")
    figure, axes = plt.subplots(2, 1, figsize=(7, 7), sharex=True)
    figure.subplots_adjust(left=0.1, right=0.7, top=0.9, bottom=0.07,
                           hspace=0.07)
    growths = {}
    for panel, values, scale in ((axes[0], seconds, 1),
                                 (axes[1], table["memory_bytes"], 1e-6)):
        panel.set_xscale("log")
        panel.set_yscale("log")
        grid(panel)
        ends = []
        for solver in dict.fromkeys(table["solver"]):
            color, marker, line = solver_style(solver)
            here = (table["solver"] == solver) & (values > 0)
            good, bad = here & solved, here & ~solved
            x, y = table["dofs"][good], scale * values[good]
            panel.plot(x, y, line, color=color, marker=marker, markersize=4.5,
                       linewidth=2 if solver == "algorithm 3" else 1.2,
                       zorder=4 if solver == "algorithm 3" else 3)
            if panel is axes[0]:
                panel.plot(table["dofs"][bad], scale * values[bad], "x",
                           color=color, markersize=7, zorder=5)
            rate = growth(x, y)
            if panel is axes[0]:
                growths[solver] = rate
            if len(x):
                last = np.argmax(x)
                ends.append((y[last], f"{solver}  {rate}", color))
            elif panel is axes[0] and bad.any():
                ends.append((scale * values[bad][-1], f"{solver}  not solved",
                             color))
        figure.canvas.draw()
        labels_at_right(panel, ends, header=panel is axes[0])
    draw_slopes(axes[0])
    axes[0].text(1.06, 1.0, "solver, growth exponent",
                 transform=axes[0].transAxes, fontsize=8,
                 fontweight="bold", va="top")
    axes[0].set_ylabel("seconds, set-up and solution")
    axes[1].set_ylabel("megabytes, without the matrix")
    axes[1].set_xlabel("degrees of freedom $N$")
    if not solved.all():
        axes[0].text(0.02, 0.96, "x: not solved", transform=axes[0].transAxes,
                     fontsize=8, va="top")
    headline(figure, message(growths), subject)
    save(figure, output, f"scaling-{name}.svg")


def draw_slopes(axes):
    """A triangle for growth in proportion, to compare the lines with."""
    (x0, x1), (y0, y1) = axes.get_xlim(), axes.get_ylim()
    left = x0 * (x1 / x0) ** 0.68
    right = left * (x1 / x0) ** 0.16
    bottom = y0 * (y1 / y0) ** 0.06
    top = bottom * right / left
    axes.fill([left, right, right], [bottom, bottom, top], facecolor="none",
              edgecolor="k", linewidth=0.8)
    axes.annotate("1", (right, np.sqrt(bottom * top)), xytext=(4, 0),
                  textcoords="offset points", va="center", fontsize=8)
