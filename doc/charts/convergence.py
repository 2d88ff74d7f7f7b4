"""Chart 2: the error of the iterates against time, and when each solver is as
good as the mesh."""

import numpy as np

from chart import (DataError, Table, axes_below, grid, headline, plt, save,
                   solver_style, times)

COLUMNS = ("solver", "iteration", "seconds", "relative_error")


def curves(table):
    """Seconds and errors of each solver, in the order of iterations."""
    result = {}
    for name in dict.fromkeys(table["solver"]):
        here = table["solver"] == name
        order = np.argsort(table["iteration"][here])
        result[name] = (table["seconds"][here][order],
                        table["relative_error"][here][order])
    return result


def arrival(curve, error):
    """The seconds of the first iterate from which on the error stays at or below
    the given one; None if there is none."""
    seconds, errors = curve
    above = np.flatnonzero(errors > error)
    first = above[-1] + 1 if len(above) else 0
    return seconds[first] if first < len(seconds) else None


def message(arrivals, goal):
    ours = arrivals.get("algorithm 3")
    if ours is None:
        return f"Algorithm 3 does not reach {goal}"
    newton = {name: seconds for name, seconds in arrivals.items()
              if name.startswith("newton") and seconds is not None}
    if not newton:
        return (f"Algorithm 3 reaches {goal} in {ours:.2g} s, and Newton's method "
                "not at all")
    best = min(newton, key=newton.get)
    if ours == 0:
        return f"The first guess is at {goal} already"
    ratio = newton[best] / ours
    # The other one may have been left out, where it would take too long.
    which = ("the best of Newton's methods" if len(newton) > 1
             else "the only one of Newton's methods that was run")
    if 0.95 < ratio < 1.05:
        return (f"Algorithm 3 reaches {goal} as soon as {which}, "
                f"{best}")
    if ratio > 1:
        return (f"Algorithm 3 reaches {goal} {times(ratio)} times sooner than "
                f"{which}, {best}")
    return (f"Algorithm 3 reaches {goal} {times(1 / ratio)} times later than "
            f"{which}, {best}")


def draw(data, output, name, subject):
    table = Table(data / f"convergence-{name}.csv", COLUMNS)
    goal = table.remark("discretisation_error")
    lines = curves(table)
    for family in ("algorithm 3", "newton"):
        if not any(solver.startswith(family) for solver in lines):
            raise DataError(f"{table.path}: nothing of {family}.")
    # Where the first guess is as good as the mesh already, a user would stop at a
    # tenth, which is what the option of the solver does.
    start = max(errors[0] for _, errors in lines.values())
    target, goal_name = goal, "the discretisation error"
    if start <= 1.5 * goal:
        target, goal_name = goal / 10, "a tenth of the discretisation error"
    arrivals = {solver: arrival(line, target) for solver, line in lines.items()}

    figure, axes = plt.subplots(figsize=(7, 4.3))
    figure.subplots_adjust(left=0.095, right=0.63, bottom=0.105)
    axes.set_xscale("log")
    axes.set_yscale("log")
    seconds = table["seconds"]
    positive = table["relative_error"][table["relative_error"] > 0]
    if np.any(table["relative_error"] < 0) or not np.any(seconds > 0):
        raise DataError(f"{table.path}: errors or seconds that cannot be.")
    low, high = positive.min() / 2, positive.max() * 5
    left = seconds[seconds > 0].min() / 3
    axes.set_ylim(low, high)
    axes.set_xlim(left, seconds.max() * 1.3)
    grid(axes)
    for solver, (t, errors) in lines.items():
        color, marker, line = solver_style(solver)
        axes.plot(t[1:], np.maximum(errors[1:], low), line,
                  color=color, marker=marker, markersize=4,
                  markevery=max(1, len(t) // 12),
                  linewidth=2 if solver == "algorithm 3" else 1.2,
                  zorder=4 if solver == "algorithm 3" else 3)
        if arrivals[solver] is not None:
            axes.plot(max(arrivals[solver], left), target, marker, color=color,
                      markersize=8, markerfacecolor="white",
                      markeredgewidth=1.4, zorder=5)
    axes.axhline(start, color="0.6", linewidth=0.8)
    axes.axhline(goal, color="k", linewidth=1)
    axes.axhline(goal / 10, color="k", linewidth=0.8, linestyle=(0, (1, 2)))
    # The line of the first guess is named above it, the others below.
    for height, text, above in ((start, "first guess", True),
                                (goal, "discretisation error", False),
                                (goal / 10, "a tenth of it", False)):
        axes.annotate(text, (0, height), xycoords=("axes fraction", "data"),
                      xytext=(3, 2 if above else -2),
                      textcoords="offset points", fontsize=7.5,
                      va="bottom" if above else "top")
    axes.set_xlabel("seconds, set-up included")
    axes.set_ylabel("energy error of the iterate, relative")

    # Names in the order of arrival, beside the seconds.
    order = sorted(lines, key=lambda solver: (arrivals[solver] is None,
                                              arrivals[solver] or 0))
    axes.text(1.06, 1.0, f"seconds to\n{goal_name}",
              transform=axes.transAxes, fontsize=8, va="top",
              fontweight="bold")
    for i, solver in enumerate(order):
        color, marker, line = solver_style(solver)
        y = 0.86 - 0.07 * i
        axes.plot([1.06, 1.105, 1.15], [y] * 3, line, color=color,
                  marker=marker, markevery=[1], markersize=5, clip_on=False,
                  transform=axes.transAxes, linewidth=1.2)
        axes.text(1.18, y, solver, transform=axes.transAxes, color=color,
                  fontsize=8, va="center")
        text = ("never" if arrivals[solver] is None
                else f"{arrivals[solver]:.2g}")
        axes.text(1.66, y, text, transform=axes.transAxes, color=color,
                  fontsize=8, va="center", ha="right")
    if any(solver.startswith("linear") for solver in lines):
        axes.text(1.06, 0.86 - 0.07 * len(order),
                  "linear: contact phases bonded,\nerror of that linear problem",
                  transform=axes.transAxes, fontsize=7, va="top", color="0.35")
    dofs = f"{int(table.remark('dofs')):,}".replace(",", " ")
    axes_below(figure, headline(figure, message(arrivals, goal_name),
                                f"{subject} N = {dofs}."), 0.08)
    save(figure, output, f"convergence-{name}.svg")
