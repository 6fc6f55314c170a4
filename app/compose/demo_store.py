"""Demo with a separate data store for the offsets and stock of the sample programs.

The user can change the data of the demo.
"""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path

from app.compose.backends.backend_entry import has_inverter, is_simulated
from app.compose.machine.machine_setup import read_machine
from app.compose.program_proving import get_samples_folder
from app.desk.command_errors import CommandError
from app.desk.data_folder import HOME_VARIABLE, find_data_folder
from app.desk.programs.program_choice import LAST_PROGRAM_SETTING
from app.desk.screen_settings import SETTINGS_KEY as SCREEN
from app.desk.stored_part import StoredPart
from app.offsets.offsets_file import read_offset_rows
from core.interpreter.shared.units import MM_PER_INCH
from core.language.source import Dialect, guess_dialect
from core.message import Message
from core.store.offsets.offset_tables import ChangeReason
from core.store.store import Store
from core.store.store_errors import StoreError
from core.store.store_export import import_programs_and_offsets
from core.store.store_file import has_store
from core.store.store_rows import FieldValue, OffsetKind

DEMO_FOLDER_NAME = "demo"  # subfolder of the data folder
_CHANGE_REASON = "offsets of the sample programs"


def open_demo_data_folder(machine_file: str | None) -> Path:
    """Switch this process to the data folder of the demo and return the folder.

    On the first call, the offsets and the stock of the sample programs are written to the folder. Later
    changes remain. Raises CommandError for a real machine, or if the store cannot be written.
    """
    machine = read_machine(machine_file)
    if not is_simulated(machine) or has_inverter(machine):
        raise CommandError(
            Message(
                "--demo is only for simulated machines, but {source} is for a real machine",
                source=machine.source,
            ),
            "real-machine",
        )
    folder = find_data_folder() / DEMO_FOLDER_NAME
    if not has_store(folder):
        _seed(folder)
    os.environ[HOME_VARIABLE] = str(folder)
    return folder


_PROGRAMS = {Dialect.OMNITURN: "bushing.nc", Dialect.SINUMERIK: "shaft.mpf", Dialect.KLARTEXT: "nozzle.h"}


def find_demo_program(machine_file: str | None) -> str:
    """Return the path of the program that the demo loads if no program is specified.

    The result is the program that was loaded last if the machine uses its language, and otherwise a sample.
    """
    dialect = Dialect(read_machine(machine_file).mdi_language)
    last = _last_program()
    if last is not None and guess_dialect(last.name) is dialect:
        return str(last)
    return str(get_samples_folder() / _PROGRAMS[dialect])


def _last_program() -> Path | None:
    """Return the path of the program that the demo loaded last, or None if the file does not exist."""
    with suppress(StoreError, OSError), Store.open(find_data_folder(), read_only=True) as store:
        stored = store.settings.read_setting(LAST_PROGRAM_SETTING)
        if isinstance(stored, str) and Path(stored).is_file():
            return Path(stored)
    return None


_PARTS = {
    "bushing.nc": StoredPart("tube:1.0:.4:2.4", 1.2 * MM_PER_INCH)
}  # stock and stick-out of the samples


def _seed(folder: Path) -> None:
    tools, secondary, zero = read_offset_rows(get_samples_folder() / "offsets.toml")
    lengths = {n: row for n, row in tools.items() if row.x == 0.0 and row.z > 0.0}  # tools of the mills
    offsets: dict[OffsetKind, dict[int, dict[str, FieldValue]]] = {
        OffsetKind.TOOL: {number: row._asdict() for number, row in tools.items()},
        OffsetKind.SECONDARY: {number: row._asdict() for number, row in secondary.items()},
        OffsetKind.ZERO: {code: row._asdict() for code, row in zero.items()},
        OffsetKind.MILL_TOOL: {n: {"length": row.z, "radius": row.nose_radius} for n, row in lengths.items()},
    }
    try:
        with Store.open(folder) as store:
            store.write(
                lambda c: import_programs_and_offsets(c, {}, offsets, ChangeReason(_CHANGE_REASON, "import"))
            ).result()
            store.settings.save_setting(SCREEN, {"first_job": True}).result()
            for program, part in _PARTS.items():
                for key, value in part.make_stored_settings(program).items():
                    store.settings.save_setting(key, value).result()
    except StoreError as error:
        raise CommandError(
            Message("the data folder of the demo cannot be used: {error}", error=error), "no-demo-store"
        ) from error
