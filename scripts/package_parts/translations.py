"""Reads the add-on's translations from the .po files in addon/partwheel/translations, whose names are Blender's
language codes."""

import gettext
import io
import json
import string
import subprocess
import sys


def dictionary(catalogs):
    """{language: {message: translation}} of .po files, as JSON. Exits if one is malformed. Fuzzy and empty entries are
    left out."""
    tables = {catalog.stem: read(catalog) for catalog in sorted(catalogs)}
    return json.dumps(tables, ensure_ascii=False, indent=0).encode()


def read(catalog):
    process = subprocess.run(["msgfmt", "--check-format", "-o", "-", catalog], capture_output=True)
    if process.returncode:
        sys.exit(process.stderr.decode())
    table = gettext.GNUTranslations(io.BytesIO(process.stdout))._catalog
    del table[""]
    for message, translation in table.items():
        # msgfmt compares names only where an entry has the flag python-brace-format, and never formats.
        if placeholders(message) != placeholders(translation):
            sys.exit(f"{catalog}: the placeholders differ in {message!r} and {translation!r}.")
        if translation != translation.strip():
            sys.exit(f"{catalog}: there is space around {translation!r}.")
    return table


def placeholders(text):
    """(name, format) of each placeholder, sorted."""
    return sorted((name, form) for _, name, form, _ in string.Formatter().parse(text) if name is not None)
