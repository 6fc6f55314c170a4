"""The key watcher: which raw keys it sends, and what it makes of records."""

from __future__ import annotations

import socket
from collections.abc import Iterator
from dataclasses import dataclass
from typing import cast

import pytest

from app.desk.stop_keys.key_watcher import KeyWatcher
from app.desk.stop_keys.raw_keys import RawKey, RawKeyReader
from app.desk.stop_keys.stop_records import (
    MAX_RECORD_BYTES,
    FocusRecord,
    StopKeyPress,
    StopKind,
    make_press_number,
)

PAUSE, SCROLL_LOCK, ESC, SPACE = 127, 78, 9, 65
OURS, OTHER = 0x600007, 0x800001


@dataclass
class Keys:
    """A source of events whose window in front is chosen by the test."""

    front: int = OURS
    escape: int = ESC

    def find_focus_window(self) -> int:
        return self.front

    def find_escape_code(self) -> int:
        return self.escape


@dataclass
class Bench:
    watcher: KeyWatcher
    keys: Keys
    control: socket.socket
    screen: socket.socket

    def show(self, focus: FocusRecord) -> None:
        self.screen.send(focus.to_bytes())
        assert self.watcher.read_focus_records()

    def sent(self) -> list[StopKeyPress]:
        """What the control got, which the screen learns too."""
        found: dict[str, list[StopKeyPress]] = {}
        for name, end in (("control", self.control), ("screen", self.screen)):
            found[name] = []
            try:
                while record := end.recv(MAX_RECORD_BYTES, socket.MSG_DONTWAIT):
                    found[name].append(StopKeyPress.from_bytes(record))
            except BlockingIOError:
                pass
        assert found["control"] == found["screen"]
        return found["control"]


@pytest.fixture
def bench() -> Iterator[Bench]:
    line, control = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    theirs, screen = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    keys = Keys()
    with line, control, theirs, screen:
        yield Bench(KeyWatcher(cast("RawKeyReader", keys), line, theirs), keys, control, screen)


HERE = FocusRecord(frozenset({OURS}), is_esc_stop_key=False)
MOVING = FocusRecord(frozenset({OURS}), is_esc_stop_key=True)


@pytest.mark.parametrize(("code", "kind"), [(PAUSE, StopKind.HOLD), (SCROLL_LOCK, StopKind.ESTOP)])
def test_stop_key_press_is_sent_with_its_press_number(bench: Bench, code: int, kind: StopKind) -> None:
    bench.show(HERE)
    bench.watcher.handle_key_press(RawKey(code, 5000))
    assert bench.sent() == [StopKeyPress(kind, make_press_number(code, 5000))]


def test_each_press_has_a_different_number(bench: Bench) -> None:
    bench.show(HERE)
    for stamp in (5000, 5100):
        bench.watcher.handle_key_press(RawKey(PAUSE, stamp))
    first, second = bench.sent()
    assert first.press_number != second.press_number


@pytest.mark.parametrize("code", [SPACE, ESC, 38, 66])
def test_no_other_key_is_sent(bench: Bench, code: int) -> None:
    bench.show(HERE)
    bench.watcher.handle_key_press(RawKey(code, 5000))
    assert bench.sent() == []


@pytest.mark.parametrize("front", [OTHER, 0, 1])
def test_stop_key_is_not_sent_while_another_program_has_the_keyboard(bench: Bench, front: int) -> None:
    bench.show(MOVING)
    bench.keys.front = front
    for code in (PAUSE, SCROLL_LOCK, ESC):
        bench.watcher.handle_key_press(RawKey(code, 5000))
    assert bench.sent() == []


def test_stop_key_is_not_sent_before_the_window_opens(bench: Bench) -> None:
    bench.watcher.handle_key_press(RawKey(PAUSE, 5000))
    assert bench.sent() == []


def test_esc_is_sent_only_with_motion_and_the_current_keyboard_layout(bench: Bench) -> None:
    bench.show(MOVING)
    bench.watcher.handle_key_press(RawKey(ESC, 5000))
    assert [each.stop_kind for each in bench.sent()] == [StopKind.ESC]
    bench.keys.escape = 66
    bench.watcher.handle_key_press(RawKey(ESC, 5100))
    assert bench.sent() == []


def test_key_watcher_ends_when_the_screen_closes(bench: Bench) -> None:
    bench.screen.close()
    assert not bench.watcher.read_focus_records()


def test_key_watcher_ends_if_the_screen_closes_with_unread_data(bench: Bench) -> None:
    bench.show(HERE)
    bench.watcher.handle_key_press(RawKey(PAUSE, 5000))
    bench.screen.close()
    assert not bench.watcher.read_focus_records()


def test_key_watcher_continues_after_the_control_has_ended(bench: Bench) -> None:
    bench.show(HERE)
    bench.control.close()
    bench.watcher.handle_key_press(RawKey(PAUSE, 5000))
    assert StopKeyPress.from_bytes(bench.screen.recv(MAX_RECORD_BYTES)).stop_kind is StopKind.HOLD


@pytest.mark.parametrize("record", [b"", b"1", bytes(8), bytes(10), b"\x09" + bytes(8)])
def test_invalid_stop_record_is_rejected(record: bytes) -> None:
    with pytest.raises(ValueError, match="not a"):
        StopKeyPress.from_bytes(record)


@pytest.mark.parametrize("record", [b"", b"12", bytes(4)])
def test_invalid_focus_record_is_rejected(record: bytes) -> None:
    with pytest.raises(ValueError, match="not a"):
        FocusRecord.from_bytes(record)


def test_records_are_decoded_as_they_were_encoded() -> None:
    focus, stop = (
        FocusRecord(frozenset({OURS, OTHER}), is_esc_stop_key=True),
        StopKeyPress(StopKind.ESC, make_press_number(9, 2**32 - 1)),
    )
    assert FocusRecord.from_bytes(focus.to_bytes()) == focus
    assert StopKeyPress.from_bytes(stop.to_bytes()) == stop


def test_key_event_without_a_timestamp_has_press_number_zero() -> None:
    assert make_press_number(PAUSE, 0) == 0
