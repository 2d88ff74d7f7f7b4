"""Obstacles that are given by a function."""

import numpy as np


class Surface:
    """Where a function of points (k x dim) is zero; it is negative in the obstacle.
    What is farther than the given size is not found."""

    def __init__(self, function, size):
        self.function, self.size = function, size

    def slope(self, x):
        """The gradient, by differences of fourth order."""
        h = 1e-4 * self.size
        result = np.empty(x.shape)
        for d in range(x.shape[1]):
            e = np.zeros(x.shape[1])
            e[d] = h
            result[:, d] = (8 * (self.function(x + e) - self.function(x - e))
                            - self.function(x + 2 * e) + self.function(x - 2 * e)
                            ) / (12 * h)
        return result

    def gap(self, x, n, flattest):
        """How far points x may go along unit vectors n; the way back, and negative,
        where they are inside. All points step together, and then the first step in
        which the sign changes is halved until nothing is left of it. Steps are half as
        long as what the suite may overlook."""
        start = self.function(x)
        sign = np.where(start < 0, -1., 1.)
        steps = 20000
        low, high = np.zeros(len(x)), np.full(len(x), np.inf)
        for k in range(1, steps + 1):
            open_ones = np.flatnonzero(~np.isfinite(high))
            if len(open_ones) == 0:
                break
            s = k * self.size / steps
            value = self.function(x[open_ones] + (sign[open_ones] * s)[:, None]
                                  * n[open_ones])
            met = (value < 0) != (start[open_ones] < 0)
            high[open_ones[met]] = s
            low[open_ones[~met]] = s
        met = np.isfinite(high)
        for _ in range(60):
            middle = np.where(met, (low + high) / 2, 0)
            value = self.function(x + (sign * middle)[:, None] * n)
            passed = (value < 0) != (start < 0)
            high = np.where(passed & met, middle, high)
            low = np.where(~passed & met, middle, low)
        gap = np.where(met, sign * low, np.inf)
        at = x + np.where(met, gap, 0)[:, None] * n
        slope = self.slope(at)
        cosine = -np.sum(slope * n, axis=1) / np.linalg.norm(slope, axis=1)
        return np.where(cosine > flattest, gap, np.inf)

    def nearest(self, x):
        """Distances, negative inside, and unit vectors, as the gradient has them."""
        slope = self.slope(x)
        norm = np.maximum(np.linalg.norm(slope, axis=1), 1e-300)
        return self.function(x) / norm, -slope / norm[:, None]

    def depth(self, x):
        value, slope = self.function(x), self.slope(x)
        return np.maximum(-value, 0) / np.linalg.norm(slope, axis=1)
