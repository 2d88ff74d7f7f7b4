"""Nodal forces of a body: what its stresses and its loads do."""

import numpy as np

from run_data import NotReadable
from unit_cell import corner_functions, gauss_points


def add_up(n_nodes, nodes, values):
    """Sums of values (k x corners x dim) at the nodes (k x corners) they belong to."""
    return np.stack([np.bincount(nodes.ravel(), values[..., d].ravel(), n_nodes)
                     for d in range(values.shape[-1])], axis=-1).astype(float)


def at_gauss_points(level, cells):
    """For each point of the Gauss rule, of the cells with these numbers: gradients of
    the shape functions (k x corners x dim) and weights (k)."""
    points, weights = gauss_points(2, level.dim)
    _, on_unit_cell = corner_functions(points)
    X, result = level.vertices[level.cells[cells]], []
    for q, weight in enumerate(weights):
        # J_de = d x_d / d xi_e; shape functions have gradients G = (d xi / d x)^T.
        J = X.transpose(0, 2, 1) @ on_unit_cell[q]
        dx = np.linalg.det(J) * weight
        if not np.all(dx > 0):
            raise NotReadable("the mesh has cells that are turned inside out.")
        result.append((on_unit_cell[q] @ np.linalg.inv(J), dx))
    return result


def lame_constants(level, cells):
    """Of each of these cells, and whether its volumetric strain is the mean."""
    E, nu, averaged = level.materials[level.cell_regions[cells]].T
    return E * nu / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu)), averaged > 0


def mean_of(values, at_points):
    """Over each cell, of values (k x ...) at its points."""
    volume = sum(dx for _, dx in at_points)
    # By transposing, cells come last, and each has a factor.
    return sum(v.T * (dx / volume) for v, (_, dx) in zip(values, at_points)).T


def body_integrals(level):
    """Nodal internal forces A u (nodes x dim) with hanging nodes not yet condensed, the
    strain energy, the trace of the diagonal block of each node, likewise, and the
    volume of each cell.

    Linear elasticity, in two dimensions plane strain: sigma = lambda theta I + 2 mu eps
    with theta the divergence of the displacement, or its mean over the cell."""
    dim, cells = level.dim, np.arange(len(level.cells))
    lame, mu, averaged = lame_constants(level, cells)
    U = level.displacement[level.cells]
    at_points = at_gauss_points(level, cells)
    gradients = [U.transpose(0, 2, 1) @ G for G, _ in at_points]
    if averaged.any():
        expansion = mean_of([np.trace(g, axis1=1, axis2=2) for g in gradients],
                            at_points)
        mean_gradient = mean_of([G for G, _ in at_points], at_points)

    forces, diagonal, energy = 0, 0, 0.
    for (G, dx), gradient in zip(at_points, gradients):
        strain = (gradient + gradient.transpose(0, 2, 1)) / 2
        theta, H = np.trace(strain, axis1=1, axis2=2), G
        if averaged.any():
            theta = np.where(averaged, expansion, theta)
            H = np.where(averaged[:, None, None], mean_gradient, G)
        # A mean is the same at all points of the cell, so that of the divergence of a
        # test function its integral remains, as it should.
        stress = (2 * mu[:, None, None] * strain
                  + (lame * theta)[:, None, None] * np.eye(dim))
        forces = forces + G @ (stress.transpose(0, 2, 1) * dx[:, None, None])
        energy += np.sum(dx * (mu * np.sum(strain**2, axis=(1, 2))
                               + lame / 2 * theta**2))
        diagonal = diagonal + dx[:, None] * (
            lame[:, None] * np.sum(H**2, axis=2)
            + mu[:, None] * (1 + dim) * np.sum(G**2, axis=2))
    return (add_up(level.n_nodes, level.cells, forces), energy,
            add_up(level.n_nodes, level.cells, diagonal[..., None])[:, 0],
            sum(dx for _, dx in at_points))


class Rows:
    """Rows of the matrix at some nodes, hanging nodes condensed: a node moves those
    that hang on it. diagonal: blocks (k x dim x dim)."""

    def __init__(self, level, nodes, hanging):
        self.level, self.nodes, self.hanging = level, np.asarray(nodes, int), hanging
        self.is_hanging = np.zeros(level.n_nodes, bool)
        self.is_hanging[list(hanging)] = True
        place = {node: i for i, node in enumerate(self.nodes.tolist())}
        near = np.zeros(level.n_nodes, bool)
        near[self.nodes] = True
        for node, masters in hanging.items():
            near[node] = any(master in place for master in masters)
        pairs = {}
        for k in np.flatnonzero(near[level.cells].any(axis=1)).tolist():
            for corner, vertex in enumerate(level.cells[k].tolist()):
                for master, weight in hanging.get(vertex, {vertex: 1.}).items():
                    if master in place:
                        weights = pairs.setdefault((place[master], k),
                                                   np.zeros(2**level.dim))
                        weights[corner] += weight
        self.at, self.cells = np.array(list(pairs), int).reshape(-1, 2).T
        weights = np.array(list(pairs.values())).reshape(-1, 2**level.dim)

        # Blocks of the node and each corner of the cell.
        lame, mu, averaged = lame_constants(level, self.cells)
        at_points = at_gauss_points(level, self.cells)
        own = [(weights[:, None] @ G)[:, 0] for G, _ in at_points]
        h, H = mean_of(own, at_points), mean_of([G for G, _ in at_points], at_points)
        blocks = 0
        for (G, dx), g in zip(at_points, own):
            first = np.where(averaged[:, None], h, g)
            second = np.where(averaged[:, None, None], H, G)
            # Entries kvij, of cell k, corner v and directions i and j.
            first, second = first * (dx * lame)[:, None], second[:, :, None]
            g = g * (dx * mu)[:, None]
            blocks = (blocks + first[:, None, :, None] * second
                      + g[:, None, None] * G[..., None]
                      + (G @ g[..., None])[..., None] * np.eye(level.dim))
        self.blocks = blocks
        self.diagonal = np.zeros((len(self.nodes), level.dim, level.dim))
        np.add.at(self.diagonal, self.at, np.einsum("kv,kvij->kij", weights, blocks))

    def forces_of_neighbours(self, u):
        """For each node half the sum of |A_pq (u_q - u_p)| over its neighbours q."""
        dim, n = self.level.dim, self.level.n_nodes
        vertices = self.level.cells[self.cells]
        at, q = np.repeat(self.at, vertices.shape[1]), vertices.ravel()
        blocks = self.blocks.reshape(-1, dim, dim)
        if not len(q):
            return np.zeros(len(self.nodes))
        # A hanging node stands for its masters.
        stands_for = [(k, master, weight) for k in np.flatnonzero(self.is_hanging[q])
                      for master, weight in self.hanging[q[k]].items()]
        if stands_for:
            own = ~self.is_hanging[q]
            k, masters, weights = (np.array(values) for values in zip(*stands_for))
            at, q = np.append(at[own], at[k]), np.append(q[own], masters)
            blocks = np.concatenate([blocks[own], weights[:, None, None] * blocks[k]])
        # A_pq is what all cells together have for the two.
        pairs = at * n + q
        order = np.argsort(pairs, kind="stable")
        pairs, first = np.unique(pairs[order], return_index=True)
        at, q = np.divmod(pairs, n)
        forces = np.einsum("kij,kj->ki", np.add.reduceat(blocks[order], first),
                           u[q] - u[self.nodes[at]])
        return np.bincount(at, np.linalg.norm(forces, axis=1) / 2, len(self.nodes))


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
