"""How phases settle: the components that the phases of the contact nodes hold, and
the increments, over the cycles of runs of the scene 'hertz' that begin from nothing
on a fine mesh."""

import numpy as np

from chart import BLUE, GREEN, ORANGE, grid, plt
from drawing_of_ideas import Failure


def cycles(workshop, name, *entries):
    return workshop.history(
        2, "hertz", name, "Refinement/Strategy=uniform", "Refinement/Levels=0",
        f"Refinement/Initial refinements={2 if workshop.quick else 6}",
        *entries).cycles


def draw(workshop):
    solved = "Solver/Coarse correction=algebraic"
    runs = ((cycles(workshop, "cycle"), BLUE, "o", "-", "multigrid cycle"),
            (cycles(workshop, "solved", solved), ORANGE, "D", "--",
             "solved"),
            (cycles(workshop, "solved-frictionless", solved,
                    "Contact/Friction law=none"), GREEN, "^", ":",
             "solved, no friction"))
    figure, (held, increments) = plt.subplots(
        2, 1, figsize=(6.3, 4.6), sharex=True,
        gridspec_kw={"height_ratios": [1, 1.6]})
    figure.subplots_adjust(left=0.12, right=0.98, top=0.98, bottom=0.1,
                           hspace=0.12)
    for run, color, marker, line, name in runs:
        truncated = run["truncated"]
        if truncated[-1] != truncated[-2]:
            raise Failure("The phases have not settled.")
        number = np.arange(1, len(truncated) + 1)
        held.plot(number, truncated, line, color=color, marker=marker)
        increments.semilogy(number, run["increment"], line, color=color,
                            marker=marker, label=name)
        # From here on the phases are those of the solution.
        settled = np.argmax(np.flip(np.cumsum(
            np.flip(truncated != truncated[-1]))) == 0)
        increments.semilogy(number[settled], run["increment"][settled], marker,
                            color="w", markeredgecolor=color, markersize=9,
                            markeredgewidth=1.6)
    held.set_ylabel("components held")
    held.set_ylim(0, None)
    increments.set_ylabel("increment")
    increments.set_xlabel("cycle")
    increments.legend(loc="upper right")
    for axes in (held, increments):
        grid(axes)
    workshop.save(figure, "phases-and-newton")
