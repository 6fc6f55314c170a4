"""Sections of the guide that the screen shows as help."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.desk.pages.field_help import FIELD_TEXTS, make_field_help
from app.desk.pages.guide_text import (
    BlockKind,
    GuideBlock,
    find_guide_folder,
    read_function_help,
    read_page_help,
    read_section,
    strip_marks,
)
from core.interpreter.dialects import get_code_book
from core.language.source import Dialect
from core.store.store_rows import FIELDS_BY_KIND, OffsetKind

PAGE = """# Title

## First

One line
and **another** [link](x.md).

1. Press `F2`,
   then `Y`.

| key | action |
|---|---|
| `A` | Do it |

### Part of first

![Picture](../pictures/jog.png)

| key | findings | stock |
|---|---|---|
| `B` | – | Open |

## Second

Not this.
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "guide").mkdir()
    (tmp_path / "guide" / "page.md").write_text(PAGE, encoding="utf-8")
    monkeypatch.setattr("app.desk.pages.guide_text.find_guide_folder", lambda: tmp_path)
    return tmp_path


def test_a_section_ends_at_the_next_heading_of_its_level(folder: Path) -> None:
    assert read_section("guide/page.md", "First") == (
        GuideBlock(BlockKind.TEXT, "One line and another link."),
        GuideBlock(BlockKind.TEXT, "1. Press F2, then Y."),
        GuideBlock(BlockKind.KEY, "Do it", "A"),
        GuideBlock(BlockKind.HEADING, "Part of first"),
        GuideBlock(BlockKind.PICTURE, str(folder / "pictures" / "jog.png")),
        GuideBlock(BlockKind.KEY, "stock: Open", "B"),
    )


@pytest.mark.parametrize("heading", ["Third", "", "first"])
def test_an_unknown_heading_has_no_section(folder: Path, heading: str) -> None:
    assert read_section("guide/page.md", heading) == ()


def test_a_missing_file_has_no_sections(folder: Path) -> None:
    assert read_section("guide/other.md", "First") == ()


@pytest.mark.parametrize("language", ["en", "es"])
def test_an_unknown_page_has_no_help(language: str) -> None:
    assert read_page_help("NO SUCH PAGE", language) == ()


@pytest.mark.parametrize("language", ["en", "es"])
def test_pictures_of_the_guide_exist(language: str) -> None:
    pictures = [block.text for block in read_page_help("JOG", language) if block.kind is BlockKind.PICTURE]
    assert pictures
    assert all(Path(path).is_file() for path in pictures)
    assert find_guide_folder().is_dir()


def test_a_special_function_is_found_by_its_name() -> None:
    address, first, *_ = read_function_help("DRIVE STATUS", "en")
    assert address == GuideBlock(BlockKind.ADDRESS, "docs/guide/special-functions.html#4-drive-status")
    assert first.text.startswith("For each axis")
    address, first, *_ = read_function_help("DRIVE STATUS", "es")
    assert address.text.startswith("docs/guide/es/special-functions.html#4-")
    assert first.text.startswith("De cada eje")


@pytest.mark.parametrize("language", ["en", "es", "fr"])
def test_an_unknown_special_function_has_no_help(language: str) -> None:
    assert read_function_help("NO SUCH FUNCTION", language) == ()


def test_a_language_without_a_guide_has_no_help() -> None:
    assert read_function_help("DRIVE STATUS", "fr") == ()
    assert read_page_help("JOG", "fr") == ()


def test_spanish_help_is_the_section_in_the_same_place() -> None:
    """The English page has `F9` and `F10` of MDI in one row, and the Spanish page the same row."""
    keys = {block.key: block.text for block in read_page_help("MDI", "es") if block.kind is BlockKind.KEY}
    assert keys["F8 PARO HUS"] == "Parar el husillo"
    assert "F9 CORR SEC, F10 OSCILO" in keys


def test_marks_of_markdown_are_removed() -> None:
    assert strip_marks("**Press** `F2` in [Jog](jog.md#x).") == "Press F2 in Jog."


@pytest.mark.parametrize("kind", OffsetKind)
def test_every_field_of_every_offset_table_is_explained(kind: OffsetKind) -> None:
    assert FIELDS_BY_KIND[kind].keys() - FIELD_TEXTS[kind].keys() == set()


@pytest.mark.parametrize("name", ["", "no such field"])
def test_an_unknown_field_has_no_help(name: str) -> None:
    assert make_field_help(OffsetKind.TOOL, name, "T1  X?") == ()


@pytest.mark.parametrize(
    ("line", "heads"), [("G01 X1 F.005 M08", ["G01", "M08"]), ("(G01)", []), ("", []), ("G01 G01", ["G01"])]
)
def test_each_code_of_a_line_is_listed_once(line: str, heads: list[str]) -> None:
    listed = [entry.head for entry in get_code_book(Dialect.OMNITURN).list_codes(line)]
    assert [head for head in listed if head[0] in "GM"] == heads
