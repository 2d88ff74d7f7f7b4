"""Mesh files, most of which are not what they should be."""
import os

from gmsh_writer import HEX, LINE, LINE3, QUAD, QUAD9, TRIANGLE, write_mesh

SQUARE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
EDGES = [(LINE, 1, (4, 1)), (LINE, 2, (2, 3)), (LINE, 3, (1, 2)), (LINE, 4, (3, 4))]
CELL = [(QUAD, 10, (1, 2, 3, 4))]
CUBE = [(x, y, z) for z in (0, 1) for x, y, _ in SQUARE]
FACES = [(QUAD, 4, (1, 2, 3, 4)), (QUAD, 5, (5, 6, 7, 8)), (QUAD, 1, (1, 2, 6, 5)),
         (QUAD, 1, (2, 3, 7, 6)), (QUAD, 1, (3, 4, 8, 7)), (QUAD, 1, (4, 1, 5, 8))]


def moved(points, *by):
    return [tuple(a + b for a, b in zip(p, by)) for p in points]


def renumbered(elements, offset, ids):
    return [(kind, ids.get(i, i), tuple(offset + v for v in vertices))
            for kind, i, vertices in elements]


def make_meshes():
    square = EDGES + CELL
    write_mesh('square.msh', SQUARE, square)
    named = [(1, 3, 'floor'), (1, 4, 'top plate'), (2, 10, 'body')]
    for version in '2.2', '4.1':
        for binary in False, True:
            write_mesh('square-%s-%s.msh' % (version, 'binary' if binary else 'text'),
                       SQUARE, square, named, version, binary)
    for binary in False, True:
        write_mesh('cube-%s.msh' % ('binary' if binary else 'text'), CUBE,
                   FACES + [(HEX, 10, tuple(range(1, 9)))],
                   [(2, 4, 'floor'), (2, 5, 'top')], '4.1', binary)
    # Far away, in two cells one of which is a needle, and tiny.
    write_mesh('far.msh', moved(SQUARE, 1e10, 0, 0), square)
    write_mesh('needle.msh', [(x, y, 0) for y in (0, 1) for x in (0, 1e-10, 1)],
               [(LINE, 1, (4, 1)), (LINE, 3, (1, 2)), (LINE, 3, (2, 3)),
                (LINE, 2, (3, 6)), (LINE, 4, (6, 5)), (LINE, 4, (5, 4)),
                (QUAD, 10, (1, 2, 5, 4)), (QUAD, 10, (2, 3, 6, 5))])
    write_mesh('tiny.msh', [tuple(1e-160 * c for c in p) for p in SQUARE], square)
    # Two blocks that have nothing, a vertex, or an edge in common.
    other = {1: 6, 2: 7, 3: 8, 4: 9, 10: 11}
    write_mesh('two.msh', SQUARE + moved(SQUARE, 2, 0, 0),
               square + renumbered(square, 4, other))
    write_mesh('two-held.msh', SQUARE + moved(SQUARE, 2, 0, 0),
               square + renumbered(square, 4, {}))
    write_mesh('vertex.msh', SQUARE + [(2, 1, 0), (2, 2, 0), (1, 2, 0)],
               square + [(LINE, 5, (3, 5)), (QUAD, 11, (3, 5, 6, 7))])
    # An arch over a bar: they meet in both ends of the arch.
    write_mesh('arch.msh', [(x, y, 0) for y in (0, 1) for x in (0, 1.5, 3)] +
               [(1.5, 1.5, 0), (0, 2, 0), (1.5, 2.5, 0), (3, 2, 0)],
               [(LINE, 3, (1, 2)), (LINE, 3, (2, 3)), (LINE, 4, (4, 1)),
                (QUAD, 10, (1, 2, 5, 4)), (QUAD, 10, (2, 3, 6, 5)),
                (QUAD, 11, (4, 7, 9, 8)), (QUAD, 11, (7, 6, 10, 9))])
    hexahedron = FACES + [(HEX, 10, tuple(range(1, 9)))]
    hinge = {9: 3, 12: 5, 13: 7, 16: 8}
    upper = moved(CUBE, 1, 1, 0)
    # Vertices 1 and 5 of the second cube are 3 and 7 of the first.
    number = {1: 3, 5: 7}
    points = list(CUBE)
    for v in range(1, 9):
        if v not in number:
            points.append(upper[v - 1])
            number[v] = len(points)
    write_mesh('edge-3d.msh', points, hexahedron + [
        (kind, {4: 14, 5: 15, 1: 11, 10: 20}[i], tuple(number[v] for v in vertices))
        for kind, i, vertices in hexahedron])
    # Cells.
    write_mesh('folded.msh', [(0, 0, 0), (1, 0, 0), (.2, .2, 0), (0, 1, 0)], square)
    write_mesh('bow-tie.msh', [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)], square)
    write_mesh('clockwise.msh', [(0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0)],
               [(LINE, 1, (1, 2)), (LINE, 2, (3, 4)), (LINE, 3, (4, 1)),
                (LINE, 4, (2, 3))] + CELL)
    write_mesh('repeated.msh', SQUARE, EDGES + [(QUAD, 10, (1, 2, 3, 3))])
    write_mesh('flat.msh', [(i, 0, 0) for i in range(4)], square)
    write_mesh('no-plane.msh', SQUARE[:2] + [(1, 1, .5), (0, 1, 0)], square)
    write_mesh('not-a-number.msh', SQUARE[:2] + [(1, float('nan'), 0), (0, 1, 0)],
               square)
    write_mesh('triangles.msh', SQUARE,
               EDGES + [(TRIANGLE, 10, (1, 2, 3)), (TRIANGLE, 10, (1, 3, 4))])
    write_mesh('triangle.msh', SQUARE + [(2, .5, 0)],
               square + [(TRIANGLE, 10, (2, 5, 3))])
    write_mesh('second-order.msh',
               SQUARE + [(.5, 0, 0), (1, .5, 0), (.5, 1, 0), (0, .5, 0), (.5, .5, 0)],
               [(LINE3, 3, (1, 2, 5)), (QUAD9, 10, tuple(range(1, 10)))])
    write_mesh('lines.msh', SQUARE, EDGES)
    write_mesh('overlap.msh', SQUARE + [(.5, 1.5, 0), (.4, 1.5, 0), (1.6, 1.6, 0)],
               square + [(QUAD, 10, (4, 3, 7, 6)), (QUAD, 10, (4, 3, 5, 6))])
    for name, vertices, cube in [
            ('twisted', (1, 2, 3, 4, 7, 8, 5, 6), CUBE),
            ('inverted', (5, 6, 7, 8, 1, 2, 3, 4), CUBE),
            ('folded-3d', tuple(range(1, 9)), CUBE[:6] + [(.1, .1, .2)] + CUBE[7:])]:
        write_mesh(name + '.msh', cube, FACES + [(HEX, 10, vertices)])
    # Groups.
    write_mesh('no-groups.msh', SQUARE, [(kind, 0, v) for kind, _, v in square])
    write_mesh('two-groups.msh', SQUARE, square + [(LINE, 9, (1, 2))])
    strip = [(x, y, 0) for y in (0, 1) for x in (0, 1, 2)]
    long_edges = [(LINE, 3, (1, 2)), (LINE, 3, (2, 3)), (LINE, 4, (5, 4)),
                  (LINE, 4, (6, 5))]
    cells = [(QUAD, 1, (1, 2, 5, 4)), (QUAD, 2, (2, 3, 6, 5))]
    write_mesh('interior.msh', strip, long_edges + [(LINE, 8, (2, 5))] + cells)
    write_mesh('partly-inside.msh', strip,
               long_edges + [(LINE, 8, (1, 4)), (LINE, 8, (2, 5))] + cells)
    write_mesh('partly-inside-3d.msh', CUBE + moved(CUBE[4:], 0, 0, 1), FACES[:1] + [
        (QUAD, 4, (5, 6, 7, 8)), (QUAD, 5, (9, 10, 11, 12)),
        (HEX, 10, tuple(range(1, 9))), (HEX, 10, tuple(range(5, 13)))])
    # The right half of the bottom has an id of its own.
    write_mesh('half-bottom.msh', strip, [(LINE, 3, (1, 2)), (LINE, 9, (2, 3))] +
               long_edges[2:] + cells)
    # Two cells beside one, which has no node in the middle of the edge that they share.
    write_mesh('seam.msh', [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0, 0),
                            (2, .5, 0), (1, .5, 0), (2, 1, 0)],
               [(LINE, 3, (1, 2)), (LINE, 3, (2, 5)), (LINE, 4, (3, 4)),
                (LINE, 4, (8, 3)), (QUAD, 1, (1, 2, 3, 4)), (QUAD, 1, (2, 5, 6, 7)),
                (QUAD, 1, (7, 6, 8, 3))])
    # The same in three dimensions: four cubes on one, which meet in one of its faces.
    lower = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    upper = [(x / 2, y / 2, z) for z in (1, 2) for y in range(3) for x in range(3)]
    points = lower + [p for p in upper if p not in lower]
    at = {p: i + 1 for i, p in enumerate(points)}

    def cuboid(x, y, z, size):
        return tuple(at[p] for dz in (0, 1) for p in (
            (x, y, z + dz), (x + size, y, z + dz), (x + size, y + size, z + dz),
            (x, y + size, z + dz)))
    fine = [cuboid(x, y, 1, .5) for x in (0, .5) for y in (0, .5)]
    below = cuboid(0, 0, 0, 1)
    write_mesh('seam-3d.msh', points, [(QUAD, 4, below[:4])] + [
        (QUAD, 5, c[4:]) for c in fine] + [(HEX, 10, c) for c in [below] + fine])
    write_mesh('one-name.msh', SQUARE, square, [(1, 3, 'floor'), (1, 4, 'floor')])
    write_mesh('number.msh', SQUARE, square, [(1, 1, '3')])
    os.mkdir('folder.msh')
    write_mesh('twice.msh', strip, long_edges + cells + [(QUAD, 7, (1, 2, 5, 4))])
    # The two cells have vertices of their own in the middle.
    write_mesh('crack.msh', strip + [(1, 0, 0), (1, 1, 0)],
               [(LINE, 3, (1, 2)), (LINE, 3, (7, 3)), (LINE, 4, (5, 4)),
                (LINE, 4, (6, 8)), (QUAD, 1, (1, 2, 5, 4)), (QUAD, 2, (7, 3, 6, 8))])
    # A bottom of edges of 20 degrees.
    arc = [(-1, .2, 0), (0, 0, 0), (1, .2, 0)]
    top = [(-1, 1, 0), (0, 1, 0), (1, 1, 0)]
    write_mesh('polygon.msh', arc + top, long_edges + cells)
    write_mesh('negative.msh', SQUARE, [(kind, -i if kind == LINE and i < 3 else i, v)
                                        for kind, i, v in square])
    write_mesh('twice-turned.msh', SQUARE, square + [(QUAD, 7, (2, 3, 4, 1))])
    columns = [(x, y, 0) for x in (0, 1, .6, 1.7) for y in (0, 1)]
    write_mesh('folded-over.msh', columns, [
        (LINE, 3, (1, 3)), (LINE, 4, (2, 4)), (QUAD, 1, (1, 3, 4, 2)),
        (QUAD, 1, (3, 5, 6, 4)), (QUAD, 1, (5, 7, 8, 6))])
    # Files.
    with open('square.msh', 'rb') as f:
        good = f.read()
    with open('comments.msh', 'wb') as f:
        f.write(b'\xef\xbb\xbf$Comments\nof a user\n$EndComments\n\n' +
                good.replace(b'\n', b'\r\n'))
    with open('partitioned.msh', 'wb') as f:
        f.write(good.replace(b'$Nodes', b'$PartitionedEntities\n0\n'
                             b'$EndPartitionedEntities\n$Nodes', 1))
    for name, content in [('text', b'This is no mesh.\n'), ('empty', b''),
                          ('half', good[:len(good) // 2]),
                          ('version', good.replace(b'2.2 0 8', b'4 0 8')),
                          ('no-elements', good[:good.index(b'$Elements')]),
                          ('huge', good.replace(b'$Nodes\n4', b'$Nodes\n99999999999')),
                          ('no-node', good.replace(b'1 2 3 4', b'1 2 3 7')),
                          ('letters', good.replace(b'1 2 3 4', b'1 2 x 4'))]:
        with open(name + '.msh', 'wb') as f:
            f.write(content)
    with open('square-4.1-binary.msh', 'rb') as f:
        binary = f.read()
    with open('half-binary.msh', 'wb') as f:
        f.write(binary[:2 * len(binary) // 3])
