# SPDX-License-Identifier: GPL-3.0-or-later
"""Which event does what while a part is being picked, placed or deformed, and how the status bar names it. No bpy here.

A modal operator written in Python can't have a keymap that users edit, so this table is it: modal() looks events up
here, and the status bar is drawn from the same rows. What starts another operator with the part is in Blender's own
keymap, where users can edit it: COMMANDS.
"""

from __future__ import annotations

from typing import NamedTuple


class Key(NamedTuple):
    """An action, the event types that cause it, and how the status bar shows them: icons of Blender's, or a text."""

    action: str
    events: frozenset
    label: str
    icons: tuple = ()
    names: str = ""


class Command(NamedTuple):
    """An operator on the part that was picked last, and its key, which is pressed with Shift and Ctrl."""

    operator: str
    key: str
    label: str
    options: dict = {}


WHEEL_STEPS = {"WHEELUPMOUSE": 1, "PAGE_UP": 1, "NUMPAD_PLUS": 1, "UP_ARROW": 1,
               "WHEELDOWNMOUSE": -1, "PAGE_DOWN": -1, "NUMPAD_MINUS": -1, "DOWN_ARROW": -1}
RESIZE = Key("RESIZE", frozenset(WHEEL_STEPS), "Size", names="Wheel, ↑↓")
CONFIRM = Key("CONFIRM", frozenset({"RET", "NUMPAD_ENTER"}), "Confirm", ("EVENT_RETURN",))
CANCEL = Key("CANCEL", frozenset({"RIGHTMOUSE", "ESC"}), "Cancel", ("EVENT_ESC", "MOUSE_RMB"))
CLICK = Key("CLICK", frozenset({"LEFTMOUSE"}), "Pick a Part", ("MOUSE_LMB",))
SNAP_BORDER = Key("SNAP_BORDER", frozenset("E"), "Snap", ("EVENT_SHIFT", "EVENT_CTRL", "EVENT_E"))
ERASE = Key("ERASE", frozenset({"BACK_SPACE"}), "")
DIGITS = dict(zip(("ZERO", "ONE", "TWO", "THREE", "FOUR", "FIVE", "SIX", "SEVEN", "EIGHT", "NINE"), "0123456789"))
NUMBER = Key("NUMBER", frozenset(DIGITS), "Number", names="0-9")
NAVIGATE = Key("NAVIGATE", frozenset({
    "MIDDLEMOUSE", "MOUSEPAN", "MOUSEZOOM", "MOUSEROTATE", "TRACKPADPAN", "TRACKPADZOOM", "NDOF_MOTION", "HOME",
    "NUMPAD_0", "NUMPAD_1", "NUMPAD_2", "NUMPAD_3", "NUMPAD_4", "NUMPAD_5", "NUMPAD_6", "NUMPAD_7", "NUMPAD_8",
    "NUMPAD_9", "NUMPAD_PERIOD"}), "Navigate", ("MOUSE_MMB",))
# Events that are no answer to anything on the screen and must reach Blender itself.
SYSTEM = frozenset({"TIMER", "TIMER_REPORT", "WINDOW_DEACTIVATE"})
MODIFIERS = frozenset({"LEFT_SHIFT", "RIGHT_SHIFT", "LEFT_CTRL", "RIGHT_CTRL", "LEFT_ALT", "RIGHT_ALT", "OSKEY",
                       "HYPER"})
BUTTONS = frozenset({"LEFTMOUSE", "RIGHTMOUSE"})  # with Alt they navigate too, in some keymaps
MOVES = frozenset({"MOUSEMOVE", "INBETWEEN_MOUSEMOVE"})

WAITING = (CLICK, NAVIGATE, CANCEL)
# While a part is held; then COMMANDS, and the ends: as many as fit in a window 1280 pixels wide.
PICKED = (RESIZE, NUMBER._replace(label="Part"), SNAP_BORDER)
# With the toolbar's tool a click goes on to the next part, and 1, 2 and 3 are Blender's.
TOOL_PICKED = (RESIZE, CLICK._replace(label="Next Part"), SNAP_BORDER)
# The same while the mouse is elsewhere than where it clicked: there the wheel zooms.
TOOL_PICKED_AWAY = (RESIZE._replace(names="↑↓"), *TOOL_PICKED[1:])
ENDS = (CONFIRM, CANCEL)  # by the toolbar's tool only the second: there whatever is done next confirms
# Shift, Ctrl and a letter, of those that no keymap of Blender's has for anything in Edit Mode.
COMMANDS = (
    Command("mesh.partwheel_deform", "D", "Drag", {"method": "RIGID"}),
    Command("mesh.partwheel_deform", "J", "Turn", {"method": "JOINT"}),
    Command("mesh.partwheel_move", "G", "Move"),
    Command("mesh.partwheel_deform", "P", "Within", {"method": "PROPORTIONAL", "start": "G"}),
    Command("mesh.partwheel_similar", "L", "Similar"),
    Command("mesh.partwheel_mirrored", "F", "Mirror"),
    Command("mesh.partwheel_copy", "C", "Copy"),
    Command("mesh.partwheel_remove", "X", "Remove"),
)

# While the parts that are alike are chosen.
SIMILAR = (Key("ALIKE", frozenset(WHEEL_STEPS), "More, Fewer", names="Wheel, ↑↓"), CONFIRM, NAVIGATE, CANCEL)

# While a part is deformed: between two movements of the handle, and during one.
DRAG = Key("DRAG", frozenset({"LEFTMOUSE"}), "Drag the Handle, or Put It Elsewhere", ("MOUSE_LMB_DRAG",))
ONE_MORE = Key("ONE_MORE", frozenset(), "One More", ("EVENT_SHIFT", "MOUSE_LMB_DRAG"))
TRANSFORM = Key("TRANSFORM", frozenset("GRS"), "Move, Rotate, Scale", ("EVENT_G", "EVENT_R", "EVENT_S"))
HANDLE_SIZE = Key("HANDLE_SIZE", frozenset({"WHEELUPMOUSE", "WHEELDOWNMOUSE"}), "Handle Size", names="Wheel")
RECOMPUTE = Key("RECOMPUTE", frozenset("P"), "Confirm, Recompute Parts", ("EVENT_P",))
AXIS = Key("AXIS", frozenset("XYZ"), "Axis", ("EVENT_X", "EVENT_Y", "EVENT_Z"))
PLANE = Key("PLANE", frozenset(), "Plane", ("EVENT_SHIFT", "EVENT_X", "EVENT_Y", "EVENT_Z"))
TYPE = Key("TYPE", frozenset(DIGITS), "Type", names="0-9 . -")
SNAP_STEPS = Key("STEPS", frozenset({"LEFT_CTRL", "RIGHT_CTRL"}), "Snap", ("EVENT_CTRL",))
PRECISE = Key("FINE", frozenset({"LEFT_SHIFT", "RIGHT_SHIFT"}), "Precise", ("EVENT_SHIFT",))
DONE = Key("DONE", CLICK.events | CONFIRM.events, "Done", ("MOUSE_LMB", "EVENT_RETURN"))
DEFORMING = (DRAG, ONE_MORE, TRANSFORM, HANDLE_SIZE, CONFIRM, RECOMPUTE, NAVIGATE, CANCEL)
MOVING = (AXIS, PLANE, TYPE, SNAP_STEPS, PRECISE, TRANSFORM, DONE, CANCEL)

# While a part is placed; those that come in pairs are in TURNS too.
SIZE = Key("SIZE", frozenset({"WHEELUPMOUSE", "WHEELDOWNMOUSE", "NUMPAD_PLUS", "NUMPAD_MINUS"}), "Size", names="Wheel")
TURN = Key("TURN", SIZE.events, "Turn", names="Shift Wheel")
DEPTH = Key("DEPTH", frozenset({"PAGE_UP", "PAGE_DOWN"}), "Depth", names="Page Up/Down")
FIT = Key("FIT", frozenset({"F"}), "Fit Border", ("EVENT_F",))
MIRROR = Key("MIRROR", frozenset({"M"}), "Mirror Copy", ("EVENT_M",))
# While compatible parts are offered: those in pairs as above, with other keys held.
OFFER = Key("OFFER", frozenset({"WHEELUPMOUSE", "WHEELDOWNMOUSE", "UP_ARROW", "DOWN_ARROW"}), "Next, Previous Part",
            names="Wheel")
SWAPPING = (OFFER, TURN, SIZE._replace(names="Ctrl Wheel"), DEPTH, MIRROR._replace(label="Mirror"),
            CLICK._replace(label="Swap"), NAVIGATE, CANCEL)
PLACING = (SIZE, TURN, DEPTH, FIT, MIRROR, CLICK._replace(label="Confirm"), NAVIGATE, CANCEL)

# While the whole model is divided into parts: the wheel does what it does to the part that was clicked, or to all.
ONE = Key("ONE", CLICK.events, "A Part", ("MOUSE_LMB",))
MERGE = Key("MERGE", frozenset(), "Merge", ("MOUSE_LMB_DRAG",))
COUNT = Key("COUNT", frozenset(WHEEL_STEPS), "More, Fewer", names="Wheel")
DIVIDE = Key("DIVIDE", frozenset(WHEEL_STEPS), "Join, Split", names="Wheel")
AUTOMATIC = Key("ANEW", frozenset("A"), "Automatic", ("EVENT_A",))
CUT_RESULTS = {"FACE_SETS": Key("FACE_SETS", frozenset("S"), "Face Sets", ("EVENT_S",)),
               "VERTEX_GROUPS": Key("VERTEX_GROUPS", frozenset("G"), "Groups", ("EVENT_G",)),
               "COLORS": Key("COLORS", frozenset("C"), "Colours", ("EVENT_C",)),
               "MATERIALS": Key("MATERIALS", frozenset("M"), "Slots", ("EVENT_M",)),
               "SEAMS": Key("SEAMS", frozenset("U"), "Seams", ("EVENT_U",)),
               "OBJECTS": Key("OBJECTS", frozenset("O"), "Objects", ("EVENT_O",)),
               "BONES": Key("BONES", frozenset("B"), "Bones", ("EVENT_B",)),
               "PRINT": Key("PRINT", frozenset("P"), "Print", ("EVENT_P",))}
CUTTING = (COUNT, NUMBER, AUTOMATIC, ONE, MERGE, *CUT_RESULTS.values(), CONFIRM, CANCEL)
CUTTING_ONE_PART = (DIVIDE, MERGE, ONE._replace(label="Another"), *CUT_RESULTS.values(), CONFIRM, CANCEL)

SCROLL_STEP, DRAG_STEP = 30, 24  # pixels of a trackpad's scroll, and of a drag, that count as a notch


class NotchCounter:
    """Counts notches in a trackpad's scroll or a drag, both of which come as pixels."""

    def __init__(self, step: float) -> None:
        self.step, self.remainder = step, 0.0

    def add_pixels(self, pixels: float) -> int:
        self.remainder += pixels
        whole = int(self.remainder / self.step)
        self.remainder -= whole * self.step
        return whole
