# SPDX-License-Identifier: GPL-3.0-or-later
"""The report in a real browser: totals, pictures, pages, choices; names that are HTML; a hundred thousand rows."""

import html
import re
import shutil
import subprocess
import urllib.parse

import pytest
from conftest import HAND, box, command, environment, run

from partwheel.batch import report

BROWSER = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")


@pytest.fixture
def browser(tmp_path_factory):
    """The page's document after its script has run, as a headless browser has it."""
    if not BROWSER:
        pytest.skip("There is no Chromium on the PATH to open the report in; scripts/test batch installs Debian's.")

    def open_(path, **state):
        profile = tmp_path_factory.mktemp("profile")
        result = subprocess.run(
            [BROWSER, "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", f"--user-data-dir={profile}",
             "--virtual-time-budget=20000", "--dump-dom", f"file://{path}#{urllib.parse.urlencode(state)}"],
            capture_output=True, text=True, check=True)
        assert 'data-ready="yes"' in result.stdout, result.stderr
        return re.sub(r"<script.*?</script>", "", result.stdout, flags=re.S)

    return open_


def cards(document):
    return [html.unescape(name) for name in re.findall(r'<div class="card[^>]*>.*?<a [^>]*>(.*?)</a>', document, re.S)]


def test_a_real_batch(tmp_path, browser):
    folder = tmp_path / "in"
    folder.mkdir()
    shutil.copy(HAND, folder)
    box(folder / "<img src=x onerror=alert(1)>.off", [1, 2, 3])
    (folder / "torn.off").write_text("OFF")
    (folder / "sheet.off").write_text("OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n")
    out = tmp_path / "out"
    options = "--make", "hierarchy,preview", "--no-open-surfaces"
    assert run(folder, "-o", out, *options, code=1)["failed"] == {"mesh file": 1, "not solid": 1}
    process = subprocess.run([*command()[:-1], "report", str(out)], capture_output=True, text=True, env=environment())
    assert process.stdout.strip() == f"{out / 'report.html'}: 4 models" and process.returncode == 0
    document = browser(out / "report.html")
    assert "4 models, 2 failed" in document and "2,396 faces" in document
    assert len(cards(document)) == 4 and any("<img src=x" in name for name in cards(document))
    assert document.count('data-width="192"') == 3  # the sheet was drawn as well, what can't be read was not
    assert len(cards(browser(out / "report.html", kind="all failures"))) == 2
    assert cards(browser(out / "report.html", kind="failure: mesh file")) == [str(folder / "torn.off")]
    assert cards(browser(out / "report.html", order="faces"))[0].endswith("hand.off")
    assert cards(browser(out / "report.html", text="SHEET")) == [str(folder / "sheet.off")]


def test_a_hundred_thousand_rows_are_paged(tmp_path, browser):
    rows = [[f"model{number:06}", f"{number:064x}", 1000, number, 0.1 + number % 7, "exact", None, "", 0]
            for number in range(100_000)]
    (tmp_path / "report.html").write_text(report.render_page(rows))
    document = browser(tmp_path / "report.html", page="1667")
    assert "page 1667 of 1667, 100,000 models" in document and cards(document)[-1] == "model099999"
    assert len(cards(document)) == 100_000 - 1666 * 60
    assert len(cards(browser(tmp_path / "report.html", page="2", order="seconds"))) == 60
