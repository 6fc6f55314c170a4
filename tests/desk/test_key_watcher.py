"""The key watcher: which raw keys it sends, and what it makes of records."""

from __future__ import annotations

import socket
from collections.abc import Iterator
from dataclasses import dataclass
from typing import cast

import pytest

from app.desk.stop_keys.key_watcher import KeyWatcher
from app.desk.stop_keys.raw_keys import RawKey, RawKeys
from app.desk.stop_keys.stop_records import LONGEST, Focus, Stop, StopKind, press_number

PAUSE, SCROLL_LOCK, ESC, SPACE = 127, 78, 9, 65
OURS, OTHER = 0x600007, 0x800001


@dataclass
class Keys:
    """A source of events whose window in front is chosen by the test."""

    front: int = OURS
    escape: int = ESC

    def focus(self) -> int:
        return self.front

    def escape_code(self) -> int:
        return self.escape


@dataclass
class Bench:
    watcher: KeyWatcher
    keys: Keys
    control: socket.socket
    screen: socket.socket

    def show(self, focus: Focus) -> None:
        self.screen.send(focus.packed())
        assert self.watcher.read_focus()

    def sent(self) -> list[Stop]:
        """What the control got, which the screen learns too."""
        found: dict[str, list[Stop]] = {}
        for name, end in (("control", self.control), ("screen", self.screen)):
            found[name] = []
            try:
                while record := end.recv(LONGEST, socket.MSG_DONTWAIT):
                    found[name].append(Stop.unpacked(record))
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
        yield Bench(KeyWatcher(cast("RawKeys", keys), line, theirs), keys, control, screen)


HERE = Focus(frozenset({OURS}), esc_holds=False)
MOVING = Focus(frozenset({OURS}), esc_holds=True)


@pytest.mark.parametrize(("code", "kind"), [(PAUSE, StopKind.HOLD), (SCROLL_LOCK, StopKind.ESTOP)])
def test_a_stop_key_is_sent_with_its_press(bench: Bench, code: int, kind: StopKind) -> None:
    bench.show(HERE)
    bench.watcher.see(RawKey(code, 5000))
    assert bench.sent() == [Stop(kind, press_number(code, 5000))]


def test_every_press_is_another(bench: Bench) -> None:
    bench.show(HERE)
    for stamp in (5000, 5100):
        bench.watcher.see(RawKey(PAUSE, stamp))
    first, second = bench.sent()
    assert first.press != second.press


@pytest.mark.parametrize("code", [SPACE, ESC, 38, 66])
def test_no_other_key_is_sent(bench: Bench, code: int) -> None:
    bench.show(HERE)
    bench.watcher.see(RawKey(code, 5000))
    assert bench.sent() == []


@pytest.mark.parametrize("front", [OTHER, 0, 1])
def test_nothing_is_sent_while_another_program_has_the_keyboard(bench: Bench, front: int) -> None:
    bench.show(MOVING)
    bench.keys.front = front
    for code in (PAUSE, SCROLL_LOCK, ESC):
        bench.watcher.see(RawKey(code, 5000))
    assert bench.sent() == []


def test_nothing_is_sent_before_there_is_a_window(bench: Bench) -> None:
    bench.watcher.see(RawKey(PAUSE, 5000))
    assert bench.sent() == []


def test_esc_is_sent_where_it_holds_by_the_layout_of_now(bench: Bench) -> None:
    bench.show(MOVING)
    bench.watcher.see(RawKey(ESC, 5000))
    assert [each.kind for each in bench.sent()] == [StopKind.ESC]
    bench.keys.escape = 66
    bench.watcher.see(RawKey(ESC, 5100))
    assert bench.sent() == []


def test_the_end_of_the_screen_ends_it(bench: Bench) -> None:
    bench.screen.close()
    assert not bench.watcher.read_focus()


def test_a_screen_that_ends_without_reading_all_ends_it_too(bench: Bench) -> None:
    bench.show(HERE)
    bench.watcher.see(RawKey(PAUSE, 5000))
    bench.screen.close()
    assert not bench.watcher.read_focus()


def test_a_control_that_has_ended_is_no_end_of_the_watcher(bench: Bench) -> None:
    bench.show(HERE)
    bench.control.close()
    bench.watcher.see(RawKey(PAUSE, 5000))
    assert Stop.unpacked(bench.screen.recv(LONGEST)).kind is StopKind.HOLD


@pytest.mark.parametrize("record", [b"", b"1", bytes(8), bytes(10), b"\x09" + bytes(8)])
def test_a_record_that_is_no_stop_is_rejected(record: bytes) -> None:
    with pytest.raises(ValueError, match="not a"):
        Stop.unpacked(record)


@pytest.mark.parametrize("record", [b"", b"12", bytes(4)])
def test_a_record_that_is_no_focus_is_rejected(record: bytes) -> None:
    with pytest.raises(ValueError, match="not a"):
        Focus.unpacked(record)


def test_records_are_read_as_they_were_written() -> None:
    focus, stop = (
        Focus(frozenset({OURS, OTHER}), esc_holds=True),
        Stop(StopKind.ESC, press_number(9, 2**32 - 1)),
    )
    assert Focus.unpacked(focus.packed()) == focus
    assert Stop.unpacked(stop.packed()) == stop


def test_an_event_without_a_stamp_has_no_number() -> None:
    assert press_number(PAUSE, 0) == 0
