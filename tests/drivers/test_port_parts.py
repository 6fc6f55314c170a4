"""Sentences of driver errors, and what drivers do alike at their ports."""

import pickle
from collections.abc import Callable

import pytest

from core.faults import DriverError, Fault
from core.message import Message
from core.ports import Latch
from drivers.port_parts import (
    FirstTouch,
    demand_axis,
    demand_free_drive,
    demand_no_homing,
    demand_output,
    demand_power,
    output_of,
)


class Touch(FirstTouch):
    def see(self, t: float, *, on: bool) -> None:
        if self._touches(on):
            self._kept = Latch(t, (), 0.001)


def test_an_error_keeps_template_and_values_and_a_sentence_without_values_keeps_its_braces() -> None:
    error = DriverError("{name} is at {place}", "homing", reason="far", name="X", place=2.5)
    message = error.args[0]
    assert isinstance(message, Message)
    assert (message.template, message.values) == ("{name} is at {place}", {"name": "X", "place": 2.5})
    assert (error.code, error.reason, error.fault) == ("homing", "far", Fault("X is at 2.5", "homing"))
    assert str(DriverError("write {at}")) == "write {at}"
    with pytest.raises(KeyError):
        DriverError("{name} is at {place}", name="X")


def test_a_fault_that_is_handed_on_keeps_its_code_also_to_another_process() -> None:
    fault = Fault("{name}: drive fault", "axis", name="Z")
    assert (fault, fault.code) == ("Z: drive fault", "axis")
    assert DriverError(fault).code == pickle.loads(pickle.dumps(fault)).code == "axis"


@pytest.mark.parametrize(
    ("order", "code", "reason"),
    [
        (lambda: demand_power(Fault("Z: drive fault", "following"), on=True), "following", ""),
        (lambda: demand_power("cable out", on=True), "axis", ""),
        (lambda: demand_power("", on=False), "power-lost", ""),
        (lambda: demand_no_homing("X"), "driver", "homing"),
        (lambda: demand_axis("Q", "XZ"), "driver", "no-axis"),
        (lambda: demand_free_drive(enabled=False, turning=True), "c-coupling", "drives-off"),
        (lambda: demand_free_drive(enabled=True, turning=True), "c-coupling", "spindle-turns"),
        (lambda: output_of("lamp", {"collet": 1}), "output", ""),
        (lambda: demand_output("lamp", True, "cable out"), "output", ""),
    ],
)
def test_what_is_refused_and_why(order: Callable[[], object], code: str, reason: str) -> None:
    with pytest.raises(DriverError) as refused:
        order()
    assert (refused.value.code, refused.value.reason) == (code, reason)


def test_what_may_be_done_is_not_refused() -> None:
    demand_power("", on=True)
    demand_no_homing("")
    demand_axis("X", "XZ")
    demand_free_drive(enabled=True, turning=False)
    demand_output("lamp", False, "cable out")
    assert output_of("collet", {"collet": 1}) == 1


def test_the_first_touch_after_arming_is_kept_and_one_that_was_there_is_none() -> None:
    touch = Touch()
    touch.see(1.0, on=True)
    touch.arm()
    touch.see(2.0, on=True)
    assert touch.latched() is None
    touch.see(3.0, on=False)
    touch.see(4.0, on=True)
    touch.see(5.0, on=False)
    touch.see(6.0, on=True)
    assert touch.latched() == Latch(4.0, (), 0.001)
