"""What a scene file says."""

import numpy as np

from expressions import Expression, NotUnderstood, split
from run_data import NotReadable
from obstacle import Obstacle
from surface import Surface


def group_names(path):
    """Ids of the groups of a mesh file of Gmsh, by their dimension and name. This section
    is text in files of all formats, binary ones included."""
    try:
        data = path.read_bytes()
    except OSError as error:
        raise NotReadable(f"'{path}' cannot be read: {error.strerror}.") from error
    groups, (_, _, section) = {}, data.partition(b"$PhysicalNames")
    for line in section.partition(b"$EndPhysicalNames")[0].splitlines():
        parts = line.decode(errors="replace").strip().split(None, 2)
        if len(parts) == 3 and parts[0].isdigit() and parts[1].isdigit():
            groups[int(parts[0]), parts[2].strip('"')] = int(parts[1])
    if not groups:
        raise NotReadable(f"'{path}' has no section $PhysicalNames.")
    return groups


class SceneText:
    """What the parameters in history.h5 say. Raises NotUnderstood where that is beyond
    this program."""

    def __init__(self, text, dim, time=None, groups=None):
        """time: of a load step, if there are several; groups: those of group_names()."""
        self.dim, self.entries, section = dim, {}, ""
        self.groups = groups or {}
        for line in text.splitlines():
            line = line.split("#")[0].strip()
            if line.startswith("subsection "):
                section = line[len("subsection "):].strip() + "/"
            elif line == "end":
                section = ""
            elif line.startswith("set ") and "=" in line:
                name, _, value = line[4:].partition("=")
                self.entries[section + name.strip()] = value.strip()

        E, nu = self.number("Material/Young's modulus"), self.number(
            "Material/Poisson ratio")
        self.names = {"E": E, "nu": nu, "lambda": E * nu / (1 + nu) / (1 - 2 * nu),
                      "mu": E / 2 / (1 + nu), "pi": np.pi,
                      "F": self.coefficient("Contact")}
        for part in split(self["Scene/Constants"], ";"):
            name, _, expression = part.partition("=")
            try:
                self.names[name.strip()] = self.evaluate(expression)
            except NotUnderstood:
                pass  # and what needs it will not be understood, either
        times = split(self.entries.get("Load steps/Times", ""), ",")
        self.times = [float(self.evaluate(part)) for part in times]
        if times:
            self.names["t"] = self.times[0] if time is None else time
        for part in split(self["Scene/Definitions"], ";"):
            name, _, expression = part.partition("=")
            self.names[name.strip()] = expression

        angle = self.number("Scene/Rotation angle")
        c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
        self.rotation = np.eye(dim)
        self.rotation[:2, :2] = [[c, -s], [s, c]]

    def __getitem__(self, entry):
        if entry not in self.entries:
            raise NotReadable(f"'{entry}' is not among the parameters in history.h5.")
        return self.entries[entry]

    def number(self, entry):
        return float(self[entry])

    def sections(self, base):
        """'Contact', and then 'Contact 2' and so on, by number."""
        found = {entry.split("/")[0] for entry in self.entries}
        return {1: base, **{number: f"{base} {number}" for number in range(2, 100)
                            if f"{base} {number}" in found}}

    def coefficient(self, section):
        """A number, or the text of an expression."""
        text = self[section + "/Friction coefficient"]
        try:
            return float(text)
        except ValueError:
            return text

    def evaluate(self, expression, points=None):
        """At points (n x dim) of the scene before it is turned, or without any."""
        names = dict(self.names)
        if points is not None:
            names.update(zip("xyz", points.T))
        return Expression(expression, names).value()

    def numbers(self, text):
        return np.array([self.evaluate(part) for part in split(text, ",")], float)

    def group(self, key, codim):
        """The id of a group of cells (codim=0) or of boundary faces (1), from its id or
        its name."""
        if key.lstrip("-").isdigit():
            return int(key)
        if (self.dim - codim, key) not in self.groups:
            raise NotUnderstood(f"'{key}', a name that the file of --mesh gives"
                                if not self.groups else
                                f"'{key}', which is no name in the file of --mesh")
        return self.groups[self.dim - codim, key]

    def vector_field(self, components, points):
        """Of the scene as it has been turned, at points of it (n x dim)."""
        original = points @ self.rotation
        values = np.empty(points.shape)
        for d, component in enumerate(components):
            values[:, d] = self.evaluate(component, original)
        return values @ self.rotation.T

    def conditions(self, entry):
        """Pairs of a key and components."""
        for part in split(self[entry], ";"):
            key, _, components = part.partition(":")
            yield key.strip(), split(components, ",")

    def boundary_conditions(self, entry):
        """Pairs of a boundary's id and components."""
        for key, components in self.conditions(entry):
            yield self.group(key, 1), components

    def obstacle(self, body_size=1., section="Obstacle"):
        """An Obstacle, like that of a verify-NN.h5. What a function says is looked for
        within the size of the body."""
        said = {name: self[section + "/" + name] for name in
                ("Kind", "Point", "Normal", "Function", "Length", "Radius", "Axes",
                 "Centers", "Side")}
        kind, dim = said["Kind"], self.dim
        if kind == "none":
            return Obstacle()
        if kind == "plane":
            point = self.numbers(said["Point"])
            normal = self.numbers(said["Normal"])
            if len(point) == 0:
                point = np.zeros(dim)
            if len(normal) == 0:
                normal = -np.eye(dim)[-1]
            normal /= np.linalg.norm(normal)
            return Obstacle(planes=[(self.rotation @ point, self.rotation @ normal)])
        if kind == "surface":
            text = said["Function"]

            def value(points):
                return np.broadcast_to(self.evaluate(text, points @ self.rotation),
                                       len(points)).astype(float)

            return Obstacle(surfaces=[Surface(value, body_size)])
        length = self.numbers(said["Length"])
        radii = [self.numbers(part)[0] for part in split(said["Radius"], ";")]
        rods, axes = [], split(said["Axes"], ";")
        for i, center in enumerate(split(said["Centers"], ";")):
            axis = np.zeros(dim)
            if dim == 3 and kind == "rods":
                axis = self.numbers(axes[i])
                axis /= np.linalg.norm(axis)
            rods.append((self.rotation @ self.numbers(center), self.rotation @ axis,
                         radii[i if len(radii) > 1 else 0],
                         length[0] if len(length) else np.inf,
                         -1. if said["Side"] == "inside" else 1.))
        return Obstacle(rods=rods)
