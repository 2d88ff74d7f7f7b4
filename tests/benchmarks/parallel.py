#!/usr/bin/env python3
"""Several processes: the same results, the time they save, what they send.

Usage: parallel.py PROGRAM_2D PROGRAM_3D SCENES_2D SCENES_3D MPIEXEC PART...

Parts: "scenes" runs every scene on 1, 2, 4 and 8 processes, solved to 1e-9, and
compares the protocols; "speed" compares two processes with one, by phase, and "runs"
does so for whole runs, by their parts; "communication" counts what is sent per
cycle; "largest" solves the largest problems that fit into 24 GiB. The results go to
the standard output.
"""
import glob
import os
import re
import subprocess
import sys
import tempfile

import h5py

from runs import seconds_of_parts

program = {2: sys.argv[1], 3: sys.argv[2]}
scenes = {2: sys.argv[3], 3: sys.argv[4]}
mpiexec = sys.argv[5]
environment = dict(
    os.environ,
    OMPI_ALLOW_RUN_AS_ROOT="1",
    OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
    OMPI_MCA_rmaps_base_oversubscribe="1",
    OMP_NUM_THREADS="1",
    DEAL_II_NUM_THREADS="1",
    PMIX_MCA_mca_base_suppress_deprecated_warning="1",
    PRTE_MCA_rmaps_default_mapping_policy=":oversubscribe",
)


def run_whole(dim, scene, n_processes, *entries):
    """Runs a scene; returns the columns of /levels and what was printed."""
    with tempfile.TemporaryDirectory() as directory:
        command = [program[dim], os.path.join(scenes[dim], scene + ".prm"),
                   "Output/Directory=" + directory,
                   "Output/Profile=true", "Output/Verbosity=levels", *entries]
        if n_processes > 1:
            command = [mpiexec, "-np", str(n_processes)] + command
        result = subprocess.run(command, env=environment, text=True,
                                capture_output=True)
        if result.returncode != 0:
            sys.exit(" ".join(command) + "\n" + result.stdout + result.stderr)
        with h5py.File(os.path.join(directory, "history.h5")) as file:
            levels = {key: value[:] for key, value in file["levels"].items()}
    return levels, result.stdout


def run(dim, scene, n_processes, *entries):
    """Runs a scene without fields; returns the columns of /levels and the profile
    of the last level: a dictionary of rows, each with messages, bytes and
    reductions per cycle, seconds, seconds of waiting; and bytes per dof."""
    levels, output = run_whole(dim, scene, n_processes, "Output/Fields=false",
                               "Solver/Inner tolerance=1e-9",
                               "Solver/Condensation=where cycles are many",
                               *entries)
    profile = {}
    for line in output.splitlines():
        row = re.match(r"         (\D+?) +([\d.]+) +(\d+) +([\d.]+) +([\d.]+)"
                       r" +([\d.]+)$", line)
        if row:
            profile[row[1]] = [float(value) for value in row.groups()[1:]]
        memory = re.match(r"         bytes per dof: leaf matrix (\d+), smoother "
                          r"and levels (\d+), processes at their largest (\d+)",
                          line)
        if memory:
            profile["memory"] = [int(value) for value in memory.groups()]
    return levels, profile


def scenes_part():
    print("Every scene on N processes, compared with one: levels on which "
          "numbers of\ncontact or sticking nodes differ, largest relative "
          "difference of energies,\nmost cycles, and the largest surplus of "
          "cycles on a level.\n")
    print("scene                 dofs   N  counts differ  energies  cycles"
          "  surplus")
    for dim in (2, 3):
        for path in sorted(glob.glob(os.path.join(scenes[dim], "*.prm"))):
            name = os.path.splitext(os.path.basename(path))[0]
            limit = "Refinement/Maximum dofs=" + ("10000" if dim == 2
                                                  else "10000")
            one = None
            for n in (1, 2, 4, 8):
                levels, _ = run(dim, name, n, limit)
                one = one or levels
                differ = sum((levels["contact_nodes"] != one["contact_nodes"])
                             | (levels["sticky_nodes"] != one["sticky_nodes"]))
                energy = max(abs(levels["energy"] / one["energy"] - 1))
                surplus = max(levels["cycles"].astype(int) -
                              one["cycles"].astype(int))
                print(f"{name + f' ({dim}D)':20}{levels['dofs'][-1]:7d}{n:4d}"
                      f"{differ:14d}{energy:11.0e}{max(levels['cycles']):7d}"
                      f"{surplus:8d}", flush=True)


def best_of(repeat, run_on, seconds):
    """What run_on(n) returns in its quickest run, for n = 1 and 2 processes, which
    take turns."""
    results = {1: [], 2: []}
    for _ in range(repeat):
        for n, its in results.items():
            its.append(run_on(n))
    return {n: min(its, key=seconds) for n, its in results.items()}


def speed_part():
    print("Two processes against one on two cores, solution on the last level, "
          "best of\nthree runs each, taken in turns; seconds by phase.")
    cases = [
        (3, "cylinder", ["Refinement/Maximum dofs=160000"]),
        (2, "hertz", ["Refinement/Strategy=uniform", "Refinement/Levels=9",
                      "Refinement/Maximum dofs=1000000",
                      "Refinement/Estimate error=false"]),
    ]
    for dim, scene, entries in cases:
        best = best_of(3, lambda n: run(dim, scene, n, *entries),
                       lambda result: result[1]["all"][3])
        print(f"\n{scene}, {best[1][0]['dofs'][-1]} dofs, "
              f"{best[1][0]['cycles'][-1]} and {best[2][0]['cycles'][-1]} "
              "cycles")
        print("                        one      two    ratio    waiting")
        for phase, one in best[1][1].items():
            if phase == "memory":
                continue
            two = best[2][1][phase]
            print(f"  {phase:18}{one[3]:9.3f}{two[3]:9.3f}"
                  f"{one[3] / max(two[3], 1e-9):9.2f}{two[4]:10.3f}")
        sys.stdout.flush()


def runs_part():
    print("Two processes against one on two cores, whole runs with default output, "
          "best of\ntwo each, taken in turns; seconds by part.")
    cases = [
        (3, "cylinder", ["Refinement/Maximum dofs=400000"]),
        (2, "hertz", ["Refinement/Strategy=uniform", "Refinement/Levels=7",
                      "Refinement/Maximum dofs=10000000"]),
    ]
    for dim, scene, entries in cases:
        def run_on(n):
            levels, output = run_whole(dim, scene, n, *entries)
            return levels["dofs"][-1], seconds_of_parts(output)

        best = best_of(2, run_on, lambda result: result[1]["all"])
        dofs, parts = zip(best[1], best[2])
        if dofs[0] != dofs[1]:
            sys.exit(f"{scene}: the meshes differ, {dofs} dofs")
        print(f"\n{scene}, {dofs[0]} dofs")
        print("                             one      two    ratio")
        for part, one in parts[0].items():
            two = parts[1][part]
            print(f"  {part:22}{one:9.2f}{two:9.2f}{one / max(two, 1e-9):9.2f}")
        # Most of these is deal.II's, and p4est's if there are two processes.
        one, two = (its["all"] - its["mesh"] - its["degrees of freedom"]
                    - its["transfer to next mesh"] for its in parts)
        print(f"  {'without these three':22}{one:9.2f}{two:9.2f}{one / two:9.2f}")
        # What two processes could come to with this mesh of deal.II's.
        whole = parts[0]["all"]
        least = parts[1]["mesh"] + (whole - parts[0]["mesh"]) / 2
        print(f"  {'all but mesh in half':22}{whole:9.2f}{least:9.2f}"
              f"{whole / least:9.2f}", flush=True)


def communication_part():
    print("What the process that sends most sends per cycle, last level of "
          "uniform meshes.\n")
    print("scene        dofs   N  levels  messages     bytes  reductions"
          "   leaf sweeps: bytes")
    cases = [(2, "hertz", ["Refinement/Strategy=uniform",
                           "Refinement/Estimate error=false",
                           "Refinement/Maximum dofs=100000000"], (4, 5, 6)),
             (3, "block", ["Refinement/Estimate error=false",
                           "Refinement/Initial refinements=1",
                           "Refinement/Maximum dofs=100000000"], (2, 3, 4))]
    for dim, scene, entries, refinements in cases:
        for levels_wanted in refinements:
            for n in (2, 4, 8):
                levels, profile = run(dim, scene, n, *entries,
                                      f"Refinement/Levels={levels_wanted}")
                row = profile["all"]
                n_levels = levels_wanted + (1 if dim == 2 else 2)
                print(f"{scene + f' ({dim}D)':11}{levels['dofs'][-1]:8d}"
                      f"{n:4d}{n_levels:8d}{row[0]:10.1f}{row[1]:10.0f}"
                      f"{row[2]:12.1f}{profile['leading sweeps'][1]:15.0f}",
                      flush=True)


def largest_part():
    print("The largest problems for 24 GiB, on two processes.\n")
    print("scene            dofs  cycles  solve s  set-up s   bytes per dof: "
          "leaf matrix  levels  largest")
    cases = [(2, "block", ["Scene/Subdivisions=11, 11",
                           "Refinement/Initial refinements=2",
                           "Refinement/Levels=6"]),
             (3, "block", ["Refinement/Initial refinements=6",
                           "Refinement/Levels=1"])]
    for dim, scene, entries in cases:
        levels, profile = run(dim, scene, 2, *entries,
                              "Refinement/Maximum dofs=100000000",
                              "Refinement/Estimate error=false")
        matrix, solver, process = profile["memory"]
        print(f"{scene + f' ({dim}D)':12}{levels['dofs'][-1]:9d}"
              f"{levels['cycles'][-1]:8d}{levels['solve_seconds'][-1]:9.1f}"
              f"{levels['setup_seconds'][-1]:10.1f}{matrix:27d}{solver:8d}"
              f"{process:9d}", flush=True)


parts = {"scenes": scenes_part, "speed": speed_part, "runs": runs_part,
         "communication": communication_part, "largest": largest_part}
for number, part in enumerate(sys.argv[6:]):
    if number > 0:
        print()
    parts[part]()
