"""No cycle starts with offsets that are no longer those of the table."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from app.desk.state.desk_machine import DeskMachine
from app.desk.status.prompt_line import RELOAD_IN_PROGRESS, START_ON_AUTOMATIC
from core.executor.commands import Command, CycleStart, UseOffsetTables
from core.executor.snapshot import MachineState
from core.interpreter.shared.job_setup import SecondaryOffset
from core.store.store_rows import OffsetKind
from tests.offsets.conftest import LIMIT, Room, room_on
from tests.texts import pattern


@pytest.fixture
def room(tmp_path: Path) -> Iterator[Room]:
    """At a machine with one start button."""
    with room_on(tmp_path, DeskMachine(has_two_hand_start=False)) as made:
        yield made


@pytest.fixture
def posted(room: Room) -> list[Command]:
    """What the one start button of this machine has posted; a program is ready."""
    room.desk.program_loader.start_loading(Path("part.nc"))
    room.desk.program_loader.wait_until_loaded(LIMIT)
    return room.posted


def test_a_program_that_is_ready_starts(room: Room, posted: list[Command]) -> None:
    room.desk.station_keys.press_start()
    assert posted == [CycleStart()]


def test_start_waits_for_saved_change_and_reloaded_program(room: Room, posted: list[Command]) -> None:
    assert room.desk.offset_book.change_fields(OffsetKind.SECONDARY, 1, {"x": 0.1}, "X .2") == ""
    room.desk.station_keys.press_start()
    assert (posted, room.desk.prompt_notice) == ([], RELOAD_IN_PROGRESS)
    room.store.write(lambda _connection: None).result(LIMIT)
    room.desk.update()
    room.desk.program_loader.wait_until_loaded(LIMIT)
    room.desk.station_keys.press_start()
    in_force, start = posted
    assert in_force == UseOffsetTables({}, {1: SecondaryOffset(0.1)})
    assert start == CycleStart()


def test_interrupted_job_continues_with_its_own_offsets(room: Room, posted: list[Command]) -> None:
    room.at(MachineState.HOLD)
    room.desk.offset_book.change_fields(OffsetKind.SECONDARY, 1, {"x": 0.1}, "X .2")
    room.desk.station_keys.press_start()
    assert posted == [CycleStart()]


def test_start_is_rejected_when_program_cannot_be_reloaded(room: Room, posted: list[Command]) -> None:
    def gone(path: Path) -> None:
        raise FileNotFoundError(2, "No such file or directory", str(path))

    object.__setattr__(room.desk.program_loader.loading_steps, "read_source", gone)
    room.desk.offset_book.change_fields(OffsetKind.SECONDARY, 1, {"x": 0.1}, "X .2")
    room.store.write(lambda _connection: None).result(LIMIT)
    room.desk.update()
    room.desk.program_loader.wait_until_loaded(LIMIT)
    room.desk.station_keys.press_start()
    assert CycleStart() not in posted
    assert re.fullmatch(pattern("offsets.cannot-load", program="part.nc"), room.desk.prompt_notice)


def test_start_is_rejected_outside_automatic_page(room: Room, posted: list[Command]) -> None:
    room.desk.window_state.set_page_properties(can_start=False)
    room.desk.station_keys.press_start()
    assert (posted, room.desk.prompt_notice) == ([], START_ON_AUTOMATIC)
