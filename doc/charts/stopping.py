"""What it saves to stop at the discretisation error."""

import numpy as np

from chart import BLUE, ORANGE, DataError, Table, axes_below, grid, headline, \
    plt, save

COLUMNS = ("scene", "tolerance", "level", "dofs", "cycles", "solve_seconds",
           "energy", "contact_nodes", "sticky_nodes")
STYLES = {"1e-9": (ORANGE, "s", "--", "to a relative increment of $10^{-9}$"),
          "discretisation": (BLUE, "o", "-", "to a tenth of the error of the mesh")}


def pick(table, scene, tolerance):
    here = (table["scene"] == scene) & (table["tolerance"] == tolerance)
    if not here.any():
        raise DataError(f"{table.path}: nothing for {scene}, {tolerance}.")
    return here


def message(table, scenes):
    """Cycles on all levels together, and how much they change."""
    saved, changes, same = [], [], True
    for scene in scenes:
        full, short = (pick(table, scene, tolerance) for tolerance in STYLES)
        if len(table["level"][full]) != len(table["level"][short]):
            raise DataError(f"{table.path}: different levels of {scene}.")
        saved.append(table["cycles"][full].sum() / table["cycles"][short].sum())
        same &= np.array_equal(table["dofs"][full], table["dofs"][short])
        changes.append(abs(table["energy"][short][-1] /
                           table["energy"][full][-1] - 1))
    text = ("Stopping at the discretisation error takes " +
            " and ".join(f"{factor:.1f}" for factor in saved) +
            " times fewer cycles")
    return text + (f", and changes the energy by {max(changes):.0e} at most"
                   if same else "")


def draw(data, output, subject):
    table = Table(data / "stopping.csv", COLUMNS)
    scenes = list(dict.fromkeys(table["scene"]))
    figure, axes = plt.subplots(1, len(scenes), figsize=(7, 3.2), sharey=True,
                                squeeze=False)
    figure.subplots_adjust(left=0.075, right=0.985, bottom=0.27, wspace=0.06)
    for panel, scene in zip(axes[0], scenes):
        panel.set_xscale("log")
        panel.set_title(scene)
        panel.set_xlabel("degrees of freedom")
        grid(panel)
        for tolerance, (color, marker, line, label) in STYLES.items():
            here = pick(table, scene, tolerance)
            panel.plot(table["dofs"][here], table["cycles"][here], marker + line,
                       color=color, label=label)
    axes[0, 0].set_ylim(0, 1.12 * table["cycles"].max())
    axes[0, 0].set_ylabel("cycles")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncol=2, fontsize=8)
    axes_below(figure, headline(figure, message(table, scenes), subject), 0.27)
    save(figure, output, "stopping.svg")
