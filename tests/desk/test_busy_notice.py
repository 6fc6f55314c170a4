"""COMPUTER BUSY: when the operator reads it, and that it hides no other message."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from app.compose.desk_assembly import create_desk_and_executor
from app.compose.stored_offsets import NO_OFFSETS
from app.desk.data_folder import HOME_VARIABLE
from app.desk.desk import Desk
from app.desk.status.busy_notice import BusyNotice
from core.executor.snapshot import Snapshot
from drivers.wakeups import ManualClock
from tests.texts import text


@pytest.fixture
def desk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Desk]:
    """The screen's model as TurnDesk assembles it."""
    monkeypatch.setenv(HOME_VARIABLE, str(tmp_path))
    made, executor = create_desk_and_executor(None, lambda: NO_OFFSETS, ManualClock())
    executor.run_tick()
    yield made
    made.close()


def late(desk: Desk, seconds: float) -> None:
    """The screen polls a snapshot with this delay."""
    desk.page_registry.notify_frame_watchers(replace(desk.read_snapshot(), hold_delay_s=seconds))


def test_delay_is_shown_and_hides_no_later_message(desk: Desk) -> None:
    late(desk, 0.3)
    assert desk.prompt_line.message == text("desk.hold-reacts-later", seconds="0.3")
    desk.say("the part is not counted")
    assert desk.prompt_line.message == "the part is not counted"


def test_delay_is_shown_after_another_warning(desk: Desk) -> None:
    seconds = iter([0.0, 0.0, 1.0, 5.0, 5.0])
    desk.prompt_line.read_time_s = lambda: next(seconds)
    desk.show_warning("another warning")
    late(desk, 0.3)
    assert desk.prompt_line.message == "another warning"
    desk.prompt_line.remove_expired_texts(desk.read_snapshot())  # after 1 s
    assert desk.prompt_line.message == "another warning"
    desk.prompt_line.remove_expired_texts(desk.read_snapshot())  # after 5 s: longer than a warning is shown
    assert desk.prompt_line.message == text("desk.hold-reacts-later", seconds="0.3")


def test_nothing_is_shown_while_the_computer_is_not_late(desk: Desk) -> None:
    late(desk, 0.0)
    assert desk.prompt_line.message == ""


@pytest.mark.parametrize(
    ("delays", "shown"),
    [
        ([0.2, 0.2, 0.2], ["0.2"]),
        ([0.2, 0.3, 0.39], ["0.2"]),
        ([0.2, 0.4, 0.7, 0.8], ["0.2", "0.4", "0.8"]),  # each at least twice the one before
        ([0.2, 0.0, 0.2], ["0.2", "0.2"]),  # the queue has shrunk in between
        ([0.0, 0.0], []),
    ],
)
def test_delay_is_shown_once_and_again_when_it_has_doubled(delays: list[float], shown: list[str]) -> None:
    said = list[str]()
    notice = BusyNotice(said.append)
    for each in delays:
        notice.check_snapshot(replace(Snapshot(), hold_delay_s=each))
    assert said == [text("desk.hold-reacts-later", seconds=each) for each in shown]
