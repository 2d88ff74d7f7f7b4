"""Scenes and meshes that are not what they should be: each is refused in a sentence,
or solved with a warning, and nothing wrong is solved without a word. They are those of
wrong_scenes.py, and some that take more than one run.

Usage: wrong_input.py PROGRAM_2D PROGRAM_3D
"""
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile

from gmsh_writer import write_mesh
from wrong_meshes import CELL, EDGES, SQUARE, make_meshes
from wrong_scenes import CASES, D, N, R, SCENES, T, mesh


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
        return self.start(dimension, 'scene.prm', *options)

    def start(self, dimension, *arguments):
        return subprocess.run([self.programs[dimension], *arguments], timeout=120,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, text=True)

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
        status = 2 if expected.endswith('error') else 1 if expected == 'unsolved' else 0
        if result.returncode != status:
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
        elif expected == 'unsolved':
            for pattern in patterns:
                if len(re.findall(pattern, result.stdout)) != 1:
                    problems.append('not found once: ' + pattern)
            if re.search('^(Peak|Forces)', result.stdout, re.M):
                problems.append('something of a solution')
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
        # With the same cells and ids, where two groups have exchanged their names.
        entries = mesh('changing', **{'Output/Checkpoint': 'true', D:
                                      'left: 0, free; top: 0.01, -0.01'})
        for levels, ids, arguments in ('1', (1, 2), ()), ('2', (2, 1), ('--restart',)):
            names = [(1, ids[0], 'left'), (1, ids[1], 'right'), (1, 4, 'top')]
            write_mesh('changing.msh', SQUARE, EDGES + CELL, names)
            result = self.run('mesh', dict(entries, **{'Refinement/Levels': levels}),
                              *arguments)
        self.verdict('13: a restart with names exchanged',
                     [] if result.returncode == 2 and 'names of physical groups' in
                     result.stderr else ['no error'], result)

    def check_file_that_is_a_directory(self):
        """Nothing of ours, so that it stays, and nothing can be written there."""
        for name in 'body-00.pvtu', 'body-00.h5', 'body.pvd', 'history.h5':
            os.makedirs('kept/%s/mine' % name)
            result = self.run('moved', {'Output/Format':
                                        'hdf5' if name == 'body-00.h5' else 'vtu',
                                        'Output/Directory': 'kept'})
            shutil.rmtree('kept')
            self.verdict('13: a directory with the name %s' % name,
                         [] if result.returncode == 2 and name in result.stderr and
                         result.stderr.count('\n') == 1 else ['no error'], result)

    def check_streams(self):
        """A scene that begins with the mark of UTF-8; and standard output that is full,
        where the system has such a file."""
        self.run('moved', {})
        with open('scene.prm', 'rb') as f:
            text = f.read()
        with open('scene.prm', 'wb') as f:
            f.write(b'\xef\xbb\xbf' + text)
        result = self.start(2, 'scene.prm', '--check')
        self.verdict('b: a scene with the mark of UTF-8',
                     ['exit status'] if result.returncode else [], result)
        if os.path.exists('/dev/full'):
            for arguments in ['scene.prm'], ['--help']:
                with open('/dev/full', 'w') as full:
                    result = subprocess.run([self.programs[2], *arguments],
                                            stdout=full, stderr=subprocess.PIPE,
                                            universal_newlines=True)
                result.stdout = ''
                self.verdict('b: standard output that is full, ' + arguments[0],
                             [] if result.returncode == 2 and
                             'standard output cannot be written' in result.stderr
                             else ['no error'], result)

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


def main():
    # Each program is on one process, and need not start a daemon for others; without
    # one, programs of other tests would have the same directory for their files.
    os.environ['OMPI_MCA_ess_singleton_isolated'] = '1'
    programs = {dimension: os.path.abspath(program)
                for dimension, program in zip((2, 3), sys.argv[1:])}
    runner = Runner(programs)
    work = tempfile.mkdtemp()
    os.environ['TMPDIR'] = work
    try:
        os.chdir(work)
        make_meshes()
        for case in CASES:
            runner.check(case)
        runner.check_same_tables()
        runner.check_slope()
        runner.check_restart()
        runner.check_file_that_is_a_directory()
        runner.check_check()
        runner.check_streams()
    finally:
        os.chdir('/')
        shutil.rmtree(work)
    print('%d failed' % runner.failures)
    return 1 if runner.failures else 0


if __name__ == '__main__':
    sys.exit(main())
