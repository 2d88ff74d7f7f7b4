#!/usr/bin/env python3
"""Measures everything that the charts show and writes it into a folder:

    make_data.py --bin2d=PROGRAM --bin3d=PROGRAM --precision=PROGRAM
        --solvers=PROGRAM --scenes2d=FOLDER --scenes3d=FOLDER --runs=FOLDER
        --data=FOLDER [--quick] [--only=PART,...] [--maps=NAME,...] [--jobs=N]

The parts are precision, cycles, solvers, stopping and stability. What is
measured, and on which meshes, stands in runs.py. Nothing is written of a run that
did not end well; then this program does not, either."""

import argparse
import csv
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

import h5py
import numpy as np

import runs
from chart import DataError, Table
from map_fields import COLUMNS

BEGIN = time.monotonic()
# Also for scenes that stop when they are as exact as their mesh.
TIGHT = "Solver/Inner tolerance=1e-9"


def say(text):
    print(f"[{time.monotonic() - BEGIN:6.1f} s] {text}", flush=True)


def run(command, log, allowed=(0,)):
    """Runs a program with its output going to a file; its exit status."""
    log.parent.mkdir(parents=True, exist_ok=True)
    with open(log, "w") as file:
        status = subprocess.run([str(word) for word in command], stdout=file,
                                stderr=subprocess.STDOUT).returncode
    if status not in allowed:
        tail = "\n".join(log.read_text().splitlines()[-5:])
        raise DataError(f"{' '.join(map(str, command))}\nended with status "
                        f"{status}; the last lines of {log}:\n{tail}")
    return status


def append(table, other):
    """Adds the rows of another table with the same columns."""
    header, *rows = other.read_text().splitlines(keepends=True)
    with open(table, "r+") as file:
        if file.readline() != header:
            raise DataError(f"{other}: other columns.")
        file.seek(0, 2)
        file.writelines(rows)


def run_for(command, log):
    """Runs a program that is stopped when it takes far too long: what it has
    written till then counts."""
    log.parent.mkdir(parents=True, exist_ok=True)
    with open(log, "w") as file:
        try:
            subprocess.run([str(word) for word in command], stdout=file,
                           stderr=subprocess.STDOUT,
                           timeout=runs.LIMIT * runs.LIMIT_OF_CASE, check=True)
        except subprocess.TimeoutExpired:
            file.write("stopped\n")
        except subprocess.CalledProcessError as error:
            file.flush()
            tail = "\n".join(log.read_text().splitlines()[-5:])
            raise DataError(f"{' '.join(map(str, command))}\nended with status "
                            f"{error.returncode}; the last lines of {log}:\n"
                            f"{tail}") from error


def result(solver, row):
    """The last columns of a field of a map: whether it was solved, iterations,
    attempts, unknowns, seconds and a note."""
    if row is None:
        return ["no", "", "", "", "", "did not come to an end"]
    iterations, attempts = int(row["iterations"]), int(row["attempts"])
    seconds = float(row["setup_seconds"]) + float(row["solve_seconds"])
    cost = [attempts, row["dofs"], f"{seconds:.4g}"]
    if row["converged"] != "1":
        # How far it came in a given time says more of the machine.
        if row["failure"] or solver == "gauss-seidel":
            return ["no", "", *cost, row["failure"] or "stopped after "
                    f"{runs.LIMIT_OF_RELAXATION} seconds"]
        return ["no", iterations, *cost,
                f"certificate {float(row['certificate']):.0e} after "
                f"{iterations} iterations"]
    if (solver == "gauss-seidel" and
            float(row["solve_seconds"]) >= runs.LIMIT_OF_RELAXATION):
        return ["yes", "", *cost, "stopped after "
                f"{runs.LIMIT_OF_RELAXATION} seconds, and solved"]
    return ["yes", iterations, *cost,
            f"attempt {attempts}: {row['attempt']}" if attempts > 1 else ""]


class Measurements:
    def __init__(self, options):
        self.options = options
        self.runs, self.data = Path(options.runs), Path(options.data)
        self.programs = {2: options.bin2d, 3: options.bin3d}
        self.data.mkdir(parents=True, exist_ok=True)

    def scene(self, dim, name):
        return Path({2: self.options.scenes2d,
                     3: self.options.scenes3d}[dim]) / f"{name}.prm"

    def precision(self):
        for what in runs.precision(self.options.quick):
            half_widths = what.half_widths
            for strategy in ("adaptive", "uniform"):
                say(f"accuracy against work: {what.name}, {strategy}")
                reference, overrides = getattr(what, strategy)
                name = f"work-precision-{what.name}-{strategy}"
                table = self.data / f"{name}.csv"
                command = [self.options.precision, what.dim,
                           self.scene(what.dim, what.scene),
                           f"--table={table}",
                           f"Refinement/Strategy={strategy}", TIGHT,
                           *what.common, *overrides]
                if reference:
                    command.append(f"--reference={reference}")
                if half_widths:
                    command.append(f"--half-widths={half_widths}")
                run(command, self.runs / f"{name}.log")
                table = Table(table, ())
                half_widths = (f"{table.remark('contact_half_width'):.12g},"
                               f"{table.remark('stick_half_width'):.12g}")

        if self.options.quick:
            self.check_reference()

    def check_reference(self):
        """Where the exact solution is known, the errors against a reference have
        to fit those against the exact one: nearly orthogonal, the error of a level
        is what it lacks to the reference and the error of the latter."""
        say("errors against a reference and against the exact solution")
        coarse, finer = 2, 2
        errors = {}
        for name, overrides in (
                ("exact", [f"Refinement/Levels={coarse + finer}"]),
                ("reference", [f"Refinement/Levels={coarse}",
                               f"--reference=uniform:{finer}",
                               "Scene/Exact displacement="])):
            table = self.runs / f"check-{name}.csv"
            run([self.options.precision, 2, self.scene(2, "manufactured"),
                 f"--table={table}", "--half-widths=1,0.5", TIGHT, *runs.UNIFORM,
                 "Refinement/Initial refinements=1", *overrides],
                self.runs / f"check-{name}.log")
            errors[name] = Table(table, ("energy_error",))["energy_error"]
        exact = errors["exact"][:coarse + 1]
        sums = np.hypot(errors["reference"], errors["exact"][-1])
        if not np.allclose(sums, exact, rtol=1e-3):
            raise DataError("Errors against a reference do not fit those against "
                            f"the exact solution: {sums} and {exact}.")

    def cycles(self):
        for what in runs.cycles(self.options.quick):
            rows = []
            for friction in what.frictions:
                for correction in runs.CORRECTIONS:
                    for truncation in runs.TRUNCATIONS:
                        say(f"cycles: {what.scene}, F = {friction}, "
                            f"{correction}, {truncation}")
                        rows += self.cycles_of(what, friction, correction,
                                               truncation)
            self.write(f"cycles-{what.name}.csv",
                       ["friction", "truncation", "correction", "level", "dofs",
                        "cycles", "solved"], rows)

    def cycles_of(self, what, friction, correction, truncation):
        name = f"{what.name}-{friction}-{correction}-{truncation}"
        directory = self.runs / name.replace(" ", "-")
        history = directory / "history.h5"
        if history.exists():
            history.unlink()
        # Status 1 says that a level has not been solved, or is no solution, after its
        # history was written: a result like any other.
        status = run([self.programs[what.dim],
                      self.scene(what.dim, what.scene),
                      TIGHT, *what.overrides,
                      f"Output/Directory={directory}", "Output/Fields=false",
                      f"Contact/Friction coefficient={friction}",
                      f"Solver/Coarse correction={correction}",
                      f"Solver/Truncation={truncation}",
                      "Solver/Safeguards=false",
                      f"Solver/Maximum cycles={runs.MOST_CYCLES}"],
                     self.runs / f"{directory.name}.log", allowed=(0, 1))
        with h5py.File(history) as file:
            levels = {key: file["levels"][key][:]
                      for key in ("level", "dofs", "cycles")}
        last = len(levels["level"]) - 1
        return [[friction, truncation, correction, levels["level"][i],
                 levels["dofs"][i], levels["cycles"][i],
                 int(not (status == 1 and i == last))]
                for i in range(last + 1)]

    def stopping(self):
        columns = ("level", "dofs", "cycles", "solve_seconds", "energy",
                   "contact_nodes", "sticky_nodes")
        rows = []
        for dim, scene, overrides in runs.stopping(self.options.quick):
            for tolerance in ("1e-9", "discretisation"):
                say(f"when to stop: {scene}, {tolerance}")
                directory = self.runs / f"stopping-{scene}-{tolerance}"
                run([self.programs[dim], self.scene(dim, scene), *overrides,
                     f"Output/Directory={directory}", "Output/Fields=false",
                     f"Solver/Inner tolerance={tolerance}"],
                    self.runs / f"{directory.name}.log")
                with h5py.File(directory / "history.h5") as file:
                    levels = [file["levels"][name][:] for name in columns]
                rows += [[scene, tolerance, *values] for values in zip(*levels)]
        self.write("stopping.csv", ["scene", "tolerance", *columns], rows)

    def solvers(self):
        if not self.options.solvers:
            raise DataError("--solvers=PROGRAM is missing.")
        for what in runs.solvers(self.options.quick):
            say(f"all solvers: {what.name}")
            table = self.data / f"scaling-{what.name}.part"
            history = self.data / f"convergence-{what.name}.part"
            of_first = [] if what.history_of_larger else [f"--history={history}"]
            self.compare(what, f"solvers-{what.name}",
                         ["--every-level", f"--table={table}", *of_first,
                          *what.overrides])
            if what.larger:
                say(f"those that get so far: {what.name}, one more mesh")
                last = self.runs / f"larger-{what.name}.csv"
                of_last = ([f"--history={history}"] if what.history_of_larger
                           else [])
                self.compare(what, f"larger-{what.name}",
                             [f"--table={last}", *of_last,
                              f"--solvers={','.join(runs.WITHOUT_FACTORS)}",
                              *what.larger])
                append(table, last)
            for file in (table, history):
                file.replace(file.with_suffix(".csv"))

    def compare(self, what, name, arguments):
        run([self.options.solvers, what.dim, self.scene(what.dim, what.scene),
             f"--seconds={runs.patience(self.options.quick)}", TIGHT, *arguments],
            self.runs / f"{name}.log")

    def stability(self):
        if not self.options.solvers:
            raise DataError("--solvers=PROGRAM is missing.")
        maps = runs.stability(self.options.quick)
        if self.options.maps:
            maps = [what for what in maps
                    if what.name in self.options.maps.split(",")]
        for what in maps:
            say(f"stability: {what.name}")
            rows = []
            # Only programs run side by side, whose seconds are their own.
            with ThreadPoolExecutor(self.options.jobs) as pool:
                found = list(pool.map(partial(self.results_of, what), what.cases))
            for case, results in zip(what.cases, found):
                for solver in what.solvers:
                    for size in case.sizes:
                        rows.append([what.subject, what.problem_axis,
                                     case.problem, what.size_axis, size, solver,
                                     case.easy,
                                     *result(solver,
                                             results.get((solver, size)))])
            self.write(f"stability-{what.name}.csv", COLUMNS, rows)

    def results_of(self, what, case):
        """What the solvers have achieved, by solver and size."""
        name = f"stability-{what.name}-{case.problem}".replace(" ", "-")
        command = [self.options.solvers, case.dim,
                   self.scene(case.dim, case.scene),
                   f"--solvers={','.join(what.solvers)}",
                   f"--limit={runs.LIMIT}",
                   f"--seconds={runs.LIMIT_OF_RELAXATION}",
                   f"--repeat={runs.REPEAT}",
                   *case.options, TIGHT, *case.overrides]
        given = any(option.startswith("--guess=") for option in case.options)
        results = {}
        for size, way in case.sizes.items():
            log = self.runs / (f"{name}-{size}.log" if given else f"{name}.log")
            table = log.with_suffix(".csv")
            if given:
                run_for(command + way + [f"--table={table}"], log)
            elif not results:
                wanted = ",".join(map(str, case.sizes.values()))
                run_for(command + [f"--levels={wanted}", f"--table={table}"],
                        log)
            else:
                break
            with open(table, newline="") as file:
                for row in csv.DictReader(file):
                    if None in row.values():
                        break  # it was stopped while it wrote this
                    key = size if given else next(
                        key for key, level in case.sizes.items()
                        if level == int(row["level"]))
                    results[row["solver"], key] = row
        return results

    def write(self, name, header, rows):
        part = (self.data / name).with_suffix(".part")
        with open(part, "w", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(header)
            writer.writerows(rows)
        part.replace(self.data / name)


def main():
    parser = argparse.ArgumentParser()
    for name in ("bin2d", "bin3d", "precision", "scenes2d", "scenes3d", "runs",
                 "data"):
        parser.add_argument(f"--{name}", required=True)
    parser.add_argument("--solvers")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--maps", help="names of stability maps, the others are "
                        "left as they are")
    parser.add_argument("--jobs", type=int, default=1, help="how many problems of "
                        "a stability map are solved at a time; their seconds are "
                        "those of the processor")
    parser.add_argument("--only", default=",".join(runs.PARTS))
    options = parser.parse_args()
    measurements = Measurements(options)
    parts = {"precision": measurements.precision,
             "cycles": measurements.cycles, "solvers": measurements.solvers,
             "stopping": measurements.stopping,
             "stability": measurements.stability}
    try:
        for part in options.only.split(","):
            if part in parts:
                parts[part]()
            elif part not in runs.DRAWN_ONLY:
                raise DataError(f"There is nothing called '{part}' to measure.")
    except DataError as error:
        sys.exit(str(error))
    say("all data have been measured")


if __name__ == "__main__":
    main()
