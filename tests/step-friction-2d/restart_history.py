"""A run of several load steps is continued from each of the two checkpoints that it
keeps, and comes to the same end as if it had been left alone; and from none where the
mesh or the times are to be others. With two load steps one of the checkpoints is that of
the last mesh of the first step.

Usage: restart_history.py LAUNCHER PROGRAM SCENE SECTION/ENTRY=VALUE ...

LAUNCHER is what starts the program, with its arguments in one, or empty.
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile

import h5py
import numpy as np

TOLERANCE = 1e-6
failures = 0


def verdict(name, problems):
    global failures
    failures += bool(problems)
    print('%-8s%s%s' % ('FAILED' if problems else 'ok', name,
                        ''.join('\n        ' + p for p in problems)))


def run(directory, *options):
    command = [*sys.argv[1].split(), sys.argv[2], sys.argv[3], *sys.argv[4:],
               'Output/Directory=' + directory, 'Output/Checkpoint=true',
               'Output/Times=false', *options]
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          timeout=300, universal_newlines=True)


def checkpoints(directory):
    return sorted(f for f in os.listdir(directory) if f.startswith('checkpoint-'))


def lines(result):
    """What is printed, without the numbers of cycles and what follows from them, nor
    numbers that are zero but for rounding."""
    kept = []
    for line in result.stdout.splitlines():
        columns = line.split()
        if line.strip().startswith(('Forces on the body', 'error against', 'Warning')):
            continue
        if re.match(r' *\d+ +\d+', line):
            del columns[5:8]
            columns[5] = '%.6g' % float(columns[5])
        kept.append(' '.join(columns))
    return kept


def entries(path):
    """Of a file for ParaView, without the comment that says when it was made."""
    return [line for line in open(path).read().splitlines() if line[:1] != '#']


def compare(directory):
    """Of the file in the folder whole: a sentence for each difference."""
    problems = []
    with h5py.File('whole/history.h5') as a, h5py.File(directory + '/history.h5') as b:
        for key in a['levels']:
            if key.endswith('seconds') or key in (
                    'cycles', 'contraction', 'certificate', 'algebraic_error', 'outer',
                    'outer_iterations', 'attempts') or 'rho_tau' in key:
                continue
            x, y = a['levels'][key][()], b['levels'][key][()]
            if x.shape != y.shape:
                problems.append('%s has %s values' % (key, y.shape))
            elif not np.allclose(x, y, rtol=TOLERANCE, atol=TOLERANCE * np.abs(x).max()):
                problems.append('%s is %s instead of %s' % (key, y, x))
        forces = [{key: values[()] for key, values in h.get('forces', {}).items()}
                  for h in (a, b)]
        if list(forces[0]) != list(forces[1]):
            problems.append('other forces')
        for key in set(forces[0]) & set(forces[1]):
            x, y = (f[key] for f in forces)
            size = max(np.abs(values).max() for other, values in forces[0].items()
                       if other[:7] == key[:7])
            if x.shape != y.shape or np.abs(x - y).max() > TOLERANCE * size:
                problems.append('force %s' % key)
        if list(a['contact']) != list(b['contact']):
            problems.append('other levels of contact')
        for level in set(a['contact']) & set(b['contact']):
            x, y = a['contact'][level], b['contact'][level]
            for key in 'displacement', 'force', 'slip':
                size = np.abs(x[key][()]).max()
                if np.abs(x[key][()] - y[key][()]).max() > 1e-5 * size + 1e-14:
                    problems.append('%s on %s' % (key, level))
    return problems


def main():
    whole = run('whole')
    verdict('a run that is left alone',
            [] if whole.returncode == 0 else ['exit status %d' % whole.returncode,
                                              whole.stdout, whole.stderr])
    kept = checkpoints('whole')
    verdict('it keeps two checkpoints', [] if len(kept) == 2 else [str(kept)])
    with h5py.File('whole/history.h5') as history:
        last = history['levels/level'][-1]
        n_steps = len(history['steps/level'])
    verdict('the last is of the last step, of several',
            [] if n_steps > 1 and kept[-1] == 'checkpoint-%02d' % last
            else ['%s, %d steps' % (kept, n_steps)])

    for removed in range(2):
        shutil.copytree('whole', 'again')
        for checkpoint in kept[len(kept) - removed:]:
            shutil.rmtree('again/' + checkpoint)
        result = run('again', '--restart')
        problems = []
        if result.returncode != 0:
            problems += ['exit status %d' % result.returncode, result.stderr]
        elif lines(result) != lines(whole):
            problems += ['it prints something else:'] + [
                '%s | %s' % pair for pair in zip(lines(whole), lines(result))
                if pair[0] != pair[1]]
        else:
            problems += compare('again')
            for name in 'body.pvd', 'contact.pvd':
                if entries('again/' + name) != entries('whole/' + name):
                    problems.append('another ' + name)
            if checkpoints('again') != kept:
                problems.append('other checkpoints: %s' % checkpoints('again'))
        verdict('continued %s' % ('with the last step', 'with the step before')[removed],
                problems)
        shutil.rmtree('again')

    for name, option, pattern in [
            ('another mesh', 'Refinement/Levels=7', "'Refinement/Levels' has changed"),
            ('other times', 'Load steps/Times=0, 7', "'Load steps/Times' has changed")]:
        result = run('whole', '--restart', option)
        verdict(name, [] if result.returncode == 2 and pattern in result.stderr
                else ['exit status %d' % result.returncode, result.stderr])
    return 1 if failures else 0


work = tempfile.mkdtemp()
sys.argv[3] = os.path.abspath(sys.argv[3])
try:
    os.chdir(work)
    status = main()
finally:
    os.chdir('/')
    shutil.rmtree(work)
sys.exit(status)
