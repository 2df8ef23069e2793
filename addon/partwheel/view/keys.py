# SPDX-License-Identifier: GPL-3.0-or-later
"""Key bindings of the modal operators and their labels in the status bar. Does not import bpy.

A modal operator in Python can't have a keymap that users edit. So modal() looks up events in this table, and the status
bar shows its rows. Operators that start from a picked part are in Blender's own keymap, where users can edit them; see
COMMANDS."""

from typing import NamedTuple


class Key(NamedTuple):
    """The event types that trigger an action, and its display in the status bar: Blender's icons, or a text."""

    events: frozenset
    label: str
    icons: tuple = ()
    names: str = ""


class Command(NamedTuple):
    """An operator that acts on the last pick, and its key, which is pressed with Shift and Ctrl."""

    operator: str
    key: str
    label: str
    options: dict = {}


WHEEL_STEPS = {"WHEELUPMOUSE": 1, "PAGE_UP": 1, "NUMPAD_PLUS": 1, "UP_ARROW": 1,
               "WHEELDOWNMOUSE": -1, "PAGE_DOWN": -1, "NUMPAD_MINUS": -1, "DOWN_ARROW": -1}
RESIZE = Key(frozenset(WHEEL_STEPS), "Size", names="Wheel, ↑↓")
CONFIRM = Key(frozenset({"RET", "NUMPAD_ENTER"}), "Confirm", ("EVENT_RETURN",))
CANCEL = Key(frozenset({"RIGHTMOUSE", "ESC"}), "Cancel", ("EVENT_ESC", "MOUSE_RMB"))
CLICK = Key(frozenset({"LEFTMOUSE"}), "Pick a Part", ("MOUSE_LMB",))
SNAP_BORDER = Key(frozenset("E"), "Snap", ("EVENT_SHIFT", "EVENT_CTRL", "EVENT_E"))
ERASE = Key(frozenset({"BACK_SPACE"}), "")
DIGITS = dict(zip(("ZERO", "ONE", "TWO", "THREE", "FOUR", "FIVE", "SIX", "SEVEN", "EIGHT", "NINE"), "0123456789"))
NUMBER = Key(frozenset(DIGITS), "Number", names="0-9")
NAVIGATE = Key(frozenset({
    "MIDDLEMOUSE", "MOUSEPAN", "MOUSEZOOM", "MOUSEROTATE", "TRACKPADPAN", "TRACKPADZOOM", "NDOF_MOTION", "HOME",
    "NUMPAD_0", "NUMPAD_1", "NUMPAD_2", "NUMPAD_3", "NUMPAD_4", "NUMPAD_5", "NUMPAD_6", "NUMPAD_7", "NUMPAD_8",
    "NUMPAD_9", "NUMPAD_PERIOD"}), "Navigate", ("MOUSE_MMB",))
# Events that the operators don't handle and must pass on to Blender.
SYSTEM = frozenset({"TIMER", "TIMER_REPORT", "WINDOW_DEACTIVATE"})
MODIFIERS = frozenset({"LEFT_SHIFT", "RIGHT_SHIFT", "LEFT_CTRL", "RIGHT_CTRL", "LEFT_ALT", "RIGHT_ALT", "OSKEY",
                       "HYPER"})
BUTTONS = frozenset({"LEFTMOUSE", "RIGHTMOUSE"})  # with Alt they navigate in some keymaps
MOVES = frozenset({"MOUSEMOVE", "INBETWEEN_MOUSEMOVE"})

WAITING = (CLICK, NAVIGATE, CANCEL)
COMPUTING = (NAVIGATE, CANCEL._replace(icons=("EVENT_ESC",)))
# After a pick. COMMANDS and ENDS are shown after these, as many as fit in a window that is 1280 pixels wide.
PICKED = (RESIZE, NUMBER._replace(label="Part"), SNAP_BORDER)
# With the toolbar's tool: a click picks the next part, and digits are passed on to Blender.
TOOL_PICKED = (RESIZE, CLICK._replace(label="Next Part"), SNAP_BORDER)
# The same while the mouse is away from the click, where the wheel zooms.
TOOL_PICKED_AWAY = (RESIZE._replace(names="↑↓"), *TOOL_PICKED[1:])
ENDS = (CONFIRM, CANCEL)  # with the tool only CANCEL: any other action confirms
# Shift, Ctrl and a letter that no keymap of Blender uses in Edit Mode.
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

# While similar parts are chosen.
SIMILAR = (Key(frozenset(WHEEL_STEPS), "More, Fewer", names="Wheel, ↑↓"), CONFIRM, NAVIGATE, CANCEL)

# While a border is drawn.
DRAWING_BORDER = (CLICK._replace(label="Draw", icons=("MOUSE_LMB_DRAG",)), CANCEL)

# While loose bits are chosen.
LOOSE_BITS = (RESIZE, CLICK._replace(label="Delete"), CONFIRM, NAVIGATE, CANCEL)

# While a part is deformed: between movements of the handle, and during one.
DRAG = Key(frozenset({"LEFTMOUSE"}), "Drag or Place the Handle", ("MOUSE_LMB_DRAG",))
ONE_MORE = Key(frozenset(), "One More", ("EVENT_SHIFT", "MOUSE_LMB_DRAG"))
TRANSFORM = Key(frozenset("GRS"), "Move, Rotate, Scale", ("EVENT_G", "EVENT_R", "EVENT_S"))
HANDLE_SIZE = Key(frozenset({"WHEELUPMOUSE", "WHEELDOWNMOUSE"}), "Handle Size", names="Wheel")
RECOMPUTE = Key(frozenset("P"), "Confirm, Recompute Parts", ("EVENT_P",))
AXIS = Key(frozenset("XYZ"), "Axis", ("EVENT_X", "EVENT_Y", "EVENT_Z"))
PLANE = Key(frozenset(), "Plane", ("EVENT_SHIFT", "EVENT_X", "EVENT_Y", "EVENT_Z"))
TYPE = Key(frozenset(DIGITS), "Type", names="0-9 . -")
SNAP_STEPS = Key(frozenset({"LEFT_CTRL", "RIGHT_CTRL"}), "Snap", ("EVENT_CTRL",))
PRECISE = Key(frozenset({"LEFT_SHIFT", "RIGHT_SHIFT"}), "Precise", ("EVENT_SHIFT",))
DONE = Key(CLICK.events | CONFIRM.events, "Done", ("MOUSE_LMB", "EVENT_RETURN"))
DEFORMING = (DRAG, ONE_MORE, TRANSFORM, HANDLE_SIZE, CONFIRM, RECOMPUTE, NAVIGATE, CANCEL)
MOVING = (AXIS, PLANE, TYPE, SNAP_STEPS, PRECISE, TRANSFORM, DONE, CANCEL)

# While a part is placed. Keys in pairs, such as those for the size: WHEEL_STEPS says which is up.
SIZE = Key(frozenset({"WHEELUPMOUSE", "WHEELDOWNMOUSE", "NUMPAD_PLUS", "NUMPAD_MINUS"}), "Size", names="Wheel")
TURN = Key(SIZE.events, "Turn", names="Shift Wheel")
DEPTH = Key(frozenset({"PAGE_UP", "PAGE_DOWN"}), "Depth", names="Page Up/Down")
FIT = Key(frozenset({"F"}), "Fit Border", ("EVENT_F",))
MIRROR = Key(frozenset({"M"}), "Mirror Copy", ("EVENT_M",))
# While compatible parts are offered: the same keys, with modifiers.
OFFER = Key(frozenset({"WHEELUPMOUSE", "WHEELDOWNMOUSE", "UP_ARROW", "DOWN_ARROW"}), "Next, Previous Part",
            names="Wheel")
SWAPPING = (OFFER, TURN, SIZE._replace(names="Ctrl Wheel"), DEPTH, MIRROR._replace(label="Mirror"),
            CLICK._replace(label="Swap"), NAVIGATE, CANCEL)
PLACING = (SIZE, TURN, DEPTH, FIT, MIRROR, CLICK._replace(label="Confirm"), NAVIGATE, CANCEL)

# While the whole model is cut into parts: the wheel acts on the clicked part, or on all.
ONE = Key(CLICK.events, "A Part", ("MOUSE_LMB",))
MERGE = Key(frozenset(), "Merge", ("MOUSE_LMB_DRAG",))
COUNT = Key(frozenset(WHEEL_STEPS), "More, Fewer", names="Wheel")
DIVIDE = Key(frozenset(WHEEL_STEPS), "Join, Split", names="Wheel")
AUTOMATIC = Key(frozenset("A"), "Automatic", ("EVENT_A",))
CUT_RESULTS = {"FACE_SETS": Key(frozenset("S"), "Face Sets", ("EVENT_S",)),
               "VERTEX_GROUPS": Key(frozenset("G"), "Groups", ("EVENT_G",)),
               "COLORS": Key(frozenset("C"), "Colors", ("EVENT_C",)),
               "MATERIALS": Key(frozenset("M"), "Slots", ("EVENT_M",)),
               "SEAMS": Key(frozenset("U"), "Seams", ("EVENT_U",)),
               "OBJECTS": Key(frozenset("O"), "Objects", ("EVENT_O",)),
               "BONES": Key(frozenset("B"), "Bones", ("EVENT_B",)),
               "PRINT": Key(frozenset("P"), "Print", ("EVENT_P",))}
CUTTING = (COUNT, NUMBER, AUTOMATIC, ONE, MERGE, *CUT_RESULTS.values(), CONFIRM, CANCEL)
CUTTING_ONE_PART = (DIVIDE, MERGE, ONE._replace(label="Another"), *CUT_RESULTS.values(), CONFIRM, CANCEL)

SCROLL_STEP, DRAG_STEP = 30, 24  # pixels per notch of a trackpad scroll and of a drag


class NotchCounter:
    """Converts pixels of a trackpad scroll to notches."""

    remainder = 0.0  # pixels that are no complete notch yet

    def add_pixels(self, pixels: float) -> int:
        """Add pixels and return the number of complete notches."""
        self.remainder += pixels
        whole = int(self.remainder / SCROLL_STEP)
        self.remainder -= whole * SCROLL_STEP
        return whole
