#!/usr/bin/env python3
"""Draws the pictures of the idea pages, from runs of the step programs:

    draw.py --bin2d=PROGRAM --bin3d=PROGRAM --runs=FOLDER OUTPUT [--quick] [NAME ...]

A picture has the name of its page and is made by the module of that name in this
folder, with '_' for '-', in its function draw(workshop). Without names all of them
are drawn."""

import argparse
import importlib
import sys
from pathlib import Path

from drawing_of_ideas import Failure, Workshop

HERE = Path(__file__).resolve().parent
COMMON = ("draw", "drawing_of_ideas", "small_block")
PICTURES = sorted(path.stem.replace("_", "-") for path in HERE.glob("*.py")
                  if path.stem not in COMMON)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--bin2d", type=Path, required=True)
    parser.add_argument("--bin3d", type=Path, required=True)
    parser.add_argument("--runs", type=Path, required=True)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("output", type=Path)
    parser.add_argument("names", nargs="*")
    options = parser.parse_args()
    unknown = [name for name in options.names if name not in PICTURES]
    if unknown:
        sys.exit(f"There is no picture '{unknown[0]}'; there are "
                 f"{', '.join(PICTURES)}.")
    workshop = Workshop({2: options.bin2d, 3: options.bin3d},
                        options.runs, options.output, options.quick)
    problems = []
    for name in options.names or PICTURES:
        try:
            importlib.import_module(name.replace("-", "_")).draw(workshop)
        except Failure as failure:
            problems.append(f"{name}: {failure}")
    if problems:
        sys.exit("\n".join(problems))


if __name__ == "__main__":
    main()
