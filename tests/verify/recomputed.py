"""Forces and gaps of a displacement."""

import numpy as np

from contact_boundary import ContactBoundary
from hanging_nodes import find_hanging_nodes
from nodal_forces import Rows, body_integrals, nodal_loads


class Recomputed:
    """What follows from the mesh, the displacement u and the loads f of a level.

    With the stiffness A of bilinear or trilinear elements the residual is r = f - A u.
    It is condensed: what a hanging node gets, its masters get. The force that holds the
    body at a node, that of the obstacle for example, is R = A u - f = -r. So r . n is
    what presses at a contact node, n being the normal towards the obstacle, and r_T is
    what friction has to bear against.

    Of all nodes: u, r (nodes x dim), is_hanging, hanging (see find_hanging_nodes()).
    Of contact nodes, in the order of contact_nodes:

    x, u_c       points and displacements (k x dim)
    gap, room    distance of the obstacle along the normal, before and after
    pressing     normal force, positive where the obstacle pushes
    u_T, slip    tangential displacement (k x dim), counted from where friction does,
                 and its length
    r_T, drag    tangential residual (k x dim) without directions in which the
                 displacement is prescribed, whose force is a reaction; its length
    can_slide    whether a tangential direction is left free
    law          of friction, by name
    bound        largest friction: F times the normal force, or what is given
    direction    unit vector of the slip, without prescribed directions; zero at rest
    measure      of the boundary that belongs to the node
    """

    def __init__(self, level, previous=None):
        """previous: the displacement at the end of the load step before, at all nodes,
        or None in the first one."""
        self.level, self.u, self.previous = level, level.displacement, previous
        self.lengths = np.linalg.norm(self.u, axis=1)
        if previous is not None:
            self.lengths = np.maximum(self.lengths, np.abs(previous).max())
        self.hanging = find_hanging_nodes(level)
        self.is_hanging = np.zeros(level.n_nodes, bool)
        self.is_hanging[list(self.hanging)] = True

        internal, self.strain_energy, diagonal, volumes = body_integrals(level)
        loads = nodal_loads(level, level.body_force, level.traction_faces,
                            level.tractions)
        self.work = np.sum(loads * self.u)
        self.r = self._condensed(loads - internal)

        self.boundary = ContactBoundary(level, self.hanging)
        self._look_at_contact_nodes()
        self._find_scales(diagonal)
        self._find_units(diagonal, volumes)

    def _condensed(self, forces):
        """What a hanging node gets, its masters get."""
        result = forces.copy()
        for node, masters in self.hanging.items():
            for master, weight in masters.items():
                result[master] += weight * result[node]
            result[node] = 0
        return result

    def _look_at_contact_nodes(self):
        level, nodes, normals = (self.level, self.level.contact_nodes,
                                 self.level.contact_normals)
        prescribed = level.is_prescribed[nodes]
        self.x, self.u_c, r_c = level.vertices[nodes], self.u[nodes], self.r[nodes]
        self.gap = np.full(len(nodes), np.inf)
        for contact in level.contacts:
            own = level.of_contact(contact)
            self.gap[own] = contact.obstacle.gap(self.x[own], normals[own])
        u_n = np.sum(self.u_c * normals, axis=1)
        self.room = self.gap - u_n
        self.pressing = np.sum(r_c * normals, axis=1)

        self.u_T = self.u_c - u_n[:, None] * normals - level.slip_origins
        self.r_T = r_c - self.pressing[:, None] * normals
        self.r_T = np.where(prescribed, 0, self.r_T)
        self.can_slide = (~prescribed).sum(axis=1) > 1
        self.slip = np.linalg.norm(self.u_T, axis=1)
        self.drag = np.linalg.norm(self.r_T, axis=1)
        self.direction = self.u_T / np.where(self.slip > 0, self.slip, 1)[:, None]
        self.direction = np.where(prescribed, 0, self.direction)

        self.measure = self.boundary.measure[nodes]
        self.bound, self.law = np.zeros(len(nodes)), level.at_contact_nodes(
            "friction_law")
        rubs = self.law == "Coulomb"
        self.bound[rubs] = (level.coefficients() * np.maximum(self.pressing, 0))[rubs]
        given = self.law == "Tresca"
        if given.any():
            self.bound[given] = (level.friction_bounds * self.measure)[given]

    def _find_scales(self, diagonal):
        """diagonal: traces of the diagonal blocks of A, with hanging nodes not yet
        condensed, which is good enough here."""
        self.largest_u = max(np.abs(self.u).max(),
                             0 if self.previous is None
                             else np.abs(self.previous).max()) or 1.

        # What is left of the force that the displacement of one node alone would cause,
        # if the others cancel it: where a body merely moves all forces are rounding
        # errors.
        self.rounding = 1e-8 * np.max(diagonal * self.lengths * ~self.is_hanging)
        self.largest_stiffness = np.max(diagonal * ~self.is_hanging)

    def _find_units(self, diagonal, volumes):
        """unit, contact_unit: the force that others are compared with, at each node of
        the body and at each contact node, that of the peak pressure.

        stiffness_n, stiffness_T: the force per length with which a contact node resists
        in normal direction, and in that of its slip, the others being held.

        zone: the factor by which the stiffness of the contact zone, for its size, is
        less than that of the node."""
        level, nodes = self.level, self.level.contact_nodes
        size = np.zeros(level.n_nodes)
        for corner in level.cells.T:
            np.maximum.at(size, corner, volumes)
        face = size**((level.dim - 1) / level.dim)
        touches = level.contact_states > 0
        self.peak_pressure = np.max((self.pressing / self.measure)[touches], initial=0)
        given = self.law == "Tresca"
        self.peak_pressure = max(self.peak_pressure, np.max(
            (np.minimum(self.bound, self.drag) / self.measure)[given], initial=0))
        rows = Rows(level, nodes, self.hanging)
        inside = rows.forces_of_neighbours(self.u) / face[nodes]
        if not touches.any():
            free = np.flatnonzero(~self.is_hanging)
            inside = Rows(level, free, self.hanging).forces_of_neighbours(
                self.u) / face[free]
        stress = max(self.peak_pressure, (1e-3 if touches.any() else 1.)
                     * np.max(inside, initial=0))
        rounding = 1e-8 * diagonal * self.lengths

        def unit(measure, at_rounding):
            result = np.maximum(stress * measure, at_rounding)
            return np.where(result > 0, result, 1.)

        self.unit = unit(face, rounding)
        self._raise_unit_inside()
        self.contact_unit = unit(self.measure, rounding[nodes])
        n, t = level.contact_normals, self.u_T / np.where(
            self.slip > 0, self.slip, 1)[:, None]
        self.stiffness_n = np.einsum("ki,kij,kj->k", n, rows.diagonal, n)
        self.stiffness_T = np.einsum("ki,kij,kj->k", t, rows.diagonal, t)
        zone = np.maximum(self.measure, self.measure[touches].sum())
        self.zone = (self.measure / zone)**(1 / (level.dim - 1))

    def _raise_unit_inside(self):
        """Where cells bear more than the peak pressure, to what they bear; but only at
        those nodes that decide what the largest unbalanced force is."""
        free = ~self.level.is_prescribed & ~self.is_hanging[:, None]
        free[self.level.contact_nodes] = False
        force = np.where(free, np.abs(self.r), 0).max(axis=1)
        order = np.argsort(-force / self.unit)
        largest = 0.
        for start in range(0, len(order), 100):
            some = order[start:start + 100]
            if not force[some[0]] / self.unit[some[0]] > largest:
                break
            rows = Rows(self.level, some, self.hanging)
            self.unit[some] = np.maximum(self.unit[some],
                                         rows.forces_of_neighbours(self.u))
            largest = max(largest, np.max(force[some] / self.unit[some]))
