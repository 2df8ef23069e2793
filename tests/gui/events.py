"""Mouse and keyboard: two drivers with the same methods. Coordinates are the window's: pixels, origin bottom left."""
import subprocess


class _Driver:
    """What both drivers share. Buttons and keys have Blender's names of event types."""

    def __init__(self):
        self.x = self.y = 0

    def click(self, button="LEFTMOUSE", **modifiers):
        self.press(button, **modifiers)
        self.release(button, **modifiers)


class Simulated(_Driver):
    """Blender's own event_simulate (needs --enable-event-simulate, which makes Blender ignore real input)."""

    def __init__(self, window):
        super().__init__()
        self._window = window

    def _send(self, kind, value, **modifiers):
        self._window.event_simulate(kind, value, x=self.x, y=self.y, **modifiers)

    def move(self, x, y, **modifiers):
        self.x, self.y = x, y
        self._send("MOUSEMOVE", "NOTHING", **modifiers)

    def press(self, button, **modifiers):
        self._send(button, "PRESS", **modifiers)

    def release(self, button, **modifiers):
        self._send(button, "RELEASE", **modifiers)

    def key(self, key, **modifiers):
        self._send(key, "PRESS", **modifiers)
        self._send(key, "RELEASE", **modifiers)

    def wheel(self, notches, **modifiers):
        """Turns the wheel: up if notches > 0, else down."""
        for _ in range(abs(notches)):
            self._send("WHEELUPMOUSE" if notches > 0 else "WHEELDOWNMOUSE", "PRESS", **modifiers)

    def write(self, text):
        """Types letters, into a text field for instance."""
        for letter in text:
            self._send(letter.upper(), "PRESS", unicode=letter)
            self._send(letter.upper(), "RELEASE")

    def scroll(self, pixels):
        """Two fingers on a trackpad, upwards if pixels > 0."""
        # What a scroll tells is how far it is from the place of the event before.
        self._window.event_simulate("MOUSEMOVE", "NOTHING", x=self.x, y=self.y - pixels)
        self._send("TRACKPADPAN", "NOTHING")


class Xdotool(_Driver):
    """Real X events, made by the program xdotool. The wheel is X's buttons 4 and 5."""

    BUTTONS = {"LEFTMOUSE": 1, "MIDDLEMOUSE": 2, "RIGHTMOUSE": 3}
    KEYS = {"RET": "Return", "ESC": "Escape", "NUMPAD_ENTER": "KP_Enter", "PAGE_UP": "Prior", "PAGE_DOWN": "Next",
            "UP_ARROW": "Up", "DOWN_ARROW": "Down"}

    def __init__(self, window):
        super().__init__()
        self._height = window.height

    def _run(self, *words):
        subprocess.run(["xdotool", *map(str, words)], check=True)

    def _run_held(self, modifiers, *words):
        self._run(*self._each("keydown", modifiers), *words, *self._each("keyup", modifiers))

    @staticmethod
    def _each(command, modifiers):
        return [word for name, is_held in modifiers.items() if is_held for word in (command, name)]

    def move(self, x, y, **_):
        self.x, self.y = x, y
        self._run("mousemove", x, self._height - 1 - y)

    def press(self, button, **modifiers):
        self._run(*self._each("keydown", modifiers), "mousedown", self.BUTTONS[button])

    def release(self, button, **modifiers):
        self._run("mouseup", self.BUTTONS[button], *self._each("keyup", modifiers))

    def key(self, key, **modifiers):
        self._run_held(modifiers, "key", self.KEYS.get(key, key.lower()))

    def wheel(self, notches, **modifiers):
        self._run_held(modifiers, "click", "--repeat", abs(notches), "--delay", 5, 4 if notches > 0 else 5)


DRIVERS = {"simulate": Simulated, "xdotool": Xdotool}
