# SPDX-License-Identifier: GPL-3.0-or-later
"""Describes how a process ended."""

import signal

from .translatable import TranslatableText

KILLED = "was killed (SIGKILL, possibly because memory ran out)"
CRASHED = "crashed ({reason})"
INTERRUPTED = "was interrupted (Ctrl-C)"
NO_ANSWER = "ended without an answer (exit code {code})"
# Windows: the exit code of a process that crashed is its NTSTATUS code.
NTSTATUS = {
    0x80000003: "breakpoint", 0xC0000005: "access violation", 0xC0000006: "a file could not be read",
    0xC0000017: "out of memory", 0xC000001D: "illegal instruction", 0xC000007B: "a library of another platform",
    0xC0000094: "division by zero", 0xC00000FD: "stack overflow", 0xC000012D: "out of memory",
    0xC0000135: "a library is missing", 0xC0000139: "a library of another version",
    0xC0000142: "a library could not be started", 0xC0000374: "heap corruption", 0xC0000409: "abort",
    0xE06D7363: "unhandled exception",
}


def describe_exit(code: int) -> TranslatableText:
    """Return the predicate of a sentence whose subject is the process. code: subprocess.Popen.returncode."""
    if code == -getattr(signal, "SIGKILL", 9):
        return TranslatableText(KILLED)
    if code < 0:
        try:
            return TranslatableText(CRASHED, reason=signal.Signals(-code).name)
        except ValueError:
            return TranslatableText(CRASHED, reason=f"signal {-code}")
    if code == 0xC000013A:
        return TranslatableText(INTERRUPTED)
    if code >= 0x80000000:
        return TranslatableText(CRASHED, reason=f"{NTSTATUS.get(code, 'NTSTATUS')}, 0x{code:08X}")
    return TranslatableText(NO_ANSWER, code=code)
