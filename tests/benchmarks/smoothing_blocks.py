#!/usr/bin/env python3
"""Which blocks to relax in a body that can hardly be compressed?

Solves with the matrix of mean volumetric strains on a square of 32 by 32 cells,
held at bottom and top, by V-cycles of block Gauss-Seidel on Galerkin products,
alone and as preconditioner of conjugate gradients. Blocks are single nodes, the
nodes of a cell, and all nodes of the cells around a node, which overlap. What a
sweep costs is counted in node rows that are read. Coarse functions are those of the
bilinear elements, or have the middle of each coarse cell moved so that all four
cells of the finer level in it have the same mean divergence. Apart from the program:
only NumPy and SciPy.
"""
import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as sl


def cell_matrix(nu):
    """Bilinear element on a square, lambda times the mean divergence."""
    mu, lam = 1 / (2 * (1 + nu)), nu / ((1 + nu) * (1 - 2 * nu))
    A, D = np.zeros((8, 8)), np.zeros(8)
    for x in (0.5 - 1 / np.sqrt(12), 0.5 + 1 / np.sqrt(12)):
        for y in (0.5 - 1 / np.sqrt(12), 0.5 + 1 / np.sqrt(12)):
            g = np.array([[y - 1, x - 1], [1 - y, -x], [-y, 1 - x], [y, x]])
            B = np.zeros((3, 8))
            B[0, 0::2] = B[2, 1::2] = g[:, 0]
            B[1, 1::2] = B[2, 0::2] = g[:, 1]
            A += 0.25 * B.T @ np.diag([2 * mu, 2 * mu, mu]) @ B
            D += 0.25 * g.ravel()
    return A + lam * np.outer(D, D)


def nodes_of(n, i0, i1, j0, j1):
    """Unknowns of a rectangle of nodes, the last ones included."""
    return [2 * (i + (n + 1) * j) + c
            for j in range(max(j0, 0), min(j1, n) + 1)
            for i in range(max(i0, 0), min(i1, n) + 1) for c in (0, 1)]


BLOCKS = {
    "nodes": lambda n: [nodes_of(n, i, i, j, j)
                        for j in range(n + 1) for i in range(n + 1)],
    "cells": lambda n: [nodes_of(n, i, i + 1, j, j + 1)
                        for j in range(n) for i in range(n)],
    "cells around nodes": lambda n: [nodes_of(n, i - 1, i + 1, j - 1, j + 1)
                                     for j in range(n + 1)
                                     for i in range(n + 1)],
}


def is_free(n):
    free = np.ones((n + 1, n + 1, 2), bool)
    free[[0, n]] = False
    return free.ravel()


def prolongation(n, keeps_volumes):
    """From n to 2n cells, for the free unknowns.

    In a coarse cell of side 2 let u = a + b x + c y + d x y. Its divergence has the
    part d[0] y + d[1] x, whose means over the four cells in it are +-d[0]/2 +-d[1]/2. The
    function that is 1 in the middle, times w, has means -+w[0]/2 -+w[1]/2 there: with
    w = (d[1], d[0]) nothing is left."""
    P = sp.lil_matrix((2 * n + 1, n + 1))
    for i in range(n + 1):
        P[2 * i, i] = 1
    for i in range(n):
        P[2 * i + 1, i] = P[2 * i + 1, i + 1] = 0.5
    P = sp.kron(sp.kron(P, P), sp.eye(2)).tolil()
    for j in range(n if keeps_volumes else 0):
        for i in range(n):
            middle = nodes_of(2 * n, 2 * i + 1, 2 * i + 1, 2 * j + 1, 2 * j + 1)
            corners = nodes_of(n, i, i + 1, j, j + 1)
            for corner, sign in enumerate((1, -1, -1, 1)):
                P[middle[0], corners[2 * corner + 1]] += sign / 4
                P[middle[1], corners[2 * corner]] += sign / 4
    P = P.tocsr()
    return P[is_free(2 * n)][:, is_free(n)]


class Level:
    def __init__(self, n, A, blocks, keeps_volumes):
        self.A = A.tocsr()
        number = np.cumsum(is_free(n)) - 1
        self.blocks = [number[[i for i in block if is_free(n)[i]]]
                       for block in blocks(n)]
        self.blocks = [block for block in self.blocks if len(block) > 0]
        self.rows = [self.A[block] for block in self.blocks]
        self.inverses = [np.linalg.inv(rows[:, block].toarray())
                         for rows, block in zip(self.rows, self.blocks)]
        self.P = self.coarser = None
        if n > 2:
            self.P = prolongation(n // 2, keeps_volumes)
            self.coarser = Level(n // 2, self.P.T @ self.A @ self.P, blocks,
                                 keeps_volumes)
        else:
            self.solver = sl.splu(self.A.tocsc())

    def relax(self, x, b, n_sweeps, step):
        for _ in range(n_sweeps):
            for block, rows, inverse in list(
                    zip(self.blocks, self.rows, self.inverses))[::step]:
                x[block] += inverse @ (b[block] - rows @ x)

    def cycle(self, b, n_sweeps):
        if self.coarser is None:
            return self.solver.solve(b)
        x = np.zeros_like(b)
        self.relax(x, b, n_sweeps, 1)
        x += self.P @ self.coarser.cycle(self.P.T @ (b - self.A @ x), n_sweeps)
        self.relax(x, b, n_sweeps, -1)
        return x


def contraction(level, n_sweeps, n_cycles=14):
    """Of the energy norm of the error: cycles alone, conjugate gradients."""
    A = level.A
    norm = lambda e: np.sqrt(e @ (A @ e))
    exact = np.random.default_rng(0).standard_normal(A.shape[0])
    e, last = exact.copy(), 1.0
    for _ in range(n_cycles):
        last = norm(e)
        e -= level.cycle(A @ e, n_sweeps)
    alone = norm(e) / last

    e, r, errors = exact.copy(), A @ exact, []
    p, rz = np.zeros_like(r), np.inf
    for _ in range(n_cycles):
        z = level.cycle(r, n_sweeps)
        rz, last_rz = r @ z, rz
        p = z + rz / last_rz * p
        Ap = A @ p
        alpha = rz / (p @ Ap)
        e -= alpha * p
        r -= alpha * Ap
        errors.append(norm(e))
    return alone, (errors[-1] / errors[3]) ** (1 / (n_cycles - 4))


def main():
    print("\nblocks to relax: square of 32 by 32 cells, mean volumetric strains")
    print("    nu  blocks              sweeps  rows per node   alone"
          "   conjugate gradients  the same with coarse functions that keep volumes")
    n = 32
    for nu in (0.49, 0.499, 0.4999):
        cells = np.array(BLOCKS["cells"](n))
        A = sp.csr_matrix((np.tile(cell_matrix(nu).ravel(), len(cells)),
                           (np.repeat(cells, 8, axis=1).ravel(),
                            np.tile(cells, (1, 8)).ravel())))
        A = A[is_free(n)][:, is_free(n)]
        for name, rows, sweeps in (("nodes", 1, (4, 9, 20)),
                                   ("cells", 4, (1, 2, 5)),
                                   ("cells around nodes", 9, (1, 2))):
            levels = [Level(n, A, BLOCKS[name], keeps) for keeps in (False, True)]
            for n_sweeps in sweeps:
                print("%6g  %-18s  %6d  %13d  %6.3f  %6.3f               %6.3f  %6.3f" % (
                    (nu, name, n_sweeps, rows * n_sweeps)
                    + contraction(levels[0], n_sweeps)
                    + contraction(levels[1], n_sweeps)), flush=True)


if __name__ == "__main__":
    main()
