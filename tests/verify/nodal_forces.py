"""Nodal forces of a body: what its stresses and its loads do."""

import numpy as np

from run_data import NotReadable
from unit_cell import corner_functions, gauss_points


def add_up(n_nodes, nodes, values):
    """Sums of values (k x corners x dim) at the nodes (k x corners) they belong to."""
    return np.stack([np.bincount(nodes.ravel(), values[..., d].ravel(), n_nodes)
                     for d in range(values.shape[-1])], axis=-1)


def body_integrals(level):
    """Nodal internal forces A u (nodes x dim) with hanging nodes not yet condensed, the
    strain energy, and the trace of the diagonal block of each node.

    Linear elasticity, in two dimensions plane strain: sigma = lambda theta I + 2 mu eps
    with theta the divergence of the displacement, or its mean over the cell."""
    dim = level.dim
    E, nu, averaged = level.materials[level.cell_regions].T
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
    for G, gradient, dx in at_points:
        strain = (gradient + gradient.transpose(0, 2, 1)) / 2
        theta = np.trace(strain, axis1=1, axis2=2)
        H = G
        if averaged.any():
            theta = np.where(averaged > 0, expansion / volume, theta)
            H = np.where(averaged[:, None, None] > 0,
                         mean_gradient / volume[:, None, None], G)
        # A mean is the same at all points of the cell, so that of the divergence of a
        # test function its integral remains, as it should.
        stress = (2 * mu[:, None, None] * strain
                  + (lame * theta)[:, None, None] * np.eye(dim))
        forces = forces + np.einsum("k,kvj,kij->kvi", dx, G, stress)
        energy += np.sum(dx * (mu * np.sum(strain**2, axis=(1, 2))
                               + lame / 2 * theta**2))
        diagonal = diagonal + dx[:, None] * (
            lame[:, None] * np.sum(H**2, axis=2)
            + mu[:, None] * (1 + dim) * np.sum(G**2, axis=2))
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
