"""The sidebar and the status bar in German, Spanish, Japanese and Chinese: a click's part is described in the language, and in
the scene's units, and all keys that count fit into the bar of a window 1280 pixels wide."""
import bpy

SAID = {"de_DE": "der Oberfläche", "es": "del área", "ja_JP": "面積の", "zh_HANS": "占面积"}


def play(stage):
    yield from stage.open("hand")
    view = bpy.context.preferences.view
    yield from stage.sidebar()
    translate = stage.part("words.say").iface_
    for start in ("key", "tool"):
        if start == "key":
            yield from stage.pick(0.5, 0.9, above=1)
        else:
            stage.use_tool()
            yield from stage.take(stage.spot(0.5, 0.9, above=1), "with the tool", notches=0)
        for language, part in SAID.items():
            if language == "zh_HANS" and bpy.app.version < (4, 0):
                language = "zh_CN"
            view.language = language
            view.use_translate_interface = view.use_translate_tooltips = True
            stage.mouse.wheel(1)
            yield from stage.settle()
            stage.mouse.wheel(-1)
            yield from stage.settle()
            stage.check(part in translate("Part: {share} of the area"), f"{language} is spoken")
            stage.bar_fits((yield from stage.screenshot(f"{start}-{language}")))
        stage.mouse.key("RET")
        yield from stage.ended()
        view.language = "en_US"
        yield from stage.settle()
    yield from stage.screenshot("after")
