"""Setup of the tour: its model with a temporary data folder, and the checks whether the tour may begin.

The tour has its own offsets, programs and counts. The data folder of the operator is therefore never
changed, even if the tour is killed.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from app.compose.backends.backend_entry import has_inverter, is_simulated
from app.compose.program_proving import get_samples_folder
from app.desk.data_folder import HOME_VARIABLE, find_data_folder
from app.desk.programs.program_choice import LAST_PROGRAM_SETTING
from app.desk.screen_settings import SETTINGS_KEY
from app.desk.stored_part import StoredPart
from app.offsets.offsets_file import read_offset_rows, read_shape_rows
from app.programs.atomic_files import write_new_file
from core.extras.tour.tour_script import STICK_OUT_IN, STOCK, TOOLS_PATH, read_programs
from core.file_lock import create_unfinished_folder, remove_abandoned_files
from core.store.offsets.offset_tables import ChangeReason
from core.store.production import part_cycles
from core.store.store import Store
from core.store.store_errors import StoreError
from core.store.store_export import import_programs_and_offsets
from core.store.store_file import has_store
from core.store.store_rows import MM_PER_INCH, FieldValue, OffsetKind

if TYPE_CHECKING:
    from app.desk.desk import Desk
    from core.machine.machine_model import Machine

SHOWN_SETTING = "tour_shown"  # Setting that is true after the tour was shown with this data folder.
_LESSONS_SETTING = "completed_lessons"
_PROGRAMS_FOLDER_NAME = "programs"
_TOUR_FOLDER_NAME = "tour"
_CHANGE_REASON = ChangeReason("tools of the tour", "import")


def is_first_start(folder: Path) -> bool:
    """Return whether the data folder is unused, so that the tour can begin.

    The folder then has no cycle, no program of the operator, no completed lesson, no earlier tour and no
    tour that is running. The result is False if the store cannot be read.
    """
    remove_abandoned_files(folder)
    if any(folder.glob(f".{_TOUR_FOLDER_NAME}.*")) or any((folder / _PROGRAMS_FOLDER_NAME).glob("*")):
        return False
    with suppress(StoreError, OSError), Store.open(folder, read_only=True) as store:
        read = store.settings.read_setting
        last = read(LAST_PROGRAM_SETTING)
        has_own_program = isinstance(last, str) and Path(last).parent != get_samples_folder()
        has_run = any(row.started for row in store.runs.read_run_records())
        has_cycle = has_run or bool(store.run_query(part_cycles.read_cycles, None, 1))
        return not (has_cycle or has_own_program or read(SHOWN_SETTING) or read(_LESSONS_SETTING))
    return False


def save_tour_shown(folder: Path) -> None:
    """Save that the tour was shown, unless the folder has no store or a running screen uses the store."""
    if not has_store(folder):
        return
    with suppress(StoreError, OSError), Store.open(folder) as store:
        store.settings.save_setting(SHOWN_SETTING, True).result()


def is_fully_simulated(machine: Machine | None) -> bool:
    """Return whether all drivers of a machine are simulated, so that the tour may move it."""
    return machine is not None and is_simulated(machine) and not has_inverter(machine)


def build_tour_desk() -> Desk:
    """Return the operator screen's model for the shipped simulated lathe, with the current data folder."""
    from app.compose.screen_desk import build_desk  # only if the tour begins, because it loads all pages

    return build_desk()


@contextmanager
def use_tour_folder() -> Iterator[Path]:
    """Create the data folder of the tour, and use it in this process until the end of the context.

    The folder is then deleted. Raises OSError or StoreError if the folder cannot be written.
    """
    own_folder, environment_value = find_data_folder(), os.environ.get(HOME_VARIABLE)
    own_folder.mkdir(parents=True, exist_ok=True)
    with create_unfinished_folder(own_folder / _TOUR_FOLDER_NAME) as folder:
        _fill_folder(folder, _read_screen_settings(own_folder))
        os.environ[HOME_VARIABLE] = str(folder)
        try:
            yield folder
        finally:
            if environment_value is None:
                del os.environ[HOME_VARIABLE]
            else:
                os.environ[HOME_VARIABLE] = environment_value


def _read_screen_settings(folder: Path) -> Mapping[str, object]:
    """Return the operator's screen settings, such as the language, or {} without a readable store."""
    if has_store(folder):
        with suppress(StoreError, OSError), Store.open(folder, read_only=True) as store:
            stored = store.settings.read_setting(SETTINGS_KEY)
            return stored if isinstance(stored, dict) else {}
    return {}


def _fill_folder(folder: Path, screen_settings: Mapping[str, object]) -> None:
    """Write the programs, tools, stock and screen settings of the tour."""
    programs_folder = folder / _PROGRAMS_FOLDER_NAME
    programs_folder.mkdir()
    part = StoredPart(STOCK, STICK_OUT_IN * MM_PER_INCH)
    settings: dict[str, object] = {SETTINGS_KEY: {**screen_settings, "first_job": False}}
    for name, text in read_programs().items():
        write_new_file(programs_folder / name, text.encode("ascii"))
        settings |= part.make_stored_settings(name)
    tools, _, _ = read_offset_rows(TOOLS_PATH)
    offsets: dict[OffsetKind, dict[int, dict[str, FieldValue]]] = {
        OffsetKind.TOOL: {number: row._asdict() for number, row in tools.items()},
        OffsetKind.SHAPE: {number: row._asdict() for number, row in read_shape_rows(TOOLS_PATH).items()},
    }
    with Store.open(folder) as store:
        store.write(
            partial(import_programs_and_offsets, programs={}, offsets=offsets, reason=_CHANGE_REASON)
        ).result()
        for key, value in settings.items():
            store.settings.save_setting(key, value).result()
