"""What the tests of friction-plot have in common: the programs, a scratch folder, and
checks that are counted."""

import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PLOT = ROOT / "common" / "plot"
sys.path.insert(0, str(PLOT))


class Workshop:
    """The command line is: both programs, the repository, what starts several
    processes, and its option for their number."""

    def __init__(self):
        two, three, _, self._mpiexec, self._numproc = sys.argv[1:6]
        self.programs = {2: two, 3: three}
        self._folder = tempfile.TemporaryDirectory(prefix="plot-")
        self.folder = Path(self._folder.name)
        self.failures = 0

    def scene(self, dim, name):
        return ROOT / f"step-friction-{dim}d" / "scenes" / f"{name}.prm"

    def run(self, dim, scene, name, *entries, processes=1):
        """Runs a scene into a folder of this name; returns the folder and what has
        been printed."""
        directory = self.folder / name
        command = [self.programs[dim], str(self.scene(dim, scene)),
                   f"Output/Directory={directory}", *entries]
        if processes > 1:
            command = [self._mpiexec, self._numproc, str(processes), *command]
        result = subprocess.run(command, capture_output=True, text=True, check=False)
        self.check(result.returncode == 0, f"{name} runs", result.stderr[-300:])
        return directory, result.stdout

    def plot(self, *arguments, environment=None):
        """Status, output and error of friction-plot."""
        result = subprocess.run(
            [sys.executable, "-B", str(PLOT / "friction_plot.py"),
             *map(str, arguments)], capture_output=True, text=True, check=False,
            cwd=self.folder, env=environment)
        return result.returncode, result.stdout, result.stderr

    def check(self, condition, what, detail=""):
        if not condition:
            self.failures += 1
            print(f"FAILED  {what}: {detail}")
        else:
            print(f"ok      {what}")

    def end(self):
        self._folder.cleanup()
        sys.exit(self.failures > 0)


def is_picture(path):
    """A PNG of sensible size, neither empty nor cut off."""
    import numpy as np
    from PIL import Image

    with Image.open(path) as image:
        pixels = np.asarray(image.convert("L"))
    height, width = pixels.shape
    ink = np.mean(pixels < 250)
    edges = np.concatenate([pixels[0], pixels[-1], pixels[:, 0], pixels[:, -1]])
    return (600 <= width <= 2500 and 400 <= height <= 2500 and 0.01 < ink < 0.7
            and (edges > 250).all())
