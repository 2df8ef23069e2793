# SPDX-License-Identifier: GPL-3.0-or-later
"""What objects made from parts have of the object that they were made from: all that Blender's RNA knows, as Blender's own
Separate keeps it; and nothing is left behind where it can't be made."""

import contextlib
import inspect
import math
import sys
import tempfile
from pathlib import Path

import bmesh
import bpy
import common
import numpy
from common import BOX, only_in, part, read_off
from mathutils import Vector
from mathutils.kdtree import KDTree
from solid_case import SolidTest, arrays, caps


# What is never the same: what makes it another data-block; of a mesh, what its other size makes of it.
OWN = {"Object": {"name", "data", "dimensions", "matrix_local", "matrix_world", "matrix_basis", "use_fake_user", "use_extra_user",
                  "tag", "asset_data"},
       "Mesh": {"name", "use_fake_user", "use_extra_user", "tag", "asset_data", "uv_layer_clone", "uv_layer_stencil",
                "uv_layer_clone_index", "uv_layer_stencil_index"}}  # see chosen_layers()
# Of Parts to Objects, but for the root: each hangs on another part, and turns about its border.
CHAINED = {"parent", "parent_type", "parent_bone", "matrix_parent_inverse", "location", "rotation_quaternion", "rotation_euler",
           "rotation_axis_angle", "scale"}
# Pointers that are no settings of their owner's.
NOT_SETTINGS = {"rna_type", "original", "library", "library_weak_reference", "override_library", "preview", "animation_data", "pose",
                "active_shape_key", "motion_path", "point_cache", "image_user", "falloff_curve", "custom_profile", "profile"}
SHIFTED = "mesh texspace_location"  # with the origin
# What would change more than itself, or hide the object from its tests.
NOT_SET = {"parent_vertices", "parent", "parent_type", "parent_bone", "active_material", "active_material_index", "hide_viewport",
           "active_shape_key_index", "show_only_shape_key", "use_shape_key_edit_mode", "instance_type", "auto_texspace",
           "rotation_mode", "scale", "delta_scale", "is_runtime_data", "track_axis", "up_axis"}


def writable(struct):
    return [prop for prop in struct.bl_rna.properties
            if not prop.is_readonly and prop.identifier not in OWN.get(struct.bl_rna.identifier, ())]


def value(struct, name):
    current = getattr(struct, name)
    if isinstance(current, bpy.types.bpy_struct):
        return current.name if hasattr(current, "name") else str(current)
    return current if isinstance(current, (str, set, int, float)) or current is None else numpy.array(current).ravel().tolist()


def values(struct):
    return {prop.identifier: value(struct, prop.identifier) for prop in writable(struct) if prop.type != "COLLECTION"}


def set_all(struct):
    """Gives each property another value than its default, as far as Blender lets it: how many it has given."""
    count = 0
    for prop in writable(struct):
        name, before = prop.identifier, value(struct, prop.identifier)
        if prop.type in {"POINTER", "COLLECTION"} or name in NOT_SET or struct.is_property_readonly(name):
            continue
        with contextlib.suppress(TypeError, ValueError, AttributeError, RuntimeError):
            if prop.type == "BOOLEAN":
                setattr(struct, name, [not one for one in before] if prop.is_array else not before)
            elif prop.type in {"INT", "FLOAT"}:
                step = 0.125 if prop.type == "FLOAT" else 1
                other = lambda one: one + step if one + step <= prop.hard_max else one - step
                setattr(struct, name, [other(one) for one in before] if prop.is_array else other(before))
            elif prop.type == "ENUM" and not prop.is_enum_flag:
                setattr(struct, name, next(item.identifier for item in prop.enum_items if item.identifier != before))
        count += value(struct, name) != before
    return count


def substructs(struct, path=""):
    """{path: struct} of the settings that it holds beside its own properties, however deep: of physics, of display, ..."""
    found = {}
    for prop in struct.bl_rna.properties:
        inner = getattr(struct, prop.identifier, None) if prop.type == "POINTER" and prop.is_readonly else None
        if inner is None or isinstance(inner, bpy.types.ID) or prop.identifier in NOT_SETTINGS:
            continue
        found[f"{path}{prop.identifier}"] = inner
        found |= substructs(inner, f"{path}{prop.identifier}.")
    return found


def all_values(struct):
    """The values of a data-block and of its substructs."""
    found = values(struct)
    for path, inner in substructs(struct).items():
        found |= {f"{path}.{name}": entry for name, entry in values(inner).items()}
    return found


def set_everything(struct):
    """set_all() of a data-block and its substructs, and of each reference to a data-block that it has not: how many."""
    count = 0
    for inner in (struct, *substructs(struct).values()):
        count += set_all(inner)
        for prop in writable(inner):
            kind = getattr(prop, "fixed_type", None)
            if prop.type != "POINTER" or prop.identifier in NOT_SET or getattr(inner, prop.identifier) is not None:
                continue
            with contextlib.suppress(TypeError, ValueError, AttributeError, RuntimeError):
                blocks_of_kind = {"Object": bpy.data.objects, "Mesh": bpy.data.meshes, "Collection": bpy.data.collections}
                if kind.identifier in blocks_of_kind:
                    arguments = (None,) if kind.identifier == "Object" else ()
                    setattr(inner, prop.identifier, blocks_of_kind[kind.identifier].new(f"of {prop.identifier}", *arguments))
                    count += getattr(inner, prop.identifier) is not None
    return count


def custom(struct):
    """Its custom properties."""
    return {key: next((getattr(stored, convert)() for convert in ("to_list", "to_dict") if hasattr(stored, convert)), stored)
            for key, stored in struct.items()}


def animation(block):
    """Of a data-block: what moves it."""
    data = block.animation_data
    if not data:
        return None
    tracks = [(track.name, track.mute, [(strip.name, strip.frame_start, strip.frame_end, strip.influence)
                                        for strip in track.strips]) for track in data.nla_tracks]
    return (curves(data), data.action_influence, data.action_blend_type, tracks,
            [(curve.data_path, curve.array_index, curve.driver.type, curve.driver.expression,
              [(variable.name, variable.type, [target.data_path for target in variable.targets])
               for variable in curve.driver.variables]) for curve in data.drivers])


def curves(data):
    if not data.action:
        return None
    action = data.action
    if not getattr(data, "action_slot", None):
        curves = action.fcurves
    else:
        curves = action.layers[0].strips[0].channelbag(data.action_slot).fcurves
    return [(curve.data_path, curve.array_index, [tuple(point.co) for point in curve.keyframe_points]) for curve in curves]


def chosen_layers(mesh):
    """The names of those that Blender uses for something."""
    chosen_layers = mesh.uv_layers.active, mesh.uv_layer_clone, mesh.uv_layer_stencil
    colors = mesh.color_attributes
    return [each and each.name for each in (*chosen_layers, *(layer for layer in mesh.uv_layers if layer.active_render),
                                            *(colors[index] for index in (colors.active_color_index, colors.render_color_index)
                                              if len(colors)))]


def object_data(obj):
    """All that an object has beside its mesh's geometry, to be compared."""
    mesh = obj.data
    data = {f"object {name}": entry for name, entry in all_values(obj).items()}
    data |= {f"mesh {name}": entry for name, entry in all_values(mesh).items()}
    data |= {"custom": custom(obj), "custom of the mesh": custom(mesh), "animation": animation(obj),
              "animation of the mesh": animation(mesh),
              "constraints": [(constraint.type, all_values(constraint)) for constraint in obj.constraints],
              "modifiers": [(modifier.type, all_values(modifier), custom(modifier) if modifier.type == "NODES" else None) for modifier in obj.modifiers],
              "particles": [(system.name, system.settings.name, all_values(system)) for system in obj.particle_systems],
              "slots": [(slot.link, slot.material and slot.material.name) for slot in obj.material_slots],
              "groups": [(group.name, group.lock_weight) for group in obj.vertex_groups],
              "layers": chosen_layers(mesh), "rigid body": obj.rigid_body and values(obj.rigid_body)}
    keys = mesh.shape_keys
    if keys:
        names = [each for each in values(keys.key_blocks[0]) if each not in {"frame"}]
        data |= {"shape keys": [[value(key, name) for name in names] for key in keys.key_blocks],
                  "all shape keys": {name: entry for name, entry in values(keys).items() if name not in OWN["Mesh"]},
                  "animation of the keys": animation(keys)}
    return data


def differences(before, new, objects):
    """{name: (before, now)} of what a new object has otherwise; objects: those that were created with it."""
    but = {f"object {name}" for name in CHAINED} | {SHIFTED} if new.parent in objects else set()
    but |= {"mesh texspace_location", "mesh texspace_size"} if new.data.use_auto_texspace else set()  # of the bounding box
    now = object_data(new)
    for state in (before, now):
        state["custom of the mesh"] = {key: entry for key, entry in state["custom of the mesh"].items()
                                       if not key.startswith("partwheel")}
    return {name: (before[name], now.get(name)) for name in before if before[name] != now.get(name) and name not in but}


def evaluated(obj):
    """(n,3) where its vertices are seen, in the world."""
    bpy.context.view_layer.update()
    shown = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = shown.to_mesh()
    positions = numpy.array([shown.matrix_world @ vertex.co for vertex in mesh.vertices])
    shown.to_mesh_clear()
    return positions


def own_vertices(mesh):
    """(V,) bool: those that have another face than caps."""
    own = numpy.zeros(len(mesh.vertices), bool)
    of_caps = caps(mesh) if "partwheel_cap" in mesh.attributes else numpy.zeros(len(mesh.polygons), bool)
    for polygon in mesh.polygons:
        if not of_caps[polygon.index]:
            own[list(polygon.vertices)] = True
    return own


def blocks():
    """All data-blocks, by kind."""
    return {name: {block.name_full for block in getattr(bpy.data, name)} for name in dir(bpy.data)
            if isinstance(getattr(bpy.data, name), bpy.types.bpy_prop_collection)}


def arrays_of(obj):
    return arrays(obj.data)[1], arrays(obj.data)[0].tolist()


class Fault(RuntimeError):
    """What nothing in the add-on knows."""


class FailAt:
    """While it is entered, the call of a function of the add-on's with this number fails, counted from where an operator has
    the parts. raised: its name."""

    def __init__(self, number):
        self.number, self.count, self.raised, self.has_parts = number, -1, None, False

    def __enter__(self):
        self.root = str(Path(sys.modules[common.MODULE].__file__).parent)
        self.handlers = {getattr(each, "__code__", None) for name in dir(bpy.app.handlers)
                         for each in [getattr(bpy.app.handlers, name)] if isinstance(each, list) for each in each}
        sys.setprofile(self._called)
        return self

    def __exit__(self, *_):
        sys.setprofile(None)

    def _called(self, frame, what, _):
        code = frame.f_code
        if what != "call" or not code.co_filename.startswith(self.root) or code.co_filename.endswith("datablocks.py"):
            return
        self.has_parts |= code.co_name in {"_steps", "_write", "_run_in_object_mode", "unite", "place"}
        if not self.has_parts:
            return
        if code.co_flags & inspect.CO_GENERATOR or code.co_name.startswith("<"):
            return  # where it goes on, it would fail before its own "finally"
        caller = frame
        while caller and caller.f_code not in self.handlers:
            caller = caller.f_back
        if caller:
            return  # Blender goes on where a handler fails
        self.count += 1
        if self.count == self.number:
            self.raised = code.co_name
            raise Fault(f"Fault in {code.co_name}")


class ObjectData(SolidTest):
    def setUp(self):
        super().setUp()
        for data in (bpy.data.collections, bpy.data.actions, bpy.data.armatures):
            for item in list(data):
                if item != bpy.context.collection:
                    data.remove(item)

    def armature(self):
        """With a bone from the origin up."""
        rig = bpy.data.objects.new("rig", bpy.data.armatures.new("rig"))
        self.link(rig)
        bpy.ops.object.mode_set(mode="EDIT")
        bone = rig.data.edit_bones.new("bone")
        bone.head, bone.tail = (0, 0, 0), (0, 0, 1)
        bpy.ops.object.mode_set(mode="OBJECT")
        return rig

    def keyed(self, obj):
        """Shape keys, one of which was removed in between; a driver, which asks the object itself, and an action for them."""
        for name in ("Basis", "gone", "wide", "tall"):
            obj.shape_key_add(name=name, from_mix=False)
        keys = obj.data.shape_keys
        obj.shape_key_remove(keys.key_blocks["gone"])
        for vertex, wide, tall in zip(obj.data.vertices, keys.key_blocks["wide"].data, keys.key_blocks["tall"].data):
            wide.co = vertex.co * 1.5
            tall.co = vertex.co + Vector((0, 0, vertex.co.z))
        wide, tall = keys.key_blocks["wide"], keys.key_blocks["tall"]
        wide.slider_min, wide.slider_max, wide.value, wide.mute = -2, 3, -0.5, False
        tall.relative_key = wide
        wide.keyframe_insert("value", frame=1)
        curve = tall.driver_add("value")
        variable = curve.driver.variables.new()
        variable.name, variable.targets[0].id, variable.targets[0].data_path = "by", obj, '["by"]'
        curve.driver.expression = "by * 0.25"
        track = keys.animation_data.nla_tracks.new()
        action = bpy.data.actions.new("strip")
        if hasattr(action, "slots"):
            action.slots.new("KEY", "strip")
        strip = track.strips.new("strip", 5, action)
        strip.influence, track.mute = 0.5, True

    def rich(self, name="dragknob", animated=True):
        """A model with parts and all that an object can have."""
        obj, hierarchy = self.built(name)
        obj["by"], obj["list"], obj.data["mesh's"] = 2.0, [1, 2, 3], "own"
        for domain in ("data", "object"):
            obj.data.materials.append(bpy.data.materials.get(domain) or bpy.data.materials.new(domain))
        obj.material_slots[1].link, obj.material_slots[1].material = "OBJECT", obj.data.materials[0]
        group = obj.vertex_groups.new(name="bone")
        group.add(range(len(obj.data.vertices)), 1, "REPLACE")
        self.keyed(obj)
        rig = self.armature()
        rig.location = 1, 2, 3
        bpy.context.view_layer.objects.active = obj
        mirror = obj.modifiers.new("mirror", "MIRROR")
        mirror.use_mirror_merge = False
        obj.modifiers.new("bend", "ARMATURE").object = rig
        hook = obj.modifiers.new("hook", "HOOK")
        hook.object = rig
        hook.vertex_indices_set([0, 1, 2, 3])
        obj.modifiers.new("solid", "SOLIDIFY").thickness = 0.25
        obj.location, obj.rotation_euler = (3, 1, 2), (0.3, 0.2, 1)
        self.give_layers(obj.data)
        self.assertGreater(set_all(obj), 30)
        self.assertGreater(set_all(obj.data), 8)
        if animated:
            obj.constraints.new("LIMIT_ROTATION").influence = 0.5
            obj.keyframe_insert("location", frame=1)
            curve = obj.driver_add("pass_index")
            curve.driver.expression = "7"
            curve = obj.driver_add('modifiers["solid"].thickness')
            variable = curve.driver.variables.new()
            variable.name, variable.targets[0].id, variable.targets[0].data_path = "by", obj, '["by"]'
            curve.driver.expression = "by * 0.125"
        other = bpy.data.collections.new("other")
        bpy.context.scene.collection.children.link(other)
        other.objects.link(obj)
        obj.parent, obj.parent_type, obj.parent_bone = rig, "BONE", "bone"
        obj.update_tag()
        bpy.context.view_layer.update()
        return obj, hierarchy, rig

    def give_layers(self, mesh):
        for key_name in ("first", "second", "third"):
            mesh.uv_layers.new(name=key_name)
            mesh.color_attributes.new(f"{key_name} color", "BYTE_COLOR", "CORNER")
        mesh.uv_layers["second"].active_render = True
        mesh.color_attributes.active_color_index, mesh.color_attributes.render_color_index = 2, 1

    def middle(self, hierarchy):
        """A node of medium size."""
        return self.nodes(hierarchy)[3]

    def made_of(self, obj, hierarchy):
        """{how: objects} of what makes objects of parts."""
        api = part("api")
        created_by = {"copy": [api.copy_part(obj, self.middle(hierarchy))],
                 "copy with caps": [api.copy_part(obj, self.middle(hierarchy), smooth=True)],
                 "split": api.split(obj, parts=4),
                 "objects": api.write(obj, api.cut(obj, 4), {"OBJECTS"}).objects,
                 "open": api.write(obj, api.cut(obj, 3), {"OBJECTS"}, closed=False, origins=False).objects}
        bpy.context.view_layer.update()
        return created_by

    def compare(self, now, before, where):
        self.assertEqual(now.keys(), before.keys(), where)
        for name, expected_value in before.items():
            self.assertEqual(now[name], expected_value, f"{name} {where}")

    def test_every_property_is_kept_by_every_command(self):
        """Also those that later versions of Blender add: whatever RNA lists as writable differs from its default before."""
        commands = {
            "copy": lambda api, obj, node: [api.copy_part(obj, node)],
            "split": lambda api, obj, node: api.split(obj, parts=3),
            "objects": lambda api, obj, node: api.write(obj, api.cut(obj, 3), {"OBJECTS"}).objects,
            "remove": lambda api, obj, node: [api.remove(obj, node, snap=False), obj][1:],
            "unite": lambda api, obj, node: [api.unite(obj, [self.cube_at_top(obj)]), obj][1:],
            "swap": lambda api, obj, node: api.swap(obj, node, self.donor(obj)) and [obj],
            "groups": lambda api, obj, node: api.write(obj, api.cut(obj, 3), {"SEAMS", "FACE_SETS"}) and [obj],
        }
        for how, command in commands.items():
            with self.subTest(how):
                self.setUp()
                obj, hierarchy = self.with_everything()
                before = object_data(obj)
                objects = command(part("api"), obj, self.nodes(hierarchy)[-2])
                bpy.context.view_layer.update()
                for new in objects:
                    self.assertEqual(differences(before, new, objects), {}, f"{how} {new.name}")

    def with_everything(self):
        """A model all of whose properties differ from their defaults, with all kinds of physics."""
        obj, hierarchy = self.built("dragknob")
        part("api").write(obj, part("api").cut(obj, 3))  # keeps the parts in the mesh
        self.give_layers(obj.data)
        obj["by"] = 2.0
        for kind in ("COLLISION", "SOFT_BODY", "CLOTH", "DYNAMIC_PAINT", "PARTICLE_SYSTEM"):
            obj.modifiers.new(kind, kind)
        self.link_active(obj)
        bpy.ops.object.forcefield_toggle()
        bpy.ops.rigidbody.object_add()
        bpy.ops.rigidbody.constraint_add()
        for modifier in obj.modifiers:
            modifier.show_viewport = modifier.show_render = False
        count = set_everything(obj) + set_everything(obj.data)
        self.assertGreater(count, 100)
        bpy.context.view_layer.update()
        return obj, hierarchy

    def cube_at_top(self, obj):
        top = max(obj.data.vertices, key=lambda vertex: vertex.co.z).co
        bpy.ops.mesh.primitive_cube_add(size=0.3 * max(obj.dimensions))
        cube = bpy.context.active_object
        bpy.context.view_layer.update()
        cube.matrix_world = obj.matrix_world @ cube.matrix_world
        cube.matrix_world.translation = obj.matrix_world @ top
        bpy.context.view_layer.update()
        return cube

    def donor(self, obj):
        donor, _ = self.built("dragknob")
        donor.location.x = 500
        bpy.context.view_layer.update()
        return donor

    def link_active(self, obj):
        for other in bpy.context.view_layer.objects:
            other.select_set(other == obj)
        bpy.context.view_layer.objects.active = obj

    def test_halves_that_a_mirror_modifier_merges_have_no_wall_between_them(self):
        """Parts of half a ball, whose hole is filled: no face is in the plane of the mirror, as the filled hole would be."""
        center = bpy.data.objects.new("center", None)
        bpy.context.scene.collection.objects.link(center)
        for mirror_object in (None, center):
            shift = Vector((0, 0, 0)) if mirror_object is None else Vector((2, 0, 0))
            bm = bmesh.new()
            bmesh.ops.create_uvsphere(bm, u_segments=16, v_segments=8, radius=1)
            bmesh.ops.delete(bm, geom=[vert for vert in bm.verts if vert.co.x < -1e-3], context="VERTS")
            bmesh.ops.translate(bm, verts=bm.verts[:], vec=shift)
            obj = self.add([], [])
            bm.to_mesh(obj.data)
            bm.free()
            center.location = shift
            obj.modifiers.new("mirror", "MIRROR").mirror_object = mirror_object
            bpy.context.view_layer.update()
            api = part("api")
            cut = api.cut(obj, 3)
            created = api.write(obj, cut, {"OBJECTS"}).objects
            bpy.context.view_layer.update()
            self.assertEqual([*part("cut.objects").difference_messages(obj, cut, created, False)], [])
            for new in created + [api.copy_part(obj, api.part(obj, 0))]:
                bm = bmesh.new()
                bm.from_object(new, bpy.context.evaluated_depsgraph_get())
                centers = [new.matrix_world @ face.calc_center_median() for face in bm.faces]
                self.assertGreater(min(abs(place.x - shift.x) for place in centers), 1e-3, new.name)
                self.assertTrue(all(len(edge.link_faces) > 1 for edge in bm.edges), new.name)
                bm.free()

    def test_a_rigged_and_mirrored_model_moves_as_before(self):
        """Each vertex of the parts is where one of the model is, at rest and posed."""
        for name in ("dragknob", "hand"):
            obj, hierarchy = self.built(name)
            obj.location, obj.rotation_euler = (3, 1, 2), (0.3, 0.2, 1)
            rig = self.armature()
            rig.data.bones["bone"].use_deform = True
            group = obj.vertex_groups.new(name="bone")
            for vertex in obj.data.vertices:
                group.add([vertex.index], (vertex.index % 5) / 4, "REPLACE")
            obj.modifiers.new("mirror", "MIRROR").use_mirror_merge = False
            obj.modifiers.new("bend", "ARMATURE").object = rig
            obj.parent = rig
            bpy.context.view_layer.update()
            size = max(obj.dimensions)
            created_by = self.made_of(obj, hierarchy)
            for degrees in (0, 50):
                bone = rig.pose.bones["bone"]
                bone.rotation_mode, bone.rotation_euler = "XYZ", (math.radians(degrees), 0.2, 0)
                rig.location.x = degrees
                places = evaluated(obj)
                tree = KDTree(len(places))
                for number, place in enumerate(places):
                    tree.insert(place, number)
                tree.balance()
                for how, objects in created_by.items():
                    for new in objects:
                        own = own_vertices(new.data)
                        now = evaluated(new)
                        self.assertEqual(len(now), 2 * len(own))
                        away = numpy.array([tree.find(place)[2] for place in now[numpy.tile(own, 2)]])
                        # Midpoints of polygons that were cut are of no vertex.
                        self.assertGreater((away < 1e-5 * size).mean(), 0.8, f"{how} {new.name} {degrees}")
                        self.assertLess(away.max(), 0.2 * size, f"{how} {new.name} {degrees}")

    def test_removing_keeps_each_shape_key(self):
        """Also where one was removed before, so that Blender counts them otherwise."""
        obj, hierarchy, _ = self.rich()
        before = object_data(obj)
        api = part("api")
        api.remove(obj, self.middle(hierarchy))
        self.compare(object_data(obj), before, "after removing")
        self.check_keys(obj, {"wide": lambda place: place * 1.5, "tall": lambda place: place * (1, 1, 2)})

    def test_strips_of_shape_keys_that_play_no_action_are_kept(self):
        obj, hierarchy = self.built("dragknob")
        self.keyed(obj)
        track = obj.data.shape_keys.animation_data.nla_tracks[0]
        track.strips[0].select = True
        self.link_active(obj)
        window = bpy.context.window_manager.windows[0]
        area = window.screen.areas[0]
        self.addCleanup(setattr, area, "type", area.type)
        area.type = "NLA_EDITOR"
        region = next(region for region in area.regions if region.type == "WINDOW")
        with bpy.context.temp_override(window=window, area=area, region=region):
            bpy.ops.nla.meta_add()
        self.assertEqual([strip.type for strip in track.strips], ["META"])
        before = object_data(obj)
        for how, objects in self.made_of(obj, hierarchy).items():
            for new in objects:
                now = object_data(new)
                for name in ("animation of the keys", "shape keys", "all shape keys"):
                    self.assertEqual(now[name], before[name], f"{name}, {how}")
                strip, = new.data.shape_keys.animation_data.nla_tracks[0].strips
                self.assertEqual([inner.type for inner in strip.strips], ["CLIP"])
                if "origins" not in how and how != "objects":
                    self.check_keys(new, {"wide": lambda place: place * 1.5, "tall": lambda place: place * (1, 1, 2)})

    def check_keys(self, obj, keys):
        base, own = numpy.array([vertex.co for vertex in obj.data.vertices]), own_vertices(obj.data)
        for name, expected in keys.items():
            places = numpy.array([point.co for point in obj.data.shape_keys.key_blocks[name].data])
            worst = abs(places - expected(base))[own].max()
            self.assertLess(worst, 1e-5 * numpy.ptp(base, axis=0).max(), name)

    def test_uniting_keeps_shape_keys_and_all_else(self):
        obj, _ = self.built("dragknob")
        obj["by"] = 2.0
        self.keyed(obj)
        hook = obj.modifiers.new("hook", "HOOK")
        bottom = min(obj.data.vertices, key=lambda vertex: vertex.co.z)
        hooked = bottom.co.copy()
        hook.vertex_indices_set([bottom.index])
        self.give_layers(obj.data)
        set_all(obj)
        set_all(obj.data)
        bpy.context.view_layer.update()
        before = object_data(obj)
        base = {tuple(vertex.co): vertex.index for vertex in obj.data.vertices}
        keys = {key.name: [tuple(point.co) for point in key.data] for key in obj.data.shape_keys.key_blocks}
        part("api").unite(obj, [self.cube_at_top(obj)])
        self.compare(object_data(obj), before, "after uniting")
        size, n_kept = max(obj.dimensions), 0
        for name, old in keys.items():
            for vertex, point in zip(obj.data.vertices, obj.data.shape_keys.key_blocks[name].data):
                number = base.get(tuple(vertex.co))
                if number is not None:
                    n_kept += 1
                    self.assertLess((point.co - Vector(old[number])).length, 1e-5 * size)
        self.assertGreater(n_kept, 2 * len(base))
        self.assertEqual([tuple(obj.data.vertices[vertex].co) for vertex in obj.modifiers["hook"].vertex_indices],
                         [tuple(hooked)])

    def test_hooks_of_each_object_with_the_mesh_stay_where_they_are(self):
        obj, hierarchy = self.built("hand")
        twin = self.link(bpy.data.objects.new("twin", obj.data))
        node = hierarchy.path(0)[-2]
        removed = {vertex for face in hierarchy.faces(node).tolist() for vertex in obj.data.polygons[face].vertices}
        kept = [vertex.index for vertex in obj.data.vertices if vertex.index not in removed]
        hooked = {tuple(obj.data.vertices[vertex].co) for vertex in kept[::7]}
        for user in (obj, twin):
            user.modifiers.new("hook", "HOOK").vertex_indices_set(kept[::7])
        part("api").remove(obj, node)
        for user in (obj, twin):
            self.assertEqual({tuple(user.data.vertices[vertex].co) for vertex in user.modifiers["hook"].vertex_indices}, hooked)

    def cube(self, place):
        bpy.ops.mesh.primitive_cube_add(location=place)
        return bpy.context.active_object

    def test_lost_multires_levels_are_reported(self):
        obj, hierarchy = self.built("dragknob")
        obj.modifiers.new("levels", "MULTIRES")
        bpy.context.view_layer.objects.active = obj
        bpy.ops.object.multires_subdivide(modifier="levels")
        self.assertIn("Multiresolution modifier", " ".join(part("solid.composition").loss_messages(obj)))
        copy = part("api").copy_part(obj, self.middle(hierarchy))
        self.assertEqual(copy.modifiers["levels"].total_levels, 1)
        bpy.ops.mesh.primitive_cube_add(size=obj.dimensions.x)
        cube = bpy.context.active_object
        before = len(obj.data.polygons)
        with self.assertRaisesRegex(ValueError, "Multiresolution modifier"):
            part("api").unite(obj, [cube])
        self.assertEqual(len(obj.data.polygons), before)

    def test_multires_levels_stay_on_whole_polygons(self):
        obj, hierarchy = self.built("hand")
        obj.shape_key_add(name="Basis")
        obj.shape_key_add(name="up").data[0].co.z += 0.5
        obj.modifiers.new("levels", "MULTIRES")
        bpy.context.view_layer.objects.active = obj
        bpy.ops.object.multires_subdivide(modifier="levels", mode="SIMPLE")
        smooth = self.evaluated_places(obj)
        sculpted = bpy.data.objects.new("sculpted", bpy.data.meshes.new_from_object(self.evaluated(obj)))
        bpy.context.scene.collection.objects.link(sculpted)
        size = max(obj.dimensions)
        for number, vertex in enumerate(sculpted.data.vertices):
            vertex.co += 0.02 * size * vertex.normal * ((number * 7919) % 101) / 101
        bpy.ops.object.select_all(action="DESELECT")
        sculpted.select_set(True)
        obj.select_set(True)
        bpy.ops.object.multires_reshape(modifier="levels")
        whole = self.evaluated_places(obj)
        self.assertLess(self.share_near(smooth, whole, 1e-4 * size), 0.1)

        node = max(numpy.flatnonzero(hierarchy.parent >= 0), key=lambda node: len(hierarchy.faces(node)))
        copy = part("api").copy_part(obj, node)
        bpy.context.view_layer.update()
        self.assertGreater(self.share_near(self.evaluated_places(copy), whole, 1e-4 * size), 0.9)  # the others are at the cap
        keys = copy.data.shape_keys.key_blocks
        self.assertEqual([key.name for key in keys], ["Basis", "up"])
        moved = [tuple(b.co - a.co) for a, b in zip(keys[0].data, keys[1].data) if a.co != b.co]
        self.assertIn(len(moved), (0, 1))  # 1 if the vertex is in the part

    def evaluated(self, obj):
        return obj.evaluated_get(bpy.context.evaluated_depsgraph_get())

    def evaluated_places(self, obj):
        places = [obj.matrix_world @ vertex.co for vertex in self.evaluated(obj).to_mesh().vertices]
        self.evaluated(obj).to_mesh_clear()
        return places

    def share_near(self, places, others, distance):
        """The share of places that are this near to one of the others."""
        tree = KDTree(len(others))
        for number, place in enumerate(others):
            tree.insert(place, number)
        tree.balance()
        return sum(tree.find(place)[2] < distance for place in places) / len(places)

    # ---- Extremes

    def test_messages_at_extremes(self):
        """They name the extreme; nothing changes."""
        api = part("api")
        for name in ("dragknob", "broken"):
            vertices, polygons = read_off("dragknob")
            obj = self.add(vertices, polygons if name == "dragknob" else [polygon for i, polygon in enumerate(polygons) if i % 7])
            hierarchy = api.build(obj)
            root, before = len(hierarchy.parent) - 1, (arrays_of(obj), blocks())
            for snap in (False, True):
                with self.assertRaisesRegex(ValueError, "whole model: nothing would be left"):
                    api.remove(obj, root, snap=snap)
            with self.assertRaisesRegex(ValueError, "whole model"):
                api.mirror_image(obj, root)
            with self.assertRaisesRegex(ValueError, "whole model"):
                api.swap(obj, root, obj)
            with self.assertRaisesRegex(ValueError, "whole mesh"):
                api.bend(obj, root, numpy.eye(3))
            self.assertEqual((arrays_of(obj), blocks()), before)
            bpy.ops.object.mode_set(mode="EDIT")
            with self.assertRaisesRegex(RuntimeError, "whole model: nothing would be left"):
                bpy.ops.mesh.partwheel_remove(node=root)
            self.assertEqual(obj.mode, "EDIT")
            bpy.ops.object.mode_set(mode="OBJECT")
            self.assertEqual(len(api.copy_part(obj, root).data.polygons) >= len(obj.data.polygons), True)
            self.assertEqual([len(api.split(obj, parts=1)), len(api.write(obj, api.cut(obj, 1), {"OBJECTS"}).objects)], [1, 1])

    # ---- Where Blender lets nothing be added

    def library(self, obj):
        """Path of a file with the object in a collection of its own; the object has gone."""
        collection = bpy.data.collections.new("of the library")
        collection.objects.link(obj)
        path = str(Path(self.folder.name) / "library.blend")
        bpy.data.libraries.write(path, {collection})
        mesh = obj.data
        bpy.data.objects.remove(obj)
        bpy.data.meshes.remove(mesh)
        bpy.data.collections.remove(collection)
        return path

    def linked_collection(self, obj):
        """The object, linked with its collection."""
        path = self.library(obj)
        with bpy.data.libraries.load(path, link=True) as (_, linked):
            linked.collections = ["of the library"]
        collection, = linked.collections
        bpy.context.scene.collection.children.link(collection)
        bpy.context.view_layer.update()
        instance = collection.objects[0]
        self.link_active(instance)
        return instance

    def overridden(self, obj):
        """The object, overridden with its collection; but its mesh is its own."""
        linked = self.linked_collection(obj).users_collection[0]
        collection = linked.override_hierarchy_create(bpy.context.scene, bpy.context.view_layer,
                                                     do_fully_editable=True)
        bpy.context.view_layer.update()
        instance = collection.all_objects[0]
        self.assertTrue(instance.override_library and collection.override_library)
        self.link_active(instance)
        mesh = bpy.data.meshes.new("own")
        mesh.from_pydata(*(arrays(instance.data)[0].tolist(), [], arrays(instance.data)[1]))
        instance.data = mesh
        return instance

    def nothing_left_behind(self):
        for kind in ("objects", "collections", "meshes", "armatures"):
            for block in getattr(bpy.data, kind):
                self.assertTrue(block.users and (kind != "objects" or block.users_collection), f"{kind}: {block.name}")

    def test_in_an_overridden_collection(self):
        """Also in Edit Mode, where Blender lets an object be there that is none."""
        for edited in (False, True)[:1 + (bpy.app.version >= (4, 0, 0))]:
            with tempfile.TemporaryDirectory() as name:
                self.folder = type("Folder", (), {"name": name})
                obj = self.overridden(self.add(*read_off("dragknob")))
                if edited:
                    obj = obj.make_local(clear_liboverride=True)
                    self.assertTrue(obj.users_collection[0].override_library)
                obj.location.x = 5
                bpy.context.view_layer.update()
                self.in_overridden(obj, edited)
                self.nothing_left_behind()
            self.setUp()

    def test_parts_of_an_overridden_mesh_are_local(self):
        """Blender copies an override as another one, whose geometry Python can't change."""
        source, _ = self.built("dragknob")
        self.keyed(source)
        obj = self.linked(source).override_create(remap_local_usages=True)
        obj.data.override_create(remap_local_usages=True)
        self.assertTrue(obj.override_library and obj.data.override_library and obj.data.shape_keys)
        self.link_active(obj)
        hierarchy = part("api").build(obj)
        api = part("api")
        copy, *created = api.copy_part(obj, self.middle(hierarchy)), *api.split(obj, parts=3)
        mirrored = api.place(obj, (0, 0, 100), target=copy, mirror=True)
        for new in (copy, *created, mirrored):
            self.assertFalse(new.override_library or new.data.override_library or new.data.library, new.name)
            self.assertEqual(len(new.data.shape_keys.key_blocks), 3)
            self.assertSolid(new.data)

    def in_overridden(self, obj, edited):
        hierarchy = part("api").build(obj)
        for operator, options in ((bpy.ops.mesh.partwheel_copy, {"node": self.middle(hierarchy), "snap": False}),
                                  (bpy.ops.mesh.partwheel_split, {"parts": 3, "hide": False}),
                                  (bpy.ops.mesh.partwheel_convex, {"hulls": 3}),
                                  (bpy.ops.mesh.partwheel_parts, {"to": {"OBJECTS"}, "count": 3, "hide": False}),
                                  (bpy.ops.mesh.partwheel_parts, {"to": {"BONES"}, "count": 3}),
                                  (bpy.ops.mesh.partwheel_remove, {"node": self.middle(hierarchy), "snap": False})):
            self.link_active(obj)
            if edited:
                bpy.ops.object.mode_set(mode="EDIT")
            known = set(bpy.data.objects)
            self.assertEqual(operator(**options), {"FINISHED"})
            bpy.context.view_layer.update()
            for new in set(bpy.data.objects) - known:
                self.assertFalse(new.library or new.override_library, operator)
                self.assertTrue(new.name in bpy.context.view_layer.objects)
                self.assertLess(abs(new.matrix_world.translation.x - 5), max(obj.dimensions), operator)
            if bpy.context.mode != "OBJECT":
                bpy.ops.object.mode_set(mode="OBJECT")

    # ---- Where it breaks off

    @only_in("oldest", "newest")
    def test_a_failure_anywhere_leaves_nothing_behind(self):
        giver, _ = self.built("hand")
        giver.location.x = 500
        giver.shape_key_add(name="Basis")
        bpy.context.view_layer.update()
        for operator, options, changes in (
                (bpy.ops.mesh.partwheel_copy, {"snap": False}, False),
                (bpy.ops.mesh.partwheel_split, {"parts": 3}, False),
                (bpy.ops.mesh.partwheel_convex, {"hulls": 2}, False),
                (bpy.ops.mesh.partwheel_parts, {"to": {"OBJECTS"}, "count": 3}, False),
                (bpy.ops.mesh.partwheel_parts, {"to": {"BONES"}, "count": 3}, True),
                (bpy.ops.mesh.partwheel_remove, {"snap": False}, True),
                (bpy.ops.mesh.partwheel_swap, {"snap": False, "build": False}, True),
                (bpy.ops.object.partwheel_unite, {"build": False}, True),
                (bpy.ops.object.partwheel_place, {"target": giver.name, "mirror": True, "location": (1, 2, 3)}, False)):
            obj, hierarchy = self.built("dragknob")
            self.keyed(obj)
            obj["by"] = 1.0
            if "node" in operator.get_rna_type().properties:
                options["node"] = self.nodes(hierarchy)[-2]
            self.link_active(obj)
            if operator.idname_py() == "mesh.partwheel_parts":
                part("api").write(obj, part("api").cut(obj, 3))  # kept in the mesh beforehand
            if operator.idname_py().startswith("mesh."):
                bpy.ops.object.mode_set(mode="EDIT")
            elif operator.idname_py() == "object.partwheel_unite":
                other = self.add(*BOX, "other")
                other.location = obj.location
                self.link_active(obj)
                other.select_set(True)
            bpy.context.view_layer.update()  # the driver
            number, raised = 0, True
            while raised:
                selected_objects = bpy.context.selected_objects[:]
                before = blocks(), bpy.context.mode, object_data(obj), arrays_of(obj)
                with FailAt(number) as fail:
                    try:
                        self.assertEqual(operator(**options), {"FINISHED"})
                    except RuntimeError as error:
                        self.assertIn("Fault", str(error), number)
                raised = fail.raised
                if raised:
                    where = f"{operator.idname_py()}: {raised}, call {number}"
                    now = blocks(), bpy.context.mode, object_data(obj), arrays_of(obj)
                    self.assertEqual(now[0], before[0], where)
                    self.assertEqual(now[1], before[1], where)
                    self.assertEqual(bpy.context.selected_objects[:], selected_objects, where)
                    self.assertEqual(bpy.context.view_layer.objects.active, obj, where)
                    is_written = any(now[2][name] != before[2][name] for name in ("groups", "custom of the mesh", "modifiers"))
                    if changes and (now[3] != before[3] or is_written):
                        break  # it was done by then
                    self.compare(now[2], before[2], where)
                    self.assertEqual(now[3], before[3], where)
                number = 2 * number + 1
            self.assertGreater(number, 30, operator)
            if bpy.context.mode != "OBJECT":
                bpy.ops.object.mode_set(mode="OBJECT")
            bpy.data.objects.remove(obj)
