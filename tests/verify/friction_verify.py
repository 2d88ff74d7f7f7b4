#!/usr/bin/env python3
"""Recomputes what a run of step-friction-2d or step-friction-3d has found, and says
whether its certificate is true.

Usage: friction-verify DIRECTORY [--tolerance X] [--mesh FILE]

DIRECTORY is the output directory of a run with 'Output/Verification=true'. This
program shares no code with the one it looks at. From history.h5 it takes the scene
and the reported numbers, from verify-NN.h5 the mesh and the displacement of level NN.
Residual, gaps, normals, measures, hanging nodes and nodal loads it finds by itself, and
loads, prescribed displacements, material, obstacle and law of friction are compared
with what the scene says. If that has names of groups of a mesh file, FILE is this mesh
file, or what belongs to names is taken as the run had it. Needs Python with numpy and
h5py.

A row per level:

  equilibrium  largest force at a node, in a direction, that nothing holds
  penetration  largest depth of a node inside the obstacle
  tension      largest force that pulls, or that acts at a distance
  cone         by how much friction exceeds its bound
  slip         by how much friction where a node slides differs from the bound, or in
               direction from opposing the slip
  states       the same if nodes do what they are said to do: open, sliding, sticking
  given        displacements that are prescribed or interpolated, loads and all that the
               scene says, compared with what the run made of it
  energy       difference from the reported energy, relative to its parts

Forces at nodes are relative to that of the peak contact pressure, lengths count as the
forces that they need: the units of the certificate. All but 'given', which is exact, may
be as large as the tolerance of the certificate in the scene, or X, above 0 and up to
0.1. The certificate itself
must not be worse than reported.

Exit status: 0 confirmed, 1 refuted, 2 if there is nothing that could be read.
"""

import argparse
import sys
import traceback
from pathlib import Path

try:
    import h5py  # noqa: F401
    import numpy as np
except ImportError as error:
    print(f"friction-verify: Python has no module '{error.name}'; on Debian install "
          "python3-h5py.", file=sys.stderr)
    sys.exit(2)

from checks import verify_level
from run_data import Level, NotReadable, read_history
from scene_text import SceneText, group_names
from verdict import COLUMNS


def tolerance_of(scene, row):
    """Of the certificate of a level, from the scene."""
    tolerance = scene.number("Solver/Certificate tolerance")
    if scene["Solver/Inner tolerance"] == "discretisation" and row["level"] > 0:
        tolerance = max(tolerance, 1e-2)
    return tolerance


def read_level(text, path, groups=None):
    """What the run wrote of a level, and the scene in its dimension, with the names of
    groups."""
    level = Level(path)
    scene = SceneText(text, level.dim, level.time, groups)
    sections = scene.sections("Obstacle")
    for contact in level.contacts:
        section = sections.get(contact.number)
        if section is not None and scene[section + "/Kind"] == "surface":
            # Which is nothing but its expression.
            contact.obstacle = scene.obstacle(
                np.linalg.norm(np.ptp(level.vertices, axis=0)), section)
    return level, scene


def verify(directory, tolerance=None, mesh=None):
    """Prints the table; returns the exit status."""
    groups = group_names(mesh) if mesh else None
    text, rows = read_history(directory)
    files = [(row, directory / f"verify-{row['level']:02d}.h5") for row in rows]
    missing = [str(row["level"]) for row, path in files if not path.is_file()]
    files = [(row, path) for row, path in files if path.is_file()]
    if not files:
        raise NotReadable(f"there is no verify-NN.h5 in '{directory}': run the scene "
                          "with 'Output/Verification=true'.")

    print(f"{'level':>5} {'dofs':>9} " + " ".join(f"{c:>11}" for c in COLUMNS)
          + "  verdict")
    refuted, complaints, remarks, before = [], [], [], None
    for row, path in files:
        level, scene = read_level(text, path, groups)
        if level.level != row["level"]:
            raise NotReadable(f"'{path}' is that of another level.")
        verdict, unknown = verify_level(level, row, scene,
                                        tolerance or tolerance_of(scene, row), before)
        before = level
        remarks += [entry for entry in unknown if entry not in remarks]
        complaints += [f"Level {row['level']}: {c}." for c in verdict.complaints]
        if verdict.complaints:
            refuted.append(str(row["level"]))
        print(f"{row['level']:5d} {level.dim * level.n_nodes:9d} "
              + " ".join(f"{verdict.largest[c]:11.1e}" for c in COLUMNS)
              + ("  refuted" if verdict.complaints else "  confirmed"), flush=True)

    for complaint in complaints:
        print(complaint)
    for entry in remarks:
        print("Taken as the run had it, since this program does not understand what "
              f"the scene says: {entry}.")
    if missing:
        print("Not looked at, without a file verify-NN.h5: level "
              f"{', '.join(missing)}.")
    n = len(files)
    if refuted:
        print(f"The certificate is refuted on {len(refuted)} of {n} levels: "
              f"{', '.join(refuted)}.")
    else:
        print(f"The certificate is confirmed on {'all ' * (n > 1)}{n} "
              f"level{'s' * (n > 1)}.")
    return 1 if refuted else 0


def main():
    parser = argparse.ArgumentParser(
        prog="friction-verify", description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter, usage=argparse.SUPPRESS)
    parser.add_argument("directory", type=Path, help="output directory of a run")
    parser.add_argument("--tolerance", type=float, metavar="X",
                        help="largest violation, in place of the scene's")
    parser.add_argument("--mesh", type=Path, metavar="FILE",
                        help="the scene's mesh file, for names of groups")
    options = parser.parse_args()
    if options.tolerance is not None and not 0 < options.tolerance <= .1:
        print(f"friction-verify: the tolerance is {options.tolerance:g}, but it must be "
              "above 0 and at most 0.1.", file=sys.stderr)
        return 2
    try:
        return verify(options.directory, options.tolerance, options.mesh)
    except NotReadable as error:
        print(f"friction-verify: {error}", file=sys.stderr)
        return 2
    except Exception:  # Not 1, which would say that the run is wrong.
        traceback.print_exc()
        return 3


if __name__ == "__main__":
    sys.exit(main())
