"""Keys are declared on attributes: their schema, and the object that holds their values."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import pytest

from core.key_declaration import (
    FileUnit,
    KeyRange,
    Pair,
    ValueKind,
    Words,
    declare_key,
    get_declared_keys,
    make_key_table,
)
from core.table_schema import FileValues, read_table_values


@make_key_table
class Line:
    """A table with a key of each form."""

    port: str = declare_key(meaning="Port.")
    reply: float = declare_key(
        KeyRange(0.01, 2.0, FileUnit.MILLISECONDS), name="reply_ms", default=0.2, meaning="Time."
    )
    parity: str = declare_key(default="N", choices=("N", "E"), meaning="Parity.")
    range: Pair = declare_key(KeyRange(0.0, 50.0, FileUnit.LENGTH), default=(0.0, 1.0), meaning="Range.")
    words: Words = declare_key(default="", is_secret=True, meaning="Words.")
    others: tuple[str, ...] = ()


class Plain:
    """Keys of a table that is read into no object of its own."""

    port: str = declare_key(meaning="Port.")
    count: int = declare_key(KeyRange(1, 9), is_derived=True, meaning="Count.")


def found(table: object) -> list[tuple[str, str]]:
    return [(each.path, each.code) for each in read_table_values(table, Line, "line", FileValues(True))]


def test_annotation_sets_kind_of_key() -> None:
    kinds = [(each.key, each.kind) for each in get_declared_keys(Line)]
    assert kinds == [
        ("port", ValueKind.TEXT),
        ("reply_ms", ValueKind.NUMBER),
        ("parity", ValueKind.CHOICE),
        ("range", ValueKind.PAIR),
        ("words", ValueKind.WORDS),
    ]
    assert [(each.key, each.is_derived) for each in get_declared_keys(Plain)] == [
        ("port", False),
        ("count", True),
    ]


def test_the_reader_fills_the_object_in_units_of_the_model() -> None:
    values = FileValues(True)
    table = {"port": "tty0", "reply_ms": 500, "range": [0, 1], "words": ["one", "two"]}
    assert read_table_values(table, Line, "line", values) == []
    line = values.make_model(Line, "line", others=("more",))
    assert line == Line("tty0", 0.5, "N", (0.0, 25.4), "one two", ("more",))


def test_defaults_are_those_of_the_file() -> None:
    assert Line("tty0") == Line("tty0", 0.2, "N", (0.0, 1.0), "")


def test_all_mistakes_are_reported_together() -> None:
    wrong = {"prot": "tty0", "reply_ms": 5000, "parity": "O", "range": [2, 1], "words": ["a b"]}
    assert found(wrong) == [
        ("line.prot", "unknown-key"),
        ("line.port", "missing"),
        ("line.reply_ms", "wrong-value"),
        ("line.parity", "wrong-value"),
        ("line.range", "wrong-value"),
        ("line.words", "wrong-value"),
    ]
    assert found("tty0") == [("line", "not-a-table")]


def test_attribute_name_is_not_a_key() -> None:
    assert ("line.reply", "unknown-key") in found({"port": "tty0", "reply": 5})


def test_secret_is_not_printed_and_object_is_frozen() -> None:
    line = Line("tty0", words="token")
    assert "token" not in repr(line)
    with pytest.raises(dataclasses.FrozenInstanceError):
        line.port = "tty1"  # type: ignore[misc]


def test_annotation_of_unknown_kind_raises_key_error() -> None:
    class Wrong:
        file: Path = declare_key(meaning="File.")

    with pytest.raises(KeyError):
        get_declared_keys(Wrong)


def test_missing_required_value_raises_type_error() -> None:
    with pytest.raises(TypeError):
        Line()  # type: ignore[call-arg]
