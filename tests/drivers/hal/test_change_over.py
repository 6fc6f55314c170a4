"""The change-over of HAL's two streams by hand: a servo thread that is past it when it is asked for."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable

import pytest

from drivers.hal.bridge.row_streams import RowStreamPair, SetpointRow

PERIOD = 0.001  # s
SPEED = 20.0  # mm/s
AHEAD = 40  # rows


class Rows:
    """``hal.stream`` without HAL."""

    def __init__(self) -> None:
        self.rows: deque[SetpointRow] = deque()

    @property
    def row_count(self) -> int:
        return len(self.rows)

    @property
    def writable(self) -> bool:
        return True

    @property
    def readable(self) -> bool:
        return bool(self.rows)

    def write(self, row: SetpointRow) -> None:
        self.rows.append(row)

    def read(self) -> SetpointRow:
        return self.rows.popleft()


class Thread:
    """Row by row from the stream that plays; both go over in the period of the row that is asked for."""

    def __init__(self) -> None:
        self.streams = Rows(), Rows()
        self.pins: dict[str, float] = {}
        self.rows = RowStreamPair(self.streams, self.pins)
        self.plays = 0
        self.played: list[SetpointRow] = []
        for n in range(1, AHEAD + 1):
            self.rows.write_row(n * PERIOD, goes_on(n * PERIOD))

    def run(self, periods: int) -> None:
        for _ in range(periods):
            row = self.streams[self.plays].read()
            self.played.append(row)
            if row[0] == self.pins["switch-at"]:
                self.plays = int(self.pins["play-b"])

    def seen(self) -> bool:
        """The bridge looks again."""
        self.rows.record_played_row(int(self.played[-1][0]))
        return self.rows.finish_stream_change(bool(self.plays))

    def late(self, what: Callable[[float], SetpointRow], at: float, past: int) -> None:
        """Asked for, but the thread was past it by so many rows before it has heard of it."""
        assert self.rows.recall_rows(at, what)
        asked, self.pins["switch-at"] = self.pins["switch-at"], -1.0
        self.run(int(asked) - int(self.played[-1][0]) + past)
        self.pins["switch-at"] = asked


def goes_on(t: float) -> SetpointRow:
    return SPEED * t, 0.0


def stops_at(stop: float) -> Callable[[float], SetpointRow]:
    return lambda t: goes_on(min(t, stop))


@pytest.fixture
def thread() -> Thread:
    made = Thread()
    made.run(5)
    assert made.seen()
    return made


def test_late_path_change_is_made_where_both_paths_still_match(thread: Thread) -> None:
    new = stops_at(0.030)
    thread.late(new, 0.010, past=6)
    assert thread.seen()
    thread.run(AHEAD - len(thread.played))
    assert thread.seen()
    assert thread.played == [(float(n), *new(n * PERIOD)) for n in range(1, AHEAD + 1)]


def test_path_change_that_is_late_twice_is_requested_again(thread: Thread) -> None:
    new = stops_at(0.035)
    thread.late(new, 0.010, past=3)
    assert thread.seen()
    asked, thread.pins["switch-at"] = thread.pins["switch-at"], -1.0
    thread.run(int(asked) - int(thread.played[-1][0]) + 3)
    thread.pins["switch-at"] = asked
    assert thread.seen()
    thread.run(AHEAD - len(thread.played))
    assert thread.played == [(float(n), *new(n * PERIOD)) for n in range(1, AHEAD + 1)]


def test_path_change_received_after_the_paths_diverge_fails(thread: Thread) -> None:
    """HAL has played on where it was to brake: that is told, and who is told brakes from there."""
    thread.late(stops_at(0.012), 0.010, past=6)
    assert not thread.seen()


def test_path_change_beyond_the_last_row_of_the_old_stream_fails(thread: Thread) -> None:
    new = stops_at(1.0)
    thread.late(new, 0.034, past=4)  # five rows are left, and the other stream would be met behind them
    thread.rows.write_row(0.041, new(0.041))
    assert not thread.seen()


def test_cam_rows_match_until_the_given_divergence_time(thread: Thread) -> None:
    def tangent(t: float) -> SetpointRow:
        return 0.0, SPEED * t

    assert thread.rows.recall_rows(0.010, tangent, 0.025)
    asked, thread.pins["switch-at"] = thread.pins["switch-at"], -1.0
    thread.run(int(asked) - 5 + 4)
    thread.pins["switch-at"] = asked
    assert thread.seen()
    thread.run(12)
    assert thread.seen()
    assert thread.played[-1] == (float(len(thread.played)), *tangent(len(thread.played) * PERIOD))


def test_setpoints_already_played_by_hal_are_accepted_if_they_match(thread: Thread) -> None:
    thread.run(10)
    thread.seen()
    assert thread.rows.find_first_recallable_row(0.012) is None
    assert thread.rows.has_same_locked_rows(0.012, stops_at(0.030))
    assert not thread.rows.has_same_locked_rows(0.012, stops_at(0.014))
    assert not thread.rows.has_same_locked_rows(-1.0, stops_at(0.030))  # of that nobody knows any more
