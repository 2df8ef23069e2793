# SPDX-License-Identifier: GPL-3.0-or-later
"""The worker process: reads a surface from standard input, writes progress and a saved hierarchy to standard output.

job.py starts it by its path with a bare Python: no numpy, no site-packages, nothing from Blender. A message is a kind,
a length and that many bytes.

Input:  B {options, face_count, marks, memory_limit, sizes}, then the bytes of the arrays
Output: P [fraction, stage, fill method, seconds of processor time], every TICK seconds
        S {stage: seconds}, then H saved hierarchy or E {status, message, faces, vertices, triangle}
"""

from __future__ import annotations

import ctypes
import json
import os
import signal
import struct
import sys
import threading
import time
from ctypes import c_double, c_float, c_int, c_int32, c_size_t, c_uint8

TYPE_CHECKING = False  # typing.TYPE_CHECKING, without the time that importing typing takes
if TYPE_CHECKING:
    from typing import Any, BinaryIO

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

from limits import die_with_parent, limit_memory  # noqa: E402
from library import Build, BuildOptions, Context, MeshView, PartwheelError, Status, call_with_outputs, load  # noqa: E402

MESSAGE = struct.Struct("<cQ")
TICK = 0.05  # seconds between reports of progress


def main() -> None:
    """Builds one hierarchy."""
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what a library prints to standard output must not mix with the messages
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # a terminal sends Ctrl-C to both processes: the parent handles it
    die_with_parent()
    load()
    try:
        header, arrays = receive()
        limit_memory(header["memory_limit"])
        threading.Thread(target=exit_at_end_of_input, daemon=True).start()
        build(header, arrays, answers)
    except (MemoryError, PartwheelError):  # build() sends all other errors
        send(answers, b"E", {"status": Status.MEMORY, "message": "Out of memory."})
    # Not sys.exit(): after a failed build, the library's cleanup could crash.
    answers.flush()
    os._exit(0)


def exit_at_end_of_input() -> None:
    """Exits when the parent has died, on all systems. The parent writes nothing after the arrays and keeps the pipe open.
    This thread runs during the build, because ctypes releases the interpreter lock."""
    while os.read(0, 4096):
        pass
    os._exit(1)


def receive() -> tuple[dict, list[bytearray]]:
    """(header, arrays), read from standard input."""
    kind, length = MESSAGE.unpack(read(MESSAGE.size))
    if kind != b"B":
        sys.exit("worker/process.py can't be run by hand: worker/job.py starts it.")
    header = json.loads(read(length))
    return header, [read(size) for size in header["sizes"]]


def read(size: int) -> bytearray:
    """Exactly this many bytes of standard input."""
    buffer = bytearray(size)
    view, position = memoryview(buffer), 0
    with open(0, "rb", buffering=0, closefd=False) as pipe:
        while position < size:
            count = pipe.readinto(view[position:])
            if not count:
                os._exit(1)  # the parent has ended
            position += count
    return buffer


def send(pipe: BinaryIO, kind: bytes, payload: object) -> None:
    """Writes a message to the pipe. The payload: a memoryview, or anything else as JSON."""
    if not isinstance(payload, memoryview):
        payload = json.dumps(payload).encode()
    try:
        pipe.write(MESSAGE.pack(kind, len(payload)))
        pipe.write(payload)
        pipe.flush()
    except OSError:
        os._exit(1)  # the parent has ended


def build(header: dict, arrays: list[bytearray], answers: BinaryIO) -> None:
    """Builds the hierarchy of a surface and sends progress and the result to the parent.

    header, arrays : see Input above; vertices, triangles, and perhaps faces; then edges and strengths of each kind of
        marks"""
    marks = header["marks"]
    n_surface = len(arrays) - 2 * len(marks)
    types: list[Any] = [c_double * 3, c_int32 * 3, c_int32][:n_surface] + [c_int32 * 2, c_float] * len(marks)
    buffers = [(item * (len(array) // ctypes.sizeof(item))).from_buffer(array) for item, array in zip(types, arrays)]
    vertices, triangles, faces = (*buffers[:n_surface], None)[:3]
    context = Context()
    surface = MeshView.of(vertices, triangles, faces, header["face_count"], ctypes.addressof)
    options = BuildOptions(**header["options"])
    kinds = [(name, edges, strengths, chosen) for (name, chosen), edges, strengths in zip(
        marks, buffers[n_surface::2], buffers[n_surface + 1::2])]
    options.set_marks(kinds, ctypes.addressof)
    native = Build(context, surface, options)
    # Reports at once: job.py takes a worker that exits before its first message as one that can't be started.
    native.run_to_end(lambda: send_progress(context, answers), TICK)
    send(answers, b"S", context.seconds())
    if error := native.error:
        send(answers, b"E", {"status": error.status, "message": str(error), "faces": error.faces, "vertices": error.vertices,
                             "triangle": error.triangle})
    else:
        send(answers, b"H", save(native.address.value))


def send_progress(context: Context, answers: BinaryIO) -> None:
    """Sends a message P."""
    fill_method, = call_with_outputs([c_int], load().pw_context_fill_method, context)
    build_time = round(time.process_time() - time.thread_time(), 2)  # of all threads but this one, which only reports
    send(answers, b"P", [*context.progress(), fill_method, build_time])


def save(hierarchy: int | None) -> memoryview:
    """The saved form of the native hierarchy at this address."""
    size, = call_with_outputs([c_size_t], load().pw_hierarchy_save, None, hierarchy, None, 0)
    buffer = (c_uint8 * size)()
    call_with_outputs([c_size_t], load().pw_hierarchy_save, None, hierarchy, buffer, size)
    return memoryview(buffer).cast("B")


if __name__ == "__main__":
    main()
