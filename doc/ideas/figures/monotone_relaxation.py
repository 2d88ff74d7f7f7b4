"""Contour lines of two energies with two unknowns each, and what relaxing one
unknown after the other does to them. Left: the unknowns belong to two nodes, and
bound and friction concern one of them each. Right: they are the Cartesian
components of a single node whose normal is at 45 degrees, so that bound and
friction concern both."""

import numpy as np

from chart import BLUE, GREY, ORANGE, RED, plt
from drawing_of_ideas import Failure

R = np.sqrt(0.5)


class Energy:
    """z^T A z/2 - b^T z + s |t.z| over n.z <= g."""

    def __init__(self, matrix, force, bound, tangent, normal, gap):
        self.matrix, self.force = np.array(matrix), np.array(force)
        self.bound, self.gap = bound, gap
        self.tangent, self.normal = np.array(tangent), np.array(normal)

    def __call__(self, z):
        z = np.asarray(z, float)
        return (0.5 * np.einsum("...i,ij,...j", z, self.matrix, z)
                - z @ self.force + self.bound * abs(z @ self.tangent))

    def relax(self, z, direction):
        """The minimiser on the line through the admissible point z, exactly: the
        energy is a parabola to either side of the only kink, and ends at the
        bound."""
        d = np.asarray(direction, float)
        slope, curvature = d @ (self.force - self.matrix @ z), d @ self.matrix @ d
        steps = [(slope + sign * self.bound * (self.tangent @ d)) / curvature
                 for sign in (-1, 1)]
        if self.tangent @ d:
            steps.append(-(self.tangent @ z) / (self.tangent @ d))
        rise = self.normal @ d
        if rise:
            limit = (self.gap - self.normal @ z) / rise
            steps = [min(step, limit) if rise > 0 else max(step, limit)
                     for step in steps]
        return z + min(steps, key=lambda step: self(z + step * d)) * d

    def path(self, start, directions, sweeps=40):
        points = [np.array(start, float)]
        for _ in range(sweeps):
            for direction in directions:
                points.append(self.relax(points[-1], direction))
        return np.array(points)


def minimiser(energy, start):
    """Relaxation in the directions of tangent and normal, for which bound and
    friction are separate; and a check that nothing near it is lower."""
    z = energy.path(start, (energy.tangent, energy.normal), 400)[-1]
    for angle in np.linspace(0, 2 * np.pi, 720):
        near = z + 1e-4 * np.array([np.cos(angle), np.sin(angle)])
        if energy.normal @ near <= energy.gap and energy(near) < energy(z):
            raise Failure("Relaxation has not found the minimum.")
    return z


def draw_energy(axes, energy, lowest, limits):
    x, y = np.meshgrid(np.linspace(*limits[0], 400), np.linspace(*limits[1], 400))
    z = np.stack([x, y], axis=-1)
    height = energy(z) - lowest
    outside = z @ energy.normal > energy.gap
    axes.contour(x, y, np.where(outside, np.nan, np.maximum(height, 0)),
                 levels=np.linspace(0.12, 3.4, 12)**2, colors="0.72",
                 linewidths=0.8)
    axes.contourf(x, y, outside, levels=[0.5, 1.5], colors=["0.85"])
    kink = np.where(outside, np.nan, z @ energy.tangent)
    axes.contour(x, y, kink, levels=[0], colors=[ORANGE], linewidths=1.6,
                 linestyles="--")
    axes.set_xlim(*limits[0])
    axes.set_ylim(*limits[1])
    axes.set_aspect("equal")
    axes.set_xticks([])
    axes.set_yticks([])
    for spine in axes.spines.values():
        spine.set_visible(True)
        spine.set_color(GREY)


def draw_path(axes, points, color):
    moved = [0] + [i for i in range(1, len(points))
                   if np.abs(points[i] - points[i - 1]).max() > 1e-9]
    axes.plot(*points[moved].T, "-", color=color, marker="o", markersize=4,
              linewidth=1.5)


def draw(workshop):
    figure, (left, right) = plt.subplots(1, 2, figsize=(6.3, 3.2))
    figure.subplots_adjust(left=0.045, right=0.99, top=0.99, bottom=0.075,
                           wspace=0.12)
    limits = ((-1.6, 1.4), (-1.6, 1.4))

    # Two nodes: a bound for the first, friction at the second.
    energy = Energy([[1, -0.85], [-0.85, 1]], [0.55, 0.35], 0.25, (0, 1), (1, 0),
                    0.8)
    start = (-1.45, -1.2)
    best = minimiser(energy, start)
    path = energy.path(start, np.eye(2))
    if np.abs(path[-1] - best).max() > 1e-9:
        raise Failure("Relaxation of separate nodes did not converge.")
    draw_energy(left, energy, energy(best), limits)
    draw_path(left, path, BLUE)
    left.plot(*best, "*", color="k", markersize=11, zorder=5)
    left.set_xlabel("normal, node 1", labelpad=3)
    left.set_ylabel("tangential, node 2", labelpad=2)

    # One node, by its Cartesian components; and as a block.
    energy = Energy([[1, 0.1], [0.1, 1]], [1.1, 0.9], 2.0, (R, -R), (R, R), 1.0)
    start = (-1.3, -0.9)
    best = minimiser(energy, start)
    path = energy.path(start, np.eye(2))
    if not energy(path[-1]) > energy(best) + 0.01:
        raise Failure("Relaxation by components did not get stuck.")
    draw_energy(right, energy, energy(best), limits)
    draw_path(right, path, RED)
    right.plot(*best, "*", color="k", markersize=11, zorder=5)
    right.annotate("", best, start, arrowprops={
        "arrowstyle": "->", "color": BLUE, "linewidth": 1.5, "shrinkA": 4,
        "shrinkB": 6, "connectionstyle": "arc3,rad=-0.35"})
    right.text(-0.85, 0.62, "whole node:\none step", color=BLUE, ha="center",
               va="center")
    right.text(path[-1][0] + 0.12, path[-1][1] - 0.06, "components:\nstuck",
               color=RED, va="top")
    right.set_xlabel("$x$ component", labelpad=3)
    right.set_ylabel("$y$ component", labelpad=2)
    for axes, place in ((left, (1.1, -0.9)), (right, (0.95, 0.93))):
        axes.text(*place, "penetrates", color="0.35", ha="center",
                  va="center", rotation=90 if axes is left else -45)
    left.text(-1.5, 0.06, "kink", color="0.35")
    right.text(-1.0, -1.3, "kink", color="0.35")
    workshop.save(figure, "monotone-relaxation")
