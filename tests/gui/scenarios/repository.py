"""The repository in the preferences of Blender 4.2 and later, and what is installed from it: a picture, for scripts/tour.

PARTWHEEL_REPOSITORY: the folder that is served.
"""
import functools
import http.server
import os
import threading

import bpy

handler = functools.partial(http.server.SimpleHTTPRequestHandler, directory=os.environ.get("PARTWHEEL_REPOSITORY"))


def play(stage):
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    preferences = bpy.context.preferences
    preferences.system.use_online_access = True
    repositories = preferences.extensions.repos
    for other in [each for each in repositories if each.use_remote_url]:
        repositories.remove(other)
    repository = repositories.new(name="Partwheel", module="partwheel",
                                  remote_url=f"http://127.0.0.1:{server.server_port}/index.json")
    index = list(repositories).index(repository)
    bpy.ops.extensions.package_uninstall(repo_index=list(repositories).index(repositories["User Default"]),
                                         pkg_id="partwheel")
    bpy.ops.extensions.repo_sync(repo_index=index)
    preferences.active_section = "EXTENSIONS"
    bpy.context.window_manager.extension_search = "partwheel"
    stage.window.screen.areas[0].ui_type = "PREFERENCES"
    with bpy.context.temp_override(area=stage.window.screen.areas[0]):
        bpy.ops.screen.screen_full_area()
    yield from stage.settle()
    yield from stage.screenshot("offered")
    bpy.ops.extensions.package_install(repo_index=index, pkg_id="partwheel", enable_on_install=True)
    yield from stage.settle()
    yield from stage.screenshot("installed")
    stage.check("bl_ext.partwheel.partwheel" in preferences.addons, "it is installed from the repository and enabled")
    server.shutdown()
