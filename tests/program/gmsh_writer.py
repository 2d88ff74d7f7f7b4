"""Writes meshes in Gmsh's formats."""
import struct

# Gmsh's numbers of the kinds of elements.
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
