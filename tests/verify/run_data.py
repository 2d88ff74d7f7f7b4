"""What a run has written: verify-NN.h5 and history.h5."""

import h5py
import numpy as np

from obstacle import Obstacle


class NotReadable(Exception):
    """One sentence that says what cannot be read."""


# What verify-NN.h5 says of each contact boundary.
OF_CONTACT = ("contact_boundary", "contact_normal", "friction_law",
              "friction_coefficient")


class FurtherContact:
    """What is said of the section 'Contact 2', or of one with a higher number, under
    the names that a Level has for those of the section 'Contact'."""


class Level:
    """What verify-NN.h5 holds, under the names that it has there. contacts are the
    contact boundaries: the level itself, and a FurtherContact for each of the others;
    a number says which section they belong to."""

    def __init__(self, path):
        sentence = (f"'{path}' cannot be read: it is no file that "
                    "'Output/Verification' makes, or damaged.")
        try:
            with h5py.File(path) as file:
                for name in ("dimension", "level", "youngs_modulus", "poisson_ratio",
                             "volumetric_strain", *OF_CONTACT):
                    setattr(self, name, file.attrs[name])
                self.number, self.contacts = 1, [self]
                for number in range(2, 100):
                    if f"contact_boundary_{number}" in file.attrs:
                        contact = FurtherContact()
                        contact.number = number
                        for name in OF_CONTACT:
                            setattr(contact, name, file.attrs[f"{name}_{number}"])
                        self.contacts.append(contact)
                # With several load steps.
                self.load_step = int(file.attrs.get("load_step", 1))
                self.time = file.attrs.get("time")
                data = {name: item[()] for name, item in file.items()}
            self._take(data)
        except (OSError, KeyError, ValueError, IndexError) as error:
            raise NotReadable(sentence) from error

    def _take(self, data):
        """Raises KeyError, ValueError or IndexError where data do not fit together."""
        self.dim = dim = int(self.dimension)
        self.n_nodes = n = len(data["vertices"])

        def rows(name, columns, kind=float):
            empty = np.zeros((0, columns) if columns > 1 else 0)
            values = np.asarray(data.get(name, empty)).astype(kind)
            if values.shape[1:] != empty.shape[1:]:
                raise ValueError(name)
            return values

        def nodes(name, columns):
            values = rows(name, columns, int)
            if values.size and values.max() >= n:
                raise IndexError(name)
            return values

        self.vertices = rows("vertices", dim)
        self.displacement = rows("displacement", dim)
        self.cells = nodes("cells", 2**dim)
        self.boundary_faces = nodes("boundary_faces", 2**(dim - 1))
        self.boundary_ids = rows("boundary_ids", 1, int)
        self.hanging_nodes = nodes("hanging_nodes", 2)
        self.hanging_weights = rows("hanging_weights", 1)
        self.prescribed = nodes("prescribed", 2)
        self.prescribed_values = rows("prescribed_values", 1)
        # Young's modulus and the like of each region; number 0 is what is in none.
        means = [self.volumetric_strain == "mean"]
        self.materials = rows("materials", 3)
        if len(self.materials) == 0:
            self.materials = np.array(
                [[self.youngs_modulus, self.poisson_ratio, *means]], float)
        one = np.zeros(len(self.cells), int)
        self.cell_ids = np.asarray(data.get("cell_ids", one)).astype(int)
        self.cell_regions = np.asarray(data.get("cell_regions", one)).astype(int)
        self.body_force = data.get("body_force")
        self.traction_faces = nodes("traction_faces", 2**(dim - 1))
        self.tractions = rows("tractions", dim)
        self.contact_nodes = nodes("contact_nodes", 1)
        self.contact_normals = rows("contact_normals", dim)
        self.contact_states = rows("contact_states", 1, int)
        # In later load steps, what slip counts from.
        self.has_slip_origins = "slip_origins" in data
        self.slip_origins = (rows("slip_origins", dim) if self.has_slip_origins
                             else np.zeros((len(self.contact_nodes), dim)))
        # Where it varies somewhere, one per contact node.
        self.friction_coefficient = data.get("friction_coefficients",
                                             self.friction_coefficient)
        self.friction_bounds = data.get("friction_bounds")
        for contact in self.contacts:
            end = "" if contact.number == 1 else f"_{contact.number}"
            contact.obstacle = Obstacle(
                list(zip(rows("plane_points" + end, dim),
                         rows("plane_normals" + end, dim))),
                [(c, a, r, length if length > 0 else np.inf, side)
                 for c, a, r, length, side in zip(
                     rows("rod_centers" + end, dim), rows("rod_axes" + end, dim),
                     rows("rod_radii" + end, 1), rows("rod_lengths" + end, 1),
                     rows("rod_sides" + end, 1))])
        k = len(self.contact_nodes)
        self.contact_sections = np.asarray(
            data.get("contact_sections", np.ones(k))).astype(int)
        if (len(self.displacement) != n
                or len(self.cell_ids) != len(self.cells)
                or len(self.cell_regions) != len(self.cells)
                or (len(self.cells) > 0
                    and self.cell_regions.max() >= len(self.materials))
                or len(self.boundary_faces) != len(self.boundary_ids)
                or len(self.hanging_nodes) != len(self.hanging_weights)
                or len(self.tractions) != 4**(dim - 1) * len(self.traction_faces)
                or len(self.contact_normals) != k or len(self.contact_states) != k
                or len(self.contact_sections) != k
                or not set(self.contact_sections) <= {c.number for c in self.contacts}
                or len(self.slip_origins) != k
                or np.shape(self.friction_coefficient) not in ((), (k,))
                or (any(c.friction_law == "Tresca" for c in self.contacts) and k > 0
                    and np.shape(self.friction_bounds) != (k,))
                or (self.body_force is not None and
                    self.body_force.shape != (2**dim * len(self.cells), dim))):
            raise ValueError("rows")

        # Whether a component of a node is prescribed, and its value (nodes x dim).
        self.is_prescribed = np.zeros((n, dim), bool)
        self.values = np.zeros((n, dim))
        self.is_prescribed[tuple(self.prescribed.T)] = True
        self.values[tuple(self.prescribed.T)] = self.prescribed_values


    def nodes_of_boundary(self, boundary):
        """Numbers of the nodes of a boundary, from its id."""
        return np.unique(self.boundary_faces[self.boundary_ids == boundary])

    def of_contact(self, contact):
        """Which contact nodes belong to a contact boundary."""
        return self.contact_sections == contact.number

    def at_contact_nodes(self, name):
        """A property of contact boundaries at each contact node."""
        values = np.array([getattr(contact, name) for contact in self.contacts])
        numbers = np.array([contact.number for contact in self.contacts])
        return values[np.searchsorted(numbers, self.contact_sections)]

    def coefficients(self):
        """Of friction, at each contact node."""
        if np.ndim(self.friction_coefficient):
            return self.friction_coefficient
        return self.at_contact_nodes("friction_coefficient")


def read_history(directory):
    """The parameters, and for each level a dictionary of its numbers."""
    path = directory / "history.h5"
    if not path.is_file():
        raise NotReadable(f"there is no '{path}'; name the output directory of a run.")
    try:
        with h5py.File(path) as file:
            text = file.attrs["parameters"]
            columns = {name: item[()] for name, item in file["levels"].items()}
            # Python's own numbers: those of numpy 2 keep the type of the file, and
            # one less than zero of an unsigned type is a large number.
            levels = [{name: column[i].item() if isinstance(column[i], np.generic)
                       else column[i] for name, column in columns.items()}
                      for i in range(len(columns["level"]))]
            for i, row in enumerate(levels):
                row["normal_forces_before"] = columns["normal_force"][:i]
                group = file.get(f"contact/level_{row['level']:02d}")
                if group is not None:
                    row["contact"] = {name: item[()] for name, item in group.items()}
                forces = {name: item[()] for name, item in file.get("forces", {}).items()}
                at = np.flatnonzero(forces.get("level", np.zeros(0)) == row["level"])
                if len(at):
                    row["forces"] = {name: values[at[0]]
                                     for name, values in forces.items()}
    except (OSError, KeyError) as error:
        raise NotReadable(f"'{path}' cannot be read: it is damaged, or of another "
                          "version.") from error
    return text if isinstance(text, str) else text.decode(), levels
