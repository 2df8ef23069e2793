# SPDX-License-Identifier: GPL-3.0-or-later
"""A host program may have set any locale: numbers given to the mesher, and those in sentences, are the same in all."""

import shapes
from partwheel import Hierarchy, FillMethod


def answers():
    """Saved bytes with points inside, and notes with numbers."""
    shape = shapes.SHAPES["torus"]()
    saved = Hierarchy.build(*shape, quality=1.4).save()
    return bytes(saved), Hierarchy.build(*shape, fill_methods=FillMethod.POINTS).notes


def test_numbers_do_not_depend_on_the_locale(request):
    saved, notes = answers()
    request.getfixturevalue("comma")
    german_saved, german_notes = answers()
    assert german_saved == saved
    assert german_notes == notes and "." in notes.partition("at most ")[2].partition(" %")[0]
