"""Chart 1: what accuracy costs, in degrees of freedom and in seconds, on meshes
that are refined uniformly and adaptively."""

import numpy as np

from chart import (BLUE, RED, DataError, Table, axes_below, crossing, grid,
                   headline, plt, save, slope_triangle, times)

COLUMNS = ("dofs", "total_seconds", "energy_error", "pressure_error",
           "contact_half_width_error", "stick_half_width_error")
QUANTITIES = (("energy_error", "energy"),
              ("pressure_error",
               r"contact pressure, $h^{1/2}\Vert\cdot\Vert_{L_2}$"),
              ("contact_half_width_error", "contact half-width"),
              ("stick_half_width_error", "stick half-width"))
STYLES = {"uniform": (RED, "s"), "adaptive": (BLUE, "o")}


def message(tables):
    """What the energy error says about time: at the smallest error that both
    kinds of refinement have reached."""
    error = max(table["energy_error"].min() for table in tables.values())
    at = {}
    for name, table in tables.items():
        at[name] = {key: crossing(table[key], table["energy_error"],
                                  error * (1 + 1e-9))
                    for key in ("dofs", "total_seconds")}
    dofs = at["uniform"]["dofs"] / at["adaptive"]["dofs"]
    seconds = at["uniform"]["total_seconds"] / at["adaptive"]["total_seconds"]
    size = f"{100 * error:.2g} % energy error"
    if dofs >= 1.5 and seconds >= 1.5:
        return (f"For {size}, adaptive refinement needs {times(dofs)} times fewer "
                f"unknowns and {times(seconds)} times less time than uniform "
                "refinement")
    if dofs <= 1 / 1.5 and seconds <= 1 / 1.5:
        return (f"For {size}, uniform refinement needs {times(1 / dofs)} times "
                f"fewer unknowns and {times(1 / seconds)} times less time than "
                "adaptive refinement")
    return (f"For {size}, adaptive refinement takes {1 / dofs:.2f} times the "
            f"unknowns and {1 / seconds:.2f} times the seconds of uniform "
            "refinement")


def draw(data, output, name, subject):
    tables = {strategy: Table(data / f"work-precision-{name}-{strategy}.csv",
                              COLUMNS) for strategy in STYLES}
    for table in tables.values():
        if min(table["energy_error"].min(), table["pressure_error"].min()) <= 0:
            raise DataError(f"{table.path}: an error of zero is not believable.")
    figure, axes = plt.subplots(4, 2, figsize=(7, 8.4), sharex="col",
                                sharey="row")
    figure.subplots_adjust(left=0.105, right=0.985, bottom=0.06,
                           hspace=0.25, wspace=0.06)
    for row, (quantity, label) in zip(axes, QUANTITIES):
        positive = np.concatenate([table[quantity][table[quantity] > 0]
                                   for table in tables.values()])
        if not len(positive):
            raise DataError(f"{data}: nothing to be seen of {quantity}.")
        # Half-widths come in multiples of a mesh width and may be met exactly:
        # such points lie on the lower edge, and are open.
        low, high = positive.min() / 3, positive.max() * 2
        for panel, abscissa in zip(row, ("dofs", "total_seconds")):
            panel.set_xscale("log")
            panel.set_yscale("log")
            panel.set_ylim(low, high)
            grid(panel)
            for strategy, (color, marker) in STYLES.items():
                x = tables[strategy][abscissa]
                y = tables[strategy][quantity]
                exact = y <= 0
                panel.plot(x, np.where(exact, np.nan, y), marker + "-",
                           color=color, zorder=3)
                panel.plot(x[exact], np.full(exact.sum(), low), marker,
                           color=color, markerfacecolor="white", clip_on=False,
                           zorder=4)
                if quantity in ("energy_error", "pressure_error"):
                    slope_triangle(panel, x, y, color, strategy == "uniform")
        row[0].set_ylabel("relative error")
        row[0].set_title(label, loc="left", pad=4)
    for height, (strategy, (color, marker)) in zip((0.93, 0.81),
                                                   STYLES.items()):
        axes[0, 0].plot([0.72], [height], marker, color=color,
                        transform=axes[0, 0].transAxes)
        axes[0, 0].text(0.75, height, strategy, color=color, va="center",
                        transform=axes[0, 0].transAxes)
    axes[3, 0].set_xlabel("degrees of freedom")
    axes[3, 1].set_xlabel("seconds, all that led there included")
    axes_below(figure, headline(figure, message(tables), subject), 0.27)
    save(figure, output, f"work-precision-{name}.svg")
