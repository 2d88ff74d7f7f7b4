"""What a run has left in its output directory."""

from pathlib import Path

import h5py


class Run:
    """The history of a run: one value per level in `levels`, one per cycle in
    `cycles`, one per outer iteration in `outer` (Algorithm 2), one per contact
    node in `contact`."""

    def __init__(self, directory):
        self.directory = Path(directory)
        with h5py.File(self.directory / "history.h5") as file:
            self.levels = {name: data[:]
                           for name, data in file["levels"].items()}
            self.cycles = {name: data[:]
                           for name, data in file["cycles"].items()}
            self.outer = ({name: data[:] for name, data in file["outer"].items()}
                          if "outer" in file else None)
            self.contact = {int(name[-2:]): {key: data[:]
                                             for key, data in group.items()}
                            for name, group in file["contact"].items()}
        self.last = int(self.levels["level"][-1])
