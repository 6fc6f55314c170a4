"""What a desk remembers, and the pages that show it: special functions, list of programs, settings."""

from __future__ import annotations

from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from app.desk.access import Access
from app.desk.data_folder import data_folder
from app.desk.desk import Desk
from app.desk.first_job import FirstJob
from app.desk.persistence import Persistence
from app.desk.program_loading import LoadingSteps
from app.desk.screen_settings import SettingsBook
from app.programs.run_history import PartCounter, RunHistory
from app.special.lamps_and_sound import DeskSounds
from core.machine.machine_model import Machine
from core.store.store_errors import StoreError

if TYPE_CHECKING:
    from app.programs.program_list import ProgramList
    from app.programs.program_rows import DrawThumbnail
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
    desk.hears = sounds.see
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
