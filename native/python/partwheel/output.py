# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that are written: none is left cut short."""

from contextlib import contextmanager
from pathlib import Path
from typing import Iterator


@contextmanager
def whole_file(path: Path) -> Iterator[None]:
    """Around what writes a file. If the disk is full, the file is removed, and the OSError names it."""
    try:
        yield
    except OSError as error:
        if error.filename is None:  # opened, but not written in full
            error.filename = str(path)
            if path.is_file():
                path.unlink()
        raise
