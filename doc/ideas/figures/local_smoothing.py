"""The levels of a small adaptive mesh and what each of their nodes is good for,
found from the cells that a run has written."""

import itertools

import numpy as np

from drawing_of_ideas import Failure
from chart import BLUE, GREY, ORANGE, RED, plt
import vtu

# Every free node of the leaf mesh is relaxed there. A node of a level is either
# relaxed on it, or its residual enters there, or it hangs.
MARKERS = {"relaxed": (BLUE, "o", 4.2, True), "own": (GREY, "o", 2.6, True),
           "edge": (ORANGE, "s", 5.0, False), "hanging": (RED, "x", 5.0, True)}


def corners(cell):
    """The vertices of a cell, counted in its own edge lengths."""
    level, i, j = cell
    return [(level, i + di, j + dj) for di, dj in
            itertools.product((0, 1), repeat=2)]


class Mesh:
    """The cells of a square that is refined locally, as (level, i, j)."""

    def __init__(self, active):
        self.active = set(active)
        self.finest = max(level for level, i, j in active)
        self.refined = set()
        for level, i, j in active:
            while level > 0:
                level, i, j = level - 1, i // 2, j // 2
                self.refined.add((level, i, j))

    def point(self, vertex):
        """Its place, counted in edge lengths of the finest cells."""
        level, i, j = vertex
        return i << (self.finest - level), j << (self.finest - level)

    def cells(self, level):
        return [cell for cell in self.active | self.refined if cell[0] == level]

    def around(self, point, cells):
        """The levels of those cells that have the point as a corner."""
        return [cell[0] for cell in cells
                if point in map(self.point, corners(cell))]

    def nodes(self, cells):
        return {self.point(corner) for cell in cells for corner in corners(cell)}

    def edge_middles(self, cell):
        level, i, j = cell
        i, j, level = 2 * i, 2 * j, level + 1
        return {self.point((level, i + di, j + dj))
                for di, dj in ((1, 0), (0, 1), (2, 1), (1, 2))} \
            if level <= self.finest else set()

    def kinds(self):
        """The kind of each node, by level; 'leaf' for the leaf mesh."""
        leaf = self.nodes(self.active)
        hanging = leaf & set().union(*map(self.edge_middles, self.active))
        levels = {point: self.around(point, self.active) for point in leaf}
        result = {"leaf": {point: "hanging" if point in hanging else "relaxed"
                           for point in leaf}}
        for level in range(self.finest + 1):
            result[level] = kinds = {}
            for point in self.nodes(self.cells(level)):
                if point in hanging:
                    kinds[point] = "hanging"
                elif max(levels[point]) > level:
                    kinds[point] = "relaxed"
                else:
                    kinds[point] = ("edge" if min(levels[point]) < level
                                    else "own")
        self.check(hanging, levels, result)
        return result

    def check(self, hanging, levels, kinds):
        """What the page says of any mesh must hold for this one."""
        for point, around in levels.items():
            if max(around) > min(around) + 1:
                raise Failure("Cells at a vertex differ by more than a level.")
            on = [level for level in range(self.finest + 1)
                  if kinds[level].get(point) in ("own", "edge", "hanging")]
            if len(on) != 1 or (point not in hanging and on != [max(around)]):
                raise Failure("A leaf node does not belong to one level.")
        for cell in self.active:
            free = {self.point(corner) for corner in corners(cell)} - hanging
            if any(point in hanging for point in
                   map(self.point, corners(cell))):
                level, i, j = cell
                free |= {self.point(corner) for corner in
                         corners((level - 1, i // 2, j // 2))} - hanging
            for one, other in itertools.combinations(free, 2):
                level = min(max(levels[one]), max(levels[other]))
                if not (one in kinds[level] and other in kinds[level]):
                    raise Failure("A pair of nodes is not on any level.")


def read_mesh(directory, number):
    """One of the meshes of a run whose domain is a square of one coarse cell."""
    data = vtu.read(directory / f"body-{number:02}.0000.vtu")
    points = data["points"][:, :2][data["cells"]]
    lower, size = points.min(axis=1), np.ptp(points, axis=1)[:, :1]
    level = np.rint(np.log2(points.max() / size)).astype(int)
    index = np.rint(lower / size).astype(int)
    return Mesh([tuple(int(x) for x in cell)
                 for cell in np.hstack((level, index))])


def draw_panel(axes, mesh, cells, kinds, title):
    for cell in cells:
        x, y = mesh.point(cell)
        size = 1 << (mesh.finest - cell[0])
        color = "#D6E8F3" if cell in mesh.refined else "white"
        axes.add_patch(plt.Rectangle((x, y), size, size, facecolor=color,
                                     edgecolor="0.6", linewidth=0.6, zorder=1))
    for kind, (color, marker, size, filled) in MARKERS.items():
        points = [point for point, known in kinds.items() if known == kind]
        if points:
            axes.plot(*zip(*points), marker, color=color, markersize=size,
                      markerfacecolor=color if filled else "white",
                      markeredgewidth=1.3, zorder=3, clip_on=False)
    whole = 1 << mesh.finest
    axes.add_patch(plt.Rectangle((0, 0), whole, whole, facecolor="none",
                                 edgecolor="0.8", linewidth=0.6, zorder=0))
    axes.set_xlim(-0.6, whole + 0.6)
    axes.set_ylim(-0.6, whole + 0.6)
    axes.set_aspect("equal")
    axes.axis("off")
    axes.set_title(title, fontsize=10, pad=2)


def draw(workshop):
    levels = 1 if workshop.quick else 2
    mesh = read_mesh(workshop.run(
        2, "raous", "local-smoothing", "Refinement/Strategy=adaptive",
        f"Refinement/Levels={levels}", "Refinement/Marking=0.5",
        "Output/Fields=true"), levels)
    kinds = mesh.kinds()
    figure, axes = plt.subplots(2, 3, figsize=(6.3, 5.0))
    figure.subplots_adjust(left=0.01, right=0.99, top=0.95, bottom=0.11,
                           wspace=0.08, hspace=0.14)
    panels = [("leaf", mesh.active, "leaf mesh")]
    for level in reversed(range(mesh.finest + 1)):
        panels.append((level, mesh.cells(level), f"level {level}"))
    for place in axes.flat:
        place.axis("off")
    for place, (key, cells, title) in zip(axes.flat, panels):
        draw_panel(place, mesh, cells, kinds[key], title)
    names = {"relaxed": "relaxed", "own": "residual enters",
             "edge": "the same, at the edge", "hanging": "hanging"}
    figure.legend(handles=[plt.Line2D(
        [], [], color=color, marker=marker, markersize=size, linestyle="none",
        markerfacecolor=color if filled else "white", markeredgewidth=1.3,
        label=names[kind])
        for kind, (color, marker, size, filled) in MARKERS.items()],
        loc="lower center", ncols=4, fontsize=10, handletextpad=0.1,
        columnspacing=1.2)
    workshop.save(figure, "local-smoothing")
