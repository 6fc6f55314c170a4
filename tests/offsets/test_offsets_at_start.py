"""No cycle starts with offsets that are no longer those of the table."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from app.desk.state.desk_machine import DeskMachine
from app.desk.status.prompt_line import NOT_HERE, STALE
from core.executor.commands import Command, CycleStart, UseOffsets
from core.executor.snapshot import State
from core.interpreter.shared.job_setup import SecondaryOffset
from core.store.store_rows import Kind
from tests.offsets.conftest import LIMIT, Room, room_on
from tests.texts import pattern


@pytest.fixture
def room(tmp_path: Path) -> Iterator[Room]:
    """At a machine with one start button."""
    with room_on(tmp_path, DeskMachine(two_hand=False)) as made:
        yield made


@pytest.fixture
def posted(room: Room) -> list[Command]:
    """What the one start button of this machine has posted; a program is ready."""
    room.desk.session.load(Path("part.nc"))
    room.desk.session.settled(LIMIT)
    return room.posted


def test_a_program_that_is_ready_starts(room: Room, posted: list[Command]) -> None:
    room.desk.station.press_start()
    assert posted == [CycleStart()]


def test_no_start_while_a_change_is_saved_and_until_the_program_is_read_anew(
    room: Room, posted: list[Command]
) -> None:
    assert room.desk.book.change(Kind.SECONDARY, 1, {"x": 0.1}, "X .2") == ""
    room.desk.station.press_start()
    assert (posted, room.desk.notice) == ([], STALE)
    room.store.write(lambda _connection: None).result(LIMIT)
    room.desk.look()
    room.desk.session.settled(LIMIT)
    room.desk.station.press_start()
    in_force, start = posted
    assert in_force == UseOffsets({}, {1: SecondaryOffset(0.1)})
    assert start == CycleStart()


def test_an_interrupted_job_goes_on_with_its_own_offsets(room: Room, posted: list[Command]) -> None:
    room.at(State.HOLD)
    room.desk.book.change(Kind.SECONDARY, 1, {"x": 0.1}, "X .2")
    room.desk.station.press_start()
    assert posted == [CycleStart()]


def test_no_start_when_the_program_cannot_be_read_again(room: Room, posted: list[Command]) -> None:
    def gone(path: Path) -> None:
        raise FileNotFoundError(2, "No such file or directory", str(path))

    object.__setattr__(room.desk.session.workshop, "read", gone)
    room.desk.book.change(Kind.SECONDARY, 1, {"x": 0.1}, "X .2")
    room.store.write(lambda _connection: None).result(LIMIT)
    room.desk.look()
    room.desk.session.settled(LIMIT)
    room.desk.station.press_start()
    assert CycleStart() not in posted
    assert re.fullmatch(pattern("offsets.cannot-load", program="part.nc"), room.desk.notice)


def test_no_start_beside_the_automatic_page(room: Room, posted: list[Command]) -> None:
    room.desk.window.show_page(starts=False)
    room.desk.station.press_start()
    assert (posted, room.desk.notice) == ([], NOT_HERE)
