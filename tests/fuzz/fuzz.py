"""Scenes, meshes, checkpoints and arguments that are changed at random, given to the
programs: whatever they are, a run has to end with a result or with a sentence.

Usage: fuzz.py PROGRAM_2D PROGRAM_3D SCENES_2D SCENES_3D FOUND
         [--seconds N] [--inputs N] [--seed N] [--launcher 'MPIEXEC FLAG N']
         [--verify SCRIPT] [--replay FOLDER]

Each input is made from a number, its seed, which is printed with what is found and
with which it can be made again (--seed N --seconds 0 tries that one only). An input
is a finding if the run
- ends by a signal, or with an exit status of its own that says "an error of the
  program" (3), or does not end,
- prints a stack trace, or a report of a sanitizer,
- refuses the input without a message, or with one of more than three lines or a
  thousand characters,
- prints "nan" or "inf" in the table of a run with exit status 0,
- leaves files that are not finished,
- says that it has solved the problem, and the certificate is not confirmed by
  SCRIPT, a second program that reads what was written.

The inputs of findings are saved in the folder FOUND, one folder for each. Exit status
1 if there were any. What was found once, and has been mended, is kept in the folder
corpus beside this file, and tried by --replay.
"""
import argparse
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
import time

TIMEOUT = 60
# Small enough to be many.
LIMITS = ['Refinement/Levels=1', 'Refinement/Maximum dofs=2000', 'Output/Times=false',
          'Solver/Total cycles=300', 'Solver/Maximum cycles=60',
          'Solver/Maximum outer iterations=10', 'Output/Directory=results']

NUMBERS = ['0', '-0', '1', '-1', '2', '.5', '1e-8', '1e8', '-1e8', '1e-30', '1e30',
           '1e300', '1e-300', '-1e-300', 'nan', 'inf', '-inf', '1e999', '0x10', '1/0',
           '1,2', '', ' ', '1e', '--1', '3.0.1', '99999999999999999999', '00', '1 2']
EXPRESSIONS = ['x', 'y', 'z', 'x*y', '1/x', 'sqrt(x)', 'log(-x)', 'x^1000', 'sin(x',
               'x)', 'x=1', 'if(x>0,1,0)', 'free', 'E', 'nu', 'pi', 'q', '1e', 'x,y',
               '(x,y)', 'x;y', '-', '*', 'rand(1)', 'x>y', '1e300*x', '"x"', '#', '\\']
PIECES = ['subsection', 'end', 'set', '=', ';', ',', ':', '(', ')', '#', '\\\n', '\0',
          '\xff', '\u00e9', '$', '%s', '%n', '../', "'", '"', '\t', '\r\n', 'true',
          'false', 'yes', 'automatic', '-1']


class Input:
    """One input: made by its seed, in the present folder."""

    def __init__(self, seed, scenes, meshes):
        self.random = random.Random(seed)
        self.scenes = scenes
        self.meshes = meshes
        self.dimension = self.random.choice([2, 2, 3])
        self.options = []
        self.restarts = False
        path = self.random.choice(self.scenes[self.dimension])
        self.scene = read(path)
        # Meshes are found beside the scene.
        for mesh in self.meshes[self.dimension]:
            shutil.copy(mesh, '.')
        kind = self.random.choice(['values', 'values', 'values', 'text', 'bytes', 'mesh',
                                   'tags', 'arguments', 'checkpoint', 'entries'])
        getattr(self, 'change_' + kind)()
        write('scene.prm', self.scene)

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

    def change_values(self, times=None):
        for _ in range(times or self.random.choice([1, 1, 2, 4])):
            entries = self.entries()
            if not entries:
                return
            m = self.random.choice(entries)
            text = self.scene.decode('utf-8', 'replace')
            self.scene = (text[:m.start(2)] + ' ' + self.value(m.group(2).strip()) +
                          text[m.end(2):]).encode('utf-8', 'replace')

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

    def change_tags(self):
        """In a mesh: physical ids, types of elements, how many tags there are, groups
        that overlap, and names, which the scene uses in the place of ids."""
        r = self.random
        name, data = self.take_mesh()
        # The scene that belongs to the mesh, so that it would be solved otherwise.
        self.scene = [s for s in map(read, self.scenes[self.dimension])
                      if name.encode() in s][0]
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
        self.restarts = True


def read(path):
    with open(path, 'rb') as f:
        return f.read()


def write(path, data):
    with open(path, 'wb') as f:
        f.write(data)


class Fuzzer:
    def __init__(self, arguments):
        self.a = arguments
        self.programs = {2: os.path.abspath(arguments.program_2d),
                         3: os.path.abspath(arguments.program_3d)}
        folders = {2: os.path.abspath(arguments.scenes_2d),
                   3: os.path.abspath(arguments.scenes_3d)}

        # The scenes of a page have meshes, in three dimensions, too.
        page = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..',
                            'doc', 'own-scene')

        def files(dimension, ending):
            return sorted(
                [os.path.join(folders[dimension], f)
                 for f in os.listdir(folders[dimension]) if f.endswith(ending)] +
                [os.path.join(page, f) for f in os.listdir(page)
                 if f.endswith(ending) and ('-3d' in f) == (dimension == 3)])
        self.scenes = {d: files(d, '.prm') for d in (2, 3)}
        self.meshes = {d: files(d, '.msh') for d in (2, 3)}
        self.found = os.path.abspath(arguments.found)
        self.n_inputs = 0
        self.findings = {}
        self.outcomes = {}

    def run(self, dimension, arguments):
        command = [self.programs[dimension]] + arguments
        if self.a.launcher:
            launcher, flag, n = self.a.launcher.split()
            command = [launcher, flag, n] + command
        try:
            done = subprocess.run(command, stdout=subprocess.PIPE,
                                  stderr=subprocess.PIPE, timeout=TIMEOUT)
            return (done.returncode, done.stdout.decode('utf-8', 'replace'),
                    done.stderr.decode('utf-8', 'replace'))
        except subprocess.TimeoutExpired:
            return (None, '', '')
        except ValueError as error:
            return (2, '', 'x: %s.' % error)  # no such argument can be given

    def problems(self, status, out, err):
        text = out + err
        if status is None:
            return 'does not end'
        if status < 0 or status > 3:
            return 'signal or status %d' % status
        if re.search(r'Stacktrace|AddressSanitizer|runtime error:|terminate called',
                     text):
            return 'stack trace or sanitizer'
        if status == 3:
            return 'error of the program'
        if status == 2:
            lines = [l for l in err.splitlines() if l.strip()]
            if self.a.launcher:
                # The launcher has something to say, too.
                lines = [l for l in lines if l.startswith('step-friction')]
            usage = any(l.startswith('Usage') for l in lines)
            if not lines:
                return 'no message'
            if not usage and (len(lines) > 3 or sum(map(len, lines)) > 1000):
                return 'long message'
            if not re.search(r'[.?)]$', lines[-1].rstrip()) and not usage:
                return 'no sentence'
        if status == 0 and re.search(r'\b-?(nan|inf)\b',
                                     ' '.join(l for l in out.splitlines()
                                              if re.match(r' *\d', l))):
            return 'nan in a table'
        if any('.part' in f for _, _, fs in os.walk('results') for f in fs):
            return 'half a file'
        return None

    def try_seed(self, seed):
        work = tempfile.mkdtemp()
        here = os.getcwd()
        try:
            os.chdir(work)
            try:
                case = Input(seed, self.scenes, self.meshes)
            except (ValueError, IndexError):
                return  # what is to be changed is not there
            self.n_inputs += 1
            limits = list(LIMITS)
            verify = (self.a.verify and not self.a.launcher and
                      random.Random(seed).random() < .5)
            if verify:
                limits.append('Output/Verification=true')
            arguments = ['scene.prm'] + case.options + limits
            if case.restarts:
                self.run(case.dimension, arguments + ['Output/Checkpoint=true'])
                files = [os.path.join(d, f) for d, _, fs in os.walk('results')
                         for f in fs if 'checkpoint' in d]
                if files:
                    name = case.random.choice(sorted(files))
                    write(name, case.change_bytes(read(name)))
                    arguments.append('Refinement/Levels=2')
                    arguments.append('--restart')
            result = self.run(case.dimension, arguments)
            problem = self.problems(*result)
            if problem is None and verify and result[0] == 0 and os.path.exists(
                    'results/history.h5'):
                done = subprocess.run([sys.executable, self.a.verify, 'results'],
                                      stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
                if done.returncode != 0:
                    problem = ('certificate refuted' if done.returncode == 1
                               else 'no verdict')
                    result = (result[0], result[1], done.stdout.decode())
            self.outcomes[result[0]] = self.outcomes.get(result[0], 0) + 1
            if problem:
                self.findings.setdefault(problem, []).append(seed)
                print('seed %d, %dD: %s' % (seed, case.dimension, problem), flush=True)
                folder = os.path.join(self.found, '%s-%d' % (
                    re.sub(r'\W+', '-', problem), seed))
                shutil.rmtree(folder, ignore_errors=True)
                shutil.copytree(work, folder)
                write(os.path.join(folder, 'arguments'), '\n'.join(arguments).encode())
                write(os.path.join(folder, 'output'),
                      ('status %s\n%s\n%s' % result).encode())
        finally:
            os.chdir(here)
            shutil.rmtree(work, ignore_errors=True)

    def replay(self, folder):
        """Runs a saved input: its files, the program's dimension in the folder's name,
        and the arguments, a line each, in the file of that name."""
        work = tempfile.mkdtemp()
        here = os.getcwd()
        try:
            shutil.copytree(folder, os.path.join(work, 'case'))
            os.chdir(os.path.join(work, 'case'))
            arguments = read('arguments').decode().split('\n')
            result = self.run(3 if '3d' in os.path.basename(folder) else 2, arguments)
            problem = self.problems(*result)
            self.n_inputs += 1
            self.outcomes[result[0]] = self.outcomes.get(result[0], 0) + 1
            if problem:
                self.findings.setdefault(problem, []).append(os.path.basename(folder))
                print('%s: %s' % (folder, problem))
                print('\n'.join(result[1:])[:2000])
        finally:
            os.chdir(here)
            shutil.rmtree(work, ignore_errors=True)

    def main(self):
        begin, seed = time.time(), self.a.seed
        if self.a.replay:
            for name in sorted(os.listdir(self.a.replay)):
                self.replay(os.path.abspath(os.path.join(self.a.replay, name)))
        else:
            self.try_seed(seed)
        while (not self.a.replay and time.time() - begin < self.a.seconds and
               (self.a.inputs is None or self.n_inputs < self.a.inputs)):
            seed += 1
            self.try_seed(seed)
        print('%d inputs, of which %s' % (self.n_inputs, ', '.join(
            '%d ended with status %s' % (n, s) for s, n in sorted(
                self.outcomes.items(), key=str))))
        for problem, seeds in sorted(self.findings.items()):
            print('%s: %d, seeds %s' % (problem, len(seeds),
                                       ' '.join(map(str, seeds[:10]))))
        if not self.findings:
            print('Nothing was found.')
        return 1 if self.findings else 0


if __name__ == '__main__':
    parser = argparse.ArgumentParser()
    for name in ('program_2d', 'program_3d', 'scenes_2d', 'scenes_3d', 'found'):
        parser.add_argument(name)
    parser.add_argument('--seconds', type=float, default=60.)
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--launcher', help='command that starts the programs on '
                        'several processes, with its arguments')
    parser.add_argument('--inputs', type=int)
    parser.add_argument('--verify')
    parser.add_argument('--replay')
    sys.exit(Fuzzer(parser.parse_args()).main())
