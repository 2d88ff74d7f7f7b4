"""A body with a single contact node, whose normal force given and found are drawn
against each other; and a run with much friction that does not converge."""

import numpy as np

from chart import BLUE, GREY, RED, grid, plt

# The body of the test tests/algorithms/multiple_solutions.cc: one square cell, held
# at its top and at its right.
YOUNG, POISSON, FRICTION, PRESS = 1.0, 0.3, 4.0, 1.0

# Load to the right; where the iteration that is drawn starts, and what is shown.
EXAMPLES = {"pulled to the left": (-3.0, 0.47, (0, 1.3)),
            "pushed to the right": (5.0, 1.25, (0.7, 1.7))}


class Node:
    """The contact node, with the entries of its stiffness: a against moving, b
    couples sliding with lifting."""

    def __init__(self, load):
        lame = YOUNG * POISSON / (1 + POISSON) / (1 - 2 * POISSON)
        shear = YOUNG / 2 / (1 + POISSON)
        self.load = load
        self.a = (lame + 3 * shear) / 3
        self.b = (lame + shear) / 4

    def found(self, given):
        """The normal force of the solution with the normal force given."""
        bound = FRICTION * given
        rest = np.sign(self.load) * max(0, abs(self.load) - bound)
        return max(0, PRESS + self.b * rest / self.a)

    def fixed_points(self):
        """They lie on the three parts of the map: open, sliding, sticking."""
        sign = np.sign(self.load)
        slope = sign * FRICTION * self.b / self.a
        sliding = (PRESS + self.b * self.load / self.a) / (1 + slope)
        return [tau for tau in (0, sliding, PRESS)
                if tau >= 0 and abs(self.found(tau) - tau) < 1e-12]


def draw_map(axes, node, title, start, limits, steps):
    given = np.linspace(*limits, 801)
    axes.plot(limits, limits, color=GREY, linewidth=0.8)
    axes.plot(given, [node.found(tau) for tau in given], color="k",
              linewidth=1.8)
    path, tau = [], start
    for _ in range(steps):
        path += [(tau, tau), (tau, node.found(tau))]
        tau = node.found(tau)
    axes.plot(*zip(*path), color=RED, linewidth=1.0)
    axes.plot(*path[0], "o", color=RED)
    for tau in node.fixed_points():
        axes.plot(tau, tau, "o", color="k", markersize=7, zorder=4,
                  markerfacecolor="white", clip_on=False)
    axes.set_xlim(limits)
    axes.set_ylim(limits)
    axes.set_aspect("equal")
    axes.set_title(title, fontsize=10, loc="left")
    axes.set_xlabel(r"$\tau$ given", fontsize=10)
    grid(axes)


def draw_run(axes, workshop):
    """Increments on the level where the iteration ends, and how many components
    are held there, which is what phases amount to."""
    run = workshop.history(
        2, "raous", "large-friction", "Contact/Friction coefficient=10",
        "Solver/Safeguards=false", fails=True)
    increment, held = run.cycles["increment"], run.cycles["truncated"]
    shown = np.flatnonzero(run.cycles["level"] == run.last)[:60]
    cycle = 1 + np.arange(len(shown))
    axes.semilogy(cycle, increment[shown], color=BLUE, linewidth=1.0)
    for number, style in zip(np.unique(held[shown]), ("^", "o", "s", "v", "D")):
        chosen = held[shown] == number
        axes.plot(cycle[chosen], increment[shown][chosen], style, color=BLUE,
                  markersize=4.5, label=f"{number} components held",
                  markerfacecolor=BLUE if number % 2 else "white")
    axes.legend(fontsize=10, ncols=2, loc="upper right", borderaxespad=0,
                handletextpad=0.2)
    axes.set_xlabel("cycle", fontsize=10)
    axes.set_ylabel("increment", fontsize=10)
    grid(axes)


def draw(workshop):
    figure = plt.figure(figsize=(6.3, 5.6))
    maps = [figure.add_axes([left, 0.5, 0.4, 0.45]) for left in (0.09, 0.58)]
    for axes, (title, example) in zip(maps, EXAMPLES.items()):
        load, start, limits = example
        draw_map(axes, Node(load), title, start, limits, 6)
    maps[0].set_ylabel(r"$\tau$ found", fontsize=10)
    draw_run(figure.add_axes([0.13, 0.085, 0.855, 0.27]), workshop)
    for axes in figure.axes:
        axes.tick_params(labelsize=9)
    workshop.save(figure, "large-friction")
