# SPDX-License-Identifier: GPL-3.0-or-later
"""The states of the modal tool."""

import dataclasses
import importlib.util
import sys

import pytest
from conftest import ROOT

# The one file of the add-on that needs neither Blender nor the add-on's other files.
spec = importlib.util.spec_from_file_location("states", ROOT / "addon" / "partwheel" / "pick" / "states.py")
states = sys.modules[spec.name] = importlib.util.module_from_spec(spec)
spec.loader.exec_module(states)


def test_notches_walk_the_stops_and_hold_at_both_ends(build_shape):
    _, h = build_shape("hand.off")
    stops, start = h.wheel(100)
    state = states.pick_face(h, 100)
    assert (state.face, state.level, state.node) == (100, 0, stops[start])
    assert state.turn(1).turn(-1) == state
    assert state.turn(1).node == stops[start + 1] and state.turn(1).level == 1
    assert state.turn(10**6).node == len(h.parent) - 1
    assert state.turn(-(10**6)).node == stops[0]
    assert states.pick_face(h, 100, 2) == state.turn(2)
    with pytest.raises(dataclasses.FrozenInstanceError):
        state.index = 0


def test_groups_of_objects_follow_the_root(build_shape):
    _, h = build_shape("hand.off")
    root = states.pick_face(h, 100, 10**6)
    assert (root.needs_groups, root.turn(-1).needs_groups, root.turn(1)) == (True, False, root)
    groups = frozenset("ab"), frozenset("abc")
    state = root.with_groups(groups)
    assert (state.node, state.group, state.next_group, state.needs_groups) == (root.node, frozenset(), groups[0], False)
    assert [state.turn(notches).group for notches in (1, 2, 3)] == [*groups, groups[1]]
    assert state.turn(2).node == root.node and state.turn(2).level == root.level + 2
    assert state.turn(2).turn(-2) == state and state.turn(2).turn(-3).node == root.stops[-2]
    assert state.count == root.count + 2
    typed = root
    for digit in str(root.count + 1):
        typed = typed.with_digit(digit)
    assert typed.at_stop(root.index, typed.typed).with_groups(groups).group == groups[0]
