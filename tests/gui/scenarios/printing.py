"""Parts for a printer, in Object Mode: P in place of objects, and what is made is seen and taken back by one undo step."""
import bpy


def play(stage):
    yield from stage.open("homer")
    with stage.override():
        bpy.ops.object.mode_set(mode="OBJECT")
    stage.window.scene.unit_settings.scale_length = 0.15  # so that he is as large as what is printed
    model, before = stage.object, set(bpy.data.objects)
    x, y, _ = stage.spot(0.5, 0.5)
    with stage.override():
        bpy.ops.ed.undo_push(message="Begin")
    yield from stage.parts_to(x, y, "FIVE", "O", "P", "RET")
    yield from stage.until("there are five pieces", lambda: len(set(bpy.data.objects) - before) == 5)
    yield from stage.settle()
    stage.check(all(bpy.data.collections[f"{model.name} for printing"] in new.users_collection
                    for new in set(bpy.data.objects) - before), "in a collection of their own")
    yield from stage.screenshot("pieces")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.until("undone", lambda: len(bpy.data.objects) == len(before))
