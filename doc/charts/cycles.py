"""Chart 4: multigrid cycles per level, for coefficients of friction, kinds of
truncation and of coarse corrections."""

import numpy as np

from chart import (BLUE, ORANGE, RED, DataError, Table, axes_below, grid, headline,
                   plt, save)

COLUMNS = ("friction", "truncation", "correction", "level", "dofs", "cycles",
           "solved")
STYLES = {"phases": (BLUE, "o", "-"), "contact": (ORANGE, "s", "--"),
          "phases without second order": (RED, "^", ":")}
CORRECTIONS = ("truncated", "monotone")


def outcome(table, shown, truncation):
    """Cycles and failures of a kind of truncation, in words; None if it behaves
    like the default."""
    here = shown & (table["truncation"] == truncation)
    default = shown & (table["truncation"] == "phases")
    if (here.sum() == default.sum() and
            np.all(table["cycles"][here] == table["cycles"][default])):
        return None
    runs = len(set(zip(table["friction"][here], table["correction"][here])))
    failures = int(np.sum(table["solved"][here] == 0))
    return (f"{failures} of {runs} runs fail" if failures else
            f"it takes up to {table['cycles'][here].max():.0f}")


def message(table, first_level):
    """What the default takes, and how the others fare."""
    shown = table["level"] >= first_level
    default = (shown & (table["truncation"] == "phases") &
               (table["correction"] == "truncated"))
    if not np.all(table["solved"][default] == 1):
        return "Truncation by phases does not converge on all levels"
    cycles = table["cycles"][default]
    text = (f"The default takes {cycles.min():.0f} to {cycles.max():.0f} cycles, "
            "whatever the friction")
    others = [(words, outcome(table, shown, truncation)) for words, truncation in
              (("with all contact nodes truncated", "contact"),
               ("without second order", "phases without second order"))]
    others = [f"{words} {result}" for words, result in others if result]
    return "; ".join([text] + [", ".join(others)] if others else [text])


def draw(data, output, name, subject, first_level):
    table = Table(data / f"cycles-{name}.csv", COLUMNS)
    frictions = np.unique(table["friction"])
    unknown = set(table["truncation"]) - set(STYLES)
    if unknown:
        raise DataError(f"{table.path}: there is no truncation {unknown.pop()}.")
    figure, axes = plt.subplots(len(CORRECTIONS), len(frictions),
                                figsize=(7, 5), sharex=True, sharey=True,
                                squeeze=False)
    figure.subplots_adjust(left=0.095, right=0.985, bottom=0.15,
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
        row[0].set_ylabel(f"{correction} correction\ncycles")
    for panel, friction in zip(axes[0], frictions):
        panel.set_title(rf"$\mathcal{{F}} = {friction:g}$")
    # More than powers of ten where there are few of them.
    span = np.log10(table["dofs"][shown].max() / table["dofs"][shown].min())
    if span < 1.7:
        low, high = axes[0, 0].get_xlim()
        ticks = [factor * 10**power for power in range(1, 9)
                 for factor in (1, 2, 5) if low < factor * 10**power < high]
        axes[0, 0].set_xticks(ticks, [f"{tick:,}".replace(",", " ")
                                      for tick in ticks])
        axes[0, 0].minorticks_off()
    for panel in axes[-1]:
        panel.set_xlabel("degrees of freedom")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles, [{"phases": "truncation by phases (default)",
                             "contact": "all contact nodes truncated",
                             "phases without second order":
                             r"by phases, without $\omega''$"}[label]
                            for label in labels],
                  loc="lower center", ncol=3, fontsize=8, handlelength=3)
    axes_below(figure, headline(figure, message(table, first_level), subject),
               0.27)
    save(figure, output, f"cycles-{name}.svg")
