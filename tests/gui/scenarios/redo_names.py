"""As redo_select: operators that name parts and clear them."""
from repeated import again

OPERATORS = (
    ("mesh.partwheel_rename", {"part": "first", "new": "third"}, {"new": "fourth"}),
    ("mesh.partwheel_forget", {"part": "first"}, {"part": "second"}),
    ("mesh.partwheel_clear", {}, {}),
)


def play(stage):
    for operator in OPERATORS:
        yield from again(stage, "hand", "EDIT", *operator)
