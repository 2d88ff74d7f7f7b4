"""The unit interval, square or cube. Its corner number v is at the end x_d = 1 in
direction d if bit d of v is set."""

import functools
import itertools

import numpy as np


@functools.lru_cache(None)
def gauss_points(n, dim):
    """Points (n^dim x dim) of the unit interval, square or cube, the first coordinate
    running fastest, and their weights."""
    x, w = np.polynomial.legendre.leggauss(n)
    x, w = (x + 1) / 2, w / 2
    points = [p[::-1] for p in itertools.product(x, repeat=dim)]
    weights = [np.prod(p) for p in itertools.product(w, repeat=dim)]
    result = np.array(points), np.array(weights)
    for values in result:
        values.flags.writeable = False  # all callers get the same
    return result


def corner_functions(points):
    """Multilinear functions that are 1 in one corner and 0 in the others: values
    (points x corners) and gradients (points x corners x dim)."""
    n_points, dim = points.shape
    values = np.ones((n_points, 2**dim))
    gradients = np.ones((n_points, 2**dim, dim))
    for corner in range(2**dim):
        for d in range(dim):
            up = corner >> d & 1
            factor = points[:, d] if up else 1 - points[:, d]
            values[:, corner] *= factor
            for e in range(dim):
                gradients[:, corner, e] *= (1 if up else -1) if e == d else factor
    return values, gradients


def local_faces(dim):
    """Corners of the faces of a cell."""
    return [[v for v in range(2**dim) if (v >> d & 1) == end]
            for d in range(dim) for end in (0, 1)]


def local_edges(dim):
    return [(v, v | 1 << d) for v in range(2**dim) for d in range(dim)
            if not v >> d & 1]
