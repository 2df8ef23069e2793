# SPDX-License-Identifier: GPL-3.0-or-later
"""What placing and swapping share: a part that follows the mouse or the wheel is turned, sunk in, scaled, mirrored."""

import math

import bpy

from ..view import keys
from ..view.in_view import InView
from ..words.say import iface_

CONFIRM, CANCEL = keys.CLICK.events | keys.CONFIRM.events, keys.CANCEL.events
SIZE_STEP, TURN_STEP, DEPTH_STEP = 1.05, math.radians(5), 0.05


class Adjusting(InView):
    """Mixed into an operator that has a scale and whether to mirror as well; _show(context), all as it is now; what
    on_confirm(context) answers; and _changed(event, sign): whether a key that is none of those below changes something,
    which it then does, sign as in keys.TURNS."""

    angle: bpy.props.FloatProperty(
        name="Turn", description="About the border's normal", subtype="ANGLE", default=0, options={"SKIP_SAVE"})
    depth: bpy.props.FloatProperty(
        name="Depth", description="How far it is sunk in, times the radius of its border", default=0,
        options={"SKIP_SAVE"})
    taken = frozenset()  # events that change the size with Ctrl alone

    def _moved(self, context, event):
        """The mouse has."""

    def on_event(self, context, event):
        if event.type in keys.NAVIGATE.events | keys.SYSTEM:
            return {"PASS_THROUGH"}
        if event.type == "MOUSEMOVE":
            self._moved(context, event)
        elif event.value in {"PRESS", "DOUBLE_CLICK"}:
            if event.type in CANCEL:
                return {"CANCELLED"}
            if event.type in CONFIRM:
                return self.on_confirm(context)
            if self._adjusted(event, keys.TURNS.get(event.type, 0)):
                self._show(context)
        return {"RUNNING_MODAL"}

    def _adjusted(self, event, sign):
        if event.type in keys.TURN.events and event.shift:
            self.angle += sign * TURN_STEP
        elif event.type in keys.SIZE.events and (event.ctrl or event.type not in self.taken):
            self.scale *= SIZE_STEP ** sign
        elif event.type in keys.DEPTH.events:
            self.depth -= sign * DEPTH_STEP
        elif event.type in keys.MIRROR.events:
            self.mirror = not self.mirror
        else:
            return self._changed(event, sign)
        return True

    def _adjustments(self):
        return iface_("size {size:.2f}, turn {turn:.0f}°, depth {depth:.2f}").format(
            size=self.scale, turn=math.degrees(self.angle), depth=self.depth)
