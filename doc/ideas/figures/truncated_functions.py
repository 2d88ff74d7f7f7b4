"""A string that hangs between two points and lies on a floor in between: what a
coarse function does to it as it is, and truncated; and how multigrid with either
converges."""

import numpy as np

from chart import BLUE, GREY, ORANGE, RED, grid, plt
from drawing_of_ideas import Failure

ENDS = (1.0, 0.6)


class String:
    """Energy u^T A u/2 - f^T u over u >= 0, linear elements on n intervals."""

    def __init__(self, n):
        self.n = n
        self.x = np.arange(1, n) / n
        self.matrix = n * (2 * np.eye(n - 1) - np.eye(n - 1, k=1)
                           - np.eye(n - 1, k=-1))
        self.force = np.full(n - 1, -16.0 / n)
        self.force[[0, -1]] += n * np.array(ENDS)
        self.coarse = []
        functions = np.eye(n - 1)
        while n > 2:
            prolongation = np.zeros((n - 1, n // 2 - 1))
            for j in range(n // 2 - 1):
                prolongation[2 * j:2 * j + 3, j] = (0.5, 1, 0.5)
            functions = functions @ prolongation
            self.coarse.append(functions)
            n //= 2

    def residual(self, u):
        return self.force - self.matrix @ u

    def error(self, u, solution):
        return np.sqrt((u - solution) @ self.matrix @ (u - solution))

    def guess(self):
        """Straight to the floor: admissible, and in contact where it lies."""
        return np.interp(self.x, [0, 0.4, 0.68, 1], [ENDS[0], 0, 0, ENDS[1]])

    def solution(self):
        """By an active set method."""
        touches = np.zeros(self.n - 1, bool)
        for _ in range(self.n):
            free = ~touches
            u = np.zeros(self.n - 1)
            u[free] = np.linalg.solve(self.matrix[np.ix_(free, free)],
                                      self.force[free])
            now = (u < 0) | (touches & (self.residual(u) < 0))
            if np.all(now == touches):
                return u
            touches = now
        raise Failure("The string finds no contact zone.")

    def relax(self, u):
        for i in range(self.n - 1):
            rest = self.force[i] - self.matrix[i] @ u
            u[i] = max(0.0, u[i] + rest / self.matrix[i, i])

    def cycle(self, u, truncated):
        """Relaxation; then one V-cycle over the coarse functions, truncated or
        whole, without regard of the floor; what penetrates is cut off, and the
        length of the step minimises the energy."""
        self.relax(u)
        keep = (u > 0).astype(float) if truncated else np.ones_like(u)
        functions = [keep * f for level in self.coarse for f in level.T]
        r, v = self.residual(u), np.zeros_like(u)
        for f in functions + functions[::-1]:
            stiffness = f @ self.matrix @ f
            if stiffness > 1e-10:
                v += f * (f @ (r - self.matrix @ v)) / stiffness
        v = np.maximum(v, -u)
        stiffness = v @ self.matrix @ v
        if not stiffness > 0:
            return
        length = max(0.0, (v @ r) / stiffness)
        down = v < 0
        if np.any(down):
            length = min(length, np.min(-u[down] / v[down]))
        u += length * v


def errors(string, solution, n_cycles, step):
    u = string.guess()
    values = [string.error(u, solution)]
    for _ in range(n_cycles):
        step(u)
        values.append(string.error(u, solution))
    return np.array(values) / values[0]


def with_ends(values):
    return np.concatenate([[ENDS[0]], values, [ENDS[1]]])


def draw_step(axes, string, u, function, color):
    """The iterate, and what is best along the function."""
    x = np.linspace(0, 1, string.n + 1)
    best = (function @ string.residual(u)
            / (function @ string.matrix @ function))
    moved = u + best * function
    axes.axhspan(-0.6, 0, color="0.88", zorder=0)
    axes.axhline(0, color="0.35", linewidth=1)
    axes.plot(x, with_ends(u), "-", color="k", marker="o", markersize=2.2,
              linewidth=1)
    touching = u <= 0
    axes.plot(string.x[touching], u[touching], "o", color=ORANGE, markersize=4.5,
              zorder=4)
    axes.plot(x, with_ends(moved), "-", color=color, linewidth=1.7)
    # The function itself, above its nodes.
    shape = np.concatenate([[0], function, [0]])
    axes.fill_between(x, 1.2, 1.2 + 0.45 * shape, color=color, alpha=0.25,
                      linewidth=0)
    axes.plot(x, 1.2 + 0.45 * shape, color=color, linewidth=1.2)
    axes.set_xlim(0, 1)
    axes.set_ylim(-0.4, 1.7)
    axes.axis("off")


def draw(workshop):
    figure = plt.figure(figsize=(6.3, 4.9))
    upper = figure.add_gridspec(1, 2, left=0.02, right=0.98, top=0.99,
                                bottom=0.5, wspace=0.06)
    lower = figure.add_gridspec(1, 1, left=0.12, right=0.72, top=0.45,
                                bottom=0.1)

    # A coarse function with a part of the contact zone below it.
    string = String(32)
    u = string.guess()
    string.relax(u)
    whole = string.coarse[2][:, 2]
    left, right = (figure.add_subplot(upper[0, i]) for i in range(2))
    draw_step(left, string, u, whole, RED)
    draw_step(right, string, u, whole * (u > 0), BLUE)
    left.text(0.06, 1.35, "whole", color=RED)
    right.text(0.06, 1.35, "truncated", color=BLUE)
    left.text(0.02, -0.3, "floor", color="0.35")

    string = String(64)
    solution = string.solution()
    n_cycles = 25
    axes = figure.add_subplot(lower[0, 0])
    for name, step, color, marker in (
            ("relaxation alone", string.relax, GREY, "s"),
            ("whole, cut off", lambda u: string.cycle(u, False), RED, "v"),
            ("truncated", lambda u: string.cycle(u, True), BLUE, "o")):
        values = errors(string, solution, n_cycles, step)
        shown = values > 1e-11
        axes.semilogy(np.arange(n_cycles + 1)[shown], values[shown], color=color,
                      marker=marker, markersize=3.5)
        axes.text(n_cycles + 0.6 if shown.all() else np.sum(shown),
                  values[shown][-1], name, color=color,
                  va="bottom" if color == GREY else "center")
    axes.set_xlim(0, n_cycles)
    axes.set_xlabel("cycles")
    axes.set_ylabel("error")
    grid(axes)
    workshop.save(figure, "truncated-functions")
