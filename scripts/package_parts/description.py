"""The description of the package on PyPI: the README with absolute links, because relative ones lead nowhere there.
scikit-build-core calls dynamic_metadata(), see pyproject.toml.

GitHub's workflows set the project's address. Without it, links become plain text, and pictures are left out."""

import os
import re
from pathlib import Path

LINK = re.compile(r"(!?)\[([^]]*)\]\(([^)\s]+)\)")


def dynamic_metadata(field, _settings):
    assert field == "readme", field
    text = Path("README.md").read_text("utf-8")
    return {"content-type": "text/markdown", "text": with_absolute_links(text, repository_address(os.environ))}


def repository_address(environment):
    """The address of the repository at this tag, with {} in place of the kind of page; "" if unknown."""
    names = [environment.get(f"GITHUB_{name}") for name in ("SERVER_URL", "REPOSITORY", "REF_NAME")]
    return "{}/{}/{{}}/{}/".format(*names) if all(names) else ""


def with_absolute_links(text, address):
    """The Markdown text with links below address, as repository_address() returns it."""
    def replace_link(link):
        is_picture, words, target = link.groups()
        if "://" in target:
            return link[0]
        if not address:
            return "" if is_picture else words
        target = f"README.md{target}" if target.startswith("#") else target
        return f"{is_picture}[{words}]({address.format('raw' if is_picture else 'blob')}{target})"

    return re.sub(r"\n{3,}", "\n\n", LINK.sub(replace_link, text))
