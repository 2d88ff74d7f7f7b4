"""The command line of friction-plot sweep."""

import argparse
import os
import shutil
from pathlib import Path

TEXT = """Runs a scene with several values of one entry, or with all pairs of values of
two, each in a directory of its own, and draws a chart or a map of what comes out on the
last level.

  friction-plot sweep SCENE.prm --set "Contact/Friction coefficient" 0.1 0.2 0.4
      --show max_pressure

If it is interrupted, the same command goes on where it was: runs that have ended are not
repeated, unless the scene or an entry has changed. A run that fails leaves a hole, which
the picture shows and a line explains; all others go on. The directory of the sweep gets
sweep.csv, with a row per run and all columns of the last level, and the picture. Quantities
are the columns of levels.csv, as 'max_pressure' or 'max pressure', and quotients of
two of them, as 'stick_half_width / contact_half_width'.

Exit status: 0 if all runs have ended well, 1 if there are holes, 2 if something is
wrong, 130 if it was interrupted."""


def positive(text):
    value = int(text)
    if value < 1:
        raise argparse.ArgumentTypeError("has to be 1 at least")
    return value


def parse_sweep(arguments):
    parser = argparse.ArgumentParser(
        prog="friction-plot sweep", description=TEXT, allow_abbrev=False,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", type=Path, metavar="SCENE.prm")
    parser.add_argument("entries", nargs="*", metavar="ENTRY=VALUE",
                        help="for all runs, as the programs take them")
    parser.add_argument("--set", nargs="+", action="append", required=True,
                        dest="axes", metavar=("ENTRY", "VALUE"),
                        help="an entry and its values; once or twice")
    parser.add_argument("--show", action="append", metavar="QUANTITY",
                        help="what is drawn, max_pressure if nothing is said; several "
                        "times for several charts")
    parser.add_argument("-d", "--directory", type=Path,
                        help="of the sweep; otherwise sweep-SCENE")
    parser.add_argument("-o", "--output", metavar="FILE",
                        help="the picture; otherwise sweep.png in the directory")
    parser.add_argument("--jobs", type=positive, default=1,
                        help="runs at the same time; otherwise one after the other")
    parser.add_argument("--processes", type=positive, default=1,
                        help="of each run, by mpirun")
    parser.add_argument("--program", metavar="PROGRAM",
                        help="which program runs the scene; otherwise step-friction-3d "
                        "if the scene lies in a directory step-friction-3d or its name "
                        "ends in -3d, and step-friction-2d if not")
    parser.add_argument("--draw", action="store_true",
                        help="run nothing, draw what is there")
    return parser.parse_args(arguments)


def find_program(options):
    """Where the program is that runs the scene, or None: beside friction-plot, or as
    the shell would find it."""
    name = options.program
    if name is None:
        in_space = (options.scene.stem.endswith("-3d")
                    or "step-friction-3d" in options.scene.resolve().parts)
        name = f"step-friction-{3 if in_space else 2}d"
    folder = os.environ.get("FRICTION_PROGRAMS", "")
    if os.sep not in name and folder and (Path(folder) / name).is_file():
        return str((Path(folder) / name).resolve())
    found = shutil.which(name)
    return str(Path(found).resolve()) if found else None
