"""First step of the screen's startup, which connects to a running control or starts a new one."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

from app.compose.control.control_start import StartedControl, list_socket_paths, start_control
from app.compose.control.process_rights_check import USES_OWN_PROCESS
from app.compose.machine.machine_setup import read_machine
from app.desk.command_errors import convert_to_command_error
from app.desk.data_folder import find_data_folder
from core.machine.machine_model import Machine

if TYPE_CHECKING:
    from app.compose.control.control_client import ControlClient

    MachineAndControl: TypeAlias = tuple[Machine, ControlClient | StartedControl | None]


def find_or_start_control(machine_file: str | None) -> MachineAndControl:
    """Return the machine of the file and its control, without waiting until the control is ready.

    The control is None if it runs in a thread of the screen's process. Raises CommandError if the machine
    file is invalid, or if a running control executes a program with a different machine file, has a
    different version or does not respond.
    """
    machine = read_machine(machine_file)
    if not USES_OWN_PROCESS:
        return machine, None
    folder = find_data_folder()
    return machine, _found(machine, folder) or start_control(machine, folder)


def _found(machine: Machine, folder: Path) -> ControlClient | None:
    paths = [path for path in list_socket_paths(folder) if path.is_socket()]
    if not paths:
        return None
    from app.compose.control.control_client import find_running_control
    from core.ports import DriverError

    with convert_to_command_error(DriverError):
        found = (find_running_control(machine, folder, path) for path in paths)
        return next((each for each in found if each is not None), None)
