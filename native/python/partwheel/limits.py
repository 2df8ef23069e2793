# SPDX-License-Identifier: GPL-3.0-or-later
"""Limits of this process. The worker imports this file, too, so it uses the standard library only."""

import ctypes
import signal
import sys

try:
    import resource
except ImportError:  # Windows, where limits have no effect
    resource = None  # type: ignore[assignment]


def die_with_parent() -> None:
    """On Linux even a stopped process dies with its parent from now on."""
    if sys.platform == "linux":
        set_parent_death_signal = 1
        ctypes.CDLL(None).prctl(set_parent_death_signal, signal.SIGKILL, 0, 0, 0)


def limit_memory(size: int) -> None:
    """Limits the data segment to this many bytes (Linux only; 0: the limit stays as it is), and disables core files."""
    if resource:
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        if size and sys.platform == "linux":
            _set_soft_limit(resource.RLIMIT_DATA, size)


def limit_processor_time(seconds: float) -> None:
    """Limits the processor time from now on."""
    if resource:
        usage = resource.getrusage(resource.RUSAGE_SELF)
        _set_soft_limit(resource.RLIMIT_CPU, int(usage.ru_utime + usage.ru_stime + seconds) + 1)


def _set_soft_limit(kind: int, value: int) -> None:
    """Sets a soft limit, at most the hard one."""
    _, hard = resource.getrlimit(kind)
    resource.setrlimit(kind, (value if hard == resource.RLIM_INFINITY else min(value, hard), hard))
