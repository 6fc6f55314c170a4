"""Reading program files: what shops' archives hold, and what is refused with one sentence."""

from __future__ import annotations

from pathlib import Path

import pytest

from core.language.source import ProgramSource, SourceError, load_source
from tests.coded import raises_code


def write(folder: Path, data: bytes) -> Path:
    path = folder / "PART"
    path.write_bytes(data)
    return path


@pytest.mark.parametrize(
    ("data", "lines"),
    [
        (b"G90\nM30\n", ("G90", "M30")),
        (b"G90\r\nM30\r\n", ("G90", "M30")),
        (b"G90\rM30\r", ("G90", "M30")),
        (b"G90\nM30", ("G90", "M30")),
        (b"\xef\xbb\xbfG90\nM30\n", ("G90", "M30")),
        (b"G90\n\nM30\n\n", ("G90", "", "M30", "")),
        (b"G90\nM30\n\x1a", ("G90", "M30")),
        (b"G90\x0cX1\nM30\n", ("G90\x0cX1", "M30")),
    ],
    ids=["unix", "dos", "mac", "no last end", "bom", "blank lines", "dos end of file", "form feed"],
)
def test_line_ends_of_all_systems_split_lines(tmp_path: Path, data: bytes, lines: tuple[str, ...]) -> None:
    assert load_source(write(tmp_path, data)).lines == lines


@pytest.mark.parametrize(
    ("data", "comment"),
    [
        ("G90(Bohrer für Ø5)\n".encode(), "G90(Bohrer für Ø5)"),
        (b"G90(f\x81r)\n", "G90(für)"),  # code page 437
        (b"G90(f\xfcr)\n", "G90(für)"),  # Latin-1
    ],
    ids=["utf-8", "dos", "latin-1"],
)
def test_accented_characters_are_preserved(tmp_path: Path, data: bytes, comment: str) -> None:
    assert load_source(write(tmp_path, data)).lines[0] == comment


def test_unicode_line_separator_does_not_end_a_line() -> None:
    assert ProgramSource("a", "G90(a\u2028b)\nM30\n").lines == ("G90(a\u2028b)", "M30")


def test_program_name_is_file_name(tmp_path: Path) -> None:
    assert load_source(write(tmp_path, b"G90\n")).name == "PART"


@pytest.mark.parametrize(
    ("data", "code", "values"),
    [
        (b"", "file-empty", ()),
        (b" \r\n\x1a", "file-empty", ()),
        (b"\xff\xfeG\x009\x000\x00", "file-utf16", ("UTF-16",)),
        (b"\xfe\xff\x00G\x009\x000", "file-utf16", ("UTF-16",)),
        (b"G90\x00\x01\x02", "file-binary", ()),
        (b"G90\n" + b"X1" * 500_000, "line-too-long", ("Line 2 ",)),
        (b"G90\r" * 3000 + b"X" * 8193 + b"\rM30\r", "line-too-long", ("Line 3001 ", "8193")),
        (b"G90\n" * 3000 + b"X" * 8193 + b"\r\nM30\n", "line-too-long", ("Line 3001 ", "8193")),
    ],
    ids=[
        "empty",
        "blank",
        "utf-16 le",
        "utf-16 be",
        "binary",
        "one line of a megabyte",
        "by returns",
        "among others",
    ],
)
def test_file_that_is_not_a_program_is_rejected(
    tmp_path: Path, data: bytes, code: str, values: tuple[str, ...]
) -> None:
    with raises_code(SourceError, code, *values) as refused:
        load_source(write(tmp_path, data))
    assert refused.value.diagnostic.hint


@pytest.mark.parametrize("end", [b"\n", b"\r\n", b"\r"], ids=["newline", "both", "return"])
def test_line_of_8192_characters_is_accepted(tmp_path: Path, end: bytes) -> None:
    lines = load_source(write(tmp_path, (b"X" * 8192 + end) * 3 + (b"G90" + end) * 5000)).lines
    assert [len(line) for line in lines] == [8192] * 3 + [3] * 5000


def test_a_missing_file_is_refused(tmp_path: Path) -> None:
    with raises_code(SourceError, "file-unreadable") as refused:
        load_source(tmp_path / "NONE")
    assert refused.value.diagnostic.code == "file-unreadable"


def test_a_folder_is_refused(tmp_path: Path) -> None:
    with raises_code(SourceError, "file-unreadable"):
        load_source(tmp_path)


def test_a_huge_file_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "HUGE"
    with path.open("wb") as file:
        file.truncate(65 * 1024 * 1024)
    with raises_code(SourceError, "file-too-large", "64 MB"):
        load_source(path)
