"""Parts of a Markdown page: headings, paragraphs, list items and table rows, which can be translated."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from enum import Enum

LINE_WIDTH = 100
_FENCE = re.compile(r"\s*```")
_HEADING = re.compile(r"(#{1,6} )(.+?)\s*")
_ITEM = re.compile(r"(\s*(?:[-*+]|\d+\.) +)(\S.*)")
_TEXT = re.compile(r"(\s*)(\S.*)")
_COMMENT = re.compile(r"(.*?(?:^|\s)# )(\S.*)")
_UNBROKEN = re.compile(r"`[^`]{,80}`|\[[^\]]{,60}\]\(| (?=(?:[-*+|>]|#+|\d+\.)(?: |$))")
"""Code, names of links, and blanks in front of a mark, which would begin a list or heading on a new line."""
_GLUE = "\x00"


class PartKind(Enum):
    """Kinds of parts of a page."""

    HEADING = "heading"
    ROW = "table row"
    TEXT = "paragraph or list item"
    COMMENT = "comment in a code block"
    OTHER = "line that is not translated"


@dataclass(frozen=True, slots=True)
class PagePart:
    """One part of a page.

    ``lead`` contains the characters in front of the text, such as the mark of a list item. The text of a
    paragraph is one line, and the text of a table row contains the separators between its cells.
    """

    kind: PartKind
    lead: str
    text: str


def split_page(page: str) -> list[PagePart]:
    """Return the parts of a page in their order, so that ``join_parts`` can write the page again."""
    parts: list[PagePart] = []
    in_code = False
    for line in page.splitlines():
        is_fence = bool(_FENCE.match(line))
        part = _read_code_line(line) if in_code or is_fence else _read_line(line)
        in_code ^= is_fence
        last = parts[-1] if parts else None
        is_item = bool(_ITEM.fullmatch(line))
        if last and last.kind is part.kind is PartKind.TEXT and not is_item:
            parts[-1] = PagePart(PartKind.TEXT, last.lead, f"{last.text} {part.text}")
        else:
            parts.append(part)
    return parts


def _read_code_line(line: str) -> PagePart:
    comment = _COMMENT.fullmatch(line)
    return (
        PagePart(PartKind.COMMENT, comment[1], comment[2]) if comment else PagePart(PartKind.OTHER, "", line)
    )


def _read_line(line: str) -> PagePart:
    """Return the part that a line outside code blocks begins or continues."""
    if set(line) <= set("|-: "):  # an empty line, or the line below the head of a table
        return PagePart(PartKind.OTHER, "", line)
    if line.startswith("|"):
        return PagePart(PartKind.ROW, "| ", line.strip().strip("|").strip())
    for kind, pattern in ((PartKind.HEADING, _HEADING), (PartKind.TEXT, _ITEM), (PartKind.TEXT, _TEXT)):
        if found := pattern.fullmatch(line):
            return PagePart(kind, found[1], found[2].rstrip())
    return PagePart(PartKind.OTHER, "", line)


def join_parts(parts: Iterable[PagePart]) -> str:
    """Return the page that consists of these parts, with its text wrapped."""
    return "".join(f"{line}\n" for part in parts for line in _write_part(part))


def _write_part(part: PagePart) -> Iterator[str]:
    if part.kind is PartKind.ROW:
        yield f"{part.lead}{part.text} |"
    elif part.kind is PartKind.TEXT:
        glued = _UNBROKEN.sub(lambda found: found[0].replace(" ", _GLUE), part.text)
        indent = " " * len(part.lead)
        lines = textwrap.wrap(
            glued, LINE_WIDTH, initial_indent=part.lead, subsequent_indent=indent,
            break_long_words=False, break_on_hyphens=False,
        )  # fmt: skip
        yield from (line.replace(_GLUE, " ") for line in lines)
    else:
        yield part.lead + part.text
