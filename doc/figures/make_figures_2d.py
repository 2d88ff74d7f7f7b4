#!/usr/bin/env python3
"""The pictures of step-friction-2d, from the runs that the CMake target
`figures-2d` does:  make_figures_2d.py RUNS OUTPUT"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.colors import PowerNorm
from matplotlib.patches import Rectangle

import plot_folder  # noqa: F401
import vtu
from drawing import (BLUE, GREEN, GREY, ORANGE, RED, SKY, STRESS, nodal_average,
                     save)
from hertz import THESIS, HertzRun, peak, width


def nodal_stress(data):
    return nodal_average(data["cells"], data["von_Mises_stress"])


def draw_body(axes, data, norm, line_width, cells_in=None):
    """Von Mises stress on the deformed body, displacements to scale."""
    points = (data["points"] + data["displacement"])[:, :2]
    cells = data["cells"]
    if cells_in is not None:
        (x0, x1), (y0, y1) = cells_in
        corners = points[cells]
        inside = ((corners[:, :, 0].max(1) > x0) & (corners[:, :, 0].min(1) < x1)
                  & (corners[:, :, 1].max(1) > y0)
                  & (corners[:, :, 1].min(1) < y1))
        cells = cells[inside]
    triangles = np.concatenate([cells[:, [0, 1, 2]], cells[:, [0, 2, 3]]])
    picture = axes.tripcolor(points[:, 0], points[:, 1], triangles,
                             nodal_stress(data), shading="gouraud",
                             norm=norm, cmap=STRESS, rasterized=True)
    edges = np.concatenate([points[cells[:, [i, (i + 1) % 4]]]
                            for i in range(4)])
    axes.add_collection(LineCollection(edges, colors="k", alpha=0.3,
                                       linewidths=line_width))
    axes.set_aspect("equal")
    return picture


def draw_obstacle(axes, depth=1.0):
    axes.add_patch(Rectangle((-3, -1 - depth), 6, depth, facecolor="0.85",
                             edgecolor="0.35", linewidth=1, zorder=0))


def body(run, output):
    """The deformed half disc, and its contact zone enlarged."""
    data = vtu.read(run.directory / f"body-{min(8, run.last):02d}.0000.vtu")
    norm = PowerNorm(0.5, 0, nodal_stress(data).max())
    figure, (whole, zoom) = plt.subplots(
        1, 2, figsize=(9, 2.9), gridspec_kw={"width_ratios": [1.08, 1]})
    figure.subplots_adjust(left=0.01, right=0.88, top=0.9, bottom=0.04,
                           wspace=0.08)

    draw_body(whole, data, norm, 0.25)
    draw_obstacle(whole)
    whole.set_xlim(-1.08, 1.08)
    whole.set_ylim(-1.1, 0.06)
    whole.axis("off")
    whole.set_title("half disc, pressed down by 0.0062 of its radius")

    window = ((-0.12, 0.12), (-1.008, -0.885))
    picture = draw_body(zoom, data, norm, 0.4, window)
    draw_obstacle(zoom)
    zoom.set_xlim(window[0])
    zoom.set_ylim(window[1])
    zoom.set_xticks([])
    zoom.set_yticks([])
    for spine in zoom.spines.values():
        spine.set_visible(True)
        spine.set_color(GREY)
    zoom.set_title("contact zone, enlarged")
    whole.indicate_inset_zoom(zoom, edgecolor="k", alpha=0.6)

    place = zoom.get_position()
    bar = figure.add_axes([0.895, place.y0, 0.014, place.height])
    scale = figure.colorbar(picture, cax=bar, ticks=[0, 0.002, 0.006, 0.012,
                                                     0.02])
    scale.outline.set_visible(False)
    scale.set_label("von Mises stress / E", labelpad=6)
    scale.ax.tick_params(labelsize=8)
    save(figure, output, "body.png")


def boundary_stresses(runs, output):
    """Figure 6.4 of the thesis: normal and tangential stress for three
    coefficients of friction."""
    figure, all_axes = plt.subplots(1, 3, figsize=(9, 3.5), sharey=True)
    figure.subplots_adjust(left=0.07, right=0.99, top=0.92, bottom=0.25,
                           wspace=0.07)
    for axes, (friction, run) in zip(all_axes, runs.items()):
        force = run.levels["normal_force"][-1]
        a, p = width(force), peak(force)
        x, pressure, shear, state = run.stresses()
        x = x / a
        shown = np.abs(x) < 1.3
        sticking = x[state == 2]
        if sticking[-1] - sticking[0] > 0.02:
            axes.axvspan(sticking[0], sticking[-1], color="0.9", zorder=0)
            axes.text(0, 0.55, "sticks", ha="center", color=GREY)
        else:
            axes.annotate(f"{len(sticking)} of {np.sum(state > 0)}\nnodes stick"
                          if len(sticking) > 1 else "one node\nsticks",
                          (0, 0.002), (0, 0.3), ha="center", color=GREY,
                          arrowprops={"arrowstyle": "->", "color": GREY})
        s = np.linspace(-1, 1, 401)
        axes.plot(s, np.sqrt(1 - s**2), "--", color="k", linewidth=1,
                  label="Hertz, no friction")
        axes.plot(x[shown], pressure[shown] / p, color=BLUE,
                  label=r"normal stress $|\sigma_n|$")
        axes.plot(x[shown], np.abs(shear[shown]) / p, color=RED,
                  label=r"tangential stress $|\sigma_T|$")
        axes.set_title(rf"$\mathcal{{F}} = {friction:g}$")
        axes.set_xlabel("$x/a_H$")
        axes.set_xlim(-1.3, 1.3)
        axes.set_ylim(0, 1.15)
    all_axes[0].set_ylabel("stress / $p_H$")
    handles, labels = all_axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncol=3)
    save(figure, output, "boundary-stresses.png")


def fixed_point(run, output):
    """Left part of figure 6.5: how fast Algorithm 2 contracts."""
    figure, axes = plt.subplots(figsize=(5.6, 3.4))
    figure.subplots_adjust(left=0.13, right=0.97, top=0.96, bottom=0.15)
    axes.plot([row[0] for row in THESIS if row[7]],
              [row[7] for row in THESIS if row[7]], "s--", color=GREY,
              markersize=5, label="thesis, table 6.1")
    level = run.levels["level"]
    rate = run.levels["rho_tau_contraction"]
    shown = level >= 2
    axes.plot(level[shown], rate[shown], "o-", color=BLUE, markersize=5,
              label="this program")
    axes.set_yscale("log")
    axes.set_ylim(1e-4, 1)
    axes.set_xlabel("level of refinement")
    axes.set_ylabel(r"contraction $\rho_\tau$ per outer iteration")
    axes.grid(axis="y", color="0.9")
    axes.legend(loc="lower right")
    save(figure, output, "fixed-point.png")


def cycles(runs, output):
    """Cycles per level of the coarse corrections."""
    figure, axes = plt.subplots(figsize=(6.6, 3.4))
    figure.subplots_adjust(left=0.1, right=0.64, top=0.95, bottom=0.16)
    styles = {"V(3,3) monotone": (RED, "s"), "V(3,3) truncated": (SKY, "v"),
              "default": (BLUE, "o"), "W(3,3) monotone": (ORANGE, "D"),
              "W(3,3) truncated": (GREEN, "^")}
    ends = []
    for name, (color, marker) in styles.items():
        levels = runs[name].levels
        from_here = levels["level"] >= 4
        axes.plot(levels["dofs"][from_here], levels["cycles"][from_here],
                  marker + "-", color=color, markersize=4.5)
        ends.append([float(levels["cycles"][-1]), name, color])
    # The names stand at the ends of the lines, moved apart where they collide.
    ends.sort(key=lambda end: end[0])
    place = -np.inf
    for value, name, color in ends:
        place = max(value, place + 1.5)
        axes.annotate(name if name != "default"
                      else "default: V, truncated, 6+6",
                      (1.0, place), xycoords=("axes fraction", "data"),
                      xytext=(8, 0), textcoords="offset points", color=color,
                      va="center", annotation_clip=False)
    axes.set_xscale("log")
    axes.set_ylim(0, 24)
    axes.set_xlabel("degrees of freedom")
    axes.set_ylabel("cycles to $10^{-9}$")
    axes.grid(axis="y", color="0.9")
    save(figure, output, "cycles.png")


def readme(run, output):
    """What this is about, in one picture."""
    force = run.levels["normal_force"][-1]
    a, p = width(force), peak(force)
    limits = (-0.13, 0.13)
    window = (limits, (-1.006, -0.8928))
    data = vtu.read(run.directory / f"body-{min(8, run.last):02d}.0000.vtu")
    norm = PowerNorm(0.8, 0, nodal_stress(data).max())

    figure = plt.figure(figsize=(7.2, 4.85), dpi=130)
    top = figure.add_axes([0.02, 0.36, 0.96, 0.63])
    bottom = figure.add_axes([0.02, 0.0, 0.96, 0.35])

    draw_body(top, data, norm, 0.5, window)
    draw_obstacle(top)
    top.set_xlim(limits)
    top.set_ylim(window[1])
    top.axis("off")

    x, pressure, shear, state = run.stresses()
    shown = (x > limits[0]) & (x < limits[1])
    contact, sticking = x[state > 0], x[state == 2]
    bottom.fill_between(x[shown], pressure[shown] / p, color=BLUE, alpha=0.15,
                        linewidth=0)
    bottom.plot(x[shown], pressure[shown] / p, color=BLUE)
    bottom.fill_between(x[shown], np.abs(shear[shown]) / p, color=RED,
                        alpha=0.25, linewidth=0)
    bottom.plot(x[shown], np.abs(shear[shown]) / p, color=RED)
    bottom.text(0.061, 0.72, "contact pressure", color=BLUE, fontsize=12)
    bottom.annotate("friction", (0.045, 0.27), (0.061, 0.42), color=RED,
                    fontsize=12, va="center",
                    arrowprops={"arrowstyle": "-", "color": RED})
    for left, right, name in ((contact[0], sticking[0], "slides"),
                              (sticking[0], sticking[-1], "sticks"),
                              (sticking[-1], contact[-1], "slides")):
        bottom.annotate("", (left, -0.1), (right, -0.1),
                        arrowprops={"arrowstyle": "<->", "color": "k",
                                    "shrinkA": 0, "shrinkB": 0})
        bottom.text((left + right) / 2, -0.16, name, ha="center", va="top",
                    fontsize=12)
    for place in (contact[0], sticking[0], sticking[-1], contact[-1]):
        bottom.plot([place, place], [-0.1, 1.2], color=GREY, linewidth=0.7,
                    linestyle=":", clip_on=False)
    bottom.plot(limits, [0, 0], color="k", linewidth=0.8)
    bottom.set_xlim(limits)
    bottom.set_ylim(-0.3, 1.15)
    bottom.axis("off")
    save(figure, output, "readme.png")


def main():
    runs, output = Path(sys.argv[1]), Path(sys.argv[2])
    default = HertzRun(runs / "hertz")
    body(default, output)
    boundary_stresses({0.05: HertzRun(runs / "F-0.05"), 0.4: default,
                       1.0: HertzRun(runs / "F-1")}, output)
    fixed_point(HertzRun(runs / "fixed-point"), output)
    cycles({"default": default,
            "V(3,3) truncated": HertzRun(runs / "V33-truncated"),
            "V(3,3) monotone": HertzRun(runs / "V33-monotone"),
            "W(3,3) truncated": HertzRun(runs / "W33-truncated"),
            "W(3,3) monotone": HertzRun(runs / "W33-monotone")}, output)
    readme(default, output)


if __name__ == "__main__":
    main()
