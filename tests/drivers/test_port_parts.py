"""Sentences of driver errors, and what drivers do alike at their ports."""

import pickle
from collections.abc import Callable

import pytest

from core.faults import DriverError, Fault
from core.message import Message
from core.ports import TouchLatch
from drivers.port_checks import (
    FirstTouchLatch,
    find_output,
    require_drive_power,
    require_existing_axis,
    require_free_spindle_drive,
    require_no_homing,
    require_output_allowed,
)


class Touch(FirstTouchLatch):
    def see(self, t: float, *, on: bool) -> None:
        if self._is_first_touch(on):
            self._kept = TouchLatch(t, (), 0.001)


def test_error_retains_template_and_values_and_plain_text_its_braces() -> None:
    error = DriverError("{name} is at {place}", "homing", reason="far", name="X", place=2.5)
    message = error.args[0]
    assert isinstance(message, Message)
    assert (message.template, message.values) == ("{name} is at {place}", {"name": "X", "place": 2.5})
    assert (error.code, error.reason, error.fault) == ("homing", "far", Fault("X is at 2.5", "homing"))
    assert str(DriverError("write {at}")) == "write {at}"
    with pytest.raises(KeyError):
        DriverError("{name} is at {place}", name="X")


def test_forwarded_fault_retains_its_code_in_another_process() -> None:
    fault = Fault("{name}: drive fault", "axis", name="Z")
    assert (fault, fault.code) == ("Z: drive fault", "axis")
    assert DriverError(fault).code == pickle.loads(pickle.dumps(fault)).code == "axis"


@pytest.mark.parametrize(
    ("order", "code", "reason"),
    [
        (lambda: require_drive_power(Fault("Z: drive fault", "following"), is_powered=True), "following", ""),
        (lambda: require_drive_power("cable out", is_powered=True), "axis", ""),
        (lambda: require_drive_power("", is_powered=False), "power-lost", ""),
        (lambda: require_no_homing("X"), "driver", "homing"),
        (lambda: require_existing_axis("Q", "XZ"), "driver", "no-axis"),
        (lambda: require_free_spindle_drive(is_enabled=False, is_turning=True), "c-coupling", "drives-off"),
        (lambda: require_free_spindle_drive(is_enabled=True, is_turning=True), "c-coupling", "spindle-turns"),
        (lambda: find_output("lamp", {"collet": 1}), "output", ""),
        (lambda: require_output_allowed("lamp", True, "cable out"), "output", ""),
    ],
)
def test_require_functions_raise_the_stated_code_and_reason(
    order: Callable[[], object], code: str, reason: str
) -> None:
    with pytest.raises(DriverError) as refused:
        order()
    assert (refused.value.code, refused.value.reason) == (code, reason)


def test_permitted_operations_are_not_rejected() -> None:
    require_drive_power("", is_powered=True)
    require_no_homing("")
    require_existing_axis("X", "XZ")
    require_free_spindle_drive(is_enabled=True, is_turning=False)
    require_output_allowed("lamp", False, "cable out")
    assert find_output("collet", {"collet": 1}) == 1


def test_first_touch_after_arming_is_latched_and_earlier_contact_ignored() -> None:
    touch = Touch()
    touch.see(1.0, on=True)
    touch.arm_latch()
    touch.see(2.0, on=True)
    assert touch.read_latch() is None
    touch.see(3.0, on=False)
    touch.see(4.0, on=True)
    touch.see(5.0, on=False)
    touch.see(6.0, on=True)
    assert touch.read_latch() == TouchLatch(4.0, (), 0.001)
