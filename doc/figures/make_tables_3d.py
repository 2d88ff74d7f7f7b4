#!/usr/bin/env python3
"""The tables of step-friction-3d, from the runs that the CMake target
`figures-3d` does:  make_tables_3d.py RUNS OUTPUT DOCUMENT"""

import sys
from functools import partial
from pathlib import Path

import h5py
import numpy as np

import tables
import plot_folder  # noqa: F401
import vtu
from cylinder import (THESIS, CylinderRun, angle, cells_along_degenerate_lines,
                      largest_angles)
from history import Run
from tables import show

YOUNG, RADIUS = 1.0, 1.0
MOST = 100  # cycles that the runs for Remark 6.7 are given,
LONGEST = 1000  # and one of them, to see whether that was not enough


def at(run, level):
    """All values of a level."""
    return {name: values[level] for name, values in run.levels.items()}


def console(runs):
    """What the cylinder scene prints."""
    return (runs / "cylinder" / "console.txt").read_text().rstrip()


def table_6_2(runs):
    """Algorithms 2 and 3 on both coarse grids, level by level, below what the
    thesis has."""
    head = (" level |     dof contact sticky outer  Jac   GS  increments"
            "  contraction")
    rows = ["       thesis, table 6.2: one hexahedron, W(3,3)",
            " level |     dof contact sticky outer  Jac   GS     rho_tau"]
    for k, dof, contact, sticky, outer, jac, gs, rho in THESIS:
        rows.append(f" {k:5d} | {dof:7d} {show(contact):>7} {show(sticky):>6} "
                    f"{show(outer):>5} {show(jac):>4} {show(gs):>4} "
                    f"{show(rho, '{:.1e}'):>11}")
    for title, name, first in (
            ("cylinder-thesis, one hexahedron, W(3,3), monotone, contact",
             "thesis-W-contact", 1),
            ("cylinder-thesis, one hexahedron, default cycle", "thesis", 1),
            ("cylinder-thesis, O-grid, default cycle", "thesis-O-grid", 0),
            ("cylinder, one hexahedron, default cycle", "one-cell", 2),
            ("cylinder, O-grid, default cycle", "large", 0)):
        jacobi, seidel = Run(runs / f"{name}-fixed-point"), Run(runs / name)
        rows += ["", f"       here: {title}", head]
        for k in jacobi.levels["level"]:
            level = at(jacobi, k)
            rows.append(
                f" {k + first:5d} | {level['dofs']:7d} {level['contact_nodes']:7d} "
                f"{level['sticky_nodes']:6d} {level['outer_iterations']:5d} "
                f"{level['cycles']:4d} {seidel.levels['cycles'][k]:4d} "
                f"{level['rho_tau']:11.1e} {level['rho_tau_contraction']:12.1e}")
    return "\n".join(rows)


def mesh_truncation_cycle(runs):
    """Cycles of Algorithm 3 on the scene cylinder-thesis: what of them is the mesh,
    what the truncation, and what the cycle."""
    kinds = ("", "-contact", "-W", "-W-contact")
    names = ("default", "contact", "W33-mono", "both")
    rows = ["       |        |                one hexahedron               |"
            "                    O-grid",
            " level | thesis |" + 2 * ("     dofs" + "".join(
                f"{name:>9}" for name in names) + " |")]
    meshes = [[Run(runs / f"thesis{mesh}{kind}").levels for kind in kinds]
              for mesh in ("", "-O-grid")]
    thesis = {row[0]: row[6] for row in THESIS}
    for k in range(max(len(levels[0]["level"]) for levels in meshes)):
        row = f" {k + 1:5d} | {show(thesis.get(k + 1)):>6} |"
        for levels in meshes:
            if k < len(levels[0]["level"]):
                row += f"{levels[0]['dofs'][k]:9d}" + "".join(
                    f"{one['cycles'][k]:9d}" for one in levels) + " |"
        rows.append(row)
    return "\n".join(row.rstrip(" |") for row in rows)


def stick_share(_):
    """What the target benchmark-stick-share has found."""
    return Path(__file__).with_name("stick-share.txt").read_text().rstrip("\n")


def columns_of_cycles(runs, columns):
    """One column of cycles per run, one row per level; dofs of the first run."""
    histories = [Run(runs / directory) for _, directory in columns]
    width = max(len(name) for name, _ in columns) + 2
    rows = [" level     dofs " + "".join(f"{name:>{width}}"
                                         for name, _ in columns)]
    for k in range(max(run.last for run in histories) + 1):
        counts = [int(run.levels["cycles"][k]) if k <= run.last else None
                  for run in histories]
        rows.append(f" {k:5d} {histories[0].levels['dofs'][k]:8d} " +
                    "".join(f"{show(count):>{width}}" for count in counts))
    return rows


def cycles(runs):
    """Cycles per level of Algorithm 3 without its ingredients, and for other
    coefficients of friction."""
    return "\n".join(columns_of_cycles(
        runs, [("default", "large"), ("no recomb.", "no-recombination"),
               ("damping 1", "damping"), ("neither", "neither"),
               ("3+3 coarse", "V33-truncated"), ("V33-mono", "V33-monotone"),
               ("W33-mono", "W33-monotone"), ("F=0", "F-0"),
               ("F=0.05", "F-0.05"), ("F=1", "F-1")]))


def truncation(runs):
    """Remark 6.7: what coarse functions know of friction."""
    kinds = (("phases", "phases"), ("contact", "contact"),
             ("no omega''", "phases-without-second-order"))
    rows = ["       truncated corrections             "
            "         monotone corrections",
            " level     dofs " + 2 * "".join(f"{name:>12}" for name, _ in kinds)]
    histories = [CylinderRun(runs / f"{name}-{correction}")
                 for correction in ("truncated", "monotone")
                 for _, name in kinds]
    for k in range(histories[0].last + 1):
        rows.append(f" {k:5d} {histories[0].levels['dofs'][k]:8d} ")
        for run in histories:
            if k > run.last:
                text = "-"
            elif k == run.last and run.gave_up(MOST):
                text = f">{MOST}"
            else:
                text = run.levels["cycles"][k]
            rows[-1] += f"{text:>12}"
    return "\n".join(rows)


def uniform(runs):
    """Both coarse grids, refined uniformly, and the one of the thesis with its cycle
    and truncation."""
    rows = []
    for title, name in (("O-grid", "uniform"),
                        ("one hexahedron", "uniform-one-cell"),
                        ("as in the thesis", "uniform-thesis")):
        for k, dofs, count, rate in zip(*(Run(runs / name).levels[key] for key in
                                          ("level", "dofs", "cycles",
                                           "contraction"))):
            rows.append(f" {title if k == 0 else '':16}{dofs:8d} {count:7d} "
                        f"{rate:6.3f}")
    return "\n".join([f" {'':16}    dofs  cycles   rate"] + rows)


def ends(runs):
    """Energy, largest pressure and estimated error, for rods as long as the
    cylinder and for shorter ones."""
    rows = ["       |        rods of length 2 and more         |"
            "              rods of length 1.5",
            " level |    dofs     energy   pressure  est. error |"
            "    dofs     energy   pressure  est. error"]
    long, short = Run(runs / "large"), Run(runs / "shorter-rods")
    for k in range(max(long.last, short.last) + 1):
        row = f" {k:5d} |"
        for run in (long, short):
            if k <= run.last:
                level = at(run, k)
                row += (f" {level['dofs']:7d}  {level['energy']:.3e} "
                        f"{level['max_pressure']:10.4f}  "
                        f"{level['estimated_error']:.2e}   |")
        rows.append(row.rstrip(" |"))
    return "\n".join(rows)


def half_ball(runs):
    """The force beside Hertz's for the same depth, radius and largest pressure
    beside Hertz's for the same force."""
    stiffness = YOUNG / (1 - 0.3**2)
    rows = ["  depth d     dofs  contact      P        P/P_H(d)  a/a_H(P)  "
            "p0/p_H(P)   a/(2R)"]
    for name in ("0.01", "0.005", "0.0025"):
        depth = float(name)
        level = at(Run(runs / f"half-ball-{name}"), -1)
        force = level["normal_force"]
        a = np.cbrt(3 * force * RADIUS / (4 * stiffness))
        p0 = 3 * force / (2 * np.pi * a**2)
        hertz = 4 / 3 * stiffness * np.sqrt(RADIUS) * depth**1.5
        rows.append(f"  {depth:<7g} {level['dofs']:8d} "
                    f"{level['contact_nodes']:8d}  {force:.3e}  "
                    f"{force / hertz:8.4f}  {level['contact_half_width'] / a:8.4f}"
                    f"  {level['max_pressure'] / p0:9.4f}  "
                    f"{np.sqrt(depth * RADIUS) / (2 * RADIUS):7.4f}")
    return "\n".join(rows)


def extruded(runs):
    """The extruded Hertz scene beside that of two dimensions, per length."""
    solid, plane = Run(runs / "extruded-hertz"), Run(runs.parent / "2d" / "uniform")
    rows = [" level | 3D: dofs contact sticky layers   energy/0.2    force/0.2 |"
            " 2D: contact sticky       energy        force"]
    for k in range(solid.last + 1):
        a, b = at(solid, k), at(plane, k)
        layers = 2**k
        rows.append(f" {k:5d} | {a['dofs']:8d} {a['contact_nodes']:7d} "
                    f"{a['sticky_nodes']:6d} {layers:6d} "
                    f"{a['energy'] / 0.2:.6e} {a['normal_force'] / 0.2:.6e} |"
                    f" {b['contact_nodes']:11d} {b['sticky_nodes']:6d} "
                    f"{b['energy']:.6e} {b['normal_force']:.6e}")
    return "\n".join(rows)


def stick_slip(runs):
    """What the patch test prints on meshes with hanging nodes."""
    return (runs / "stick-slip-adaptive" / "console.txt").read_text().rstrip()


def checks(runs):
    """Single numbers that the text quotes."""
    rows = []
    jacobi = CylinderRun(runs / "large-fixed-point")
    seidel = CylinderRun(runs / "large")
    for name in ("force", "displacement"):
        difference = max(
            np.abs(jacobi.contact[k][name] - seidel.contact[k][name]).max() /
            np.abs(seidel.contact[k][name]).max() for k in seidel.contact)
        rows.append(f" Algorithms 2 and 3, largest difference of a contact "
                    f"{name}, of the largest: {difference:.0e}")
    for title, name in (("O-grid", "large"), ("one hexahedron", "one-cell")):
        jac, gs = (Run(runs / directory).levels["cycles"][1:].sum()
                   for directory in (f"{name}-fixed-point", name))
        rows.append(f" cycles of Algorithms 2 and 3 after the first mesh, {title}: "
                    f"{jac} and {gs}, {100 * gs / jac:.0f} percent")
    jac, gs = (sum(row[column] for row in THESIS[1:]) for column in (5, 6))
    rows.append(f"    thesis: {jac} and {gs}, {100 * gs / jac:.0f} percent")
    for title, name in (("O-grid", "large"), ("one hexahedron", "one-cell")):
        run = CylinderRun(runs / name)
        data = vtu.read(run.directory / f"body-{run.last:02d}.0000.vtu")
        angles, middles = largest_angles(data)
        above = ((np.abs(np.abs(angle(middles)) - 30) < 4) &
                 (np.hypot(middles[:, 0], middles[:, 1]) > 0.93))
        rows.append(f" largest angles of cells, {title}: {angles.max():.1f} of "
                    f"all, {np.median(angles[above]):.0f} typically above rods")
    lower, upper = cells_along_degenerate_lines(data)
    rows.append(f" cells per length of the cylinder along the degenerate lines: "
                f"{lower[0]} to {lower[1]} on the lower ones, {upper[0]} to {upper[1]} "
                "on the upper")
    counts = [Run(runs / f"W33-monotone{name}").levels["cycles"]
              for name in ("-fixed-point", "")]
    for title, count in zip(("2", "3"), counts):
        rows.append(f" W(3,3) monotone, Algorithm {title}, O-grid, cycles from "
                    "level 0: " + " ".join(map(str, count)))
    rows.append(" Algorithm 2, first change of the normal forces, from level 1: "
                + " ".join(f"{jacobi.outer['change'][jacobi.outer['level'] == k][0]:.2f}"
                           for k in range(1, jacobi.last + 1)))
    nodes = seidel.nodes()
    shear = np.hypot(nodes["around"], nodes["along"])
    slides = nodes["state"] == 1
    gap = np.abs(shear - 0.4 * nodes["pressure"])[slides].max()
    rows.append(" largest | |sigma_T| - F |sigma_n| | at a sliding node, of the "
                f"largest pressure: {gap / nodes['pressure'].max():.0e}")
    middle = (np.abs(nodes["z"] - 1) < 1e-6) & (nodes["state"] > 0)
    theta = nodes["angle"][middle]
    rows.append(f" contact halfway along the cylinder: {theta.min():.2f} to "
                f"{theta.max():.2f} degrees, {middle.sum()} nodes")
    stick = nodes["state"] == 2
    rows.append(f" stick: {nodes['angle'][stick].min():.2f} to "
                f"{nodes['angle'][stick].max():.2f} degrees, z from "
                f"{nodes['z'][stick].min():.2f} to {nodes['z'][stick].max():.2f}")
    shares = []
    for friction, name in (("0.05", "F-0.05"), ("0.4", "large"), ("1", "F-1")):
        level = at(Run(runs / name), -1)
        shares.append(f"{100 * level['sticky_nodes'] / level['contact_nodes']:.0f}"
                      f" percent for F={friction}")
    rows.append(" sticking nodes among those in contact: " + ", ".join(shares))
    count = Run(runs / "without-second-order-long").levels["cycles"]
    rows.append(" phases without second order, monotone, cycles from level 0: " +
                " ".join(f">{LONGEST}" if n >= LONGEST else str(n) for n in count))
    cross = Run(runs / "crossing-rods")
    contact = cross.contact[cross.last]
    here = (contact["point"][:, 2] < 1) & (contact["state"] > 0)
    point, normal, u, state = (contact[name][here] for name in
                               ("point", "normal", "displacement", "state"))
    arc, z = np.arctan2(point[:, 0], -point[:, 1]), point[:, 2] - 0.5
    tangential = u - np.sum(u * normal, axis=1)[:, None] * normal
    inward = tangential[:, 0] * point[:, 0] + tangential[:, 2] * z < 0
    rows.append(f" crossing rods: half axes of contact {np.abs(arc).max():.3f} and "
                f"{np.abs(z).max():.3f}, of stick "
                f"{np.abs(arc[state == 2]).max():.3f} and "
                f"{np.abs(z[state == 2]).max():.3f}; "
                f"{100 * inward[state == 1].mean():.0f} percent of the sliding "
                "nodes move inwards")
    for name in ("crossing-rods", "block"):
        rows.append(f" {name}, cycles from level 0: " + " ".join(
            map(str, Run(runs / name).levels["cycles"])))
    converged = []
    for path in sorted(runs.glob("*/history.h5")):
        with h5py.File(path) as file:
            gave_up = file["levels/cycles"][-1] in (MOST, LONGEST)
            converged.append(file["levels/certificate"][:-1 if gave_up else None])
    rows.append(" largest certificate on any level that has converged, of any run "
                f"here: {np.concatenate(converged).max():.0e}")
    return "\n".join(rows)


def main():
    runs, output, document = map(Path, sys.argv[1:4])
    tables.write({name: partial(make, runs) for name, make in
                  (("console-3d", console), ("table-6.2", table_6_2),
                   ("cycles-thesis", mesh_truncation_cycle),
                   ("stick-share", stick_share), ("cycles-3d", cycles),
                   ("truncation", truncation), ("uniform", uniform), ("ends", ends),
                   ("half-ball", half_ball), ("extruded", extruded),
                   ("stick-slip-3d", stick_slip), ("checks-3d", checks))},
                 output, document)


if __name__ == "__main__":
    main()
