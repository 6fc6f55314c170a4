"""Drives made from their vendors' EDS or DCF files, which lie in the folder that TURNDESK_EDS names.

Each is configured by what its dictionary has, moves and stops; of our writing is the slide behind it alone.
"""

from __future__ import annotations

import dataclasses
import os
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from canopen import ObjectDictionary
from canopen.objectdictionary import ODVariable

from app.compose.backends.canopen_backend import connect_canopen_machine, create_simulated_devices
from core.machine.machine_model import Machine
from core.ports import DriverError
from drivers.canopen import canopen_objects as od
from drivers.canopen.canopen_table import CanopenTable
from drivers.canopen.drive_profiles import find_drive_profile
from drivers.wakeups import ManualClock
from tests.drivers.canopen.bench import CanBench, can_machine, cyclic, says
from tests.drivers.machines import ramp

FOLDER = Path(os.environ.get("TURNDESK_EDS", "/nowhere"))
FILES = sorted(path for path in FOLDER.glob("*") if path.suffix.lower() in {".eds", ".dcf"})
TICK = 0.002
pytestmark = pytest.mark.skipif(not FILES, reason="TURNDESK_EDS names no folder with EDS files")


def dictionary(path: Path) -> ObjectDictionary:
    """Of the file; the test is skipped where it is none of a drive."""
    try:
        found = od.load_object_dictionary(path.name, str(path), od.build_drive_dictionary)
    except DriverError as error:
        pytest.skip(str(error))
    if od.CONTROL not in found or od.TARGET not in found:
        pytest.skip(f"{path.name} is not of a drive that positions")
    return found


def machine_of(path: Path) -> Machine:
    """The shipped lathe with this drive on its slides, in the best mode that it has."""
    found = dictionary(path)
    told = found.device_information
    family = find_drive_profile("", told.vendor_number, told.product_name)
    if family.record_queue is not None:
        machine = can_machine(('drive = "epos2"', f'drive = "{family.name}"'))
    elif od.IP_RECORD in found:
        machine = cyclic("ip")
    else:
        machine = cyclic("csp", drive=family.name)
    table = machine.hardware.find_driver_table(CanopenTable)
    assert table is not None
    nodes = tuple(
        dataclasses.replace(node, eds=str(path), sdo=()) if node.name in {"X", "Z"} else node
        for node in table.nodes
    )
    tables = {**machine.hardware.tables, "canopen": dataclasses.replace(table, nodes=nodes)}
    return dataclasses.replace(machine, hardware=dataclasses.replace(machine.hardware, tables=tables))


@pytest.fixture(params=FILES, ids=lambda path: path.name)
def bench(request: pytest.FixtureRequest) -> Iterator[CanBench]:
    path: Path = request.param
    machine = machine_of(path)
    modes = dictionary(path).get_variable(od.SUPPORTED, 0)
    found = CanBench.__new__(CanBench)
    found.model, found.clock = machine, ManualClock()
    found.peers = create_simulated_devices(machine, found.clock)
    if isinstance(modes, ODVariable) and modes.default:
        for name in ("X", "Z"):
            says(found.peers, name, {(od.SUPPORTED, 0): modes.default})
    found.machine = connect_canopen_machine(machine, found.clock, found.peers.process_frames)
    yield found
    found.close()


def test_drive_with_a_public_eds_is_configured_moves_and_stops(bench: CanBench) -> None:
    axes = bench.machine.axes
    for told in bench.machine.ports.warnings:
        assert re.search("[0-9A-F]{4}h", told)
    axes.enable(True)
    axes.splice(ramp(bench.clock.now() + 0.2, (0.0, 0.0, 0.0), 60.0, 0.4))
    for _ in range(700):
        bench.tick(TICK)
    sample = axes.sample()
    assert sample.fault == ""
    assert sample.actual[0] == pytest.approx(60.0 * 0.42, abs=0.0013)
    axes.enable(False)
    assert not axes.sample().enabled


def test_silent_drive_stops_the_other_axis(bench: CanBench) -> None:
    axes = bench.machine.axes
    axes.enable(True)
    axes.splice(ramp(bench.clock.now() + 0.2, (0.0, 0.0, 0.0), 60.0, 1.0))
    for _ in range(200):
        bench.tick(TICK)
    bench.peers.nodes["Z"].is_silent = True
    for _ in range(250):
        bench.tick(TICK)
    assert axes.sample().fault.startswith("Z: ")
    assert bench.peers.plant.servos[0].v == 0.0
    assert not bench.peers.plant.axis_drives["X"].power_states.is_powered
