"""Chart 6, figure 6.3 of the thesis: up to which coefficient of friction a
solution is known to exist, over the Poisson ratio. The formulas are those of
eck_bound() in common/parameters/material.h."""

import numpy as np

from chart import BLUE, GREY, RED, axes_below, grid, headline, plt, save


def bound_2d(nu):
    return np.sqrt(1 - ((1 - 2 * nu) / (1 - nu)) ** 2 / 4)


def bound_3d(nu):
    return np.sqrt(1 - 1 / (4 * (1 - nu)))


def draw(output):
    nu = np.linspace(0, 0.5, 201)
    figure, axes = plt.subplots(figsize=(5.2, 3.7))
    figure.subplots_adjust(left=0.11, right=0.97, bottom=0.13)
    for bound, color, line, text, below in (
            (bound_2d, BLUE, "-", "two dimensions", False),
            (bound_3d, RED, "--", "three dimensions", True)):
        axes.plot(nu, bound(nu), line, color=color, linewidth=1.8)
        axes.annotate(text, (0.15, bound(0.15)), xytext=(0, -6 if below else 6),
                      textcoords="offset points", color=color,
                      ha="right" if not below else "center",
                      va="top" if below else "bottom")
    axes.set_xlim(0, 0.5)
    axes.set_ylim(0.6, 1.02)
    axes.set_xlabel(r"Poisson ratio $\nu$")
    axes.set_ylabel(r"coefficient of friction $\mathcal{F}$")
    grid(axes)
    mid = 0.325
    top = headline(figure, "The more nearly incompressible, the more friction "
                   "in 2D and the less in 3D", "Below the lines a static "
                   "solution is known to exist (Eck).", width=56)
    axes_below(figure, top, 0.1)
    axes.plot([mid, mid], [bound_2d(mid), bound_3d(mid)], "o", color="k",
              markersize=4)
    for bound, below in ((bound_2d, False), (bound_3d, True)):
        axes.annotate(f"{bound(mid):.3f}", (mid, bound(mid)),
                      xytext=(0, -5 if below else 5),
                      textcoords="offset points", fontsize=8, ha="center",
                      va="top" if below else "bottom")
    axes.axvline(mid, color=GREY, linewidth=0.8, linestyle=":")
    axes.text(mid - 0.005, 0.61, r"$\nu=0.325$: scenes hertz, cylinder",
              color=GREY, fontsize=8, ha="right")
    save(figure, output, "eck-bounds.svg")
