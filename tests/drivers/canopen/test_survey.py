"""The nodes of a bus asked one by one: who answers, who does not, who is something else."""

from __future__ import annotations

import dataclasses
import re

import pytest

from app.compose.backends.canopen_backend import create_canopen_config, create_simulated_devices
from core.machine.machine_model import Machine
from core.ports import DriverError
from drivers.canopen.canopen_survey import SurveyResult, identify_nodes
from drivers.canopen.canopen_table import CanopenTable
from drivers.wakeups import ManualClock
from tests.coded import raises_code
from tests.drivers.canopen.bench import can_machine


def on_one_bus(there: Machine, asked: Machine) -> Machine:
    """The machine that asks, on the channel of the one that is there."""
    bus, own = there.hardware.find_driver_table(CanopenTable), asked.hardware.find_driver_table(CanopenTable)
    assert bus is not None
    assert own is not None
    moved = dataclasses.replace(own, channel=bus.channel)
    tables = {**asked.hardware.tables, "canopen": moved}
    return dataclasses.replace(asked, hardware=dataclasses.replace(asked.hardware, tables=tables))


def surveyed(*changes: tuple[str, str], silent: str = "") -> dict[str, SurveyResult]:
    """What the shipped machine's peers say to a machine file with ``changes``."""
    clock, machine = ManualClock(), can_machine()
    peers = create_simulated_devices(machine, clock)
    try:
        if silent:
            peers.nodes[silent].is_silent = True
        asking = on_one_bus(machine, can_machine(*changes))
        return {
            found.name: found
            for found in identify_nodes(create_canopen_config(asking), clock, peers.process_frames)
        }
    finally:
        peers.close()


def test_bus_survey_lists_every_node_with_its_identity() -> None:
    found = surveyed()
    assert {name: answer.node_id for name, answer in found.items()} == {
        "X": 1,
        "Z": 2,
        "spindle": 3,
        "io": 10,
    }
    assert not any(answer.error_text for answer in found.values())
    # EPOS2 has no option of its quick stop, and no time for its window
    assert "PP homing IP CSP" in found["X"].detail_text
    for value in ("EPOS2", "pvt"):
        assert value in found["X"].detail_text
    assert re.findall("[0-9A-F]{4}h", found["X"].detail_text) == ["605Ah", "6066h"]
    assert found["io"].detail_text == "CiA 401"


def test_survey_reports_missing_mode_objects_before_writing() -> None:
    csp = (
        ('mode = "pvt"', 'mode = "csp"'),
        ('drive = "epos2"', 'drive = "epos4"'),
        ("sync_ms = 10 ", "sync_ms = 4 "),
    )
    found = surveyed(*csp)
    assert "runs csp" in found["X"].detail_text
    interpolated = (('mode = "pvt"', 'mode = "ip"'), *csp[1:])
    trouble = surveyed(*interpolated)["X"].error_text
    assert trouble.startswith("X: ")
    assert "60C1:1" in trouble


def test_silent_node_does_not_hide_other_nodes_in_survey() -> None:
    found = surveyed(silent="Z")
    assert found["Z"].error_text.startswith("Z: node 2, object 1000:0: ")
    assert [name for name, answer in found.items() if answer.error_text] == ["Z"]


def test_node_of_another_kind_is_reported_with_both_profiles() -> None:
    found = surveyed(("Z = { id = 2,", "Z = { id = 10,"), ("io = { id = 10,", "io = { id = 2,"))
    for name, values in (("Z", ["10", "401", "402"]), ("io", ["2", "402", "401"])):
        assert re.findall("[0-9]+", found[name].error_text) == values
    assert not found["X"].error_text


def test_survey_sends_no_heartbeat_that_nodes_could_monitor(monkeypatch: pytest.MonkeyPatch) -> None:
    clock, machine = ManualClock(), can_machine()
    peers = create_simulated_devices(machine, clock)
    heard: list[int] = []
    take = peers.nodes["X"].handle_frame

    def noted(cob: int, data: bytes) -> None:
        heard.append(cob)
        take(cob, data)

    monkeypatch.setattr(peers.nodes["X"], "handle_frame", noted)
    try:
        identify_nodes(create_canopen_config(machine), clock, peers.process_frames)
    finally:
        peers.close()
    assert 0x601 in heard  # SDO requests to node 1
    assert 0x700 + 127 not in heard


def test_missing_bus_is_reported_in_one_line() -> None:
    machine = can_machine(('interface = "virtual"', 'interface = "nobody"'))
    with raises_code(DriverError, "driver", "interface nobody", "channel bench-"):
        identify_nodes(create_canopen_config(machine), ManualClock())
