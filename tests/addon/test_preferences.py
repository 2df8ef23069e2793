# SPDX-License-Identifier: GPL-3.0-or-later
"""What the preferences of builds do, on the worker's side: a program in its place reports what it receives."""

import tempfile
from pathlib import Path

import bpy
import common
from common import BOX, MeshTest, package, part

# Reads all input of the worker, and writes the answer below.
PREAMBLE = """
import json, os, struct, sys, time
message = struct.Struct("<cQ")
header = json.loads(sys.stdin.buffer.read(message.unpack(sys.stdin.buffer.read(message.size))[1]))
sys.stdin.buffer.read(sum(header["sizes"]))
def answer(kind, value):
    text = json.dumps(value).encode()
    sys.stdout.buffer.write(message.pack(kind, len(text)) + text)
    sys.stdout.buffer.flush()
"""
REFUSES = PREAMBLE + "answer(b'E', {'status': 13, 'message': ''})"
WORKS = PREAMBLE + "answer(b'P', [0.5, 'cluster', 1, 1e6])\nos.read(0, 1)"  # says that it has worked for days; to the end


class Preferences(MeshTest):
    def setUp(self):
        super().setUp()
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.directory = Path(directory.name)
        self.preferences = bpy.context.preferences.addons[common.MODULE].preferences
        self.add(*BOX)

    def set(self, name, value):
        self.addCleanup(setattr, self.preferences, name, getattr(self.preferences, name))
        setattr(self.preferences, name, value)

    def worker(self, program):
        """From now on workers run this."""
        entry = self.directory / "entry.py"
        entry.write_text(program)
        self.addCleanup(setattr, package("worker.job"), "ENTRY", package("worker.job").ENTRY)
        package("worker.job").ENTRY = entry

    def refusal(self):
        with self.assertRaises(RuntimeError) as refused:
            bpy.ops.mesh.partwheel_build()
        return str(refused.exception)

    def test_memory_is_a_share_of_what_is_available(self):
        self.addCleanup(setattr, part("parts.builds"), "available_memory", part("parts.builds").available_memory)
        part("parts.builds").available_memory = lambda: 10 * 2**30
        self.worker(REFUSES)
        self.assertIn("It may use 8.0 GiB", self.refusal())
        for share in (25, 100):
            self.set("memory_share", share)
            self.assertIn(f"It may use {share / 10:.1f} GiB", self.refusal())

    def test_the_time_limit_is_in_minutes(self):
        self.worker(WORKS)
        self.assertIn("after 120.024 seconds of work", self.refusal())  # two, and 2 ms for each of 12 triangles
        for minutes in (1, 7):
            self.set("cpu_limit", minutes)
            self.assertIn(f"after {60 * minutes} seconds of work", self.refusal())
