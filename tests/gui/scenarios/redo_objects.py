"""As redo_select: operators that pick, place and unite in Object Mode."""
from repeated import again

FACE = 700
OPERATORS = (
    ("object.partwheel_pick", {"face_index": FACE}, {"level": 1}),
    ("object.partwheel_place", {"target": "hand", "location": (0.1, 0.2, 0.3)}, {"scale": 2.0}),
    ("object.partwheel_place", {"target": "hand", "location": (0.1, 0.2, 0.3)}, {"mirror": True}),
    ("object.partwheel_unite", {"build": False}, {"keep": True}),
    ("object.partwheel_unite", {"build": False, "keep": True}, {"blend": 0.5, "keep": False}),
)


def play(stage):
    for operator in OPERATORS:
        yield from again(stage, "hand", "OBJECT", *operator)
