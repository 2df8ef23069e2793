"""MkDocs hooks. They generate the page of the C API from the headers. The site has no source files, so links to source files
become their paths."""

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HEADERS = ROOT / "native" / "include"
LINK_UP = re.compile(r"\[([^]]+)\]\(((?:\.\./)+)([^)#]+)\)")


def on_page_markdown(markdown, page, **_):
    if page.file.src_path == "api_c.md":
        markdown += "".join(map(section, ("partwheel.h", "partwheel_types.h", "partwheel_edit.h")))
    depth = page.file.src_path.count("/")  # of the page below docs

    def replace_link(link):
        text, up, path = link.groups()
        if up.count("../") <= depth:
            return link[0]  # it stays within docs
        return text if path in text else f"{text} (`{path}`)"

    return LINK_UP.sub(replace_link, markdown)


def section(header):
    """A header as Markdown, with a section for each of its chapters."""
    text = (HEADERS / header).read_text()
    chapters = re.split(r"^/\* -{4} (.+?) -+ \*/\n", text, flags=re.M)
    head, chapters = chapters[0], zip(chapters[1::2], chapters[2::2])
    comment, declarations = head[2:].split("*/", 1)
    comment = re.sub(r"^ \*? ?", "", comment, flags=re.M).strip()
    parts = [f"\n\n## {header}\n\n```text\n{comment}\n```\n"]
    if declarations.strip():
        parts.append(f"\n```c\n{declarations.strip()}\n```\n")
    parts += [f"\n### {title}\n\n```c\n{body.strip()}\n```\n" for title, body in chapters]
    return "".join(parts)
