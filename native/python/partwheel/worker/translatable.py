# SPDX-License-Identifier: GPL-3.0-or-later
"""Messages that a caller can translate."""


class TranslatableText:
    """A message for users.

    sentences : English templates, each of which is translated separately
    values : what to put into the templates' {fields}; a value may be a TranslatableText or a WorkerError, too

    str() is the message in English.
    """

    def __init__(self, *sentences: str, **values: object) -> None:
        self.sentences, self.values = sentences, values

    def __str__(self) -> str:
        return " ".join(self.sentences).format(**self.values)
