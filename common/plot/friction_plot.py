#!/usr/bin/env python3
"""Draws what runs of step-friction-2d and step-friction-3d have left in their output
directories, and runs a scene with several values of one entry or two.

  friction-plot DIRECTORY                 the picture of a run
  friction-plot DIRECTORY DIRECTORY ...   several runs compared
  friction-plot sweep SCENE.prm ...       see friction-plot sweep --help

The picture of a run shows the body with its mesh and its stresses, displaced as it is;
the contact zone enlarged; along the contact boundary the pressure and the tangential
stress with what friction allows, and which nodes are open, slide and stick; the residual
after each cycle; cycles and numbers of unknowns and of nodes in contact level by level.
In space the body is seen from the side of the obstacle, and its contact boundary is
drawn as a map, unrolled if it is round. Compared are contact stresses (in the plane),
peak pressure, tangential force, cycles and residuals.

Axes have units if the scene names them in 'Output/Units'. Exit status: 0 drawn, 2 if
something is wrong, which one sentence says."""

import argparse
import sys
from importlib.util import find_spec
from pathlib import Path

NEEDED = {"matplotlib": "python3-matplotlib", "h5py": "python3-h5py",
          "numpy": "python3-numpy", "PIL": "python3-pil"}
NAME = "friction-plot"



def parse_drawing(arguments):
    parser = argparse.ArgumentParser(
        prog=NAME, description=__doc__, allow_abbrev=False,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directories", nargs="+", metavar="DIRECTORY",
                        help="output directory of a run")
    parser.add_argument("-o", "--output", metavar="FILE",
                        help="the picture, a .png, .svg or .pdf; otherwise picture.png "
                        "in the directory, or comparison.png here")
    parser.add_argument("--level", type=int, help="which level; otherwise the last one")
    parser.add_argument("--show", default="body,contact,convergence", metavar="PANELS",
                        help="some of body,contact,convergence")
    parser.add_argument("--field", default="von_Mises_stress",
                        help="what colours the body: von_Mises_stress, stress_xx, "
                        "displacement_y, estimated_error, ... ('?' lists all)")
    parser.add_argument("--range", nargs=2, type=float, metavar=("LEAST", "MOST"),
                        help="of the scale of the body's colours")
    parser.add_argument("--warp", type=float, default=1., metavar="FACTOR",
                        help="of displacements; 1 is to scale")
    return parser.parse_args(arguments)


def draw(options):
    """Draws runs; returns the name of the picture. What takes long to load is loaded
    when everything has been looked at."""
    from choice import PANELS, Choice
    from failure import Failure
    from fields import field_names, read_fields
    from history import Run
    from write_picture import check_ending, write_picture

    panels = options.show.split(",")
    for panel in panels:
        if panel not in PANELS:
            raise Failure(f"there is no panel '{panel}'; there are "
                          f"{', '.join(PANELS)}.")
    if options.range and not options.range[0] < options.range[1]:
        raise Failure("the range of colours has to end above its beginning.")
    one = len(options.directories) == 1
    if not one and (options.level is not None or options.range or options.warp != 1.):
        raise Failure("--level, --range and --warp are for the picture of one run.")
    output = check_ending(options.output) if options.output else None
    runs = [Run(directory) for directory in options.directories]
    if one and options.field == "?":
        level = runs[0].last if options.level is None else options.level
        mesh = read_fields(runs[0].directory, "body", level)
        return ("" if mesh is None else "\n".join(field_names(mesh)))
    if one:
        from draw_run import draw_run

        output = output or check_ending(runs[0].directory / "picture.png")
        figure = draw_run(runs[0], Choice(options.level, panels, options.field,
                                          options.range, options.warp))
    else:
        from draw_comparison import draw_comparison

        output = output or check_ending(Path("comparison.png"))
        figure = draw_comparison(runs)
    write_picture(figure, output)
    return f"{output}"


def without(name):
    """A sentence about a module that is missing."""
    name = (name or "").split(".")[0]
    return (f"Python has no module '{name}'; on Debian install "
            f"{NEEDED.get(name, name)}.")


def main(arguments):
    is_sweep = arguments[:1] == ["sweep"]
    if is_sweep:
        from sweep_options import parse_sweep
        options = parse_sweep(arguments[1:])
    else:
        options = parse_drawing(arguments)
    from failure import Failure
    try:
        for name in NEEDED:
            if find_spec(name) is None:
                raise Failure(without(name))
        if is_sweep:
            from sweep import sweep
            return sweep(options)
        print(draw(options))
        return 0
    except Failure as failure:
        print(f"{NAME}: {failure}", file=sys.stderr)
    except ImportError as error:
        # A module that is there may want another one that is not.
        print(f"{NAME}: {without(error.name)}", file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
