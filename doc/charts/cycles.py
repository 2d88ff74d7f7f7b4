"""Chart 4: multigrid cycles per level, for coefficients of friction, kinds of
truncation and of coarse corrections."""

import numpy as np

from chart import (BLUE, ORANGE, RED, DataError, Table, grid, headline, plt,
                   save)

COLUMNS = ("friction", "truncation", "correction", "level", "dofs", "cycles",
           "solved")
STYLES = {"phases": (BLUE, "o", "-"), "contact": (ORANGE, "s", "--"),
          "phases without second order": (RED, "^", ":")}
CORRECTIONS = ("truncated", "monotone")


def message(table, first_level):
    """How far the cycles of the default differ, and what is worst."""
    shown = (table["level"] >= first_level)
    default = (shown & (table["truncation"] == "phases") &
               (table["correction"] == "truncated"))
    cycles = table["cycles"][default].astype(int)
    worst = table["cycles"][shown & (table["truncation"] == "contact")].max()
    if not np.all(table["solved"][default] == 1):
        return "Truncation by phases does not converge on all levels"
    failures = np.sum(table["solved"][shown] == 0)
    lost = (f"and {failures} runs fail" if failures > 1 else
            "and a run fails" if failures else "though nothing fails")
    return (f"Truncation by phases takes {cycles.min()} to {cycles.max()} cycles "
            f"for all coefficients of friction; with all contact nodes truncated "
            f"it is up to {worst:.0f}, {lost}")


def draw(data, output, name, subject, first_level):
    table = Table(data / f"cycles-{name}.csv", COLUMNS)
    frictions = np.unique(table["friction"])
    unknown = set(table["truncation"]) - set(STYLES)
    if unknown:
        raise DataError(f"{table.path}: there is no truncation {unknown.pop()}.")
    figure, axes = plt.subplots(len(CORRECTIONS), len(frictions),
                                figsize=(7, 5), sharex=True, sharey=True,
                                squeeze=False)
    figure.subplots_adjust(left=0.085, right=0.985, top=0.83, bottom=0.15,
                           wspace=0.06, hspace=0.12)
    shown = table["level"] >= first_level
    most = table["cycles"][shown].max()
    for row, correction in zip(axes, CORRECTIONS):
        for panel, friction in zip(row, frictions):
            panel.set_xscale("log")
            panel.set_yscale("log")
            panel.set_ylim(5, 1.6 * max(most, 25))
            ticks = [tick for tick in (5, 10, 20, 50, 100, 200)
                     if tick < 1.6 * max(most, 25)]
            panel.set_yticks(ticks, [str(tick) for tick in ticks])
            panel.minorticks_off()
            grid(panel)
            for truncation, (color, marker, line) in STYLES.items():
                here = (shown & (table["friction"] == friction) &
                        (table["truncation"] == truncation) &
                        (table["correction"] == correction))
                if not here.any():
                    raise DataError(f"{table.path}: nothing for F = {friction:g}, "
                                    f"{truncation}, {correction}.")
                dofs, cycles = table["dofs"][here], table["cycles"][here]
                panel.plot(dofs, cycles, marker + line, color=color,
                           markersize=4, linewidth=1.2, label=truncation)
                failed = table["solved"][here] == 0
                panel.plot(dofs[failed], cycles[failed], "x", color=color,
                           markersize=10, markeredgewidth=2, zorder=5)
                for x, y in zip(dofs[failed], cycles[failed]):
                    panel.annotate("fails", (x, y), xytext=(0, 6),
                                   textcoords="offset points", ha="center",
                                   color=color, fontsize=7)
        row[0].set_ylabel(f"cycles to $10^{{-9}}$\n{correction} correction")
    for panel, friction in zip(axes[0], frictions):
        panel.set_title(rf"$\mathcal{{F}} = {friction:g}$")
    for panel in axes[-1]:
        panel.set_xlabel("degrees of freedom")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles, [{"phases": "truncation by phases (default)",
                             "contact": "all contact nodes truncated",
                             "phases without second order":
                             r"by phases, without $\omega''$"}[label]
                            for label in labels],
                  loc="lower center", ncol=3, fontsize=8, handlelength=3)
    headline(figure, message(table, first_level), subject)
    save(figure, output, f"cycles-{name}.svg")
