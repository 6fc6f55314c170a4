"""A desk at which people have access levels."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

import pytest

import resources
from app.compose.desk_assembly import desk_and_executor
from app.compose.runs.journal import Journal
from app.compose.stored_offsets import stored_offsets
from app.desk.access import Access, Session
from app.desk.desk import Desk
from app.special.special_functions import SpecialFunction, SpecialFunctions
from core.access.access_table import Level
from core.executor.executor import Executor
from core.executor.snapshot import Snapshot
from core.store.people import PersonRow
from core.store.store import Store
from drivers.waiting import StepClock

LIMIT = 60.0
LEVELS = {"ANNA": Level.SERVICE, "BEN": Level.SETUP, "CARLA": Level.OPERATOR}
T = TypeVar("T", bound=SpecialFunction)
R = TypeVar("R", bound="Room")


@dataclass
class Room:
    desk: Desk
    executor: Executor
    clock: StepClock
    journal: Journal
    at: float = 1000.0

    @property
    def access(self) -> Access:
        return self.desk.access

    @property
    def store(self) -> Store:
        store = self.journal._store
        assert store is not None
        return store

    def run(self, ticks: int = 20) -> None:
        for _ in range(ticks):
            self.clock.advance(0.01)
            self.executor.tick()
        self.desk.look()

    def settle(self) -> None:
        """Until what was asked of workers and of the disk is there."""
        self.store.write(lambda _connection: None).result(LIMIT)
        self.desk.look()
        self.desk.book.poll()

    def find(self, kind: type[T]) -> T:
        special = self.desk.pages.find(SpecialFunctions)
        assert special is not None
        return next(each for each in special.functions if isinstance(each, kind))

    def enter_people(self) -> None:
        """No PIN fits what is stored of theirs."""
        for name, level in LEVELS.items():
            self.journal.opened().people.save_person(PersonRow(name, level, b"salt", b"hash")).result()
        self.access.reload()

    def sign_in(self, name: str) -> None:
        """As if the PIN was entered."""
        self.access.name, self.access.level = name, LEVELS[name]
        self.access.used()
        self.settle()

    def log(self, kind: str) -> list[tuple[str, str]]:
        self.settle()
        return [(row.text, row.who) for row in self.store.events.read_events(kinds={kind})][::-1]


class NoPins(Session):
    """A session in which nothing happens, where signing in is not installed."""

    def used(self) -> None:
        pass

    def look(self, snapshot: Snapshot) -> None:
        pass

    def reload(self) -> None:
        pass

    def close(self) -> None:
        pass


@contextmanager
def opened_room(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, kind: type[R]) -> Iterator[R]:
    """A desk of this kind of room, with an empty store."""
    file = tmp_path / "own.toml"
    file.write_text(resources.machine_file("gt75.toml"))
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path / "home"))
    clock, journal = StepClock(), Journal.at_home()
    desk, executor = desk_and_executor(str(file), stored_offsets, clock, journal)
    made = kind(desk, executor, clock, journal)
    made.access.clock = lambda: made.at
    if made.access.session is None:
        made.access.session = NoPins()
    made.run(2)
    yield made
    desk.close()
    journal.close()


@pytest.fixture
def room(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Room]:
    """A desk with an empty store."""
    with opened_room(tmp_path, monkeypatch, Room) as made:
        yield made
