"""The sidebar in German, Japanese and Chinese: a click's part is told in the language, and in the scene's units."""
import bpy

SAID = {"de_DE": "der Oberfläche", "ja_JP": "面積の", "zh_HANS": "占面积"}


def play(stage):
    yield from stage.open("hand")
    view = bpy.context.preferences.view
    yield from stage.sidebar()
    yield from stage.pick(0.5, 0.9, above=1)
    told = stage.part("words.say").iface_
    for language, part in SAID.items():
        if language == "zh_HANS" and bpy.app.version < (4, 0):
            language = "zh_CN"
        view.language = language
        view.use_translate_interface = view.use_translate_tooltips = True
        stage.mouse.wheel(1)
        yield from stage.settle()
        stage.mouse.wheel(-1)
        yield from stage.settle()
        stage.check(part in told("Part: {share} of the area"), f"{language} is spoken")
        yield from stage.screenshot(language)
    stage.mouse.key("RET")
    yield from stage.ended()
    yield from stage.screenshot("after")
    view.language = "en_US"
    yield from stage.settle()
