"""Settings of the line by Return, and what is kept of them."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.transfer.serial_transfer import SETTING_ROWS, convert_settings_to_json, read_settings
from core.machine.serial_and_backup_tables import SerialLineModel
from tests.texts import text

DEFAULT = SerialLineModel("/dev/ttyUSB0", 9600, 7, "E", 1, "xonxoff", "%", "\r\n")
PORTS = ("/dev/ttyS0", "/dev/ttyUSB0")


def around(name: str, model: SerialLineModel) -> list[str]:
    """What a row shows as Return steps it on, until it is where it began."""
    _, value, step = next(row for row in SETTING_ROWS if row[0] == name)
    shown = [value(model)]
    while True:
        model = step(model, PORTS)
        if value(model) == shown[0]:
            return shown
        shown.append(value(model))


@pytest.mark.parametrize(
    ("row", "count"),
    [
        ("PORT", 2),
        ("SPEED", 11),
        ("BITS, PARITY, STOP BITS", 7),
        ("FLOW CONTROL", 3),
        (text("programs.serial-wrap"), 2),
        ("LINE ENDING", 3),
        ("DC CODES", 2),
        (text("programs.serial-after-dc1"), 2),
        (text("programs.serial-leader"), 4),
    ],
)
def test_every_setting_cycles_through_its_values(row: str, count: int) -> None:
    shown = around(row, DEFAULT)
    assert len(shown) == len(set(shown)) == count


def test_baud_rate_not_in_list_changes_to_the_first() -> None:
    _, value, step = SETTING_ROWS[1]
    assert value(step(replace(DEFAULT, baud=12345), PORTS)) == "110"


def test_port_setting_is_unchanged_without_ports() -> None:
    assert SETTING_ROWS[0][2](DEFAULT, ()) == DEFAULT


def test_stored_settings_are_read_back() -> None:
    changed = replace(DEFAULT, baud=4800, parity="O", eol="\n", wait=True)
    assert read_settings(convert_settings_to_json(changed), DEFAULT) == changed


@pytest.mark.parametrize(
    "kept", [None, 7, {"flow": "smoke"}, {"bits": 9}, {"parity": "X"}, {"baud": "fast"}, {"wait": 1}]
)
def test_invalid_stored_settings_are_replaced_by_defaults(kept: object) -> None:
    assert read_settings(kept, DEFAULT) == DEFAULT
