"""A screen that is killed, hangs or does not read: what the control does alone, what the next one gets."""

from __future__ import annotations

import json
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from app.compose.control.control_messages import (
    ControlFailedMessage,
    EventMessage,
    EventStoredMessage,
    InputChange,
    InterruptedJobMessage,
    SnapshotMessage,
)
from app.compose.control.control_server import REST_CHECK_COUNT, SILENT_CHECK_COUNT, STOPPED_CHECK_COUNT
from app.compose.control.unattended_notes import (
    EVENTS_FILE_NAME,
    NOTE_FILE_NAME,
    UnconfirmedEvent,
    UnconfirmedEvents,
    delete_interruption_note,
    pop_interruption_note,
    pop_unconfirmed_events,
    save_interruption_note,
    save_unconfirmed_events,
)
from app.compose.runs.journal import Journal
from app.compose.runs.receipt import EventReceipt
from core.executor.commands import PreventNextPart, SetSwitch
from core.executor.snapshot import ACTIVE_STATES, InterruptedJob, LogEvent, MachineState
from core.store.production import part_cycles
from core.store.production.part_cycles import CycleRow, ProductionStopRow
from core.store.store import Store
from core.store.store_rows import EventOrigin, EventRow
from tests.control.bench import SHORT, Bench, Screen, control, one_button, until
from tests.interrupted import broken_off

AT = "2026-05-04T09:30:00.000Z"


@pytest.fixture
def bench(tmp_path: Path) -> Iterator[Bench]:
    with control(tmp_path) as made:
        yield made


def test_new_screen_receives_events_not_confirmed_by_the_lost_one(bench: Bench) -> None:
    first = bench.screen()
    first.meet()
    for text in ("one", "two"):
        bench.server.outbox.add_event(LogEvent(0.0, "warning", text))
    assert [each.event.text for each in first.events("warning")] == ["one", "two"]
    first.lose()
    second = bench.screen()
    second.meet()
    again = second.events("warning")
    assert [each.event.text for each in again] == ["one", "two"]
    second.hear(again[0])
    bench.server.outbox.add_event(LogEvent(0.0, "warning", "three"))
    assert [each.event.text for each in second.events("warning")] == ["three"]
    second.lose()
    third = bench.screen()
    third.meet()
    assert [each.event.text for each in third.events("warning")] == ["two", "three"]


def test_number_of_events_buffered_without_a_screen_is_limited(bench: Bench) -> None:
    for number in range(10_050):
        bench.server.outbox.add_event(LogEvent(0.0, "test", str(number)))
    screen = bench.screen()
    screen.meet()
    got = [screen.take(EventMessage).event.text for _ in range(10_000)]
    assert got[-1] == "10049"
    assert len(set(got)) == 10_000


def test_the_executor_does_not_wait_for_a_screen_that_does_not_read(bench: Bench) -> None:
    screen = bench.screen()
    screen.meet()
    for number in range(3000):  # more than the socket holds
        bench.server.outbox.add_event(LogEvent(0.0, "test", "x" * 200 + str(number)))
    ticks, t = bench.server.executor.tick_count, bench.shot.t
    until(lambda: bench.server.executor.tick_count > ticks + 10 and bench.shot.t > t + 0.5)
    screen.take(EventMessage, lambda each: each.event.text.endswith("x2999"))
    shown = screen.take(SnapshotMessage)
    assert shown.snapshot.t > t + 0.4  # those in between were replaced


def test_screen_that_does_not_read_can_be_replaced(bench: Bench) -> None:
    screen = bench.screen()
    screen.meet()
    for number in range(3000):
        bench.server.outbox.add_event(LogEvent(0.0, "test", "x" * 200 + str(number)))
    screen.lose()
    other = bench.screen()
    other.meet()
    assert len(other.events("test")) == 3000


def test_a_second_screen_is_refused_while_one_is_connected(bench: Bench) -> None:
    first = bench.screen()
    first.meet()
    second = bench.screen()
    assert second.take(ControlFailedMessage).reason == "busy"
    second.thread.join()
    first.post(SetSwitch("single_block", True))
    first.take(SnapshotMessage, lambda each: each.snapshot.single_block)
    first.lose()
    bench.screen().meet()


def test_screen_that_disconnects_before_hello_does_not_harm_the_control(bench: Bench) -> None:
    screen = bench.screen()
    screen.end.close()
    screen.thread.join()
    bench.screen().meet()


@pytest.mark.parametrize(
    "data", [b"", b"\x80", b"no pickle", b"cno.such\nmodule\n.", b"(lp0\n0.", b"\x80\x05K\x01K\x02"]
)
def test_damaged_bytes_end_only_the_connection(bench: Bench, data: bytes) -> None:
    screen = bench.screen()
    screen.meet()
    screen.end.send_bytes(data)
    screen.thread.join(10.0)
    assert not screen.thread.is_alive()
    with pytest.raises(EOFError):
        screen.take(ControlFailedMessage)
    bench.screen().meet()


@pytest.mark.parametrize("message", ["what", 3, None, ("Post", 1), InputChange("no such input", True)])
def test_an_unknown_message_changes_nothing(bench: Bench, message: object) -> None:
    screen = bench.screen()
    screen.meet()
    screen.end.send(message)
    screen.hand("no_such_hand")
    screen.hand("press_hold", "too", "much")
    screen.post(SetSwitch("single_block", True))
    screen.take(SnapshotMessage, lambda each: each.snapshot.single_block)


def test_event_that_cannot_be_pickled_does_not_block_later_messages(bench: Bench) -> None:
    screen = bench.screen()
    screen.meet()
    bench.server.outbox.add_event(LogEvent(0.0, "test", threading.Lock()))  # type: ignore[arg-type]
    bench.server.outbox.add_event(LogEvent(0.0, "test", "behind it"))
    assert screen.take(EventMessage).event.text == "behind it"
    assert screen.take(SnapshotMessage)


# --- hold and continue ------------------------------------------------------------------------------------


def test_lost_screen_causes_feed_hold(bench: Bench) -> None:
    screen = bench.screen()
    screen.meet()
    bench.run(screen)
    screen.lose()
    bench.looks(1)
    bench.until(MachineState.HOLD)
    other = bench.screen()
    assert other.meet().snapshot.state is MachineState.HOLD
    assert len(other.events("stop")) == 1


def test_screen_without_life_signs_causes_hold_even_if_threads_respond(bench: Bench) -> None:
    screen = bench.screen()
    screen.meet()
    bench.run(screen)
    bench.alive(screen)
    bench.looks(1)
    assert bench.shot.state in ACTIVE_STATES
    for _ in range(SILENT_CHECK_COUNT):
        screen.end.send(EventStoredMessage(0))
        bench.server.check_screen_response()
    bench.until(MachineState.HOLD)


def test_screen_with_life_signs_causes_no_hold(bench: Bench) -> None:
    screen = bench.screen()
    screen.meet()
    bench.run(screen)
    for _ in range(SILENT_CHECK_COUNT - 2):
        bench.server.check_screen_response()
    bench.alive(screen)
    bench.looks(5)
    for _ in range(SILENT_CHECK_COUNT - 7):
        bench.server.check_screen_response()
    bench.looks(1)
    assert bench.shot.state in ACTIVE_STATES


def test_automatic_start_while_the_screen_is_silent_is_put_on_hold(bench: Bench) -> None:
    screen = bench.screen()
    screen.meet()
    job = bench.run(screen)
    bench.alive(screen)
    bench.looks(SILENT_CHECK_COUNT)
    bench.until(MachineState.HOLD)
    bench.start(screen, job)  # not ``Alive``: as buttons of the machine do it
    bench.until(MachineState.RUN)
    bench.looks(1)
    bench.until(MachineState.HOLD)
    bench.alive(screen)
    bench.looks(1)
    bench.start(screen, job)
    bench.until(MachineState.RUN)
    bench.looks(1)
    assert bench.shot.state in ACTIVE_STATES


def test_a_part_is_finished_without_a_screen_and_no_other_begins(tmp_path: Path) -> None:
    with control(tmp_path, one_button(alone=True)) as bench:
        screen = bench.screen()
        screen.meet()
        screen.post(SetSwitch("cycle_repeat", True))
        screen.post(PreventNextPart("NO MORE TODAY"))
        screen.post(PreventNextPart(""))
        bench.run(screen, SHORT)
        screen.lose()
        bench.looks(1)
        barred = bench.shot.next_barred
        assert barred
        bench.until(MachineState.IDLE)
        assert bench.shot.parts >= 1
        other = bench.screen()
        hello = other.meet()
        assert hello.snapshot.next_barred == barred
        assert hello.interrupted_job is None
        assert len(other.events("part")) == bench.shot.parts
        bench.looks(SILENT_CHECK_COUNT + 1)
        assert bench.shot.next_barred == barred  # its window is not open yet
        bench.alive(other)
        bench.looks(1)
        assert bench.shot.next_barred == ""


@pytest.mark.parametrize("late", [False, True])
def test_previous_bar_of_next_part_applies_again_when_screen_returns(tmp_path: Path, late: bool) -> None:
    with control(tmp_path, one_button(alone=True)) as bench:
        screen = bench.screen()
        screen.meet()
        bench.alive(screen)
        if not late:
            screen.post(PreventNextPart("TOOL 3 IS WORN"))
            until(lambda: bench.shot.next_barred == "TOOL 3 IS WORN")
        bench.looks(SILENT_CHECK_COUNT)
        until(lambda: bench.shot.next_barred not in {"", "TOOL 3 IS WORN"})
        if late:  # it is back, and nobody has looked yet
            screen.post(PreventNextPart("TOOL 3 IS WORN"))
            until(lambda: bench.shot.next_barred == "TOOL 3 IS WORN")
        bench.alive(screen)
        bench.looks(1)
        assert bench.shot.next_barred == "TOOL 3 IS WORN"


@pytest.mark.parametrize(("looks", "runs"), [(REST_CHECK_COUNT - 1, False), (REST_CHECK_COUNT, False)])
def test_control_at_rest_closes_without_a_screen(bench: Bench, looks: int, runs: bool) -> None:
    screen = bench.screen()
    screen.meet()
    screen.lose()
    for _ in range(looks):
        bench.server.check_screen_response()
    assert bench.server.closing_event.is_set() is (looks >= REST_CHECK_COUNT)


def test_control_in_feed_hold_waits_longer_for_a_screen(bench: Bench) -> None:
    screen = bench.screen()
    screen.meet()
    bench.run(screen)
    screen.lose()
    bench.looks(1)
    bench.until(MachineState.HOLD)
    for _ in range(STOPPED_CHECK_COUNT - 2):
        bench.server.check_screen_response()
    assert not bench.server.closing_event.is_set()
    bench.server.check_screen_response()
    assert bench.server.closing_event.is_set()


# --- the note -------------------------------------------------------------------------------------------


def test_job_interrupted_without_a_screen_is_noted_for_next_start(bench: Bench, tmp_path: Path) -> None:
    screen = bench.screen()
    screen.meet()
    bench.run(screen)
    noted = screen.take(InterruptedJobMessage, lambda each: each.job is not None).job
    assert not (tmp_path / NOTE_FILE_NAME).exists()
    screen.lose()
    bench.looks(1)
    known, left = pop_interruption_note(tmp_path)
    assert known
    assert left is not None
    assert noted is not None
    assert left.program == noted.program == "part.nc"
    assert pop_interruption_note(tmp_path) == (False, None)


def test_absence_of_an_interrupted_job_is_noted_too(bench: Bench, tmp_path: Path) -> None:
    screen = bench.screen()
    screen.meet()
    screen.lose()  # its store may have the note of a part that has ended since
    bench.looks(1)
    assert json.loads((tmp_path / NOTE_FILE_NAME).read_bytes()) is None
    other = bench.screen()
    other.meet()
    assert not (tmp_path / NOTE_FILE_NAME).exists()


def test_screen_that_disconnects_immediately_leaves_the_note(bench: Bench, tmp_path: Path) -> None:
    screen = bench.screen()
    screen.meet()
    bench.run(screen)
    screen.lose()
    bench.looks(1)
    assert (tmp_path / NOTE_FILE_NAME).exists()
    other = bench.screen()  # with another machine file
    other.meet()
    other.lose()
    bench.looks(1)
    known, left = pop_interruption_note(tmp_path)
    assert known
    assert left is not None


def test_screen_that_opens_slowly_is_not_treated_as_silent(bench: Bench) -> None:
    screen = bench.screen()
    screen.meet()
    bench.run(screen)
    bench.looks(SILENT_CHECK_COUNT + 1)
    assert bench.shot.state in ACTIVE_STATES


def test_closing_control_accepts_no_screen(bench: Bench) -> None:
    bench.server.closing_event.set()
    screen = bench.screen()
    with pytest.raises(EOFError):
        screen.end.recv()


def test_screen_that_connects_while_the_note_is_saved_removes_it(
    bench: Bench, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    screen = bench.screen()
    screen.meet()
    screen.lose()

    def slowly(folder: Path, job: InterruptedJob | None) -> None:
        bench.screen().meet()
        save_interruption_note(folder, job)

    monkeypatch.setattr("app.compose.control.control_server.save_interruption_note", slowly)
    bench.looks(1)
    assert not (tmp_path / NOTE_FILE_NAME).exists()


def test_events_not_saved_by_any_screen_are_saved_when_control_closes(tmp_path: Path) -> None:
    with control(tmp_path, one_button(alone=True)) as bench:
        screen = bench.screen()
        screen.meet()
        bench.run(screen, SHORT)
        for each in screen.events("load"):
            screen.hear(each)
        screen.lose()
        bench.until(MachineState.IDLE)
        parts = bench.shot.parts
    left = pop_unconfirmed_events(tmp_path)
    program, events = left
    rows = tuple(each.event_row for each in events)
    assert (program, parts) == ("part.nc", 1)
    assert [row.kind for row in rows].count("part") == 1
    assert "load" not in {row.kind for row in rows}
    assert rows[0].at < rows[-1].at
    assert pop_unconfirmed_events(tmp_path) == UnconfirmedEvents()
    save_unconfirmed_events(tmp_path, left)
    for _ in range(2):
        Journal(tmp_path).close()
    with Store.open(tmp_path, read_only=True) as store:
        assert store.runs.read_part_count("part.nc") == 1
        assert store.events.read_events()[::-1] == rows


# --- the row of a cycle ---------------------------------------------------------------------------------


def stored_cycles(folder: Path) -> list[tuple[str, int, str, bool]]:
    """Program, part, outcome, and whether it has ended, of each stored cycle."""
    with Store.open(folder, read_only=True) as store, store.read() as connection:
        rows = part_cycles.read_cycles(connection, None, 100)
    return [(row.program, row.part, row.outcome, row.ended is not None) for row in rows]


def store_events(folder: Path, screen: Screen, messages: list[EventMessage]) -> None:
    """A screen that stores these events, and is killed before it confirms them."""
    journal = Journal(folder, control_running=True)
    journal.hear(LogEvent(0.0, "load", "part.nc"))
    identity = screen.identity
    for each in messages:
        origin = EventOrigin(identity, each.event_number)
        if not journal.has_stored_event(origin):
            journal.hear(each.event, EventReceipt(origin, lambda: None, each.production_rows))
    journal.close()


def test_cycle_that_ends_without_a_screen_is_stored_once_by_the_next(tmp_path: Path) -> None:
    """The first screen stores the start, the second the end; the third receives both and stores neither."""
    with control(tmp_path, one_button(alone=True)) as bench:
        first = bench.screen()
        first.meet()
        bench.run(first, SHORT)
        store_events(tmp_path, first, first.events("start"))
        assert stored_cycles(tmp_path) == [("part.nc", 0, "", False)]
        first.lose()
        bench.until(MachineState.IDLE)
        for _ in range(2):
            screen = bench.screen()
            screen.meet()
            store_events(tmp_path, screen, screen.all_events())
            assert stored_cycles(tmp_path) == [("part.nc", 1, "COMPLETE", True)]
            screen.lose()


def test_cycle_that_no_screen_has_stored_is_stored_at_the_next_start(tmp_path: Path) -> None:
    with control(tmp_path, one_button(alone=True)) as bench:
        screen = bench.screen()
        screen.meet()
        bench.run(screen, SHORT)
        for each in screen.events("load"):
            screen.hear(each)
        screen.lose()
        bench.until(MachineState.IDLE)
    for _ in range(2):
        Journal(tmp_path).close()
        assert stored_cycles(tmp_path) == [("part.nc", 1, "COMPLETE", True)]


def test_rows_of_stored_events_do_not_replace_newer_rows(tmp_path: Path) -> None:
    """The start of a cycle arrives again after its end was stored."""
    started = CycleRow("key", "part.nc", 0, AT)
    ended = started._replace(part=3, ended=AT, seconds=9.5, outcome="COMPLETE")
    row = EventRow(AT, "start", "part.nc")
    events = tuple(
        UnconfirmedEvent(row, EventOrigin("control", number), (rows,))
        for number, rows in ((1, started), (2, ended))
    )
    save_unconfirmed_events(tmp_path, UnconfirmedEvents("part.nc", events))
    Journal(tmp_path).close()
    save_unconfirmed_events(tmp_path, UnconfirmedEvents("part.nc", events[:1]))
    Journal(tmp_path).close()
    with Store.open(tmp_path, read_only=True) as store, store.read() as connection:
        assert part_cycles.read_cycles(connection, None, 100) == (ended,)


def test_cycle_and_stop_rows_are_the_same_after_they_were_saved(tmp_path: Path) -> None:
    rows = (
        CycleRow("key", "part.nc", 3, AT, AT, 9.5, "COMPLETE", 31.5),
        CycleRow("key 2", "part.nc", 0, AT),
        ProductionStopRow("key 3", "key 2", "part.nc", AT, 4.0, "FEED HOLD", 7),
    )
    event = UnconfirmedEvent(EventRow(AT, "part", "part 3"), EventOrigin("control", 5), rows)
    left = UnconfirmedEvents("part.nc", (event,))
    save_unconfirmed_events(tmp_path, left)
    assert pop_unconfirmed_events(tmp_path) == left


@pytest.mark.parametrize(
    "rows",
    [
        3,
        [3],
        [[]],
        [["key", "part.nc", "3", AT, AT, 9.5, "COMPLETE", None]],
        [["key", "part.nc", 3, None, AT, 9.5, "COMPLETE", None]],
        [["key", "key 2", "part.nc", AT, "4.0", "FEED HOLD", 7]],
        [{"key": "key"}],
    ],
)
def test_damaged_cycle_rows_are_rejected_with_their_events(tmp_path: Path, rows: object) -> None:
    event = [AT, "part", "part 3", 0, "", "", "control", 5, rows]
    (tmp_path / EVENTS_FILE_NAME).write_text(json.dumps(["part.nc", [event]]))
    assert pop_unconfirmed_events(tmp_path) == UnconfirmedEvents()


def test_events_saved_before_rows_existed_are_read(tmp_path: Path) -> None:
    event = [AT, "part", "part 3", 0, "", "", "control", 5]
    (tmp_path / EVENTS_FILE_NAME).write_text(json.dumps(["part.nc", [event]]))
    (left,) = pop_unconfirmed_events(tmp_path).events
    assert (left.event_row.text, left.origin.number, left.production_rows) == ("part 3", 5, ())


# --- the note at the next start -------------------------------------------------------------------------


@pytest.mark.parametrize("left", [None, broken_off(program="part.nc")])
def test_interruption_note_overrides_the_older_store(tmp_path: Path, left: InterruptedJob | None) -> None:
    before = Journal(tmp_path)
    before.note(broken_off(program="old.nc"))
    before.close()
    save_interruption_note(tmp_path, left)
    attached = Journal(tmp_path, control_running=True)  # the control that wrote it is running
    assert attached.left is None
    attached.close()
    for logged in (False, True):
        journal = Journal(tmp_path)
        assert journal.left == left
        assert journal.is_interruption_logged is logged
        journal.close()


def test_note_is_retained_if_the_store_cannot_be_opened(tmp_path: Path) -> None:
    save_interruption_note(tmp_path, broken_off())
    row = EventRow("2026-05-04T09:30:00.000Z", "part", "part 1")
    save_unconfirmed_events(
        tmp_path, UnconfirmedEvents("part.nc", (UnconfirmedEvent(row, EventOrigin("control", 5)),))
    )
    with Store.open(tmp_path):  # by another TurnDesk
        journal = Journal(tmp_path)
        assert journal.left is None
        journal.close()
    journal = Journal(tmp_path)
    assert journal.left == broken_off()
    journal.close()
    with Store.open(tmp_path, read_only=True) as store:
        assert store.runs.read_part_count("part.nc") == 1


def test_unconfirmed_events_already_in_the_store_are_not_stored_again(tmp_path: Path) -> None:
    row = EventRow("2026-05-04T09:30:00.000Z", "part", "part")
    origins = tuple(EventOrigin("control", number) for number in (5, 6, 7))
    with Store.open(tmp_path) as store:
        store.runs.record_event(row, "part.nc", origins[1])  # and was killed before it confirmed it
    save_unconfirmed_events(
        tmp_path, UnconfirmedEvents("part.nc", tuple(UnconfirmedEvent(row, at) for at in origins))
    )
    journal = Journal(tmp_path)
    journal.close()
    with Store.open(tmp_path, read_only=True) as store:
        assert store.runs.read_part_count("part.nc") == 2
        assert store.runs.read_last_origin() == origins[2]
    other = tuple(EventOrigin("another", number) for number in (1, 2, 3))
    save_unconfirmed_events(
        tmp_path, UnconfirmedEvents("part.nc", tuple(UnconfirmedEvent(row, at) for at in other))
    )
    Journal(tmp_path).close()
    with Store.open(tmp_path, read_only=True) as store:
        assert store.runs.read_part_count("part.nc") == 5


def test_confirmed_events_are_not_saved_again_when_control_closes(bench: Bench, tmp_path: Path) -> None:
    screen = bench.screen()
    screen.meet()
    bench.server.outbox.add_event(LogEvent(0.0, "test", "text"))
    for each in screen.events("test"):
        screen.hear(each)
    until(lambda: not bench.server.outbox.unconfirmed_events)
    screen.lose()
    bench.close()
    assert pop_unconfirmed_events(tmp_path) == UnconfirmedEvents()


@pytest.mark.parametrize(
    "data",
    [b"", b"{", b"\xff", b"[]", b"3", b'["a", [[1]]]', b'["a", 3]', b'["a", [["2", "part", "", 1, "", ""]]]'],
)
def test_damaged_unconfirmed_events_are_ignored_and_deleted(tmp_path: Path, data: bytes) -> None:
    (tmp_path / EVENTS_FILE_NAME).write_bytes(data)
    assert pop_unconfirmed_events(tmp_path) == UnconfirmedEvents()
    assert not (tmp_path / EVENTS_FILE_NAME).exists()


@pytest.mark.parametrize("data", [b"", b"{", b"\xff\xfe", b"[1"])
def test_damaged_note_is_ignored(tmp_path: Path, data: bytes) -> None:
    (tmp_path / NOTE_FILE_NAME).write_bytes(data)
    assert pop_interruption_note(tmp_path) == (False, None)


def test_note_without_a_valid_job_means_no_interrupted_job(tmp_path: Path) -> None:
    (tmp_path / NOTE_FILE_NAME).write_text('{"program": 3}')
    assert pop_interruption_note(tmp_path) == (True, None)


def test_saved_note_is_read_back_unchanged(tmp_path: Path) -> None:
    job = broken_off(program="part.nc")
    save_interruption_note(tmp_path, job)
    assert pop_interruption_note(tmp_path) == (True, job)
    delete_interruption_note(tmp_path)
    save_interruption_note(tmp_path / "part.nc" / "no folder", job)
    (tmp_path / "file").write_text("")
    save_interruption_note(tmp_path / "file", job)  # a disk that fails
    assert pop_interruption_note(tmp_path / "file") == (False, None)
