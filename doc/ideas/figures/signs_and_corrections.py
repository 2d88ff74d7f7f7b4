"""Increments of four runs, cycle by cycle: one that shows no sign, two whose signs
have called for a correction, and one that has learnt from coarser meshes."""

import re

import numpy as np

from chart import BLUE, GREEN, ORANGE, PINK, RED, grid, plt
from drawing_of_ideas import Failure

LAYER = "Material/Regions=where abs(y - 0.33) < 0.06: 1e6*E, nu"

# Title, scene, refinements, entries.
RUNS = (("no sign", "block", 3, ()),
        ("slow: a stiff layer, first mesh", "block", 0,
         (LAYER, "Solver/Condensation=never")),
        ("to and fro: friction 10, second mesh", "raous", 1,
         ("Contact/Friction coefficient=10",)),
        ("learnt: friction 10, fifth mesh", "raous", 4,
         ("Contact/Friction coefficient=10",)))

# By how the sentence of a run begins that says what has been tried.
STYLES = (("Algorithm 3 with levels made", "levels made\nof the matrix", GREEN, "s"),
          ("Algorithm 3 with algebraic", "algebraic\ncorrections", ORANGE, "s"),
          ("Algorithm 3", "Algorithm 3", BLUE, "o"),
          ("Complementary pivoting", "pivoting", RED, "D"),
          ("complementary pivoting", "pivoting", RED, "D"),
          ("Newton", "Newton", ORANGE, "D"),
          ("continuation", "continuation", "k", "^"),
          ("Algorithm 2", "Algorithm 2", PINK, "v"))


def attempts_of(directory, n_cycles):
    """Pairs of an attempt on the last level and the number of its cycles, from
    what the run has printed below the row of this level."""
    lines = (directory / "console.txt").read_text().splitlines()
    rows = [i for i, line in enumerate(lines) if re.match(r" +\d+ +\d+ +\d+ ", line)]
    if not rows:
        raise Failure(f"{directory} has no level.")
    attempts = []
    for line in lines[rows[-1] + 1:]:
        attempts += [(name.strip(" ;"), int(cycles)) for name, cycles in re.findall(
            r"([^;]+?),? (?:was given up after|took) (\d+) cycles?", line)]
    return attempts or [("Algorithm 3", n_cycles)]


def style_of(name):
    for begin, label, color, marker in STYLES:
        if name.startswith(begin):
            return label, color, marker
    return name, "k", "o"


def draw_run(axes, workshop, title, scene, levels, entries):
    if workshop.quick:
        levels = min(levels, 2)
    name = "signs-" + re.sub(r"\W+", "-", title)
    wanted = (f"Refinement/Levels={levels}", *entries)
    run = workshop.history(2, scene, name, *wanted)
    increment = run.cycles["increment"][run.cycles["level"] == run.last]
    directory = workshop.runs / f"{scene}-2d-{name}"
    begin = 0
    for attempt, n in attempts_of(directory, len(increment)):
        label, color, marker = style_of(attempt)
        cycle = np.arange(begin, begin + n)
        axes.semilogy(1 + cycle, increment[begin:begin + n], marker, color=color,
                      linestyle="-", linewidth=0.8, markersize=3 if n < 60 else 1.5)
        begin += n
        yield label, color
    axes.set_title(title, fontsize=10, loc="left")
    axes.set_ylim(1e-12, 1e2)
    axes.set_xlim(0, max(10, 1.04 * len(increment)))
    axes.tick_params(labelsize=9)
    grid(axes)


def draw(workshop):
    figure, panels = plt.subplots(2, 2, figsize=(6.3, 4.6), sharey=True)
    seen = {}
    for axes, run in zip(panels.flat, RUNS):
        seen.update(draw_run(axes, workshop, *run))
    for axes in panels[1]:
        axes.set_xlabel("cycle", fontsize=10)
    for axes in panels[:, 0]:
        axes.set_ylabel("increment", fontsize=10)
    figure.legend([plt.Line2D([], [], color=color, linewidth=2) for color in
                   seen.values()], [label.replace("\n", " ") for label in seen],
                  loc="lower center", ncols=len(seen), fontsize=9, frameon=False)
    figure.subplots_adjust(left=0.1, right=0.985, top=0.94, bottom=0.185,
                           hspace=0.35, wspace=0.08)
    workshop.save(figure, "signs-and-corrections")
