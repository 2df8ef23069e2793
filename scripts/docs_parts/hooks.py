"""MkDocs hooks: they generate the C API's page from the headers, and replace links to source files, which the site
doesn't have, with the files' paths."""

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HEADERS = ROOT / "native" / "include"
UPWARD = re.compile(r"\[([^]]+)\]\(((?:\.\./)+)([^)#]+)\)")


def on_page_markdown(markdown, page, **_):
    if page.file.src_path == "api_c.md":
        markdown += "".join(map(section, ("partwheel.h", "partwheel_types.h", "partwheel_edit.h")))
    depth = page.file.src_path.count("/")  # of the page below docs

    def replace(link):
        text, up, path = link.groups()
        if up.count("../") <= depth:
            return link[0]
        return text if path in text else f"{text} (`{path}`)"

    return UPWARD.sub(replace, markdown)


def section(header):
    """A header as Markdown: a section for each chapter with its comments and declarations."""
    text = (HEADERS / header).read_text()
    chapters = re.split(r"^/\* -{4} (.+?) -+ \*/\n", text, flags=re.M)
    head, chapters = chapters[0], zip(chapters[1::2], chapters[2::2])
    about = re.sub(r"^ \*? ?", "", head[2:head.index("*/")], flags=re.M)
    parts = [f"\n\n## {header}\n\n```text\n{about.strip()}\n```\n"]
    rest = head[head.index("*/") + 2:].strip()
    if rest:
        parts.append(f"\n```c\n{rest}\n```\n")
    parts += [f"\n### {title}\n\n```c\n{body.strip()}\n```\n" for title, body in chapters]
    return "".join(parts)
