"""The obstacle of a scene."""

import numpy as np

# It is not met at a flatter angle than this, as a cosine: what the suite documents.
FLATTEST = 0.05
# Whether a rod ends just here shall not be a matter of rounding.
ROUNDING = 1e-10


class Obstacle:
    """Half spaces, each beyond a plane with a point and a unit normal into it, and rods
    with a point in their middle, a unit axis (zero in two dimensions, and of balls),
    radius, length, and a side, which is -1 if they are holes; and surfaces."""

    def __init__(self, planes=(), rods=(), surfaces=()):
        self.planes, self.rods = list(planes), list(rods)
        self.surfaces = list(surfaces)

    def numbers(self):
        """All of it in one array; an infinite length is 0."""
        rods = [np.hstack([center, axis, radius, length if np.isfinite(length) else 0,
                           side])
                for center, axis, radius, length, side in self.rods]
        return np.hstack([*map(np.hstack, self.planes), *rods, []])

    def gap(self, x, n):
        """How far the points x (k x dim) may go along the unit vectors n until they
        meet it; infinite if they do not. For a rod that is the smaller root s of
        |P(x + s n - c)| = R, P being the projection along the axis, and for a hole the
        larger one."""
        gap = np.full(len(x), np.inf)
        with np.errstate(all="ignore"):
            for point, normal in self.planes:
                cosine = n @ normal
                distance = ((point - x) @ normal) / cosine
                gap = np.where(cosine > FLATTEST, np.minimum(gap, distance), gap)
            for center, axis, radius, length, side in self.rods:
                d = x - center
                d, m = (v - np.outer(v @ axis, axis) for v in (d, n))
                a, b = np.sum(m * m, axis=1), np.sum(m * d, axis=1)
                c = np.sum(d * d, axis=1) - radius**2
                root = np.sqrt(np.maximum(b * b - a * c, 0))
                # At the intersection the cosine of ray and surface is root / radius.
                distance = (-b - side * root) / a
                meets = (root > FLATTEST * radius) & ~((c > 0) & (side * b >= 0))
                along = (x + distance[:, None] * n - center) @ axis
                meets &= np.abs(along) <= (.5 + ROUNDING) * length
                gap = np.where(meets, np.minimum(gap, distance), gap)
        for surface in self.surfaces:
            gap = np.minimum(gap, surface.gap(x, n, FLATTEST))
        return gap

    def nearest(self, x, outward, flattest=FLATTEST):
        """The distance of points x from it, negative inside, and unit vectors towards
        the nearest plane or axis that a body with these normals faces, however long
        rods are; zeros where there is none."""
        smallest = np.full(len(x), np.inf)
        normals = np.zeros(x.shape)
        pieces = [((point - x) @ normal, np.tile(normal, (len(x), 1)))
                  for point, normal in self.planes]
        pieces += [surface.nearest(x) for surface in self.surfaces]
        for center, axis, radius, _, side in self.rods:
            to_axis = center - x
            to_axis = to_axis - np.outer(to_axis @ axis, axis)
            norm = np.linalg.norm(to_axis, axis=1)
            pieces.append((side * (norm - radius),
                           side * to_axis / np.where(norm > 0, norm, 1)[:, None]))
        for distance, direction in pieces:
            nearer = (distance < smallest) & (np.sum(direction * outward, axis=1) > flattest)
            smallest[nearer], normals[nearer] = distance[nearer], direction[nearer]
        return smallest, normals

    def depth(self, x):
        """How deep points x are inside, 0 outside."""
        depth = np.zeros(len(x))
        for point, normal in self.planes:
            depth = np.maximum(depth, (x - point) @ normal)
        for surface in self.surfaces:
            depth = np.maximum(depth, surface.depth(x))
        for center, axis, radius, length, side in self.rods:
            d = x - center
            along = d @ axis
            across = np.linalg.norm(d - np.outer(along, axis), axis=1)
            within = np.abs(along) <= length / 2
            depth = np.where(within, np.maximum(depth, side * (radius - across)),
                             depth)
        return depth
