"""What a run has recorded in the history.h5 of its output directory."""

from pathlib import Path

import h5py
import numpy as np

from failure import Failure


def entries_of(text):
    """The entries of a scene file, by 'Section/Entry'."""
    entries, section = {}, ""
    for line in text.splitlines():
        line = line.split("#")[0].strip()
        if line.startswith("subsection "):
            section = line[len("subsection "):].strip() + "/"
        elif line == "end":
            section = ""
        elif line.startswith("set ") and "=" in line:
            name, _, value = line[4:].partition("=")
            entries[section + name.strip()] = value.strip()
    return entries


def text_of(attribute):
    return attribute.decode() if isinstance(attribute, bytes) else str(attribute)


def quantity(row, name):
    """A column of a level, or a quotient of two. Raises Failure."""
    values = []
    for part in name.split("/"):
        key = part.strip().replace(" ", "_")
        if key not in row:
            raise Failure(f"there is no quantity '{part.strip()}'; there are "
                          f"{', '.join(sorted(row))}.")
        values.append(float(row[key]))
    if len(values) > 2:
        raise Failure(f"'{name}' is no quotient of two quantities.")
    if len(values) == 1:
        return values[0]
    return values[0] / values[1] if values[1] != 0 else np.nan


class Run:
    """The history of a run: one value per level in `levels`, one per cycle in
    `cycles`, one per outer iteration in `outer` (Algorithm 2; or None), one per
    contact node in `contact`, by level. `dim` is the dimension, `entries` are the
    parameters, by 'Section/Entry'. Raises Failure."""

    def __init__(self, directory):
        self.directory = Path(directory)
        if not self.directory.is_dir():
            raise Failure(f"there is no directory '{self.directory}'; name the output "
                          "directory of a run.")
        path = self.directory / "history.h5"
        if not path.is_file():
            raise Failure(f"there is no '{path}': no run has finished a level there; "
                          "name the output directory of a run.")
        self._units, self._labels = {}, {}
        try:
            with h5py.File(path, "r") as file:
                self._read(file)
        except (OSError, KeyError, ValueError, IndexError) as error:
            raise Failure(f"'{path}' cannot be read: it is damaged, or of another "
                          "version.") from error

    def _read(self, file):
        self.scene = text_of(file.attrs["scene"])
        self.version = text_of(file.attrs["version"])
        self.entries = entries_of(text_of(file.attrs["parameters"]))
        self.dim = int(file.attrs["dimension"])
        self.levels = self._columns(file["levels"])
        self.cycles = (self._columns(file["cycles"]) if "cycles" in file
                       else {name: self.levels["level"][:0] for name in
                             ("level", "increment", "energy", "residual")})
        self.outer = self._columns(file["outer"]) if "outer" in file else None
        self.contact = {int(name.split("_")[1]): self._columns(group)
                        for name, group in file.get("contact", {}).items()}
        self.last = int(self.levels["level"][-1])

    def _columns(self, group):
        """The datasets of a group; their labels and units are kept by its first name
        and theirs."""
        for name, data in group.items():
            path = f"{group.name.split('/')[1]}/{name}"
            if "units" in data.attrs:
                self._units[path] = text_of(data.attrs["units"])
            if "label" in data.attrs:
                self._labels[path] = text_of(data.attrs["label"])
        return {name: data[:] for name, data in group.items()}

    def unit(self, column):
        """Of a column such as 'levels/energy' or 'contact/gap': what the scene calls
        it, or nothing."""
        return self._units.get(column, "")

    def label(self, column):
        """What a column is, in a few words."""
        return self._labels.get(column, column.split("/")[1].replace("_", " "))

    def axis(self, text, column):
        """The name of an axis, with the unit of a column if it has one."""
        unit = self.unit(column)
        return f"{text} [{unit}]" if unit else text

    def row(self, level):
        """What is known of a level, by column. Raises Failure."""
        for i, number in enumerate(self.levels["level"]):
            if number == level:
                return {name: values[i] for name, values in self.levels.items()}
        raise Failure(f"the run in '{self.directory}' has no level {level}; its last "
                      f"one is {self.last}.")
