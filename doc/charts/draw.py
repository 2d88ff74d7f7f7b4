#!/usr/bin/env python3
"""Draws the charts from their data:

    draw.py DATA OUTPUT [--quick] [--only=PART,...]

The parts are precision, cycles, solvers, stopping, stability, bounds and runs. Missing or
impossible data are an error. Stability maps are drawn of all files
stability-*.csv that are there."""

import argparse
import sys
from pathlib import Path

import bounds
import convergence
import cycles
import runs
import scaling
import stability
import stopping
import whole_runs
import work_precision
from chart import DataError


def draw(part, data, output, quick):
    if part == "precision":
        for what in runs.precision(quick):
            work_precision.draw(data, output, what.name, what.subject)
    elif part == "cycles":
        for what in runs.cycles(quick):
            cycles.draw(data, output, what.name, what.subject, what.first_level)
    elif part == "solvers":
        for what in runs.solvers(quick):
            convergence.draw(data, output, what.name, what.subject)
            scaling.draw(data, output, what.name, what.subject,
                         runs.patience(quick))
    elif part == "stopping":
        stopping.draw(data, output, runs.STOPPING_SUBJECT)
    elif part == "stability":
        for path in sorted(data.glob("stability-*.csv")):
            stability.draw(path, output)
    elif part == "bounds":
        bounds.draw(output)
    elif part == "runs":
        whole_runs.draw(output)
    else:
        raise DataError(f"There is no kind of chart '{part}'.")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("data", type=Path)
    parser.add_argument("output", type=Path)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", default=",".join(runs.PARTS))
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    problems = []
    for part in options.only.split(","):
        try:
            draw(part, options.data, options.output, options.quick)
        except DataError as error:
            problems.append(str(error))
    if problems:
        sys.exit("\n".join(problems))


if __name__ == "__main__":
    main()
