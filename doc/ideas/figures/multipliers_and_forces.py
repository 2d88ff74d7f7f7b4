"""Above, hat functions on a boundary and the dual function of one of them. Below,
nodal forces of the scene 'hertz' without friction on two levels, and the stresses
that they are beside the closed form of Hertz and beside the normal stress of the
finite element solution."""

import numpy as np

from chart import BLUE, GREY, ORANGE, RED, plt
from drawing_of_ideas import Failure
import vtu
from hertz import HertzRun, peak, width

LEVELS = (4, 5)
YOUNG, POISSON = 1, 0.325  # as in the scene
COLORS = {4: (ORANGE, "s"), 5: (BLUE, "o")}


def dual_on_edge(length):
    """Values at the ends of an edge (columns) of the linear functions (rows) that
    are biorthogonal to its two hat functions: the integral of a function with
    its own hat function is that of the hat function, with the other one zero."""
    mass = length / 6 * np.array([[2.0, 1.0], [1.0, 2.0]])
    return length / 2 * np.linalg.inv(mass)


def draw_bases(axes):
    nodes = np.array([0.0, 1.0, 1.7, 3.1, 4.0])
    hats = np.eye(len(nodes))
    shown = 2
    for i, hat in enumerate(hats):
        axes.plot(nodes, hat, color=BLUE if i == shown else "0.75",
                  linewidth=1.8 if i == shown else 1, zorder=3 if i == shown else 1)
    axes.fill_between(nodes, hats[shown], color=BLUE, alpha=0.18, linewidth=0)
    places, values = [nodes[0], nodes[shown - 1]], [0.0, 0.0]
    for edge in (shown - 1, shown):
        dual = dual_on_edge(nodes[edge + 1] - nodes[edge])[shown - edge]
        places += [nodes[edge], nodes[edge + 1]]
        values += list(dual)
    places += [nodes[shown + 1], nodes[-1]]
    values += [0.0, 0.0]
    axes.plot(places, values, color=RED, linewidth=1.8, linestyle="--", zorder=4)
    axes.plot(nodes, 0 * nodes, "o-", color="k", markersize=4, linewidth=0.8,
              zorder=2)
    axes.text(1.98, 1.62, r"dual function $m_p\psi_p$", color=RED)
    axes.text(2.42, 0.62, r"hat function $\lambda_p$", color=BLUE)
    axes.set_yticks([-1, 0, 1, 2])
    axes.set_xticks([])
    axes.spines["bottom"].set_visible(False)


def corner_stresses(data):
    """In all corners of one cell after the other. What is bilinear is linear along
    the two edges that meet there."""
    def along_edges(field):
        values = data[field][:, :2].astype(float)[data["cells"]]
        return np.stack([np.roll(values, shift, axis=1) - values
                         for shift in (-1, 1)], axis=-1).reshape(-1, 2, 2)

    gradients = along_edges("displacement") @ np.linalg.inv(along_edges("points"))
    strains = (gradients + gradients.transpose(0, 2, 1)) / 2
    mu = YOUNG / (2 * (1 + POISSON))
    lam = 2 * mu * POISSON / (1 - 2 * POISSON)
    return (2 * mu * strains
            + lam * np.trace(strains, axis1=1, axis2=2)[:, None, None] * np.eye(2))


def boundary_stress(directory, level, points, normals):
    """The pressure of the finite element solution, averaged over the cells at
    each node."""
    data = vtu.read(directory / f"body-{level:02d}.0000.vtu")
    corners = data["points"][data["cells"]][:, :, :2].reshape(-1, 2)
    stresses = corner_stresses(data)
    result = []
    for point, normal in zip(points, normals):
        here = np.abs(corners - point).max(axis=1) < 1e-6
        if not np.any(here):
            raise Failure("A contact node is no node of the body.")
        result.append(-np.mean(stresses[here] @ normal @ normal))
    return np.array(result)


def draw(workshop):
    directory = workshop.run(2, "hertz", "frictionless",
                             "Contact/Friction law=none",
                             "Contact/Contact normal=obstacle",
                             f"Refinement/Levels={LEVELS[-1]}",
                             "Output/Fields=true")
    run = HertzRun(directory)
    total = run.levels["normal_force"][-1]
    a, p = width(total), peak(total)

    figure = plt.figure(figsize=(6.3, 5.0))
    upper = figure.add_gridspec(1, 1, left=0.08, right=0.99, top=0.99, bottom=0.66)
    lower = figure.add_gridspec(1, 2, left=0.08, right=0.99, top=0.55, bottom=0.1,
                                wspace=0.2)
    draw_bases(figure.add_subplot(upper[0, 0]))
    forces, stresses = (figure.add_subplot(lower[0, i]) for i in range(2))
    s = np.linspace(-1, 1, 401)
    stresses.plot(s, np.sqrt(1 - s**2), color="k", linewidth=1)
    for level in LEVELS:
        nodes = run.contact[level]
        x = nodes["point"][:, 0] / a
        order = np.argsort(x)
        order = order[np.abs(x[order]) < 1.35]
        force = -np.sum(nodes["force"] * nodes["normal"], axis=1)[order]
        pressure = force / nodes["measure"][order]
        raw = boundary_stress(directory, level, nodes["point"][order],
                              nodes["normal"][order])
        color, marker = COLORS[level]
        forces.plot(x[order], 100 * force / total, "-", color=color, marker=marker,
                    linewidth=0.8)
        stresses.plot(x[order], pressure / p, marker, color=color, zorder=3)
        stresses.plot(x[order], raw / p, "x", color=color, markersize=5.5,
                      markeredgewidth=1.2)
        middle = np.argmin(np.abs(x[order]))
        print(f"  level {level}, in the middle: force {force[middle] / total:.4f} "
              f"of the total, {pressure[middle] / p:.3f} of Hertz's pressure from "
              f"it, {raw[middle] / p:.3f} from the stress; next to contact from "
              f"the stress: {raw[force <= 1e-9 * total].min() / p:.3f}")
        forces.text(0.03, 100 * force[middle] / total + 0.7, f"level {level}",
                    color=color, ha="center", va="bottom")
    forces.set_ylim(-0.5, 20)
    forces.set_yticks([0, 5, 10, 15])
    forces.set_title("nodal forces, % of the total")
    stresses.set_title("pressure, Hertz = 1")
    for axes in (forces, stresses):
        axes.axhline(0, color="0.8", linewidth=0.7, zorder=0)
        axes.set_xlabel("$x/a$", labelpad=1)
        axes.set_xlim(-1.35, 1.35)
    stresses.plot([], [], "o", color=GREY, label=r"$\tau/m_p$")
    stresses.plot([], [], "x", color=GREY, label=r"$-\sigma_n(u_h)$")
    stresses.plot([], [], color="k", linewidth=1, label="Hertz")
    stresses.legend(loc="lower center", handlelength=1.2)
    workshop.save(figure, "multipliers-and-forces")
