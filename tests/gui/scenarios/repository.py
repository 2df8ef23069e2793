"""The repository in the preferences of Blender 4.2 and later, and what is installed from it: pictures for scripts/tour.

PARTWHEEL_REPOSITORY: the folder that is served.
"""
import functools
import http.server
import os
import subprocess
import threading

import bpy
from bl_pkg import bl_extension_notify

handler = functools.partial(http.server.SimpleHTTPRequestHandler, directory=os.environ.get("PARTWHEEL_REPOSITORY"))


def seen(stage, window, name):
    """A picture of the window, drawn anew."""
    draws = []
    handle = bpy.types.SpacePreferences.draw_handler_add(lambda: draws.append(True), (), "WINDOW", "POST_PIXEL")
    for _ in range(2):  # what a first drawing has found out a second one shows
        count = len(draws)
        for area in window.screen.areas:
            area.tag_redraw()
        yield from stage.until("the window is drawn", lambda: len(draws) > count)
        yield from stage.settle()
    bpy.types.SpacePreferences.draw_handler_remove(handle, "WINDOW")
    yield from stage.screenshot(name)


def play(stage):
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    preferences = bpy.context.preferences
    preferences.system.use_online_access = True
    repositories = preferences.extensions.repos
    for other in [candidate for candidate in repositories if candidate.use_remote_url]:
        repositories.remove(other)
    repository = repositories.new(name="Partwheel", module="partwheel",
                                  remote_url=f"http://127.0.0.1:{server.server_port}/index.json")
    index = list(repositories).index(repository)
    bpy.ops.extensions.package_uninstall(repo_index=list(repositories).index(repositories["User Default"]),
                                         pkg_id="partwheel")
    bpy.ops.extensions.repo_sync(repo_index=index)
    preferences.active_section = "EXTENSIONS"
    bpy.context.window_manager.extension_search = "partwheel"
    bpy.ops.screen.userpref_show()
    yield from stage.until("the preferences are open", lambda: len(bpy.context.window_manager.windows) == 2)
    window = bpy.context.window_manager.windows[-1]
    subprocess.run(["xdotool", "search", "--sync", "--name", "Preferences", "windowsize", "900", "520",
                    "windowmove", "10", "40"], check=True)
    yield from stage.until("it is where it was moved to", lambda: (window.width, window.height) == (900, 520))
    yield from stage.until("Blender has looked for updates", lambda: not bl_extension_notify.update_in_progress())
    yield from seen(stage, window, "offered")
    bpy.ops.extensions.package_install(repo_index=index, pkg_id="partwheel", enable_on_install=True)
    bpy.ops.extensions.package_show_set(repo_index=index, pkg_id="partwheel")
    yield from seen(stage, window, "installed")
    stage.check("bl_ext.partwheel.partwheel" in preferences.addons, "it is installed from the repository and enabled")
    server.shutdown()
