"""The figures of a shift, worked out by hand; and nights in which the clock moves."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator
from datetime import UTC, datetime
from functools import partial
from pathlib import Path

import pytest

from app.cli.main import main
from app.extras.quality.shift_page import make_shift_html
from app.extras.quality.shift_results import (
    Shift,
    ShiftResults,
    ShiftTimesError,
    calculate_shift_results,
    find_shift,
    make_report_period,
    parse_local_time,
)
from core.store.event_log import add_events
from core.store.production import measured_parts, part_cycles, tool_lives
from core.store.production.measured_parts import FeatureRow, ReadingRow
from core.store.production.part_cycles import CycleRow, ProductionStopRow
from core.store.production.tool_lives import ToolLifeRow
from core.store.store import Store
from core.store.store_rows import EventRow
from tests.coded import raises_code, recorded_refusals
from tests.texts import text

DAY = "2026-03-02T"
EIGHT = Shift(
    datetime(2026, 3, 2, 6, tzinfo=UTC).timestamp(), datetime(2026, 3, 2, 14, tzinfo=UTC).timestamp()
)


@pytest.fixture(autouse=True)
def zone(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """A shop in Berlin, whatever the computer says: +1 h, +2 h from 2026-03-29 to 2026-10-25."""
    monkeypatch.setenv("TZ", "Europe/Berlin")
    time.tzset()
    yield
    monkeypatch.undo()
    time.tzset()


def cycle(
    key: str, at: str, end: str | None, seconds: float, part: int = 0, outcome: str = "COMPLETE"
) -> CycleRow:
    ended = f"{DAY}{end}.000Z" if end is not None else None
    return CycleRow(
        key, "pin.nc" if key[0] == "p" else "cap.nc", part, f"{DAY}{at}.000Z", ended, seconds, outcome
    )


ROWS = (
    cycle("p0", "05:50:00", "06:10:00", 1200.0, 7),  # over the beginning: 10 min of it are this shift's
    cycle("p1", "06:10:00", "07:10:00", 3600.0, 8),
    cycle("p2", "07:20:00", "07:50:00", 1500.0, 9),  # held for 5 min
    cycle("c1", "08:00:00", "08:15:00", 900.0, 0, "GIVEN UP"),
    cycle("c2", "09:00:00", None, 0.0, 0, ""),  # the control was killed
    cycle("c3", "13:40:00", "14:20:00", 2400.0, 1),  # over the end: a part of the next shift, 20 min of this
)
STOPS = (
    ProductionStopRow("s0", "", "pin.nc", f"{DAY}07:10:00.000Z", 600.0, "BETWEEN CYCLES"),
    ProductionStopRow("s1", "p2", "pin.nc", f"{DAY}07:30:00.000Z", 300.0, "FEED HOLD", 12),
    ProductionStopRow("s2", "", "cap.nc", f"{DAY}13:30:00.000Z", 3600.0, "BETWEEN CYCLES"),  # 30 min of it
    ProductionStopRow("s3", "", "cap.nc", f"{DAY}03:00:00.000Z", 60.0, "FEED HOLD"),  # of the night before
)


@pytest.fixture
def store(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Store]:
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path))
    with Store.open(tmp_path) as store:
        for row in ROWS:
            store.write(partial(part_cycles.save_cycle, row=row)).result()
        for stop in STOPS:
            store.write(partial(part_cycles.save_stop, row=stop)).result()
        events = [
            EventRow(f"{DAY}08:15:00.000Z", "alarm", "102 following error: X", 9),
            EventRow(f"{DAY}14:00:00.000Z", "alarm", "of the next shift"),
            EventRow(f"{DAY}08:16:00.000Z", "switch", "no alarm"),
        ]
        store.write(lambda c: add_events(c, events)).result()
        feature = FeatureRow(0, "pin.nc", "SPIGOT", "diameter", 10.0, -0.05, 0.05, "tool", 1, 1, 0, 1)
        number = store.write(lambda c: measured_parts.save_feature(c, feature)).result()
        for at, size in (("06:30", 10.05), ("07:00", 10.051), ("15:00", 11.0)):
            reading = ReadingRow(0, number, 8, size, "mm", f"{DAY}{at}:00.000Z", "typed", "")
            store.write(partial(measured_parts.add_reading, row=reading)).result()
        store.write(lambda c: tool_lives.save_tool_life_limits(c, ToolLifeRow(1, 50))).result()
        store.write(lambda c: tool_lives.save_insert_use(c, 1, 20, 60.0)).result()
        yield store


def figures(store: Store, shift: Shift = EIGHT) -> ShiftResults:
    return calculate_shift_results(store, shift, datetime(2026, 3, 3, tzinfo=UTC).timestamp())


def test_shift_counts_the_parts_finished_in_it(store: Store) -> None:
    found = figures(store)
    assert [(p.program_name, p.part_count, dict(p.incomplete_cycles)) for p in found.program_results] == [
        ("pin.nc", 3, {}),
        ("cap.nc", 0, {"GIVEN UP": 1, "CUT OFF": 1}),
    ]
    assert found.program_results[0].cycle_times_s == (1200.0, 3600.0, 1500.0)
    assert found.part_count == 3


def test_availability_and_stops_match_hand_calculation(store: Store) -> None:
    found = figures(store)
    assert found.availability is not None
    # 10 + 60 + 25 + 15 + 20 min of cycles in 8 h; 10 + 5 + 30 min of stops
    assert (found.availability.planned_s, found.availability.producing_s) == (28_800.0, 7_800.0)
    assert [(r.reason, r.times, r.seconds) for r in found.stop_reasons] == [
        ("BETWEEN CYCLES", 2, 2400.0),
        ("FEED HOLD", 1, 300.0),
    ]
    assert (found.total_stop_time_s, found.unrecorded_time_s) == (2700.0, 28_800.0 - 7_800.0 - 2_700.0)


def test_alarms_bad_readings_and_tool_lives_are_listed(store: Store) -> None:
    found = figures(store)
    assert [row.text for row in found.alarms] == ["102 following error: X"]
    assert found.reading_count == 2
    assert [row.value for _, row in found.bad_readings] == [10.051]  # on the limit is good
    assert [(row.number, row.parts) for row in found.tool_lives] == [(1, 20)]


def test_offset_changes_are_listed_with_user_and_time(store: Store) -> None:
    store.offsets.tool_offsets.change_row(1, "wear", {"x": 1.0, "wear_x": -0.01}, who="proposed").result()
    now = datetime.now(UTC).timestamp()
    found = calculate_shift_results(store, Shift(now - 60.0, now + 60.0), now)
    assert [(c.number, c.why, c.who) for c in found.offset_changes] == [(1, "wear", "proposed")]
    page = make_shift_html(found, "GT-75", "now", is_metric=True)
    assert "proposed" in page
    assert "The shift is still running" in page


def test_empty_shift_is_reported_as_empty(store: Store) -> None:
    found = figures(store, Shift(EIGHT.start_s - 30 * 86_400, EIGHT.end_s - 30 * 86_400))
    assert (found.part_count, found.program_results, found.notes) == (
        0,
        (),
        ("No part was started in this period.",),
    )
    assert found.unrecorded_time_s == 28_800.0
    assert "none" in make_shift_html(found, "", "now", is_metric=False)


def test_clock_set_back_is_reported_and_durations_are_retained(store: Store) -> None:
    store.write(lambda c: part_cycles.save_cycle(c, cycle("p9", "07:00:00", "06:40:00", 600.0, 10))).result()
    found = figures(store)
    assert any("was set back" in note for note in found.notes)
    assert 600.0 in found.program_results[0].cycle_times_s
    assert found.availability is not None
    assert found.availability.producing_s == 7_800.0  # it overlaps what ran: nothing is counted twice


@pytest.mark.parametrize(
    ("now", "hours", "moved"),
    [
        (datetime(2026, 3, 29, 8, tzinfo=UTC), 7.0, 3600.0),  # forward in the night
        (datetime(2026, 10, 25, 9, tzinfo=UTC), 9.0, -3600.0),  # back
        (datetime(2026, 11, 23, 9, tzinfo=UTC), 8.0, 0.0),
    ],
)
def test_shift_over_a_clock_change_has_its_true_length(now: datetime, hours: float, moved: float) -> None:
    shift = find_shift((22, 6), now)
    assert (shift.end_s - shift.start_s) / 3600 == hours
    assert shift.clock_change_s == moved
    assert datetime.fromtimestamp(shift.start_s).hour == 22
    assert datetime.fromtimestamp(shift.end_s).hour == 6


def test_current_and_previous_shifts_are_found() -> None:
    at = datetime(2026, 11, 23, 9, tzinfo=UTC)  # 10 h in Berlin
    assert find_shift((6, 14), at).start_s == parse_local_time("2026-11-23 06:00")
    assert find_shift((6, 14), at, 1).start_s == parse_local_time("2026-11-22 06:00")
    assert find_shift((14, 22), at).start_s == parse_local_time("2026-11-22 14:00")
    assert find_shift((6, 6), at).end_s == parse_local_time("2026-11-24 06:00")


@pytest.mark.parametrize(
    ("first", "last", "code", "value"),
    [
        ("yesterday", "2026-03-02", "not-a-time", "yesterday"),
        ("2026-03-02 14:00", "2026-03-02 06:00", "ends-first", "2026-03-02 06:00"),
        ("2026-01-01", "2026-06-01", "too-many-days", "62"),
        ("2026-02-30", "2026-03-02", "not-a-time", "2026-02-30"),
    ],
)
def test_invalid_shift_times_are_rejected(first: str, last: str, code: str, value: str) -> None:
    with raises_code(ShiftTimesError, code, value):
        make_report_period(first, last)


def test_names_are_escaped_on_the_page(store: Store) -> None:
    row = cycle("p7", "10:00:00", "10:10:00", 600.0, 11)._replace(program="<script>alert(1)</script>")
    store.write(lambda c: part_cycles.save_cycle(c, row)).result()
    page = make_shift_html(figures(store), "<b>", "now", is_metric=True)
    assert "<script>" not in page
    assert "&lt;script&gt;" in page
    assert "http" not in page.replace("http-equiv", "")  # nothing is loaded from anywhere


@pytest.mark.usefixtures("store")
class TestCommand:
    """``turndesk shift`` beside a desk that has the store."""

    TIMES = ("--from", "2026-03-02 07:00", "--to", "2026-03-02 15:00")  # 6 to 14 h UTC

    def test_text_json_and_page_show_the_same_values(
        self, capsys: pytest.CaptureFixture[str], tmp_path: Path
    ) -> None:
        assert main(["shift", *self.TIMES]) == 0
        said = capsys.readouterr().out
        assert "Parts: 3\n" in said
        assert text("quality.in-cycle", share=27.1, run="2:10:00", planned="8:00:00") in said
        assert main(["shift", *self.TIMES, "--json"]) == 0
        told = json.loads(capsys.readouterr().out)
        assert (told["parts"], told["producing"], told["stopped"]) == (3, 7800.0, 2700.0)
        assert main(["shift", *self.TIMES, "--report", str(tmp_path / "r.html"), "--metric"]) == 0
        assert "10.051 mm" in (tmp_path / "r.html").read_text()
        assert main(["shift", "--back", "1"]) == 0

    @pytest.mark.parametrize(
        ("argv", "code", "value"),
        [
            (("--from", "2026-03-02"), "from-and-to", "--from"),
            (("--from", "2026-03-02", "--to", "2026-03-01"), "ends-first", "2026-03-02"),
            ((*TIMES, "--back", "2"), "back-and-times", "--back"),
            (("--back", "-1"), "back", "--back -1"),
            (("--metric",), "metric-needs-report", "--metric"),
            (("--report", "/nonexistent/r.html"), "cannot-write", "/nonexistent"),
        ],
    )
    def test_invalid_commands_are_rejected(
        self,
        capsys: pytest.CaptureFixture[str],
        monkeypatch: pytest.MonkeyPatch,
        argv: tuple[str, ...],
        code: str,
        value: str,
    ) -> None:
        refusals = recorded_refusals(monkeypatch)
        assert main(["shift", *argv]) == 2
        said = capsys.readouterr().err
        assert [each.code for each in refusals] == [code]
        assert value in said
        assert said.count("\n") == 1
