"""The key watcher: which raw keys it sends, and what it makes of records."""

from __future__ import annotations

import socket
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import cast

import pytest

from app.desk.stop_keys.handled_presses import HandledPresses, is_press_handled
from app.desk.stop_keys.key_watcher import KeyWatcher
from app.desk.stop_keys.raw_keys import RawKey, RawKeyReader
from app.desk.stop_keys.raw_pointer import PointerPress, RawPointerReader
from app.desk.stop_keys.stop_records import (
    MAX_RECORD_BYTES,
    TOUCH_CODE,
    FocusRecord,
    StopArea,
    StopKeyPress,
    StopKind,
    make_button_code,
    make_press_number,
)

PAUSE, SCROLL_LOCK, ESC, SPACE, H, E = 127, 78, 9, 65, 43, 26
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

    def find_character(self, code: int) -> str:
        return {43: "H", 26: "E", SPACE: " ", 38: "A"}.get(code, "")


@dataclass
class Pointer:
    """Windows on a screen; each covers all that follow, with its corner on the screen and its size."""

    windows: list[tuple[int, int, int, int, int]]
    waiting: list[PointerPress] = field(default_factory=list)

    def read_presses(self) -> list[PointerPress]:
        waiting, self.waiting = self.waiting, []
        return waiting

    def find_window_at(self, x: int, y: int, window_ids: frozenset[int]) -> tuple[int, int, int] | None:
        for window, left, top, width, height in self.windows:
            if left <= x < left + width and top <= y < top + height:
                return (window, x - left, y - top) if window in window_ids else None
        return None


@dataclass
class Bench:
    watcher: KeyWatcher
    keys: Keys
    control: socket.socket
    screen: socket.socket
    pointer: Pointer

    def click(self, x: int, y: int, code: int = make_button_code(1)) -> None:
        self.watcher.handle_pointer_press(PointerPress(code, 5000, x, y))

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
    keys, pointer = Keys(), Pointer([(OURS, 100, 50, 800, 600)])
    with line, control, theirs, screen:
        watcher = KeyWatcher(cast("RawKeyReader", keys), line, theirs, cast("RawPointerReader", pointer))
        yield Bench(watcher, keys, control, screen, pointer)


HERE = FocusRecord(frozenset({OURS}), is_esc_stop_key=False)
MOVING = FocusRecord(frozenset({OURS}), is_esc_stop_key=True)
DRAWN = FocusRecord(
    frozenset({OURS}),
    is_esc_stop_key=False,
    stop_areas=(
        StopArea(OURS, 10, 20, 40, 30, StopKind.ESTOP),  # on the screen: x 110 to 149, y 70 to 99
        StopArea(OURS, 10, 60, 40, 30, StopKind.HOLD),  # y 110 to 139
    ),
)


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


@pytest.mark.parametrize("code", [make_button_code(1), make_button_code(3), TOUCH_CODE])
@pytest.mark.parametrize(
    ("x", "y", "kind"),
    [(110, 70, StopKind.ESTOP), (149, 99, StopKind.ESTOP), (130, 110, StopKind.HOLD)],
)
def test_press_on_drawn_stop_control_is_sent(bench: Bench, code: int, x: int, y: int, kind: StopKind) -> None:
    bench.show(DRAWN)
    bench.keys.front = OTHER  # A click needs no keyboard focus.
    bench.click(x, y, code)
    assert bench.sent() == [StopKeyPress(kind, make_press_number(code, 5000))]


@pytest.mark.parametrize("at", [(109, 70), (150, 70), (110, 69), (110, 100), (400, 300), (20, 30)])
def test_press_next_to_drawn_stop_control_is_not_sent(bench: Bench, at: tuple[int, int]) -> None:
    bench.show(DRAWN)
    bench.click(*at)
    assert bench.sent() == []


def test_press_on_window_that_covers_stop_control_is_not_sent(bench: Bench) -> None:
    bench.show(DRAWN)
    bench.pointer.windows.insert(0, (OTHER, 0, 0, 300, 300))
    bench.click(130, 80)
    assert bench.sent() == []


def test_press_on_stop_control_of_moved_window_is_sent(bench: Bench) -> None:
    bench.show(DRAWN)
    bench.pointer.windows[0] = (OURS, 500, 300, 800, 600)
    bench.click(130, 80)
    assert bench.sent() == []
    bench.click(530, 330)
    assert [each.stop_kind for each in bench.sent()] == [StopKind.ESTOP]


def test_press_on_another_window_of_turndesk_is_not_sent(bench: Bench) -> None:
    bench.show(DRAWN._replace(window_ids=frozenset({OURS, OTHER})))
    bench.pointer.windows.insert(0, (OTHER, 100, 50, 300, 300))
    bench.click(130, 80)
    assert bench.sent() == []


def test_no_press_is_sent_while_no_stop_control_is_drawn(bench: Bench) -> None:
    bench.show(HERE)
    bench.click(130, 80)
    assert bench.sent() == []


F2, ENTER = 68, 36
LETTERS = FocusRecord(frozenset({OURS}), is_esc_stop_key=False, are_letters_stop_keys=True)


def handled(code: int, time_ms: int) -> FocusRecord:
    """No text field has the keyboard, and the screen has handled this press."""
    number = make_press_number(code, time_ms)
    return LETTERS._replace(handled_press=number, received_press=number)


def press(bench: Bench, *presses: tuple[int, int]) -> list[StopKind]:
    """Press keys at these times; the stops that are sent."""
    for code, time_ms in presses:
        bench.watcher.handle_key_press(RawKey(code, time_ms))
    return [each.stop_kind for each in bench.sent()]


@pytest.mark.parametrize(("code", "kind"), [(H, StopKind.HOLD), (SPACE, StopKind.HOLD), (E, StopKind.ESTOP)])
def test_letter_is_sent_after_the_screen_has_handled_the_last_press(
    bench: Bench, code: int, kind: StopKind
) -> None:
    assert press(bench, (F2, 4000)) == []
    bench.show(handled(F2, 4000))
    assert press(bench, (38, 5000)) == []  # A is no stop key.
    bench.show(handled(38, 5000))
    assert press(bench, (code, 6000)) == [kind]


def test_letter_is_not_sent_while_an_earlier_press_is_not_handled(bench: Bench) -> None:
    press(bench, (38, 4000))
    bench.show(handled(38, 4000))
    assert press(bench, (F2, 5000), (H, 5100), (E, 5200), (SPACE, 5300)) == []  # F2 may open a field.
    bench.show(handled(SPACE, 5300))
    assert press(bench, (H, 6000)) == [StopKind.HOLD]


def test_letter_is_not_sent_while_a_text_field_has_the_keyboard(bench: Bench) -> None:
    press(bench, (F2, 4000))
    bench.show(handled(F2, 4000)._replace(are_letters_stop_keys=False))
    assert press(bench, (H, 5000)) == []


def test_letter_is_not_sent_while_a_click_is_not_handled(bench: Bench) -> None:
    press(bench, (F2, 4000))
    bench.show(handled(F2, 4000))
    bench.pointer.waiting.append(PointerPress(make_button_code(1), 4500, 400, 300))
    assert press(bench, (H, 5000)) == []
    bench.show(handled(H, 5000))
    bench.click(400, 300, TOUCH_CODE)
    assert press(bench, (H, 6000)) == []  # The touch was in the same millisecond as the handled press.


def test_second_letter_is_sent_after_the_first_one_was_sent(bench: Bench) -> None:
    press(bench, (F2, 4000))
    bench.show(handled(F2, 4000)._replace(stop_areas=DRAWN.stop_areas))
    bench.click(130, 110)
    assert press(bench, (PAUSE, 4900), (H, 5000), (E, 5100)) == [
        StopKind.HOLD,
        StopKind.HOLD,
        StopKind.HOLD,
        StopKind.ESTOP,
    ]


def test_letter_is_not_sent_before_the_watcher_has_seen_another_press(bench: Bench) -> None:
    bench.show(handled(F2, 4000))
    assert press(bench, (H, 5000)) == []


@pytest.mark.parametrize("received", [(E, 5000), (ENTER, 5040)])
def test_letter_that_the_screen_has_already_received_is_not_sent_by_a_late_watcher(
    bench: Bench, received: tuple[int, int]
) -> None:
    # E entered text and Enter closed the field before the watcher read these presses.
    press(bench, (F2, 4000))
    closed = handled(F2, 4000)._replace(received_press=make_press_number(*received))
    bench.show(closed)
    assert press(bench, (E, 5000)) == []
    assert press(bench, (ENTER, 5040)) == []
    bench.show(handled(ENTER, 5040))
    assert press(bench, (E, 6000)) == [StopKind.ESTOP]


def test_esc_that_the_screen_received_before_motion_is_not_sent_by_a_late_watcher(bench: Bench) -> None:
    bench.show(MOVING._replace(received_press=make_press_number(ESC, 5000)))
    assert press(bench, (ESC, 5000)) == []
    assert press(bench, (ESC, 6000)) == [StopKind.ESC]


@pytest.mark.parametrize(("code", "kind"), [(PAUSE, StopKind.HOLD), (SCROLL_LOCK, StopKind.ESTOP)])
def test_stop_key_is_sent_although_the_screen_has_received_it(
    bench: Bench, code: int, kind: StopKind
) -> None:
    bench.show(HERE._replace(received_press=make_press_number(code, 5000)))
    assert press(bench, (code, 5000)) == [kind]


def test_letter_is_sent_if_the_screen_has_received_only_an_earlier_press(bench: Bench) -> None:
    press(bench, (F2, 4000))
    bench.show(handled(F2, 4000)._replace(received_press=make_press_number(H, 4900)))
    assert press(bench, (E, 5000)) == [StopKind.ESTOP]


def test_letter_is_not_sent_without_reader_of_mouse_and_touch(bench: Bench) -> None:
    press(bench, (F2, 4000))
    bench.show(handled(F2, 4000))
    bench.watcher._pointer = None
    assert press(bench, (H, 5000)) == []


def test_letter_is_not_sent_while_another_program_has_the_keyboard(bench: Bench) -> None:
    press(bench, (F2, 4000))
    bench.show(handled(F2, 4000))
    bench.keys.front = OTHER
    assert press(bench, (H, 5000)) == []


@pytest.mark.parametrize(
    ("press_ms", "handled_ms", "expected"),
    [
        (5000, 5001, True),
        (5000, 4999, False),
        (5000, 5000, False),
        (2**32 - 5, 3, True),
        (3, 2**32 - 5, False),
    ],
)
def test_press_is_handled_if_the_screen_has_handled_a_later_one(
    press_ms: int, handled_ms: int, *, expected: bool
) -> None:
    assert is_press_handled(make_press_number(F2, press_ms), make_press_number(H, handled_ms)) is expected


def test_unknown_press_is_not_handled() -> None:
    assert not is_press_handled(0, make_press_number(H, 5000))
    assert not is_press_handled(make_press_number(H, 5000), 0)
    assert is_press_handled(make_press_number(H, 5000), make_press_number(H, 5000))


def test_press_counts_as_handled_after_two_frames() -> None:
    record = HandledPresses()
    record.record_press(7)
    assert record.received_press == 7
    record.complete_frame()
    assert record.handled_press == 0
    record.record_press(0)  # An event without a time stamp.
    record.complete_frame()
    assert record.handled_press == 7


def test_press_is_not_handled_while_the_pointer_is_down() -> None:
    record = HandledPresses()
    record.record_press(7)
    record.is_pointer_down = True
    for _frame in range(3):
        record.complete_frame()
        assert record.handled_press == 0
    record.is_pointer_down = False
    record.complete_frame()
    record.complete_frame()
    assert record.handled_press == 7


def test_click_that_the_screen_has_received_is_not_sent_by_a_late_watcher(bench: Bench) -> None:
    # The pointer may have moved to the stop control after the click elsewhere.
    bench.show(DRAWN._replace(received_press=make_press_number(make_button_code(1), 5000)))
    bench.click(130, 80)
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


@pytest.mark.parametrize(
    "record",
    [b"", b"12", bytes(4), bytes(15), DRAWN.to_bytes()[:-1], DRAWN.to_bytes() + b"1", b"\0\1\0\0\0"],
)
def test_invalid_focus_record_is_rejected(record: bytes) -> None:
    with pytest.raises(ValueError, match="not a"):
        FocusRecord.from_bytes(record)


def test_records_are_decoded_as_they_were_encoded() -> None:
    focus, stop = (
        FocusRecord(frozenset({OURS, OTHER}), is_esc_stop_key=True),
        StopKeyPress(StopKind.ESC, make_press_number(9, 2**32 - 1)),
    )
    assert FocusRecord.from_bytes(focus.to_bytes()) == focus
    for record in (
        DRAWN,
        DRAWN._replace(are_letters_stop_keys=True, handled_press=2**41 + 5, received_press=2**41 + 6),
    ):
        assert FocusRecord.from_bytes(record.to_bytes()) == record
    assert StopKeyPress.from_bytes(stop.to_bytes()) == stop


def test_unknown_stop_kind_of_area_is_rejected() -> None:
    with pytest.raises(ValueError, match="9 is not a valid"):
        FocusRecord.from_bytes(DRAWN.to_bytes()[:-1] + b"\x09")


def test_record_of_too_many_windows_and_areas_fits_in_its_limit() -> None:
    many = FocusRecord(frozenset(range(2000)), is_esc_stop_key=True, stop_areas=DRAWN.stop_areas * 100)
    found = FocusRecord.from_bytes(many.to_bytes())
    assert len(many.to_bytes()) <= MAX_RECORD_BYTES
    assert (len(found.window_ids), len(found.stop_areas)) == (500, 64)


def test_key_event_without_a_timestamp_has_press_number_zero() -> None:
    assert make_press_number(PAUSE, 0) == 0
