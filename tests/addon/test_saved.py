# SPDX-License-Identifier: GPL-3.0-or-later
"""Hierarchies in .blend files: there again after opening, linking and appending; refused when not wholly sound."""

import contextlib
import io
import os
import random
import tempfile
from pathlib import Path

import bpy
import common
from common import BOX, MeshTest, only_in, package, part, read_off, snapshot

FORMATS = Path(__file__).resolve().parents[1] / "core" / "saved"


class Saved(MeshTest):
    def setUp(self):
        super().setUp()
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.path = str(Path(directory.name) / "saved.blend")
        self.State = part("parts.registry").State

    def state(self, obj):
        return part("parts.registry").get_state(obj.data)[0]

    def stored_hierarchy(self, obj):
        return part("parts.registry").get_hierarchy(snapshot(obj))

    def built(self, name="hand"):
        obj = self.add(*(BOX if name == "box" else read_off(name)))
        self.assertEqual(bpy.ops.mesh.partwheel_build(), {"FINISHED"})
        return obj

    def save(self):
        bpy.ops.wm.save_as_mainfile(filepath=self.path)

    def open(self):
        bpy.ops.wm.open_mainfile(filepath=self.path)
        obj = bpy.data.objects["model"]
        bpy.context.view_layer.objects.active = obj
        return obj

    def properties(self):
        return [mesh.name for mesh in bpy.data.meshes if part("parts.stored").PROPERTY in mesh]

    def test_saved_parts_load_with_the_file(self):
        obj = self.built()
        saved = self.stored_hierarchy(obj).save()
        self.save()
        self.assertEqual(self.properties(), [])
        obj = self.open()
        self.assertEqual(self.properties(), [])
        self.assertEqual(self.state(obj), self.State.UNOPENED)
        self.assertEqual(self.stored_hierarchy(obj).save(), saved)
        self.assertEqual(self.state(obj), self.State.FITS)
        self.assertEqual(saved, self.hierarchy(obj).save())

    def test_saved_in_edit_mode_and_again_unopened(self):
        obj = self.built()
        saved = self.stored_hierarchy(obj).save()
        self.edit(obj)
        self.save()
        self.assertEqual(obj.mode, "EDIT")
        self.open()
        self.save()
        obj = self.open()
        self.assertEqual(self.stored_hierarchy(obj).save(), saved)

    def test_the_preference_disables_saving_parts(self):
        preferences = bpy.context.preferences.addons[common.MODULE].preferences
        self.built()
        self.save()
        with_it = os.path.getsize(self.path)
        preferences.save_with_file = False
        self.addCleanup(setattr, preferences, "save_with_file", True)
        self.save()
        self.assertLess(os.path.getsize(self.path), with_it - 50_000)
        self.assertEqual(self.state(self.open()), self.State.NONE)

    def test_undo_after_saving_does_not_bring_bytes_back(self):
        self.built()
        bpy.ops.ed.undo_push(message="built")
        self.save()
        bpy.context.object.location.x += 1
        bpy.ops.ed.undo_push(message="moved")
        bpy.ops.ed.undo()
        self.assertEqual(self.properties(), [])

    # ---- Linked and appended

    def bring(self, link):
        """The saved object, linked or appended to a new file."""
        bpy.ops.wm.read_homefile()
        MeshTest.setUp(self)
        with bpy.data.libraries.load(self.path, link=link) as (there, here):
            here.objects = there.objects
        return self.link(bpy.data.objects["model"])

    def test_parts_of_appended_meshes_load(self):
        saved = self.stored_hierarchy(self.built()).save()
        self.save()
        obj = self.bring(link=False)
        self.assertEqual(self.state(obj), self.State.UNOPENED)
        self.assertEqual(self.stored_hierarchy(obj).save(), saved)
        self.assertEqual(self.properties(), [])

    def test_parts_of_linked_meshes_load(self):
        saved = self.stored_hierarchy(self.built()).save()
        self.save()
        obj = self.bring(link=True)
        self.assertIsNotNone(obj.data.library)
        self.assertEqual(self.stored_hierarchy(obj).save(), saved)
        self.assertEqual(bpy.ops.mesh.partwheel_build(), {"FINISHED"})  # and a new one may be built
        self.assertEqual(self.stored_hierarchy(obj).save(), saved)

    # ---- Another file

    # ---- Bytes that are not sound

    def after_tampering(self, change):
        """The hierarchy after opening a file whose bytes were changed, which must be said on the console; for
        other versions see test_trouble.py."""
        obj = self.built("cross_quad")
        stored = part("parts.stored")
        packed = stored.pack(part("mesh.arrays").compute_fingerprint(obj.data), self.stored_hierarchy(obj))
        self.assertEqual(len(stored.unpack(packed)[1].order), len(obj.data.polygons))
        part("parts.registry").forget(obj.data)
        changed = change(packed)
        obj.data[stored.PROPERTY] = changed
        ours = isinstance(changed, bytes) and changed.startswith(stored.MAGIC)
        other_version = ours and changed[8:12] != packed[8:12]
        output = io.StringIO()
        with contextlib.redirect_stdout(output):
            actual = self.stored_hierarchy(obj)
        self.assertEqual(actual is None and not other_version, "are ignored" in output.getvalue())
        if actual is None:
            self.assertEqual(bpy.ops.mesh.partwheel_build(), {"FINISHED"})
            self.assertEqual(len(self.stored_hierarchy(obj).order), len(obj.data.polygons))
        MeshTest.setUp(self)
        return actual

    @only_in("newest")
    def test_tampered_bytes_are_refused(self):
        draw = random.Random(3)
        stored = part("parts.stored")

        def flipped(packed):
            place = draw.randrange(len(packed))
            return packed[:place] + bytes([packed[place] ^ 1 << draw.randrange(8)]) + packed[place + 1:]

        def forged(packed, topology=None, saved=None):
            """With a right hash over a wrong header, or another saved hierarchy."""
            start = stored.HEADER.size + stored.HASH_SIZE
            head = list(stored.HEADER.unpack_from(packed))
            header = stored.HEADER.pack(*head[:2], topology or head[2], head[3])
            return header + stored._hash(header) + (packed[start:] if saved is None else saved)

        box = package().Hierarchy.build(BOX[0], [t for a, b, c, d in BOX[1] for t in ((a, b, c), (a, c, d))])
        self.assertIsNotNone(self.after_tampering(forged))  # forging alone changes nothing
        for change in (*[flipped] * 20, lambda p: b"", lambda p: p[:30], lambda p: p[:-1], lambda p: p + b"0",
                       lambda p: p[:-4000], lambda p: "text", lambda p: 7, lambda p: [1.5, 2.5], lambda p: {"a": b"b"},
                       lambda p: p[:8] + b"\1\0\0\0" + p[12:], lambda p: forged(p, topology=bytes(16)),
                       lambda p: forged(p, saved=b""), lambda p: forged(p, saved=box.save()),
                       lambda p: forged(p, saved=bytes(10**7))):
            self.assertIsNone(self.after_tampering(change))

    def test_saves_of_other_formats(self):
        """Files of newer versions are recognized by the library's number of the format, also if nothing else has changed; of the
        older ones, those that the library reads load."""
        stored, format_now = part("parts.stored"), package("library").saved_format()

        def packed(saved, version):
            header = stored.HEADER.pack(stored.MAGIC, version, bytes(16), bytes(16))
            return header + stored._hash(header) + saved

        old = {name: (FORMATS / f"{name}-tripod.partwheel").read_bytes() for name in ("4", "5", str(format_now))}
        self.assertEqual(stored.pack((bytes(16), bytes(16)), package().Hierarchy.load(old["5"]))[8:12],
                         format_now.to_bytes(4, "little"))
        for version in (2, 5):  # 2: before the header had the library's number
            self.assertEqual(len(stored.unpack(packed(old["5"], version))[1].order), 44)
        with self.assertRaises(stored.OlderVersion):
            stored.unpack(packed(old["4"], 4))
        newer = old[str(format_now)][:8] + (format_now + 1).to_bytes(4, "little") + old[str(format_now)][12:]
        with self.assertRaises(stored.NewerVersion):
            stored.unpack(packed(newer, format_now + 1))

    # ---- Bytes that are sound, but of another mesh

    def is_accepted(self, obj, hierarchy, moved=False):
        """Whether the hierarchy is accepted for the object's mesh when a file says it is its own; moved: a vertex has
        been moved since."""
        stored = part("parts.stored")
        part("parts.registry").forget_all()
        obj.data[stored.PROPERTY] = stored.pack(part("mesh.arrays").compute_fingerprint(obj.data), hierarchy)
        place = obj.data.vertices[0].co.copy()
        if moved:
            obj.data.vertices[0].co.x += 0.01
        output = io.StringIO()
        with contextlib.redirect_stdout(output):
            actual = self.stored_hierarchy(obj)
        obj.data.vertices[0].co = place
        self.assertEqual(actual is None, "they belong to another mesh" in output.getvalue())
        return actual is not None

    def test_saved_parts_of_every_fill_method_load(self):
        for name, fill_method in (("cross_quad", "exact"), ("blob", "repaired"), ("cow", "points")):
            MeshTest.setUp(self)
            obj = self.add(*read_off(name))
            hierarchy = self.hierarchy(obj)
            self.assertEqual(hierarchy.summary.fill_method, fill_method)
            self.assertTrue(self.is_accepted(obj, hierarchy))
            self.assertTrue(self.is_accepted(obj, hierarchy, moved=True))

    def mismatched_meshes(self, vertices, polygons):
        """Meshes like this one of which a hierarchy does not fit it: (name, vertices, polygons)."""
        count = len(vertices)
        yield "a vertex too many", [(0, 0, 0)] * 5000 + vertices, [[v + 5000 for v in polygon] for polygon in polygons]
        yield "vertices in another order", vertices[-7:] + vertices[:-7], [[(v + 7) % count for v in polygon]
                                                                           for polygon in polygons]
        yield "faces in another order", vertices, polygons[7:] + polygons[:7]
        yield "a face too few", vertices, polygons[:-1]

    def test_saved_parts_of_another_mesh_are_refused(self):
        """The vertex numbers of a hand with 5,000 vertices before its own went up to 6,196 for 1,197."""
        for name in ("hand", "cross_quad", "blob"):
            vertices, polygons = read_off(name)
            for what, *other in self.mismatched_meshes(vertices, polygons):
                with self.subTest(f"{name}, {what}"):
                    MeshTest.setUp(self)
                    strange = self.hierarchy(self.add(*other, "other"))
                    obj = self.add(vertices, polygons)
                    self.assertFalse(self.is_accepted(obj, strange))
                    if strange.summary.fill_method == "exact":  # else only places tell which face is which
                        self.assertFalse(self.is_accepted(obj, strange, moved=True))
