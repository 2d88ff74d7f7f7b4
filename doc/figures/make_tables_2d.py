#!/usr/bin/env python3
"""The tables of step-friction-2d, from the runs that the CMake target
`figures-2d` does:  make_tables_2d.py RUNS OUTPUT DOCUMENT"""

import sys
from functools import partial
from pathlib import Path

import h5py
import numpy as np

import tables
from hertz import HALF_PLANE, THESIS, HertzRun
from tables import show


def console(runs):
    """What the Hertz scene prints."""
    return (runs / "hertz" / "console.txt").read_text().rstrip()


def scene():
    """The scene file as it is."""
    source = Path(__file__).parents[2] / "step-friction-2d" / "scenes" / "hertz.prm"
    return source.read_text().rstrip()


def one_level(runs):
    """The cycles of the last level of the Hertz scene."""
    with h5py.File(runs / "hertz" / "history.h5") as file:
        level = file["cycles/level"][:]
        here = level == level.max()
        columns = [file[f"cycles/{name}"][:][here]
                   for name in ("increment", "energy", "damping", "truncated")]
    last = columns[1][-1]
    rows = [" cycle  increment  energy above the last one  step length  truncated"]
    for k, (increment, energy, length, truncated) in enumerate(zip(*columns)):
        rows.append(f" {k + 1:5d}  {increment:9.0e}  {(energy - last) / abs(last):24.0e}"
                    f"  {length:11.2f}  {truncated:9.0f}")
    return "\n".join(rows)


def table_6_1(runs):
    """Algorithms 2 and 3 beside the thesis, level by level."""
    jacobi, seidel = HertzRun(runs / "fixed-point"), HertzRun(runs / "W33-monotone")
    rows = ["       |                    thesis, table 6.1                    |"
            "                          here",
            " level |    dof contact sticky outer  Jac   GS  rho_tau          |"
            "    dof contact sticky outer  Jac   GS  increments  contraction"]
    thesis = {row[0]: row[1:] for row in THESIS}
    for k in jacobi.levels["level"]:
        dof, contact, sticky, outer, jac, gs, rho = thesis.get(k, [None] * 7)
        rows.append(f" {k:5d} | {show(dof):>6} {show(contact):>7} "
                    f"{show(sticky):>6} {show(outer):>5} {show(jac):>4} "
                    f"{show(gs):>4}  {show(rho, '{:.1e}'):<17}|")
        level = {name: values[k] for name, values in jacobi.levels.items()}
        rates = ["{:.1e}".format(level[name]) if level["outer_iterations"] > 2
                 else "-" for name in ("rho_tau", "rho_tau_contraction")]
        rows[-1] += (f" {level['dofs']:6d} {level['contact_nodes']:7d} "
                     f"{level['sticky_nodes']:6d} "
                     f"{level['outer_iterations']:5d} {level['cycles']:4d} "
                     f"{seidel.levels['cycles'][k]:4d}  "
                     f"{rates[0]:>10}  {rates[1]:>11}")
    return "\n".join(rows)


def outer_start(runs):
    """Outer iterations of Algorithm 2 by what they start from, beside the thesis."""
    thesis = {row[0]: row[1:] for row in THESIS}
    rows = ["       |      thesis       |       dofs here       |"
            "      from interpolated forces     |             from zero",
            " level |    dof outer  Jac |     Q1   with centres |"
            "   outer  Jac  7th change  factor |   outer  Jac  7th change  factor"]
    for line in (runs / "outer-start.txt").read_text().splitlines()[1:]:
        mesh, _, forces, zero, _, _ = (part.split() for part in line.split("|"))
        dof, _, _, outer, jac, _, _ = thesis.get(int(mesh[0]), [None] * 7)
        rows.append(f" {mesh[0]:>5} | {show(dof):>6} {show(outer):>5} {show(jac):>4} |"
                    f" {mesh[1]:>6} {mesh[2]:>14} |")
        for outer, jac, _, seventh, factor, _ in (forces, zero):
            rows[-1] += (f"   {outer:>5} {jac:>4}  "
                         f"{'-' if float(seventh) == 0 else seventh:>10} "
                         f"{factor if int(outer) > 2 else '-':>7} |")
        rows[-1] = rows[-1].rstrip(" |")
    return "\n".join(rows)


def cycles(runs):
    """Cycles per level of Algorithm 3, by coarse correction."""
    columns = [("default", "hertz"), ("V33-trunc", "V33-truncated"),
               ("W33-trunc", "W33-truncated"), ("V33-mono", "V33-monotone"),
               ("W33-mono", "W33-monotone"), ("F=0", "F-0"), ("F=0.05", "F-0.05"),
               ("F=1", "F-1")]
    histories = [HertzRun(runs / directory) for _, directory in columns]
    rows = [" level     dofs " + "".join(f"{name:>10}" for name, _ in columns)]
    for k in histories[0].levels["level"]:
        rows.append(f" {k:5d} {histories[0].levels['dofs'][k]:8d} " +
                    "".join(f"{run.levels['cycles'][k]:10d}"
                            for run in histories))
    return "\n".join(rows)


def marking(runs):
    """Cycles of Algorithm 3 as in the thesis, on meshes that differ in what is marked."""
    rows = [" marked  cycles from level 1", " thesis  " + "".join(
        f"{row[6]:4d}" for row in THESIS if row[0] > 0)]
    for part, name in ((.25, ""), (.3, "-marking-0.3"), (.4, "-marking-0.4"),
                       (.5, "-marking-0.5")):
        counts = HertzRun(runs / f"W33-monotone{name}").levels["cycles"][1:]
        rows.append(f"   {part:4.2f}  " + "".join(f"{count:4d}" for count in counts))
    return "\n".join(rows)


def comparison(runs):
    """Stick ratio, half-width and largest pressure beside the half-plane."""
    rows = ["   F   run             dofs  contact sticky |     c/a   a/a_H "
            " p0/p_H | half-plane:   c/a   a/a_H  p0/p_H"]
    for friction, reference in HALF_PLANE.items():
        name = f"F-{friction:g}"
        for label, directory in (("scene", "hertz" if friction == 0.4 else name),
                                 ("quarter depth", "quarter-" + name)):
            run = HertzRun(runs / directory)
            found = run.factors()
            level = {name: values[-1] for name, values in run.levels.items()}
            rows.append(
                f" {friction:4.2f}  {label:13}{level['dofs']:8d} "
                f"{level['contact_nodes']:8d} {level['sticky_nodes']:6d} | "
                "{:7.5f}  {:6.4f}  {:6.4f} |           ".format(*found) +
                "{:7.5f}  {:6.4f}  {:6.4f}".format(*reference))
    run = HertzRun(runs / "obstacle-normal")
    level = {name: values[-1] for name, values in run.levels.items()}
    rows.append(f" 0.00  normal of obst. {level['dofs']:6d}"
                f" {level['contact_nodes']:7d} {level['sticky_nodes']:6d} | "
                "{:7.5f}  {:6.4f}  {:6.4f} |".format(*run.factors()))
    return "\n".join(rows)


def ripple(run, level):
    """How much the pressure differs from a smooth function inside the contact
    zone, relative, root mean square. The middle, where there may be a peak, is
    left out."""
    x, pressure, _, _ = run.stresses(level)
    x = x / run.levels["contact_half_width"][level]
    inner = (np.abs(x) < 0.4) & (np.abs(x) > 0.05)
    fit = np.polyfit(x[inner]**2, pressure[inner], 4)
    return (pressure[inner] / np.polyval(fit, x[inner]**2) - 1).std()


def checks(runs):
    """Single numbers that the text quotes."""
    rows = []
    jacobi, seidel = HertzRun(runs / "fixed-point"), HertzRun(runs / "W33-monotone")
    for name in ("force", "displacement"):
        difference = max(
            np.abs(jacobi.contact[k][name] - seidel.contact[k][name]).max() /
            np.abs(seidel.contact[k][name]).max() for k in seidel.contact)
        rows.append(f" Algorithms 2 and 3, largest difference of a contact "
                    f"{name}, of the largest: {difference:.0e}")
    for friction, directory in ((0.05, "F-0.05"), (0.4, "hertz"), (1.0, "F-1")):
        run = HertzRun(runs / directory)
        x, pressure, shear, state = run.stresses()
        slides = state == 1
        gap = np.abs(np.abs(shear) - friction * pressure)[slides].max()
        rows.append(f" F={friction:<4g} largest | |sigma_T| - F |sigma_n| | at a "
                    f"sliding node, of the largest pressure: "
                    f"{gap / pressure.max():.0e}")
        first = 9
        rows.append(" " * 8 + f"ripple of the pressure, rms, from level {first}: " +
                    " ".join(f"{ripple(run, level):.1e}"
                             for level in range(first, run.last + 1)))
    rows.append(" F=0.05 sticking nodes by level: " +
                " ".join(map(str, HertzRun(runs / "F-0.05").levels["sticky_nodes"])))
    # The estimator alone refines in smaller steps: its last mesh that is not
    # larger is the one to compare with.
    all_contact = HertzRun(runs / "hertz").levels
    alone = HertzRun(runs / "estimator-only").levels
    for name, levels in (("true", all_contact), ("false", alone)):
        k = np.flatnonzero(levels["dofs"] <= all_contact["dofs"][-1])[-1]
        rows.append(f" Contact zone = {name}: {levels['dofs'][k]} dofs, "
                    f"{levels['contact_nodes'][k]} contact, "
                    f"{levels['sticky_nodes'][k]} sticky, "
                    f"energy {levels['energy'][k]:.5e}")
    with h5py.File(runs / "fixed-point" / "history.h5") as file:
        level, change = file["outer/level"][:], file["outer/change"][:]
    rows.append(" Algorithm 2, first change of the normal forces, from level 5:")
    rows.append("    " + " ".join(f"{change[level == k][0]:.1e}"
                                  for k in range(5, jacobi.last + 1)))
    most = int(np.argmax(seidel.levels["cycles"]))
    with h5py.File(runs / "W33-monotone" / "history.h5") as file:
        here = file["cycles/level"][:] == most
        increments = file["cycles/increment"][:][here]
        truncated = file["cycles/truncated"][:][here]
    rows.append(f" W(3,3) monotone, level {most}: increments of the cycles, and "
                "how many components were truncated:")
    rows += ["   " + " ".join(f"{value:5.0e}" for value in increments),
             "   " + " ".join(f"{value:5.0f}" for value in truncated)]
    marked = {f: HertzRun(runs / f"marking-F-{f:g}").levels["cycles"].max()
              for f in (0.05, 0.4, 1)}
    rows.append(" V(3,3) monotone, Marking = 0.5, most cycles on a level: " +
                ", ".join(f"{most} for F={f:g}" for f, most in marked.items()))
    worst = max(HertzRun(path.parent).levels["certificate"].max()
                for path in runs.glob("*/history.h5"))
    rows.append(f" largest certificate on any level of any run here: {worst:.0e}")
    return "\n".join(rows)


def main():
    runs, output, document = map(Path, sys.argv[1:4])
    tables.write({"scene": scene,
                  "console": partial(console, runs),
                  "one-level": partial(one_level, runs),
                  "table-6.1": partial(table_6_1, runs),
                  "outer-start": partial(outer_start, runs),
                  "marking": partial(marking, runs),
                  "cycles": partial(cycles, runs),
                  "half-plane": partial(comparison, runs),
                  "checks": partial(checks, runs)}, output, document)


if __name__ == "__main__":
    main()
