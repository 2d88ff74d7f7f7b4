"""Inputs that are made from numbers: a scene, its meshes and arguments, one of which is
changed at random."""
import os
import random
import re
import shutil
import struct

from meshes import FORMATS, TYPES, Mesh

NUMBERS = ['0', '-0', '1', '-1', '2', '.5', '1e-8', '1e8', '-1e8', '1e-30', '1e30',
           '1e300', '1e-300', '-1e-300', 'nan', 'inf', '-inf', '1e999', '0x10', '1/0',
           '1,2', '', ' ', '1e', '--1', '3.0.1', '99999999999999999999', '00', '1 2']
EXPRESSIONS = ['x', 'y', 'z', 'x*y', '1/x', 'sqrt(x)', 'log(-x)', 'x^1000', 'sin(x',
               'x)', 'x=1', 'if(x>0,1,0)', 'free', 'E', 'nu', 'pi', 'q', '1e', 'x,y',
               '(x,y)', 'x;y', '-', '*', 'rand(1)', 'x>y', '1e300*x', '"x"', '#', '\\']
PIECES = ['subsection', 'end', 'set', '=', ';', ',', ':', '(', ')', '#', '\\\n', '\0',
          '\xff', '\u00e9', '$', '%s', '%n', '../', "'", '"', '\t', '\r\n', 'true',
          'false', 'yes', 'automatic', '-1']
DOUBLES = [0., -0., float('nan'), float('inf'), -float('inf'), 1e-300, 1e300, -1e30, 1e-8]

# What is changed; some of them more often.
KINDS = ['values', 'values', 'values', 'numbers', 'numbers', 'entries', 'text', 'bytes',
         'arguments', 'mesh', 'tags', 'formats', 'formats', 'checkpoint', 'history',
         'history']


class Input:
    """One input: made by its seed, in the present folder."""

    def __init__(self, seed, scenes, meshes):
        self.random = random.Random(seed)
        self.scenes = scenes
        self.meshes = meshes
        self.dimension = self.random.choice([2, 2, 3])
        self.kind = self.random.choice(KINDS)
        self.options = []
        # Whether a checkpoint of the run is damaged, and the run continued; each of the
        # two with these options more.
        self.restarts = False
        self.first_options = ['Output/Checkpoint=true']
        self.later_options = []
        candidates = [read(path) for path in self.scenes[self.dimension]]
        if self.kind == 'history':
            candidates = [scene for scene in candidates if times(scene) or force(scene)]
        self.scene = self.random.choice(candidates)
        # Meshes are found beside the scene.
        for mesh in self.meshes[self.dimension]:
            shutil.copy(mesh, '.')
        getattr(self, 'change_' + self.kind)()
        write('scene.prm', self.scene)

    def has_platens(self):
        return force(self.scene) or any('/Force=' in o for o in self.options)

    def number(self):
        r = self.random
        return r.choice([r.choice(NUMBERS), '%g' % r.gauss(0, 1),
                         '%g' % (10. ** r.uniform(-12, 12)), str(r.randint(-3, 9))])

    def value(self, old):
        """Another value in place of an old one, often nearly as it was."""
        r = self.random
        parts = re.split(r'([,;: ]+)', old)
        if len(parts) > 1 and r.random() < .6:
            i = r.randrange(0, len(parts), 2)
            parts[i] = self.value(parts[i])
            return ''.join(parts)
        return r.choice([self.number, lambda: r.choice(EXPRESSIONS),
                         lambda: old + r.choice(PIECES), lambda: r.choice(PIECES) + old,
                         lambda: '-' + old, lambda: old * 2, lambda: '', self.number])()

    def entries(self):
        return [m for m in re.finditer(r'^( *set [^=\n]*=)([^\n]*)$',
                                       self.scene.decode('utf-8', 'replace'), re.M)]

    def change_values(self, n=None):
        for _ in range(n or self.random.choice([1, 1, 2, 4])):
            entries = self.entries()
            if not entries:
                return
            m = self.random.choice(entries)
            text = self.scene.decode('utf-8', 'replace')
            self.scene = (text[:m.start(2)] + ' ' + self.value(m.group(2).strip()) +
                          text[m.end(2):]).encode('utf-8', 'replace')

    def change_numbers(self):
        """Numbers of the scene, by so little that it may still be one."""
        for _ in range(self.random.choice([1, 2, 4])):
            text = self.scene.decode()
            # Neither in comments nor ids of boundaries, which a colon follows.
            found = [m for m in re.finditer(r'(?<![\w.^])\d*\.?\d+(?:e-?\d+)?(?![\w.:])',
                                            text)
                     if '#' not in text[text.rfind('\n', 0, m.start()) + 1:m.start()] and
                     '=' in text[text.rfind('\n', 0, m.start()) + 1:m.start()]]
            m = self.random.choice(found)
            number = float(m.group(0)) * self.random.choice(
                [-1, 0, .5, 2, 10, .1, 100, .01, self.random.gauss(1, .1)])
            self.scene = (text[:m.start()] + self.random.choice(
                ['%g' % number, '%g' % number, '%d' % round(number)]) +
                text[m.end():]).encode()

    def change_entries(self):
        """Entries of other scenes are put in the place of this one's."""
        r = self.random
        other = read(r.choice(self.scenes[self.dimension])).decode()
        sections = re.findall(r'^subsection .*?^end$', other, re.M | re.S)
        for section in r.sample(sections, min(len(sections), r.randint(1, 3))):
            name = section.split('\n')[0]
            own = re.compile('^%s$.*?^end$' % re.escape(name), re.M | re.S)
            text = self.scene.decode('utf-8', 'replace')
            self.scene = (own.sub('', text) + '\n' + section + '\n').encode()
        if r.random() < .3:
            self.change_values(1)

    def change_text(self):
        r = self.random
        lines = self.scene.split(b'\n')
        for _ in range(r.choice([1, 1, 3])):
            i = r.randrange(len(lines))
            action = r.randrange(5)
            if action == 0:
                del lines[i]
            elif action == 1:
                lines.insert(i, lines[r.randrange(len(lines))])
            elif action == 2:
                lines[i] = lines[i][:r.randrange(len(lines[i]) + 1)]
            elif action == 3:
                piece = r.choice(PIECES).encode('utf-8', 'replace')
                k = r.randrange(len(lines[i]) + 1)
                lines[i] = lines[i][:k] + piece + lines[i][k:]
            else:
                lines[i] = lines[i] * r.choice([2, 1000])
            lines = lines or [b'']
        self.scene = b'\n'.join(lines)

    def change_bytes(self, data=None):
        r = self.random
        changed = bytearray(self.scene if data is None else data)
        for _ in range(r.choice([1, 2, 8])):
            if not changed:
                break
            k = r.randrange(len(changed))
            action = r.randrange(4)
            if action == 0:
                changed[k] ^= 1 << r.randrange(8)
            elif action == 1:
                changed[k] = r.randrange(256)
            elif action == 2:
                del changed[k:k + r.choice([1, 10, len(changed)])]
            else:
                changed[k:k] = bytes(r.randrange(256)
                                     for _ in range(r.choice([1, 4, 50])))
        if data is None:
            self.scene = bytes(changed)
        return bytes(changed)

    def take_mesh(self):
        """Any mesh in the place of the scene's: its name and content."""
        name = self.random.choice(self.meshes[self.dimension])
        data = read(name)
        name = os.path.basename(name)
        self.scene = re.sub(rb'set (Geometry|Mesh file) *=.*', b'', self.scene)
        self.scene += ('\nsubsection Scene\n  set Geometry = mesh file\n  set Mesh '
                       'file = %s\nend\n' % name).encode()
        return name, data

    def take_mesh_and_scene(self):
        """Any mesh with the scene that belongs to it, so that it would be solved if
        nothing else were changed."""
        name, data = self.take_mesh()
        self.scene = [s for s in map(read, self.scenes[self.dimension])
                      if name.encode() in s][0]
        return name, data

    def change_tags(self):
        """In a mesh: physical ids, types of elements, how many tags there are, groups
        that overlap, and names, which the scene uses in the place of ids."""
        r = self.random
        name, data = self.take_mesh_and_scene()
        lines = data.decode().split('\n')
        for _ in range(r.choice([1, 1, 2])):
            if r.random() < .3:
                self.change_names(lines)
            elif lines[1].startswith('4'):
                self.change_entity(lines)
            else:
                self.change_elements(lines)
        write(name, '\n'.join(lines).encode('utf-8', 'replace'))

    def id(self, old='1'):
        return self.random.choice(['1', '2', '3', '4', '0', '-1', '-' + old, '2147483647',
                                   '-2147483648', '4294967295', '4294967296', '1e3', '',
                                   self.number()])

    def type(self):
        return self.random.choice([str(self.random.randrange(0, 32)), '15', '92', '-1',
                                   '0', '1000', self.number()])

    def change_elements(self, lines):
        """Version 2.2: number, type, how many tags, tags, nodes."""
        r = self.random
        begin, end = lines.index('$Elements') + 2, lines.index('$EndElements')
        # One element, or all those of its group.
        chosen = [r.randrange(begin, end)]
        if r.random() < .4:
            chosen = [i for i in range(begin, end)
                      if lines[i].split()[3:4] == lines[chosen[0]].split()[3:4]]
        action = r.randrange(4)
        new, n = (self.type() if action == 1 else self.id()), r.randrange(5)
        said = r.choice([str(n), '2', self.number()])
        for i in chosen:
            words = lines[i].split()
            if action == 0:
                lines[i] = ' '.join(words[:3] + [new] + words[4:])
            elif action == 1:
                lines[i] = ' '.join(words[:1] + [new] + words[2:])
            elif action == 2:
                tags = (words[3:5] + ['7', '8', '9'])[:n]
                lines[i] = ' '.join(words[:2] + [said] + tags + words[5:])
            else:
                lines.insert(end, ' '.join(words[:3] + [new] + words[4:]))
        if action == 3:
            lines[begin - 1] = str(int(lines[begin - 1]) + len(chosen))

    def change_entity(self, lines):
        """Version 4.1: an entity has its tag, a box, how many ids, ids, and what
        bounds it; blocks of elements have a dimension, a tag, a type and a number."""
        r = self.random
        if r.random() < .3:
            i = lines.index('$Elements') + 2
            blocks = []
            while lines[i] != '$EndElements':
                blocks.append(i)
                i += 1 + int(lines[i].split()[3])
            i = r.choice(blocks)
            words = lines[i].split()
            k = r.randrange(4)
            words[k] = self.type() if k == 2 else self.id(words[k])
        else:
            first = lines.index('$Entities') + 1
            n_points = int(lines[first].split()[0])
            i = r.randrange(first + 1 + n_points, lines.index('$EndEntities'))
            words = lines[i].split()
            n = int(words[7])
            action = r.randrange(3)
            if action == 0:
                words[8:8 + n] = [self.id()] * max(n, 1)
                words[7] = str(max(n, 1))
            elif action == 1:
                words[8:8] = [self.id()]
                words[7] = str(n + 1)
            else:
                words[7] = self.id(words[7])
        lines[i] = ' '.join(words)

    def change_names(self, lines):
        """Anything may be in a name, and any id may have one."""
        r = self.random
        if '$PhysicalNames' in lines and r.random() < .8:
            del lines[lines.index('$PhysicalNames'):
                      lines.index('$EndPhysicalNames') + 1]
        names = [r.choice(['floor', 'top plate', 'wall', '4', 'free', '',
                           r.choice(PIECES), r.choice(EXPRESSIONS), 'x' * 5000])
                 for _ in range(r.randint(1, 3))]
        dimension = str(self.dimension - 1)
        block = ['%s %s "%s"' % (r.choice([dimension] * 4 + ['0', '3', '4', '-1', 'x']),
                                 self.id(), n) for n in names]
        lines[3:3] = (['$PhysicalNames', r.choice([str(len(names))] * 3 +
                                                  [self.number()])] +
                      block + ['$EndPhysicalNames'])
        text = self.scene.decode()
        for match in reversed(list(re.finditer(
                r'(?:Boundary id|Displacement|Traction) *= *(\d+)', text))):
            if r.random() < .5:
                text = text[:match.start(1)] + r.choice(names) + text[match.end(1):]
        self.scene = text.encode('utf-8', 'replace')

    def change_mesh(self):
        r = self.random
        name, data = self.take_mesh()
        if r.random() < .4:
            write(name, self.change_bytes(data))
            return
        # Numbers in the text: indices, tags, coordinates.
        words = re.split(rb'(\s+)', data)
        for _ in range(r.choice([1, 1, 2, 5])):
            k = r.randrange(0, len(words), 2)
            other = words[r.randrange(0, len(words), 2)]
            words[k] = r.choice([self.number().encode(), other, other, b'', words[k] +
                                 b'0'])
        write(name, b''.join(words))

    def change_formats(self):
        """A mesh is written in another format, with some of what it says changed, or
        numbers of the file, or as it is."""
        r = self.random
        name, data = self.take_mesh_and_scene()
        mesh = Mesh(data)
        for _ in range(r.choice([0, 1, 1, 2])):
            self.change_parts(mesh)
        version, binary = r.choice(FORMATS)
        self.kind = 'mesh, %s %s' % (version, 'binary' if binary else 'text')
        mesh.write(name, version, binary)
        action = r.random()
        if binary and action < .4:
            write(name, self.change_binary(read(name)))
        elif action < .6:
            write(name, self.change_bytes(read(name)))

    def change_parts(self, mesh):
        r = self.random
        action = r.randrange(8)
        element = r.choice(mesh.elements)
        if action == 0:
            element[1] = r.choice([0, 1, 2, 3, 10, -1, -element[1], 2**31 - 1, -2**31])
        elif action == 1:
            old, new = element[1], r.choice([0, 1, 2, 3, 10, -1, 2**31 - 1])
            for e in mesh.elements:
                e[1] = new if e[1] == old else e[1]
        elif action == 2:
            element[0] = r.choice(TYPES)
        elif action == 3:
            element[2][r.randrange(len(element[2]))] = r.choice(
                [0, -1, 2**31 - 1, len(mesh.nodes) + 1, r.randint(1, len(mesh.nodes))])
        elif action == 4:
            r.shuffle(element[2])
        elif action == 5:
            mesh.elements.append([element[0], r.choice([element[1], 1, 7]),
                                  list(element[2])])
        elif action == 6:
            mesh.elements.remove(element)
        else:
            i = r.randrange(len(mesh.nodes))
            point = list(mesh.nodes[i])
            point[r.randrange(3)] = r.choice([r.choice(DOUBLES), r.gauss(0, 1)])
            mesh.nodes[i] = r.choice([tuple(point), r.choice(mesh.nodes)])

    def change_binary(self, data):
        """Numbers of a binary file, most of which begin after a multiple of four bytes
        in their sections."""
        r = self.random
        sections = [m.span(1) for m in re.finditer(
            rb'^\$(?:Entities|Nodes|Elements)\n(.*?)\n\$End', data, re.M | re.S)]
        for _ in range(r.choice([1, 1, 2, 5])):
            begin, end = r.choice(sections)
            # What counts the others is at the beginning.
            n = min((end - begin) // 4, r.choice([8, 1000000]))
            at = begin + 4 * r.randrange(n)
            number = r.choice([
                struct.pack('=i', r.choice([r.randint(-1, 40), 2**31 - 1, -2**31])),
                struct.pack('=q', r.choice([r.randint(-1, 40), 2**31, 2**32 + 1, 2**40,
                                            2**63 - 1, -2**63])),
                struct.pack('=d', r.choice([r.choice(DOUBLES), r.gauss(0, 1)]))])
            data = data[:at] + number + data[at + len(number):]
        return data

    def change_arguments(self):
        r = self.random
        entries = self.entries()
        for _ in range(r.choice([1, 2, 3])):
            m = r.choice(entries)
            name = m.group(1).replace('set', '').replace('=', '').strip()
            section = r.choice(['Scene', 'Obstacle', 'Contact', 'Material', 'Solver',
                                'Refinement', 'Output', 'Boundary conditions', ''])
            argument = '%s/%s=%s' % (section, name, self.value(m.group(2).strip()))
            self.options.append(r.choice([
                argument, argument, argument, '--check', '--restart', '--foo', '', '-h',
                argument[:r.randrange(len(argument) + 1)], 'x' * 5000]))
        self.options = [o.replace('\0', '') for o in self.options]

    def change_checkpoint(self):
        """The run is continued on a finer mesh; after several load steps that is not
        possible, and it solves the last one again. In both cases there are two
        checkpoints."""
        self.restarts = True
        if not times(self.scene):
            self.first_options += ['Refinement/Levels=2']
            self.later_options += ['Refinement/Levels=3']

    def change_history(self):
        """The same for load steps, of which there are so few that the run is continued
        within the first or a later one, and for platens."""
        self.change_checkpoint()
        if times(self.scene):
            kept = self.random.randint(2, 5)
            self.options = ['Load steps/Times=' + ', '.join(times(self.scene)[:kept])]
            if self.random.random() < .2:
                self.later_options += ['Refinement/Levels=2']

    def damage(self, folder):
        """Changes a file of the checkpoints in a folder, or two. Returns whether there
        is any."""
        files = sorted(os.path.join(d, f) for d, _, names in os.walk(folder)
                       for f in names if 'checkpoint' in d)
        chosen = self.random.sample(files, min(len(files), self.random.choice([1, 1, 2])))
        for name in chosen:
            write(name, self.change_bytes(read(name)))
        return bool(chosen)


def times(scene):
    """The load steps of a scene, if there are any."""
    found = re.search(rb'^ *set Times *= *([\d.].*)$', scene, re.M)
    return [t.strip() for t in found.group(1).decode().split(',')] if found else []


def force(scene):
    """Whether a scene has a total force, which a search has to find."""
    return bool(re.search(rb'^\s*set\s+Force\s*=\s*\S', scene, re.M))


def read(path):
    with open(path, 'rb') as f:
        return f.read()


def write(path, data):
    with open(path, 'wb') as f:
        f.write(data)
