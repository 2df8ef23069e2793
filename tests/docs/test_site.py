# SPDX-License-Identifier: GPL-3.0-or-later
"""The site that scripts/docs builds, in a real browser, as wide as a phone and as a desk: no error, nothing wider than the
page, each picture there, each link of the site answered.

A page of our own opens each page of the site in a frame of that width,
from a server of this process, and sends back what it saw.
"""

import functools
import http.server
import json
import queue
import re
import shutil
import subprocess
import threading
import urllib.request

import pytest
from conftest import ROOT

BROWSER = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
WIDTHS = (390, 1280)  # pixels
LOOK = """<!doctype html><title>Partwheel</title><body><script>
async function look(page, width) {
  const frame = document.createElement("iframe");
  frame.style = `width: ${width}px; height: 844px; border: 0`;
  frame.src = page;
  document.body.append(frame);
  await new Promise(loaded => frame.onload = loaded);
  const inner = frame.contentDocument, root = inner.documentElement;
  await Promise.all([...inner.images].map(image => image.decode().catch(() => {})));
  const scrolls = each => each && (/auto|scroll|hidden/.test(getComputedStyle(each).overflowX) || scrolls(each.parentElement));
  const content = [...inner.querySelectorAll("[data-md-component=container] *, footer *")];
  const seen = {
    page, width, title: inner.title, available: root.clientWidth, needed: root.scrollWidth,
    wide: content.filter(each => each.getBoundingClientRect().right > width + 1 && !scrolls(each.parentElement))
      .map(each => each.outerHTML.slice(0, 99)),
    images: inner.images.length,
    unseen: [...inner.images].filter(image => !image.naturalWidth).map(image => image.src),
    links: [...inner.links].map(link => link.href).filter(link => link.startsWith(location.origin)),
    ids: [...inner.querySelectorAll("[id]")].map(each => each.id)};
  frame.remove();
  return seen;
}
const tell = seen => fetch("/seen", {method: "POST", body: JSON.stringify(seen)});
(async () => {
  const seen = [];
  for (const page of PAGES) for (const width of WIDTHS) seen.push(await look(page, width));
  return seen;
})().then(tell, error => tell(String(error)));
</script>"""


SITE = ROOT / "build" / "site"
LONGEST = 1800  # seconds, only so that nothing hangs for ever


class Server(http.server.ThreadingHTTPServer):
    """The site, the page that looks at it, and what that saw."""

    def __init__(self):
        super().__init__(("127.0.0.1", 0), functools.partial(Handler, directory=SITE))
        self.address = f"http://127.0.0.1:{self.server_port}"
        self.seen = queue.Queue()


class Handler(http.server.SimpleHTTPRequestHandler):
    def do_GET(self):
        if self.path == "/look":
            self._answer(LOOK.replace("PAGES", json.dumps(pages())).replace("WIDTHS", json.dumps(WIDTHS)))
        else:
            super().do_GET()

    def do_POST(self):
        self.server.seen.put(json.loads(self.rfile.read(int(self.headers["Content-Length"]))))
        self._answer("Thank you.")

    def _answer(self, text):
        self.send_response(200)
        self.send_header("Content-Type", "text/html; charset=utf-8")
        self.end_headers()
        self.wfile.write(text.encode())

    def log_message(self, *_):
        pass


def pages():
    """All but the one for what is not there: its links are those of a site at a server's root."""
    return sorted(f"/{path.relative_to(SITE).as_posix()}" for path in SITE.rglob("*.html") if path.name != "404.html")


@pytest.fixture(scope="module")
def server():
    """The site, built anew."""
    result = subprocess.run([ROOT / "scripts" / "docs"], capture_output=True, text=True)
    assert result.returncode == 0, result.stdout + result.stderr
    with Server() as running:
        threading.Thread(target=running.serve_forever, daemon=True).start()
        yield running
        running.shutdown()


@pytest.fixture(scope="module")
def browsed(server, tmp_path_factory):
    """What was seen of each page at each width, and what the browser's console said."""
    if not BROWSER:
        pytest.skip("chromium is absent: apt-get install chromium")
    log = tmp_path_factory.mktemp("browser") / "said"
    with log.open("w") as file:
        browser = subprocess.Popen(
            [BROWSER, "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--hide-scrollbars",
             f"--user-data-dir={log.parent / 'profile'}", "--enable-logging=stderr", "--remote-debugging-port=0",
             f"{server.address}/look"], stderr=file)  # the port keeps it open
    try:
        views = server.seen.get(timeout=LONGEST)
    finally:
        browser.terminate()
        browser.wait()
    assert isinstance(views, list), views
    return views, re.findall(r"CONSOLE.*", log.read_text())


def test_every_page_is_tested_at_each_width(browsed):
    views, _ = browsed
    assert [(view["page"], view["width"]) for view in views] == [(page, width) for page in pages() for width in WIDTHS]
    assert all(view["available"] == view["width"] and "Partwheel" in view["title"] for view in views)
    assert sum(view["images"] for view in views) > 20


def test_no_error_in_the_console(browsed):
    assert browsed[1] == []


def test_nothing_is_wider_than_the_page(browsed):
    assert [(view["page"], view["width"], view["needed"], view["wide"]) for view in browsed[0]
            if view["wide"] or view["needed"] > view["available"]] == []


def test_every_picture_is_there(browsed):
    assert [(view["page"], view["unseen"]) for view in browsed[0] if view["unseen"]] == []


def test_the_reference_has_types_beside_descriptions(server):
    """A name, a type from the annotation, a description: not the description in place of the type."""
    for page, name, kind, description in (("api_python", "vertices", "ArrayLike", "(V, 3) coordinates"),
                                          ("api_blender", "level", "int", "")):
        text = re.sub(r"\s+", " ", re.sub(r"<[^>]+>", " ", (SITE / f"{page}.html").read_text()))
        assert re.search(rf" {name} {kind} {re.escape(description)}", text), page


def test_every_link_of_the_site_is_answered(server, browsed):
    ids = {view["page"]: set(view["ids"]) for view in browsed[0]}
    links = {link for view in browsed[0] for link in view["links"]}
    assert len(links) > 100
    for link in sorted(links):
        page, _, anchor = link.removeprefix(server.address).partition("#")
        with urllib.request.urlopen(server.address + page) as answer:  # raises for what is not there
            assert answer.status == 200
        assert not anchor or anchor in ids["/index.html" if page == "/" else page], link
