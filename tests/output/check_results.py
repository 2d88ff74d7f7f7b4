"""Looks at all files of an output directory: each of them must be complete
under its name, and what they say about each other must be true.

Usage: check_results.py DIRECTORY [--unfinished]

With --unfinished the run was killed: files with '.part' in their names may be
there, and are not looked at."""

import re
import sys
import xml.etree.ElementTree as xml
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "common" / "plot"))
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


def check_table(name):
    """It is that of history.h5; after a run that was killed in between, without the
    last level."""
    lines = name.read_text().splitlines()
    columns = [column.split(" [")[0] for column in lines[0].split(",")]
    with h5py.File(directory / "history.h5") as file:
        levels = {key: data[()] for key, data in file["levels"].items()}
    assert sorted(columns) == sorted(levels), f"{name}: {columns}"
    rows = [[float(value) for value in line.split(",")] for line in lines[1:]]
    n_levels = len(levels["level"])
    assert len(rows) in ((n_levels - 1, n_levels) if unfinished else (n_levels,)), \
        f"{name}: {len(rows)} rows"
    for column, values in zip(columns, np.transpose(rows)):
        assert np.allclose(values, levels[column][:len(rows)], rtol=1e-10,
                           atol=0), f"{name}: {column}"


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
    """The pieces of a record, and which of their arrays belong to points and to
    cells: those that the record says."""
    record = xml.parse(name)
    fields = [[array.get("Name") for array in record.find(f".//P{kind}")]
              for kind in ("PointData", "CellData")]
    pieces = [directory / piece.get("Source") for piece in record.iter("Piece")]
    for piece in pieces:
        for kind, names in zip(("PointData", "CellData"), fields):
            assert vtu.fields_of(piece, kind) == names, f"{piece}: {kind}"
    return [vtu.read(piece) for piece in pieces], *fields


def check_piece(name):
    """The description is XML and its numbers are those of the arrays, which
    follow each other without gaps up to the end of the file."""
    text, data = vtu.split(name)
    description = xml.fromstring(text).find(".//Piece")
    arrays = vtu.read(name)
    n_points, n_cells = (int(description.get(f"NumberOf{what}"))
                         for what in ("Points", "Cells"))
    assert len(arrays["points"]) == n_points, f"{name}: points"
    for kind, count in ("PointData", n_points), ("CellData", n_cells):
        for key in vtu.fields_of(name, kind):
            assert len(arrays[key]) == count, f"{name}: {key}"
    assert len(arrays["cells"]) == len(arrays["types"]) == n_cells, f"{name}: cells"
    corners = np.unique(arrays["cells"])
    assert np.array_equal(corners, np.arange(n_points)), f"{name}: corners"
    assert len(data) == sum(array.nbytes + 8 for key, array in arrays.items()
                            if key != "cells"), f"{name}: size"


def check_fields(name):
    """Numbers are numbers, and a point has the same in the pieces of all processes
    that have it."""
    known = {}
    pieces, of_points, of_cells = read_pieces(name)
    assert "displacement" in of_points, f"{name}: no displacement"
    assert name.name.startswith("contact") or "von_Mises_stress" in of_cells, \
        f"{name}: no stress"
    for piece in pieces:
        for key, values in piece.items():
            assert np.all(np.isfinite(values)), f"{name}: {key}"
        for i, point in enumerate(piece["points"]):
            here = tuple(np.round(point, 10) + 0.)
            values = {key: piece[key][i] for key in of_points}
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
        elif path.suffix == ".csv":
            check_table(path)
        elif path.suffix == ".xdmf":
            check_description(path)
        elif path.suffix == ".pvtu":
            check_fields(path)
        elif path.suffix == ".vtu":
            check_piece(path)
        elif path.suffix == ".pvd":
            for entry in xml.parse(path).iter("DataSet"):
                assert (directory / entry.get("file")).exists(), path
    kinds = sorted({re.sub(r"[-.0-9]+", " ", path.name) for path in files})
    print(f"{len(files)} files of {len(kinds)} kinds are as they should be")


main()
