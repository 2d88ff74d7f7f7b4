"""The contact boundary as a line or a map: where its nodes are, seen from itself."""

import numpy as np


def tractions(nodes):
    """Of the records of contact nodes: pressure, and the tangential stress as
    vectors."""
    measure = np.maximum(nodes["measure"], 1e-300)
    traction = nodes["force"] / measure[:, None]
    normal = nodes["normal"]
    pressure = -np.sum(traction * normal, axis=1)
    return pressure, traction + pressure[:, None] * normal


# Up to so many nodes each is compared with all others.
FEW_NODES = 2000
# Several parts of a picture ask for the same.
_known = []


def chains(points, measure):
    """Contact nodes of the plane in the order in which the boundary runs through them:
    a list of arrays of indices, one per connected piece of it. Neighbours are not
    further from each other than the sum of their measures, each of which is half of
    what lies between a node and its neighbours."""
    for known_points, pieces in _known:
        if known_points is points:
            return pieces
    nearby = Nearby(points)
    is_left = np.ones(len(points), bool)
    result = []
    while is_left.any():
        # A walk ends at an end, from which the next one sees the whole piece.
        end = walk(points, measure, int(np.argmax(is_left)), is_left, nearby)[-1]
        chain = walk(points, measure, end, is_left, nearby)
        is_left[chain] = False
        result.append(np.array(chain))
    _known[:] = [*_known[-8:], (points, result)]
    return result


def walk(points, measure, start, allowed, nearby):
    """From a node to the nearest one that has not been visited, and so on."""
    is_open = allowed.copy()
    chain = [start]
    is_open[start] = False

    def closest(candidates):
        here = chain[-1]
        candidates = candidates[is_open[candidates]]
        distance = np.hypot(*(points[candidates] - points[here]).T)
        near = distance <= 1.01 * (measure[candidates] + measure[here])
        if not near.any():
            return None
        return int(candidates[near][np.argmin(distance[near])])

    while True:
        following = closest(nearby.to(chain[-1]))
        if following is None and not nearby.has_all:
            following = closest(np.flatnonzero(is_open))
        if following is None:
            return chain
        is_open[following] = False
        chain.append(following)


class Nearby:
    """Where to look for the neighbours of a node: the boundary is a graph over x or over
    y nearly everywhere, so that neighbours are neighbours if nodes are sorted by it."""

    WIDTH = 16

    def __init__(self, points):
        self.has_all = len(points) <= FEW_NODES
        self._all = np.arange(len(points))
        self._orders = []
        if not self.has_all:
            # Up to rounding, where several have the same.
            places = np.round(points / (np.ptp(points) * 1e-9)).astype(np.int64)
            for first, second in ((0, 1), (1, 0)):
                order = np.lexsort((places[:, second], places[:, first]))
                position = np.empty(len(points), int)
                position[order] = self._all
                self._orders.append((order, position))

    def to(self, node):
        if self.has_all:
            return self._all
        return np.concatenate([
            order[max(position[node] - self.WIDTH, 0):position[node] + self.WIDTH + 1]
            for order, position in self._orders])


class Line:
    """The contact boundary of the plane as an axis: `pieces` are arrays of indices of
    nodes, `place` is where each node is on the axis, `tangent` the direction in which
    the axis runs, `name` what it measures.

    If the boundary, where it is looked at, is a graph over x or y, that is the axis;
    otherwise it is the length along it, from the end where x is smallest."""

    def __init__(self, nodes, shown):
        points, normal = nodes["point"], nodes["normal"]
        self.pieces = chains(points, nodes["measure"])
        self.tangent = np.stack([-normal[:, 1], normal[:, 0]], axis=1)
        for axis, name in enumerate("xy"):
            if (np.abs(self.tangent[shown, axis]) > 0.35).all() and self._is_graph(
                    points[:, axis], shown):
                self.name = name
                self.place = points[:, axis].copy()
                self.tangent *= np.sign(self.tangent[:, axis])[:, None]
                break
        else:
            self.name = "length along the contact boundary"
            self._measure(points)
        self.pieces = [piece[np.argsort(self.place[piece], kind="stable")]
                       if self.name in "xy" else piece for piece in self.pieces]

    def _is_graph(self, values, shown):
        """Whether no two of the nodes that are shown are above each other."""
        for piece in self.pieces:
            steps = np.diff(values[piece[shown[piece]]])
            if not ((steps > 0).all() or (steps < 0).all()):
                return False
        return True

    def _measure(self, points):
        self.place = np.zeros(len(points))
        start, pieces = 0., []
        for piece in sorted(self.pieces, key=lambda p: points[p, 0].min()):
            if points[piece[0], 0] > points[piece[-1], 0]:
                piece = piece[::-1]
            steps = np.diff(points[piece], axis=0)
            length = np.concatenate([[0.], np.cumsum(np.linalg.norm(steps, axis=1))])
            self.place[piece] = start + length
            start += 1.1 * length[-1]
            along = np.gradient(points[piece], axis=0) if len(piece) > 1 else 0.
            turned = np.sign(np.sum(along * self.tangent[piece], axis=1))
            self.tangent[piece] *= np.where(turned == 0, 1., turned)[:, None]
            pieces.append(piece)
        self.pieces = pieces


def zone(points, states, margin, smallest=0.):
    """Bounds of the box around the nodes in contact, each side wider by a part of its
    length; all nodes where nothing touches. Rows: lower, upper."""
    inside = points[states > 0] if (states > 0).any() else points
    lower, upper = inside.min(axis=0), inside.max(axis=0)
    size = np.maximum(upper - lower, smallest)
    middle = (lower + upper) / 2
    return np.stack([middle - (0.5 + margin) * size, middle + (0.5 + margin) * size])


class Chart:
    """A map of the contact boundary in space: `place(points)` are two coordinates of
    each point, `names` what they measure, `frame` two unit vectors for each of the
    points given to frame(), along which they grow.

    What is curved in one direction only is unrolled along the circle that fits it
    best; all else is seen along its mean normal."""

    def __init__(self, points, normals, up):
        mean = normals.mean(axis=0)
        self.normal = mean / max(np.linalg.norm(mean), 1e-300)
        spread = np.linalg.eigh(normals.T @ normals / len(normals))
        self.circle = None
        deviation = np.abs(normals @ self.normal).min()
        if deviation < 1 - 1e-4 and spread[0][0] < 1e-6:
            self._unroll(points, normals, spread[1][:, 0])
        if self.circle is None:
            self._project(up)

    def _unroll(self, points, normals, axis):
        """x = c + R n, up to the axis."""
        axis = axis * np.sign(axis[np.argmax(np.abs(axis))])
        across = np.eye(3) - np.outer(axis, axis)
        p, n = points @ across, normals @ across
        n_points = len(p)
        system = np.zeros((3 * n_points, 4))
        system[:, :3] = np.tile(np.eye(3), (n_points, 1))
        system[:, 3] = n.ravel()
        solution = np.linalg.lstsq(system, p.ravel(), rcond=None)[0]
        radius = solution[3]
        fit = np.abs(system @ solution - p.ravel()).max()
        if fit > 0.05 * abs(radius):
            return
        outwards = self.normal @ across
        outwards /= np.linalg.norm(outwards)
        around = np.cross(axis, outwards)
        self.circle = (solution[:3], radius, axis, outwards, around)
        self.names = ["length along " + direction_name(axis), "length around it"]
        if abs(axis[np.argmax(np.abs(axis))]) < 0.999:
            self.names[0] = "length along the axis"

    def _project(self, up):
        right = np.cross(up, self.normal)
        if np.linalg.norm(right) < 1e-2:
            right = np.eye(3)[np.argmin(np.abs(self.normal))]
        # As far as possible along the axes, so that coordinates are those of the scene.
        axes = [e for e in np.eye(3) if abs(e @ self.normal) < 1e-3]
        if len(axes) == 2:
            self.axes = np.array(axes)
            self.names = [direction_name(e) for e in axes]
            return
        right -= (right @ self.normal) * self.normal
        right /= np.linalg.norm(right)
        self.axes = np.array([right, np.cross(self.normal, right)])
        self.names = ["across the mean normal", "across the mean normal"]

    def place(self, points):
        if self.circle is None:
            return points @ self.axes.T
        center, radius, axis, outwards, around = self.circle
        q = (points - center) * np.sign(radius)
        angle = np.arctan2(q @ around, q @ outwards)
        return np.stack([points @ axis, radius * angle], axis=1)

    def components(self, normals, vectors):
        """Of tangential vectors at points with the given normals, along the two
        coordinates."""
        if self.circle is None:
            return vectors @ self.axes.T
        axis = self.circle[2]
        around = np.cross(axis, normals)
        around /= np.linalg.norm(around, axis=1)[:, None]
        return np.stack([vectors @ axis, np.sum(vectors * around, axis=1)], axis=1)


def direction_name(axis):
    return "xyz"[int(np.argmax(np.abs(axis)))]
