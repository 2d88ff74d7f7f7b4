#!/usr/bin/env python3
"""How good the estimated errors of a run's quantities are, where the truth is known: a
table and a figure.

Usage: error_bars.py PROGRAM_2D PROGRAM_3D ROOT TABLE FIGURE [few]

Of the scene 'manufactured' the truth is known in closed form. Of others, the half
disc of Hertz with several coefficients of friction, a block, a punch and a half ball, it
is what the finest of the adaptive meshes gives, and meshes with up to a sixth of its
unknowns are judged. (Hertz's own formula is that of a half-plane, from which a half disc
differs by more than what fine meshes do.) Each mesh whose errors are known gives a case
for each quantity. Left out are meshes with fewer than five nodes in contact, cases without
an estimate, those whose truth is met up to rounding, which both error
and estimate say, and the peak pressure of 'punch', which has a corner there.

'half-plane' is the half disc pressed by a sixteenth of the depth, where it differs from
one by three parts in a thousand and less. The truth is that of the half-plane with
friction, HALF_PLANE in hertz.py, for the force of the finest mesh. Judged are meshes
with bars of a percent and more.

Histories have a mesh of their own for each case of a later load step. The truth is the
same history on a mesh of four times as many unknowns as the finest of them, or more;
for 'Cattaneo-Mindlin' it is the closed form of the zone of stick, with the forces and
the zone of contact of that mesh, on meshes that are not as fine as to see that it is not
quite that of a half disc. Left out is the tangential force of a half disc that is pressed
only: its two halves cancel, but for the turning of tangents along the arc.

The exit status is 1 if the truth is outside of the bar in more than one of twenty cases
of any quantity, in first load steps or in later ones, or if for the median case bars are
more than five times the error, in later steps six times. 'few': coarser meshes, without a
figure, for a test. On these bars are wider, up to twenty times. The column 'within 5' has
the cases in which they are no more than five times the error.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

from hertz import HALF_PLANE, peak, width

QUANTITIES = {
    "max_pressure": "peak pressure", "contact_half_width": "half-width of contact",
    "stick_half_width": "half-width of stick", "normal_force": "normal force",
    "tangential_force": "tangential force"}


def manufactured(friction):
    """p = p0 (x - 1)^2 from 1 to 3; friction is F p, less F p (x - 2)^2 from 2 on."""
    p0 = .05
    force = p0 * 8 / 3
    return {"max_pressure": 4 * p0, "normal_force": force,
            "tangential_force": friction * (force - p0 * (1 / 5 + 1 / 2 + 1 / 3)),
            "contact_half_width": 1., "stick_half_width": .5}


class Runs:
    def __init__(self, programs, root, folder, few):
        self.programs, self.root, self.folder, self.few = programs, root, folder, few

    def run(self, dim, scene, dofs, *entries):
        """The levels of a run, by name of the dataset."""
        target = self.folder / "run"
        dofs = dofs // 16 if self.few else dofs
        subprocess.run(
            [self.programs[dim - 2],
             f"{self.root}/step-friction-{dim}d/scenes/{scene}.prm",
             f"Output/Directory={target}", "Output/Fields=false",
             "Solver/Inner tolerance=1e-9",
             f"Refinement/Maximum dofs={dofs}", "Refinement/Levels=25", *entries],
            check=True, stdout=subprocess.DEVNULL)
        with h5py.File(target / "history.h5") as file:
            levels = {name: data[()] for name, data in file["levels"].items()}
        levels.setdefault("load_step", np.ones_like(levels["level"]))
        return levels


def judge(levels, truth, most_dofs, left_out=(), least_bar=0.):
    """For each quantity pairs of error and bar. The truth is that of all levels, or of
    each of them."""
    cases = {}
    for name in QUANTITIES:
        bars = levels[name + "_error"]
        if name in truth and name not in left_out:
            errors = np.abs(levels[name] - truth[name])
            use = ((bars >= 0) & (levels["dofs"] <= most_dofs)
                   & (bars >= least_bar * levels[name])
                   & (np.maximum(errors, bars) > 1e-8 * abs(truth[name]))
                   & (levels["contact_nodes"] >= 5))
            size = np.abs(truth[name]) * np.ones(len(errors))
            cases[name] = list(zip(errors[use], bars[use], size[use]))
    return cases


def part(levels, use):
    return {name: values[use] for name, values in levels.items()}


def half_plane(runs, add):
    """Half-widths and pressure of a small zone of contact."""
    for friction in (0, .4, 1):
        entries = ([f"Contact/Friction coefficient={friction}"] if friction
                   else ["Contact/Friction law=none"])
        levels = runs.run(2, "hertz", 80000, *entries,
                          "Boundary conditions/Displacement=1: 0, -0.0062/16")
        force = levels["normal_force"][-1]
        stick, contact, pressure = HALF_PLANE[friction]
        truth = {"max_pressure": pressure * peak(force),
                 "contact_half_width": contact * width(force)}
        if friction:
            truth["stick_half_width"] = stick * truth["contact_half_width"]
        add("half-plane", judge(levels, truth, np.inf, least_bar=.01))


LATER = " (later)"


def histories(runs, add):
    """Later load steps, and the first one of 'mindlin'."""
    press = "Boundary conditions/Displacement=1: 0, -0.0062*"
    to_and_fro = "Boundary conditions/Displacement=3: 0.01*if(t < 4, t - 1, 7 - t), -0.02"
    for family, scene, left_out, entries in (
            ("Mindlin", "mindlin", (), ["Load steps/Times=0, 2, 4, 6, 8"]),
            ("Mindlin, nu = 0.3", "mindlin", (),
             ["Load steps/Times=0, 2, 4, 6, 8", "Material/Poisson ratio=0.3",
              "Contact/Friction coefficient=0.3"]),
            ("Hertz, in steps", "hertz", ("tangential_force",),
             ["Load steps/Times=1, 2, 3, 4, 5", press + "t/5"]),
            ("Hertz, taken back", "hertz", ("tangential_force",),
             ["Load steps/Times=1, 2, 3, 4, 5", press + "(6 - t)/5"]),
            ("block, to and fro", "block", (),
             ["Load steps/Times=1, 2, 3, 4, 5, 6", to_and_fro])):
        def run(dofs):
            levels = runs.run(2, scene, 4 * dofs if runs.few else dofs, *entries)
            return levels, part(levels, levels["load_step"] > 1)
        levels, fine = run(100000)
        if family == "Mindlin":
            first = part(levels, levels["load_step"] == 1)
            add("Mindlin, first step",
                judge(first, {name: first[name][-1] for name in QUANTITIES
                              if name[0] not in "ts"}, first["dofs"][-1] / 6))
        for dofs in (3000, 6000, 12000, 24000)[2 * runs.few:]:
            coarse = run(dofs)[1]
            add(family + LATER,
                judge(coarse, {name: fine[name] for name in QUANTITIES}, np.inf,
                      left_out))
            if family == "Mindlin":
                add("Cattaneo-Mindlin" + LATER,
                    judge(coarse, {"stick_half_width": zone_of_stick(fine)}, np.inf,
                          least_bar=.01))


def zone_of_stick(levels, friction=.3):
    """The closed form, for a drag that is turned at t = 4."""
    forward = levels["time"] <= 4
    # Known by its size. On the way back it has just changed its sign at t = 6.
    force = np.where(levels["time"] < 6, 1., -1.) * levels["tangential_force"]
    turned = force[levels["time"] == 4][0]
    bound = friction * levels["normal_force"]
    return levels["contact_half_width"] * np.sqrt(np.where(
        forward, 1 - force / bound, 1 - np.abs(force - turned) / (2 * bound)))


def all_cases(runs):
    """By name of a family of runs."""
    result = {}

    def add(family, cases):
        for name, pairs in cases.items():
            result.setdefault(family, {}).setdefault(name, []).extend(pairs)

    for friction in (.1, .4, .8):
        for strategy in ("uniform", "adaptive"):
            levels = runs.run(2, "manufactured", 200000,
                              f"Refinement/Strategy={strategy}",
                              f"Contact/Friction coefficient={friction}")
            add("manufactured, " + strategy,
                judge(levels, manufactured(friction), np.inf))
    for friction in (0, .05, .4, 1):
        entries = ([f"Contact/Friction coefficient={friction}"] if friction
                   else ["Contact/Friction law=none"])
        levels = runs.run(2, "hertz", 400000, *entries)
        truth = {name: levels[name][-1] for name in QUANTITIES
                 if friction or name[0] not in "ts"}
        most = levels["dofs"][-1] / 6
        add("Hertz, adaptive", judge(levels, truth, most))
        levels = runs.run(2, "hertz", 80000, *entries, "Refinement/Strategy=uniform",
                          "Refinement/Initial refinements=2")
        add("Hertz, uniform", judge(levels, truth, np.inf))
    for dim, scene, dofs, left_out in ((2, "raous", 500000, ()),
                                       (2, "punch", 200000, ("max_pressure",)),
                                       (3, "half-ball", 160000, ("stick_half_width",
                                                                 "tangential_force"))):
        levels = runs.run(dim, scene, dofs)
        truth = {name: levels[name][-1] for name in QUANTITIES}
        add(f"{scene} ({dim}D)",
            judge(levels, truth, levels["dofs"][-1] / 6, left_out))
    half_plane(runs, add)
    histories(runs, add)
    return result


def line(name, family, cases):
    errors, bars, _ = np.array(cases).T
    inside = int(np.sum(errors <= bars))
    ratio = np.median(bars / np.maximum(errors, 1e-300))
    near = np.mean(bars <= 5 * errors)
    return (f"{name:<22} {family:<23} {inside:4d} of {len(errors):3d} {ratio:8.1f}"
            f" {near:8.0%}", inside, len(errors), ratio)


def draw(result, path):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(1, 5, figsize=(15, 4), sharey=True)
    for axis, (name, title) in zip(axes, QUANTITIES.items()):
        for number, (family, cases) in enumerate(result.items()):
            if cases.get(name):
                errors, bars, size = np.array(cases[name]).T
                axis.loglog(bars / size, np.maximum(errors / size, 1e-9),
                            "x" if family.endswith(LATER) else ".",
                            color=pyplot.cm.tab20(number % 20), label=family,
                            markersize=4)
        ends = np.array([1e-8, 1.])
        axis.loglog(ends, ends, "k-", linewidth=.8)
        axis.loglog(ends, ends / 5, "k:", linewidth=.8)
        axis.set_title(title)
        axis.set_xlabel("bar")
        axis.set_xlim(1e-5, 2)
        axis.set_ylim(1e-6, 2)
    axes[0].set_ylabel("error, relative")
    handles = {}
    for axis in axes:
        for handle, label in zip(*axis.get_legend_handles_labels()):
            handles.setdefault(label, handle)
    figure.tight_layout(rect=(0, .14, 1, 1))
    figure.legend([handles[family] for family in result if family in handles],
                  [family for family in result if family in handles],
                  loc="lower center", ncol=7, fontsize=7)
    figure.savefig(path, dpi=100)


def main():
    programs, root, table = sys.argv[1:3], sys.argv[3], Path(sys.argv[4])
    few = sys.argv[6:] == ["few"]
    with tempfile.TemporaryDirectory() as folder:
        result = all_cases(Runs(programs, root, Path(folder), few))
    lines, good = [f"{'quantity':<22} {'runs':<23} {'inside':>11} {'median':>8}"
                   f" {'within 5':>8}"], True
    for later in (False, True):
        for name, title in QUANTITIES.items():
            together = []
            for family, cases in result.items():
                if cases.get(name) and family.endswith(LATER) == later:
                    lines.append(line(title, family, cases[name])[0])
                    together += cases[name]
            if together:
                text, inside, n, ratio = line(title, "all" + later * LATER, together)
                lines.append(text)
                good = (good and inside >= .95 * n
                        and ratio <= (20 if few else 6 if later else 5))
    print("\n".join(lines))
    table.write_text("\n".join(lines) + "\n")
    if not few:
        draw(result, sys.argv[5])
    sys.exit(not good)


main()
