# SPDX-License-Identifier: GPL-3.0-or-later
"""How a process ended, in words."""

import signal

from .said import Said

KILLED = "was killed (SIGKILL, perhaps for want of memory)"
CRASHED = "crashed ({reason})"
STOPPED = "was ended from outside (Ctrl-C)"
MUTE = "ended without an answer (exit code {code})"
# Of Windows, where a process that crashed has such a number for its exit code.
NTSTATUS = {
    0x80000003: "breakpoint", 0xC0000005: "access violation", 0xC0000006: "a file could not be read",
    0xC0000017: "out of memory", 0xC000001D: "illegal instruction", 0xC000007B: "a library of another platform",
    0xC0000094: "division by zero", 0xC00000FD: "stack overflow", 0xC000012D: "out of memory",
    0xC0000135: "a library is missing", 0xC0000139: "a library of another version",
    0xC0000142: "a library could not be started", 0xC0000374: "heap corruption", 0xC0000409: "abort",
    0xE06D7363: "unhandled exception",
}


def ending(code):
    """A Said, for a sentence that begins with the process: what subprocess.Popen.returncode says."""
    if code == -getattr(signal, "SIGKILL", 9):
        return Said(KILLED)
    if code < 0:
        try:
            return Said(CRASHED, reason=signal.Signals(-code).name)
        except ValueError:
            return Said(CRASHED, reason=f"signal {-code}")
    if code == 0xC000013A:
        return Said(STOPPED)
    if code >= 0x80000000:
        return Said(CRASHED, reason=f"{NTSTATUS.get(code, 'NTSTATUS')}, 0x{code:08X}")
    return Said(MUTE, code=code)
