"""The panel of the last operation, with other options, gives what the operator gives with these at once, and undo brings all
back: operators that select in Edit Mode."""
from repeated import again

# Operator, options, what is changed in the panel.
OPERATORS = (
    ("mesh.partwheel_similar", {"threshold": 0.99}, {"threshold": 0.3}),
    ("mesh.partwheel_mirrored", {"extend": True}, {"extend": False}),
    ("mesh.partwheel_recall", {"part": "first"}, {"part": "second"}),
    ("mesh.partwheel_recall", {"part": "first"}, {"part": "second", "extend": True}),
)


def play(stage):
    for operator in OPERATORS:
        symmetric = operator[0] == "mesh.partwheel_mirrored"
        yield from again(stage, "homer" if symmetric else "hand", "EDIT", *operator)
