"""Which nodes of a mesh hang."""

import numpy as np

from unit_cell import local_edges, local_faces


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
        """The one nearest to the middle, if it is near; boundaries are curved."""
        if not candidates:
            return None
        middle = vertices[corners].mean(axis=0)
        size = np.linalg.norm(vertices[corners[0]] - vertices[corners[-1]])
        candidates = [(np.linalg.norm(vertices[c] - middle), c) for c in candidates]
        distance, best = min(candidates)
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
