# SPDX-License-Identifier: GPL-3.0-or-later
"""Said: what users are told, so that it can be told in another language."""


class Said:
    """sentences: templates, which are looked up one by one; values: what is in their braces, maybe Said as well. str() is
    all of it, in English."""

    def __init__(self, *sentences, **values):
        self.sentences, self.values = sentences, values

    def __str__(self):
        return " ".join(self.sentences).format(**self.values)
