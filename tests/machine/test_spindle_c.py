"""C on the spindle's own drive in the machine file."""

from __future__ import annotations

from app.compose.machine.machine_files import parse_machine
from tests.machine.test_hardware import CAN, assert_refused, changed

ON = "in rpm, amax in rpm/s\nenabled = "


def with_c(*changes: tuple[str, str]) -> str:
    text = changed(f"{ON}false", f"{ON}true", CAN)
    for old, new in changes:
        text = changed(old, new, text)
    return text


COUNTS = ("spindle = { id = 3 }", "spindle = { id = 3, counts_per_rev = 18000 }")


def test_spindle_drive_with_counts_serves_as_c_axis() -> None:
    machine = parse_machine(with_c(COUNTS), "can")
    assert machine.is_c_enabled
    assert machine.is_spindle_c_axis


def test_spindle_drive_without_counts_is_rejected_as_c_axis() -> None:
    assert_refused(with_c(), "canopen.nodes.C", "the spindle drive can also serve as the C axis")


def test_spindle_drive_without_pvt_mode_is_rejected_as_c_axis() -> None:
    text = with_c(COUNTS, ('mode = "pvt"', 'mode = "pp"'))
    assert_refused(text, "canopen.nodes.C", 'mode = "pvt"')


def test_c_axis_with_own_drive_needs_a_drive() -> None:
    text = with_c(COUNTS, (f"{ON}true", f"{ON}true\nown_drive = true"))
    assert_refused(text, "canopen.nodes.C", "needs a drive")
