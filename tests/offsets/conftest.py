"""A desk with a store of its own, and a machine whose state the test decides."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path

import pytest

from app.desk.desk import Desk
from app.desk.programs.program_folder import ProgramFolders
from app.desk.programs.program_loading import LoadingSteps, ProgramLoader, ProvedJob
from app.desk.state.desk_clock import DeskClock
from app.desk.state.desk_control import DeskControl
from app.desk.state.desk_machine import DeskMachine
from app.offsets.offset_book import OffsetBook
from app.offsets.secondary_offsets import SecondaryOffsetEntry
from app.offsets.tool_offsets import ToolOffsetTable
from app.path.path_picture import PictureBuilder
from core.executor.commands import Command
from core.executor.job import Proof, make_job
from core.executor.snapshot import MachineState, Snapshot
from core.interpreter.shared.job_setup import InterpreterSetup
from core.language.source import ProgramSource
from core.store.store import Store
from tests.screen.yes import read

LIMIT = 60.0


@dataclass
class Room:
    """Everything around one offset page."""

    desk: Desk
    store: Store
    now: list[Snapshot]
    loads: list[str] = field(default_factory=list)
    posted: list[Command] = field(default_factory=list)

    def at(
        self, state: MachineState = MachineState.IDLE, *, metric: bool = False, diameter: bool = False
    ) -> None:
        """The machine is in this state and mode."""
        modal = self.now[0].modal._replace(metric=metric, diameter=diameter)
        self.now[0] = replace(self.now[0], state=state, modal=modal)

    def page(self) -> SecondaryOffsetEntry:
        """F9, on the desk's book."""
        return SecondaryOffsetEntry(self.desk)

    def grid(self) -> ToolOffsetTable:
        """F8, on the desk's book."""
        return ToolOffsetTable(self.desk)

    def enter(self, page: SecondaryOffsetEntry | ToolOffsetTable, *answers: str, asked: bool = False) -> None:
        """Type each answer with its Return, and wait until what they change is saved.

        ``asked``: the last answer is questioned, and Y is pressed; otherwise nothing may be questioned.
        """
        page.update(self.now[0])
        for answer in answers:
            for key in answer:
                assert page.handle_key(key)
            assert page.handle_key("Enter")
        assert bool(self.desk.confirmation_key) == asked, self.desk.prompt_notice
        if asked:
            self.confirm()
        self.settle(page)

    def confirm(self) -> None:
        """Press Y to the question about a suspicious change, a new master or an undo."""
        read(self.desk)
        self.desk.confirm_question()

    def settle(self, page: SecondaryOffsetEntry | ToolOffsetTable) -> None:
        """Wait for the disk, then look as a frame would."""
        self.store.write(lambda _connection: None).result(LIMIT)
        self.desk.update()
        page.update(self.now[0])


@contextmanager
def room_on(
    folder: Path, machine: DeskMachine | None = None, book: OffsetBook | None = None
) -> Iterator[Room]:
    """A desk on this machine; its store is in a folder, and its book reads that unless one is given."""
    store, now, loads = Store.open(folder / "home"), [Snapshot(state=MachineState.IDLE)], []
    posted: list[Command] = []

    def read(path: Path) -> ProgramSource:
        loads.append(path.name)
        return ProgramSource(path.name, "G90\nM30\n")

    workshop = LoadingSteps(
        read,
        lambda source, block_delete: make_job(source, InterpreterSetup(block_delete=block_delete)),
        lambda job, _watch: ProvedJob(Proof(job.digest, ())),
        lambda _job, _watch: PictureBuilder().build_picture(),
    )
    desk = Desk(
        DeskControl(posted.append, lambda: now[0]),
        ProgramLoader(workshop, lambda _command: None),
        ProgramFolders(()),
        machine=machine or DeskMachine(),
        clock=DeskClock(read_seconds=lambda: 0.0),
        offset_book=book or OffsetBook(store),
    )
    yield Room(desk, store, now, loads, posted)
    desk.close()
    store.close()


@pytest.fixture
def room(tmp_path: Path) -> Iterator[Room]:
    with room_on(tmp_path) as made:
        yield made
