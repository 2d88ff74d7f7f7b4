"""Scenes and meshes that are not what they should be: each is refused in a sentence,
or solved with a warning, and nothing wrong is solved without a word.

Usage: wrong_input.py PROGRAM_2D PROGRAM_3D

A case is a scene with overrides, and what is expected of it:
- error: exit status 2, one line on standard error that ends as a sentence does and
  in which a pattern is found, nothing on standard output, no file left behind;
- later error: the same, but in a history, which has printed the load step, and may
  have left files, complete ones, of those before;
- warning: exit status 0, and the only lines that begin with "Warning:" are those of
  the patterns, once each;
- good: exit status 0 without a warning.
"""
import math
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile

SCENES = {
    # A block of two cells, pressed onto a plane and held by its symmetry.
    'pressed': (2, {
        'Scene/Size': '2, 1', 'Scene/Subdivisions': '2, 1',
        'Obstacle/Kind': 'plane',
        'Boundary conditions/Displacement': '0: 0, free',
        'Boundary conditions/Traction': '3: 0, -0.01',
        'Contact/Boundary id': '2', 'Contact/Friction coefficient': '0.3'}),
    # The same, moved by its top.
    'moved': (2, {
        'Scene/Size': '2, 1', 'Scene/Subdivisions': '2, 1',
        'Obstacle/Kind': 'plane',
        'Boundary conditions/Displacement': '3: 0.01, -0.01',
        'Contact/Boundary id': '2', 'Contact/Friction coefficient': '0.3'}),
    # A mesh file: 1 left, 2 right, 3 bottom, 4 top, and the body 10.
    'mesh': (2, {
        'Scene/Geometry': 'mesh file', 'Obstacle/Kind': 'plane',
        'Boundary conditions/Displacement': '4: 0.01, -0.01',
        'Contact/Boundary id': '3', 'Contact/Friction coefficient': '0.3'}),
    'pressed 3d': (3, {
        'Obstacle/Kind': 'plane',
        'Boundary conditions/Displacement': '0: 0, free, free; 2: free, 0, free',
        'Boundary conditions/Traction': '5: 0, 0, -0.01',
        'Contact/Boundary id': '4', 'Contact/Friction coefficient': '0.3'}),
    # 1 the sides, 4 bottom, 5 top.
    'mesh 3d': (3, {
        'Scene/Geometry': 'mesh file', 'Obstacle/Kind': 'plane',
        'Boundary conditions/Displacement': '5: 0.01, 0, -0.01',
        'Contact/Boundary id': '4', 'Contact/Friction coefficient': '0.3'}),
}

LINE, TRIANGLE, QUAD, HEX, LINE3, QUAD9 = 1, 2, 3, 5, 8, 10


def write_mesh(name, nodes, elements, names=(), version='2.2', binary=False):
    """A file in Gmsh's format: nodes are points, elements (type, physical id, nodes
    from 1 on), names (dimension, id, name). In version 4.1 each element has an entity
    of its own."""
    dimension = {LINE: 1, TRIANGLE: 2, QUAD: 2, HEX: 3, LINE3: 1, QUAD9: 2}
    out = bytearray()

    def text(s):
        out.extend((s + '\n').encode())

    def numbers(kinds, *values):
        """As text, or in binary by the letters of struct."""
        if binary:
            out.extend(struct.pack('=' + kinds, *values))
        else:
            text(' '.join('%.17g' % v if k == 'd' else str(v)
                          for k, v in zip(kinds, values)))

    text('$MeshFormat')
    text('%s %d 8' % (version, binary))
    if binary:
        out.extend(struct.pack('=i', 1))
        text('')
    text('$EndMeshFormat')
    if names:
        text('$PhysicalNames')
        text(str(len(names)))
        for d, i, n in names:
            text('%d %d "%s"' % (d, i, n))
        text('$EndPhysicalNames')
    if version == '4.1':
        text('$Entities')
        of_dimension = [[k for k, e in enumerate(elements) if dimension[e[0]] == d]
                        for d in range(4)]
        numbers('qqqq', *[len(l) for l in of_dimension])
        for d in range(1, 4):
            for k in of_dimension[d]:
                physical = [elements[k][1]] if elements[k][1] else []
                numbers('idddddd' + 'q' + 'i' * len(physical) + 'q',
                        k + 1, 0., 0., 0., 1., 1., 1., len(physical), *physical, 0)
        if binary:
            text('')
        text('$EndEntities')
    text('$Nodes')
    if version == '4.1':
        numbers('qqqq', 1, len(nodes), 1, len(nodes))
        numbers('iiiq', 2, 1, 0, len(nodes))
        for i in range(len(nodes)):
            numbers('q', i + 1)
        for p in nodes:
            numbers('ddd', *p)
    else:
        text(str(len(nodes)))
        for i, p in enumerate(nodes):
            numbers('iddd', i + 1, *p)
    if binary:
        text('')
    text('$EndNodes')
    text('$Elements')
    if version == '4.1':
        numbers('qqqq', len(elements), len(elements), 1, len(elements))
        for k, (kind, _, vertices) in enumerate(elements):
            numbers('iiiq', dimension[kind], k + 1, kind, 1)
            numbers('q' * (1 + len(vertices)), k + 1, *vertices)
    else:
        text(str(len(elements)))
        for k, (kind, physical, vertices) in enumerate(elements):
            if binary:
                numbers('iii', kind, 1, 2)
                numbers('iii' + 'i' * len(vertices), k + 1, physical, 1, *vertices)
            else:
                numbers('iiiii' + 'i' * len(vertices),
                        k + 1, kind, 2, physical, 1, *vertices)
    if binary:
        text('')
    text('$EndElements')
    with open(name, 'wb') as f:
        f.write(out)


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


def mesh(name, **overrides):
    return dict({'Scene/Mesh file': name + '.msh'}, **overrides)


def ceiling(**overrides):
    """Something above the block of two cells, one away from it."""
    return dict({'Obstacle 2/Kind': 'plane', 'Obstacle 2/Point': '0, 2',
                 'Obstacle 2/Normal': '0, 1', 'Contact 2/Boundary id': '3'}, **overrides)


D, T, P, N = ('Boundary conditions/Displacement', 'Boundary conditions/Traction',
              'Boundary conditions/Pinned points', 'Contact/Contact normal')
BARE = "in the end no node of 'Contact 2' is in contact .* does 'Obstacle 2/Normal'"
B, G = 'Boundary conditions/Body force', 'Boundary conditions/Force'
R = 'Material/Regions'

# (number in the list of findings that it belongs to, name, scene, overrides,
#  what is expected, patterns)
CASES = [
    # 1. Parts that nothing holds.
    (1, 'part that is not held', 'mesh', mesh('two'), 'error',
     [r'part of the body in \(2, 0\) to \(3, 1\) .*physical id 11.* not held against '
      r'a displacement in x direction and a displacement in y direction and a '
      r'rotation around \(2.5, 0.5\)']),
    (1, 'part that is not held, with a load', 'mesh',
     mesh('two', **{B: '0, -0.01'}), 'error', ['part of the body in']),
    (1, 'part that only contact holds', 'mesh',
     mesh('two-held', **{D: '4: 0.01, -0.01'}), 'warning',
     ['the body consists of 2 parts that have no edge in common']),
    (1, 'parts joined in a vertex', 'mesh', mesh('vertex'), 'error',
     [r'in \(1, 1\) to \(2, 2\) .*share 1 vertex with the others, \(1, 1\), but parts '
      'are joined by edges only']),
    (1, 'parts joined in two vertices', 'mesh', mesh('arch'), 'error',
     [r'in \(0, 1\) to \(3, 2.5\) .*share 2 vertices with the others, one of them '
      r'\((0|3), 1\), but parts are joined by edges only']),
    (1, 'parts joined along an edge', 'mesh 3d', mesh('edge-3d'), 'error',
     [r'in \(1, 1, 0\) to \(2, 2, 1\) .*share 2 vertices with the others, one of them '
      r'\(1, 1, [01]\), but parts are joined by faces only.* not held against a '
      'displacement in any direction and a rotation around any axis']),
    (1, 'nothing is held', 'moved', {D: ''}, 'error',
     ['x direction and .*y direction and .*rotation|x direction']),
    (1, 'nothing is held in one direction', 'moved', {D: '3: free, -0.01'}, 'error',
     ['not held against a displacement in x direction']),
    (1, 'free rotation', 'moved', {D: '', P: '(0, 0): 0, 0', 'Obstacle/Kind': 'none',
                                   'Contact/Boundary id': '-1',
                                   'Contact/Friction coefficient': '0'}, 'error',
     [r'a rotation around \(0, 0\)']),
    (1, 'free rotation around an axis', 'pressed 3d',
     {D: '', P: '(0,0,0): 0, 0, 0; (0,0,1): 0, 0, 0', 'Obstacle/Kind': 'none', T: '',
      'Contact/Boundary id': '-1', 'Contact/Friction coefficient': '0'}, 'error',
     [r'a rotation around the axis through \(0, 0, .* in z direction']),
    (1, 'load away from the obstacle', 'pressed', {T: '3: 0, 0.01'}, 'error',
     ["scene 'scene': the body .*y direction: its loads push it there"]),
    (1, 'no load towards the obstacle', 'pressed', {T: ''}, 'error',
     ['not held against a displacement in y direction: neither']),
    (1, 'load that tips the body over', 'pressed',
     {D: '0: 0, free', T: '', B: '0, 0.02*(x-1.1)'}, 'good', []),
    (1, 'load towards the obstacle', 'pressed', {}, 'good', []),
    (1, 'load that only a finer mesh sees', 'pressed',
     {T: '3: 0, (abs(x-.6)<.1 ? -.001 : 0)'}, 'good', []),
    (1, 'load that a finer mesh sees the other way round', 'pressed',
     {'Scene/Size': '1, 1', 'Scene/Subdivisions': '1, 1',
      T: '3: 0, (abs(x-.5)<.05 ? -.001 : .0003)'}, 'error', ['its loads push it']),
    (1, 'discs smaller than a cell', 'pressed',
     {'Obstacle/Kind': 'rods', 'Obstacle/Centers': '.5, -.1; 1.5, -.1',
      'Obstacle/Radius': '.1', N: 'body', D: '0: 0, free'}, 'good', []),
    # What the normals of one surface hold only because they are oblique to the other
    # one, far from where the two touch.
    (1, 'straight edge on discs', 'pressed',
     {'Obstacle/Kind': 'rods', 'Obstacle/Centers': '.5, -.1; 1.5, -.1',
      'Obstacle/Radius': '.1', D: ''}, 'error',
     ['not held against a displacement in x direction: neither']),
    (1, 'straight edge far above a disc', 'pressed',
     {'Obstacle/Kind': 'rods', 'Obstacle/Centers': '1, -2', 'Obstacle/Radius': '1',
      D: '', P: '(0, 0): free, 0; (2, 0): free, 0'}, 'error',
     ['not held against a displacement in x direction']),
    (1, 'corners between discs', 'pressed',
     {'Obstacle/Kind': 'rods', 'Obstacle/Centers': '-.3, -.4; 2.3, -.4',
      'Obstacle/Radius': '.5', D: '', T: '3: 0, -.0001'}, 'good', []),
    (1, 'half disc with its own normals on a plane', 'pressed',
     {'Scene/Geometry': 'half disc', 'Scene/Size': '', 'Scene/Subdivisions': '',
      'Obstacle/Point': '0, -1', D: '', P: '(1, 0): free, 0', T: '1: 0, -.001',
      'Contact/Boundary id': '0', N: 'body'}, 'error',
     ['not held against a displacement in x direction: neither']),
    (1, 'half disc that is held sideways', 'pressed',
     {'Scene/Geometry': 'half disc', 'Scene/Size': '', 'Scene/Subdivisions': '',
      'Obstacle/Point': '0, -1', D: '', P: '(0, 0): 0, free', T: '1: 0, -.001',
      'Contact/Boundary id': '0'}, 'good', []),
    (1, 'tall body on a small foot', 'pressed',
     {'Scene/Size': '1, 1200', 'Scene/Subdivisions': '1, 300', D: '',
      P: '(0, 0): 0, free', T: '3: 0, -1e-9', 'Refinement/Initial refinements': '1'},
     'good', []),
    (2, 'obstacle above and below', 'moved',
     {'Scene/Size': '4, .1', 'Scene/Subdivisions': '8, 1', 'Obstacle/Kind': 'rods',
      'Obstacle/Centers': '2, -.5; 2, .75', 'Obstacle/Radius': '.5', D: '0: 0, 0',
      T: '1: 0, .00005', 'Contact/Boundary id': '3'}, 'warning',
     ['the largest displacement']),
    (2, 'disc beside a plane of symmetry', 'pressed',
     {'Scene/Size': '1, 1', 'Scene/Subdivisions': '2, 2', 'Obstacle/Kind': 'rods',
      'Obstacle/Centers': '.4, -.1', 'Obstacle/Radius': '.1', T: '',
      D: '0: 0, free; 3: 0, -.01'}, 'good', []),
    (1, 'weight on the obstacle', 'pressed', {T: '', B: '0, -0.01'}, 'good', []),
    (1, 'load towards the obstacle, 3D', 'pressed 3d', {}, 'good', []),
    (1, 'load past the obstacle, 3D', 'pressed 3d', {T: '5: 0, 0, 0.01'}, 'error',
     ['z direction: its loads push it there']),
    # 2. Normals.
    (2, 'normals of a body on a slope', 'moved',
     {'Obstacle/Normal': '0.26, -0.97', 'Obstacle/Point': '2, 0', N: 'body'}, 'warning',
     ['off that of the obstacle', 'away from the obstacle, or inside']),
    (2, 'normals of the obstacle there', 'moved',
     {'Obstacle/Normal': '0.26, -0.97', 'Obstacle/Point': '2, 0'}, 'good', []),
    # 4. Displacements that are not small.
    (4, 'dragged far away', 'moved', {D: '3: 3, -0.01', 'Obstacle/Kind': 'rods',
                                      'Obstacle/Centers': '1, -5',
                                      'Obstacle/Radius': '5'}, 'warning',
     ['the largest displacement is 3 ', 'away from the obstacle, or inside']),
    (4, 'large displacement', 'moved', {D: '3: 1, -0.01'}, 'warning',
     ['the largest displacement is 1 ']),
    # Forces that are given.
    (0, 'a force', 'moved', {G: '3: free, -0.02'}, 'good', []),
    (0, 'a force, and no displacement to begin with', 'moved', {G: '1: free, -0.02'},
     'error', ["boundary 1: 'Displacement' does not say where it begins"]),
    (0, 'a force of a component that is free', 'pressed', {G: '0: free, -0.01'},
     'error', ["'Displacement' leaves component 2 free"]),
    (0, 'a force that varies', 'moved', {G: '3: free, -0.02*x'}, 'error',
     ["a total force cannot depend on the place.*'0, -0.02.x' cannot be understood"]),
    (0, 'a force that varies, but not between two points', 'moved',
     {G: '3: free, -0.02 + 0*cos(x)', 'Scene/Definitions': 'r = x'}, 'error',
     ['a total force cannot depend on the place']),
    (0, 'a force that varies by a definition', 'moved',
     {G: '3: free, -r', 'Scene/Definitions': 'r = 0.02*(x < 1e-9)'}, 'error',
     ['a total force cannot depend on the place']),
    (0, 'a force that is no number later', 'moved',
     {G: '3: free, -0.02/(1-t)', 'Load steps/Times': '0, 1'}, 'error',
     ["Force': '0, -0.02/.1-t.' is -inf"]),
    (0, 'a force with a component too many', 'moved', {G: '3: free, -0.02, 0'}, 'error',
     ['needs 2 components, but has 3|2 components']),
    (0, 'two forces on a boundary', 'moved', {G: '3: free, -0.02; 3: 0, free'}, 'error',
     ['is there twice']),
    (0, 'a force in a turned scene', 'moved',
     {G: '3: free, -0.02', 'Scene/Rotation angle': '90',
      'Obstacle/Point': '0, 0', 'Obstacle/Normal': '0, -1'}, 'error',
     ['leaves a component free']),
    (0, 'a force of nothing', 'moved', {G: '3: free, free'}, 'error',
     ['all components are free']),
    (0, 'a force on what is partly held', 'moved',
     {D: '0: 0, free; 3: 0.01, -0.01', G: '3: 0.001, free'}, 'error',
     ['a part of it has its displacement in component 1 from another']),
    (0, 'a force on what is pinned', 'moved',
     {G: '3: free, -0.02', P: '(0, 1): free, -0.01'}, 'error',
     ['contradict each other in a vertex of boundary id 3']),
    (0, 'a force that is half an expression', 'moved', {G: '3: free, -0.02*'}, 'error',
     ["'Boundary conditions/Force': '0, -0.02\\*' cannot be understood"]),
    (0, 'a name like those of the program', 'moved',
     {'Scene/Constants': 'no_x = 1', G: '3: free, -0.02*no_x'}, 'error',
     ["'Scene/Constants': 'no_x' begins like names that the program needs"]),
    (0, 'a force that begins with zero', 'moved',
     {D: '3: 0, -0.01', G: '3: free, -0.02*t', 'Load steps/Times': '0, 1',
      'Refinement/Levels': '1'}, 'good', []),
    (0, 'a force that begins with zero, away from the obstacle', 'moved',
     {D: '3: 0, -0.06', G: '3: free, -0.02*t', 'Load steps/Times': '0, 1',
      'Obstacle/Point': '0, -0.05'}, 'good', []),
    (0, 'two forces that balance, and nothing else', 'moved',
     {D: '2: 0, 0.01; 3: 0, -0.01', G: '2: free, 0.02; 3: free, -0.02',
      'Obstacle/Kind': 'none', 'Contact/Boundary id': '-1',
      'Contact/Friction coefficient': '0'}, 'error',
     ["not held against a displacement in y direction: neither .*, and a boundary with a "
      "given force does not;"]),
    (0, 'two forces that balance, and a pin', 'moved',
     {D: '2: 0, 0.01; 3: 0, -0.01', G: '2: free, 0.02; 3: free, -0.02', P: '(0,0.5): 0, 0',
      'Scene/Subdivisions': '4, 2', 'Obstacle/Kind': 'none', 'Contact/Boundary id': '-1',
      'Contact/Friction coefficient': '0'}, 'warning', ['plain elasticity']),
    (0, 'a force that pulls', 'moved', {G: '3: free, 0.02'}, 'error',
     ['cannot be reached.*component 2 on boundary 3']),
    (0, 'a force that friction cannot bear', 'moved', {G: '3: 0.01, -0.02'}, 'error',
     ['cannot be reached.*component 1 on boundary 3']),
    # 5. Meshes.
    (5, 'folded cell', 'mesh', mesh('folded'), 'error',
     [r'folded quadrilateral number 5 around \(0.3, 0.3\)']),
    (5, 'bow tie', 'mesh', mesh('bow-tie'), 'error', ['folded quadrilateral']),
    (5, 'folded cell, 3D', 'mesh 3d', mesh('folded-3d'), 'error',
     ['folded hexahedron number 7']),
    (5, 'twisted cell', 'mesh 3d', mesh('twisted'), 'error', ['twisted']),
    (5, 'cell of one node twice', 'mesh', mesh('repeated'), 'error',
     ['same node twice']),
    (5, 'flat cell', 'mesh', mesh('flat'), 'error', ['flat']),
    (5, 'clockwise cell', 'mesh', mesh('clockwise'), 'good', []),
    (5, 'inverted cell', 'mesh 3d', mesh('inverted'), 'good', []),
    (5, 'three cells at an edge', 'mesh', mesh('overlap'), 'error',
     ['3 cells that share the edge']),
    (5, 'triangles', 'mesh', mesh('triangles'), 'error',
     ['has 2 triangles, but only quadrilaterals']),
    (5, 'one triangle', 'mesh', mesh('triangle'), 'error',
     ['has 1 triangle, but only quadrilaterals']),
    (5, 'second order', 'mesh', mesh('second-order'), 'error',
     ['Mesh.ElementOrder = 1']),
    (5, 'lines only', 'mesh', mesh('lines'), 'error', ['has no quadrilaterals']),
    (5, 'mesh of three dimensions', 'mesh', mesh('cube-text'), 'error',
     ['give the scene to step-friction-3d']),
    (5, 'mesh of two dimensions', 'mesh 3d', mesh('square'), 'error',
     ['give the scene to step-friction-2d']),
    (5, 'cell folded over its neighbour', 'mesh', mesh('folded-over'), 'error',
     ['two cells on the same side']),
    (5, 'negative ids', 'mesh', mesh('negative'), 'good', []),
    (5, 'cell in two groups, turned', 'mesh', mesh('twice-turned'), 'good', []),
    (5, 'partitioned', 'mesh', mesh('partitioned'), 'error', ['is partitioned']),
    (5, 'comments first', 'mesh', mesh('comments'), 'good', []),
    (5, 'interior curve', 'mesh', mesh('interior'), 'good', []),
    (5, 'interior curve that is used', 'mesh',
     mesh('interior', **{T: '8: 0, 0'}), 'error', ['lie inside the body']),
    (5, 'group that lies inside in part', 'mesh',
     mesh('partly-inside', **{D: '8: 0.01, -0.01'}), 'error',
     [r'physical id 8 .*boundary, but 1 edge of it inside the body, around \(1, 0.5\)']),
    (5, 'the same, but nothing uses it', 'mesh', mesh('partly-inside'), 'good', []),
    (5, 'group that lies inside in part, 3D', 'mesh 3d', mesh('partly-inside-3d'),
     'error', [r'1 face of it inside the body, around \(0.5, 0.5, 1\)']),
    (5, 'no groups', 'mesh', mesh('no-groups'), 'error',
     ['names boundary id 4, but the mesh has only 0']),
    (5, 'no groups, one boundary', 'mesh',
     mesh('no-groups', **{D: '', P: '(0, 1): 0, -.01; (1, 1): 0, -.01',
                          'Contact/Boundary id': '0'}), 'warning',
     ['pinned at .* bears a force']),
    (5, 'face in two groups', 'mesh', mesh('two-groups'), 'good', []),
    (5, 'face in two groups that are used', 'mesh',
     mesh('two-groups', **{T: '9: 0, 0'}), 'error', ['in the groups 3 and 9']),
    (5, 'cell in two groups', 'mesh', mesh('twice'), 'good', []),
    (5, 'names', 'mesh', mesh('square-2.2-text', **{
        D: 'top plate: 0.01, -0.01', 'Contact/Boundary id': 'floor'}), 'good', []),
    (5, 'unknown name', 'mesh',
     mesh('square-2.2-text', **{'Contact/Boundary id': 'flor'}), 'error',
     [r"which has 'floor' \(3\), 'top plate' \(4\)"]),
    (5, 'name without a mesh file', 'moved', {'Contact/Boundary id': 'floor'}, 'error',
     ["'floor' is no boundary id"]),
    (5, 'no mesh at all', 'mesh', mesh('text'), 'error', ["not in Gmsh's format"]),
    (5, 'empty file', 'mesh', mesh('empty'), 'error', ['nothing in the mesh file']),
    (5, 'missing file', 'mesh', mesh('missing'), 'error', ['cannot open']),
    (5, 'half a file', 'mesh', mesh('half'), 'error', ['ends in the middle|has no sec']),
    (5, 'half a binary file', 'mesh', mesh('half-binary'), 'error',
     ['ends in the middle|has no sec']),
    (5, 'another version', 'mesh', mesh('version'), 'error', ['version 4.0']),
    (5, 'no elements', 'mesh', mesh('no-elements'), 'error', ['no section .Elements']),
    (5, 'a number that is too large', 'mesh', mesh('huge'), 'error', ['there is more']),
    (5, 'a node that there is not', 'mesh', mesh('no-node'), 'error',
     ['number 7']),
    (5, 'letters', 'mesh', mesh('letters'), 'error', ['something else than a number']),
    (5, 'no number', 'mesh', mesh('not-a-number'), 'error', ['no number']),
    # 7. Entries that nothing uses.
    (7, 'mesh file without its geometry', 'moved', {'Scene/Mesh file': 'square.msh'},
     'error', ["set that to 'mesh file'"]),
    (7, 'entries that nothing uses', 'moved',
     {'Scene/Radius': '3', 'Obstacle/Radius': '3', 'Contact/Friction bound': '1',
      'Refinement/Marking': '.3', 'Output/Format': 'hdf5', 'Output/Fields': 'false'}, 'warning',
     ["'Scene/Radius' is not used", "'Obstacle/Radius' is not used",
      "'Contact/Friction bound' is not used", "'Refinement/Marking' is not used",
      "'Output/Format' is not used"]),
    (7, 'an entry twice', 'moved', {'Scene/Radius': '1\n  set Radius = 2'}, 'error',
     [r"scene.prm:(\d+): 'Scene/Radius' has been set already, by scene.prm:\d+; remove"]),
    (7, 'an entry twice, in two sections', 'moved',
     {'Contact/Boundary id': '2\nend\nsubsection Contact\n  set Boundary id = 2'},
     'error', ["'Contact/Boundary id' has been set already, by scene.prm"]),
    (7, 'marking of everything', 'moved', {'Refinement/Marking': '0'}, 'error',
     ["'0' is no value for 'Refinement/Marking'; give a number v such that 0 < v <= 1"]),
    (7, 'coefficient without its law', 'moved', {'Contact/Friction law': 'none'},
     'warning', ["'Contact/Friction coefficient' is not used"]),
    (7, 'constants and definitions that nothing uses', 'moved',
     {'Scene/Constants': 'a = 1; b = 2*a; push = 3', 'Scene/Definitions':
      'r = x; s = r', T: '1: 0, -0.0001*push'}, 'warning',
     ["'Scene/Constants' says what 'b' is, which nothing uses",
      "'Scene/Definitions' says what 's' is, which nothing uses"]),
    (7, 'entries of another algorithm', 'moved',
     {'Solver/Outer damping': '0.5', 'Solver/Mixed outer iterations': '3',
      'Solver/Outer tolerance': '1e-5', 'Solver/Total cycles': '100',
      'Solver/Safeguards': 'false', 'Solver/Recombined steps': '2',
      'Solver/Coarse correction': 'monotone'}, 'warning',
     ["'Solver/Outer damping' is not used", "'Solver/Mixed outer iterations' is not used",
      "'Solver/Outer tolerance' is not used", "'Solver/Total cycles' is not used",
      "'Solver/Recombined steps' is not used"]),
    (7, 'entries of Algorithm 2 that safeguards use', 'moved',
     {'Solver/Outer tolerance': '1e-5', 'Solver/Maximum outer iterations': '20'}, 'good',
     []),
    (7, 'coefficient in an expression', 'moved',
     {'Contact/Friction law': 'Tresca', 'Contact/Friction bound': '0.01*F'}, 'good',
     []),
    # 9. Loads.
    (9, 'not a number in a load', 'pressed', {B: 'sqrt(x-1), 0'}, 'error',
     [r"'sqrt\(x-1\), 0' is not a number at \(0"]),
    (9, 'division by zero in a traction', 'pressed', {T: '3: 0, -1/(y-1)'}, 'error',
     [r'inf at \(.*, 1\)']),
    (9, 'division by zero in a displacement', 'moved', {D: '3: 0.01/x, -0.01'}, 'error',
     [r'inf at \(0, 1\)']),
    (9, 'division by zero in a bound', 'moved',
     {'Contact/Friction law': 'Tresca', 'Contact/Friction bound': 'F/x'}, 'error',
     [r"'F/x' is inf at \(0, 0\)"]),
    (9, 'negative bound', 'moved',
     {'Contact/Friction law': 'Tresca', 'Contact/Friction bound': '-F'}, 'error',
     [r"Friction bound': '-F' is -0.3 at \(.*, 0\), where a number from 0 up to"]),
    (9, 'negative coefficient', 'moved', {'Contact/Friction coefficient': 'x - 1'},
     'error', [r"Friction coefficient': 'x - 1' is -.* at \(.*, 0\), where a number from"]),
    (9, 'coefficient that is not a number', 'moved',
     {'Contact/Friction coefficient': 'sqrt(x - 1)'}, 'error',
     [r"'sqrt\(x - 1\)' is not a number at \(.*, 0\)"]),
    (9, 'coefficient that is not a number in three dimensions', 'pressed 3d',
     {'Contact/Friction coefficient': '0.3/y'}, 'error', [r'inf at \(.*, 0, 0\)']),
    (9, 'coefficient of a name that is not there', 'moved',
     {'Contact/Friction coefficient': '0.3*much'}, 'error',
     ["'Contact/Friction coefficient': '0.3.much' cannot be understood"]),
    (9, 'coefficient that is a vector', 'moved',
     {'Contact/Friction coefficient': '0.3, 0.4'}, 'error', ['several values']),
    (9, 'coefficient of itself', 'moved',
     {'Contact/Friction coefficient': '2*F'}, 'error', ['cannot be understood']),
    (9, 'coefficient of a definition that uses it', 'moved',
     {'Contact/Friction coefficient': '0.3*f', 'Scene/Definitions': 'f = F/0.3'},
     'error', ['cannot be understood']),
    (9, 'constant that uses a coefficient that varies', 'moved',
     {'Contact/Friction coefficient': '0.3*x', 'Scene/Constants': 'c = 2*F'},
     'error', ["'2.F' cannot be understood"]),
    (9, 'coefficient in z in two dimensions', 'moved',
     {'Contact/Friction coefficient': '0.3*z'}, 'error', ['cannot be understood']),
    (9, 'coefficient that varies', 'moved',
     {'Contact/Friction coefficient': '0.1*r', 'Scene/Definitions': 'r = x + a',
      'Scene/Constants': 'a = 1', T: '1: 0, -0.001*F'}, 'good', []),
    (9, 'coefficient that is too large somewhere', 'moved',
     {'Contact/Friction coefficient': 'x'}, 'warning', ['friction 2 is above']),
    (9, 'coefficient that varies without its law', 'moved',
     {'Contact/Friction law': 'none', 'Contact/Friction coefficient': '0.1*x'},
     'warning', ["'Contact/Friction coefficient' is not used"]),
    (9, 'a load without measure', 'pressed', {T: '3: 0, -1e200'}, 'error',
     ['up to 1e30']),
    (9, 'not a number in three dimensions', 'pressed 3d', {B: '0, 0, log(-z)'},
     'error', ['not a number']),
    # 10. No contact.
    (10, 'normal of the wrong sign', 'moved', {'Obstacle/Normal': '0, 1'}, 'warning',
     ['faces the obstacle', 'no node is in contact']),
    (10, 'rod inside the body', 'moved',
     {'Obstacle/Kind': 'rods', 'Obstacle/Centers': '1, .5', 'Obstacle/Radius': '.1'},
     'warning', ['faces the obstacle', 'no node is in contact']),
    (10, 'contact boundary that is prescribed', 'moved',
     {'Contact/Boundary id': '3'}, 'warning',
     ['faces the obstacle', 'no node is in contact']),
    (10, 'body in its obstacle', 'moved', {'Obstacle/Point': '0, 0.02'}, 'warning',
     ['inside the obstacle before']),
    (10, 'no obstacle', 'moved', {'Obstacle/Kind': 'none'}, 'warning',
     ['there is no obstacle']),
    (10, 'nothing that could touch', 'moved',
     {'Obstacle/Kind': 'none', 'Contact/Boundary id': '-1'}, 'warning',
     ['no part of the boundary may touch anything, so that this is plain elasticity']),
    (10, 'traction where all is prescribed', 'moved', {T: '3: 0, -5; 1: 0.0001, 0'},
     'warning', ["'Boundary conditions/Traction' does not move boundary 3"]),
    (10, 'traction where a component is free', 'moved',
     {D: '0: 0, free; 3: free, -0.01', T: '0: 0, 0.0001'}, 'good', []),
    (10, 'polygon', 'mesh', mesh('polygon', **{'Refinement/Initial refinements': '1'}),
     'warning', ['edges of up to 22.6 degrees']),
    # 11. All the rest.
    (11, 'one id twice', 'moved', {D: '3: 0.01, -0.01; 3: 0, 0'}, 'error',
     ['names boundary id 3 twice']),
    (11, 'one id twice in tractions', 'pressed', {T: '3: 0, -0.01; 3: 0, -0.02'},
     'error', ['names boundary id 3 twice']),
    (11, 'one point twice', 'pressed', {P: '(2, 0): 0.1, free; (2, 0): 0.2, free'},
     'error', ['twice']),
    (11, 'pin against a boundary', 'pressed', {P: '(0, 0): 0.1, free'}, 'error',
     ['contradict each other']),
    (11, 'z that varies', 'mesh', mesh('no-plane'), 'error', ['no plane z = constant']),
    (11, 'crack', 'mesh', mesh('crack'), 'warning', [r'at \(1, 0.5\)']),
    (11, 'too many refinements', 'moved', {'Refinement/Initial refinements': '15'},
     'error', ['degrees of freedom']),
    (11, 'too many cells', 'moved', {'Scene/Subdivisions': '1000000, 100000'}, 'error',
     ['degrees of freedom']),
    (11, 'too long a cylinder', 'pressed 3d', {
        'Scene/Geometry': 'cylinder', 'Scene/Length': '1e9', T: '', D: '1: 0, 0, 0'},
     'error', ["the coarse mesh would have 4e.10 degrees of freedom.*'Scene/Layers'"]),
    (11, 'too long a half cylinder', 'pressed 3d', {
        'Scene/Geometry': 'half cylinder', 'Scene/Length': '1e25', T: '',
        D: '1: 0, 0, 0'}, 'error', ['the coarse mesh would have 6e.27 degrees']),
    (11, 'too deep a mesh', 'pressed 3d', {'Refinement/Levels': '25',
                                           'Refinement/Initial refinements': '15'},
     'error', ['degrees of freedom|refined more than']),
    (11, 'sizes without measure', 'moved', {'Scene/Size': '1e-300, 1e-300'}, 'error',
     ['1e-30']),
    (11, 'stiffness without measure', 'moved', {"Material/Young's modulus": '1e-308'},
     'error', ['1e-30']),
    (11, 'infinite stiffness', 'moved', {"Material/Young's modulus": '1e308'}, 'error',
     ['1e30']),
    (11, 'radius without measure', 'moved',
     {'Obstacle/Kind': 'rods', 'Obstacle/Centers': '1, -1',
      'Obstacle/Radius': '1e-200'}, 'error', ['1e-30']),
    (11, 'definition that is broken', 'moved', {'Scene/Definitions': 'r = sqrt(x'},
     'error', ["'Scene/Definitions' of 'r'"]),
    (11, 'definition that is there twice', 'moved',
     {'Scene/Definitions': 'r = x; r = y'}, 'error', ['says twice what .r. is']),
    (11, 'constant that is there twice', 'moved', {'Scene/Constants': 'a = 1; a = 2'},
     'error', ['says twice what .a. is']),
    (11, 'definition with the name of a constant', 'moved',
     {'Scene/Constants': 'a = 1', 'Scene/Definitions': 'a = x'}, 'error',
     ['constant already']),
    (11, 'several values', 'moved', {'Scene/Radius': '1, 2'}, 'error', ['number']),
    (11, 'several values in an expression', 'moved',
     {'Contact/Friction law': 'Tresca', 'Contact/Friction bound': '1, 2'}, 'error',
     ['several values']),
    (11, 'assignment', 'moved', {D: '3: x=0.01, -0.01'}, 'error', ["has a '=' in it"]),
    (11, 'two comparisons in a row', 'moved',
     {T: '1: (0.2<y<0.4 ? -0.001 : 0), 0'}, 'error',
     [r"'\(0.2<y<0.4 . -0.001 : 0\)' has two comparisons in a row, .*; join them by "
      "'&&'"]),
    (11, 'two comparisons in a row in a definition', 'moved',
     {'Scene/Definitions': 'inside = 0.2 <= y == 1'}, 'error',
     ["'Scene/Definitions' of 'inside': '0.2 <= y == 1' has two comparisons"]),
    (11, 'two comparisons that are joined', 'moved',
     {T: '1: (0.2<y && y<=0.4 ? -0.001*(x>1) : (y>.8)*(y!=.9)*0.001), '
         'if(y<.2, y>.1, y<.3)*0'}, 'good', []),
    (11, 'time without load steps', 'moved', {D: '3: 0.01*t, -0.01'}, 'error',
     ["'0.01.t, -0.01' cannot be understood"]),
    (11, 'times that do not increase', 'moved',
     {'Load steps/Times': '0, 1, 1', D: '3: 0.01*t, -0.01'}, 'error',
     ['time number 3 is not after the one before']),
    (11, 'times that depend on something', 'moved',
     {'Load steps/Times': '0, x', D: '3: 0.01*t, -0.01'}, 'error',
     ["'Load steps/Times': 'x' cannot be understood"]),
    (11, 'a size that depends on the time', 'moved',
     {'Load steps/Times': '0, 1', 'Scene/Size': '2 + t, 1'}, 'error',
     ["'Scene/Size': '2 . t' cannot be understood; .*; the time t is none of them here"]),
    (11, 'a pinned point that is moved in the course of time', 'pressed',
     {'Load steps/Times': '0, 1', P: '(0, 1): 0.02*t, free'}, 'error',
     ["points': '0.02.t' cannot be understood; .*; the time t is none of them here"]),
    (11, 'a region that depends on the time', 'moved',
     {'Load steps/Times': '0, 1', 'Material/Regions': 'where x < t: 2, 0.3'}, 'error',
     ["'x < t' cannot be understood"]),
    (11, 'a constant that is the time', 'moved',
     {'Load steps/Times': '0, 1', 'Scene/Constants': 't = 2'}, 'error',
     ['is the time of load steps']),
    (11, 'load steps with checkpoints', 'moved',
     {'Load steps/Times': '0, 1', D: '3: 0.01*t, -0.01', 'Output/Checkpoint': 'true'},
     'good', []),
    (11, 'load steps without the time', 'moved', {'Load steps/Times': '0, 1'},
     'warning', ['nothing in the scene depends on t']),
    (11, 'load steps', 'moved',
     {'Load steps/Times': '0, 1/2, 2*a', 'Scene/Constants': 'a = 1',
      'Scene/Definitions': 'shift = 0.01*t', D: '3: shift, -0.01'}, 'good', []),
    (11, 'loads that come later', 'pressed',
     {'Load steps/Times': '0, 1', T: '3: 0, -0.01*t'}, 'later error',
     ["scene 'scene' at the time t = 0: the body is not held .*, or let there be loads "
      "that press it against an obstacle at each of the 'Load steps/Times'"]),
    (11, 'a value that is no number later', 'pressed',
     {'Load steps/Times': '1, 2', T: '3: 0, -0.01*sqrt(1.5 - t)', 'Output/Fields': 'false'},
     'later error', ["sqrt.1.5 - t.' is not a number at .* at the time 2, where"]),
    (11, 'a displacement into the obstacle later', 'moved',
     {'Load steps/Times': '0, 1', D: '3: 0.01, -0.01; 0: 0, 0.01 - 0.02*t'}, 'later error',
     ["at the time t = 1: the prescribed displacement of the node at"]),
    (11, 'a force that cannot be reached later', 'moved',
     {'Load steps/Times': '0, 1', G: '3: free, -0.02 + 0.03*t'}, 'later error',
     ["scene 'scene' at the time t = 1: the forces of"]),
    (11, 'an obstacle that moves along itself', 'moved',
     {'Load steps/Times': '0, 1', 'Obstacle/Kind': 'surface',
      'Scene/Definitions': 'road = 0.001*cos(9*(x - 0.1*t)) - 0.001',
      'Obstacle/Function': 'y - road'}, 'warning',
     ["'Obstacle/Function' depends on t, but slip is that of the body alone"]),
    (11, 'an obstacle that moves without friction', 'moved',
     {'Load steps/Times': '0, 1', 'Obstacle/Kind': 'surface',
      'Contact/Friction coefficient': '0', 'Obstacle/Function': 'y - 0.001*t'}, 'good',
     []),
    (11, 'a constant t without load steps', 'moved',
     {'Scene/Constants': 't = 1', D: '3: 0.01*t, -0.01'}, 'good', []),
    (11, 'tolerance below rounding', 'moved', {'Solver/Inner tolerance': '1e-25'},
     'good', []),
    (11, 'an id of many digits', 'moved', {'Contact/Boundary id': '7' * 5000}, 'error',
     ["'7+[.]+7+' is no boundary id"]),
    (11, 'a long path', 'moved', {'Scene/Mesh file': 'x' * 5000}, 'error',
     ["'Scene/Mesh file' is 'x+[.]+x+', but"]),
    (11, 'a long name', 'moved', {'Scene/Constants': '%s = 1; %s = 2' % (2 * ('n' * 5000,))},
     'error', ["says twice what 'n+[.]+n+' is"]),
    (11, 'a long number', 'moved', {'Scene/Radius': '0' * 5000 + '1e31'},
     'error',
     ["'Scene/Radius' is 0+[.]+0+1e31, which is beyond 1e30"]),
    (11, 'negative id', 'moved', {'Contact/Boundary id': '-7'}, 'error',
     ['no boundary id']),
    # 13. What another round of trials has found.
    (13, 'cells that do not fit', 'mesh', mesh('seam'), 'warning',
     [r'1 node of the boundary lies on boundary edges of other cells between their '
      r'corners, at \(1, 0.5\)']),
    (13, 'cells that do not fit in 3D', 'mesh 3d', mesh('seam-3d', **{
        D: '4: 0, 0, 0; 5: 0, 0, -0.01', 'Contact/Boundary id': '-1',
        'Obstacle/Kind': 'none'}), 'warning',
     [r'5 nodes of the boundary lie on boundary faces of other cells between their '
      'corners, one of them at', 'plain elasticity']),
    (13, 'a number at random', 'pressed', {T: '3: 0, -0.01*rand()'}, 'error',
     [r"'-0.01\*rand\(\)' is at random"]),
    (13, 'a number at random in a definition', 'pressed', {
        'Scene/Definitions': 'p = rand_seed(1)', T: '3: 0, -0.01*p'}, 'error',
     ['is at random']),
    (13, 'a name that begins like it', 'pressed', {
        'Scene/Definitions': 'random = 1', T: '3: 0, -0.01*random'}, 'good', []),
    (13, 'one name of two groups', 'mesh', mesh('one-name'), 'error',
     ["calls two physical groups 'floor', 3 and 4; give each"]),
    (13, 'a name that is the number of another group', 'mesh', mesh('number'), 'error',
     ["calls its group 1 '3', and the scene speaks of 3, which might be either"]),
    (13, 'a directory as a mesh file', 'mesh', mesh('folder'), 'error',
     ["'folder.msh' is no file but a directory"]),
    (13, 'a device as a mesh file', 'mesh', {'Scene/Mesh file': '/dev/zero'}, 'error',
     ['is no file but a device']),
    (13, 'a tolerance that lets everything pass', 'moved',
     {'Solver/Certificate tolerance': '10'}, 'error', ['Certificate tolerance']),
    (13, 'locking', 'pressed', {'Material/Poisson ratio': '0.499'}, 'warning',
     ['a Poisson ratio of 0.499 and pointwise volumetric strains']),
    (13, 'a pin that bears a load', 'pressed', {
        D: '', P: '(0, 1): 0, free', T: '1: -0.01, 0; 3: 0, -0.01',
        'Contact/Friction coefficient': '0.01'}, 'warning',
     [r'the point that is pinned at \(0, 1\) bears a force of 0.009']),
    (13, 'a pin that keeps a body in its place', 'pressed', {
        D: '', P: '(1, 0): 0, free'}, 'good', []),
    (13, 'materials far apart', 'pressed', {R: 'where x > 1: 1e12*E, nu'}, 'warning',
     [r'1e\+12 times as stiff as another']),
    (13, 'locking in a region', 'pressed', {R: 'where x > 1: E, 0.4999'}, 'warning',
     ["0.4999 and pointwise .*'E, nu, mean' where it is that of a region"]),
    (13, 'no locking', 'pressed', {'Material/Poisson ratio': '0.499',
                                   'Material/Volumetric strain': 'mean'}, 'good', []),
    (13, 'boundaries that contradict each other', 'moved',
     {D: '0: 0, 0; 3: 0.01, -0.01'}, 'warning',
     [r'moves \(0, 1\) by 0 in x direction with boundary 0 and by 0.01 with '
      'boundary 3']),
    (13, 'boundaries that agree where they meet', 'moved',
     {D: '0: 0, -0.01*y; 3: 0.01*x, -0.01'}, 'good', []),
    (13, 'half of the bottom is no contact boundary', 'mesh',
     mesh('half-bottom', **{D: '4: 0.01, -0.05'}), 'warning',
     ['is no contact node has gone through the surface of the obstacle, by .* at '
      r'\(2, 0\)']),
    (13, 'a body that hangs over the edge of what it lies on', 'mesh',
     mesh('half-bottom', **{'Obstacle/Point': '0, 0.1', D: '4: 0.01, 0.1'}), 'warning',
     ['the body lies inside the obstacle before']),
    (13, 'a node in the obstacle that cannot get out', 'pressed', {
        'Obstacle/Kind': 'surface', 'Obstacle/Function': 'min(y, x - 0.6)'}, 'warning',
     ['a node on the contact boundary lies inside the obstacle, at .* by 0.35']),
    # 12. Several contact boundaries.
    (12, 'a second one that touches nothing', 'pressed', ceiling(), 'warning', [BARE]),
    (12, 'two that touch', 'pressed', {
        D: '2: 0, 0', 'Contact/Boundary id': '0', 'Obstacle/Normal': '-1, 0',
        'Contact 2/Boundary id': '1', 'Obstacle 2/Kind': 'plane',
        'Obstacle 2/Point': '2, 0', 'Obstacle 2/Normal': '1, 0'}, 'good', []),
    (12, 'a corner', 'moved', {
        D: '3: 0, -0.01', 'Contact 2/Boundary id': '1', 'Obstacle 2/Kind': 'plane',
        'Obstacle 2/Point': '2, 0', 'Obstacle 2/Normal': '1, 0'}, 'error',
     [r'node at \(2, 0\) lies on two', "'Contact' and 'Contact 2'"]),
    (12, 'a corner that is held', 'moved', {
        'Scene/Size': '2, 1', D: '3: 0, -0.01; 0: 0, 0', 'Contact 2/Boundary id': '0',
        'Obstacle 2/Kind': 'plane', 'Obstacle 2/Point': '-1, 0',
        'Obstacle 2/Normal': '-1, 0'}, 'warning',
     ['moves .* with boundary 0 and by -0.01 with boundary 3',
      "of 'Contact 2' faces the obstacle", BARE]),
    (12, 'the same boundary', 'pressed', ceiling(**{'Contact 2/Boundary id': '2'}),
     'error', ["'Contact 2/Boundary id' is 2, as is that of 'Contact'"]),
    (12, 'a boundary that is not there', 'pressed',
     ceiling(**{'Contact 2/Boundary id': '9'}), 'error',
     ["'Contact 2/Boundary id' names boundary id 9"]),
    (12, 'no boundary', 'pressed', ceiling(**{'Contact 2/Boundary id': '-1'}), 'warning',
     ["'Contact 2' and 'Obstacle 2' are of no effect"]),
    (12, 'no obstacle', 'pressed', ceiling(**{
        'Obstacle 2/Kind': 'none', 'Obstacle 2/Point': '', 'Obstacle 2/Normal': ''}),
     'warning', ["there is no obstacle for 'Contact 2'"]),
    (12, 'an obstacle on the wrong side', 'pressed',
     ceiling(**{'Obstacle 2/Normal': '0, -1'}), 'warning',
     ["of 'Contact 2' faces the obstacle", BARE]),
    (12, 'number one', 'pressed', {'Contact 1/Boundary id': '3'}, 'error',
     ["there is no section 'Contact 1'; did you mean 'Contact'"]),
    (12, 'an entry that is not there', 'pressed', {'Contact 2/Friction': '3'}, 'error',
     ["there is no entry 'Contact 2/Friction'"]),
    (12, 'negative coefficient', 'pressed',
     ceiling(**{'Contact 2/Friction coefficient': '-0.1'}), 'error',
     ["'Contact 2/Friction coefficient' is -0.1, but it must not be negative"]),
    (12, 'coefficient with an unknown name', 'pressed',
     ceiling(**{'Contact 2/Friction coefficient': '2*f'}), 'error',
     ["'Contact 2/Friction coefficient': '2.f' cannot be understood"]),
    (12, 'coefficient above the bound', 'pressed',
     ceiling(**{'Contact 2/Friction coefficient': '7*F'}), 'warning',
     ['friction 2.1 is above', BARE]),
    (12, 'what nothing uses', 'pressed', ceiling(**{
        'Obstacle 2/Radius': '3', 'Contact 2/Friction bound': '1'}), 'warning',
     ["'Obstacle 2/Radius' is not used", "'Contact 2/Friction bound' is not used",
      BARE]),
]


class Runner:
    def __init__(self, programs):
        self.programs = programs
        self.failures = 0

    def run(self, scene, overrides, *options):
        dimension, entries = SCENES[scene]
        all_entries = dict(entries)
        all_entries.update({'Refinement/Initial refinements': '2', 'Output/Times':
                            'false', 'Output/Directory': 'results'})
        if 'Scene/Mesh file' in overrides and scene.startswith('mesh'):
            all_entries['Refinement/Initial refinements'] = '1'
        all_entries.update(overrides)
        with open('scene.prm', 'w') as f:
            for path, value in all_entries.items():
                section, name = path.split('/', 1)
                f.write('subsection %s\n  set %s = %s\nend\n' % (section, name, value))
        if '--restart' not in options:
            shutil.rmtree('results', ignore_errors=True)
        return subprocess.run([self.programs[dimension], 'scene.prm', *options],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              timeout=120, universal_newlines=True)

    def verdict(self, name, problems, result):
        print('%-8s%s' % ('FAILED' if problems else 'ok', name))
        if problems:
            self.failures += 1
            for line in problems + [result.stdout, result.stderr]:
                print('        ' + line.rstrip().replace('\n', '\n        '))

    def check(self, case):
        number, name, scene, overrides, expected, patterns = case
        result = self.run(scene, overrides)
        problems = []
        if result.returncode != (2 if expected.endswith('error') else 0):
            problems.append('exit status %d' % result.returncode)
        if expected.endswith('error'):
            lines = result.stderr.splitlines()
            if len(lines) != 1 or not re.search(r'[.?]$', lines[0]):
                problems.append('this is no single sentence')
            if len(result.stderr) > 700:
                problems.append('this is too long')
            for pattern in patterns:
                if not re.search(pattern, result.stderr):
                    problems.append('not found: ' + pattern)
            is_late = expected == 'later error'
            said = [l for l in result.stdout.splitlines() if not l.startswith('Warning:')]
            if bool(said) != is_late:
                problems.append('no load step is there' if is_late else
                                'something on standard output')
            left = [os.path.join(d, f) for d, _, fs in os.walk('results') for f in fs
                    if not is_late or '.part' in f]
            if left:
                problems.append('files left: ' + ', '.join(left))
        else:
            warnings = [l for l in result.stdout.splitlines()
                        if l.startswith('Warning:')]
            for pattern in patterns:
                if sum(bool(re.search(pattern, w)) for w in warnings) != 1:
                    problems.append('not found once: ' + pattern)
            if len(warnings) != len(patterns):
                problems.append('%d warnings instead of %d'
                                % (len(warnings), len(patterns)))
            if result.stderr:
                problems.append('something on standard error')
        self.verdict('%d: %s' % (number, name), problems, result)

    def check_same_tables(self):
        """The same mesh in four formats, and its groups by name."""
        names = {D: 'top plate: 0.01, -0.01', 'Contact/Boundary id': 'floor'}
        expected = self.run('mesh', mesh('square')).stdout
        for file in ('square-2.2-text', 'square-2.2-binary', 'square-4.1-text',
                     'square-4.1-binary'):
            result = self.run('mesh', mesh(file, **names))
            self.verdict('5: ' + file, [] if result.stdout == expected and
                         result.returncode == 0 else ['another table'], result)
        tables = [self.run('mesh 3d', mesh(file)) for file in ('cube-text',
                                                              'cube-binary')]
        self.verdict('5: text and binary in 3D',
                     [] if tables[0].stdout == tables[1].stdout and
                     tables[0].returncode == 0 else ['another table'], tables[1])

    def check_slope(self):
        """Coulomb's law in total forces: a block whose lower edge slides down a slope
        of 15 degrees gets as much friction as the coefficient allows."""
        angle = math.radians(15)
        normal = (math.sin(angle), 0, -math.cos(angle))
        down = (-math.cos(angle), 0, -math.sin(angle))
        shift = ', '.join('%.9g' % (.1 * t + .02 * n) for t, n in zip(down, normal))
        for kind, obeys in ('obstacle', True), ('body', False):
            result = self.run('pressed 3d', {
                D: '5: ' + shift, T: '', 'Obstacle/Point': '1, 0, 0',
                'Obstacle/Normal': ', '.join('%.15g' % n for n in normal), N: kind})
            force = re.search(r'on the body \(([^)]*)\)', result.stdout)
            force = [float(f) for f in force.group(1).split(',')]
            pressure = -sum(f * n for f, n in zip(force, normal))
            friction = math.sqrt(sum(f * f for f in force) - pressure ** 2)
            ratio = friction / pressure
            self.verdict('2: forces on a slope, normals of the %s' % kind,
                         [] if (abs(ratio - .3) < 1e-3) == obeys else
                         ['their ratio is %.4f' % ratio], result)

    def check_restart(self):
        """With the same mesh, whose ids are others."""
        entries = mesh('changing', **{'Output/Checkpoint': 'true'})
        shutil.copy('square.msh', 'changing.msh')
        self.run('mesh', dict(entries, **{'Refinement/Levels': '1'}))
        write_mesh('changing.msh', SQUARE, [
            (kind, {1: 2, 2: 1}.get(i, i), v) for kind, i, v in EDGES] + CELL)
        result = self.run('mesh', dict(entries, **{'Refinement/Levels': '2'}),
                          '--restart')
        self.verdict('13: a restart with other ids',
                     [] if result.returncode == 2 and 'another coarse mesh' in
                     result.stderr else ['no error'], result)

    def check_check(self):
        result = self.run('moved', {}, '--check')
        self.verdict('--check solves and writes nothing',
                     ([] if result.returncode == 0 and 'energy' not in result.stdout
                      else ['it has done something else']) +
                     (['something was written'] if os.path.exists('results') else []),
                     result)
        result = self.run('moved', {'Obstacle/Point': '0, 0.02'}, '--check')
        self.verdict('--check warns', [] if result.returncode == 0 and
                     'inside the obstacle' in result.stdout else ['no warning'], result)
        result = self.run('moved', {R: 'where x > 5: 2, .3'}, '--check')
        self.verdict('--check warns of regions', [] if result.returncode == 0 and
                     'no cell of the first mesh has the material of region 1' in
                     result.stdout else ['no warning'], result)
        result = self.run('mesh', mesh('two'), '--check')
        self.verdict('--check finds errors', [] if result.returncode == 2 else
                     ['exit status'], result)


# Other materials in regions: list 18, what a later round of users asked for.
CASES += [
    (18, 'regions by name and by id', 'mesh',
     mesh('square-2.2-text', **{R: 'body: 2, .3'}), 'good', []),
    (18, 'a region that no cell has', 'mesh', mesh('square', **{R: '11: 2, .3'}),
     'error', ["'Material/Regions' names the physical id 11, but .* only 10;"]),
    (18, 'a region that is no name', 'mesh',
     mesh('square-4.1-text', **{R: 'rim: 2, .3'}), 'error',
     [r"'rim' is neither a number nor the name of a physical surface .* which has "
      r"'body' \(10\);"]),
    (18, 'a region without a mesh file', 'moved', {R: 'rim: 2, .3'}, 'error',
     ["'rim' is no region; give the physical id of cells, .* or 'where'"]),
    (18, 'a condition', 'moved', {R: 'where x > 1: 2, .3'}, 'good', []),
    (18, 'a condition that no cell fulfils', 'moved',
     {R: 'where x > 1: 2, .3; where x > 5: 3, .3'}, 'warning',
     ["no cell .* has the material of region 2 in 'Material/Regions'"]),
    (18, 'a condition that covers another', 'moved',
     {R: 'where x > 1: 2, .3; where x > .5: 3, .3'}, 'warning',
     ["no cell .* has the material of region 1 in 'Material/Regions'"]),
    (18, 'a condition that is none', 'moved', {R: 'where x >: 2, .3'}, 'error',
     ["'Material/Regions': 'x >' cannot be understood"]),
    (18, 'a condition with two comparisons in a row', 'moved',
     {R: 'where 0.5 < x < 1: 2, .3'}, 'error',
     ["'Material/Regions': '0.5 < x < 1' has two comparisons in a row"]),
    (18, 'a condition without a value', 'moved', {R: 'where 1/(x-0.125): 2, .3'},
     'error', [r"Regions.*'1/\(x-0.125\)' is inf at \(0.125,"]),
    (18, 'a modulus is missing', 'moved', {R: 'where x > 1: 2'}, 'error',
     ["region 'where x > 1' has 1 number, where 'E, nu' is wanted"]),
    (18, 'a modulus is negative', 'moved', {R: '0: -2, .3'}, 'error',
     ["region '0' has -2 as Young's modulus, which must be positive"]),
    (18, 'incompressible', 'moved', {R: '0: 2, .5'}, 'error',
     ["region '0' has .5 as Poisson ratio, .* between -1 and 1/2"]),
    (18, 'another volumetric strain', 'moved', {R: '0: 2, .3, averaged'}, 'error',
     ["region '0' has 'averaged' as volumetric strain; take 'mean' or"]),
    (18, 'a cell in two groups, one of which is a region', 'mesh',
     mesh('twice', **{R: '7: 2, .3'}), 'good', []),
    (18, 'a cell in two groups, both of them regions', 'mesh',
     mesh('twice', **{R: '7: 2, .3; 1: 3, .3'}), 'error',
     ['has a cell number . around .* in the groups 1 and 7, and the scene speaks of '
      'both']),
    # Obstacles.
    (18, 'a ball in two dimensions', 'moved',
     {'Obstacle/Kind': 'balls', 'Obstacle/Centers': '0, -1'}, 'error',
     ["'balls', which there are in three dimensions only"]),
    (18, 'a negative radius', 'moved',
     {'Obstacle/Kind': 'rods', 'Obstacle/Centers': '0, -1', 'Obstacle/Radius': '-1'},
     'error', ["'Obstacle/Radius' is '-1', but radii must be positive"]),
    (18, 'two radii for three rods', 'moved',
     {'Obstacle/Kind': 'rods', 'Obstacle/Centers': '0, -1; 1, -1; 2, -1',
      'Obstacle/Radius': '1; 2'}, 'error', ['has 2 numbers, but there are 3 rods']),
    (18, 'radii of their own', 'moved',
     {'Obstacle/Kind': 'rods', 'Obstacle/Centers': '0, -1; 2, -2',
      'Obstacle/Radius': '1; 2'}, 'good', []),
    (18, 'a surface without a function', 'moved', {'Obstacle/Kind': 'surface'},
     'error', ["'surface', but there is none; set 'Obstacle/Function'"]),
    (18, 'a function without a surface', 'moved', {'Obstacle/Function': 'y'},
     'warning', ["'Obstacle/Function' is not used"]),
    (18, 'a function without a value', 'moved',
     {'Obstacle/Kind': 'surface', 'Obstacle/Function': 'y + 0/x'}, 'error',
     [r"'Obstacle/Function': 'y \+ 0/x' is not a number at \(0,"]),
    (18, 'a function that is nowhere zero', 'moved',
     {'Obstacle/Kind': 'surface', 'Obstacle/Function': '1 + y^2'}, 'warning',
     ['no node of the contact boundary faces the obstacle', 'no node is in contact']),
    (18, 'a function that is negative everywhere', 'moved',
     {'Obstacle/Kind': 'surface', 'Obstacle/Function': '-1e8'}, 'error',
     [r"the node at \(.*\) on the contact boundary lies inside the obstacle, and there is"]),
    (18, 'a function with the wrong sign', 'moved',
     {'Obstacle/Kind': 'surface', 'Obstacle/Function': '-5 - y'}, 'error',
     ["'Obstacle/Function' is to be negative in the obstacle"]),
    (18, 'a plane as a surface', 'pressed',
     {'Obstacle/Kind': 'surface', 'Obstacle/Function': 'exp(y) - 1'}, 'good', []),
    (18, 'a body in a hole', 'moved',
     {'Obstacle/Kind': 'rods', 'Obstacle/Centers': '1, 1', 'Obstacle/Radius': '1.4143',
      'Obstacle/Side': 'inside'}, 'good', []),
]


def main():
    # Each program is on one process, and need not start a daemon for others.
    os.environ['OMPI_MCA_ess_singleton_isolated'] = '1'
    runner = Runner({2: os.path.abspath(sys.argv[1]), 3: os.path.abspath(sys.argv[2])})
    work = tempfile.mkdtemp()
    try:
        os.chdir(work)
        make_meshes()
        for case in CASES:
            runner.check(case)
        runner.check_same_tables()
        runner.check_slope()
        runner.check_restart()
        runner.check_check()
    finally:
        os.chdir('/')
        shutil.rmtree(work)
    print('%d failed' % runner.failures)
    return 1 if runner.failures else 0


if __name__ == '__main__':
    sys.exit(main())
