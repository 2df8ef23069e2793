# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds in a separate process."""

from .job import MESSAGE, WAIT_SECONDS, Job, WorkerError, available_memory, read_memory

__all__ = ["MESSAGE", "WAIT_SECONDS", "Job", "WorkerError", "available_memory", "read_memory"]
