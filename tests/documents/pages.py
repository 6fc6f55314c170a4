"""Read the Markdown pages of the repository: headings, links, paragraphs and commands.

``python -m tests.documents.pages`` lists the external links. Tests do not open them.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

from core.page_contents import make_anchor

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
GENERATED = frozenset(
    {
        "docs/access.md",
        "docs/alarms.md",
        "docs/checks.md",
        "docs/integrator/machine-file.md",
        "docs/json.md",
        "docs/klartext-codes.md",
        "docs/language.md",
        "docs/licences.md",
        "docs/reliability.md",
        "docs/sinumerik-codes.md",
        "docs/speed.md",
        "docs/vulnerabilities.md",
    }
)
"""Pages that a program writes; their sentences and tables come from its source."""
TRANSLATED_FOLDER = "docs/guide/es/"
"""Folder of the pages in Spanish, to which rules about English words do not apply."""
_FENCE = re.compile(r"^\s*```\s*(\w*)")
_ITEM = re.compile(r"^\s*(?:[-*+]|\d+\.)\s+")
_LINK = re.compile(r"!?\[(?:[^\]`]|`[^`]*`)*\]\(([^)\s]+)\)")
_HEADING = re.compile(r"^(#{1,6}) (.+?)\s*$")
_SPAN = re.compile(r"`[^`]+`")
_LEAD = re.compile(r"^\*\*[^*]+[.:]\*\*")
_SHORT = re.compile(r"\b(?:e\.g|i\.e|etc|vs|No|approx)\.")
_END = re.compile(r"[.!?…][)\"”*]*(?=\s|$)")


class Line(NamedTuple):
    """A line of a page: number from 1, text, and the language of its code block or None."""

    number: int
    text: str
    code: str | None


class Paragraph(NamedTuple):
    """Text between blank lines, or one list item, with the number of its first line."""

    number: int
    text: str

    @property
    def sentences(self) -> int:
        """Number of sentences, without a lead in bold; code and links count as words."""
        plain = _SHORT.sub("x", _SPAN.sub("x", _LINK.sub("x", self.text)))
        return len(_END.findall(_LEAD.sub("", plain)))


class Command(NamedTuple):
    """A shell command of a page, with the number of its line and whether it is complete."""

    number: int
    text: str
    complete: bool


@dataclass(frozen=True)
class Page:
    """One Markdown page."""

    path: Path

    @property
    def name(self) -> str:
        """Path from the root of the repository."""
        return self.path.relative_to(ROOT).as_posix()

    @cached_property
    def text(self) -> str:
        """The whole text."""
        return self.path.read_text(encoding="utf-8")

    @cached_property
    def lines(self) -> list[Line]:
        """All lines; the fences of code blocks belong to the code."""
        found, code = [], None
        for number, text in enumerate(self.text.splitlines(), 1):
            fence = _FENCE.match(text)
            if fence and code is None:
                code = fence[1]
                found.append(Line(number, text, code))
            else:
                found.append(Line(number, text, code))
                code = None if fence else code
        return found

    @property
    def headings(self) -> Iterator[tuple[int, int, str]]:
        """Line number, level and title of each heading."""
        for line in self.lines:
            if line.code is None and (heading := _HEADING.match(line.text)):
                yield line.number, len(heading[1]), heading[2]

    @cached_property
    def anchors(self) -> frozenset[str]:
        """Anchors of the headings, and those that the page itself sets."""
        found: dict[str, int] = {}
        for _, _, title in self.headings:
            anchor = make_anchor(title)
            found[anchor] = found.get(anchor, -1) + 1
        repeated = {f"{anchor}-{n}" for anchor, most in found.items() for n in range(1, most + 1)}
        return frozenset(found) | repeated | set(re.findall(r'<a id="([^"]+)">', self.text))

    @cached_property
    def prose(self) -> str:
        """The text with empty lines in the place of code blocks, so that line numbers stay."""
        return "\n".join("" if line.code is not None else line.text for line in self.lines)

    @property
    def links(self) -> Iterator[tuple[int, str]]:
        """Line number and target of each link and picture outside of code."""
        for link in _LINK.finditer(self.prose):
            yield self.prose.count("\n", 0, link.start()) + 1, link[1]

    @property
    def paragraphs(self) -> Iterator[Paragraph]:
        """Paragraphs and list items; headings, tables, code and comments are not among them."""
        start, words = 0, list[str]()
        for line in [*self.lines, Line(0, "", None)]:
            text = line.text.strip()
            apart = line.code is not None or not text or text.startswith(("|", "<", "#"))
            if words and (apart or _ITEM.match(line.text)):
                yield Paragraph(start, " ".join(words))
                words = []
            if not apart:
                start = start if words else line.number
                words.append(_ITEM.sub("", line.text).strip() if not words else text)

    @property
    def commands(self) -> Iterator[Command]:
        """Commands in shell blocks, and those that the text names between backquotes."""
        for line in self.lines:
            if line.code == "sh" and not _FENCE.match(line.text):
                yield Command(line.number, line.text.strip(), True)
        for span in re.finditer(r"`([^`]+)`", self.prose):
            if "\n\n" not in span[1]:
                yield Command(self.prose.count("\n", 0, span.start()) + 1, " ".join(span[1].split()), False)


def pages() -> list[Page]:
    """Return all pages: those in the root folder and those in docs."""
    return [Page(path) for path in [*sorted(ROOT.glob("*.md")), *sorted(DOCS.rglob("*.md"))]]


def is_record(page: Page) -> bool:
    """Return whether a page is a decision record."""
    return page.path.parent.name == "decisions" and page.path.name != "README.md"


def main() -> None:
    """Print the external links, with their pages and lines."""
    for page in pages():
        for number, target in page.links:
            if "://" in target:
                sys.stdout.write(f"{page.name}:{number}: {target}\n")


if __name__ == "__main__":
    main()
