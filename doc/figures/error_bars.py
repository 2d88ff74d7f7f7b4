#!/usr/bin/env python3
"""How good the estimated errors of a run's quantities are, where the truth is known: a
table and a figure.

Usage: error_bars.py PROGRAM_2D PROGRAM_3D ROOT TABLE FIGURE [few]

Of the scene 'manufactured' the truth is known in closed form. Of the others, the half
disc of Hertz with several coefficients of friction, a block, a punch and a half ball, it
is what the finest of the adaptive meshes gives, and meshes with up to a sixth of its
unknowns are judged. (Hertz's own formula is that of a half-plane, from which a half disc
differs by more than what meshes do.) Each mesh whose errors are known gives a case for
each quantity. Left out are cases whose truth is met up to rounding, which both error and
estimate say, and the peak pressure of 'punch', which has a corner there. 'few': coarser
meshes, without a figure, for a test.

The exit status is 1 if the truth is outside of the bar in more than one of twenty cases
of any quantity, or if bars are more than five times the error for the median case. With
'few' meshes are coarse, on which half-widths have bars of six times the error, and only
the first is judged.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

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
             f"Refinement/Maximum dofs={dofs}", "Refinement/Levels=25", *entries],
            check=True, stdout=subprocess.DEVNULL)
        with h5py.File(target / "history.h5") as file:
            return {name: data[()] for name, data in file["levels"].items()}


def judge(levels, truth, most_dofs, left_out=()):
    """For each quantity pairs of error and bar."""
    cases = {}
    for name in QUANTITIES:
        bars = levels[name + "_error"]
        if name in truth and name not in left_out:
            errors = np.abs(levels[name] - truth[name])
            use = ((bars >= 0) & (levels["dofs"] <= most_dofs)
                   & (np.maximum(errors, bars) > 1e-8 * abs(truth[name]))
                   & (levels["contact_nodes"] >= 5))
            cases[name] = list(zip(errors[use], bars[use], [abs(truth[name])] * use.sum()))
    return cases


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
    return result


def line(name, family, cases):
    errors, bars, _ = np.array(cases).T
    inside = int(np.sum(errors <= bars))
    ratio = np.median(bars / np.maximum(errors, 1e-300))
    return (f"{name:<22} {family:<23} {inside:4d} of {len(errors):3d} {ratio:8.1f}",
            inside, len(errors), ratio)


def draw(result, path):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(1, 5, figsize=(15, 3.4), sharey=True)
    for axis, (name, title) in zip(axes, QUANTITIES.items()):
        for family, cases in result.items():
            if cases.get(name):
                errors, bars, size = np.array(cases[name]).T
                axis.loglog(bars / size, np.maximum(errors / size, 1e-9), ".",
                            label=family, markersize=4)
        ends = np.array([1e-8, 1.])
        axis.loglog(ends, ends, "k-", linewidth=.8)
        axis.loglog(ends, ends / 5, "k:", linewidth=.8)
        axis.set_title(title)
        axis.set_xlabel("bar")
        axis.set_xlim(1e-5, 2)
        axis.set_ylim(1e-6, 2)
    axes[0].set_ylabel("error, relative")
    axes[0].legend(fontsize=6)
    figure.tight_layout()
    figure.savefig(path, dpi=100)


def main():
    programs, root, table = sys.argv[1:3], sys.argv[3], Path(sys.argv[4])
    few = sys.argv[6:] == ["few"]
    with tempfile.TemporaryDirectory() as folder:
        result = all_cases(Runs(programs, root, Path(folder), few))
    lines, good = [f"{'quantity':<22} {'runs':<23} {'inside':>11} {'median':>8}"], True
    for name, title in QUANTITIES.items():
        together = []
        for family, cases in result.items():
            if cases.get(name):
                lines.append(line(title, family, cases[name])[0])
                together += cases[name]
        text, inside, n, ratio = line(title, "all", together)
        lines.append(text)
        good = good and inside >= .95 * n and (few or ratio <= 5)
    print("\n".join(lines))
    table.write_text("\n".join(lines) + "\n")
    if not few:
        draw(result, sys.argv[5])
    sys.exit(not good)


main()
