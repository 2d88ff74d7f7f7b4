"""Meshes in Gmsh's formats: read from text in version 2.2 or 4.1, and written in either,
as text or in binary."""
import os
import re
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(os.path.dirname(HERE), 'program'))
from gmsh_writer import write_mesh  # noqa: E402

FORMATS = [(version, binary) for version in ('2.2', '4.1') for binary in (False, True)]
# Gmsh's types that can be written; others, which are points, are left out.
TYPES = [1, 2, 3, 5, 8, 10]


class Mesh:
    """Lists of nodes (points), of elements ([type, physical id, nodes from 1 on]), and of
    names (dimension, physical id, name)."""

    def __init__(self, data):
        lines = data.decode().split('\n')
        self.names = [(int(d), int(i), name) for d, i, name in re.findall(
            r'^(\d) (-?\d+) "(.*)"$', '\n'.join(section(lines, 'PhysicalNames')), re.M)]
        if lines[1].startswith('4'):
            self.read_4(lines)
        else:
            self.read_2(lines)

    def number_nodes(self, points):
        number = {tag: i + 1 for i, (tag, _) in enumerate(points)}
        self.nodes = [point for _, point in points]
        self.elements = [[kind, physical, [number[n] for n in nodes]]
                         for kind, physical, nodes in self.elements if kind in TYPES]

    def read_2(self, lines):
        self.elements = []
        for line in section(lines, 'Elements')[1:]:
            words = [int(w) for w in line.split()]
            self.elements.append([words[1], words[3], words[3 + words[2]:]])
        self.number_nodes([(int(l.split()[0]), tuple(map(float, l.split()[1:])))
                           for l in section(lines, 'Nodes')[1:]])

    def read_4(self, lines):
        entities = section(lines, 'Entities')
        physical, at = {}, 1
        for dimension, n in enumerate(map(int, entities[0].split())):
            n_numbers = 4 if dimension == 0 else 7
            for line in entities[at:at + n]:
                words = line.split()
                physical[dimension, int(words[0])] = (
                    int(words[n_numbers + 1]) if int(words[n_numbers]) > 0 else 0)
            at += n
        points = []
        for (_, tags, coordinates) in blocks(section(lines, 'Nodes'), 2):
            points += [(int(t), tuple(map(float, c.split())))
                       for t, c in zip(tags, coordinates)]
        self.elements = []
        for (dimension, tag, kind), rows in blocks(section(lines, 'Elements'), 1):
            for row in rows:
                self.elements.append([kind, physical[dimension, tag],
                                      [int(w) for w in row.split()[1:]]])
        self.number_nodes(points)

    def write(self, name, version, binary):
        write_mesh(name, self.nodes, self.elements, self.names, version, binary)


def section(lines, name):
    """The lines of a section, or none."""
    if '$' + name not in lines:
        return []
    return lines[lines.index('$' + name) + 1:lines.index('$End' + name)]


def blocks(lines, n_lists):
    """Of format 4.1: three numbers, and so many lists of as many lines as the fourth
    one says."""
    at = 1
    while at < len(lines):
        *head, n = map(int, lines[at].split())
        at += 1
        yield (tuple(head), *[lines[at + k * n:at + (k + 1) * n]
                              for k in range(n_lists)])
        at += n_lists * n
