"""Reading of machine files by name or path, including the tables that drivers declare."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import TypeGuard

import resources
from app.compose.machine.driver_modules import load_all_drivers, load_used_drivers
from core.machine import machine_file
from core.machine.machine_model import Machine
from core.message import Message
from core.secret_values import format_toml_value
from core.table_schema import FileFinding, MachineFileError

DEFAULT_MACHINE_FILE = "gt75.toml"


@lru_cache(maxsize=8)  # cached by text, because folder proofs and their workers read the same file
def parse_machine(text: str, source: str) -> Machine:
    """Return the machine that the TOML ``text`` describes, including the tables of drivers.

    ``source`` names the file in messages. Raises MachineFileError that lists every finding.
    """
    data = machine_file.parse_tables(text, source)
    try:
        machine = machine_file.build_machine(data, text, source, load_used_drivers(data))
    except MachineFileError:  # the findings name the possible values of all drivers
        machine = machine_file.build_machine(data, text, source, load_all_drivers())
    if machine.silenced_checks:
        _known_checks(machine.silenced_checks, source)
    return machine


def _known_checks(silenced: tuple[str, ...], source: str) -> None:
    from core.proving.checks.part_checks import PART_CHECKS

    wrong = [name for name in silenced if name not in PART_CHECKS]
    if wrong:
        expected = Message("the name must be one of the part checks: {checks}", checks=", ".join(PART_CHECKS))
        found = [FileFinding("checks.silenced", format_toml_value(name), expected) for name in wrong]
        raise MachineFileError(found, source)


def load_machine(path: Path | None = None) -> Machine:
    """Return the machine that the file ``path`` describes.

    If ``path`` is None, return the shipped simulated lathe. Raises MachineFileError if the file cannot be
    read or has errors. The exception lists every finding.
    """
    if path is None:
        return _shipped(DEFAULT_MACHINE_FILE)
    return parse_machine(machine_file.read_machine_text(path), str(path))


def load_named_machine(name: str | None) -> Machine:
    """Return the machine for a file path or for the name of a shipped machine.

    If ``name`` is None, return the shipped lathe. Raises MachineFileError that lists every finding.
    """
    if _is_shipped(name):
        return load_shipped_machine(name)
    return load_machine(Path(name) if name else None)


def find_machine_path(name: str | None) -> Path:
    """Return the path of the file that ``load_named_machine`` reads."""
    if name and not _is_shipped(name):
        return Path(name).absolute()
    return resources.get_machine_path(f"{name}.toml" if name else DEFAULT_MACHINE_FILE)


def _is_shipped(name: str | None) -> TypeGuard[str]:
    return bool(name) and name in resources.list_machine_names() and not Path(name).exists()


def load_shipped_machine(name: str) -> Machine:
    """Return a machine that is shipped with TurnDesk. Raises FileNotFoundError if the name is unknown."""
    return _shipped(f"{name}.toml")


def _shipped(name: str) -> Machine:
    return parse_machine(resources.read_machine_file(name), name)
