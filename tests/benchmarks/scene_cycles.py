#!/usr/bin/env python3
"""Cycles per level of scenes with several materials, contacts, given forces and load
steps, on one process and on several.

Usage: scene_cycles.py PROGRAM_2D PROGRAM_3D SCENES_2D SCENES_3D MPIEXEC DOFS PROCESSES
         DOFS_OF_VARIANTS

  DOFS              the first mesh of more is the last one
  PROCESSES         numbers of them, separated by commas; the others are compared with
                    the first one
  DOFS_OF_VARIANTS  the same for what is changed

For each scene and number of processes a row: the cycles of each level, those of each
later load step behind a bar, and on how many levels and steps the numbers of nodes in
contact or of sticking nodes are not those of the first number of processes. Scenes are
solved to 1e-9, never on contact nodes alone, and those that stop sooner also as they
are. Then come the cycles of some of them with one thing changed. The results go to the
standard output.
"""
import os
import subprocess
import sys
import tempfile

import h5py

program = {2: sys.argv[1], 3: sys.argv[2]}
scenes = {2: sys.argv[3], 3: sys.argv[4]}
mpiexec, dofs = sys.argv[5], int(sys.argv[6])
processes = [int(word) for word in sys.argv[7].split(",")]
# What makes a scene take many: the scene with one thing changed, on one process.
NU = "Material/Poisson ratio=0.3"
POINTWISE = "Material/Volumetric strain=pointwise"
FIRST = "Load steps/Times=0"
# Cycles of the multigrid method are meant, not those of contact nodes alone.
TIGHT = ["Solver/Inner tolerance=1e-9", "Solver/Condensation=never"]
SOLVER = "Solver/Coarse correction=algebraic"
VARIANTS = [
    ("wheel", "unchanged", []),
    ("wheel", "tyre as stiff as the rim",
     ["Material/Regions=where r > 0.75: 100, 0.48, mean"]),
    ("wheel", "tyre with a Poisson ratio of 0.3",
     ["Material/Regions=where r > 0.75: 1, 0.3"]),
    ("wheel", "both: one material", ["Material/Regions=where r > 0.75: 100, 0.3"]),
    ("wheel", "no friction", ["Contact/Friction law=none"]),
    ("wheel", "algebraic corrections", [SOLVER]),
    ("mindlin", "pressing, unchanged", [FIRST]),
    ("mindlin", "with a Poisson ratio of 0.3", [FIRST, NU, POINTWISE]),
    ("mindlin", "the same, and a turn", ["Load steps/Times=0, 1, 2, 3, 4, 5", NU,
                                         POINTWISE]),
    ("mindlin", "algebraic corrections", [FIRST, SOLVER]),
    ("rough", "unchanged", []),
    ("rough", "no friction", ["Contact/Friction law=none"]),
]

# Scenes that end after a number of levels have more of them here.
MORE = ["Refinement/Levels=25"]
ROWS = [(2, "inclined", MORE), (2, "wheel", []), (2, "pin", []), (2, "wall", []),
        (2, "rough", []), (2, "mindlin", MORE), (3, "ball-on-ball", MORE),
        (3, "mindlin", MORE)]
STOP_SOONER = [row for row in ROWS if row[1] in ("wheel", "pin", "rough", "mindlin")]


def run(dim, scene, n_processes, most, entries):
    """The columns of /levels."""
    with tempfile.TemporaryDirectory() as directory:
        command = [program[dim], os.path.join(scenes[dim], scene + ".prm"),
                   "Output/Directory=" + directory, "Output/Fields=false",
                   f"Refinement/Maximum dofs={most}", *entries]
        if n_processes > 1:
            command = [mpiexec, "-np", str(n_processes)] + command
        result = subprocess.run(command, text=True, capture_output=True)
        if result.returncode != 0:
            sys.exit(" ".join(command) + "\n" + result.stdout + result.stderr)
        with h5py.File(os.path.join(directory, "history.h5")) as file:
            return {key: value[:] for key, value in file["levels"].items()}


def cycles_of(levels):
    # Scenes without times have no load steps.
    steps = levels.get("load_step", [0] * len(levels["cycles"]))
    words = []
    for i, cycles in enumerate(levels["cycles"]):
        if i > 0 and steps[i] != steps[i - 1]:
            words.append("|")
        solutions = levels["outer_iterations"][i]
        words.append(str(cycles) + (f"/{solutions}" if solutions > 1 else ""))
    return " ".join(words)


def print_rows(rows, title, more):
    print(f"{title:20}  dofs   N  differ  cycles")
    first = {}
    for n in processes:
        for dim, scene, entries in rows:
            levels = run(dim, scene, n, dofs, [*entries, *more])
            one = first.setdefault((dim, scene), levels)
            differ = sum((levels["contact_nodes"] != one["contact_nodes"])
                         | (levels["sticky_nodes"] != one["sticky_nodes"]))
            print(f"{scene + f' ({dim}D)':18}{levels['dofs'][-1]:8d}{n:4d}{differ:8d}  "
                  f"{cycles_of(levels)}", flush=True)
    print()


print("Cycles on levels 0, 1, ...; those of later load steps, on the last mesh, behind "
      "bars.\nWhere a force is given, 12/7 are those of 7 solutions together. On N "
      "processes; 'differ'\nare levels and steps on which numbers of nodes in contact or "
      "sticking are not those of\nthe first number of processes.\n")
print_rows(ROWS, "to 1e-9", TIGHT)
print_rows(STOP_SOONER, "as they are", [])

most = int(sys.argv[8])
print(f"To 1e-9, with one thing changed, two dimensions, to {most} dofs.\n")
for scene, label, entries in VARIANTS:
    cycles = cycles_of(run(2, scene, 1, most, [*TIGHT, *entries]))
    print(f"{scene + ', ' + label:42}  {cycles}", flush=True)
