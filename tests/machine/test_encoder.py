"""An encoder on the spindle beside an inverter, in the machine file."""

from __future__ import annotations

import pytest

import resources
from app.compose.machine.machine_files import parse_machine
from drivers.canopen.canopen_table import EncoderTable
from drivers.inverter.inverter_table import InverterTable
from tests.machine.test_hardware import CAN, assert_refused, changed

VFD = (
    'driver = "vfd"\nvfd = { family = "delta-vfdb", port = "/dev/ttyUSB1", stop = 2, hz_per_rpm = 0.01667 }\n'
    'encoder = { node = "turns", counts_per_rev = 4096 }'
)


def with_encoder(*changes: tuple[str, str]) -> str:
    text = changed('driver = "cia402"', VFD, CAN)
    text = changed("io = { id = 10,", "turns = { id = 20, profile = 406 }\nio = { id = 10,", text)
    text = changed("spindle = { id = 3 }\n", "", text)
    for old, new in changes:
        text = changed(old, new, text)
    return text


def test_spindle_encoder_may_be_its_own_node() -> None:
    hardware = parse_machine(with_encoder(), "can").hardware
    assert hardware.find_driver_table(EncoderTable) == EncoderTable(node="turns", counts_per_rev=4096)
    inverter = hardware.find_driver_table(InverterTable)
    assert inverter is not None
    assert inverter.disagree == pytest.approx(0.15)


def test_spindle_encoder_may_be_connected_to_a_drive() -> None:
    text = with_encoder(
        ('node = "turns", counts_per_rev = 4096', 'node = "Z", object = "60E4:1", counts_per_rev = -2000'),
        ("turns = { id = 20, profile = 406 }\n", ""),
    )
    found = parse_machine(text, "can").hardware.find_driver_table(EncoderTable)
    assert found is not None
    assert (found.node, *found.object_address, found.counts_per_rev) == ("Z", 0x60E4, 1, -2000)


@pytest.mark.parametrize(
    ("old", "new", "path", "expected"),
    [
        ('node = "turns"', 'node = "wheel"', "spindle.encoder.node", "profile = 406"),
        ('node = "turns"', 'node = "io"', "spindle.encoder.node", "does not count revolutions"),
        ('node = "turns"', 'node = "Z"', "spindle.encoder.object", "60E4:1"),
        ('node = "turns"', 'node = "Z"', "canopen.nodes.turns.profile", "this encoder is not used"),
        ('node = "turns"', 'node = "turns", object = "6004"', "spindle.encoder.object", "sub-index"),
        ("counts_per_rev = 4096", "counts_per_rev = 0", "spindle.encoder.counts_per_rev", "at least 16"),
        ("counts_per_rev = 4096", "counts_per_rev = 1.5", "spindle.encoder.counts_per_rev", "whole"),
        (", counts_per_rev = 4096", "", "spindle.encoder.counts_per_rev", "missing"),
        ("counts_per_rev = 4096", "counts_per_rev = 4096, ppr = 1", "spindle.encoder.ppr", ""),
        ("profile = 406", "profile = 404", "canopen.nodes.turns.profile", "406 (encoder)"),
        ("hz_per_rpm = 0.01667", "hz_per_rpm = 0.01667, disagree_pct = 80", "spindle.vfd.disagree_pct", "50"),
    ],
)
def test_invalid_encoder_is_rejected(old: str, new: str, path: str, expected: str) -> None:
    assert_refused(with_encoder((old, new)), path, expected)


def test_encoder_is_rejected_with_spindle_drive_on_bus() -> None:
    text = changed(
        'driver = "cia402"', 'driver = "cia402"\nencoder = { node = "turns", counts_per_rev = 99 }'
    )
    assert_refused(text, "spindle.encoder", 'spindle.driver must be "vfd"')


def test_encoder_is_rejected_with_inverter_on_simulated_backend() -> None:
    text = resources.read_machine_file("gt75-vfd.toml").replace(
        "encoder_ppr = 0", 'encoder_ppr = 0\nencoder = { node = "turns", counts_per_rev = 4096 }'
    )
    assert_refused(text, "spindle.encoder", "does not support an encoder on a bus")
