# SPDX-License-Identifier: GPL-3.0-or-later
"""What is tinted in which colour. Without a graphics card: which triangles would be handed to it."""

import types

import bpy
import numpy as np
from common import BOX, MeshTest, part, read_off
from mathutils import Matrix


class Tints(MeshTest):
    def setUp(self):
        super().setUp()
        self.obj = self.add(*read_off("homer"))
        self.h = part("api").build(self.obj)
        self.overlay = part("view.overlay")
        self.parts = self.overlay.Parts(part("view.seen").seen(self.obj), self.h)
        self.obj.data.calc_loop_triangles()
        self.face_of = {frozenset(each.vertices): each.polygon_index for each in self.obj.data.loop_triangles}

    def tinted(self, *what):
        """{colour: the faces that have it, a list with each as often as it is drawn}"""
        found = {}

        def draw(_context, _obj, layers):
            for _, faces, color, _ in layers:
                found[color] = sorted(found.get(color, []) + faces)

        self.replace(self.overlay, "_draw", draw)
        self.replace(self.parts, "batch", lambda piece: (None, self.faces(self.parts.triangles[slice(*piece)])))
        self.replace(self.parts, "of_faces", lambda _name, faces: (None, sorted(faces.tolist())))
        self.overlay.draw_held(bpy.context, self.obj, self.parts, *what)
        return found

    def replace(self, owner, name, value):
        self.addCleanup(setattr, owner, name, getattr(owner, name))
        setattr(owner, name, value)

    def faces(self, triangles):
        return [self.face_of[frozenset(triangle)] for triangle in triangles.tolist()]

    def test_the_part_and_what_the_next_notch_adds(self):
        for face in (100, 3000):
            stops, _ = self.h.wheel(face)
            for node, larger in zip(stops, stops[1:]):
                inside, whole = (set(self.h.faces(each).tolist()) for each in (node, larger))
                self.assertEqual(self.tinted(node, larger, None), {
                    self.overlay.PART: sorted(inside), self.overlay.NEXT: sorted(whole - inside)})
            self.assertEqual(self.tinted(stops[-1], stops[-1], None), {
                self.overlay.PART: list(range(len(self.h.order)))})

    def test_the_same_with_its_border_in_creases(self):
        stops, start = self.h.wheel(100)
        node, larger = stops[start], stops[start + 1]
        snapped = np.setdiff1d(self.h.faces(larger), self.h.faces(larger)[:5])
        self.assertEqual(self.tinted(node, larger, snapped), {
            self.overlay.PART: sorted(snapped.tolist()), self.overlay.NEXT: sorted(self.h.faces(larger)[:5].tolist())})


class State:
    """gpu.state: what is set, as add-ons drawing before have left it."""

    def __init__(self):
        self.now = {"blend": "ADDITIVE", "depth_test": "GREATER", "depth_mask": True}

    def __getattr__(self, name):
        what, _, way = name.rpartition("_")
        return (lambda: self.now[what]) if way == "get" else (lambda value: self.now.update({what: value}))


class Drawing(MeshTest):
    def test_tints_are_blended_and_the_state_is_given_back(self):
        """The mesh shows through, what lies before it hides them, and who draws next finds all as it was."""
        overlay, state, drawn = part("view.overlay"), State(), []
        self.addCleanup(setattr, overlay, "gpu", overlay.gpu)
        overlay.gpu = types.SimpleNamespace(state=state, types=types.SimpleNamespace(
            Buffer=lambda *what: what, GPUUniformBuf=lambda buffer: buffer))
        shader = types.SimpleNamespace(bind=lambda: None, uniform_block=lambda *_: None)
        batch = types.SimpleNamespace(draw=lambda _shader: drawn.append(dict(state.now)))
        before = dict(state.now)
        view = types.SimpleNamespace(is_perspective=True, view_matrix=Matrix(), perspective_matrix=Matrix(),
                                     use_clip_planes=False)
        overlay._draw(types.SimpleNamespace(region_data=view), self.add(*BOX),
                      [(shader, batch, overlay.PART, 0.0), (shader, batch, overlay.NEXT, 0.0)])
        self.assertEqual(drawn, 2 * [{"blend": "ALPHA", "depth_test": "LESS_EQUAL", "depth_mask": False}])
        self.assertEqual(state.now, before)
