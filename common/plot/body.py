"""The body: all cells of it in the plane, its surface in space."""

import numpy as np
from matplotlib.collections import LineCollection, PolyCollection

import vtu
from drawing import STRESS

# More edges than that are a black spot.
MOST_EDGES = 400000


def displaced(mesh, factor):
    return mesh.points + factor * mesh.of_points["displacement"]


def cells_inside(points, cells, window):
    """Those that a window (rows: lower, upper) has a part of."""
    corners = points[cells][:, :, :2]
    return cells[((corners.max(axis=1) >= window[0])
                  & (corners.min(axis=1) <= window[1])).all(axis=1)]


def draw_plane(axes, points, cells, values, norm):
    """Colours by values in the points, and the mesh."""
    triangles = np.concatenate([cells[:, [0, 1, 2]], cells[:, [0, 2, 3]]])
    picture = axes.tripcolor(points[:, 0], points[:, 1], triangles, values,
                             shading="gouraud", norm=norm, cmap=STRESS,
                             rasterized=True)
    draw_edges(axes, points[:, :2], cells)
    axes.set_aspect("equal")
    return picture


def draw_edges(axes, points, cells):
    edges = np.concatenate([cells[:, [i, (i + 1) % 4]] for i in range(4)])
    edges = np.unique(np.sort(edges, axis=1), axis=0)
    if len(edges) > MOST_EDGES:
        return
    width = np.clip(40 / np.sqrt(len(edges) + 1), 0.06, 0.5)
    alpha = 0.35 * np.clip(np.sqrt(2e4 / (len(edges) + 1)), 0.3, 1)
    axes.add_collection(LineCollection(points[edges], colors="k", alpha=alpha,
                                       linewidths=width, rasterized=True),
                        autolim=False)


def surface(cells):
    """The faces of hexahedra that bound the body, corners in cyclic order, and the
    cell of each. A face that meets four smaller ones is inside, and so are these."""
    faces = cells[:, vtu.FACES].reshape(-1, 4)
    owner = np.repeat(np.arange(len(cells)), 6)
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True,
                                return_counts=True)
    once = np.sort(first[count == 1])
    faces, owner = faces[once], owner[once]

    # Each corner of a small face, with the corner across, which is in the middle of
    # the large face.
    n = int(faces.max()) + 1 if len(faces) else 1
    pairs = (faces.astype(np.int64) * n + np.roll(faces, 2, axis=1)).ravel()
    face_of_pair = np.repeat(np.arange(len(faces)), 4)
    order = np.argsort(pairs, kind="stable")
    pairs, face_of_pair = pairs[order], face_of_pair[order]
    known = np.unique(pairs)
    # All candidates for the middle of each face: what is across its first corner.
    begin = np.searchsorted(known, faces[:, 0].astype(np.int64) * n)
    end = np.searchsorted(known, (faces[:, 0].astype(np.int64) + 1) * n)
    face = np.repeat(np.arange(len(faces)), end - begin)
    offsets = np.arange(len(face)) - np.repeat(np.cumsum(end - begin) - (end - begin),
                                               end - begin)
    middle = known[begin[face] + offsets] % n
    is_large = np.ones(len(face), bool)
    for corner in range(1, 4):
        code = faces[face, corner].astype(np.int64) * n + middle
        at = np.minimum(np.searchsorted(known, code), len(known) - 1)
        is_large &= known[at] == code
    # Not its own corner.
    is_large &= (faces[face] != middle[:, None]).all(axis=1)

    keep = np.ones(len(faces), bool)
    keep[face[is_large]] = False
    for corner in range(4):
        code = faces[face[is_large], corner].astype(np.int64) * n + middle[is_large]
        low = np.searchsorted(pairs, code, "left")
        high = np.searchsorted(pairs, code, "right")
        for a, b in zip(low, high):
            keep[face_of_pair[a:b]] = False
    return faces[keep], owner[keep]


class View:
    """A parallel projection. `towards` is the direction of sight, `up` what is up in
    the picture."""

    def __init__(self, towards, up):
        self.depth = np.array(towards) / np.linalg.norm(towards)
        self.right = np.cross(self.depth, up)
        self.right /= np.linalg.norm(self.right)
        self.up = np.cross(self.right, self.depth)

    def __call__(self, points):
        return np.stack([points @ self.right, points @ self.up], axis=-1)

    @staticmethod
    def onto(normal):
        """Obliquely onto a boundary with this normal, which is below in the picture."""
        normal = np.asarray(normal, float) / np.linalg.norm(normal)
        axis = int(np.argmax(np.abs(normal)))
        if abs(normal[axis]) > 0.85:
            normal = np.sign(normal[axis]) * np.eye(3)[axis]
        others = [e for e in np.eye(3) if abs(e @ normal) < 0.85][:2]
        across = [e - (e @ normal) * normal for e in others]
        return View(-0.5 * normal - 0.55 * across[0] + 0.9 * across[1], -normal)


def draw_space(panels, mesh, values, view, norm, factor=1.):
    """The surface as it is seen, in each of the axes, each face with the mean of the
    values at its corners."""
    points = displaced(mesh, factor)
    faces, owner = surface(mesh.cells)
    corners = points[faces]
    normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    outwards = corners.mean(axis=1) - points[mesh.cells[owner]].mean(axis=1)
    normals *= np.sign(np.sum(normals * outwards, axis=1))[:, None]
    seen = normals @ view.depth < 0
    faces, corners = faces[seen], corners[seen]
    # The farthest first.
    order = np.argsort(-(corners.mean(axis=1) @ view.depth))
    colours = STRESS(norm(values[faces[order]].mean(axis=1)))
    width = np.clip(25 / np.sqrt(len(order) + 1), 0.05, 0.4)
    edges = (0, 0, 0, 0.4)
    if 4 * len(order) > MOST_EDGES:
        edges, width = "face", 0.1
    # Where the mesh gets finer on a curved surface there are chinks: what is behind
    # them has the colour of the faces around.
    for axes in panels:
        for line, thickness in ((colours, 2.), (edges, width)):
            axes.add_collection(PolyCollection(
                view(corners[order]), facecolors=colours, edgecolors=line,
                linewidths=thickness, rasterized=True))
        axes.set_aspect("equal")
        axes.autoscale_view()
        axes.margins(0.01)
        axes.axis("off")
