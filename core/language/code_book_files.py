"""Reader of code books.

A folder ``code_books/LANGUAGE`` contains ``book.toml`` and one TOML file per subject.

- Each table ``[["Title of the chapter"]]`` is one entry with the fields of ``CodeBookEntry`` as keys.
- A chapter may continue in the next file.
- ``heads`` instead of ``head`` makes one entry for each head.
- ``{name}`` in a text is replaced by the text of that name in ``[parts]``, or by that field of the
  entry.
- ``[usual]`` contains default texts of the entries.
- ``refused`` may be a table of replacements, with which the example must be rejected.
- ``[meanings]`` explains the words that follow codes.
"""

from __future__ import annotations

import re
import tomllib
from collections import ChainMap, Counter
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from core.language.code_book import CodeBook, CodeBookEntry

CODE_BOOKS_FOLDER = Path(__file__).with_name("code_books")

_TEXTS = dict.fromkeys(("head", "words", "what", "example", "refused", "why", "behind", "insert"), "")
_KINDS: Mapping[str, type | tuple[type, ...]] = {
    **dict.fromkeys(_TEXTS, str),
    "heads": list,
    "refused": (str, dict),
    "whole": bool,
    "files": dict,
}
"""Types of the values of an entry, by key."""

_PLACEHOLDER = re.compile(r"\{(\w+)\}")


def read_code_book(folder: Path) -> CodeBook:
    """Return the code book of a folder.

    Raises ValueError if an entry is invalid or a code has more than one entry. The message names the code
    and, for an invalid entry, the file.
    """
    frame = tomllib.loads((folder / "book.toml").read_text(encoding="utf-8"))
    chapters: dict[str, list[CodeBookEntry]] = {}
    meanings: dict[str, str] = {}
    for path in (folder / f"{subject}.toml" for subject in frame["subjects"]):
        try:
            _read_subject(path.read_text(encoding="utf-8"), chapters, meanings)
        except ValueError as error:
            raise ValueError(f"{path.name}: {error}") from error
    _check_once([entry.head for entries in chapters.values() for entry in entries])
    return CodeBook(
        tuple((title, tuple(entries)) for title, entries in chapters.items()),
        head=_program(frame["head"]),
        lines_after_example=_program(frame["tail"]),
        comment_sign=frame["comment"],
        word_meanings=meanings,
    )


def _read_subject(text: str, chapters: dict[str, list[CodeBookEntry]], meanings: dict[str, str]) -> None:
    """Add the entries and meanings of a file to the book."""
    tables = tomllib.loads(text)
    parts, usual = tables.pop("parts", {}), tables.pop("usual", {})
    meanings |= tables.pop("meanings", {})
    for title, rows in tables.items():
        entries = (entry for row in rows for entry in _entries(row, usual, parts))
        chapters.setdefault(title, []).extend(entries)


def _entries(row: dict[str, Any], usual: dict[str, Any], parts: dict[str, str]) -> Iterator[CodeBookEntry]:
    """Yield the entry of each head of a row. Raises ValueError if the row is invalid."""
    for head in row.get("heads") or [row.get("head", "")]:
        try:
            yield _entry({**_TEXTS, **usual, **row, "head": head}, parts)
        except ValueError as error:
            raise ValueError(f"{head}: {error}") from error


def _entry(row: dict[str, Any], parts: dict[str, str]) -> CodeBookEntry:
    if wrong := [key for key, value in row.items() if not isinstance(value, _KINDS.get(key, ()))]:
        raise ValueError(f"{wrong[0]} is an unknown key, or its value is of the wrong kind")
    known = ChainMap(row, parts)
    texts = {key: _fill_placeholders(value, known) for key, value in row.items() if isinstance(value, str)}
    texts["what"] = " ".join(texts["what"].split())
    texts["behind"] = _program(texts["behind"])
    if not (texts["head"] and texts["what"]):
        raise ValueError("head or what is missing")
    if isinstance(row["refused"], dict):
        texts["refused"] = _replace_pieces(texts["example"], row["refused"])
    if bool(texts["refused"]) != bool(texts["why"]):
        raise ValueError("refused and why must be together")
    files = tuple(
        (name, _program(_fill_placeholders(text, known))) for name, text in row.get("files", {}).items()
    )
    return CodeBookEntry(**texts, whole=row.get("whole", False), files=files)


def _fill_placeholders(text: str, known: Mapping[str, Any]) -> str:
    """Return a text with its placeholders replaced, and without leading and trailing line breaks."""
    if "{" not in text:
        return text.strip("\n")

    def get_placeholder_text(hole: re.Match[str]) -> str:
        found = known.get(hole[1])
        if isinstance(found, str):
            return _fill_placeholders(found, {name: each for name, each in known.items() if name != hole[1]})
        raise ValueError(f"{hole[0]} has no text")

    return _PLACEHOLDER.sub(get_placeholder_text, text).strip("\n")


def _replace_pieces(example: str, pieces: Mapping[str, str]) -> str:
    """Return the example after replacing each key of ``pieces`` with its value.

    Raises ValueError if the example does not contain one of the keys.
    """
    for before, after in pieces.items():
        if before not in example:
            raise ValueError(f"the example does not contain {before}")
        example = example.replace(before, after)
    return example


def _program(text: str) -> str:
    """Return the lines of a program as one text that ends with a line break."""
    return text.strip("\n") + "\n" if text else ""


def _check_once(heads: list[str]) -> None:
    """Raise ValueError if a code has more than one entry."""
    if twice := [head for head, times in Counter(heads).items() if times > 1]:
        raise ValueError(f"{', '.join(twice)}: each code must have only one entry")
