"""The picture of several runs: their contact stresses, their numbers level by level,
and how the solutions were found."""

import textwrap

import numpy as np
from matplotlib.ticker import MaxNLocator

import boundary
from drawing import BLUE, GREEN, ORANGE, PINK, RED, SKY, plt

COLOURS = (BLUE, RED, GREEN, ORANGE, PINK, SKY, "k", "0.55")
# Where results go says nothing about them.
NO_DIFFERENCE = ("Output/",)


def differences(runs):
    """The entries in which the parameters of runs differ."""
    names = {name for run in runs for name in run.entries
             if not name.startswith(NO_DIFFERENCE)}
    return sorted(name for name in names
                  if len({run.entries.get(name) for run in runs}) > 1)


def names_of(runs):
    """A name for each run: its directory, and the scene if there are several, or
    entries that differ if these are not many."""
    different = differences(runs)
    names = []
    for run in runs:
        name = run.directory.resolve().name
        if any(other.scene != run.scene for other in runs):
            name += f" ({run.scene})" if run.scene != name else ""
        elif 0 < len(different) <= 2:
            name += ": " + ", ".join(
                f"{entry.split('/')[-1]} = {run.entries.get(entry, '')}"
                for entry in different)
        names.append(textwrap.shorten(name, 60, placeholder=" ..."))
    return names


def draw_comparison(runs):
    """A figure."""
    stresses = all(run.dim == 2 and run.last in run.contact for run in runs)
    names = names_of(runs)
    columns = 1 if max(map(len, names)) > 45 else 2
    heights = [7.8 if stresses else 5.2, 0.22 * -(-len(runs) // columns) + 0.15]
    figure = plt.figure(figsize=(10, sum(heights)), layout="constrained")
    above, key = figure.subfigures(2, 1, height_ratios=heights)
    axes = above.subplots(3 if stresses else 2, 2)
    styles = [{"color": COLOURS[i % len(COLOURS)],
               "linestyle": ("-", "--", ":", "-.")[i // len(COLOURS) % 4]}
              for i in range(len(runs))]
    if stresses:
        draw_stresses(axes[0], runs, styles)
    below = axes[-2:]
    for run, style in zip(runs, styles):
        draw_quantity(below[0, 0], run, style, "max_pressure", "peak pressure")
        draw_quantity(below[0, 1], run, style, "tangential_force", "tangential force")
        below[1, 0].plot(run.levels["dofs"], run.levels["cycles"], marker=".", **style)
        last = run.cycles["residual"][run.cycles["level"] == run.last]
        shown = last > 0
        below[1, 1].semilogy(np.arange(1, len(last) + 1)[shown], last[shown],
                             marker=".", **style)
    for panel, name in ((below[0, 0], "max_pressure"), (below[0, 1], "tangential_force")):
        # Errors on the first levels may be larger than what they belong to.
        values = np.concatenate([run.levels[name] for run in runs])
        margin = 0.3 * max(np.ptp(values), 1e-300)
        panel.set_ylim(values.min() - margin, values.max() + margin)
    for panel in (below[0, 0], below[0, 1], below[1, 0]):
        panel.set_xscale("log")
        panel.set_xlabel("degrees of freedom")
    below[1, 0].set_title("cycles")
    below[1, 0].set_ylim(bottom=0)
    below[1, 0].yaxis.set_major_locator(MaxNLocator(nbins=6, integer=True))
    below[1, 1].set_title("residual on the last level")
    below[1, 1].set_xlabel("cycle")
    below[1, 1].xaxis.set_major_locator(MaxNLocator(nbins=6, integer=True))
    key.legend(below[1, 0].get_lines(), names, loc="center", ncol=columns)
    return figure


def draw_quantity(axes, run, style, name, title):
    """By level, with its estimated error where that is known."""
    dofs, values = run.levels["dofs"], run.levels[name]
    axes.plot(dofs, values, marker=".", **style)
    errors = run.levels.get(f"{name}_error", np.full(len(values), -1.))
    known = errors >= 0
    axes.errorbar(dofs[known], values[known], errors[known], fmt="none", capsize=2,
                  elinewidth=0.8, color=style["color"])
    axes.set_title(run.axis(title, f"levels/{name}"))


def draw_stresses(axes, runs, styles):
    """Pressure and tangential stress along the boundary of the plane."""
    windows = [boundary.zone(run.contact[run.last]["point"],
                             run.contact[run.last]["state"], 0.3) for run in runs]
    window = np.stack([np.min([w[0] for w in windows], axis=0),
                       np.max([w[1] for w in windows], axis=0)])
    lines = []
    for run in runs:
        nodes = run.contact[run.last]
        shown = ((nodes["point"] >= window[0] - 1e-12)
                 & (nodes["point"] <= window[1] + 1e-12)).all(axis=1)
        lines.append(boundary.Line(nodes, shown))
    for run, style, line in zip(runs, styles, lines):
        nodes = run.contact[run.last]
        pressure, tangential = boundary.tractions(nodes)
        along = np.sum(tangential * line.tangent, axis=1)
        for piece in line.pieces:
            axes[0].plot(line.place[piece], pressure[piece], **style)
            axes[1].plot(line.place[piece], along[piece], **style)
    axis = lines[0].name
    if axis in "xy" and all(line.name == axis for line in lines):
        for panel in axes:
            panel.set_xlim(*window[:, "xy".index(axis)])
    for panel, title in zip(axes, ("pressure", "tangential stress")):
        panel.set_title(runs[0].axis(title, "levels/max_pressure"))
        panel.set_xlabel(runs[0].axis(axis, "contact/gap"))
