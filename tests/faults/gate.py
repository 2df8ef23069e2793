# SPDX-License-Identifier: GPL-3.0-or-later
"""A gate in the way of worker processes: held at their beginning for as long as a test wants, however slow or fast the
machine is. Linux only.
"""

import tempfile
from pathlib import Path

HELD = """import os, runpy, time
parent = os.getppid()
while not os.path.exists({open!r}):
    time.sleep(0.005)
    if os.getppid() != parent:
        os._exit(1)
runpy.run_path({entry!r}, run_name="__main__")
"""


class Gate:
    """Closed from the beginning: workers that are started from now on wait for open(). worker: the module core.worker.
    """

    def __init__(self, worker):
        self._worker, self._entry = worker, worker.ENTRY
        self._directory = tempfile.TemporaryDirectory(prefix="partwheel-gate-")
        self._open = Path(self._directory.name) / "open"
        worker.ENTRY = Path(self._directory.name) / "held.py"
        worker.ENTRY.write_text(HELD.format(open=str(self._open), entry=str(self._entry)))

    def open(self):
        self._open.touch()

    def close(self):
        """For workers that have not come to it yet."""
        self._open.unlink()

    def remove(self):
        """Workers are as before. Those that wait are left waiting: whoever started them ends them."""
        self._worker.ENTRY = self._entry
        self._directory.cleanup()
