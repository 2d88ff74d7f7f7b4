"""The five parts of one step, computed for a small block."""

import numpy as np

from chart import BLUE, GREEN, GREY, RED, SKY, grid, plt
from drawing_of_ideas import PHASES, mark_phases
from small_block import SmallBlock

# The step that is shown: not yet with the phases of the solution.
SHOWN = 2


def functional(axes, block, u, tau):
    shift = np.linspace(-1, 1, 201)
    for phase, label in (("stick", "sticks"), ("slip", "slides")):
        nodes = np.flatnonzero(block.phases(u) == phase)
        node = nodes[len(nodes) // 2 if phase == "stick" else 1]
        at_rest = u[2 * node]
        scale = 4e-4
        energy = []
        for s in shift:
            moved = u.copy()
            moved[2 * node] = at_rest + s * scale
            energy.append(block.energy(moved, tau))
        energy = np.array(energy) - block.energy(u, tau)
        color, marker = PHASES[phase]
        axes.plot((at_rest + shift * scale) * 1e3, energy / energy.max(),
                  color=color)
        axes.plot(at_rest * 1e3, 0, marker, color=color)
        axes.text(at_rest * 1e3, 1.05, label, ha="center", fontsize=9,
                  color=color)
    axes.set(xlabel="position along the plane", ylabel="energy", xticks=[],
             yticks=[], ylim=(-0.05, 1.2))


def heights(block, u):
    """How far the lower side is above the plane."""
    return block.points[block.contact, 0], block.gap + u[2 * block.contact + 1]


def relaxation(axes, block, before, after):
    x, height = heights(block, before)
    axes.plot(x, height * 1e3, "--", color=GREY, linewidth=1, label="before")
    x, height = heights(block, after)
    axes.plot(x, height * 1e3, color=BLUE, linewidth=1, label="after")
    mark_phases(axes, block.phases(after), x, height * 1e3, markersize=3)
    axes.fill_between(x, -4, 0, color="0.85", linewidth=0)
    axes.set(ylim=(-2, 12), xlabel="lower side", xticks=[], yticks=[],
             ylabel="height")
    lines = [line for line in axes.get_lines()
             if line.get_label() in ("before", "after")]
    axes.legend(handles=lines, loc="upper center", fontsize=8)


def truncation(axes, block, u):
    """The nodes of the lower side, with the directions that are left to coarse
    functions, and below them one of these for the normal direction."""
    x = block.points[block.contact, 0]
    level = 2
    basis = block.interpolation(level)[2 * block.contact, :]
    coarse = np.flatnonzero(basis.any(axis=0))
    middle = coarse[len(coarse) // 4]
    hat = basis[:, middle]
    free = block.free(u)
    axes.plot(x, hat, "--", color=GREY, linewidth=1)
    axes.fill_between(x, 0, hat * free[2 * block.contact + 1], color=SKY,
                      alpha=0.6, linewidth=0)
    for node in range(0, len(x), 2):
        phase = block.phases(u)[node]
        color = PHASES[phase][0]
        if phase != "stick":
            axes.annotate("", (x[node] - 0.055, 1.5), (x[node] + 0.055, 1.5),
                          arrowprops={"arrowstyle": "<->", "color": color,
                                      "shrinkA": 0, "shrinkB": 0})
        if phase == "open":
            axes.annotate("", (x[node], 1.35), (x[node], 1.65),
                          arrowprops={"arrowstyle": "<->", "color": color,
                                      "shrinkA": 0, "shrinkB": 0})
        if phase == "stick":
            axes.plot(x[node], 1.5, "s", color=color, markersize=4)
    axes.text(1.0, 1.85, "directions left", fontsize=8, ha="center")
    axes.text(1.0, 1.12, "a coarse function", fontsize=8, ha="center", color=GREY)
    axes.set(xlabel="lower side", xticks=[], yticks=[], ylim=(-0.05, 2.1))


def correction(axes, block, v):
    nx, ny = block.cells
    scale = 0.12 / np.abs(v).max()
    x = (block.points[:, 0] + scale * v[0::2]).reshape(ny + 1, nx + 1)
    y = (block.points[:, 1] + scale * v[1::2]).reshape(ny + 1, nx + 1)
    for i in range(0, nx + 1, 2):
        axes.plot(x[:, i], y[:, i], color=GREEN, linewidth=0.7)
    for j in range(0, ny + 1, 2):
        axes.plot(x[j], y[j], color=GREEN, linewidth=0.7)
    axes.set(aspect="equal", xticks=[], yticks=[],
             xlabel="correction, enlarged")
    for side in ("left", "bottom"):
        axes.spines[side].set_visible(False)


def line_search(axes, block, u, v, tau):
    lengths = np.linspace(0, 2.0, 121)
    energy = np.array([block.energy(u + a * v, tau) for a in lengths])
    best = block.step_length(u, v, tau)
    least = block.energy(u + best * v, tau)
    axes.plot(lengths, (energy - least) / (energy[0] - least), color=BLUE)
    axes.plot(best, 0, "o", color=RED)
    axes.annotate(f"$\\alpha={best:.2f}$", (best, 0), (best, 0.25),
                  ha="center", fontsize=9)
    axes.set(xlabel="step length", ylabel="energy", yticks=[],
             xticks=[0, 1, 2])


def convergence(axes, block, steps):
    iterates, tau = block.iterate(30)
    least = block.energy(iterates[-1], tau)
    start = block.energy(iterates[0], tau) - least
    without, _ = block.iterate(steps, coarse=False)
    for values, color, label in ((without, GREY, "without 3-5"),
                                 (iterates[:steps], BLUE, "all parts")):
        error = [(block.energy(u, tau) - least) / start for u in values]
        axes.semilogy(range(1, steps + 1), error, "o-", color=color,
                      markersize=3, label=label)
    axes.set(xlabel="steps", ylabel="error of the energy",
             ylim=(1e-15, 5), yticks=[1, 1e-4, 1e-8, 1e-12])
    axes.minorticks_off()
    axes.legend(loc="upper right", bbox_to_anchor=(1.05, 0.9), fontsize=8)
    grid(axes)


def draw(workshop):
    block = SmallBlock()
    iterates, final_tau = block.iterate(30)
    u, tau = block.start.copy(), np.zeros(len(block.contact))
    for _ in range(SHOWN - 1):
        u, _, tau = block.step(u, tau)
    before = u.copy()
    for _ in range(3):
        u, tau = block.relax(u, tau)
    tau = block.normal_force(u)
    v = block.correction(u, tau)

    figure, axes = plt.subplots(3, 2, figsize=(5.6, 6.6))
    figure.subplots_adjust(left=0.1, right=0.97, top=0.95, bottom=0.07,
                           hspace=0.55, wspace=0.3)
    axes = axes.ravel()
    for ax, title in zip(axes, ("1  functional", "2  relaxation",
                                "3  truncation", "4  coarse correction",
                                "5  line search", "together")):
        ax.set_title(title, loc="left", fontweight="bold", fontsize=10)
    functional(axes[0], block, iterates[-1], final_tau)
    relaxation(axes[1], block, before, u)
    truncation(axes[2], block, u)
    correction(axes[3], block, v)
    line_search(axes[4], block, u, v, tau)
    convergence(axes[5], block, 9)
    workshop.save(figure, "five-parts")
