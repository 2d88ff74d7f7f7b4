"""The fields of a run at a level, of all processes together."""

import h5py
import numpy as np

import vtu
from failure import Failure

STRESSES = ("XX", "YY", "ZZ", "XY", "YZ", "XZ")
# What is no field.
MESH = {"points", "cells", "connectivity", "offsets", "types"}


class Mesh:
    """Points (n x 3), cells (rows of points), and fields: `of_points`, `of_cells`."""

    def __init__(self, points, cells, of_points, of_cells):
        self.points, self.cells = points, cells
        self.of_points, self.of_cells = of_points, of_cells

    def in_points(self, name):
        """A field of numbers in the points; one of cells is averaged there."""
        if name in self.of_points:
            return self.of_points[name]
        return nodal_average(self.cells, self.of_cells[name], len(self.points))


def nodal_average(cells, values, n_points=0):
    """Values of cells, averaged at the nodes that are their corners."""
    nodes = cells.ravel()
    return (np.bincount(nodes, np.repeat(values, cells.shape[1]), minlength=n_points)
            / np.bincount(nodes, minlength=n_points))


def merged(points, cells, of_points, of_cells):
    """A Mesh in which points at the same place are one. Processes, and cells of an
    HDF5 file, have each their own."""
    size = np.ptp(points, axis=0).max() if len(points) else 1.
    places = np.round((points - points.min(axis=0)) / (size * 1e-10)).astype(np.int64)
    _, first, inverse = np.unique(places, axis=0, return_index=True,
                                  return_inverse=True)
    return Mesh(points[first], inverse.reshape(-1)[cells],
                {name: values[first] for name, values in of_points.items()}, of_cells)


def joined(files):
    """One Mesh of the pieces of all processes."""
    pieces = [(vtu.read(file), vtu.fields_of(file, "CellData")) for file in files]
    pieces = [piece for piece in pieces if len(piece[0]["cells"])]
    if not pieces:
        raise Failure(f"'{files[0]}' and its like have no cells.")
    starts = np.cumsum([0] + [len(arrays["points"]) for arrays, _ in pieces])
    of_cells = pieces[0][1]
    of_points = [name for name in pieces[0][0] if name not in MESH | set(of_cells)]

    def all_of(name):
        return np.concatenate([arrays[name] for arrays, _ in pieces])

    cells = np.concatenate([arrays["cells"] + start
                            for (arrays, _), start in zip(pieces, starts)])
    fields = ({name: all_of(name) for name in of_points},
              {name: all_of(name) for name in of_cells})
    if len(pieces) == 1:
        return Mesh(all_of("points"), cells, *fields)
    return merged(all_of("points"), cells, *fields)


def from_hdf5(path):
    """The body as 'Output/Format=hdf5' has it: corners of different cells are
    different points there, and have what belongs to the cell."""
    with h5py.File(path, "r") as file:
        data = {name: item[()] for name, item in file.items()}
    points, cells = data.pop("nodes"), data.pop("cells")
    points = np.pad(points, ((0, 0), (0, 3 - points.shape[1])))
    of_cells = {name: values[cells[:, 0]].reshape(-1) for name, values in data.items()
                if name != "displacement"}
    # As a .vtu has it.
    names = [f"stress_{name.lower()}" for name in STRESSES]
    if "stress_xx" in of_cells:
        zero = np.zeros(len(cells))
        of_cells["stress"] = np.stack([of_cells.pop(name, zero) for name in names],
                                      axis=1)
    displacement = data["displacement"]
    displacement = np.pad(displacement, ((0, 0), (0, 3 - displacement.shape[1])))
    return merged(points, cells, {"displacement": displacement}, of_cells)


def read_fields(directory, what, level):
    """The Mesh of the 'body' or the 'contact' boundary, or None if the run has
    written no such fields. Raises Failure."""
    name = directory / f"{what}-{level:02d}"
    record, hdf5 = name.with_suffix(".pvtu"), name.with_suffix(".h5")
    try:
        if record.is_file():
            return joined(vtu.pieces_of(record))
        if hdf5.is_file():
            return from_hdf5(hdf5)
    except (OSError, KeyError, ValueError, IndexError, TypeError) as error:
        raise Failure(f"'{name}' and its like cannot be read: they are damaged, or of "
                      "another version.") from error
    return None


def field_names(mesh):
    """What select_field() knows by name."""
    names = []
    for name, values in {**mesh.of_points, **mesh.of_cells}.items():
        if values.ndim == 1:
            names.append(name)
        elif values.shape[1] == 6:
            names += [f"{name}_{component.lower()}" for component in STRESSES]
        else:
            names += [name] + [f"{name}_{component}" for component in "xyz"]
    return names


def select_field(mesh, name):
    """A number in each point, of a field or of a component of it, as 'stress_xy' or
    'displacement'. Raises Failure."""
    if name not in field_names(mesh):
        raise Failure(f"there is no field '{name}'; there are "
                      f"{', '.join(field_names(mesh))}.")
    base, _, component = name.rpartition("_")
    for fields in (mesh.of_points, mesh.of_cells):
        if name in fields and fields[name].ndim == 1:
            return mesh.in_points(name)
        if name in fields:
            values = np.linalg.norm(fields[name], axis=1)
        elif base in fields and component.upper() in STRESSES:
            values = fields[base][:, STRESSES.index(component.upper())]
        elif base in fields:
            values = fields[base][:, "xyz".index(component)]
        else:
            continue
        if fields is mesh.of_points:
            return values
        return nodal_average(mesh.cells, values, len(mesh.points))
    raise Failure(f"there is no field '{name}'.")
