#!/usr/bin/env python3
"""Has solvers solve problems drawn at random (random_problems.py), the same for
all, and writes what came of it:

    robustness_data.py --solvers=PROGRAM --work=FOLDER --table=FILE
        [--seeds2d=SEEDS] [--seeds3d=SEEDS] [--limit=SECONDS] [--all]
        [--default-only]
    robustness_data.py --show DIM SEED

PROGRAM is benchmark-solvers, SEEDS are numbers and ranges, as 1-6,17. A problem that
the product refuses is an error, since it was drawn to be well posed; with --all so is
one that the default does not solve. With --show a problem is printed as a scene file, and the options that
benchmark-solvers needs besides."""

import argparse
import csv
import subprocess
import sys
import time
from pathlib import Path

import runs
from random_problems import Problem

SOLVERS = ("default", "algorithm 3", "algorithm 2", "newton direct",
           "newton gmres")

COLUMNS = ("dim", "seed", "solver", "dofs", "contact", "sticking", "converged",
           "iterations", "seconds", "certificate", "attempts", "attempt",
           "failure")


def options_of(problem):
    return [f"--guess={problem.guess}", f"--inclusion={problem.inclusion:.6g}"]


def solve(problem, solvers, options):
    """The rows of one problem; what went wrong, if anything."""
    work, limit = options.work, options.limit
    name = f"{problem.dim}d-{problem.seed}"
    scene, table = work / f"{name}.prm", work / f"{name}.csv"
    scene.write_text(problem.scene())
    table.unlink(missing_ok=True)
    command = [options.program, problem.dim, scene, f"--table={table}",
               f"--limit={limit}", f"--repeat={runs.REPEAT}",
               f"--solvers={','.join(solvers)}",
               *options_of(problem)]
    with open(work / f"{name}.log", "w") as log:
        try:
            status = subprocess.run([str(word) for word in command], stdout=log,
                                    stderr=subprocess.STDOUT,
                                    timeout=20 * limit).returncode
        except subprocess.TimeoutExpired:
            status = "none, stopped"
    found = {}
    if table.is_file():
        with open(table, newline="") as file:
            found = {row["solver"]: row for row in csv.DictReader(file)}
    if status == 1 and not found:
        return [], f"{name} was refused: {(work / f'{name}.log').read_text()}"
    rows = []
    for solver in solvers:
        row = found.get(solver)
        if row is None:
            rows.append([problem.dim, problem.seed, solver, "", "", "", 0, "", "",
                         "", "", "", f"ended with status {status}"])
            continue
        seconds = float(row["setup_seconds"]) + float(row["solve_seconds"])
        rows.append([problem.dim, problem.seed, solver, row["dofs"],
                     row["contact"], row["sticking"], row["converged"],
                     row["iterations"], f"{seconds:.4g}",
                     f"{float(row['certificate']):.1e}", row["attempts"],
                     row["attempt"], row["failure"]])
    return rows, None


def seeds_of(text):
    seeds = []
    for part in text.split(","):
        ends = [int(number) for number in part.split("-")]
        seeds += range(ends[0], ends[-1] + 1)
    return seeds


def show(dim, seed):
    problem = Problem(dim, seed)
    print(problem.scene(), end="")
    print("# benchmark-solvers", *options_of(problem))


def main():
    if sys.argv[1:2] == ["--show"]:
        return show(*map(int, sys.argv[2:4]))
    parser = argparse.ArgumentParser()
    parser.add_argument("--solvers", dest="program", type=Path, required=True)
    parser.add_argument("--work", type=Path, required=True)
    parser.add_argument("--table", type=Path, required=True)
    parser.add_argument("--seeds2d", type=seeds_of, default=seeds_of("1-500"))
    parser.add_argument("--seeds3d", type=seeds_of, default=seeds_of("1-200"))
    parser.add_argument("--limit", type=float, default=30.)
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--default-only", action="store_true")
    options = parser.parse_args()
    options.work.mkdir(parents=True, exist_ok=True)
    options.table.parent.mkdir(parents=True, exist_ok=True)
    problems = [Problem(dim, seed)
                for dim, seeds in ((2, options.seeds2d), (3, options.seeds3d))
                for seed in seeds]
    begin, refused, unsolved = time.monotonic(), [], []
    part = options.table.with_suffix(".part")
    with open(part, "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        for n, problem in enumerate(problems, 1):
            rows, refusal = solve(
                problem, SOLVERS[:1] if options.default_only else SOLVERS, options)
            writer.writerows(rows)
            file.flush()
            if refusal:
                refused.append(refusal)
            elif str(rows[0][6]) != "1":
                unsolved.append(f"{problem.dim}D, seed {problem.seed}")
            if n % 20 == 0 or n == len(problems):
                print(f"[{time.monotonic() - begin:6.0f} s] {n} of "
                      f"{len(problems)}; not solved by default: "
                      f"{', '.join(unsolved) or 'none'}", flush=True)
    if refused:
        sys.exit("\n".join(refused))
    part.replace(options.table)
    if options.all and unsolved:
        sys.exit(f"not solved by default: {', '.join(unsolved)}")


if __name__ == "__main__":
    main()
