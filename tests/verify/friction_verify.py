#!/usr/bin/env python3
"""Recomputes what a run of step-friction-2d or step-friction-3d has found, and says
whether its certificate is true.

Usage: friction-verify DIRECTORY [--tolerance X]

DIRECTORY is the output directory of a run with 'Output/Verification=true'. This
program shares no code with the one it looks at. From history.h5 it takes the scene
and the reported numbers, from verify-NN.h5 the mesh and the displacement of level NN.
Residual, gaps, normals, measures, hanging nodes and nodal loads it finds by itself, and
loads, prescribed displacements, material, obstacle and law of friction are compared
with what the scene says. Needs Python with numpy and h5py.

A row per level:

  equilibrium  largest force at a node, in a direction, that nothing holds
  penetration  largest depth of a node inside the obstacle
  tension      largest force that pulls, or that acts at a distance
  cone         by how much friction exceeds its bound
  slip         by how much friction where a node slides differs from the bound, or in
               direction from opposing the slip
  states       the same if nodes do what they are said to do: open, sliding, sticking
  given        displacements that are prescribed or interpolated, loads and all that the
               scene says, compared with what the run made of it
  energy       difference from the reported energy, relative to its parts

Forces are relative to the largest nodal force, lengths to the largest displacement of a
node that may get into contact. All but 'given', which is exact, may be as large as the
tolerance of the certificate in the scene, or X. The certificate itself, whose lengths
are relative to the largest gap if that is larger, must not be worse than reported.

Exit status: 0 confirmed, 1 refuted, 2 if there is nothing that could be read.
"""

import argparse
import itertools
import re
import sys
from pathlib import Path

try:
    import h5py
    import numpy as np
except ImportError as error:
    print(f"friction-verify: Python has no module '{error.name}'; on Debian install "
          "python3-h5py.", file=sys.stderr)
    sys.exit(2)

# Relative difference of what should be the same but for rounding.
ROUNDING = 1e-9
# The obstacle is not met at a flatter angle than this, as a cosine: what the
# documentation of the class Obstacle says.
FLATTEST = 0.05


class NotReadable(Exception):
    """One sentence that says what cannot be read."""


# --------------------------------------------------------------------------------------
# The unit square or cube. Its corner number v is at the end x_d = 1 in direction d if
# bit d of v is set.


def gauss_points(n, dim):
    """Points (n^dim x dim) of the unit interval, square or cube, the first coordinate
    running fastest, and their weights."""
    x, w = np.polynomial.legendre.leggauss(n)
    x, w = (x + 1) / 2, w / 2
    points = [p[::-1] for p in itertools.product(x, repeat=dim)]
    weights = [np.prod(p) for p in itertools.product(w, repeat=dim)]
    return np.array(points), np.array(weights)


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


# --------------------------------------------------------------------------------------
# Expressions of a scene file, in the syntax of muParser.


class NotUnderstood(Exception):
    """An expression that this program does not know how to evaluate."""


def _logical(f):
    return lambda *arguments: np.where(f(*arguments), 1., 0.)


FUNCTIONS = {
    "sin": np.sin, "cos": np.cos, "tan": np.tan, "asin": np.arcsin, "acos": np.arccos,
    "atan": np.arctan, "atan2": np.arctan2, "sinh": np.sinh, "cosh": np.cosh,
    "tanh": np.tanh, "exp": np.exp, "log": np.log, "ln": np.log, "log2": np.log2,
    "log10": np.log10, "sqrt": np.sqrt, "abs": np.abs, "sign": np.sign,
    "pow": np.power, "floor": np.floor, "ceil": np.ceil, "rint": np.rint,
    "if": lambda c, a, b: np.where(np.rint(c) != 0, a, b),
    "min": lambda *a: np.min(np.broadcast_arrays(*a), axis=0),
    "max": lambda *a: np.max(np.broadcast_arrays(*a), axis=0),
    "sum": lambda *a: sum(a),
}
OPERATORS = [
    {"||": _logical(lambda a, b: (a != 0) | (b != 0))},
    {"&&": _logical(lambda a, b: (a != 0) & (b != 0))},
    {"<=": _logical(np.less_equal), ">=": _logical(np.greater_equal),
     "!=": _logical(np.not_equal), "==": _logical(np.equal), "<": _logical(np.less),
     ">": _logical(np.greater)},
    {"+": np.add, "-": np.subtract},
    {"*": np.multiply, "/": np.divide},
]
TOKEN = re.compile(r"\s*(?:(\d+\.?\d*(?:[eE][-+]?\d+)?|\.\d+(?:[eE][-+]?\d+)?)"
                   r"|([A-Za-z_]\w*)|(\|\||&&|<=|>=|!=|==|[-+*/^()<>,?:]))")


class Expression:
    """Evaluated while it is read: the argument of every operator is a number or an
    array of one number per point."""

    def __init__(self, text, names):
        """names: of numbers and arrays, and of texts that are to be evaluated."""
        self.text, self.names, self.tokens, position = text, names, [], 0
        text = text.rstrip()
        while position < len(text):
            match = TOKEN.match(text, position)
            if not match:
                raise NotUnderstood(self.text)
            self.tokens.append(match.groups())
            position = match.end()
        self.tokens.append((None, None, None))
        self.at = 0

    def value(self):
        with np.errstate(all="ignore"):
            result = self._condition()
        if self.at != len(self.tokens) - 1:
            raise NotUnderstood(self.text)
        return result

    def _next_is(self, *symbols):
        symbol = self.tokens[self.at][2]
        if symbol in symbols:
            self.at += 1
            return symbol
        return None

    def _demand(self, symbol):
        if not self._next_is(symbol):
            raise NotUnderstood(self.text)

    def _condition(self):
        value = self._binary(0)
        if self._next_is("?"):
            first = self._condition()
            self._demand(":")
            return np.where(value != 0, first, self._condition())
        return value

    def _binary(self, strength):
        if strength == len(OPERATORS):
            return self._signed()
        value = self._binary(strength + 1)
        while True:
            symbol = self._next_is(*OPERATORS[strength])
            if not symbol:
                return value
            value = OPERATORS[strength][symbol](value, self._binary(strength + 1))

    def _signed(self):
        if self._next_is("-"):
            return -self._signed()
        if self._next_is("+"):
            return self._signed()
        base = self._operand()
        if self._next_is("^"):
            return np.power(base, self._signed())
        return base

    def _operand(self):
        number, name, _ = self.tokens[self.at]
        if self._next_is("("):
            value = self._condition()
            self._demand(")")
            return value
        self.at += 1
        if number is not None:
            return np.float64(number)
        if name in FUNCTIONS and self._next_is("("):
            arguments = [self._condition()]
            while self._next_is(","):
                arguments.append(self._condition())
            self._demand(")")
            return FUNCTIONS[name](*arguments)
        if name not in self.names:
            raise NotUnderstood(self.text)
        value = self.names[name]
        return Expression(value, self.names).value() if isinstance(value, str) else value


def split(text, separator):
    """At a character that is not inside parentheses; without empty parts."""
    parts, depth = [""], 0
    for c in text:
        depth += (c == "(") - (c == ")")
        if c == separator and depth == 0:
            parts.append("")
        else:
            parts[-1] += c
    return [part.strip() for part in parts if part.strip()]


# --------------------------------------------------------------------------------------
# The scene, as it is written.


class SceneText:
    """What the parameters in history.h5 say. Raises NotUnderstood where that is beyond
    this program."""

    def __init__(self, text, dim):
        self.dim, self.entries, section = dim, {}, ""
        for line in text.splitlines():
            line = line.split("#")[0].strip()
            if line.startswith("subsection "):
                section = line[len("subsection "):].strip() + "/"
            elif line == "end":
                section = ""
            elif line.startswith("set ") and "=" in line:
                name, _, value = line[4:].partition("=")
                self.entries[section + name.strip()] = value.strip()

        E, nu = self.number("Material/Young's modulus"), self.number(
            "Material/Poisson ratio")
        self.names = {"E": E, "nu": nu, "lambda": E * nu / (1 + nu) / (1 - 2 * nu),
                      "mu": E / 2 / (1 + nu), "pi": np.pi,
                      "F": self.number("Contact/Friction coefficient")}
        for part in split(self["Scene/Constants"], ";"):
            name, _, expression = part.partition("=")
            self.names[name.strip()] = self.evaluate(expression)
        for part in split(self["Scene/Definitions"], ";"):
            name, _, expression = part.partition("=")
            self.names[name.strip()] = expression

        angle = self.number("Scene/Rotation angle")
        c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
        self.rotation = np.eye(dim)
        self.rotation[:2, :2] = [[c, -s], [s, c]]

    def __getitem__(self, entry):
        if entry not in self.entries:
            raise NotReadable(f"'{entry}' is not among the parameters in history.h5.")
        return self.entries[entry]

    def number(self, entry):
        return float(self[entry])

    def evaluate(self, expression, points=None):
        """At points (n x dim) of the scene before it is turned, or without any."""
        names = dict(self.names)
        if points is not None:
            names.update(zip("xyz", points.T))
        return Expression(expression, names).value()

    def numbers(self, text):
        return np.array([self.evaluate(part) for part in split(text, ",")], float)

    def vector_field(self, components, points):
        """Of the scene as it has been turned, at points of it (n x dim)."""
        original = points @ self.rotation
        values = np.empty(points.shape)
        for d, component in enumerate(components):
            values[:, d] = self.evaluate(component, original)
        return values @ self.rotation.T

    def conditions(self, entry):
        """Pairs of a key and components."""
        for part in split(self[entry], ";"):
            key, _, components = part.partition(":")
            yield key.strip(), split(components, ",")

    def obstacle(self):
        """An Obstacle, like that of a verify-NN.h5."""
        kind, dim = self["Obstacle/Kind"], self.dim
        if kind == "none":
            return Obstacle()
        if kind == "plane":
            point = self.numbers(self["Obstacle/Point"])
            normal = self.numbers(self["Obstacle/Normal"])
            if len(point) == 0:
                point = np.zeros(dim)
            if len(normal) == 0:
                normal = -np.eye(dim)[-1]
            normal /= np.linalg.norm(normal)
            return Obstacle(planes=[(self.rotation @ point, self.rotation @ normal)])
        length = self.numbers(self["Obstacle/Length"])
        radius = self.number("Obstacle/Radius")
        rods, axes = [], split(self["Obstacle/Axes"], ";")
        for i, center in enumerate(split(self["Obstacle/Centers"], ";")):
            axis = self.numbers(axes[i]) if dim == 3 else np.zeros(dim)
            if dim == 3:
                axis /= np.linalg.norm(axis)
            rods.append((self.rotation @ self.numbers(center), self.rotation @ axis,
                         radius, length[0] if len(length) else np.inf))
        return Obstacle(rods=rods)


# --------------------------------------------------------------------------------------
# The obstacle.


class Obstacle:
    """Half spaces, each beyond a plane with a point and a unit normal into it, and rods
    with a point in their middle, a unit axis (zero in two dimensions), radius and
    length."""

    def __init__(self, planes=(), rods=()):
        self.planes, self.rods = list(planes), list(rods)

    def numbers(self):
        """All of it in one array; an infinite length is 0."""
        rods = [np.hstack([center, axis, radius, length if np.isfinite(length) else 0])
                for center, axis, radius, length in self.rods]
        return np.hstack([*map(np.hstack, self.planes), *rods, []])

    def gap(self, x, n):
        """How far the points x (k x dim) may go along the unit vectors n until they meet
        it; infinite if they do not. For a rod that is the smaller root s of
        |P(x + s n - c)| = R, P being the projection along the axis."""
        gap = np.full(len(x), np.inf)
        with np.errstate(all="ignore"):
            for point, normal in self.planes:
                cosine = n @ normal
                distance = ((point - x) @ normal) / cosine
                gap = np.where(cosine > FLATTEST, np.minimum(gap, distance), gap)
            for center, axis, radius, length in self.rods:
                d = x - center
                d, m = (v - np.outer(v @ axis, axis) for v in (d, n))
                a, b = np.sum(m * m, axis=1), np.sum(m * d, axis=1)
                c = np.sum(d * d, axis=1) - radius**2
                root = np.sqrt(np.maximum(b * b - a * c, 0))
                # At the intersection the cosine of ray and surface is root / radius.
                distance = (-b - root) / a
                meets = (root > FLATTEST * radius) & ~((c > 0) & (b >= 0))
                along = (x + distance[:, None] * n - center) @ axis
                meets &= np.abs(along) <= (.5 + ROUNDING) * length
                gap = np.where(meets, np.minimum(gap, distance), gap)
        return gap

    def nearest(self, x):
        """The distance of points x from it, negative inside, and unit vectors towards
        the nearest plane or axis, however long rods are."""
        smallest = np.full(len(x), np.inf)
        normals = np.zeros(x.shape)
        pieces = [((point - x) @ normal, np.tile(normal, (len(x), 1)))
                  for point, normal in self.planes]
        for center, axis, radius, _ in self.rods:
            to_axis = center - x
            to_axis = to_axis - np.outer(to_axis @ axis, axis)
            norm = np.linalg.norm(to_axis, axis=1)
            pieces.append((norm - radius,
                           to_axis / np.where(norm > 0, norm, 1)[:, None]))
        for distance, direction in pieces:
            nearer = distance < smallest
            smallest[nearer], normals[nearer] = distance[nearer], direction[nearer]
        return smallest, normals

    def depth(self, x):
        """How deep points x are inside, 0 outside."""
        depth = np.zeros(len(x))
        for point, normal in self.planes:
            depth = np.maximum(depth, (x - point) @ normal)
        for center, axis, radius, length in self.rods:
            d = x - center
            along = d @ axis
            across = np.linalg.norm(d - np.outer(along, axis), axis=1)
            within = np.abs(along) <= length / 2
            depth = np.where(within, np.maximum(depth, radius - across), depth)
        return depth


# --------------------------------------------------------------------------------------
# The discrete problem of a level.


class Level:
    """What verify-NN.h5 holds, under the names that it has there."""

    def __init__(self, path):
        try:
            with h5py.File(path) as file:
                for name, value in file.attrs.items():
                    setattr(self, name, value)
                data = {name: item[()] for name, item in file.items()}
            self.dim = dim = int(self.dimension)
            self.vertices, self.cells = data["vertices"], data["cells"].astype(int)
            self.displacement = data["displacement"]
            self.boundary_faces = data["boundary_faces"].astype(int)
            self.boundary_ids = data["boundary_ids"].astype(int)
        except (OSError, KeyError, AttributeError, ValueError) as error:
            raise NotReadable(f"'{path}' cannot be read: it is no file that "
                              f"'Output/Verification' makes, or damaged.") from error

        def rows(name, columns, kind=float):
            empty = np.zeros((0, columns) if columns > 1 else 0)
            return np.asarray(data.get(name, empty)).astype(kind)

        self.hanging_nodes = rows("hanging_nodes", 2, int)
        self.hanging_weights = rows("hanging_weights", 1)
        self.prescribed = rows("prescribed", 2, int)
        self.prescribed_values = rows("prescribed_values", 1)
        self.body_force = data.get("body_force")
        self.traction_faces = rows("traction_faces", 2**(dim - 1), int)
        self.tractions = rows("tractions", dim)
        self.contact_nodes = rows("contact_nodes", 1, int)
        self.contact_normals = rows("contact_normals", dim)
        self.contact_states = rows("contact_states", 1, int)
        self.friction_bounds = data.get("friction_bounds")
        self.obstacle = Obstacle(
            list(zip(rows("plane_points", dim), rows("plane_normals", dim))),
            [(c, a, r, length if length > 0 else np.inf) for c, a, r, length in zip(
                rows("rod_centers", dim), rows("rod_axes", dim), rows("rod_radii", 1),
                rows("rod_lengths", 1))])
        self.n_nodes = len(self.vertices)

        # Whether a component of a node is prescribed, and its value.
        self.is_prescribed = np.zeros((self.n_nodes, dim), bool)
        self.values = np.zeros((self.n_nodes, dim))
        self.is_prescribed[tuple(self.prescribed.T)] = True
        self.values[tuple(self.prescribed.T)] = self.prescribed_values


def add_up(n_nodes, nodes, values):
    """Sums of values (k x corners x dim) at the nodes (k x corners) they belong to."""
    return np.stack([np.bincount(nodes.ravel(), values[..., d].ravel(), n_nodes)
                     for d in range(values.shape[-1])], axis=-1)


def body_integrals(level):
    """Nodal internal forces A u (nodes x dim) with hanging nodes not yet condensed, the
    strain energy, and the trace of the diagonal block of each node.

    Linear elasticity, in two dimensions plane strain, sigma = lambda theta I + 2 mu eps,
    and theta the divergence of the displacement, or its mean over the cell."""
    E, nu, dim = level.youngs_modulus, level.poisson_ratio, level.dim
    lame, mu = E * nu / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu))
    X, U = level.vertices[level.cells], level.displacement[level.cells]
    points, weights = gauss_points(2, dim)
    _, on_unit_cell = corner_functions(points)

    at_points, volume, expansion, mean_gradient = [], 0, 0, 0
    for q, weight in enumerate(weights):
        # J_de = d x_d / d xi_e; shape functions have gradients G = (d xi / d x)^T.
        J = np.einsum("kvd,ve->kde", X, on_unit_cell[q])
        dx = np.linalg.det(J) * weight
        if not np.all(dx > 0):
            raise NotReadable("the mesh has cells that are turned inside out.")
        G = np.einsum("ve,ked->kvd", on_unit_cell[q], np.linalg.inv(J))
        gradient = np.einsum("kvi,kvj->kij", U, G)
        at_points.append((G, gradient, dx))
        volume = volume + dx
        expansion = expansion + dx * np.trace(gradient, axis1=1, axis2=2)
        mean_gradient = mean_gradient + dx[:, None, None] * G

    forces, diagonal, energy = 0, 0, 0.
    averaged = level.volumetric_strain == "mean"
    for G, gradient, dx in at_points:
        strain = (gradient + gradient.transpose(0, 2, 1)) / 2
        theta = np.trace(strain, axis1=1, axis2=2)
        H = G
        if averaged:
            theta, H = expansion / volume, mean_gradient / volume[:, None, None]
        stress = 2 * mu * strain + (lame * theta)[:, None, None] * np.eye(dim)
        forces = forces + np.einsum("k,kvj,kij->kvi", dx, G, stress)
        energy += np.sum(dx * (mu * np.sum(strain**2, axis=(1, 2))
                               + lame / 2 * theta**2))
        diagonal = diagonal + dx[:, None] * (
            lame * np.sum(H**2, axis=2) + mu * (1 + dim) * np.sum(G**2, axis=2))
    # The stress of the mean is constant in the cell, so that the gradients of test
    # functions, too, count with their mean only.
    return (add_up(level.n_nodes, level.cells, forces), energy,
            add_up(level.n_nodes, level.cells, diagonal[..., None])[:, 0])


def area_vectors(corners, points):
    """Of faces (k x corners x dim) at points of the unit interval or square: normal
    times surface element (k x points x dim), up to the sign."""
    _, gradients = corner_functions(points)
    tangents = np.einsum("kvd,qve->kqed", corners, gradients)
    if corners.shape[-1] == 2:
        t = tangents[:, :, 0]
        return np.stack([t[..., 1], -t[..., 0]], axis=-1)
    return np.cross(tangents[:, :, 0], tangents[:, :, 1])


def nodal_loads(level, body_force, faces, tractions):
    """Nodal forces (nodes x dim), hanging nodes not yet condensed, of a body force at
    2^dim points per cell and tractions at 4^(dim-1) points per face."""
    dim, loads = level.dim, np.zeros((level.n_nodes, level.dim))
    if body_force is not None:
        points, weights = gauss_points(2, dim)
        values, gradients = corner_functions(points)
        J = np.einsum("kvd,qve->kqde", level.vertices[level.cells], gradients)
        dx = np.linalg.det(J) * weights
        at_points = body_force.reshape(len(level.cells), len(points), dim)
        loads += add_up(level.n_nodes, level.cells,
                        np.einsum("kq,qv,kqd->kvd", dx, values, at_points))
    if len(faces):
        points, weights = gauss_points(4, dim - 1)
        values, _ = corner_functions(points)
        dx = weights * np.linalg.norm(
            area_vectors(level.vertices[faces], points), axis=-1)
        at_points = tractions.reshape(len(faces), len(points), dim)
        loads += add_up(level.n_nodes, faces,
                        np.einsum("kq,qv,kqd->kvd", dx, values, at_points))
    return loads


def find_hanging_nodes(level):
    """Of a mesh without further knowledge: a dictionary from each hanging node to its
    masters and their weights.

    A node hangs in the middle of an edge of a cell if there are edges of other cells
    from it to both ends, and in the middle of a face if the middles of the face's four
    edges hang and all have an edge to it."""
    vertices, neighbors = level.vertices, [set() for _ in range(level.n_nodes)]
    edges = np.vstack([level.cells[:, list(edge)] for edge in local_edges(level.dim)])
    edges = np.unique(np.sort(edges, axis=1), axis=0)
    for a, b in edges.tolist():
        neighbors[a].add(b)
        neighbors[b].add(a)

    def near_middle(candidates, corners):
        """The one nearest to the middle, if it is near enough; boundaries are curved."""
        middle = vertices[corners].mean(axis=0)
        size = np.linalg.norm(vertices[corners[0]] - vertices[corners[-1]])
        candidates = [(np.linalg.norm(vertices[c] - middle), c) for c in candidates]
        distance, best = min(candidates, default=(np.inf, None))
        return best if distance < .35 * size else None

    masters, middles = {}, {}
    for a, b in edges.tolist():
        middle = near_middle(neighbors[a] & neighbors[b], [a, b])
        if middle is not None:
            masters[middle] = {a: .5, b: .5}
            middles[a, b] = middle
    if level.dim == 3 and middles:
        # Of the corners 0 1 / 2 3 of a face, these pairs are edges.
        for face in level.cells[:, np.array(local_faces(3))].reshape(-1, 4).tolist():
            ends = [tuple(sorted((face[i], face[j])))
                    for i, j in ((0, 1), (2, 3), (0, 2), (1, 3))]
            if all(end in middles for end in ends):
                common = set.intersection(*(neighbors[middles[end]] for end in ends))
                middle = near_middle(common - set(face), face)
                if middle is not None:
                    masters[middle] = {corner: .25 for corner in face}

    # Masters that hang themselves are replaced by theirs.
    def resolve(node, weight, result):
        if node not in masters:
            result[node] = result.get(node, 0) + weight
            return result
        for master, share in masters[node].items():
            resolve(master, weight * share, result)
        return result

    return {node: resolve(node, 1., {}) for node in masters}


class Contact:
    """The contact boundary: measure and mean normal of its nodes."""

    def __init__(self, level, hanging):
        dim, n = level.dim, level.n_nodes
        faces = level.boundary_faces[level.boundary_ids == level.contact_boundary]
        points, weights = gauss_points(2, dim - 1)
        values, _ = corner_functions(points)
        vectors = area_vectors(level.vertices[faces], points) if len(faces) else (
            np.zeros((0, len(points), dim)))

        # Outwards is away from the cell that the face belongs to.
        table = {}
        for cell in level.cells:
            for corners in local_faces(dim):
                table.setdefault(tuple(sorted(cell[corners])), []).append(cell)
        self.problem = None
        outwards = np.ones(len(faces))
        for i, face in enumerate(faces):
            cells = table.get(tuple(sorted(face)), [])
            if len(cells) != 1:
                self.problem = "a face of the contact boundary is inside of the body"
                continue
            away = (level.vertices[face].mean(axis=0)
                    - level.vertices[cells[0]].mean(axis=0))
            outwards[i] = np.sign(away @ vectors[i].mean(axis=0))
        vectors = vectors * outwards[:, None, None]

        self.measure = add_up(n, faces, np.einsum(
            "q,qv,kq->kv", weights, values, np.linalg.norm(vectors, axis=-1))[..., None]
        )[:, 0]
        for node, masters in hanging.items():
            for master, weight in masters.items():
                self.measure[master] += weight * self.measure[node]
            self.measure[node] = 0
        self.normal = add_up(n, faces, np.einsum(
            "q,qv,kqd->kvd", weights, values, vectors))
        norm = np.linalg.norm(self.normal, axis=1)
        self.normal /= np.where(norm > 0, norm, 1)[:, None]
        self.nodes = np.unique(faces)

        # By which angle the boundary turns around a node: between the normals of any
        # two faces that have a node in common with one of its faces.
        middle = vectors.mean(axis=1)
        middle /= np.maximum(np.linalg.norm(middle, axis=1), 1e-300)[:, None]
        at_node = {}
        for i, face in enumerate(faces):
            for node in face:
                at_node.setdefault(node, []).append(i)
        self.turn = {}
        for node, own in at_node.items():
            near = sorted({j for i in own for corner in faces[i]
                           for j in at_node[corner]})
            cosines = middle[own] @ middle[near].T
            self.turn[node] = np.degrees(np.arccos(np.clip(cosines.min(), -1, 1)))


# --------------------------------------------------------------------------------------
# What is claimed, and whether it is true.


class Verdict:
    """The largest violation per column, and sentences about those above their limit."""

    def __init__(self, columns):
        self.largest = dict.fromkeys(columns, 0.)
        self.complaints = []
        self.certificate = 0.

    def check(self, column, violations, limit, sentence, places=None):
        """violations: relative ones, nonnegative, one or many; NaN counts as too large.
        places: where they are, as points."""
        violations = np.atleast_1d(np.asarray(violations, float))
        if violations.size == 0:
            return
        violations = np.where(np.isfinite(violations), violations, np.inf)
        worst = int(np.argmax(violations))
        value = violations.flat[worst]
        if column in self.largest:
            self.largest[column] = max(self.largest[column], value)
        if value > limit:
            where = ""
            if places is not None:
                place = places[worst // (violations.size // len(places))]
                where = " at (" + ", ".join(f"{x:.6g}" for x in place) + ")"
            self.complaints.append(
                f"{sentence}{where}: {value:.1e}, and may be {limit:.0e}")

    def demand(self, is_true, sentence, column="given"):
        if not is_true:
            self.largest[column] = np.inf
            self.complaints.append(sentence)


COLUMNS = ("equilibrium", "penetration", "tension", "cone", "slip", "states", "given",
           "energy")


def relative(a, b):
    """The largest difference of two arrays, relative to their largest number."""
    a, b = np.asarray(a, float), np.asarray(b, float)
    if a.shape != b.shape:
        return np.inf
    size = max(np.abs(a).max(initial=0), np.abs(b).max(initial=0))
    return np.abs(a - b).max(initial=0) / size if size > 0 else 0.


def verify_level(level, reported, scene, tolerance):
    """level: a Level; reported: the numbers of that level in history.h5 by name, the
    contact nodes among them; scene: a SceneText. Returns a Verdict, and a list of what
    could not be compared with the scene."""
    verdict = Verdict(COLUMNS)
    u, dim, n = level.displacement, level.dim, level.n_nodes
    exact = min(tolerance, ROUNDING)
    largest_u = np.abs(u).max() or 1.

    # Hanging nodes and prescribed displacements.
    hanging = find_hanging_nodes(level)
    written = {}
    for (node, master), weight in zip(level.hanging_nodes.tolist(),
                                      level.hanging_weights):
        masters = written.setdefault(node, {})
        masters[master] = masters.get(master, 0.) + weight
    same = written.keys() == hanging.keys() and all(
        written[node].keys() == hanging[node].keys()
        and all(abs(written[node][m] - w) < ROUNDING for m, w in hanging[node].items())
        for node in hanging)
    verdict.demand(same, "hanging nodes are not those of the mesh, or their masters")
    is_hanging = np.zeros(n, bool)
    is_hanging[list(hanging)] = True
    interpolated = np.array([
        np.abs(sum(w * u[m] for m, w in masters.items()) - u[node]).max()
        for node, masters in hanging.items()])
    verdict.check("given", interpolated / largest_u, exact,
                  "a hanging node is not where its masters have it",
                  level.vertices[list(hanging)])
    held = level.is_prescribed.any(axis=1)
    verdict.demand(not np.any(held & is_hanging),
                   "the displacement of a hanging node is prescribed")
    verdict.check("given",
                  np.where(level.is_prescribed, np.abs(u - level.values), 0)[held]
                  / largest_u, exact,
                  "a displacement is not the prescribed one", level.vertices[held])

    # The residual r = f - A u, condensed: what a hanging node gets is its masters'. The
    # force that the obstacle, or what holds the body, exerts on it is R = A u - f = -r.
    internal, strain_energy, diagonal = body_integrals(level)
    loads = nodal_loads(level, level.body_force, level.traction_faces, level.tractions)
    work = np.sum(loads * u)
    r = loads - internal
    for node, masters in hanging.items():
        for master, weight in masters.items():
            r[master] += weight * r[node]
        r[node] = 0

    # Scales.
    contact = Contact(level, hanging)
    verdict.demand(contact.problem is None, contact.problem)
    nodes, normals = level.contact_nodes, level.contact_normals
    x, u_c, r_c = level.vertices[nodes], u[nodes], r[nodes]
    gap = level.obstacle.gap(x, normals)
    u_n = np.sum(u_c * normals, axis=1)
    room = gap - u_n
    rounding = 1e-8 * np.max(diagonal * np.linalg.norm(u, axis=1) * ~is_hanging)
    force_scale = max(np.abs(r).max(), rounding) or 1.
    length_scale = np.abs(u_c).max(initial=0) or largest_u
    # That of the certificate. Where a boundary is round the largest gap is that of a
    # node far off, and a scale which is no measure of what happens in contact.
    wide_scale = max(np.abs(u_c).max(initial=0), np.abs(room).max(initial=0)) or 1.

    # Nodes in contact are on the contact boundary, and their normals are right.
    is_contact = np.zeros(n, bool)
    is_contact[nodes] = True
    possible = np.zeros(n, bool)
    possible[contact.nodes] = True
    possible &= ~is_hanging & ~level.is_prescribed.all(axis=1)
    verdict.demand(not np.any(is_contact & ~possible) and len(set(nodes)) == len(nodes),
                   "a contact node is none of the contact boundary")
    verdict.demand(np.all(np.isfinite(gap)), "a contact node cannot meet the obstacle")
    verdict.check("given", np.abs(np.linalg.norm(normals, axis=1) - 1), exact,
                  "a normal is no unit vector", x)
    if level.contact_normal == "obstacle":
        _, towards = level.obstacle.nearest(x)
        verdict.check("given", np.abs(normals - towards).max(axis=1, initial=0), exact,
                      "a normal does not point straight to the obstacle", x)
    else:
        cosine = np.clip(np.sum(normals * contact.normal[nodes], axis=1), -1, 1)
        turns = np.array([contact.turn.get(node, 0) for node in nodes])
        beyond = np.degrees(np.arccos(cosine)) - turns - 1
        verdict.demand(np.all(beyond <= 0),
                       "a normal points away from those of the faces around its node")
    along_normal = np.abs(normals)[level.is_prescribed[nodes]]
    verdict.check("given", along_normal, exact,
                  "the normal displacement of a contact node is prescribed")

    # Equilibrium where nothing holds and nothing touches.
    free = ~level.is_prescribed & ~is_hanging[:, None] & ~is_contact[:, None]
    unbalanced = np.abs(np.where(free, r, 0)) / force_scale
    verdict.check("equilibrium", unbalanced, tolerance,
                  "there is a force where nothing holds the body", level.vertices)

    # Contact: u_n <= g, no tension, no force at a distance. Nodes that are left out,
    # since they cannot meet the obstacle, must not be inside of it.
    pressing = np.sum(r_c * normals, axis=1)
    pull = np.maximum(-pressing, 0) / force_scale

    def at_distance(scale):
        return np.maximum(np.minimum(pressing / force_scale, room / scale), 0)

    verdict.check("penetration", np.maximum(-room, 0) / length_scale, tolerance,
                  "a node is inside of the obstacle", x)
    others = possible & ~is_contact
    verdict.check("penetration",
                  level.obstacle.depth(level.vertices[others] + u[others])
                  / length_scale, tolerance,
                  "a node that is left out is inside of the obstacle",
                  level.vertices[others])
    verdict.check("tension", pull, tolerance, "the obstacle pulls", x)
    verdict.check("tension", at_distance(length_scale), tolerance,
                  "the obstacle pushes from a distance", x)

    # Friction. Where a tangential displacement is prescribed its force is a reaction.
    u_T = u_c - u_n[:, None] * normals
    r_T = np.where(level.is_prescribed[nodes], 0, r_c - pressing[:, None] * normals)
    can_slide = (~level.is_prescribed[nodes]).sum(axis=1) > 1
    slip, drag = np.linalg.norm(u_T, axis=1), np.linalg.norm(r_T, axis=1)
    bound = np.zeros(len(nodes))
    if level.friction_law == "Coulomb":
        bound = level.friction_coefficient * np.maximum(pressing, 0)
    elif level.friction_law == "Tresca":
        bound = level.friction_bounds * contact.measure[nodes]
    beyond_cone = np.maximum(drag - bound, 0) / force_scale
    verdict.check("cone", beyond_cone, tolerance, "friction is beyond its bound", x)
    direction = u_T / np.where(slip > 0, slip, 1)[:, None]
    direction = np.where(level.is_prescribed[nodes], 0, direction)
    deviation = np.where((slip > 0) & can_slide,
                         np.linalg.norm(r_T - bound[:, None] * direction, axis=1), 0)

    def wrong_slip(scale):
        return np.minimum(deviation / force_scale, slip / scale)

    verdict.check("slip", wrong_slip(length_scale), tolerance,
                  "friction does not oppose the slip as it should", x)

    # The certificate, by its own definition.
    verdict.certificate = max(np.max(part, initial=0) for part in (
        unbalanced, -room / wide_scale, pull, at_distance(wide_scale), beyond_cone,
        wrong_slip(wide_scale)))
    verdict.check(None, max(verdict.certificate - reported["certificate"], 0),
                  .1 * tolerance,
                  f"the certificate is reported to be {reported['certificate']:.1e} and "
                  f"is {verdict.certificate:.1e}, which is more by")

    # What the nodes are said to do.
    state = level.contact_states
    opens, slides, sticks = (state == s for s in (0, 1, 2))
    verdict.demand(np.all(opens | slides | sticks), "a contact node has no known state",
                   "states")
    verdict.check("states", np.where(opens, np.abs(pressing), 0) / force_scale,
                  tolerance, "there is a force at a node that is said to be open", x)
    verdict.check("states", np.where(opens, 0, np.abs(room)) / length_scale, tolerance,
                  "a node that is said to touch does not", x)
    verdict.check("states", np.where(sticks, slip, 0) / length_scale, tolerance,
                  "a node that is said to stick has moved", x)
    if level.friction_law != "none":
        # The share of the bound that a prescribed component leaves to the others.
        share = np.where(slip > tolerance * length_scale,
                         np.linalg.norm(direction, axis=1), can_slide)
        missing = np.where(slides & can_slide, bound * share - drag, 0)
        verdict.check("states", np.maximum(missing, 0) / force_scale, tolerance,
                      "a node that is said to slide bears less friction than it can", x)

    # The reported numbers. A force on the body is -r, without what prescribed
    # displacements take.
    touches = ~opens
    tangential = np.linalg.norm(r_T.sum(axis=0))
    total = pressing[touches].sum()
    measure = contact.measure[nodes]
    width = ((lambda m: m / 2) if dim == 2 else (lambda m: np.sqrt(m / np.pi)))
    energy = strain_energy - work + np.sum(bound * slip)
    parts = strain_energy + abs(work) + np.sum(bound * slip) or 1.
    verdict.check("energy", abs(energy - reported["energy"]) / parts, tolerance,
                  "the reported energy is wrong")
    for name, number in (("cells", len(level.cells)), ("dofs", dim * n),
                         ("contact_nodes", touches.sum()),
                         ("sticky_nodes", sticks.sum())):
        verdict.demand(reported[name] == number, f"{name} is reported to be "
                       f"{reported[name]:.0f} and is {number}", "states")
    for name, number, size in (
            ("normal_force", total, total), ("tangential_force", tangential,
                                             np.sum(drag) + abs(total)),
            ("max_pressure", np.max((pressing / measure)[touches], initial=0), 0),
            ("contact_half_width", width(measure[touches].sum()), 0),
            ("stick_half_width", width(measure[sticks].sum()), 0)):
        size = max(abs(size), abs(number), abs(reported[name])) or 1.
        verdict.check(None, abs(number - reported[name]) / size, tolerance,
                      f"{name} is reported to be {reported[name]:.6g} and is "
                      f"{number:.6g}")
    if "contact" in reported:
        check_contact_records(verdict, level, reported["contact"], tolerance, {
            "point": x, "normal": normals, "displacement": u_c, "gap": gap,
            "measure": measure, "state": state,
            "force": -pressing[:, None] * normals - r_T})
    else:
        verdict.demand(len(nodes) == 0, "history.h5 has no contact nodes")

    return verdict, compare_with_scene(verdict, level, scene, hanging, exact)


def check_contact_records(verdict, level, records, tolerance, found):
    """The contact nodes in history.h5, which have an order of their own."""
    order = np.lexsort(level.vertices[level.contact_nodes].T[::-1])
    theirs = np.lexsort(records["point"].T[::-1])
    for name, values in found.items():
        limit = tolerance if name == "force" else min(tolerance, ROUNDING)
        if len(order) != len(theirs):
            verdict.demand(False, "history.h5 has another number of contact nodes")
            return
        verdict.check("given", relative(values[order], records[name][theirs]), limit,
                      f"'{name}' of contact nodes in history.h5 is wrong")


def compare_with_scene(verdict, level, scene, hanging, limit):
    """Whether the run has solved what its scene says. Returns entries that are beyond
    this program."""
    dim, X, unknown = level.dim, level.vertices, []

    def attempt(entry, compare):
        try:
            compare()
        except NotUnderstood as error:
            unknown.append(f"'{entry}' ({error})")

    def same(entry, mine, theirs):
        verdict.check("given", relative(mine, theirs), limit,
                      f"'{entry}' is not what the scene says")

    def material():
        same("Material", [scene.names["E"], scene.names["nu"]],
             [level.youngs_modulus, level.poisson_ratio])
        verdict.demand(scene["Material/Volumetric strain"] == level.volumetric_strain,
                       "'Material/Volumetric strain' is not what the scene says")

    def friction():
        law, F = scene["Contact/Friction law"], scene.names["F"]
        if law == "Coulomb" and F == 0:
            law = "none"
        verdict.demand(law == level.friction_law
                       and scene["Contact/Contact normal"] == level.contact_normal
                       and int(scene["Contact/Boundary id"]) == level.contact_boundary,
                       "section 'Contact' is not what the scene says")
        same("Contact/Friction coefficient", F if law == "Coulomb" else 0.,
             level.friction_coefficient)
        if law == "Tresca" and len(level.contact_nodes):
            bounds = scene.evaluate(scene["Contact/Friction bound"],
                                    X[level.contact_nodes] @ scene.rotation)
            same("Contact/Friction bound",
                 np.broadcast_to(bounds, len(level.contact_nodes)),
                 level.friction_bounds)

    def displacement():
        is_set, values = np.zeros((len(X), dim), bool), np.zeros((len(X), dim))

        def prescribe(nodes, components):
            texts = ["0" if c == "free" else c for c in components]
            wanted = np.array([c != "free" for c in components])
            new = np.zeros(is_set.shape, bool)
            new[nodes] = wanted
            new &= ~is_set
            values[new] = scene.vector_field(texts, X)[new]
            is_set[new] = True

        for key, components in scene.conditions("Boundary conditions/Displacement"):
            prescribe(np.unique(level.boundary_faces[level.boundary_ids == int(key)]),
                      components)
        size = np.linalg.norm(X[level.cells[:, 0]] - X[level.cells[:, -1]], axis=1)
        for key, components in scene.conditions("Boundary conditions/Pinned points"):
            point = scene.rotation @ scene.numbers(key.strip()[1:-1])
            nearest = np.argmin(np.linalg.norm(X - point, axis=1))
            if np.linalg.norm(X[nearest] - point) < 1e-8 * size.max():
                prescribe([nearest], components)
        hanging_nodes = list(hanging)
        is_set[hanging_nodes], values[hanging_nodes] = False, 0
        verdict.demand(np.array_equal(is_set, level.is_prescribed),
                       "other displacements are prescribed than the scene says")
        same("Boundary conditions/Displacement", values, level.values)

    def loads():
        body, faces, tractions = None, [], []
        components = split(scene["Boundary conditions/Body force"], ",")
        if components:
            values, _ = corner_functions(gauss_points(2, dim)[0])
            points = np.einsum("qv,kvd->kqd", values, X[level.cells]).reshape(-1, dim)
            body = scene.vector_field(components, points)
        values, _ = corner_functions(gauss_points(4, dim - 1)[0])
        for key, components in scene.conditions("Boundary conditions/Traction"):
            part = level.boundary_faces[level.boundary_ids == int(key)]
            points = np.einsum("qv,kvd->kqd", values, X[part]).reshape(-1, dim)
            faces.append(part)
            tractions.append(scene.vector_field(components, points))
        empty = np.zeros((0, 2**(dim - 1)), int), np.zeros((0, dim))
        same("Boundary conditions/Body force' or 'Traction",
             nodal_loads(level, body, np.vstack([empty[0], *faces]),
                         np.vstack([empty[1], *tractions])),
             nodal_loads(level, level.body_force, level.traction_faces,
                         level.tractions))

    attempt("Material", material)
    attempt("Contact/Friction bound", friction)
    attempt("Boundary conditions/Displacement", displacement)
    attempt("Boundary conditions/Body force' or 'Traction", loads)
    attempt("Obstacle", lambda: same("Obstacle", scene.obstacle().numbers(),
                                     level.obstacle.numbers()))
    return unknown


# --------------------------------------------------------------------------------------
# A directory.


def read_history(directory):
    """The parameters, and for each level a dictionary of its numbers."""
    path = directory / "history.h5"
    if not path.is_file():
        raise NotReadable(f"there is no '{path}'; name the output directory of a run.")
    try:
        with h5py.File(path) as file:
            text = file.attrs["parameters"]
            columns = {name: item[()] for name, item in file["levels"].items()}
            levels = [{name: column[i] for name, column in columns.items()}
                      for i in range(len(columns["level"]))]
            for row in levels:
                group = file.get(f"contact/level_{row['level']:02d}")
                if group is not None:
                    row["contact"] = {name: item[()] for name, item in group.items()}
    except (OSError, KeyError) as error:
        raise NotReadable(f"'{path}' cannot be read: it is damaged, or of another "
                          "version.") from error
    return text if isinstance(text, str) else text.decode(), levels


def tolerance_of(scene, row):
    """Of the certificate of a level, from the scene."""
    tolerance = scene.number("Solver/Certificate tolerance")
    if scene["Solver/Inner tolerance"] == "discretisation" and row["level"] > 0:
        tolerance = max(tolerance, 1e-2)
    return tolerance


def verify(directory, tolerance=None):
    """Prints the table; returns the exit status."""
    text, levels = read_history(directory)
    print(f"{'level':>5} {'dofs':>9} " + " ".join(f"{c:>11}" for c in COLUMNS)
          + "  verdict")
    refuted, missing, remarks, complaints, n = [], [], [], [], 0
    for row in levels:
        path = directory / f"verify-{row['level']:02d}.h5"
        if not path.is_file():
            missing.append(str(row["level"]))
            continue
        level = Level(path)
        try:
            scene = SceneText(text, level.dim)
        except (NotUnderstood, ValueError) as error:
            raise NotReadable(f"the parameters in history.h5 are not understood: "
                              f"{error}.") from error
        if level.level != row["level"]:
            raise NotReadable(f"'{path}' is that of another level.")
        limit = tolerance or tolerance_of(scene, row)
        verdict, unknown = verify_level(level, row, scene, limit)
        n += 1
        remarks += [entry for entry in unknown if entry not in remarks]
        complaints += [f"Level {row['level']}: {c}." for c in verdict.complaints]
        if verdict.complaints:
            refuted.append(str(row["level"]))
        print(f"{row['level']:5d} {dofs_of(level):9d} "
              + " ".join(f"{verdict.largest[c]:11.1e}" for c in COLUMNS)
              + ("  refuted" if verdict.complaints else "  confirmed"), flush=True)
    if n == 0:
        raise NotReadable(f"there is no verify-NN.h5 in '{directory}': run the scene "
                          "with 'Output/Verification=true'.")
    for complaint in complaints:
        print(complaint)
    for entry in remarks:
        print(f"Taken as the run had it, since this program does not understand what "
              f"the scene says: {entry}.")
    if missing:
        print(f"Not looked at, without a file verify-NN.h5: level {', '.join(missing)}.")
    if refuted:
        print(f"The certificate is refuted on {len(refuted)} of {n} levels: "
              f"{', '.join(refuted)}.")
    else:
        print(f"The certificate is confirmed on {'all ' * (n > 1)}{n} "
              f"level{'s' * (n > 1)}.")
    return 1 if refuted else 0


def dofs_of(level):
    return level.dim * level.n_nodes


def main():
    parser = argparse.ArgumentParser(
        prog="friction-verify", description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter, usage=argparse.SUPPRESS)
    parser.add_argument("directory", type=Path, help="output directory of a run")
    parser.add_argument("--tolerance", type=float, metavar="X",
                        help="largest violation, in place of the scene's")
    options = parser.parse_args()
    try:
        return verify(options.directory, options.tolerance)
    except NotReadable as error:
        print(f"friction-verify: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
