"""What a release page needs besides the packages: the notes, and pictures for the page of the extension."""

import re
import shutil

from platforms import ROOT

PICTURES = ("front.webp", "tour.jpg", "three_clicks.jpg", "parts_to.jpg", "truck.jpg", "seams.jpg")


def write(target):
    """Writes NOTES.md and the folder pictures to target."""
    (target / "NOTES.md").write_text(notes((ROOT / "CHANGELOG.md").read_text()))
    (target / "pictures").mkdir()
    for name in PICTURES:
        shutil.copy(ROOT / "docs" / "images" / name, target / "pictures")


def notes(changelog):
    """The newest version's section, without its heading."""
    return re.split(r"^## .+\n", changelog, flags=re.M)[1].strip() + "\n"
