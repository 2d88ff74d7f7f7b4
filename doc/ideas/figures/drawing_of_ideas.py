"""What the pictures of the idea pages have in common: the programs they run, and
how files are written. Palette and style are those of the charts."""

import subprocess
import sys
from pathlib import Path

DOC = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(DOC / "charts"), str(DOC / "figures"),
                str(DOC.parent / "common" / "plot")]
import chart  # noqa: E402
from history import Run  # noqa: E402

SCENES = {2: DOC.parent / "step-friction-2d" / "scenes",
          3: DOC.parent / "step-friction-3d" / "scenes"}


# Colour and marker of the phases of contact nodes.
PHASES = {"open": (chart.SKY, "o"), "slip": (chart.ORANGE, "D"),
          "stick": (chart.RED, "s")}


def mark_phases(axes, phases, x, y, **style):
    """Nodes at (x, y) with the markers of their phases."""
    for phase, (color, marker) in PHASES.items():
        chosen = phases == phase
        axes.plot(x[chosen], y[chosen], marker, color=color, label=phase, **style)


class Failure(Exception):
    """Why there is no picture, in one sentence."""


class Workshop:
    """What a picture is made with.

    programs: the step programs, by dimension. runs: a folder for what they
    write. output: where pictures go. quick: whether tiny meshes will do, as in a
    test, where the picture is not looked at.
    """

    def __init__(self, programs, runs, output, quick=False):
        self.programs = programs
        self.runs = runs
        self.output = output
        self.quick = quick

    def run(self, dim, scene, name, *entries, fails=False):
        """Runs a shipped scene with some entries changed ('Section/Entry=value')
        and returns the directory with its results, history.h5 and, unless
        entries say otherwise, no fields. A run that is meant to fail says so."""
        directory = self.runs / f"{scene}-{dim}d-{name}"
        directory.mkdir(parents=True, exist_ok=True)
        command = [str(self.programs[dim]), str(SCENES[dim] / f"{scene}.prm"),
                   f"Output/Directory={directory}", "Output/Times=false",
                   "Output/Fields=false", *entries]
        done = subprocess.run(command, capture_output=True, text=True)
        (directory / "console.txt").write_text(done.stdout)
        if done.returncode != 0 and not fails:
            raise Failure(f"{scene} in {dim}D ({name}) ended with status "
                          f"{done.returncode}:\n"
                          f"{done.stdout[-2000:]}{done.stderr[-2000:]}")
        return directory

    def history(self, dim, scene, name, *entries, fails=False):
        """The same, returning the numbers of the run."""
        return Run(self.run(dim, scene, name, *entries, fails=fails))

    def save(self, figure, name):
        """Writes `name`.svg. Equal pictures give equal files, whenever they are
        made."""
        self.output.mkdir(parents=True, exist_ok=True)
        chart.save(figure, self.output, f"{name}.svg")
