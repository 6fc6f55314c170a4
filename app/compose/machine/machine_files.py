"""Reading of machine files by name or path, shipped or not, with the tables that drivers add."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import TypeGuard

import resources
from app.compose.extra import extras, insert_after
from core.machine import desk_tables, machine_file, setter_table
from core.machine.machine_model import Machine
from core.message import Message
from core.table_schema import Driver, Finding, MachineFileError, written
from drivers.canopen import canopen_table
from drivers.grblhal import grblhal_table
from drivers.hal import hal_table
from drivers.hal.boards import board_table
from drivers.inverter import inverter_table
from drivers.simulated import simulated_table

SHIPPED = "gt75.toml"
# Tables that each driver adds, in the order of the findings. The module that assembles a backend is named in
# ``backend_entry``, so that it is loaded only when needed.
_OWN_DRIVERS: tuple[Driver, ...] = (
    simulated_table.DRIVER,
    canopen_table.DRIVER,
    inverter_table.DRIVER,
    grblhal_table.DRIVER,
    hal_table.DRIVER,
    board_table.DRIVER,
    desk_tables.DRIVER,
    setter_table.DRIVER,
    desk_tables.BACKUP_DRIVER,
)
DRIVERS: tuple[Driver, ...] = tuple(
    insert_after(
        _OWN_DRIVERS,
        lambda driver: driver.tables[0].path,
        [(each, extra.tables_follow) for extra in extras().values() for each in extra.machine_tables()],
    )
)


@lru_cache(maxsize=8)  # cached by text, because folder proofs and their workers read the same file
def parse_machine(text: str, source: str) -> Machine:
    """Return the machine that the TOML ``text`` describes, including the tables of drivers.

    ``source`` names the file in messages. Raises MachineFileError with every finding.
    """
    machine = machine_file.parse_machine(text, source, DRIVERS)
    if machine.silenced:
        _known_checks(machine.silenced, source)
    return machine


def _known_checks(silenced: tuple[str, ...], source: str) -> None:
    from core.proving.checks.part_checks import CHECKS

    wrong = [name for name in silenced if name not in CHECKS]
    if wrong:
        expected = Message("the name must be one of the part checks: {checks}", checks=", ".join(CHECKS))
        found = [Finding("checks.silenced", written(name), expected) for name in wrong]
        raise MachineFileError(found, source)


def load_machine(path: Path | None = None) -> Machine:
    """Return the machine that the file ``path`` describes, or the shipped simulated lathe for None.

    Raises MachineFileError with every finding, also if the file cannot be read.
    """
    if path is None:
        return _shipped(SHIPPED)
    return parse_machine(machine_file.text_of(path), str(path))


def named_machine(name: str | None) -> Machine:
    """Return the machine of a file or a shipped machine by name, or the shipped lathe for None.

    Raises MachineFileError with every finding.
    """
    if _is_shipped(name):
        return shipped_machine(name)
    return load_machine(Path(name) if name else None)


def machine_path(name: str | None) -> Path:
    """Return the path of the file that ``named_machine`` reads."""
    if name and not _is_shipped(name):
        return Path(name).absolute()
    return resources.machine_path(f"{name}.toml" if name else SHIPPED)


def _is_shipped(name: str | None) -> TypeGuard[str]:
    return bool(name) and name in resources.machine_names() and not Path(name).exists()


def shipped_machine(name: str) -> Machine:
    """Return a machine that is shipped with TurnDesk. Raises FileNotFoundError if the name is unknown."""
    return _shipped(f"{name}.toml")


def _shipped(name: str) -> Machine:
    return parse_machine(resources.machine_file(name), name)
