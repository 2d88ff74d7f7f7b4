"""Chart 3: time and memory of all solvers against the number of unknowns."""

import numpy as np

from chart import (DataError, Table, axes_below, exponent, grid, headline,
                   labels_at_right, plt, save, solver_style)

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


def draw(data, output, name, subject, patience):
    table = Table(data / f"scaling-{name}.csv", COLUMNS)
    seconds = table["setup_seconds"] + table["solve_seconds"]
    # One that has been stopped has not arrived, however good its last iterate.
    stopped = ((table["solver"] == "gauss-seidel") &
               (table["solve_seconds"] >= patience))
    solved = (table["converged"] == 1) & ~stopped
    if np.any(seconds <= 0) or np.any(table["memory_bytes"][solved] <= 0):
        raise DataError(f"{table.path}: a time or memory that cannot be.")
    figure, axes = plt.subplots(2, 1, figsize=(7, 7), sharex=True)
    figure.subplots_adjust(left=0.1, right=0.7, bottom=0.07,
                           hspace=0.07)
    names = list(dict.fromkeys(table["solver"]))
    growths = {}
    for solver in names:
        good = (table["solver"] == solver) & solved
        growths[solver] = growth(table["dofs"][good], seconds[good])
    axes_below(figure, headline(figure, message(growths), subject), 0.08)

    for panel, values in zip(axes, (seconds, 1e-6 * table["memory_bytes"])):
        panel.set_xscale("log")
        panel.set_yscale("log")
        grid(panel)
        ends = [draw_solver(panel, table, values, solved, solver,
                            failures=panel is axes[0]) for solver in names]
        figure.canvas.draw()
        labels_at_right(panel, [end for end in ends if end is not None],
                        header=panel is axes[0])
    triangle_of_slope_one(axes[0])
    axes[0].text(1.06, 1.0, "solver, growth exponent",
                 transform=axes[0].transAxes, fontsize=8, fontweight="bold",
                 va="top")
    axes[0].set_ylabel("seconds, set-up and solution")
    axes[1].set_ylabel("megabytes, without the matrix")
    axes[1].set_xlabel("degrees of freedom $N$")
    if not solved.all():
        axes[0].text(0.02, 0.97, "x: not solved", transform=axes[0].transAxes,
                     fontsize=8, va="top")
    save(figure, output, f"scaling-{name}.svg")


def draw_solver(panel, table, values, solved, solver, failures):
    """The line of a solver, and where its name belongs: the last value, the name
    with the growth exponent, and the colour. Nothing if there is nothing of it."""
    color, marker, line = solver_style(solver)
    here = (table["solver"] == solver) & (values > 0)
    x, y = table["dofs"][here & solved], values[here & solved]
    panel.plot(x, y, line, color=color, marker=marker, markersize=4.5,
               linewidth=2 if solver == "algorithm 3" else 1.2,
               zorder=4 if solver == "algorithm 3" else 3)
    failed = here & ~solved
    if failures:
        panel.plot(table["dofs"][failed], values[failed], "x", color=color,
                   markersize=7, zorder=5)
        if failed.any() and not len(x):
            return (values[failed][-1], f"{solver}  not solved", color)
    if not len(x):
        return None
    if x.max() < 0.3 * table["dofs"].max():
        # The line ends early, and has its name there.
        panel.annotate(f"{solver}  {growth(x, y)}",
                       (x.max(), y[np.argmax(x)]), xytext=(7, 0),
                       textcoords="offset points", va="center", color=color,
                       fontsize=8, zorder=6,
                       bbox={"facecolor": "white", "edgecolor": "none",
                             "alpha": 0.85, "pad": 0.8})
        return None
    return (y[np.argmax(x)], f"{solver}  {growth(x, y)}", color)


def triangle_of_slope_one(axes):
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
