"""Description of TurnDesk for the page of a package index, which is made from ``README.md``.

The project has no public address. Links and pictures of the README lead to files of the repository, so an
index page could not show them.
"""

from __future__ import annotations

import re

_FENCE = re.compile(r"^```.*?^```$", re.MULTILINE | re.DOTALL)
_PICTURE = re.compile(r"^!\[[^\]]*\]\((?!https?://)[^)\s]+\)\n+", re.MULTILINE)
_LINK = re.compile(r"(?<!!)\[((?:[^\[\]`]|`[^`]*`)+)\]\((?!https?://|mailto:)[^)\s]+\)")
_NOTE = """
## Documentation

The package contains all pages that this text names: `turndesk where` prints the folder `documents`.
"""


def format_index_page(readme: str) -> str:
    """Return the README without pictures and links that lead to files of the repository.

    The text of each link remains. Code blocks do not change.
    """
    parts: list[str] = []
    end = 0
    for fence in _FENCE.finditer(readme):
        parts += [_remove_relative_targets(readme[end : fence.start()]), fence[0]]
        end = fence.end()
    parts.append(_remove_relative_targets(readme[end:]))
    return "".join(parts).rstrip("\n") + "\n" + _NOTE


def _remove_relative_targets(text: str) -> str:
    return _LINK.sub(r"\1", _PICTURE.sub("", text))


def convert_description(metadata: bytes) -> bytes:
    """Return a metadata file of a package, with the README in it as the description for an index page."""
    headers, separator, readme = metadata.decode().partition("\n\n")
    return (headers + separator + format_index_page(readme)).encode() if readme else metadata
