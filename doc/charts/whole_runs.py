"""Below chart 3: what a user waits for, and what of it are solutions, beside an older
state. Drawn from what benchmark-runs has measured, doc/benchmark/runs.txt."""

import re
from pathlib import Path

from chart import (BLUE, DataError, GREY, ORANGE, axes_below, headline, plt,
                   save)

RESULTS = Path(__file__).resolve().parents[1] / "benchmark" / "runs.txt"
ROW = re.compile(r"^(\S+) +([23])D +(\d+) (now|before) +([\d.]+) +([\d.]+) "
                 r"+([\d.]+)$", re.M)
PARTS = (("solutions", BLUE), ("set-up", ORANGE), ("all else", GREY))


def draw(output):
    runs = {}
    for name, dim, dofs, state, *seconds in ROW.findall(RESULTS.read_text()):
        label = f"{name}, {dim}D\n{float(dofs):,.0f} dofs"
        runs.setdefault(label, {})[state] = [float(s) for s in seconds]
    runs = {label: both for label, both in runs.items() if len(both) == 2}
    if not runs:
        raise DataError(f"{RESULTS}: no run has an older state beside it.")

    figure, axes = plt.subplots(figsize=(6.6, 0.62 * len(runs) + 1.5))
    figure.subplots_adjust(left=0.2, right=0.97, bottom=0.45 / figure.get_figheight())
    ratios = []
    for place, (label, both) in enumerate(runs.items()):
        whole = sum(both["before"])
        ratios.append(sum(both["now"]) / whole)
        for state, shift in (("before", -0.2), ("now", 0.2)):
            left = 0
            for (part, color), seconds in zip(PARTS, both[state]):
                axes.barh(place + shift, seconds / whole, 0.36, left / whole,
                          color=color, alpha=0.45 if state == "before" else 1,
                          label=part if place == 0 and state == "now" else None)
                left += seconds
            axes.annotate(f"{state}: {left:.1f} s", (left / whole, place + shift),
                          xytext=(3, 0), textcoords="offset points", va="center",
                          fontsize=7, color="0.3")
    axes.set_yticks(range(len(runs)), list(runs))
    axes.invert_yaxis()
    axes.set_xlim(0, 1.16)
    axes.set_xlabel("time, as a part of that of the older state")
    for side in ("top", "right", "left"):
        axes.spines[side].set_visible(False)
    axes.tick_params(axis="y", length=0)
    axes.legend(loc="lower left", bbox_to_anchor=(-0.01, 1.), ncol=3, fontsize=8,
                frameon=False)
    top = headline(figure, f"Whole runs take {min(ratios):.2f} to {max(ratios):.2f} "
                   "of the time that they took",
                   "One process, default output; set-up is degrees of freedom, "
                   "assembly and levels. The older state is pale.")
    axes_below(figure, top, 0.25)
    save(figure, output, "whole-runs.svg")
