"""CiA 402's states: every status word, every next step, and a reset that never energises."""

from __future__ import annotations

import pytest

from drivers.canopen.canopen_objects import DriveState, reset_step, state_of, towards_enabled
from drivers.simulators.canopen_axis_drive import PowerStates


@pytest.mark.parametrize(
    ("word", "state"),
    [
        (0x0000, DriveState.NOT_READY),
        (0x0250, DriveState.OFF),
        (0x0231, DriveState.READY),
        (0x0233, DriveState.ON),
        (0x0237, DriveState.ENABLED),
        (0x1637, DriveState.ENABLED),  # homing attained, target reached
        (0x0217, DriveState.QUICK_STOP),
        (0x021F, DriveState.REACTING),
        (0x0218, DriveState.FAULT),
        (0x0238, DriveState.FAULT),  # bit 5 does not matter there
    ],
)
def test_status_words(word: int, state: DriveState) -> None:
    assert state_of(word) is state


def test_the_walk_up_takes_one_step_a_word() -> None:
    power, seen = PowerStates(lambda: None), []
    for _ in range(4):
        power.control(towards_enabled(state_of(power.word)))
        seen.append(power.state)
    assert seen == [DriveState.READY, DriveState.ON, DriveState.ENABLED, DriveState.ENABLED]


@pytest.mark.parametrize("state", [DriveState.FAULT, DriveState.REACTING, DriveState.NOT_READY])
def test_the_walk_up_never_leaves_a_fault(state: DriveState) -> None:
    assert towards_enabled(state) == 0


def test_an_emergency_is_left_downwards_only() -> None:
    power = PowerStates(lambda: None)
    power.state = DriveState.QUICK_STOP
    power.control(towards_enabled(power.state))
    assert power.state is DriveState.OFF


def test_a_reset_ends_without_power() -> None:
    power = PowerStates(lambda: None)
    power.state, word = DriveState.FAULT, 0x0F
    power.control(word)
    for _ in range(6):
        word = reset_step(state_of(power.word), word)
        power.control(word)
    assert power.state is DriveState.OFF
    assert not power.powered


def test_a_drive_without_voltage_does_not_come_on() -> None:
    power = PowerStates(lambda: None)
    power.sto = True
    for _ in range(5):
        power.control(towards_enabled(state_of(power.word)))
    assert power.state is DriveState.OFF
