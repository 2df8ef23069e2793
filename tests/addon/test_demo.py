# SPDX-License-Identifier: GPL-3.0-or-later
"""What scripts/demo does inside Blender, with the one of its models that takes no minutes."""

import sys
import tempfile
from pathlib import Path

from common import MESHES, MeshTest, only_in

PARTS = Path(__file__).resolve().parents[2] / "scripts" / "demo_parts"


@only_in("oldest")  # the distribution's, in which the demo runs
class Demo(MeshTest):
    def test_a_sheet_is_reported_as_refused(self):
        sys.path.insert(0, str(PARTS))
        self.addCleanup(sys.path.remove, str(PARTS))
        import perform

        (sheet,) = (model for model in perform.MODELS if not model.clicks)
        with tempfile.TemporaryDirectory() as folder:
            report = perform.perform(sheet, MESHES, folder, True)
        self.assertRegex(report["refused"], r"^The mesh is a sheet, not a solid: .*\.$")
        self.assertNotIn("clicks", report)
