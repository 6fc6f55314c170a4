"""CiA 402's states: every status word, every next step, and a reset that never energises."""

from __future__ import annotations

import pytest

from drivers.canopen.canopen_objects import (
    DriveState,
    decode_drive_state,
    get_enabling_control_word,
    get_reset_control_word,
)
from drivers.simulators.canopen_axis_drive import PowerStateMachine


@pytest.mark.parametrize(
    ("word", "state"),
    [
        (0x0000, DriveState.NOT_READY_TO_SWITCH_ON),
        (0x0250, DriveState.SWITCH_ON_DISABLED),
        (0x0231, DriveState.READY_TO_SWITCH_ON),
        (0x0233, DriveState.SWITCHED_ON),
        (0x0237, DriveState.OPERATION_ENABLED),
        (0x1637, DriveState.OPERATION_ENABLED),  # homing attained, target reached
        (0x0217, DriveState.QUICK_STOP_ACTIVE),
        (0x021F, DriveState.FAULT_REACTION_ACTIVE),
        (0x0218, DriveState.FAULT),
        (0x0238, DriveState.FAULT),  # bit 5 does not matter there
    ],
)
def test_status_word_gives_the_drive_state(word: int, state: DriveState) -> None:
    assert decode_drive_state(word) is state


def test_enabling_advances_one_state_per_control_word() -> None:
    power, seen = PowerStateMachine(lambda: None), []
    for _ in range(4):
        power.apply_control_word(get_enabling_control_word(decode_drive_state(power.status_word)))
        seen.append(power.state)
    assert seen == [
        DriveState.READY_TO_SWITCH_ON,
        DriveState.SWITCHED_ON,
        DriveState.OPERATION_ENABLED,
        DriveState.OPERATION_ENABLED,
    ]


@pytest.mark.parametrize(
    "state", [DriveState.FAULT, DriveState.FAULT_REACTION_ACTIVE, DriveState.NOT_READY_TO_SWITCH_ON]
)
def test_enabling_never_leaves_a_fault_state(state: DriveState) -> None:
    assert get_enabling_control_word(state) == 0


def test_quick_stop_state_is_left_only_by_disabling() -> None:
    power = PowerStateMachine(lambda: None)
    power.state = DriveState.QUICK_STOP_ACTIVE
    power.apply_control_word(get_enabling_control_word(power.state))
    assert power.state is DriveState.SWITCH_ON_DISABLED


def test_fault_reset_ends_without_power() -> None:
    power = PowerStateMachine(lambda: None)
    power.state, word = DriveState.FAULT, 0x0F
    power.apply_control_word(word)
    for _ in range(6):
        word = get_reset_control_word(decode_drive_state(power.status_word), word)
        power.apply_control_word(word)
    assert power.state is DriveState.SWITCH_ON_DISABLED
    assert not power.is_powered


def test_drive_without_voltage_is_not_enabled() -> None:
    power = PowerStateMachine(lambda: None)
    power.is_sto_active = True
    for _ in range(5):
        power.apply_control_word(get_enabling_control_word(decode_drive_state(power.status_word)))
    assert power.state is DriveState.SWITCH_ON_DISABLED
