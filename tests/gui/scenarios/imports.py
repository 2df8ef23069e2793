"""With Find on Import in the preferences what File > Import and File > Append bring has its parts found beside Blender's own
work; an object that is added, undo and redo begin nothing, and a mesh without area pops nothing up. Workers are held until what comes
between has happened."""
import bpy
import numpy


def play(stage):
    gate = stage.hold_workers()
    yield from stage.open("homer", build=False)
    model, folder = stage.object, stage._work
    with stage.override():
        bpy.ops.object.mode_set(mode="OBJECT")
    path, line, library = folder / "imported.obj", folder / "line.obj", folder / "appended.blend"
    write(path, model.data)
    line.write_text("o line\nv 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nf 1 2 3 4\n")
    bpy.data.libraries.write(str(library), {model})
    bpy.context.preferences.view.filebrowser_display_type = "WINDOW"
    preferences = stage.part("preferences").preferences()

    yield from bring(stage, path)
    stage.check(not stage.has_builds(), "nothing is found unless the preferences say so")
    preferences.on_import = True

    imported = yield from bring(stage, path)
    yield from stage.until("a build has begun for what was imported", stage.has_builds)
    stage.check([stage.builds.is_being_built(stage.snapshot(obj)) for obj in (imported, model)] == [True, False], "for nothing else")
    status = stage.part("view.status").StatusLine.stack[-1]._content
    stage.check("finds the parts of" in status and "Esc" in status, f"the status bar says so ({status})")
    yield from stage.screenshot("0-imported")
    view = stage.view_state()
    stage.mouse.move(*stage.empty_spot())
    stage.mouse.key("NUMPAD_3")
    yield from stage.until("the view turns meanwhile", lambda: stage.view_state() != view)
    gate.open()
    yield from stage.until("its parts are found", lambda: stage.registry.find_hierarchy(imported.data) is not None)
    stage.check(stage.registry.get_state(imported.data)[0] == stage.registry.State.FITS, "and fit")

    gate.close()
    stage.registry.forget_all()
    yield from bring(stage, path)
    yield from stage.until("a build has begun again", stage.has_builds)
    stage.mouse.move(*stage.empty_spot())
    stage.mouse.key("ESC")
    yield from stage.until("Esc ends it", lambda: not stage.has_builds())
    yield from stage.settle()
    stage.check(not stage.has_builds(), "for good")

    with stage.override():
        bpy.ops.mesh.primitive_torus_add("INVOKE_DEFAULT", True)
    yield from stage.settle()
    stage.check(not stage.has_builds(), "nothing is found for an object that is added")
    with stage.override():
        bpy.ops.ed.undo()
        bpy.ops.ed.redo()
    yield from stage.settle()
    stage.check(not stage.has_builds(), "nor when undo and redo take it away and bring it back")

    gate.open()
    yield from bring(stage, line)
    yield from stage.until("a mesh without area is refused", lambda: "No parts for line" in stage.reports())
    yield from stage.settle()
    yield from stage.screenshot("1-line")

    appended = yield from bring(stage, library, "wm.append", "Object")
    yield from stage.until("what was appended has parts", lambda: stage.registry.find_hierarchy(appended.data) is not None)
    gate.remove()


def bring(stage, path, operator="wm.obj_import", inside=""):
    """Imports a file, as the user does: in the file browser's window that the menu opens. Returns the new object."""
    before, windows = set(bpy.data.objects), bpy.context.window_manager.windows
    with stage.override():
        getattr(bpy.ops.wm, operator.partition(".")[2])("INVOKE_DEFAULT")
    yield from stage.until("the file browser is open", lambda: len(windows) == 2)
    area = windows[1].screen.areas[0]
    yield from stage.until("and shows a folder", lambda: area.spaces.active.params)
    area.spaces.active.params.directory = str(path / inside if inside else path.parent).encode()
    yield from stage.settle()
    area.spaces.active.params.filename = "homer" if inside else path.name
    region = next(region for region in area.regions if region.type == "WINDOW")
    with bpy.context.temp_override(window=windows[1], area=area, region=region):
        bpy.ops.file.execute("INVOKE_DEFAULT")
    yield from stage.until("the file is read", lambda: len(windows) == 1 and set(bpy.data.objects) - before)
    yield from stage.settle()
    return (set(bpy.data.objects) - before).pop()


def write(path, mesh):
    """As an OBJ file."""
    places = numpy.zeros((len(mesh.vertices), 3))
    mesh.vertices.foreach_get("co", places.ravel())
    lines = [f"v {x} {y} {z}" for x, y, z in places]
    lines += ["f " + " ".join(str(vertex + 1) for vertex in polygon.vertices) for polygon in mesh.polygons]
    path.write_text("\n".join(["o imported", *lines]) + "\n")
