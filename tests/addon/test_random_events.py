# SPDX-License-Identifier: GPL-3.0-or-later
"""Random events, undo and redo: after each, what is selected is what a plain model of sets says.

PARTWHEEL_EVENTS=10000 runs that many instead of the few of every day.
"""

import os
import random

import bpy
import numpy as np
from bpy_extras.view3d_utils import location_3d_to_region_2d
from common import package, part, selected
from test_modal import FakeContext, Tool, ToolTest, event, view

EVENTS = int(os.environ.get("PARTWHEEL_EVENTS", 500))
UP, DOWN = ("WHEELUPMOUSE", "PAGE_UP", "NUMPAD_PLUS", "UP_ARROW"), ("WHEELDOWNMOUSE", "PAGE_DOWN", "NUMPAD_MINUS",
                                                                   "DOWN_ARROW")
DIGITS = ("ZERO", "ONE", "TWO", "THREE", "FOUR", "FIVE", "SIX", "SEVEN", "EIGHT", "NINE")
HOWS = ({}, {"extend": True}, {"deselect": True})
DEEP = 25  # undo steps that are gone back at most


class Model:
    """What should be selected, with sets and a list of undo steps. parts(face): (sets growing, the same with snapped
    borders, index of the first)."""

    def __init__(self, parts):
        self.parts, self.selected, self.held = parts, frozenset(), None
        self.steps, self.at = [self.selected], 0

    def click(self, face, how):
        sets, snapped, start = self.parts(face)
        self.held = dict(sets=sets, others=snapped, index=start, how=how, before=self.selected, typed="")
        self._apply()

    def _apply(self):
        faces, before = self.held["sets"][self.held["index"]], self.held["before"]
        self.selected = (before | faces if "extend" in self.held["how"] else
                         before - faces if "deselect" in self.held["how"] else faces)

    def go(self, index, typed=""):
        self.held["index"], self.held["typed"] = max(0, min(index, len(self.held["sets"]) - 1)), typed
        self._apply()

    def turn(self, notches):
        self.go(self.held["index"] + notches)

    def snap(self):
        self.held["sets"], self.held["others"] = self.held["others"], self.held["sets"]
        self._apply()

    def digit(self, digit):
        typed = self.held["typed"] + str(digit)
        if len(typed) > len(str(len(self.held["sets"]))):
            typed = str(digit)
        self.go(int(typed) - 1, typed)

    def erase(self):
        typed = self.held["typed"][:-1]
        self.go(int(typed) - 1 if typed else self.held["index"], typed)

    def cancel(self):
        self.selected, self.held = self.held["before"], None

    def confirm(self):
        self.held = None
        self.step()

    def step(self):
        self.steps[self.at + 1:] = [self.selected]
        self.at += 1

    def undo(self, by):
        self.at += by
        self.selected = self.steps[self.at]


class RandomEvents(ToolTest):
    def test_nothing_diverges(self):
        self.start()
        self.send("ESC")
        bpy.context.preferences.edit.undo_steps = 256
        # Of the two ways to deselect, both are to be met, though the mesh is small.
        self.addCleanup(setattr, part("mesh.selection"), "DESELECT_ALL_COST", part("mesh.selection").DESELECT_ALL_COST)
        part("mesh.selection").DESELECT_ALL_COST = 100
        self.spots = self.find_spots(12)
        bpy.ops.ed.undo_push(message="start")
        stops = {face: self.h.wheel(face) for _, face in self.spots}
        creases, every = package().Creases(*part("mesh.arrays").read_surface(self.obj.data)), np.arange(2390)
        sets = {node: self.h.faces(node) for path, _ in stops.values() for node in path.tolist()}
        snapped = {node: np.flatnonzero(creases.snap(np.isin(every, faces))) for node, faces in sets.items()}
        self.model = Model(lambda face: (*([frozenset(choices[node].tolist()) for node in stops[face][0].tolist()]
                                           for choices in (sets, snapped)), stops[face][1]))
        self.name, self.random = self.obj.name, random.Random(2008)
        counts = {}
        for number in range(EVENTS):
            action = self.random.choice(self.actions())
            counts[action.__name__] = counts.get(action.__name__, 0) + 1
            what = action()
            self.obj = bpy.data.objects[self.name]  # undo has made it anew
            self.assertEqual(selected(self.obj), self.model.selected, f"after event {number}: {action.__name__} {what}")
        print(f"{EVENTS} random events: {counts}")
        self.assertGreater(min(counts.get(name, 0) for name in ("click", "turn", "digit", "confirm", "cancel", "undo",
                                                                "redo", "next_click", "drag", "snap")), 0)

    def find_spots(self, count):
        """[(pixel, face)] that are safe to click."""
        _, _, region, region_view = view()
        tree, clicks = part("view.picking").FaceRayCaster(self.obj), []
        for polygon in random.Random(7).sample(list(self.obj.data.polygons), 800):
            pixel = location_3d_to_region_2d(region, region_view, self.obj.matrix_world @ polygon.center)
            pixel = [int(value) for value in pixel]
            hit = tree.cast(self.obj.matrix_world, region, region_view, pixel)
            if hit and hit[0] == polygon.index:
                clicks.append((pixel, polygon.index))
        self.assertGreaterEqual(len(clicks), count)
        return clicks[:count]

    def actions(self):
        if self.model.held:
            own = [self.next_click] if self.tool.tool else [self.digit, self.digit, self.erase]
            return [self.turn] * 6 + own + [self.drag, self.confirm, self.cancel, self.other_key, self.snap]
        can = [self.click] * 3 + [self.click_outside]
        if self.model.at > max(0, len(self.model.steps) - DEEP):
            can += [self.undo]
        if self.model.at + 1 < len(self.model.steps):
            can += [self.redo]
        return can

    def begin(self, point, how, tool=True):
        """With the toolbar's tool or without it, where digits are Blender's."""
        self.tool, self.context = Tool(tool=tool, **how), FakeContext()
        return self.tool.invoke(self.context, event("LEFTMOUSE", point))

    def finish(self, answer, expected):
        """Blender makes the undo step of an operator that has finished."""
        self.assertEqual(answer, expected)
        if "FINISHED" in answer:
            bpy.ops.ed.undo_push(message="Select Part")

    def click(self):
        (point, face), how = self.random.choice(self.spots), self.random.choice(HOWS)
        self.assertEqual(self.begin(point, how, self.random.random() < 0.5), {"RUNNING_MODAL"})
        self.send("LEFTMOUSE", point, "RELEASE")
        self.at = point
        self.model.click(face, how)
        return face, how

    def click_outside(self):
        answer = self.begin((1, 1), {})
        self.finish(answer, {"FINISHED"} if self.model.selected else {"CANCELLED"})
        if self.model.selected:
            self.model.selected = frozenset()
            self.model.step()

    def turn(self):
        notches = self.random.choice((1, 1, 1, -1, -1, 3))
        key = self.random.choice(UP if notches > 0 else DOWN)
        for _ in range(abs(notches)):
            self.send(key, self.at)  # the wheel is the tool's there alone
            self.model.turn(1 if notches > 0 else -1)
        return key, notches

    def digit(self):
        digit = self.random.randrange(10)
        self.send(DIGITS[digit])
        self.model.digit(digit)
        return digit

    def snap(self):
        self.send("E", shift=True, ctrl=True)
        self.model.snap()

    def erase(self):
        self.send("BACK_SPACE")
        self.model.erase()

    def drag(self):
        """With the button still down: only right after a click."""
        self.send("RET")
        bpy.ops.ed.undo_push(message="Select Part")
        self.model.confirm()
        (x, y), face = self.random.choice(self.spots)
        self.begin((x, y), {})
        self.at = (x, y)
        self.model.click(face, {})
        start = self.model.held["index"]
        for _ in range(3):
            notches = self.random.randrange(-6, 7)
            self.send("MOUSEMOVE", (x, y + notches * part("view.keys").DRAG_STEP), "NOTHING")
            self.model.go(start + notches)
        self.send("LEFTMOUSE", (x, y), "RELEASE")

    def confirm(self):
        self.finish(self.send(self.random.choice(("RET", "NUMPAD_ENTER"))), {"FINISHED"})
        self.model.confirm()

    def cancel(self):
        self.finish(self.send(self.random.choice(("ESC", "RIGHTMOUSE"))), {"CANCELLED"})
        self.model.cancel()

    def next_click(self):
        self.finish(self.send("LEFTMOUSE", self.random.choice(self.spots)[0]), {"FINISHED", "PASS_THROUGH"})
        self.model.confirm()
        return self.click()

    def other_key(self):
        self.finish(self.send(self.random.choice(("TAB", "A", "E", "X"))), {"FINISHED", "PASS_THROUGH"})
        self.model.confirm()

    def undo(self):
        bpy.ops.ed.undo()
        self.model.undo(-1)

    def redo(self):
        bpy.ops.ed.redo()
        self.model.undo(1)
