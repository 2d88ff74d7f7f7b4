#!/usr/bin/env python3
"""Writes wall.msh, the mesh of the scene 'wall', in Gmsh's format 2.2:

    python3 wall.py > wall.msh

A unit square of eight by eight quadrilaterals without the one in the lower right
corner, so that no vertex belongs to the floor and to the wall.
"""
N = 8
FLOOR, WALL, TOP, LEFT, CORNER = 1, 2, 3, 4, 5
NAMES = ("floor", "wall", "top", "left", "corner")


def number(i, j):
    """Of a vertex; there is none at (N, 0)."""
    return 1 + i + (N + 1) * j - (j > 0)


def lines():
    """Boundary edges: id, and the numbers of their ends."""
    for k in range(N - 1):
        yield FLOOR, number(k, 0), number(k + 1, 0)
        yield WALL, number(N, k + 1), number(N, k + 2)
    for k in range(N):
        yield TOP, number(k + 1, N), number(k, N)
        yield LEFT, number(0, k + 1), number(0, k)
    yield CORNER, number(N - 1, 0), number(N - 1, 1)
    yield CORNER, number(N - 1, 1), number(N, 1)


elements = [f"1 2 {boundary} {boundary} {a} {b}" for boundary, a, b in lines()]
elements += [f"3 2 10 1 {number(i, j)} {number(i + 1, j)} {number(i + 1, j + 1)} "
             f"{number(i, j + 1)}" for j in range(N) for i in range(N)
             if (i, j) != (N - 1, 0)]
points = [(i / N, j / N) for j in range(N + 1) for i in range(N + 1) if (i, j) != (N, 0)]

print("$MeshFormat\n2.2 0 8\n$EndMeshFormat")
print(f"$PhysicalNames\n{len(NAMES) + 1}")
for boundary, name in enumerate(NAMES, 1):
    print(f'1 {boundary} "{name}"')
print('2 10 "block"\n$EndPhysicalNames')
print(f"$Nodes\n{len(points)}")
for k, (x, y) in enumerate(points, 1):
    print(f"{k} {x:.12g} {y:.12g} 0")
print(f"$EndNodes\n$Elements\n{len(elements)}")
for k, element in enumerate(elements, 1):
    print(k, element)
print("$EndElements")
