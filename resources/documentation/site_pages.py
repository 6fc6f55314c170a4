"""Pages of the documentation site: their files, their navigation by reader, and their Markdown.

The pages are written for GitHub. Two of its rules differ from those of MkDocs, and ``convert_lists`` adapts
the text: content of a list item may be indented by two or three spaces, and a list may follow a paragraph
without a blank line.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path, PurePosixPath
from typing import NamedTuple

Navigation = list[dict[str, "str | Navigation"]]
"""Entries of the navigation: a title with the path of its page or with the entries below it."""

INDEX_PATH = PurePosixPath("docs/index.md")
DECISIONS_PATH = PurePosixPath("docs/decisions/README.md")
_LINK = re.compile(r"\[((?:[^\]`]|`[^`]*`)*)\]\(([^)\s]+)\)")
_ITEM = re.compile(r"(\s*)((?:[-*+]|\d+\.)\s+)\S")
_NUMBER = re.compile(r"^(\d+)\.(?=\s)")
_FENCE = re.compile(r"\s*```")
_LIST_INDENT = 4
"""Indent that MkDocs expects for the content of a list item, in spaces per level."""


class _Item(NamedTuple):
    """List item: the indent of its mark, and the column at which its content begins."""

    indent: int
    column: int


def list_site_files(project_folder: Path) -> list[PurePosixPath]:
    """Return the paths of all pages and of all files that they show or link to, from the project folder."""
    pages = [*project_folder.glob("*.md"), *(project_folder / "docs").rglob("*.md")]
    found = {page.resolve() for page in pages}
    for page in pages:
        for _, target in _LINK.findall(page.read_text(encoding="utf-8")):
            file = target.partition("#")[0]
            if file and "://" not in target and (page.parent / file).is_file():
                found.add((page.parent / file).resolve())
    return sorted(PurePosixPath(path.relative_to(project_folder.resolve())) for path in found)


def make_navigation(project_folder: Path) -> Navigation:
    """Return the navigation: the start page, the pages of each reader, and the list of all documents.

    The readers and their pages are the chapters and the tables of ``docs/index.md``. A page that is listed
    for several readers is in the chapter of the first one.
    """
    index = (project_folder / INDEX_PATH).read_text(encoding="utf-8")
    used: set[str] = set()
    navigation: Navigation = [{"TurnDesk": "README.md"}]
    for chapter in index.split("\n## ")[1:]:
        title, _, text = chapter.partition("\n")
        entries: Navigation = []
        for entry in _list_entries(text, INDEX_PATH, used):
            entries.append(_with_decisions(entry, project_folder, used))
        if entries:
            navigation.append({title: entries})
    return [*navigation, {"All documents": str(INDEX_PATH)}]


def _list_entries(text: str, page: PurePosixPath, used: set[str]) -> Iterator[dict[str, str | Navigation]]:
    """Yield an entry for each page that the tables link to and that is not in ``used``, and add it there."""
    for line in text.splitlines():
        for title, target in _LINK.findall(line) if line.startswith("|") else ():
            path = _resolve(page, target)
            if path.endswith(".md") and path not in used:
                used.add(path)
                yield {title.replace("`", ""): path}


def _with_decisions(
    entry: dict[str, str | Navigation], project_folder: Path, used: set[str]
) -> dict[str, str | Navigation]:
    """Return the entry; if it is the index of the decision records, add the records below it."""
    if str(DECISIONS_PATH) not in entry.values():
        return entry
    text = (project_folder / DECISIONS_PATH).read_text(encoding="utf-8")
    records = list(_list_entries(text, DECISIONS_PATH, used))
    return {next(iter(entry)): [{"Index": str(DECISIONS_PATH)}, *records]}


def _resolve(page: PurePosixPath, target: str) -> str:
    """Return the path of a link's target from the project folder."""
    parts: list[str] = []
    for part in (page.parent / target.partition("#")[0]).parts:
        if part == "..":
            parts.pop()
        else:
            parts.append(part)
    return "/".join(parts)


def convert_lists(text: str) -> str:
    """Return the page with lists as MkDocs expects them, with four spaces for each level.

    A blank line is inserted before an item that follows a paragraph directly.
    """
    lines: list[str] = []
    items: list[_Item] = []  # the open list items, from the outermost to the innermost
    in_code = has_paragraphs = False
    for line in text.splitlines():
        if not line.strip():
            lines.append("")
            has_paragraphs = True
            continue
        indent = len(line) - len(line.lstrip())
        was_in_list, is_sibling = bool(items), False
        while items and indent < items[-1].column and not in_code:
            is_sibling = items.pop().indent == indent
        begins_block = is_sibling or not lines or not lines[-1]
        item = None if in_code else _find_item(line, begins_block)
        if item and (has_paragraphs or not was_in_list) and lines and lines[-1]:
            lines.append("")
        rest = max(0, indent - (items[-1].column if items else 0))
        content = line.lstrip() if item or in_code else _NUMBER.sub(r"\1\.", line.lstrip())
        lines.append(" " * (len(items) * _LIST_INDENT + rest) + content)
        if item:
            items.append(item)
            has_paragraphs = False
        if _FENCE.match(line):
            in_code = not in_code
    return "\n".join(lines) + "\n"


def _find_item(line: str, begins_block: bool) -> _Item | None:
    """Return the list item that starts in a line, or None if the line does not start an item.

    As on GitHub, a number other than 1 within a paragraph does not start an item.
    """
    found = _ITEM.match(line)
    if found is None or not (begins_block or found[2].strip() in {"-", "*", "+", "1."}):
        return None
    return _Item(len(found[1]), len(found[1]) + len(found[2]))
