"""The runs of the Hertz scene, and the closed forms and published numbers that
they are compared with."""

import numpy as np

import plot_folder  # noqa: F401
from history import Run

YOUNG, POISSON, RADIUS = 1.0, 0.325, 1.0

# Stick ratio c/a, a/a_H and p(0)/p_H of the half-plane with coupled normal and
# tangential tractions, by coefficient of friction. These are the values that
# the test tests/reference/half_plane_contact computes (HertzFactors).
HALF_PLANE = {0.0: (0.0, 1.0, 1.0),
              0.05: (0.000320, 0.99590, 1.07036),
              0.4: (0.473454, 0.97243, 1.06118),
              1.0: (0.778295, 0.95616, 1.05657)}

# Table 6.1 of the thesis: level, dof, contact, sticky, outer iterations, cycles
# of Algorithms 2 and 3, rho_tau. The dofs of level 8 are printed "1 6646".
THESIS = [(0, 94, None, None, 1, None, None, None),
          (1, 330, 1, 1, 1, 12, 12, None),
          (2, 1234, 3, 1, 3, 32, 14, 1.9e-4),
          (3, 1602, 5, 3, 4, 32, 9, 2.3e-3),
          (4, 2200, 7, 3, 5, 39, 9, 1.9e-2),
          (5, 3274, 15, 7, 6, 45, 11, 4.4e-2),
          (6, 5330, 29, 13, 7, 46, 10, 6.0e-2),
          (7, 9114, 57, 27, 7, 45, 13, 6.1e-2),
          (8, 16646, 113, 53, 7, 45, 11, 6.1e-2),
          (9, 31596, 225, 107, 7, 45, 17, 6.0e-2),
          (10, 64870, 449, 213, 7, 45, 13, 6.0e-2)]


def width(force):
    """Hertz's half-width for a normal force per thickness."""
    return np.sqrt(4 * force * RADIUS * (1 - POISSON**2) / (np.pi * YOUNG))


def peak(force):
    """Hertz's largest pressure."""
    return 2 * force / (np.pi * width(force))


class HertzRun(Run):
    """The history of a run of the scene, in Hertz's terms."""

    def stresses(self, level=None):
        """Positions along the contact boundary from left to right, pressure,
        tangential stress along increasing x, and states of its nodes."""
        nodes = self.contact[self.last if level is None else level]
        order = np.argsort(nodes["point"][:, 0])
        order = order[nodes["point"][order, 1] < -0.5 * RADIUS]
        normal = nodes["normal"][order]
        traction = nodes["force"][order] / nodes["measure"][order, None]
        tangent = np.stack([-normal[:, 1], normal[:, 0]], axis=1)
        pressure = -np.sum(traction * normal, axis=1)
        shear = np.sum(traction * tangent, axis=1)
        return (nodes["point"][order, 0], pressure, shear, nodes["state"][order])

    def factors(self):
        """c/a, a/a_H and p(0)/p_H on the last level."""
        levels = {name: values[-1] for name, values in self.levels.items()}
        force, a = levels["normal_force"], levels["contact_half_width"]
        return (levels["stick_half_width"] / a, a / width(force),
                levels["max_pressure"] / peak(force))
