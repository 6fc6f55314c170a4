"""What a desk remembers, and the pages that show it: special functions, list of programs, settings.

Also what it counts of production, its scope, and the status file of its machine.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Collection
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from app.compose.runs.journal import Journal
from app.desk.access import Access
from app.desk.data_folder import RECORDS, data_folder
from app.desk.desk import Desk
from app.desk.pages.first_job import FirstJob
from app.desk.persistence import Persistence
from app.desk.programs.program_loading import LoadingSteps
from app.desk.screen_settings import SettingsBook
from app.offsets.mill_touch import MillLives
from app.production.parts_book import PartsBook, tools_of
from app.production.parts_watch import PartsWatch
from app.production.tool_life_watch import ToolLifeWatch
from app.programs.run_history import PartCounter, RunHistory
from app.shopfloor.floor_reading import UNKNOWN, FloorReader
from app.shopfloor.status_file import NAME, StatusFile, StatusKeeper, status_of
from app.special.lamps_and_sound import DeskSounds
from core.executor.snapshot import Snapshot
from core.machine.machine_model import Machine
from core.records.record import Channel, Record
from core.records.recordings import Recordings
from core.store.store_errors import StoreError
from core.store.store_rows import Kind, utc_now

if TYPE_CHECKING:
    from app.programs.program_list import ProgramList
    from app.programs.program_rows import DrawThumbnail
    from app.scope.scope_curves import LiveSamples
    from app.scope.scope_model import Scope
    from app.special.special_functions import SpecialFunctions


def furnish(
    desk: Desk,
    machine: Machine,
    persistence: Persistence,
    workshop: LoadingSteps,
    own: Path | None = None,
    thumbnail: DrawThumbnail | None = None,
) -> None:
    """Give the desk what it remembers, and the pages that show it.

    ``workshop`` keeps nothing of what it proves; ``own`` is the operator's folder; ``thumbnail`` draws the
    part of a program.
    """
    desk.access = desk.book.access = Access(persistence, desk.say, desk.clock)
    desk.settings = SettingsBook(persistence)
    with suppress(StoreError):  # a store that cannot be read is reported elsewhere
        desk.first_job = FirstJob.stored(persistence)
    desk.counter = PartCounter(persistence)
    desk.record = RunHistory(persistence)
    own = own or data_folder() / "programs"
    sounds = DeskSounds(desk, persistence)
    desk.attach(sounds)
    desk.frame_watchers.append(sounds.see)
    desk.attach_later(
        "app.special.special_functions.SpecialFunctions",
        partial(_special_functions, desk, machine, persistence, workshop, own, sounds),
    )
    desk.attach_later(
        "app.programs.program_list.ProgramList", partial(_files, desk, persistence, workshop, own, thumbnail)
    )


def _special_functions(
    desk: Desk,
    machine: Machine,
    persistence: Persistence,
    workshop: LoadingSteps,
    own: Path,
    sounds: DeskSounds,
) -> SpecialFunctions:
    from app.compose.special_functions_desk import special_functions

    return special_functions(desk, machine, persistence, workshop, own, sounds)


def _files(
    desk: Desk, persistence: Persistence, workshop: LoadingSteps, own: Path, thumbnail: DrawThumbnail | None
) -> ProgramList:
    from app.compose.program_list_desk import program_list

    return program_list(desk, persistence, workshop, own, thumbnail)


def give_production(desk: Desk, machine: Machine, journal: Journal | None) -> None:
    """Give the desk what it counts and keeps of production."""
    tools = tools_of(machine.kind)
    book = journal.parts_book(tools) if journal is not None else PartsBook(tools=tools)
    book.access = desk.access
    watch = PartsWatch(desk, book, ToolLifeWatch(book))
    desk.attach(watch)
    desk.watches.append(watch)
    if tools is Kind.MILL_TOOL:
        lives = watch.lives
        desk.attach(MillLives(lives.lives, lambda number, cut: lives.set_used(number, cut, desk.say)))


@dataclass(frozen=True, slots=True)
class RecordedSamples:
    """The recorder's ring, as the page reads it."""

    recorder: Recordings

    @property
    def channels(self) -> tuple[Channel, ...]:
        """What is recorded."""
        return self.recorder.ring.recorded.channels

    @property
    def last(self) -> float:
        """Time of the newest sample."""
        return self.recorder.ring.samples.last

    @property
    def lasts(self) -> float:
        """Seconds that are kept."""
        return self.recorder.ring.recorded.lasts

    def between(self, begin: float, end: float, names: Collection[str] | None = None) -> Record:
        """The samples from ``begin`` up to and with ``end``."""
        return self.recorder.between(begin, end, names)


def give_scope(desk: Desk, live: LiveSamples | None = None) -> None:
    """The page SCOPE on ``live``, or on what the desk's recorder samples; with neither it has files alone.

    The scope is made when somebody first opens its page.
    """
    desk.attach_later("app.scope.scope_model.Scope", partial(_scope, desk, live))
    desk.open_record = lambda name: _scope_of(desk).open_alarm(name)


def _scope(desk: Desk, live: LiveSamples | None) -> Scope:
    from app.scope.record_shelf import RecordShelf
    from app.scope.scope_model import Scope
    from core.records.record_file import open_record, save_record, write_csv

    if live is None and desk.recorder is not None:
        live = RecordedSamples(desk.recorder)
    return Scope(desk, live, RecordShelf(data_folder() / RECORDS, save_record, open_record, write_csv))


def _scope_of(desk: Desk) -> Scope:
    from app.scope.scope_model import Scope

    scope = desk.attached(Scope)
    assert scope is not None
    return scope


def keep_status(machine: Machine, snapshot: Callable[[], Snapshot], folder: Path) -> Callable[[], None]:
    """Begin to keep the status file in this folder; returns how to end it."""
    reader = FloorReader(machine, time.monotonic)
    keeper = StatusKeeper(
        StatusFile(folder / NAME, utc_now),
        lambda: status_of(machine.name, reader.look(snapshot())),
        status_of(machine.name, UNKNOWN),
    )
    keeper.start()
    return keeper.close
