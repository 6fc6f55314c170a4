"""The state machine of CiA 402: what a status word means, and the next control word on the way to a goal."""

from __future__ import annotations

from enum import StrEnum


class DriveState(StrEnum):
    """States as the profile names them."""

    NOT_READY = "not ready to switch on"
    OFF = "switch on disabled"
    READY = "ready to switch on"
    ON = "switched on"
    ENABLED = "operation enabled"
    QUICK_STOP = "quick stop active"
    REACTING = "fault reaction active"
    FAULT = "fault"


_MASKS = (
    (0x4F, 0x00, DriveState.NOT_READY),
    (0x4F, 0x40, DriveState.OFF),
    (0x6F, 0x21, DriveState.READY),
    (0x6F, 0x23, DriveState.ON),
    (0x6F, 0x27, DriveState.ENABLED),
    (0x6F, 0x07, DriveState.QUICK_STOP),
    (0x4F, 0x0F, DriveState.REACTING),
    (0x4F, 0x08, DriveState.FAULT),
)
SHUTDOWN, SWITCH_ON, ENABLE, DISABLE, QUICK, RESET = 0x06, 0x07, 0x0F, 0x00, 0x02, 0x80
NEW, AT_ONCE, HALT = 0x10, 0x20, 0x100  # bit 4 new set-point, homing start or interpolation active; 5; 8
REACHED, LIMITED, BIT_12, BIT_13 = 0x400, 0x800, 0x1000, 0x2000
PP, PV, HM, IP, CSP = 1, 3, 6, 7, 8
MODE_BITS = {PP: 0x01, PV: 0x04, HM: 0x20, IP: 0x40, CSP: 0x80}  # in 0x6502

_LADDER = {
    DriveState.OFF: SHUTDOWN,
    DriveState.READY: SWITCH_ON,
    DriveState.ON: ENABLE,
    DriveState.ENABLED: ENABLE,
    DriveState.QUICK_STOP: DISABLE,  # leaving it upwards would be a restart out of an emergency
}


def state_of(word: int) -> DriveState:
    """What a status word says; a word that fits no mask is a drive that is not ready."""
    for mask, bits, state in _MASKS:
        if word & mask == bits:
            return state
    return DriveState.NOT_READY


def towards_enabled(state: DriveState) -> int:
    """The control word of the next step up. A fault is never left here: only its reset does that."""
    return _LADDER.get(state, DISABLE)


def reset_step(state: DriveState, last: int) -> int:
    """The control word that clears a fault: the edge of bit 7, and then nothing that energises."""
    if state is DriveState.FAULT and last != RESET:
        return RESET
    return DISABLE
