"""Looks at all files of an output directory: each of them must be complete
under its name, and what they say about each other must be true.

Usage: check_results.py DIRECTORY [--unfinished]

With --unfinished the run was killed: files with '.part' in their names may be
there, and are not looked at."""

import re
import sys
import xml.etree.ElementTree as xml
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "doc" / "figures"))
try:
    import h5py
    import numpy as np
    import vtu
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

directory = Path(sys.argv[1])
unfinished = "--unfinished" in sys.argv


def check_datasets(name):
    """Every number of an HDF5 file can be read."""
    count = 0

    def visit(path, item):
        nonlocal count
        if isinstance(item, h5py.Dataset):
            values = item[()]
            assert np.all(np.isfinite(values)), f"{name}: {path}"
            count += 1

    with h5py.File(name) as file:
        file.visititems(visit)
    assert count > 0, f"{name} is empty"


def check_description(name):
    """The datasets that XDMF describes are there, with their sizes."""
    for item in xml.parse(name).iter("DataItem"):
        if item.get("Format") != "HDF":
            continue
        file, path = item.text.strip().split(":")
        shape = tuple(int(n) for n in item.get("Dimensions").split())
        with h5py.File(directory / file) as data:
            assert data[path].shape == shape, f"{name}: {item.text}"


def read_pieces(name):
    """The pieces of a record, those of processes without cells excepted."""
    pieces = [directory / piece.get("Source")
              for piece in xml.parse(name).iter("Piece")]
    for piece in pieces:
        xml.parse(piece)
    return [vtu.read(piece) for piece in pieces
            if 'NumberOfPoints="0"' not in piece.read_text()[:2000]]


def check_fields(name):
    """Numbers are numbers, and on the contact boundary a point has the same
    in all faces, whichever processes these belong to."""
    nodal = name.name.startswith("contact")
    known = {}
    for piece in read_pieces(name):
        for key, values in piece.items():
            assert np.all(np.isfinite(values)), f"{name}: {key}"
        fields = [key for key in piece
                  if len(piece[key]) == len(piece["points"])
                  and key not in ("points", "cells", "connectivity", "types",
                                  "offsets")]
        assert "displacement" in fields, f"{name}: no displacement"
        if not nodal:
            continue
        for i, point in enumerate(piece["points"]):
            here = tuple(np.round(point, 6) + 0.)
            values = {key: piece[key][i] for key in fields}
            for key, value in known.setdefault(here, values).items():
                assert np.array_equal(value, values[key]), \
                    f"{name}: {key} at {here}"


def main():
    files = sorted(path for path in directory.iterdir() if path.is_file())
    parts = [path for path in directory.iterdir() if ".part" in path.name]
    assert unfinished or not parts, f"left over: {parts}"
    files = [path for path in files if path not in parts]
    for path in files:
        if path.suffix == ".h5":
            check_datasets(path)
        elif path.suffix == ".xdmf":
            check_description(path)
        elif path.suffix == ".pvtu":
            check_fields(path)
        elif path.suffix == ".vtu":
            xml.parse(path)
        elif path.suffix == ".pvd":
            for entry in xml.parse(path).iter("DataSet"):
                assert (directory / entry.get("file")).exists(), path
    kinds = sorted({re.sub(r"[-.0-9]+", " ", path.name) for path in files})
    print(f"{len(files)} files of {len(kinds)} kinds are as they should be")


main()
