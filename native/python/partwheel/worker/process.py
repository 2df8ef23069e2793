# SPDX-License-Identifier: GPL-3.0-or-later
"""The worker process: one surface in by standard input, progress and a saved hierarchy out by standard output.

job.py starts it by its path, with a bare Python: no numpy, no site-packages, nothing of Blender. Messages are a
kind, a length and so many bytes. In: B {options, face_count, memory_limit, sizes}, then the arrays' bytes. Out: P
[fraction, stage, rung, seconds of processor time] some times a second; in the end S {stage: seconds}, and H saved
hierarchy or E {status, message}.
"""

import ctypes
import json
import os
import signal
import struct
import sys
import threading
import time
from ctypes import c_int, c_size_t, c_uint8

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

from library import Build, BuildOptions, Context, PartwheelError, Status, load, told  # noqa: E402

MESSAGE = struct.Struct("<cQ")
TICK = 0.05  # seconds between reports of progress


def main():
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # whatever a library prints must not get between the messages
    end_with_parent()
    load()
    try:
        header, arrays = receive()
        limit(header["memory_limit"])
        threading.Thread(target=wait_for_end_of_input, daemon=True).start()
        build(header, arrays, answers)
    except (MemoryError, PartwheelError):  # of what is refused but for want of memory, build() tells
        send(answers, b"E", {"status": Status.MEMORY, "message": "Out of memory."})
    # Not sys.exit(): a build that went wrong may have left the library in a state that does not bear tidying up.
    answers.flush()
    os._exit(0)


def end_with_parent():
    """On Linux even a stopped worker dies with its parent; everywhere else wait_for_end_of_input() sees to it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C in a terminal goes to parent and worker: the parent decides
    if sys.platform == "linux":
        set_parent_death_signal = 1
        ctypes.CDLL(None).prctl(set_parent_death_signal, signal.SIGKILL, 0, 0, 0)


def wait_for_end_of_input():
    """The parent writes nothing after the arrays: when the pipe ends, the parent has. The build lets go of Python's
    lock while it is in the library, so this thread runs whatever the library does."""
    while os.read(0, 4096):
        pass
    os._exit(1)


def limit(memory):
    """Memory for data, in bytes, as far as the system keeps such limits; and no core file after a crash."""
    try:
        import resource
    except ImportError:  # Windows
        return
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    if memory and sys.platform == "linux":
        _, most = resource.getrlimit(resource.RLIMIT_DATA)
        memory = memory if most == resource.RLIM_INFINITY else min(memory, most)
        resource.setrlimit(resource.RLIMIT_DATA, (memory, most))


def receive():
    """(header, arrays as bytearrays), read from standard input."""
    kind, length = MESSAGE.unpack(read(MESSAGE.size))
    if kind != b"B":
        sys.exit("worker/process.py is started by worker/job.py and makes no sense alone.")
    header = json.loads(read(length))
    return header, [read(size) for size in header["sizes"]]


def read(size):
    buffer = bytearray(size)
    view, done = memoryview(buffer), 0
    with open(0, "rb", buffering=0, closefd=False) as pipe:
        while done < size:
            got = pipe.readinto(view[done:])
            if not got:
                os._exit(1)  # the parent has ended
            done += got
    return buffer


def send(pipe, kind, payload):
    if not isinstance(payload, memoryview):
        payload = json.dumps(payload).encode()
    try:
        pipe.write(MESSAGE.pack(kind, len(payload)))
        pipe.write(payload)
        pipe.flush()
    except OSError:
        os._exit(1)  # the parent has ended


def build(header, arrays, answers):
    vertices, triangles, *faces = ((c_uint8 * len(array)).from_buffer(array) for array in arrays)
    surface = vertices, len(vertices) // 24, triangles, len(triangles) // 12, faces[0] if faces else None
    context = Context()
    thread = Build(context, (*surface, header["face_count"]), BuildOptions(**header["options"]))
    report(context, answers)  # that it has begun: one that ends before this could not be started
    thread.start()
    while not thread.done.wait(TICK):
        report(context, answers)
    report(context, answers)
    send(answers, b"S", context.seconds())
    if thread.error:
        send(answers, b"E", {"status": thread.error.status, "message": str(thread.error)})
    else:
        send(answers, b"H", saved(thread.address.value))


def report(context, answers):
    send(answers, b"P", [*context.progress(), *told([c_int], load().pw_context_rung, context), work()])


def work():
    """Processor time that all has taken but the reporting itself, in hundredths of a second."""
    return round(time.process_time() - time.thread_time(), 2)


def saved(hierarchy):
    size, = told([c_size_t], load().pw_hierarchy_save, hierarchy, None, 0)
    buffer = (c_uint8 * size)()
    told([c_size_t], load().pw_hierarchy_save, hierarchy, buffer, size)
    return memoryview(buffer).cast("B")


if __name__ == "__main__":
    main()
