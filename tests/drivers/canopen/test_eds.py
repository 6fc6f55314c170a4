"""Drives by their own dictionary: an EDS file beside the machine file."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import canopen
import pytest

from app.compose.backends.canopen_backend import create_canopen_config
from core.machine.machine_model import Machine
from core.ports import DriverError
from drivers.canopen.canopen_objects import build_drive_dictionary
from drivers.canopen.drive_profiles import PROFILES
from tests.coded import raises_code
from tests.drivers.canopen.bench import CanBench, can_machine


def beside(folder: Path) -> Machine:
    """A machine file in ``folder`` whose X has an EDS file there."""
    machine = can_machine(("X = { id = 1, counts", 'X = { id = 1, eds = "x.eds", counts'))
    return dataclasses.replace(machine, source=str(folder / "machine.toml"))


def test_eds_file_next_to_the_machine_file_is_used(tmp_path: Path) -> None:
    canopen.export_od(build_drive_dictionary(PROFILES["epos2"]), str(tmp_path / "x.eds"), "eds")
    node = create_canopen_config(beside(tmp_path)).axes[0].node
    assert node is not None
    assert node.eds == str(tmp_path / "x.eds")
    bench = CanBench(beside(tmp_path))
    bench.machine.axes.enable(True)
    assert bench.machine.axes.sample().enabled
    bench.close()


@pytest.mark.filterwarnings("ignore:The 'warn' method")  # of the library's logger
@pytest.mark.parametrize("text", [None, "", "[6040]\nParameterName=\n", "\x00\x01"])
def test_unreadable_eds_file_is_reported_by_name(tmp_path: Path, text: str | None) -> None:
    if text is not None:
        (tmp_path / "x.eds").write_text(text)
    with raises_code(DriverError, "driver", tmp_path / "x.eds"):
        CanBench(beside(tmp_path))
