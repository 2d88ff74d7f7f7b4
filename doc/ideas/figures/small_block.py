"""A block with a slightly bent lower side, pushed down onto a plane and sideways,
solved with friction by the method of this suite on 32 x 16 cells: small enough
for full matrices, so that pictures can look into a single step. It shares no code
with the library."""

import numpy as np

FRICTION = 0.4
WIDTH, HEIGHT = 2.0, 1.0


def element_matrix(size):
    """Plane strain on a square cell: Young's modulus 1, Poisson ratio 0.3. The
    order of nodes is that of deal.II, that of components x, y."""
    poisson = 0.3
    factor = 1 / ((1 + poisson) * (1 - 2 * poisson))
    law = factor * np.array([[1 - poisson, poisson, 0],
                             [poisson, 1 - poisson, 0],
                             [0, 0, (1 - 2 * poisson) / 2]])
    matrix = np.zeros((8, 8))
    for x in (0.5 - np.sqrt(1 / 12), 0.5 + np.sqrt(1 / 12)):
        for y in (0.5 - np.sqrt(1 / 12), 0.5 + np.sqrt(1 / 12)):
            dx = np.array([-(1 - y), 1 - y, -y, y]) / size
            dy = np.array([-(1 - x), -x, 1 - x, x]) / size
            strain = np.zeros((3, 8))
            strain[0, 0::2], strain[1, 1::2] = dx, dy
            strain[2, 0::2], strain[2, 1::2] = dy, dx
            matrix += strain.T @ law @ strain * size**2 / 4
    return matrix


def hats(fine, coarse):
    """Coarse hat functions at fine points of an interval: fine+1 by coarse+1."""
    x = np.linspace(0, coarse, fine + 1)[:, None]
    return np.maximum(0, 1 - np.abs(x - np.arange(coarse + 1)))


class SmallBlock:
    """The discrete problem. Node p has the components 2p (x) and 2p+1 (y); the
    outward normal of the lower side is -y, its tangent x. Rows of nodes go from
    left to right, from below upwards."""

    def __init__(self, cells=32):
        self.cells = (cells, cells // 2)
        nx, ny = self.cells
        x = np.linspace(0, WIDTH, nx + 1)
        self.points = np.array([(a, b) for b in np.linspace(0, HEIGHT, ny + 1)
                                for a in x])
        n = len(self.points)
        self.matrix = np.zeros((2 * n, 2 * n))
        local = element_matrix(WIDTH / nx)
        for j in range(ny):
            for i in range(nx):
                nodes = np.array([j * (nx + 1) + i, j * (nx + 1) + i + 1,
                                  (j + 1) * (nx + 1) + i,
                                  (j + 1) * (nx + 1) + i + 1])
                dofs = np.stack([2 * nodes, 2 * nodes + 1], 1).ravel()
                self.matrix[np.ix_(dofs, dofs)] += local
        self.contact = np.arange(nx + 1)
        self.gap = 0.03 * (x - 0.9)**2
        self.top = np.arange(n - nx - 1, n)
        self.start = np.zeros(2 * n)
        self.start[2 * self.top], self.start[2 * self.top + 1] = 0.006, -0.015

    def residual(self, u):
        """There are no loads: r = -Au, minus the nodal forces."""
        return -self.matrix @ u

    def normal_force(self, u):
        """tau at the contact nodes: what the plane pushes with."""
        touches = -u[2 * self.contact + 1] >= self.gap - 1e-15
        force = -self.residual(u)[2 * self.contact + 1]
        return np.where(touches, np.maximum(force, 0), 0)

    def energy(self, u, tau):
        """The functional of Tresca at given normal forces, (6.8)."""
        return (0.5 * u @ self.matrix @ u +
                FRICTION * tau @ np.abs(u[2 * self.contact]))

    def relax(self, u, tau):
        """One leading sweep; tau is updated along with it (Algorithm 3)."""
        for p in range(len(self.points) - len(self.top)):
            row = slice(2 * p, 2 * p + 2)
            a = self.matrix[row, row]
            b = -self.matrix[row] @ u + a @ u[row]
            if p not in self.contact:
                u[row] = np.linalg.solve(a, b)
                continue
            touches = -u[2 * p + 1] >= self.gap[p] - 1e-15
            tau[p] = max(0, (a @ u[row] - b)[1]) if touches else 0
            u[row] = self.local_problem(a, b, FRICTION * tau[p], self.gap[p])
        return u, tau

    @staticmethod
    def local_problem(a, b, bound, gap):
        """(6.15): first without the obstacle, then on it."""
        def slip(remaining, stiffness):
            return (np.sign(remaining) * max(0, abs(remaining) - bound) /
                    stiffness)

        condensed = a[0, 0] - a[0, 1]**2 / a[1, 1]
        z_x = slip(b[0] - a[0, 1] * b[1] / a[1, 1], condensed)
        z_y = (b[1] - a[0, 1] * z_x) / a[1, 1]
        if -z_y > gap:
            z_y = -gap
            z_x = slip(b[0] - a[0, 1] * z_y, a[0, 0])
        return z_x, z_y

    def phases(self, u):
        """Of the contact nodes: 'open', 'slip' or 'stick'."""
        touches = -u[2 * self.contact + 1] >= self.gap - 1e-15
        return np.where(~touches, "open",
                        np.where(u[2 * self.contact] == 0, "stick", "slip"))

    def free(self, u):
        """The truncation as a vector: 1 where a component is free."""
        free = np.ones_like(u)
        free[2 * self.top] = free[2 * self.top + 1] = 0
        phases = self.phases(u)
        free[2 * self.contact[phases == "stick"]] = 0
        free[2 * self.contact[phases != "open"] + 1] = 0
        return free

    def interpolation(self, level):
        """From the mesh with 2**-level as many cells in each direction."""
        nx, ny = self.cells
        scalar = np.kron(hats(ny, ny >> level), hats(nx, nx >> level))
        return np.kron(scalar, np.eye(2))

    def coarser(self, matrix, level):
        """The matrix of the next coarser functions, of that of a level."""
        nx, ny = (n >> level for n in self.cells)
        x, y = hats(nx, nx // 2), hats(ny, ny // 2)
        entries = matrix.reshape(ny + 1, nx + 1, 2, ny + 1, nx + 1, 2)
        entries = np.einsum("jJ,iI,jicvud,vV,uU->JIcVUd", y, x, entries, y, x,
                            optimize=True)
        n = 2 * x.shape[1] * y.shape[1]
        return entries.reshape(n, n)

    def correction(self, u, tau, levels=4, sweeps=3):
        """A V-cycle for the truncated linear problem, below the leaf mesh."""
        free = self.free(u)
        gradient = self.residual(u)
        slips = (self.phases(u) == "slip")
        gradient[2 * self.contact] -= (FRICTION * tau * slips *
                                       np.sign(u[2 * self.contact]))
        gradient *= free
        v = np.zeros_like(u)
        order = list(range(1, levels + 1)) + list(range(levels, 0, -1))
        bases = {k: free[:, None] * self.interpolation(k) for k in set(order)}
        matrices = {0: free[:, None] * self.matrix * free}
        for k in range(levels):
            matrices[k + 1] = self.coarser(matrices[k], k)
        for k in order:
            b = bases[k].T @ (gradient - self.matrix @ v)
            if k == levels:
                c = np.linalg.lstsq(matrices[k], b, rcond=1e-12)[0]
            else:
                c = self.sweeps(matrices[k], b, sweeps)
            v += bases[k] @ c
        return v

    @staticmethod
    def sweeps(matrix, b, number):
        """Block Gauss-Seidel; functions that truncation has taken stay zero."""
        c = np.zeros_like(b)
        n = len(b) // 2
        nodes = np.arange(n)
        inverses = np.linalg.pinv(
            matrix.reshape(n, 2, n, 2)[nodes, :, nodes, :], 1e-10, True)
        for _ in range(number):
            for p in nodes:
                row = slice(2 * p, 2 * p + 2)
                c[row] += inverses[p] @ (b[row] - matrix[row] @ c)
        return c

    def project(self, u):
        result = u.copy()
        result[2 * self.contact + 1] = np.maximum(u[2 * self.contact + 1],
                                                  -self.gap)
        return result

    def step_length(self, u, v, tau, longest=2.0):
        """The length that minimises the energy: the functional is convex. Along v it is
        a parabola, and friction at the contact nodes."""
        slope, curvature = -self.residual(u) @ v, 0.5 * v @ self.matrix @ v
        at_rest, shift = u[2 * self.contact], v[2 * self.contact]

        def energy(length):
            return (length * (slope + length * curvature) +
                    FRICTION * tau @ np.abs(at_rest + length * shift))

        low, high = 0.0, longest
        for _ in range(60):
            left, right = low + (high - low) / 3, high - (high - low) / 3
            if energy(left) < energy(right):
                high = right
            else:
                low = left
        return (low + high) / 2

    def step(self, u, tau, sweeps=3, coarse=True):
        """One step of the method; returns the smoothed iterate as well."""
        u = u.copy()
        for _ in range(sweeps):
            u, tau = self.relax(u, tau)
        smoothed, tau = u.copy(), self.normal_force(u)
        if coarse:
            v = self.correction(u, tau)
            target = self.project(u + self.step_length(u, v, tau) * v)
            u = u + self.step_length(u, target - u, tau, 1.0) * (target - u)
        return u, smoothed, tau

    def iterate(self, steps, coarse=True):
        """The smoothed iterates, and the normal forces of the last."""
        u, tau = self.start.copy(), np.zeros(len(self.contact))
        iterates = []
        for _ in range(steps):
            u, smoothed, tau = self.step(u, tau, coarse=coarse)
            iterates.append(smoothed)
        return iterates, tau
