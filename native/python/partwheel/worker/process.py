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
from ctypes import byref, c_double, c_int, c_size_t, c_uint8, c_void_p

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

from library import STAGE_COUNT, BuildOptions, Stage, Status, load  # noqa: E402

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
    except MemoryError:
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


class Build(threading.Thread):
    """pw_build in a thread of its own, while the main thread reports."""

    def __init__(self, context, header, arrays):
        super().__init__()
        self.context, self.header, self.arrays = context, header, arrays
        self.hierarchy, self.status, self.message = c_void_p(), Status.OK, ""

    def run(self):
        vertices, triangles, *faces = ((c_uint8 * len(array)).from_buffer(array) for array in self.arrays)
        options = BuildOptions(**self.header["options"])
        self.status = load().pw_build(
            self.context, ctypes.addressof(vertices), len(vertices) // 24, ctypes.addressof(triangles),
            len(triangles) // 12, ctypes.addressof(faces[0]) if faces else None, self.header["face_count"],
            byref(options), byref(self.hierarchy))
        self.message = load().pw_error_message().decode()  # each thread has its own


def build(header, arrays, answers):
    context = c_void_p()
    if load().pw_context_create(byref(context)):
        raise MemoryError
    thread = Build(context, header, arrays)
    report(context, answers)  # that it has begun: one that ends before this could not be started
    thread.start()
    while thread.is_alive():
        thread.join(TICK)
        report(context, answers)
    seconds = (c_double * STAGE_COUNT)()
    load().pw_context_seconds(context, seconds)
    send(answers, b"S", {load().pw_stage_name(each).decode(): seconds[each] for each in Stage})
    if thread.status:
        send(answers, b"E", {"status": thread.status, "message": thread.message})
    else:
        send(answers, b"H", saved(thread.hierarchy))


def report(context, answers):
    fraction, stage, rung = c_double(), c_int(), c_int()
    load().pw_context_progress(context, byref(fraction), byref(stage))
    load().pw_context_rung(context, byref(rung))
    send(answers, b"P", [fraction.value, load().pw_stage_name(stage.value).decode(), rung.value, work()])


def work():
    """Processor time that all has taken but the reporting itself, in hundredths of a second."""
    return round(time.process_time() - time.thread_time(), 2)


def saved(hierarchy):
    count = c_size_t()
    status = load().pw_hierarchy_save(hierarchy, None, 0, byref(count))
    buffer = (c_uint8 * count.value)()
    status = status or load().pw_hierarchy_save(hierarchy, ctypes.addressof(buffer), count.value, byref(count))
    if status:
        raise MemoryError  # the only way for a finished hierarchy not to be saved
    return memoryview(buffer).cast("B")


if __name__ == "__main__":
    main()
