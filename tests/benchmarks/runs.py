#!/usr/bin/env python3
"""Whole runs: seconds, their parts, and memory, beside other programs.

Usage: runs.py PROGRAM_2D PROGRAM_3D LINEAR SCENES_2D SCENES_3D
               [--before PROGRAM_2D PROGRAM_3D] [--repeat N] [--quick]

PROGRAM_*  the step programs;
LINEAR     benchmark-linear_program, a plain program for linear elasticity in the
           manner of step-40;
SCENES_*   the folders of the scene files;
--before   step programs to compare with, those of an older state; entries of
           scene files that they do not know are left out for them.

Every program is a process of its own, on one processor core. Programs that are
compared take turns, N times; what counts is the quickest run of each. Seconds are
those from the start of the process to its end, memory is the largest that it had.
"""

import argparse
import os
import re
import subprocess
import sys
import tempfile
import time

import h5py

TABLE = re.compile(r"^ +(\d+) +\d+ +(\d+) +(\d+) +(\d+) +(\d+) +(\d+) ")
PART = re.compile(r"^(\S.*?) +([\d.]+) +([\d.]+)%$", re.M)

# One process by itself, on one processor core.
ENVIRONMENT = dict(os.environ,
                   OMPI_ALLOW_RUN_AS_ROOT="1",
                   OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                   OMPI_MCA_ess_singleton_isolated="1",
                   OMP_NUM_THREADS="1",
                   DEAL_II_NUM_THREADS="1")


def seconds_of_parts(output):
    """What `Output/Profile = true` says of the parts of a run."""
    return {m.group(1): float(m.group(2)) for m in PART.finditer(output)}


class Run:
    """One run of a program: its seconds, peak memory and output."""

    def __init__(self, command):
        with tempfile.TemporaryFile("w+") as output:
            begin = time.monotonic()
            process = subprocess.Popen(command, stdout=output,
                                       stderr=subprocess.STDOUT,
                                       env=ENVIRONMENT)
            _, status, usage = os.wait4(process.pid, 0)
            self.seconds = time.monotonic() - begin
            process.returncode = os.waitstatus_to_exitcode(status)
            self.bytes = usage.ru_maxrss * 1024
            output.seek(0)
            self.output = output.read()
        if process.returncode != 0:
            sys.exit("%s ends with %d:\n%s" % (" ".join(command),
                                               process.returncode,
                                               self.output))

    def dofs(self):
        rows = [m for m in map(TABLE.match, self.output.split("\n")) if m]
        if not rows:
            sys.exit("there is no table of levels in\n" + self.output)
        return int(rows[-1].group(2))

    def main_parts(self, directory):
        """Seconds of solutions, of what is set up for them, and of all else.
        @param directory  where the run has its results."""
        with h5py.File(os.path.join(directory, "history.h5")) as file:
            solution, setup = (sum(file["levels"][name][:])
                               for name in ("solve_seconds", "setup_seconds"))
        return solution, setup, self.seconds - solution - setup

    def parts(self):
        return seconds_of_parts(self.output)


def best(commands, repeat, directory=None):
    """The quickest run of each command; they take turns."""
    runs = [[] for _ in commands]
    for _ in range(repeat):
        for command, its in zip(commands, runs):
            its.append(Run(command))
            if directory:
                its[-1].main = its[-1].main_parts(directory)
    return [min(its, key=lambda run: run.seconds) for its in runs]


def known_scene(binary, scene, directory):
    """A copy of a scene file without the entries that a program does not know."""
    with open(scene, encoding="utf-8") as file:
        lines = file.read().split("\n")
    copy = os.path.join(directory, os.path.basename(scene))
    while True:
        with open(copy, "w", encoding="utf-8") as file:
            file.write("\n".join(lines))
        output = subprocess.run(
            [binary, copy, "Refinement/Levels=0", "Output/Fields=false",
             "Output/Directory=" + os.path.join(directory, "known")],
            env=ENVIRONMENT, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
            check=False).stdout
        unknown = re.search(r":(\d+): there is no entry", output)
        if not unknown:
            return copy
        lines[int(unknown.group(1)) - 1] = ""


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("programs", nargs=5)
    parser.add_argument("--before", nargs=2)
    parser.add_argument("--repeat", type=int, default=4)
    parser.add_argument("--quick", action="store_true")
    arguments = parser.parse_args()
    program = dict(zip("23", arguments.programs[:2]))
    linear = arguments.programs[2]
    scenes = dict(zip("23", arguments.programs[3:]))
    before = dict(zip("23", arguments.before)) if arguments.before else None
    repeat = 1 if arguments.quick else arguments.repeat

    # dimension, scene, entries; refinements from the coarse mesh for the linear
    # program, or none.
    uniform = ["Refinement/Strategy=uniform", "Refinement/Maximum dofs=10000000"]
    cases = [
        ("2", "hertz", uniform + ["Refinement/Levels=7"], None),
        ("2", "block", uniform + ["Refinement/Levels=9",
                                  "Refinement/Initial refinements=0"], 9),
        ("3", "cylinder", ["Refinement/Maximum dofs=400000"], None),
        ("3", "block", uniform + ["Refinement/Levels=4",
                                  "Refinement/Initial refinements=1"], 5),
        ("3", "block", uniform + ["Refinement/Levels=5",
                                  "Refinement/Initial refinements=1"], 6)]
    if arguments.quick:
        cases = [
            ("2", "block", uniform + ["Refinement/Levels=3",
                                      "Refinement/Initial refinements=0"], 3),
            ("3", "block", uniform + ["Refinement/Levels=1",
                                      "Refinement/Initial refinements=1"], 2)]

    parts_of, main_parts_of = [], []
    print("Whole runs with friction, default output, to the default tolerance; "
          "the quickest of %d" % repeat)
    print("%-9s %s  %9s %9s %9s  %s" %
          ("scene", "", "dofs", "seconds", "B/dof", "" if not before else
           "   before     B/dof     ratio"))
    with tempfile.TemporaryDirectory() as directory:
        results = os.path.join(directory, "run")

        def command(binary, dim, scene, entries):
            path = os.path.join(scenes[dim], scene + ".prm")
            if before and binary == before[dim]:
                path = known_scene(binary, path, directory)
            return [binary, path, "Output/Directory=" + results,
                    "Output/Profile=true", "Output/Verbosity=levels", *entries]

        for dim, scene, entries, _ in cases:
            commands = [command(program[dim], dim, scene, entries)]
            if before:
                commands.append(command(before[dim], dim, scene, entries))
            runs = best(commands, repeat, results)
            dofs = runs[0].dofs()
            main_parts_of.append((scene, dim, dofs, [run.main for run in runs]))
            row = "%-9s %sD %9d %9.2f %9.0f" % (
                scene, dim, dofs, runs[0].seconds, runs[0].bytes / dofs)
            if before:
                row += "  %9.2f %9.0f %9.2f" % (
                    runs[1].seconds, runs[1].bytes / dofs,
                    runs[0].seconds / runs[1].seconds)
            print(row, flush=True)
            parts_of.append(("%s %sD" % (scene, dim),
                             [run.parts() for run in runs]))

        print("\nWhat is in these seconds: solutions, what is set up for them "
              "(degrees of freedom,\nassembly, levels), and all else")
        print("%-9s %s  %9s         %9s %9s %9s" % (
            "scene", "", "dofs", "solution", "set-up", "all else"))
        for scene, dim, dofs, its in main_parts_of:
            for name, seconds in zip(("now", "before"), its):
                print("%-9s %sD %9d %-7s %9.2f %9.2f %9.2f" % (
                    scene, dim, dofs, name, *seconds))

        print("\nParts of these runs, seconds%s" %
              (" (before, where that program tells)" if before else ""))
        for name, runs in parts_of:
            print(name)
            for part, seconds in runs[0].items():
                row = "  %-22s %8.2f %5.1f%%" % (
                    part, seconds, 100 * seconds / max(runs[0]["all"], 1e-9))
                if len(runs) > 1 and part in runs[1]:
                    row += " %8.2f" % runs[1][part]
                print(row)

        print("\nThe same mesh, a plain linear program; neither output nor "
              "estimates on either side")
        print("%-9s %s  %9s %9s %9s  %9s %9s  %7s %7s" %
              ("scene", "", "dofs", "friction", "B/dof", "linear", "B/dof",
               "seconds", "memory"))
        for dim, scene, entries, refinements in cases:
            if refinements is None:
                continue
            friction, plain = best(
                [command(program[dim], dim, scene,
                         entries + ["Output/Fields=false",
                                    "Refinement/Estimate error=false"]),
                 [linear, dim, os.path.join(scenes[dim], scene + ".prm"),
                  str(refinements)]], repeat)
            dofs = friction.dofs()
            if plain.output.split()[0] != str(dofs):
                sys.exit("the meshes differ: %d and %s" % (dofs, plain.output))
            print("%-9s %sD %9d %9.2f %9.0f  %9.2f %9.0f  %7.2f %7.2f" % (
                scene, dim, dofs, friction.seconds, friction.bytes / dofs,
                plain.seconds, plain.bytes / dofs,
                friction.seconds / plain.seconds, friction.bytes / plain.bytes))
            print("  linear: " + plain.output.strip(), flush=True)


if __name__ == "__main__":
    main()
