# SPDX-License-Identifier: GPL-3.0-or-later
"""What placing and swapping share: keys that turn, sink, scale and mirror a part that follows mouse or wheel."""

import math

import bpy

from ..view import keys
from ..view.in_view import InView
from ..translations.lookup import iface_

CONFIRM, CANCEL = keys.CLICK.events | keys.CONFIRM.events, keys.CANCEL.events
SIZE_STEP = 1.05  # factor per notch
TURN_STEP = math.radians(5)
DEPTH_STEP = 0.05  # radii of the border


class Adjusting(InView):
    """Mixin for modal operators that have the properties scale and mirror.

    They define _show(context), which shows the current state; on_confirm(context), which returns the result of the
    operator; and _on_other_key(event, sign), which handles keys not listed here and returns whether it changed
    anything. sign: as in keys.WHEEL_STEPS."""

    angle: bpy.props.FloatProperty(
        name="Turn", description="About the border's normal", subtype="ANGLE", options={"SKIP_SAVE"})
    depth: bpy.props.FloatProperty(
        name="Depth", description="How deep the part sinks in, in radii of its border", options={"SKIP_SAVE"})
    ctrl_size_events = frozenset()  # events that change the size only with Ctrl

    def _on_mouse_move(self, context: bpy.types.Context, event: bpy.types.Event) -> None:
        """Handles a mouse move; does nothing by default."""

    def on_event(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type in keys.NAVIGATE.events | keys.SYSTEM:
            return {"PASS_THROUGH"}
        if event.type == "MOUSEMOVE":
            self._on_mouse_move(context, event)
        elif event.value in {"PRESS", "DOUBLE_CLICK"}:
            if event.type in CANCEL:
                return {"CANCELLED"}
            if event.type in CONFIRM:
                return self.on_confirm(context)
            if self._adjust(event, keys.WHEEL_STEPS.get(event.type, 0)):
                self._show(context)
        return {"RUNNING_MODAL"}

    def _adjust(self, event: bpy.types.Event, sign: int) -> bool:
        """Applies a key. Returns whether it changed anything."""
        if event.type in keys.TURN.events and event.shift:
            self.angle += sign * TURN_STEP
        elif event.type in keys.SIZE.events and (event.ctrl or event.type not in self.ctrl_size_events):
            self.scale *= SIZE_STEP ** sign
        elif event.type in keys.DEPTH.events:
            self.depth -= sign * DEPTH_STEP
        elif event.type in keys.MIRROR.events:
            self.mirror = not self.mirror
        else:
            return self._on_other_key(event, sign)
        return True

    def _adjustment_text(self) -> str:
        """Size, turn and depth, for the status bar."""
        return iface_("size {size:.2f}, turn {turn:.0f}°, depth {depth:.2f}").format(
            size=self.scale, turn=math.degrees(self.angle), depth=self.depth)
