"""The lines of a long text are those that splitting it gives, without being kept."""

from __future__ import annotations

import pickle

import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.language import source as module
from core.language.long_lines import LazyLines
from core.language.source import ProgramSource

TEXT = st.text(st.sampled_from("X1.\n "), min_size=1)


def split(text: str) -> list[str]:
    lines = text.split("\n")
    return lines if lines[-1] else lines[:-1]


@given(TEXT, st.slices(8), st.integers(-9, 9))
def test_lazy_lines_match_lines_of_text(text: str, at: slice, one: int) -> None:
    lines, known = LazyLines(text), split(text)
    assert (len(lines), list(lines), list(lines[at])) == (len(known), known, known[at])
    if -len(known) <= one < len(known):
        assert lines[one] == known[one]
    else:
        with pytest.raises(IndexError):
            lines[one]
    assert list(pickle.loads(pickle.dumps(lines))) == known
    if known:
        assert lines.join_lines(range(len(known))) == "\n".join(known)


@pytest.mark.parametrize(
    ("text", "kept"),
    [("X1\nZ2\n", False), ("X1\r\nZ2\r\n", True), ("(\N{DEGREE SIGN})\nZ2\n", True), ("X", True)],
)
def test_only_long_ascii_text_is_split_lazily(text: str, kept: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "_LONG", 2)
    source = ProgramSource("A", text)
    assert isinstance(source.lines, tuple) is kept
    assert [*source.lines] == text.replace("\r", "").removesuffix("\n").split("\n")


def test_short_program_stores_its_lines() -> None:
    assert ProgramSource("A", "X1\nZ2\n").lines == ("X1", "Z2")
