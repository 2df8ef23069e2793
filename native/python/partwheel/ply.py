# SPDX-License-Identifier: GPL-3.0-or-later
"""Binary PLY files with polygons of different sizes, which trimesh can't read, as text, which it can."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Iterator, List, NamedTuple, Optional, Tuple

import numpy as np

CODES = {"char": "b", "int8": "b", "uchar": "B", "uint8": "B", "short": "h", "int16": "h", "ushort": "H", "uint16": "H",
         "int": "i", "int32": "i", "uint": "I", "uint32": "I", "float": "f", "float32": "f", "double": "d", "float64": "d"}


class Element(NamedTuple):
    """Rows of properties.

    properties : of each property the code of its list's length, or "" for a single number, and the code of its numbers
    """

    row_count: int
    properties: List[Tuple[str, str]]


def to_text_if_mixed(path: Path) -> Optional[bytes]:
    """The content of a PLY file as text, if the file is binary and an element has lists of different lengths; otherwise
    None, also if the file is damaged, which trimesh reports."""
    data = path.read_bytes()
    try:
        end = data.index(b"\n", data.index(b"end_header")) + 1
        header = data[:end].decode("ascii", "replace")
        form, elements = _parse_header(header)
        order = {"binary_little_endian": "<", "binary_big_endian": ">"}.get(form, "")
        if not order or not _is_mixed(data, end, order, elements):
            return None
        text, start = [header.replace(form, "ascii", 1)], end
        for element in elements:
            for row, start in _rows(data, start, order, element):
                text.append(" ".join(map(repr, row)) + "\n")
    except (ValueError, IndexError, KeyError, struct.error):
        return None
    return "".join(text).encode()


def _parse_header(header: str) -> Tuple[str, List[Element]]:
    form, elements = "", []
    for words in map(str.split, header.splitlines()):
        if words[:1] == ["format"]:
            form = words[1]
        elif words[:1] == ["element"]:
            elements.append(Element(int(words[2]), []))
        elif words[:2] == ["property", "list"]:
            elements[-1].properties.append((CODES[words[2]], CODES[words[3]]))
        elif words[:1] == ["property"]:
            elements[-1].properties.append(("", CODES[words[1]]))
    return form, elements


def _is_mixed(data: bytes, start: int, order: str, elements: List[Element]) -> bool:
    """Whether an element has lists of different lengths."""
    for element in elements:
        if not element.row_count:
            continue
        first, _ = next(_rows(data, start, order, element))
        fields: List[Tuple[str, str, Tuple[int, ...]]] = []
        lengths = {}
        for length, code in element.properties:
            size = 1
            if length:
                size = int(first[sum(np.prod(shape, dtype=int) for _, _, shape in fields)])
                lengths[f"f{len(fields)}"] = size
                fields.append((f"f{len(fields)}", order + length, ()))
            fields.append((f"f{len(fields)}", order + code, (size,)))
        layout = np.dtype(fields)
        if start + element.row_count * layout.itemsize > len(data):
            return bool(lengths)
        rows = np.frombuffer(data, layout, element.row_count, start)
        if any((rows[name] != size).any() for name, size in lengths.items()):
            return True
        start += rows.nbytes
    return False


def _rows(data: bytes, start: int, order: str, element: Element) -> Iterator[Tuple[List[float], int]]:
    """The numbers of each row, with the length before each list, and where the row ends."""
    for _ in range(element.row_count):
        row: List[float] = []
        for length, code in element.properties:
            count = 1
            if length:
                count, = struct.unpack_from(order + length, data, start)
                start += struct.calcsize(order + length)
                row.append(count)
            row += struct.unpack_from(f"{order}{count}{code}", data, start)
            start += struct.calcsize(f"{order}{count}{code}")
        yield row, start
