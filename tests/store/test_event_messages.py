"""Texts of the log keep template and values; a damaged or older one is shown as it was stored."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from pathlib import Path

import pytest

from core.message import Message, pack_message, unpack_message
from core.store.store import Store
from core.store.store_file import STORE_FILE_NAME

CAUSE = Message("{axis} is {distance} off its setpoint", axis="Z", distance=2.1)
LINE = Message("{number} {alarm}: {cause}", number=102, alarm="FOLLOWING ERROR", cause=CAUSE)


def test_event_retains_the_values_of_its_text(tmp_path: Path) -> None:
    with Store.open(tmp_path) as store:
        store.events.log_event("alarm", LINE, 4).result()
        store.events.log_event("start", "pin.nc").result()
    with Store.open(tmp_path) as store:
        start, alarm = store.events.read_events()
    assert type(start.text) is str
    assert isinstance(alarm.text, Message)
    assert (alarm.text, alarm.text.template) == (LINE, LINE.template)
    cause = alarm.text.values["cause"]
    assert isinstance(cause, Message)
    assert cause.values == {"axis": "Z", "distance": 2.1}


def test_a_search_finds_the_english_text(tmp_path: Path) -> None:
    with Store.open(tmp_path) as store:
        store.events.log_event("alarm", LINE).result()
        assert [row.text for row in store.events.read_events("off its")] == [LINE]
        assert store.events.read_events("template") == ()


@pytest.mark.parametrize(
    "packed",
    [
        "{",
        "7",
        "{}",
        '{"template": "{a}", "values": {}, "case": ""}',
        pack_message(Message("another {a}", a=1)),
    ],
)
def test_a_message_that_does_not_fit_its_text_is_not_used(tmp_path: Path, packed: str) -> None:
    with Store.open(tmp_path) as store:
        store.events.log_event("alarm", LINE).result()
    with closing(sqlite3.connect(tmp_path / STORE_FILE_NAME)) as connection:
        connection.execute("UPDATE events SET message = ?", (packed,))
        connection.commit()
    with Store.open(tmp_path) as store:
        [event] = store.events.read_events()
    assert (event.text, type(event.text)) == (str.__str__(LINE), str)


@pytest.mark.parametrize(
    "text", [LINE, LINE.upper(), CAUSE.lower(), CAUSE.capitalize(), CAUSE.capitalize_first_letter(), "plain"]
)
def test_packed_message_is_unpacked_unchanged(text: str) -> None:
    made = unpack_message(pack_message(text), str.__str__(text))
    assert made == text
    assert getattr(made, "case", "") == getattr(text, "case", "")
