"""Sections of the user's guide that the screen shows as help, read from the Markdown files of the guide.

A wheel contains these files in ``resources/guide``. In a clone, they are in ``docs``.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import Enum
from functools import cache
from importlib.resources import files
from pathlib import Path

from app.desk.translation import ENGLISH_CODE
from core.page_contents import make_anchor

REFERENCE_FILE, FUNCTIONS_FILE = "guide/screen.md", "guide/special-functions.md"
COMMON_KEYS, ALARM_LOG = "EVERY PAGE", "ALARMS AND STOPS"  # Topics that are not pages.
# Headings of the English reference by page name.
_PAGE_HEADINGS = {
    COMMON_KEYS: "Keys that act on every page",
    ALARM_LOG: "Alarms and stops, F7",
    "MAIN MENU": "Main menu, F1",
    "AUTOMATIC": "Automatic",
    "EDITOR": "Editor",
    "MDI": "MDI",
    "JOG": "Jog",
    "SEARCHTO": "SEARCHTO",
    "PROGRAMS": "Programs",
    "JOBS": "Jobs",
    "SHARED PROGRAMS": "Shared programs",
    "TOOL OFFSETS": "Tool offsets, F8",
    "TOOL SHAPE": "Tool shape",
    "SECONDARY OFFSETS": "Secondary offsets, F9",
    "ZERO OFFSETS": "Zero offsets",
    "TOOL TABLE": "Tool table and presets of a mill",
    "PRESETS": "Tool table and presets of a mill",
    "PART": "Part",
    "SPECIAL FUNCTIONS": "Special functions, F10",
    "MEASURED PARTS": "Measured parts",
    "SCOPE": "Scope",
    "ANALYSES": "Analyses",
    "DRIVE TEST": "Drive test",
}

_HEADING = re.compile(r"(#+) (.*)")
_PICTURE = re.compile(r"!\[[^\]]*\]\(([^)]+)\)")
_LINK = re.compile(r"\[([^\]]*)\]\([^)]*\)")
_LIST_ITEM = re.compile(r"\s*(-|\d+\.) +(.*)")


class BlockKind(Enum):
    """Kinds of blocks in a section of the user's guide."""

    HEADING = "heading"
    TEXT = "text"
    KEY = "key"
    PICTURE = "picture"
    ADDRESS = "address"


@dataclass(frozen=True, slots=True)
class GuideBlock:
    """One heading, paragraph, key description, picture or address of the guide.

    ``text`` of a picture is its path. ``key`` of a key description is the first cell of its table row.
    ``text`` of an address is the address of a section, from the folder of the documentation site.
    """

    kind: BlockKind
    text: str
    key: str = ""


def find_guide_folder() -> Path:
    """Return the folder with the files of the guide, which may not exist."""
    shipped = Path(str(files("resources"))) / "guide"
    return shipped if shipped.is_dir() else Path(__file__).parents[3] / "docs"


def read_page_help(topic: str, language: str) -> tuple[GuideBlock, ...]:
    """Return the section about a page in the operator's language.

    ``topic`` is the name of the page, ``COMMON_KEYS`` or ``ALARM_LOG``. The result is empty if the guide
    does not describe the page.
    """
    return read_section(*_find_page_heading(topic, language))


def find_page_address(topic: str, language: str) -> str:
    """Return the address of the section about a page, or an empty string if the guide has no such section.

    The address is a path from the folder of the documentation site, with an anchor.
    """
    name, heading = _find_page_heading(topic, language)
    return make_section_address(name, heading) if heading else ""


def make_section_address(name: str, heading: str) -> str:
    """Return the address of a section of a file in ``docs``, from the folder of the documentation site."""
    return f"docs/{name.removesuffix('.md')}.html#{make_anchor(heading)}"


def _find_page_heading(topic: str, language: str) -> tuple[str, str]:
    """Return the guide file of a language and the heading of a page, which is empty for an unknown page."""
    return _find_translation(REFERENCE_FILE, _PAGE_HEADINGS.get(topic, ""), language)


def read_function_help(name: str, language: str) -> tuple[GuideBlock, ...]:
    """Return the address and the section of a special function, or an empty tuple if the guide has neither.

    ``name`` is the English name of the function.
    """
    wanted = name.casefold()
    for heading in _list_headings(find_guide_folder(), FUNCTIONS_FILE):
        if heading.lstrip("0123456789 ").casefold() == wanted:
            section = _find_translation(FUNCTIONS_FILE, heading, language)
            blocks = read_section(*section)
            return (GuideBlock(BlockKind.ADDRESS, make_section_address(*section)), *blocks) if blocks else ()
    return ()


def _find_translation(name: str, heading: str, language: str) -> tuple[str, str]:
    """Return the file and the heading of a section in a language; the heading is empty if there is none.

    ``heading`` is the English heading. The folder of a translated file has the code of the language, and
    its headings are in the same order.
    """
    if language == ENGLISH_CODE:
        return name, heading
    folder = find_guide_folder()
    path = Path(name)
    translated = (path.parent / language / path.name).as_posix()
    pairs = zip(_list_headings(folder, name), _list_headings(folder, translated), strict=False)
    return translated, dict(pairs).get(heading, "")


@cache
def _read_lines(folder: Path, name: str) -> tuple[str, ...]:
    """Return the lines of a file of the guide, or an empty tuple if the file cannot be read."""
    try:
        return tuple((folder / name).read_text(encoding="utf-8").splitlines())
    except OSError:
        return ()


@cache
def _list_headings(folder: Path, name: str) -> tuple[str, ...]:
    found = (_HEADING.fullmatch(line) for line in _read_lines(folder, name))
    return tuple(match[2] for match in found if match)


def read_section(name: str, heading: str) -> tuple[GuideBlock, ...]:
    """Return the blocks of one section of a guide file, including subsections but not its heading."""
    folder = find_guide_folder()
    return tuple(_make_blocks(_find_section(_read_lines(folder, name), heading), (folder / name).parent))


def _find_section(lines: Sequence[str], heading: str) -> list[str]:
    """Return the lines after a heading, up to the next heading of the same or a higher level."""
    found: list[str] = []
    level = 0
    for line in lines:
        match = _HEADING.fullmatch(line)
        if level and match and len(match[1]) <= level:
            break
        if level:
            found.append(line)
        elif match and match[2] == heading:
            level = len(match[1])
    return found


def _make_blocks(lines: Sequence[str], folder: Path) -> Iterator[GuideBlock]:
    """Yield the blocks of these lines. Consecutive lines of text form one paragraph."""
    text: list[str] = []
    heads: list[str] = []
    for line in (*lines, ""):
        is_row, item, other = (
            line.startswith("|"),
            _LIST_ITEM.fullmatch(line),
            _make_single_block(line, folder),
        )
        if text and (is_row or item or other or not line.strip()):
            yield GuideBlock(BlockKind.TEXT, strip_marks(" ".join(text)))
            text = []
        heads = heads if is_row else []
        if other:
            yield other
        elif is_row:
            cells = [strip_marks(cell.strip()) for cell in line.strip().strip("|").split(" | ")]
            if heads and not set(line) <= set("|-: "):
                yield _make_key(heads, cells)
            heads = heads or cells
        elif item:
            text = ["·" if item[1] == "-" else item[1], item[2]]
        elif line.strip():
            text.append(line.strip())


def _make_single_block(line: str, folder: Path) -> GuideBlock | None:
    """Return the heading or the picture that a line contains, or None if it contains something else."""
    heading, picture = _HEADING.fullmatch(line), _PICTURE.fullmatch(line.strip())
    if heading:
        return GuideBlock(BlockKind.HEADING, strip_marks(heading[2]))
    return GuideBlock(BlockKind.PICTURE, str((folder / picture[1]).resolve())) if picture else None


def _make_key(heads: Sequence[str], cells: Sequence[str]) -> GuideBlock:
    """Return the block of a table row. If the row has several actions, each is named by its column."""
    actions = [(head, cell) for head, cell in zip(heads[1:], cells[1:], strict=False) if cell != "–"]
    several = len(heads) > 2
    text = "   ".join(f"{head}: {cell}" if several else cell for head, cell in actions)
    return GuideBlock(BlockKind.KEY, text, cells[0])


def strip_marks(text: str) -> str:
    """Return the text without the Markdown marks for links, code and bold letters."""
    return _LINK.sub(r"\1", text).replace("**", "").replace("`", "").strip()
