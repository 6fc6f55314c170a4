"""Begins to start the screen: finds the control that a killed screen has left, or starts one."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

from app.compose.control.control_start import StartedControl, socket_path, start_control
from app.compose.control.rights import OWN_PROCESS
from app.compose.machine.machine_setup import read_machine
from app.desk.command_errors import as_command_error
from app.desk.data_folder import data_folder
from core.machine.machine_model import Machine

if TYPE_CHECKING:
    from app.compose.control.control_client import ControlClient

    Begun: TypeAlias = tuple[Machine, ControlClient | StartedControl | None]


def begin_control(machine_file: str | None) -> Begun:
    """Return the machine of the file, and its control without waiting for it.

    The control is None where it runs on a thread of the screen's process. Raises CommandError for a bad
    machine file, and for a control that runs a program with another machine file.
    """
    machine = read_machine(machine_file)
    if not OWN_PROCESS:
        return machine, None
    folder = data_folder()
    return machine, _found(machine, folder) or start_control(machine, folder)


def _found(machine: Machine, folder: Path) -> ControlClient | None:
    path = socket_path(folder)
    if path is None or not path.is_socket():
        return None
    from app.compose.control.control_client import find_control
    from core.ports import DriverError

    with as_command_error(DriverError):
        return find_control(machine, folder, path)
