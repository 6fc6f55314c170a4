"""The files of the code books: what an entry can contain, what is rejected, and that each is packaged."""

from __future__ import annotations

import configparser
import subprocess
import sys
from pathlib import Path

import pytest

from core.language.code_book import CodeBook
from core.language.code_book_files import CODE_BOOKS_FOLDER, read_code_book

HOUSE = Path(__file__).parents[2]
FRAME = """
comment = ";"
head = "BEGIN"
tail = "END"
subjects = ["codes"]
"""
CODE = """
[[Codes]]
head = "G1"
what = "Straight line."
example = "G1 X5 F2"
refused = "G1 F-1"
why = "F"
"""


def book(folder: Path, codes: str, **further: str) -> CodeBook:
    """Return the book of a file with these codes; each of ``further`` is a file that follows."""
    names = ", ".join(f'"{name}"' for name in ("codes", *further))
    (folder / "book.toml").write_text(FRAME.replace('"codes"', names), encoding="utf-8")
    for name, text in {"codes": codes, **further}.items():
        (folder / f"{name}.toml").write_text(text, encoding="utf-8")
    return read_code_book(folder)


def test_entry_has_values_of_its_file(tmp_path: Path) -> None:
    found = book(tmp_path, CODE)
    assert (found.head, found.lines_after_example, found.comment_sign) == ("BEGIN\n", "END\n", ";")
    (entry,) = found.entries
    assert (entry.form, entry.what, entry.example) == ("G1", "Straight line.", "G1 X5 F2")
    assert (entry.refused, entry.why, entry.written, entry.whole) == ("G1 F-1", "F", "G1", False)


def test_entry_text_is_composed_of_parts_and_other_texts(tmp_path: Path) -> None:
    codes = """
    [parts]
    start = "T1"
    there = '''
{start}
G0 X1
'''
    [[Codes]]
    head = "G1"
    what = '''
Straight
line.
'''
    insert = "{head} X2"
    example = "{there}\\n{insert}"
    behind = "{start}"
    files = { "A.H" = "{insert}" }
    """
    (entry,) = book(tmp_path, codes).entries
    assert entry.what == "Straight line."
    assert entry.example == "T1\nG0 X1\nG1 X2"
    assert (entry.behind, entry.written, entry.files) == ("T1\n", "G1 X2", (("A.H", "G1 X2\n"),))


def test_heads_share_entry_and_default_texts(tmp_path: Path) -> None:
    codes = """
    [usual]
    example = "{head}"
    refused = "{head} {head}"
    why = "twice"
    [[Codes]]
    heads = ["M3", "M4"]
    what = "Spindle."
    [[Codes]]
    head = "M6"
    what = "Tool."
    refused = { "M" = "M6 M" }
    """
    found = book(tmp_path, codes).entries
    assert [each.head for each in found] == ["M3", "M4", "M6"]
    assert [each.example for each in found] == ["M3", "M4", "M6"]
    assert [each.refused for each in found] == ["M3 M3", "M4 M4", "M6 M6"]


def test_a_chapter_continues_in_the_next_file(tmp_path: Path) -> None:
    more = CODE.replace("G1", "G2") + "[meanings]\nF = 'feed'\n"
    found = book(tmp_path, CODE, more=more)
    assert [(title, [each.head for each in entries]) for title, entries in found.chapters] == [
        ("Codes", ["G1", "G2"])
    ]
    assert found.word_meanings == {"F": "feed"}


@pytest.mark.parametrize(
    ("before", "after", "named"),
    [
        ('why = "F"', 'whi = "F"', "whi"),
        ('why = "F"', "why = 3", "why"),
        ('why = "F"', "", "why"),
        ('refused = "G1 F-1"', "", "refused"),
        ('refused = "G1 F-1"', 'refused = { "F7" = "F-1" }', "F7"),
        ('what = "Straight line."', "", "what"),
        ('head = "G1"', "", "head"),
        ('head = "G1"', 'heads = "G1"', "heads"),
        ('"G1 X5 F2"', '"G1 {place}"', "{place}"),
        ('"G1 X5 F2"', '"{example}"', "{example}"),
        ('"G1 X5 F2"', '"G1', "line 5"),
        ("G1 X5 F2", "G1 X5\\q", "line 5"),
    ],
)
def test_an_entry_that_is_wrong_is_rejected(tmp_path: Path, before: str, after: str, named: str) -> None:
    assert before in CODE
    with pytest.raises(ValueError, match=r"codes\.toml: ") as raised:
        book(tmp_path, CODE.replace(before, after))
    assert named in str(raised.value)


def test_a_code_with_two_entries_is_rejected(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="G1: "):
        book(tmp_path, CODE, more=CODE)


@pytest.mark.parametrize("path", sorted(CODE_BOOKS_FOLDER.rglob("*.*")), ids=lambda path: path.name)
def test_each_file_is_part_of_a_book_and_of_the_package(path: Path) -> None:
    frame = (path.parent / "book.toml").read_text(encoding="utf-8")
    assert path.stem == "book" or f'"{path.stem}"' in frame
    config = configparser.ConfigParser()
    config.read(HOUSE / "setup.cfg", encoding="utf-8")
    patterns = config["options.package_data"]["core.language"].split()
    assert any(path.relative_to(CODE_BOOKS_FOLDER.parent).match(pattern) for pattern in patterns)


def test_code_books_are_not_loaded_before_use() -> None:
    script = "import sys, app.cli.main, core.interpreter.dialects; print(*sys.modules)"
    loaded = subprocess.run(
        [sys.executable, "-c", script], cwd=HOUSE, capture_output=True, text=True, check=True
    ).stdout.split()
    assert "core.interpreter.dialects" in loaded
    assert "core.language.code_book_files" not in loaded
