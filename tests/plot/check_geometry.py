"""Surfaces with hanging nodes, the boundary as a line and as a map, the merging of
pieces: on meshes that are made here, against closed forms. Needs no program."""

import sys

from workshop import PLOT  # noqa: F401

import numpy as np

import body
import boundary
import draw_run
import fields

failures = 0


def check(condition, what, detail=""):
    global failures
    if not condition:
        failures += 1
    print(f"{'ok    ' if condition else 'FAILED'}  {what} {'' if condition else detail}")


def cube(refined):
    """A unit cube of 2^3 cells, those in `refined` cut in eight: points and cells."""
    points, numbers, cells = [], {}, []

    def point(place):
        key = tuple(np.round(np.array(place) * 4).astype(int))
        if key not in numbers:
            numbers[key] = len(points)
            points.append(np.array(key) / 4)
        return numbers[key]

    def add(corner, size):
        order = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0),
                 (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
        cells.append([point(corner + size * np.array(o)) for o in order])

    for i in np.ndindex(2, 2, 2):
        corner = np.array(i) / 2
        if i in refined:
            for j in np.ndindex(2, 2, 2):
                add(corner + np.array(j) / 4, 0.25)
        else:
            add(corner, 0.5)
    return np.array(points), np.array(cells)


def test_surface():
    for refined in ([], [(0, 0, 0)], [(0, 0, 0), (1, 1, 1)],
                    [(0, 0, 0), (1, 0, 0), (0, 1, 0)], list(np.ndindex(2, 2, 2))):
        points, cells = cube(refined)
        faces, owner = body.surface(cells)
        corners = points[faces]
        areas = np.linalg.norm(np.cross(corners[:, 2] - corners[:, 0],
                                        corners[:, 3] - corners[:, 1]), axis=1) / 2
        outside = ((corners == 0).all(axis=1) | (corners == 1).all(axis=1)).any(axis=1)
        check(abs(areas.sum() - 6) < 1e-12 and outside.all(),
              f"the surface of a cube with {len(refined)} refined cells",
              f"{areas.sum()} {np.sum(~outside)}")
        check(all(set(face) <= set(cells[cell]) for face, cell in zip(faces, owner)),
              "  and the cells of its faces")


def test_merged():
    points, cells = cube([(0, 0, 0)])
    alone = points[cells].reshape(-1, 3)
    mesh = fields.merged(alone, np.arange(len(alone)).reshape(-1, 8),
                         {"u": alone @ [1, 2, 3]}, {"v": np.arange(len(cells))})
    check(len(mesh.points) == len(points), "corners at one place are one point")
    check(np.allclose(mesh.points[mesh.cells], points[cells])
          and np.allclose(mesh.of_points["u"], mesh.points @ [1, 2, 3]),
          "  with their cells and values")
    average = fields.nodal_average(np.array([[0, 1], [1, 2]]), np.array([1., 3.]))
    check(np.allclose(average, [1, 2, 3]), "values of cells, averaged in points")


def line_nodes(points, normals):
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    measure = np.zeros(len(points))
    measure[:-1] += steps / 2
    measure[1:] += steps / 2
    return {"point": points, "normal": normals, "measure": measure,
            "state": np.ones(len(points), int)}


def shuffled(nodes, seed):
    order = np.random.default_rng(seed).permutation(len(nodes["point"]))
    return {name: values[order] for name, values in nodes.items()}


def test_line():
    # An arc with a mesh that gets finer by halves, in any order.
    angles = [0.]
    step = 0.1
    while angles[-1] < 2.8:
        step = 0.1 if abs(angles[-1] - 1.4) > 0.5 else 0.0125
        angles.append(angles[-1] + step)
    angles = np.array(angles) - 1.4
    normals = np.stack([np.sin(angles), -np.cos(angles)], axis=1)
    nodes = line_nodes(2 * normals, normals)
    length = np.concatenate([[0], np.cumsum(
        np.linalg.norm(np.diff(nodes["point"], axis=0), axis=1))])
    for seed in range(3):
        mixed = shuffled(nodes, seed)
        line = boundary.Line(mixed, np.abs(mixed["point"][:, 0]) < 1.)
        check(len(line.pieces) == 1 and line.name == "x"
              and np.array_equal(line.place, mixed["point"][:, 0])
              and (np.diff(line.place[line.pieces[0]]) > 0).all()
              and (line.tangent[:, 0] > 0).all(), "near the pole an arc is a graph over x")
        line = boundary.Line(mixed, np.ones(len(angles), bool))
        places = np.sort(line.place)
        check(line.name.startswith("length") and np.allclose(places, length)
              and np.array_equal(np.argsort(line.place),
                                 np.argsort(mixed["point"][:, 0])),
              "all of it is as long as it is")
    # The same with so many nodes that not all of them are compared.
    few, boundary.FEW_NODES = boundary.FEW_NODES, 10
    same = boundary.chains(mixed["point"].copy(), mixed["measure"])
    boundary.FEW_NODES = few
    check(len(same) == 1 and np.array_equal(
        np.sort(same[0]), np.arange(len(angles))) and len(set(np.sign(
            np.diff(mixed["point"][same[0], 0])))) == 1, "also if they are many")
    # A ring, fine below and coarse above.
    around = np.concatenate([np.linspace(0, np.pi, 40, endpoint=False),
                             np.linspace(np.pi, 2 * np.pi, 3000, endpoint=False)])
    ring = np.stack([np.cos(around), np.sin(around)], axis=1)
    length = np.linalg.norm(np.roll(ring, -1, axis=0) - ring, axis=1)
    for piece in [boundary.chains(ring, (length + np.roll(length, 1)) / 2)]:
        check(len(piece) == 1 and (np.abs(np.diff(piece[0])) % (len(ring) - 2) == 1).all(),
              "a ring is one piece")
    # Two pieces.
    left = {name: values[angles < -0.3] for name, values in nodes.items()}
    right = {name: values[angles > 0.3] for name, values in nodes.items()}
    both = shuffled({name: np.concatenate([left[name], right[name]]) for name in left}, 1)
    check(sorted(map(len, boundary.chains(both["point"], both["measure"])))
          == sorted([len(left["point"]), len(right["point"])]),
          "two pieces of a boundary are two")


def test_chart():
    random = np.random.default_rng(0)
    # Of a cylinder whose axis lies askew, a hole and a rod.
    axis = np.array([1., 2., -1.]) / np.sqrt(6)
    across = np.cross(axis, [0, 0, 1])
    across /= np.linalg.norm(across)
    third = np.cross(axis, across)
    for sign, what in ((1, "rod"), (-1, "hole")):
        angle, along = random.uniform(-1, 1, 200), random.uniform(0, 5, 200)
        radial = np.outer(np.cos(angle), across) + np.outer(np.sin(angle), third)
        points = np.array([3., 1., 4.]) + np.outer(along, axis) + 2 * radial
        chart = boundary.Chart(points, sign * radial, np.array([0., 1, 0]))
        place = chart.place(points)
        expected = np.stack([along, 2 * angle], axis=1)
        # Up to shifts and directions of the coordinates.
        difference = [min(np.ptp(place[:, c] - expected[:, c]),
                          np.ptp(place[:, c] + expected[:, c])) for c in (0, 1)]
        check(max(difference) < 1e-9, f"a {what} is unrolled", difference)
        # A step along a tangent is a step on the map.
        h = 1e-6
        tangent = np.cross(axis, radial)
        moved = chart.place(points + h * tangent)
        check(np.allclose((moved - place) / h,
                          chart.components(sign * radial, tangent), atol=1e-4),
              "  and arrows point where steps go")
    flat = np.stack([random.uniform(0, 1, 50), np.zeros(50),
                     random.uniform(0, 1, 50)], axis=1)
    chart = boundary.Chart(flat, np.tile([0., -1, 0], (50, 1)), np.array([0., 1, 0]))
    check(chart.names == ["x", "z"] and np.allclose(chart.place(flat), flat[:, [0, 2]]),
          "a plane keeps its coordinates")
    ball = random.normal(size=(80, 3)) * 0.2 + [0, 0, -1]
    ball /= np.linalg.norm(ball, axis=1)[:, None]
    chart = boundary.Chart(ball, ball, np.array([0., 1, 0]))
    check(chart.circle is None, "a ball is seen along its normal")


def test_sections():
    """Bottom and top of a cube are two contact boundaries, with hanging nodes; on the
    top more nodes touch."""
    points, cells = cube([(0, 0, 1), (1, 0, 0)])
    quadrilaterals, _ = body.surface(cells)
    level = points[quadrilaterals][:, :, 2]
    quadrilaterals = quadrilaterals[(level == 0).all(axis=1) | (level == 1).all(axis=1)]
    faces = fields.Mesh(points, quadrilaterals, {"pressure": points[:, 2]},
                        {"place": points[quadrilaterals].mean(axis=1)})
    # Those between coarse and fine cells hang.
    free = np.array([i for i in np.unique(quadrilaterals) if not (
        (points[i] * 4 % 2).any() and (points[i, :2] == 0.5).any())])
    at_top = points[free, 2] == 1
    nodes = {"point": points[free], "section": np.where(at_top, 2, 1),
             "state": np.where(at_top | (points[free, 0] == 0), 1, 0)}
    own, top, section = draw_run.of_one_section(nodes, faces)
    corners = top.points[top.cells]
    areas = np.linalg.norm(np.cross(corners[:, 2] - corners[:, 0],
                                    corners[:, 3] - corners[:, 1]), axis=1) / 2
    check(section == 2 and (own["point"][:, 2] == 1).all()
          and len(own["point"]) == at_top.sum() < (points[:, 2] == 1).sum(),
          "of several contact boundaries one is drawn")
    check((top.points[:, 2] == 1).all() and abs(areas.sum() - 1) < 1e-12
          and (top.of_points["pressure"] == 1).all()
          and np.allclose(top.of_cells["place"], corners.mean(axis=1)),
          "all faces of it, and no others", f"{areas.sum()}")
    del nodes["section"]
    same = draw_run.of_one_section(nodes, faces)
    check(same[0] is nodes and same[1] is faces and same[2] is None,
          "where there is one, nothing is chosen")


test_surface()
test_merged()
test_sections()
test_line()
test_chart()
sys.exit(failures > 0)
