# SPDX-License-Identifier: GPL-3.0-or-later
"""A movement's typed number, and what of the gizmo is under the mouse."""

import math
import random

from common import MeshTest, part
from mathutils import Vector


class Typing(MeshTest):
    def test_a_number_is_typed(self):
        movement = part("deform.movement").Movement("G", Vector(), False)
        for key, typed in (("ONE", "1"), ("PERIOD", "1."), ("NUMPAD_5", "1.5"), ("MINUS", "-1.5"), ("MINUS", "1.5"),
                           ("BACK_SPACE", "1.")):
            self.assertIs(movement.type_key(key), True, key)
            self.assertEqual(movement.typed, typed)
        for key in ("A", "MOUSEMOVE", "RET"):
            self.assertIs(movement.type_key(key), False, key)
        self.assertEqual(movement.typed, "1.")


class Gizmo(MeshTest):
    def test_the_distance_from_a_segment_is_the_least_of_those_from_its_points(self):
        rng = random.Random(5)
        for _ in range(200):
            point, a, b = (Vector((rng.uniform(-3, 3), rng.uniform(-3, 3))) for _ in range(3))
            least = min((point - a.lerp(b, step / 2000)).length for step in range(2001))
            self.assertTrue(math.isclose(part("deform.gizmo")._distance(point, a, b), least, abs_tol=5e-3))
