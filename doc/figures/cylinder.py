"""The runs of the cylinder scene in the terms of its contact boundary, and the
published numbers that they are compared with."""

import numpy as np

import plot_folder  # noqa: F401
import vtu
from history import Run

# Table 6.2 of the thesis: level, dof, contact, sticky, outer iterations, cycles
# of Algorithms 2 and 3, rho_tau.
THESIS = [(0, 27, None, None, None, None, None, None),
          (1, 567, 6, 2, 5, 72, 23, 4.1e-2),
          (2, 3723, 14, 4, 4, 63, 17, 2.2e-2),
          (3, 10194, 46, 18, 5, 75, 18, 2.2e-2),
          (4, 37935, 180, 56, 5, 87, 21, 4.3e-2),
          (5, 92961, 684, 188, 6, 146, 32, 5.9e-2),
          (6, 226500, 2728, 747, 6, 274, 70, 7.2e-2)]


def angle(points):
    """Degrees around the axis of the cylinder, from its lowest line."""
    return np.degrees(np.arctan2(points[:, 0], -points[:, 1]))


class CylinderRun(Run):
    """The history of a run of the scene."""

    def nodes(self, level=None):
        """The contact nodes above the rod at x>0: angle, z, pressure, and the
        tangential stress in the frame (around, along) the cylinder, and the
        state."""
        contact = self.contact[self.last if level is None else level]
        here = contact["point"][:, 0] > 0.01
        point, normal = contact["point"][here], contact["normal"][here]
        traction = contact["force"][here] / contact["measure"][here, None]
        around = np.stack([-normal[:, 1], normal[:, 0], 0 * normal[:, 0]], axis=1)
        return {"angle": angle(point), "z": point[:, 2],
                "pressure": -np.sum(traction * normal, axis=1),
                "around": np.sum(traction * around, axis=1),
                "along": traction[:, 2], "state": contact["state"][here]}

    def halfway(self):
        """The contact nodes above the rod at x>0 at z=1, by angle."""
        nodes = self.nodes()
        row = np.flatnonzero(np.abs(nodes["z"] - 1) < 1e-6)
        row = row[np.argsort(nodes["angle"][row])]
        return {name: values[row] for name, values in nodes.items()}

    def gave_up(self, most):
        """Whether the last level has used up all cycles that it was given."""
        return self.levels["cycles"][-1] >= most


def largest_angles(data):
    """The largest angle, in degrees, in the faces of each cell, and the middles
    of the cells."""
    corners = data["points"][data["cells"]].astype(float)
    faces = corners[:, vtu.FACES]
    after = np.roll(faces, -1, axis=2) - faces
    before = np.roll(faces, 1, axis=2) - faces
    cosine = (np.sum(after * before, axis=-1) / np.linalg.norm(after, axis=-1)
              / np.linalg.norm(before, axis=-1))
    return (np.degrees(np.arccos(cosine)).max(axis=(1, 2)),
            corners.mean(axis=1))


def cells_along_degenerate_lines(data):
    """How many cells the coarsest and the finest part of the lines where two sides of
    the hexahedron meet at the mantle would have along the whole cylinder: on the two
    lower lines, and on the two upper ones."""
    corners = data["points"][data["cells"]].astype(float)
    on_line = np.all(np.abs(np.abs(corners[:, :, :2]) - np.sqrt(.5)) < 1e-5, axis=2)
    along = np.ptp(corners[:, :, 2], axis=1)
    number = np.round(np.ptp(data["points"][:, 2]) / along).astype(int)
    above = corners[:, :, 1].mean(axis=1) > 0
    return [(number[cells].min(), number[cells].max())
            for cells in (on_line.sum(axis=1) >= 2) & np.array([~above, above])]
