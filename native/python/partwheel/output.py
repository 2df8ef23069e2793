# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes files completely or not at all."""

import os
import secrets
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


def replace_text(path: Path, text: str) -> None:
    """Writes a file, and replaces an earlier one in one step: other processes see either."""
    temporary = path.with_name(f"new-{secrets.token_hex(8)}")
    temporary.write_text(text, "utf-8")
    os.replace(temporary, path)
