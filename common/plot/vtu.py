"""Reads the .vtu files that the programs write: XML, and behind it arrays as they
are in memory, each after its length in bytes, 64 bits wide."""

import re
from pathlib import Path

import numpy as np

TYPES = {"Float32": "f4", "Float64": "f8", "Int32": "i4", "UInt8": "u1"}
ORDERS = {"LittleEndian": "<", "BigEndian": ">"}


# The faces of a hexahedron, corners in cyclic order.
FACES = np.array([[0, 1, 2, 3], [4, 5, 6, 7], [0, 1, 5, 4],
                  [2, 3, 7, 6], [0, 3, 7, 4], [1, 2, 6, 5]])


def attributes_of(tag):
    return dict(re.findall(r'(\w+)="([^"]*)"', tag))


def split(file_name):
    """The XML of a file, complete without the arrays, and the arrays' bytes."""
    contents = Path(file_name).read_bytes()
    start = contents.index(b"_", contents.index(b"<AppendedData")) + 1
    end = contents.rindex(b"\n  </AppendedData>")
    return (contents[:start] + contents[end:]).decode(), contents[start:end]


def read(file_name):
    """All arrays of a file by name, vectors and tensors as rows: of points, the
    displacement for example, or of cells, like stresses. The points themselves are
    called 'points', the cells are the rows of 'cells', corners in cyclic order."""
    text, data = split(file_name)
    order = ORDERS[attributes_of(re.search("<VTKFile[^>]*>", text)[0])["byte_order"]]
    arrays = {}
    for tag in re.findall(r"<DataArray[^>]*/>", text):
        attributes = attributes_of(tag)
        start = int(attributes["offset"])
        n_bytes = int(np.frombuffer(data, order + "u8", 1, start)[0])
        dtype = np.dtype(order + TYPES[attributes["type"]])
        values = np.frombuffer(data, dtype, n_bytes // dtype.itemsize, start + 8)
        n_components = int(attributes.get("NumberOfComponents", 1))
        if n_components > 1:
            values = values.reshape(-1, n_components)
        arrays[attributes.get("Name", "points")] = values
    ends = arrays["offsets"]
    arrays["cells"] = arrays["connectivity"].reshape(-1, ends[0] if len(ends) else 1)
    return arrays


def fields_of(file_name, kind):
    """The names of a file's arrays of points ('PointData') or of cells
    ('CellData')."""
    text, _ = split(file_name)
    inside = re.search(f"<{kind}>(.*?)</{kind}>", text, re.DOTALL)[1]
    return [attributes_of(tag)["Name"]
            for tag in re.findall(r"<DataArray[^>]*/>", inside)]


def pieces_of(record_name):
    """The files that a .pvtu lists."""
    path = Path(record_name)
    return [path.parent / attributes_of(tag)["Source"]
            for tag in re.findall(r"<Piece [^>]*/>", path.read_text())]
