# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes files completely or not at all."""

from contextlib import contextmanager
from pathlib import Path
from typing import Iterator


@contextmanager
def whole_file(path: Path) -> Iterator[None]:
    """Context in which a file is written. If the disk is full, removes the file; the OSError names it."""
    try:
        yield
    except OSError as error:
        if error.filename is None:  # opened, but not written in full
            error.filename = str(path)
            if path.is_file():
                path.unlink()
        raise
