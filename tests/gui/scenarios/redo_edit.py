"""As redo_select: operators that change the mesh in Edit Mode."""
from repeated import again

OPERATORS = (
    ("mesh.partwheel_deform", {"handles": True}, {"method": "PROPORTIONAL"}),
    ("mesh.partwheel_swap", {"other": "other", "build": False}, {"blend": 0.5}),
)


def play(stage):
    for operator in OPERATORS:
        yield from again(stage, "hand", "EDIT", *operator)
