"""Reads the .vtu files that deal.II writes: little-endian arrays, compressed
by zlib in blocks and coded in base 64, one header of 32 bit integers each."""

import base64
import re
import struct
import zlib
from pathlib import Path

import numpy as np

TYPES = {"Float32": "<f4", "Float64": "<f8", "Int32": "<i4", "UInt32": "<u4",
         "Int64": "<i8", "UInt64": "<u8", "UInt8": "u1", "Int8": "i1"}


# The faces of a hexahedron, corners in cyclic order.
FACES = np.array([[0, 1, 2, 3], [4, 5, 6, 7], [0, 1, 5, 4],
                  [2, 3, 7, 6], [0, 3, 7, 4], [1, 2, 6, 5]])


def decode(text, dtype):
    """The array in one binary DataArray."""
    text = "".join(text.split())
    (n_blocks,) = struct.unpack("<I", base64.b64decode(text[:8])[:4])
    n_header = 4 * (3 + n_blocks)
    n_coded = 4 * ((n_header + 2) // 3)
    header = struct.unpack(f"<{3 + n_blocks}I",
                           base64.b64decode(text[:n_coded])[:n_header])
    data = base64.b64decode(text[n_coded:])
    blocks, start = [], 0
    for size in header[3:]:
        blocks.append(zlib.decompress(data[start:start + size]))
        start += size
    return np.frombuffer(b"".join(blocks), dtype=dtype)


def read(file_name):
    """All arrays of a file with one piece by name, vectors as rows; the points
    are called 'points', the cells are the rows of 'cells'."""
    text = Path(file_name).read_text()
    text = text[text.index("<Piece"):]
    arrays = {}
    pattern = re.compile(r"<DataArray([^>]*)>([^<]*)</DataArray>")
    for match in pattern.finditer(text):
        attributes = dict(re.findall(r'(\w+)="([^"]*)"', match.group(1)))
        dtype = np.dtype(TYPES[attributes["type"]])
        if attributes["format"] == "binary":
            values = decode(match.group(2), dtype)
        else:
            values = np.array(match.group(2).split(), dtype=dtype)
        n_components = int(attributes.get("NumberOfComponents", 1))
        if n_components > 1:
            values = values.reshape(-1, n_components)
        arrays[attributes.get("Name", "points")] = values
    n_cells = len(arrays["offsets"])
    arrays["cells"] = arrays["connectivity"].reshape(n_cells, -1)
    return arrays
