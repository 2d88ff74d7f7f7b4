#!/usr/bin/env python3
"""The pictures of step-friction-3d, from the runs that the CMake target
`figures-3d` does:  make_figures_3d.py RUNS OUTPUT"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.colors import Normalize, PowerNorm
from matplotlib.patches import Patch, Polygon

import plot_folder  # noqa: F401
import vtu
from body import View
from cylinder import THESIS, CylinderRun, angle
from drawing import (BLUE, GREY, ORANGE, PHASES, PINK, RED, SKY, STRESS,
                     nodal_average, save)
from history import Run


def surface(data, length=2.0):
    """The faces of the cells on the surface of a cylinder of radius 1, with the
    mean of the von Mises stress at their corners."""
    points = data["points"]
    stress = nodal_average(data["cells"], data["von_Mises_stress"])
    faces = data["cells"][:, vtu.FACES].reshape(-1, 4)
    z = points[faces][:, :, 2]
    r = np.hypot(points[faces][:, :, 0], points[faces][:, :, 1])
    here = ((z < 1e-6).all(1) | (z > length - 1e-6).all(1)
            | (r > 1 - 1e-6).all(1))
    return points[faces[here]], stress[faces[here]].mean(axis=1)


def outline(rings):
    """The outline of a cylinder between two rings of projected points."""
    points = np.concatenate(rings)
    order = np.lexsort((points[:, 1], points[:, 0]))
    hull = []
    for run in (order, order[::-1]):
        start = len(hull)
        for point in points[run]:
            while (len(hull) - start >= 2 and
                   np.cross(hull[-1] - hull[-2], point - hull[-1]) <= 0):
                hull.pop()
            hull.append(point)
        hull.pop()
    return np.array(hull)


def overview(run, output):
    """The cylinder on its rods, with its mesh, obliquely from below."""
    faces, stress = surface(vtu.read(
        run.directory / f"body-{min(4, run.last):02d}.0000.vtu"))
    view = View(towards=(-0.55, 0.42, 0.9), up=(0, 1, 0))
    norm = PowerNorm(0.5, 0, 0.2, clip=True)

    # The cylinder is convex: what faces the viewer is visible.
    normals = np.cross(faces[:, 1] - faces[:, 0], faces[:, 3] - faces[:, 0])
    normals *= np.sign(np.sum(normals * (faces.mean(axis=1) - (0, 0, 1)),
                              axis=1))[:, None]
    seen = normals @ view.depth < 0

    figure, axes = plt.subplots(figsize=(6.4, 4.7))
    figure.subplots_adjust(left=0.0, right=0.86, top=1, bottom=0.0)
    # Where the mesh gets finer, a vertex on a circle is no midpoint of an edge:
    # do not let the paper shine through.
    t = np.linspace(0, 2 * np.pi, 181)
    axes.add_patch(Polygon(view(np.stack([np.cos(t), np.sin(t), 0 * t], axis=1)),
                           facecolor=STRESS(norm(0.005)), edgecolor="none"))
    picture = axes.add_collection(PolyCollection(
        view(faces[seen]), array=stress[seen], norm=norm, cmap=STRESS,
        edgecolors=(0, 0, 0, 0.35), linewidths=0.25))
    for side in (-1, 1):
        x, y = side * 0.75, -1.5 * np.cos(np.pi / 6)
        near, far = (view(np.stack([x + 0.5 * np.cos(t), y + 0.5 * np.sin(t),
                                    np.full_like(t, z)], axis=1))
                     for z in (0, 2))
        axes.add_patch(Polygon(outline([near, far]), facecolor="0.75", alpha=0.55,
                               edgecolor="none"))
        axes.add_patch(Polygon(outline([near, far]), facecolor="none",
                               edgecolor="0.35", linewidth=0.8))
        axes.add_patch(Polygon(near, facecolor="0.85", alpha=0.6,
                               edgecolor="none"))
        axes.add_patch(Polygon(near, facecolor="none", edgecolor="0.35",
                               linewidth=0.8))
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.margins(0.01)
    axes.axis("off")
    bar = figure.add_axes([0.87, 0.3, 0.018, 0.5])
    scale = figure.colorbar(picture, cax=bar, extend="max",
                            ticks=[0, 0.01, 0.05, 0.1, 0.2])
    scale.outline.set_visible(False)
    scale.set_label("von Mises stress / E")
    scale.ax.tick_params(labelsize=8)
    save(figure, output, "cylinder.png")


def tangential_stress(run, output):
    """Figure 6.6 of the thesis: tangential stresses, from below and, along one
    rod, in the frames of the nodes."""
    level = 6
    data = vtu.read(run.directory / f"contact-{level:02d}.0000.vtu")
    corners = data["points"][data["cells"]]
    stress = np.linalg.norm(data["tangential_traction"], axis=1)
    mean = stress[data["cells"]].mean(axis=1)
    norm = Normalize(0, 0.04, clip=True)

    figure, (whole, zoom) = plt.subplots(
        1, 2, figsize=(9, 4.6), gridspec_kw={"width_ratios": [1, 1.05]})
    figure.subplots_adjust(left=0.01, right=0.88, top=0.91, bottom=0.12,
                           wspace=0.2)
    below = (corners[:, :, 1] < 0.02).all(1)
    whole.add_collection(PolyCollection(
        corners[below][:, :, [0, 2]], array=mean[below], norm=norm, cmap=STRESS,
        edgecolors=(0, 0, 0, 0.3), linewidths=0.15))
    whole.set_aspect("equal")
    whole.set_xlim(-1.01, 1.01)
    whole.set_ylim(-0.02, 2.02)
    whole.axis("off")
    whole.set_title("cylinder from below")

    limits = (27.2, 32.8)
    theta = angle(data["points"])
    corner = theta[data["cells"]]
    here = ((corner.max(1) > limits[0]) & (corner.min(1) < limits[1]))
    cells = data["cells"][here]
    picture = zoom.tripcolor(
        theta, data["points"][:, 2],
        np.concatenate([cells[:, [0, 1, 2]], cells[:, [0, 2, 3]]]), stress,
        shading="gouraud", norm=norm, cmap=STRESS, rasterized=True)
    nodes = run.nodes(level)
    size = np.maximum(np.hypot(nodes["around"], nodes["along"]), 1e-30)
    column = (nodes["angle"] - 30) / 0.46875
    shown = ((nodes["state"] > 0) & (nodes["angle"] > limits[0] + 0.1) &
             (nodes["angle"] < limits[1] - 0.1) &
             (np.abs(column - np.round(column)) < 1e-3) &
             (np.round(nodes["z"] * 384).astype(int) % 32 == 16))
    zoom.quiver(nodes["angle"][shown], nodes["z"][shown],
                (nodes["around"] / size)[shown], (nodes["along"] / size)[shown],
                angles="uv", pivot="mid", scale=22, width=0.0045, color="k")
    zoom.set_xlim(limits)
    zoom.set_ylim(0, 2)
    zoom.set_xlabel("degrees around the axis, from the lowest line")
    zoom.set_ylabel("$z$")
    zoom.set_title("above one rod, width stretched")
    place = zoom.get_position()
    bar = figure.add_axes([0.9, place.y0, 0.014, place.height])
    scale = figure.colorbar(picture, cax=bar, extend="max")
    scale.outline.set_visible(False)
    scale.set_label(r"tangential stress $|\sigma_T|$ / E")
    scale.ax.tick_params(labelsize=8)
    save(figure, output, "tangential-stress.png")


def draw_phases(axes, x, y, state, width, height):
    """A rectangle for each node of a regular grid."""
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) / 2
    axes.add_collection(PolyCollection(
        np.stack([x, y], axis=1)[:, None] + corners * (width, height),
        facecolors=PHASES[state], edgecolors="none", antialiased=False))


def phases(run, other, output):
    """Which nodes slide and stick above one rod, and the stresses across it;
    the normal stress on another mesh, too."""
    nodes = run.nodes()
    limits = (27, 33)
    here = (nodes["angle"] > limits[0]) & (nodes["angle"] < limits[1])
    nodes = {name: values[here] for name, values in nodes.items()}
    figure, (plan, profile) = plt.subplots(
        1, 2, figsize=(9, 4.0), gridspec_kw={"width_ratios": [1, 1.15]})
    figure.subplots_adjust(left=0.075, right=0.985, top=0.92, bottom=0.13,
                           wspace=0.2)
    plan.set_facecolor(PHASES[0])
    touching = nodes["state"] > 0
    draw_phases(plan, nodes["angle"][touching], nodes["z"][touching],
                nodes["state"][touching], 0.234375, 1 / 384)
    plan.axvline(30, color="k", linewidth=0.8, linestyle=":")
    plan.set_xlim(limits)
    plan.set_ylim(0, 2)
    plan.set_xlabel("degrees around the axis")
    plan.set_ylabel("$z$")
    plan.set_title("phases of the nodes above one rod")
    plan.text(30.6, 1, "slides", va="center")
    plan.text(28.97, 0.6, "sticks", ha="center", va="top", color=BLUE,
              fontweight="bold")
    for x in (27.5, 32.4):
        plan.text(x, 1, "open", ha="center", va="center", color=GREY)

    row = run.halfway()
    theta, pressure, state = row["angle"], row["pressure"], row["state"]
    shear = np.hypot(row["around"], row["along"])
    sticking = theta[state == 2]
    profile.axvspan(sticking[0] - 0.117, sticking[-1] + 0.117, color="0.9")
    profile.text(sticking.mean(), 0.001, "sticks", ha="center", color=GREY)
    profile.plot(theta, pressure, color=BLUE, label=r"$|\sigma_n|$")
    row = other.halfway()
    profile.plot(row["angle"], row["pressure"], color=SKY, linewidth=0.9,
                 label=r"$|\sigma_n|$, one hexahedron")
    profile.plot(theta, 0.4 * pressure, "--", color="k", linewidth=1,
                 label=r"$\mathcal{F}|\sigma_n|$")
    profile.plot(theta, shear, color=RED, label=r"$|\sigma_T|$")
    profile.set_xlim(limits)
    profile.set_ylim(0, 0.08)
    profile.set_xlabel("degrees around the axis")
    profile.set_ylabel("stress / E")
    profile.set_title("stresses halfway along the cylinder, $z=1$")
    profile.legend(loc="upper right", ncol=2, fontsize=9)
    save(figure, output, "phases.png")


def crossing_rods(run, output):
    """One of the two contact zones of the crossing rods."""
    contact = run.contact[run.last]
    point, normal, state = (contact[name] for name in ("point", "normal", "state"))
    traction = contact["force"] / contact["measure"][:, None]
    tangential = traction - (np.sum(traction * normal, axis=1)[:, None] * normal)
    arc = np.radians(angle(point))
    z = point[:, 2] - 0.5
    window = 0.125
    here = (np.abs(arc) < window) & (np.abs(z) < window)
    touching = here & (state > 0)
    width = np.diff(np.unique(np.round(arc[touching], 9))).min()
    height = np.diff(np.unique(np.round(z[touching], 9))).min()

    figure, axes = plt.subplots(figsize=(5.6, 4.4))
    figure.subplots_adjust(left=0.15, right=0.97, top=0.98, bottom=0.12)
    axes.set_facecolor(PHASES[0])
    draw_phases(axes, arc[touching], z[touching], state[touching], width, height)
    column = np.round(arc / width).astype(int)
    row = np.round(z / height).astype(int)
    shown = touching & (column % 5 == 0) & (row % 5 == 0)
    axes.quiver(arc[shown], z[shown],
                (tangential[:, 0] * normal[:, 1] * -1 +
                 tangential[:, 1] * normal[:, 0])[shown],
                tangential[shown, 2], angles="xy", pivot="tail", width=0.004,
                color="k")
    axes.set_aspect("equal")
    axes.set_xlim(-window, window)
    axes.set_ylim(-window * 0.8, window * 0.8)
    axes.set_xlabel("around the cylinder")
    axes.set_ylabel("along the cylinder")
    axes.set_xticks([-0.1, -0.05, 0, 0.05, 0.1])
    axes.set_yticks([-0.1, -0.05, 0, 0.05, 0.1])
    axes.legend(handles=[Patch(facecolor=color, label=name) for color, name in
                         zip(PHASES[[2, 1]], ("sticks", "slides"))],
                loc="upper right")
    save(figure, output, "crossing-rods.png")


def fixed_point(run, output):
    """Right part of figure 6.5: how Algorithm 2 changes the normal forces."""
    figure, axes = plt.subplots(figsize=(5.6, 3.6))
    figure.subplots_adjust(left=0.14, right=0.97, top=0.96, bottom=0.14)
    shades = plt.get_cmap("viridis_r")(np.linspace(0.1, 1, run.last + 1))
    for level in range(run.last + 1):
        change = run.outer["change"][run.outer["level"] == level]
        axes.plot(np.arange(1, len(change) + 1), change, "o-",
                  color=shades[level], markersize=4, linewidth=1.3,
                  label=f"level {level}")
    axes.axhline(2e-7, color=GREY, linestyle="--", linewidth=1)
    axes.text(1, 1.2e-7, "tolerance", color=GREY, va="top")
    axes.set_yscale("log")
    axes.set_ylim(5e-9, 2)
    axes.set_xlabel("outer iteration")
    axes.set_ylabel(r"relative change of $\tau$")
    axes.grid(axis="y", color="0.9")
    axes.legend(loc="upper right", fontsize=9)
    save(figure, output, "fixed-point-3d.png")


def labels_at_ends(axes, ends, ratio):
    """Names at the right ends of lines on a logarithmic axis, moved apart where
    they collide."""
    ends.sort(key=lambda end: end[0])
    place = 0.0
    for value, name, color in ends:
        place = max(value, place * ratio)
        axes.annotate(name, (1.0, place), xycoords=("axes fraction", "data"),
                      xytext=(8, 0), textcoords="offset points", color=color,
                      va="center", annotation_clip=False)


def cycles(runs, output):
    """Cycles per level on both coarse grids, and in the thesis."""
    figure, axes = plt.subplots(figsize=(6.4, 3.4))
    figure.subplots_adjust(left=0.1, right=0.72, top=0.96, bottom=0.15)
    ends = []
    for name, (run, color, marker) in runs.items():
        levels = run.levels
        axes.plot(levels["dofs"], levels["cycles"], marker + "-", color=color,
                  markersize=4.5)
        ends.append((float(levels["cycles"][-1]), name, color))
    published = [row for row in THESIS if row[6]]
    axes.plot([row[1] for row in published], [row[6] for row in published],
              "s--", color=GREY, markersize=4.5)
    ends.append((70.0, "thesis: one cell", GREY))
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_ylim(8, 100)
    axes.set_yticks([10, 20, 40, 80])
    axes.set_yticklabels(["10", "20", "40", "80"])
    axes.minorticks_off()
    axes.set_xlabel("degrees of freedom")
    axes.set_ylabel("cycles to $10^{-9}$")
    axes.grid(axis="y", color="0.9")
    labels_at_ends(axes, ends, 1.16)
    save(figure, output, "cycles-3d.png")


def truncation(runs, output, most):
    """Remark 6.7: cycles per level of the kinds of truncation."""
    figure, all_axes = plt.subplots(1, 2, figsize=(8.6, 3.5), sharey=True)
    figure.subplots_adjust(left=0.08, right=0.99, top=0.9, bottom=0.27,
                           wspace=0.06)
    styles = {"phases": (BLUE, "o"), "contact": (ORANGE, "s"),
              "phases without second order": (RED, "^")}
    for axes, correction in zip(all_axes, ("truncated", "monotone")):
        for name, (color, marker) in styles.items():
            run = CylinderRun(runs / f"{name.replace(' ', '-')}-{correction}")
            dofs, count = run.levels["dofs"], run.levels["cycles"]
            axes.plot(dofs, count, marker + "-", color=color, markersize=5,
                      label={"phases without second order":
                             r"phases without second order $\omega''$"}.get(
                                 name, name))
            if run.gave_up(most):
                axes.annotate(f"more than {most}", (dofs[-1], count[-1]),
                              xytext=(-9, 2), textcoords="offset points",
                              ha="right", va="center", color=color)
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_ylim(9, 125)
        axes.set_yticks([10, 20, 40, 80])
        axes.set_yticklabels(["10", "20", "40", "80"])
        axes.minorticks_off()
        axes.set_xticks([5e3, 1e4, 2e4, 5e4])
        axes.set_xticklabels(["5 000", "10 000", "20 000", "50 000"])
        axes.set_title(f"{correction} coarse correction")
        axes.set_xlabel("degrees of freedom")
        axes.grid(axis="y", color="0.9")
    all_axes[0].set_ylabel("cycles to $10^{-9}$")
    handles, labels = all_axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncol=3)
    save(figure, output, "truncation.png")


def main():
    runs, output = Path(sys.argv[1]), Path(sys.argv[2])
    large = CylinderRun(runs / "large")
    pictures = {
        "overview": lambda: overview(CylinderRun(runs / "cylinder"), output),
        "tangential-stress": lambda: tangential_stress(large, output),
        "phases": lambda: phases(large, CylinderRun(runs / "one-cell"), output),
        "crossing-rods": lambda: crossing_rods(Run(runs / "crossing-rods"), output),
        "fixed-point": lambda: fixed_point(
            CylinderRun(runs / "large-fixed-point"), output),
        "cycles": lambda: cycles({
            "O-grid": (large, BLUE, "o"),
            "one cell": (CylinderRun(runs / "one-cell"), RED, "v"),
            "one cell, uniform": (CylinderRun(runs / "uniform-one-cell"), PINK, "^"),
            "O-grid, uniform": (CylinderRun(runs / "uniform"), SKY, "D")}, output),
        "truncation": lambda: truncation(runs, output, most=100)}
    for name in sys.argv[3:] or pictures:
        pictures[name]()


if __name__ == "__main__":
    main()
