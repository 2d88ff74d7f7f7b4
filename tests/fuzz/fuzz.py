"""Scenes, meshes, checkpoints and arguments that are changed at random, given to the
programs: whatever they are, a run has to end with a result or with a sentence.

Usage: fuzz.py PROGRAM_2D PROGRAM_3D SCENES_2D SCENES_3D FOUND
         [--seconds N] [--inputs N] [--seed N] [--timeout N]
         [--processes N ...] [--launcher 'MPIEXEC FLAG'] [--verify SCRIPT]
         [--replay FOLDER]

Inputs are tried for so many seconds, and as many inputs at most, on each of the numbers
of PROCESSES, one after the other; on one process if none are given. Each input is made
from a number, its seed, which is printed with what is found and with which it can be
made again (--seed N --processes N --seconds 0 tries that one only). The first one is that
of the option or, so that other inputs are tried each time, from the time of the clock. An
input is a finding if the run
- ends by a signal, or with an exit status of its own that says "an error of the
  program" (3), or does not end within the seconds of --timeout,
- prints a stack trace, or a report of a sanitizer,
- refuses the input (exit status 2) without a message, or with one of more than three
  lines or a thousand characters, or that does not end like a sentence, or of several
  processes; or finds no solution (1) without saying so,
- prints "nan" or "inf" in the table of a run with exit status 0, or leaves no results,
- refuses the input before a level has been solved, and leaves other files in its
  directory than there were; or leaves files there that are not finished, its lock, a
  list of files that are not there, or anything elsewhere; or anything after --check,
- continues from checkpoints, one of which was damaged, and comes to another result than
  the run that wrote them,
- says that it has solved the problem, and the certificate is not confirmed by
  SCRIPT, a second program that reads what was written; that is done for half of the
  inputs.

In the end, or if it is interrupted, there is a table of what was tried: runs for each
kind of change, with the dimension and the number of processes, and with the exit status.
("checkpoint, before" are the runs that write the checkpoints, "checkpoint" those that
continue from damaged ones.) Exit status 1 if there were any findings.

Inputs of findings, up to 20 of each kind, are saved in the folder FOUND, a folder for
each: the files as they were before the run, checkpoints among them, in case.json the seed
as a name, the dimension, the number of processes and the arguments, in output what the
run has printed, and in left the results that it has left. With --replay such a folder, or
each folder in the one that is given, is tried in the place of new inputs. What was found
once, and has been mended, is kept, without output and left, in the folder corpus beside
this file.
"""
import argparse
import collections
import json
import os
import random
import re
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time

from inputs import Input, read, times, write

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
# Of each kind of finding.
MOST_SAVED = 20
# Small enough to be many.
LIMITS = ['Refinement/Levels=1', 'Refinement/Maximum dofs=2000', 'Output/Times=false',
          'Solver/Total cycles=300', 'Solver/Maximum cycles=60',
          'Solver/Maximum outer iterations=10', 'Output/Directory=results']
# Forces are found by up to 60 solutions on a mesh.
FORCE_LIMITS = ['Refinement/Maximum dofs=500', 'Solver/Total cycles=60',
                'Solver/Maximum cycles=30']


def rows(out):
    """The rows of the table that is printed."""
    return [l.split() for l in out.splitlines() if re.match(r' *\d+ +\d+ ', l)]


def contents(folder, outside=False):
    """Of all files of results, or of all other files: their names and what is in
    them."""
    found = {}
    for d, _, files in os.walk(folder):
        for f in files:
            name = os.path.relpath(os.path.join(d, f), folder)
            if name.startswith('results' + os.sep) != outside:
                found[name] = read(os.path.join(d, f))
    return found


def sanitizer_options():
    """What the tests of the sanitized programs set; nothing to other programs."""
    with open(os.path.join(ROOT, 'CMakePresets.json')) as f:
        presets = json.load(f)['testPresets']
    return {name: value.replace('${sourceDir}', ROOT) for preset in presets
            if preset['name'] == 'sanitize'
            for name, value in preset['environment'].items()}


def stop(process):
    """A launcher ends its processes if it is asked to, and cannot if it is killed."""
    process.terminate()
    try:
        process.wait(10)
    except subprocess.TimeoutExpired:
        pass
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass
    process.wait()


class Fuzzer:
    def __init__(self, arguments):
        self.a = arguments
        self.programs = {2: os.path.abspath(arguments.program_2d),
                         3: os.path.abspath(arguments.program_3d)}
        folders = {2: os.path.abspath(arguments.scenes_2d),
                   3: os.path.abspath(arguments.scenes_3d)}

        # The scenes of a page have meshes, in three dimensions, too.
        page = os.path.join(ROOT, 'doc', 'own-scene')

        def files(dimension, ending):
            return sorted(
                [os.path.join(folders[dimension], f)
                 for f in os.listdir(folders[dimension]) if f.endswith(ending)] +
                [os.path.join(page, f) for f in os.listdir(page)
                 if f.endswith(ending) and ('-3d' in f) == (dimension == 3)])
        self.scenes = {d: files(d, '.prm') for d in (2, 3)}
        self.meshes = {d: files(d, '.msh') for d in (2, 3)}
        self.environment = {**sanitizer_options(), **os.environ}
        # Where MPI has files of its own.
        self.temporary = tempfile.mkdtemp()
        self.found = os.path.abspath(arguments.found)
        self.n_processes = 1
        self.n_inputs = self.n_verified = 0
        self.script = arguments.verify and os.path.abspath(arguments.verify)
        if self.script and subprocess.run(
                [sys.executable, '-B', self.script, '--help'],
                stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode != 0:
            print('Certificates are not verified: %s cannot be run.' % self.script)
            self.script = None
        self.findings = {}
        self.statuses = collections.Counter()
        # By kinds of change.
        self.tried = collections.defaultdict(collections.Counter)

    def run(self, dimension, arguments):
        """Status, or None if it does not end, and what it has printed."""
        command = [self.programs[dimension]] + arguments
        environment = dict(self.environment, TMPDIR=self.temporary)
        if self.n_processes > 1:
            command = self.a.launcher.split() + [str(self.n_processes)] + command
        else:
            # Without a daemon, which would outlive the program.
            environment['OMPI_MCA_ess_singleton_isolated'] = '1'
        # Not pipes, which what is left of a run that was killed might hold open.
        with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
            try:
                process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=out,
                                           stderr=err, env=environment,
                                           start_new_session=True)
            except (ValueError, OSError) as error:
                return (2, '', 'x: %s.' % error)  # no such argument can be given
            try:
                process.wait(self.a.timeout)
                status = process.returncode
            except subprocess.TimeoutExpired:
                stop(process)
                status = None
            except KeyboardInterrupt:
                stop(process)
                raise
            texts = []
            for file in (out, err):
                file.seek(0)
                texts.append(file.read(1000000).decode('utf-8', 'replace'))
        return (status, *texts)

    def message_problem(self, err):
        """What is wrong with how an input has been refused."""
        if self.n_processes > 1:
            # The launcher has something to say, too.
            err = re.sub(r'^-{20,}\n.*?^-{20,}$', '', err, flags=re.M | re.S)
        lines = [l for l in err.splitlines() if l.strip()]
        if not lines:
            return 'no message'
        if any(l.startswith('Usage') for l in lines):
            return None
        if len(lines) > 3 or sum(map(len, lines)) > 1000:
            return 'long message'
        if not re.search(r'[.?)]$', lines[-1].rstrip()):
            return 'no sentence'
        if sum(bool(re.match(r'step-friction-\dd: ', l)) for l in lines) > 1:
            return 'message of several processes'
        return None

    def file_problem(self, arguments, status, out, before, after):
        """What is wrong with the files that a run has left, given those before."""
        if contents(after, outside=True) != contents(before, outside=True):
            return 'files elsewhere'
        old, new = contents(before), contents(after)
        if any(re.search(r'\.part\b|/\.lock$|/\.writable-', name) for name in new):
            return 'half a file'
        if '--check' in arguments:
            return 'files of a check' if (new != old or os.path.isdir(
                os.path.join(after, 'results')) != os.path.isdir(
                    os.path.join(before, 'results'))) else None
        # As long as no level has been solved, everything is as it was. A run that is
        # continued prints the rows of levels before again.
        known = [int(m.group(1)) for m in
                 (re.match(r'results/checkpoint-(\d+)/', name) for name in old) if m]
        n_repeated = min(known, default=0) if '--restart' in arguments else 0
        if status == 2 and len(rows(out)) <= n_repeated and new != old:
            return 'files of a run that was refused'
        if status == 0 and 'results/history.h5' not in new:
            return 'no results'
        for name, data in new.items():
            if name.endswith(('.pvd', '.pvtu', '.xdmf')) and data != old.get(name):
                listed = re.findall(rb'(?:file|Source)="([^"]*)"|([\w.-]+\.h5):', data)
                if any('results/' + (a or b).decode() not in new for a, b in listed):
                    return 'files that are listed and not there'
        return None

    def problem_of(self, arguments, result, before, after):
        """What is wrong with a run, or nothing: BEFORE and AFTER are folders in which it
        finds and leaves files."""
        status, out, err = result
        if re.search(r'Stacktrace|Sanitizer|runtime error:|terminate called', out + err):
            return 'stack trace or sanitizer'
        if status is None:
            return 'does not end'
        if status < 0 or status > 3:
            return 'signal or status %d' % status
        if status == 3:
            return 'error of the program'
        if status == 1 and not re.search('^No (convergence on level|solution)', out, re.M):
            return 'no convergence without a word'
        if status == 0 and any(re.search(r'\b(nan|inf)\b', ' '.join(row))
                               for row in rows(out)):
            return 'nan in a table'
        return ((self.message_problem(err) if status == 2 else None) or
                self.file_problem(arguments, status, out, before, after))

    def verify(self, arguments, result):
        """Whether the certificate is confirmed, if the run has one and wrote what that
        takes; what the second program says is added to the result."""
        if (not self.script or result[0] != 0 or '--check' in arguments or
                'Output/Verification=true' not in arguments):
            return None, result
        self.n_verified += 1
        try:
            done = subprocess.run([sys.executable, '-B', self.script, 'results'],
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                  timeout=self.a.timeout)
            status, text = done.returncode, done.stdout.decode('utf-8', 'replace')
        except subprocess.TimeoutExpired:
            status, text = None, ''
        problem = {0: None, 1: 'certificate refuted'}.get(status, 'no verdict')
        return problem, (result[0], result[1], result[2] + text)

    def row_problem(self, case, result):
        """A run that is continued has the table of the run before, as far as that went:
        the same meshes, and energies but for the accuracy of forces that are found."""
        if result[0] != 0:
            return None
        if len(rows(result[1])) < len(case.get('rows', [])):
            return 'a run that was continued has lost levels'
        for row, other in zip(rows(result[1]), case.get('rows', [])):
            if row[:3] != other[:3] or (abs(float(row[8]) - float(other[8])) >
                                        1e-3 * abs(float(other[8])) + 1e-12):
                return 'another result of a run that was continued'
        return None

    def examine(self, case):
        """Runs a case in the present folder. What is found is printed and saved."""
        before = os.path.join(self.temporary, 'before')
        shutil.rmtree(before, ignore_errors=True)
        shutil.copytree('.', before)
        arguments = case['arguments']
        result = self.run(case['dimension'], arguments)
        problem = self.problem_of(arguments, result, before, '.')
        if problem is None:
            problem = self.row_problem(case, result)
        if problem is None:
            problem, result = self.verify(arguments, result)
        self.statuses[result[0]] += 1
        tried = self.tried[case['kind']]
        tried[case['dimension'], case['processes']] += 1
        tried['status', result[0]] += 1
        if problem:
            self.add_finding(case, problem, result, before)
        return problem, result

    def add_finding(self, case, problem, result, before):
        print('%s, %dD, %d process%s: %s' % (
            case['name'], case['dimension'], case['processes'],
            'es' * (case['processes'] > 1), problem), flush=True)
        self.findings.setdefault(problem, []).append(case['name'])
        if self.a.replay:
            print('\n'.join(result[1:])[:2000])
            return
        if len(self.findings[problem]) > MOST_SAVED:
            return
        folder = os.path.join(self.found, '%dd-%s-%s' % (
            case['dimension'], re.sub(r'\W+', '-', problem), case['name']))
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(before, folder)
        with open(os.path.join(folder, 'case.json'), 'w') as f:
            json.dump(case, f, indent=1)
            f.write('\n')
        write(os.path.join(folder, 'output'), ('status %s\n%s\n%s' % result).encode())
        if os.path.isdir('results'):
            shutil.copytree('results', os.path.join(folder, 'left'))

    def try_seed(self, seed):
        work = tempfile.mkdtemp()
        here = os.getcwd()
        try:
            os.chdir(work)
            try:
                made = Input(seed, self.scenes, self.meshes)
            except (ValueError, IndexError, struct.error):
                return  # what is to be changed is not there, or cannot be written
            self.n_inputs += 1
            limits = LIMITS + FORCE_LIMITS * made.has_platens()
            if random.Random(seed).random() < .5:
                limits.append('Output/Verification=true')
            case = {'name': str(seed), 'kind': made.kind, 'dimension': made.dimension,
                    'processes': self.n_processes,
                    'arguments': ['scene.prm'] + made.options + limits}
            if made.restarts:
                case['arguments'] += made.first_options
                case['kind'] += ', before'
            problem, result = self.examine(case)
            if made.restarts and problem is None and made.damage('results'):
                case['arguments'] += made.later_options + ['--restart']
                case['kind'] = made.kind
                if not (times(made.scene) and made.later_options):
                    case['rows'] = rows(result[1])
                self.examine(case)
        finally:
            os.chdir(here)
            shutil.rmtree(work, ignore_errors=True)

    def replay(self, folder):
        """Runs a case that has been saved."""
        with open(os.path.join(folder, 'case.json')) as f:
            case = json.load(f)
        if case['processes'] > 1 and not self.a.launcher:
            print('%s: not tried without a launcher' % folder)
            return
        case['name'] = os.path.basename(folder)
        case.setdefault('kind', 'corpus')
        self.n_processes = case['processes']
        work = tempfile.mkdtemp()
        here = os.getcwd()
        try:
            shutil.copytree(folder, work, dirs_exist_ok=True,
                            ignore=shutil.ignore_patterns('case.json', 'output', 'left'))
            os.chdir(work)
            self.n_inputs += 1
            problem, result = self.examine(case)
            if problem is None:
                print('%s: status %s' % (case['name'], result[0]))
        finally:
            os.chdir(here)
            shutil.rmtree(work, ignore_errors=True)

    def try_inputs(self, seed):
        """On the present number of processes, for the time given; returns the next
        seed."""
        begin, n_before = time.time(), self.n_inputs
        while True:
            self.try_seed(seed)
            seed += 1
            if (time.time() - begin >= self.a.seconds or
                    self.n_inputs - n_before == self.a.inputs):
                return seed

    def try_all(self):
        if self.a.replay:
            folder = os.path.abspath(self.a.replay)
            if os.path.exists(os.path.join(folder, 'case.json')):
                self.replay(folder)
            else:
                for name in sorted(os.listdir(folder)):
                    self.replay(os.path.join(folder, name))
        else:
            seed = self.a.seed
            if seed is None:
                # So many that no other run comes to the same ones.
                seed = int(time.time()) * 100
            print('The first seed is %d.' % seed, flush=True)
            for self.n_processes in self.a.processes:
                seed = self.try_inputs(seed)

    def print_tried(self):
        """A table of all runs: kinds of change, dimensions and processes, statuses."""
        print('%d inputs in %d runs, %d of them verified' % (
            self.n_inputs, sum(self.statuses.values()), self.n_verified))
        columns = [(d, n) for n in (1, 2) for d in (2, 3)]
        columns += sorted({(d, n) for tried in self.tried.values() for d, n in tried
                           if d != 'status' and n > 2})
        columns += [('status', s) for s in sorted(self.statuses, key=str)]
        names = ['no end' if n is None else 'status %d' % n if d == 'status' else
                 '%dD, -np %d' % (d, n) for d, n in columns]
        print('%-20s' % 'changed' + ''.join('%11s' % name for name in names))
        total = sum(self.tried.values(), collections.Counter())
        for kind, tried in sorted(self.tried.items()) + [('all', total)]:
            print('%-20s' % kind + ''.join('%11d' % tried[c] for c in columns))

    def main(self):
        signal.signal(signal.SIGTERM, signal.default_int_handler)
        try:
            self.try_all()
        except KeyboardInterrupt:
            print('Interrupted.')
        self.print_tried()
        for problem, seeds in sorted(self.findings.items()):
            print('%s: %d, %s' % (problem, len(seeds), ' '.join(seeds[:10])))
        if not self.findings:
            print('Nothing was found.')
        return 1 if self.findings else 0


if __name__ == '__main__':
    parser = argparse.ArgumentParser()
    for name in ('program_2d', 'program_3d', 'scenes_2d', 'scenes_3d', 'found'):
        parser.add_argument(name)
    parser.add_argument('--seconds', type=float, default=60.)
    parser.add_argument('--seed', type=int)
    parser.add_argument('--timeout', type=float, default=60.)
    parser.add_argument('--processes', type=int, nargs='+', default=[1])
    parser.add_argument('--launcher', help='command that starts the programs on '
                        'several processes, but for their number')
    parser.add_argument('--inputs', type=int)
    parser.add_argument('--verify')
    parser.add_argument('--replay')
    options = parser.parse_args()
    if max(options.processes) > 1 and not options.launcher:
        parser.error('several processes need a --launcher')
    fuzzer = Fuzzer(options)
    try:
        status = fuzzer.main()
    finally:
        shutil.rmtree(fuzzer.temporary, ignore_errors=True)
    sys.exit(status)
