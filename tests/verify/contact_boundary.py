"""The boundary that may touch an obstacle."""

import numpy as np

from nodal_forces import add_up, area_vectors
from unit_cell import corner_functions, gauss_points, local_faces


class ContactBoundary:
    """Of its nodes, each at its number:

    measure  integral of the nodal function over the boundary, where hanging nodes leave
             their share to their masters: a length in 2D, an area in 3D
    normal   unit vector outwards, the mean of the faces around the node (nodes x dim)
    turn     a dictionary with the angle in degrees by which the boundary turns there

    nodes has the numbers themselves, section for each node of the mesh that of the
    scene that speaks of it (zero if none does), and problem a sentence or None."""

    def __init__(self, level, hanging):
        dim, n = level.dim, level.n_nodes
        faces = level.boundary_faces[np.isin(
            level.boundary_ids, [contact.contact_boundary for contact in level.contacts])]
        self.section = np.zeros(n, int)
        for contact in level.contacts:
            own = level.boundary_ids == contact.contact_boundary
            self.section[level.boundary_faces[own]] = contact.number
        points, weights = gauss_points(2, dim - 1)
        values, _ = corner_functions(points)
        vectors = area_vectors(level.vertices[faces], points) if len(faces) else (
            np.zeros((0, len(points), dim)))

        # Outwards is away from the cell that the face belongs to.
        table = {}
        for cell in level.cells[np.isin(level.cells, faces).any(axis=1)]:
            for corners in local_faces(dim):
                table.setdefault(tuple(sorted(cell[corners])), []).append(cell)
        self.problem = None
        outwards = np.ones(len(faces))
        middles, middle_vectors = level.vertices[faces].mean(axis=1), vectors.mean(axis=1)
        for i, face in enumerate(faces):
            cells = table.get(tuple(sorted(face)), [])
            if len(cells) != 1:
                self.problem = "a face of the contact boundary is inside of the body"
                continue
            away = middles[i] - level.vertices[cells[0]].mean(axis=0)
            outwards[i] = np.sign(away @ middle_vectors[i])
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
