# SPDX-License-Identifier: GPL-3.0-or-later
"""What a release needs besides the code: the wheel's description, the notes, the pictures. tests/ship looks at all files."""

import email
import re
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
TWINE = ROOT / "build" / "venv" / "package" / "bin" / "twine"
README = ROOT / "README.md"
sys.path.append(str(ROOT / "scripts" / "package_parts"))

import description  # noqa: E402
import elsewhere  # noqa: E402
import release_page  # noqa: E402
import zips  # noqa: E402


def test_the_tests_that_run_on_other_platforms_exist():
    for name in elsewhere.CORE:
        assert (ROOT / f"tests/core/test_{name}.py").exists(), name


@pytest.fixture
def wheel():
    """The wheel that scripts/package built of this README."""
    oldest = max(path.stat().st_mtime for path in (README, Path(description.__file__)))
    wheels = [path for path in (ROOT / "build" / "package").glob("*.whl") if path.stat().st_mtime > oldest]
    if not wheels:
        pytest.skip("there is no wheel of this README: scripts/package builds it")
    return wheels[0]


def test_the_description_of_the_wheel_is_the_readme_without_relative_links(wheel):
    with zipfile.ZipFile(wheel) as archive:
        name, = (name for name in archive.namelist() if name.endswith(".dist-info/METADATA"))
        metadata = email.message_from_bytes(archive.read(name))
    assert metadata["Description-Content-Type"].startswith("text/markdown")
    text = metadata.get_payload(decode=True).decode()
    assert all(target.startswith("https://") for target in links(text))
    assert words(text) == words(README.read_text("utf-8"))


def test_links_of_the_description_lead_to_pages_of_the_repository():
    known = {"GITHUB_SERVER_URL": "https://github.com", "GITHUB_REPOSITORY": "a/b", "GITHUB_REF_NAME": "v1.2.3"}
    readme = README.read_text("utf-8")
    text = description.with_absolute_links(readme, description.repository_address(known))
    assert words(text) == words(readme)
    assert len(links(text)) == len(links(readme)) > 20
    for target in links(text):
        kind, path = re.fullmatch(r"https://github\.com/a/b/(blob|raw)/v1\.2\.3/([^#]+)(?:#.+)?", target).groups()
        assert (ROOT / path).is_file()
        assert (kind == "raw") == (path.startswith("docs/images/"))


def links(markdown):
    return re.findall(r"\]\(([^)]+)\)", markdown)


def words(markdown):
    """The text without pictures and targets of links."""
    return re.sub(r"\[([^]]*)\](\([^)]+\))?", r"\1", re.sub(r"!\[[^]]*\]\([^)]+\)", "", markdown)).split()


@pytest.mark.skipif(not TWINE.exists(), reason="twine is absent: scripts/package installs it")
def test_twine_accepts_the_wheel(wheel):
    result = subprocess.run([TWINE, "check", "--strict", wheel], capture_output=True, text=True)
    assert result.returncode == 0, result.stdout + result.stderr


def test_notes_and_pictures_of_the_release_page(tmp_path):
    release_page.write(tmp_path)
    heading, section = re.search(r"^## ([^\n]+)\n(.+?)(?=^## |\Z)", (ROOT / "CHANGELOG.md").read_text("utf-8"), re.M | re.S).groups()
    assert heading.split()[0] == zips.agreed_version()
    assert (tmp_path / "NOTES.md").read_text("utf-8").strip() == section.strip()
    pictures = sorted((tmp_path / "pictures").iterdir())
    assert [path.name for path in pictures] == sorted(release_page.PICTURES)
    assert all(0 < path.stat().st_size < 2_000_000 for path in pictures)
