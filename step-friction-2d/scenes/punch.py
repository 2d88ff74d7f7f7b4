#!/usr/bin/env python3
"""Writes punch.msh, the mesh of the scene 'punch', in Gmsh's format 2.2:

    python3 punch.py > punch.msh

A punch of width 2 whose lower face is flat for |x| < 0.5 and bends upwards from
there, with radius 1; it has a hole of radius 0.2. Columns of quadrilaterals,
and rings of them in a square around the hole. The columns are narrow under the
bend, because refinement of a mesh from a file does not know that an edge of
it was meant to be round.
"""
from math import atan2, cos, sin, sqrt

CENTRE, RADIUS, HALF = 0.65, 0.2, 0.4
TOP, RINGS = 1.2, 4
CONTACT, UPPER, HOLE, SIDES = 1, 2, 3, 4

xs = [-1 + 0.025 * i for i in range(20)] + [-0.5 + 0.1 * i for i in range(10)]
xs += [0.5 + 0.025 * i for i in range(21)]
left, right = 21, 29  # columns of the square


def bottom(x):
    beyond = max(0.0, abs(x) - 0.5)
    return 1 - sqrt(1 - beyond**2)


nodes, quads, lines = [], [], []


def node(x, y):
    nodes.append((x, y))
    return len(nodes)


square_bottom, square_top = CENTRE - HALF, CENTRE + HALF
grid = []
for x in xs:
    b = bottom(x)
    ys = [b + (square_bottom - b) * j / 4 for j in range(4)]
    ys += [square_bottom + 0.1 * j for j in range(8)]
    ys += [square_top + (TOP - square_top) * j / 2 for j in range(3)]
    grid.append(ys)
low, high = 4, 12  # rows of the square
columns, rows = len(xs), len(grid[0])
number = {}
for i in range(columns):
    for j in range(rows):
        if not (left < i < right and low < j < high):
            number[i, j] = node(xs[i], grid[i][j])
for i in range(columns - 1):
    for j in range(rows - 1):
        if not (left <= i < right and low <= j < high):
            quads.append([number[i, j], number[i + 1, j],
                          number[i + 1, j + 1], number[i, j + 1]])
for i in range(columns - 1):
    lines.append((CONTACT, number[i, 0], number[i + 1, 0]))
    lines.append((UPPER, number[i, rows - 1], number[i + 1, rows - 1]))
for j in range(rows - 1):
    for i in (0, columns - 1):
        lines.append((SIDES, number[i, j], number[i, j + 1]))

# Around the square, anticlockwise, and inwards to the hole.
rim = [(i, low) for i in range(left, right)]
rim += [(right, j) for j in range(low, high)]
rim += [(i, high) for i in range(right, left, -1)]
rim += [(left, j) for j in range(high, low, -1)]
outer = [number[p] for p in rim]
for ring in range(1, RINGS + 1):
    inner = []
    for i, j in rim:
        x, y = xs[i], grid[i][j] - CENTRE
        angle, share = atan2(y, x), ring / RINGS
        inner.append(node((1 - share) * x + share * RADIUS * cos(angle),
                          CENTRE + (1 - share) * y
                          + share * RADIUS * sin(angle)))
    n = len(rim)
    for k in range(n):
        quads.append([outer[k], outer[(k + 1) % n],
                      inner[(k + 1) % n], inner[k]])
    outer = inner
for k in range(len(outer)):
    lines.append((HOLE, outer[k], outer[(k + 1) % len(outer)]))

print("$MeshFormat\n2.2 0 8\n$EndMeshFormat")
print("$PhysicalNames\n5")
for identity, name in ((CONTACT, "contact"), (UPPER, "top"), (HOLE, "hole"),
                       (SIDES, "sides")):
    print(f'1 {identity} "{name}"')
print('2 0 "punch"\n$EndPhysicalNames')
print(f"$Nodes\n{len(nodes)}")
for k, (x, y) in enumerate(nodes):
    print(k + 1, f"{x:.12g} {y:.12g} 0")
print(f"$EndNodes\n$Elements\n{len(lines) + len(quads)}")
for k, (identity, a, b) in enumerate(lines):
    print(k + 1, 1, 2, identity, identity, a, b)
for k, quad in enumerate(quads):
    print(len(lines) + k + 1, 3, 2, 0, 5, *quad)
print("$EndElements")
