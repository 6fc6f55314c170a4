"""A desk at which people have access levels."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

import pytest

import resources
from app.compose.desk_assembly import create_desk_and_executor
from app.compose.runs.journal import Journal
from app.compose.stored_offsets import read_stored_offsets
from app.desk.access import SignInSession, UserAccess
from app.desk.desk import Desk
from app.special.special_functions import SpecialFunction, SpecialFunctionsModel
from core.access.access_table import AccessLevel
from core.executor.executor import Executor
from core.executor.snapshot import Snapshot
from core.store.store import Store
from core.store.user_records import UserRow
from drivers.wakeups import ManualClock

LIMIT = 60.0
LEVELS = {"ANNA": AccessLevel.SERVICE, "BEN": AccessLevel.SETUP, "CARLA": AccessLevel.OPERATOR}
T = TypeVar("T", bound=SpecialFunction)
R = TypeVar("R", bound="Room")


@dataclass
class Room:
    desk: Desk
    executor: Executor
    clock: ManualClock
    journal: Journal
    at: float = 1000.0

    @property
    def access(self) -> UserAccess:
        return self.desk.user_access

    @property
    def store(self) -> Store:
        store = self.journal._store
        assert store is not None
        return store

    def run(self, ticks: int = 20) -> None:
        for _ in range(ticks):
            self.clock.advance(0.01)
            self.executor.run_tick()
        self.desk.update()

    def settle(self) -> None:
        """Until what was asked of workers and of the disk is there."""
        self.store.write(lambda _connection: None).result(LIMIT)
        self.desk.update()
        self.desk.offset_book.poll_saving()

    def find(self, kind: type[T]) -> T:
        special = self.desk.page_registry.find_model(SpecialFunctionsModel)
        assert special is not None
        return next(each for each in special.functions if isinstance(each, kind))

    def enter_people(self) -> None:
        """No PIN fits what is stored of theirs."""
        for name, level in LEVELS.items():
            self.journal.require_store().people.save_user(UserRow(name, level, b"salt", b"hash")).result()
        self.access.reload()

    def sign_in(self, name: str) -> None:
        """As if the PIN was entered."""
        self.access.user_name, self.access.access_level = name, LEVELS[name]
        self.access.record_activity()
        self.settle()

    def log(self, kind: str) -> list[tuple[str, str]]:
        self.settle()
        return [(row.text, row.who) for row in self.store.events.read_events(kinds={kind})][::-1]


class NoPins(SignInSession):
    """A session in which nothing happens, where signing in is not installed."""

    def record_activity(self) -> None:
        pass

    def update(self, snapshot: Snapshot) -> None:
        pass

    def reload(self) -> None:
        pass

    def close(self) -> None:
        pass


@contextmanager
def opened_room(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, kind: type[R]) -> Iterator[R]:
    """A desk of this kind of room, with an empty store."""
    file = tmp_path / "own.toml"
    file.write_text(resources.read_machine_file("gt75.toml"))
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path / "home"))
    clock, journal = ManualClock(), Journal.open_default()
    desk, executor = create_desk_and_executor(str(file), read_stored_offsets, clock, journal)
    made = kind(desk, executor, clock, journal)
    made.access.read_time_s = lambda: made.at
    if made.access.sign_in_session is None:
        made.access.sign_in_session = NoPins()
    made.run(2)
    yield made
    desk.close()
    journal.close()


@pytest.fixture
def room(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Room]:
    """A desk with an empty store."""
    with opened_room(tmp_path, monkeypatch, Room) as made:
        yield made
