"""Machine files by their names, shipped ones and others, read with what the list of drivers adds."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

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
# What each driver adds to the file, in the order in which a machine file's owner is told of them. The module
# that puts a backend together stands in ``backend_entry``, where no table has to be loaded for it.
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


@lru_cache(maxsize=8)  # by the text itself: a folder of proofs and its workers ask for the same one
def parse_machine(text: str, source: str) -> Machine:
    """The machine that the TOML ``text`` describes, with everything that drivers add; ``source`` names it.

    Raises MachineFileError naming every mistake.
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
    """The machine that ``path`` describes; None: the shipped simulated lathe.

    Raises MachineFileError with everything that is wrong, also where the file cannot be read at all.
    """
    if path is None:
        return _shipped(SHIPPED)
    return parse_machine(machine_file.text_of(path), str(path))


def named_machine(name: str | None) -> Machine:
    """The machine of a file, a shipped one by its name, or (None) the shipped lathe; as ``load_machine``."""
    if name and name in resources.machine_names() and not Path(name).exists():
        return shipped_machine(name)
    return load_machine(Path(name) if name else None)


def shipped_machine(name: str) -> Machine:
    """One of the machines that come with the product. Raises FileNotFoundError for another name."""
    return _shipped(f"{name}.toml")


def _shipped(name: str) -> Machine:
    return parse_machine(resources.machine_file(name), name)
