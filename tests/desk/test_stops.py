"""What F7 lists: alarms, E-stops and stops, from the executor's events and from the store's log."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.desk.status.alarm_log import MAX_ENTRIES, AlarmLog, parse_alarm
from core.alarms import CATALOG, AlarmCode
from core.executor.raised_alarm import format_log_line, make_alarm
from core.executor.snapshot import LogEvent
from core.store.store_rows import EventRow
from tests.texts import text as wording


def event(code: AlarmCode, detail: str = "", line: int = 0) -> LogEvent:
    alarm = make_alarm(code, detail, line, 1.0)
    kind = {"estop": "estop", "feed-hold": "stop"}.get(code, "alarm")
    return LogEvent(1.0, kind, format_log_line(alarm), line, alarm)


def row(event: LogEvent, at: str = "2020-02-03T04:05:06Z") -> EventRow:
    return EventRow(at, event.kind, event.text, event.line_number)


@pytest.fixture
def log() -> AlarmLog:
    return AlarmLog(lambda: "09:41:07")


def test_newest_stop_is_listed_first_with_its_time(log: AlarmLog) -> None:
    log.hear(event("following", "X is 2.345 off its setpoint", 4))
    log.hear(event("estop"))
    assert [(entry.local_time, entry.alarm.number) for entry in log.entries] == [
        ("09:41:07", 701),
        ("09:41:07", 102),
    ]
    assert log.entries[1].alarm.cause == wording("screen.off-setpoint", axis="X", distance="2.345")


def test_stop_entry_links_to_the_recording_before_it(log: AlarmLog) -> None:
    log.hear(replace(event("following"), record_name="today-alarm102.scope"))
    log.add_stored_entries(
        [row(event("following"))._replace(record="before-alarm102.scope"), row(event("estop"))]
    )
    records = [entry.recording_name for entry in log.entries]
    assert records == ["today-alarm102.scope", "before-alarm102.scope", ""]


def test_event_that_is_not_a_stop_is_not_listed(log: AlarmLog) -> None:
    log.hear(LogEvent(1.0, "switch", "single block on"))
    assert log.entries == ()


def test_number_of_stop_entries_is_limited(log: AlarmLog) -> None:
    for line in range(MAX_ENTRIES + 10):
        log.hear(event("feed-hold", line=line))
    assert len(log.entries) == MAX_ENTRIES
    log.hear(event("estop"))
    assert len(log.entries) == MAX_ENTRIES
    assert log.entries[0].alarm.code == "estop"


def test_stored_stops_are_listed_after_new_ones(log: AlarmLog) -> None:
    log.hear(event("estop"))
    log.add_stored_entries([row(event("following", "Z is 1.2 off its setpoint", 7))])
    today, before = log.entries
    assert today.alarm.code == "estop"
    assert before.local_time.startswith("2020-02-0")  # a day that is not today
    alarm = before.alarm
    assert (alarm.number, alarm.code, alarm.line) == (102, "following", 7)
    assert alarm.cause == wording("screen.off-setpoint", axis="Z", distance="1.2")
    assert alarm.remedy == CATALOG["following"].remedy


@pytest.mark.parametrize("code", sorted(CATALOG))
def test_every_stored_alarm_is_read_back(code: AlarmCode) -> None:
    made = event(code, "what was seen: here", 3)
    back = parse_alarm(row(made))
    assert back is not None
    assert made.alarm is not None
    assert (back.number, back.code, back.text, back.cause, back.line) == (
        *(made.alarm.number, code, made.alarm.text),
        *(made.alarm.cause, 3),
    )


@pytest.mark.parametrize(
    ("kind", "text"),
    [
        ("alarm", "FOLLOWING ERROR: X"),  # as older versions wrote it
        ("stop", "feed hold"),
        ("alarm", "999 NOTHING: of ours"),
        ("part", "102 FOLLOWING ERROR: X"),
        ("alarm", ""),
    ],
)
def test_unreadable_stop_event_is_skipped(log: AlarmLog, kind: str, text: str) -> None:
    log.add_stored_entries([EventRow("rubbish", kind, text, 0)])
    assert log.entries == ()


def test_invalid_time_is_shown_unchanged(log: AlarmLog) -> None:
    log.add_stored_entries([row(event("estop"), at="yesterday")])
    assert log.entries[0].local_time == "yesterday"
