"""Objects of CiA 301, 401, 402 and 406, object dictionaries, and the drive states of CiA 402."""

from __future__ import annotations

import configparser
import io
import logging
import re
from collections.abc import Callable
from enum import StrEnum
from pathlib import Path

from canopen import ObjectDictionary, import_od
from canopen.objectdictionary import ODArray, ODRecord, ODVariable
from canopen.objectdictionary import datatypes as kind

from core.input_file import BYTES_PER_MB, read_input_text
from core.message import Message
from core.ports import DriverError
from drivers.canopen.canopen_nodes import CanNode
from drivers.canopen.drive_profiles import CIA402_PROFILE, DriveProfile, find_drive_profile

U8, U16, U32, U64 = kind.UNSIGNED8, kind.UNSIGNED16, kind.UNSIGNED32, kind.UNSIGNED64
I8, I16, I32 = kind.INTEGER8, kind.INTEGER16, kind.INTEGER32

DEVICE_TYPE, ERROR_REGISTER, SYNC_PERIOD, COMMANDED = 0x1000, 0x1001, 0x1006, 0x1400
WATCHED, HEARTBEAT, IDENTITY, ON_ERROR = 0x1016, 0x1017, 0x1018, 0x1029
ABORT_OPTION, QUICK_OPTION, FAULT_OPTION = 0x6007, 0x605A, 0x605E
CONTROL, STATUS, MODE, MODE_SHOWN = 0x6040, 0x6041, 0x6060, 0x6061
POSITION, WINDOW, WINDOW_TIME, VELOCITY = 0x6064, 0x6065, 0x6066, 0x606C
TARGET, HOME_OFFSET, LIMITS = 0x607A, 0x607C, 0x607D
PROFILE_SPEED, PROFILE_ACCEL, PROFILE_DECEL, QUICK_DECEL = 0x6081, 0x6083, 0x6084, 0x6085
HOME_METHOD, HOME_SPEEDS, HOME_ACCEL = 0x6098, 0x6099, 0x609A
IP_SUBMODE, IP_RECORD, IP_TIME, BUFFER = 0x60C0, 0x60C1, 0x60C2, 0x60C4
INPUTS_402, FOLLOWING, TARGET_SPEED, SUPPORTED = 0x60FD, 0x60F4, 0x60FF, 0x6502
ACTUAL_TORQUE = 0x6077  # Actual torque in per mille of the rated torque.
HOME_METHODS, MOTOR_TURN, GEAR, FEED = 0x60E3, 0x608F, 0x6091, 0x6092
DIGITAL_IN, DIGITAL_OUT, ERROR_MODE, ERROR_VALUE = 0x6000, 0x6200, 0x6206, 0x6207
ENCODER_MODE, ENCODER_STEPS, ENCODER_RANGE, ENCODER_POSITION = 0x6000, 0x6001, 0x6002, 0x6004
ENCODER_RESOLUTION, ENCODER_TURNS, SECOND_POSITION = 0x6501, 0x6502, 0x60E4
ANALOG_IN, ANALOG_EVENTS, ANALOG_DELTA = 0x6401, 0x6423, 0x6426

_log = logging.getLogger(__name__)
_MAX_EDS_SIZE = 16 * BYTES_PER_MB  # Maximum size of an EDS file.
_MAX_EDS_ERRORS = 50  # Maximum number of objects without a type in an EDS file.
_VARIABLES_301 = ((DEVICE_TYPE, U32), (ERROR_REGISTER, U8), (SYNC_PERIOD, U32), (HEARTBEAT, U16))
_ARRAYS_301 = ((WATCHED, U32, 2), (ON_ERROR, U8, 1))
_VARIABLES_402 = (
    *((ABORT_OPTION, I16), (QUICK_OPTION, I16), (FAULT_OPTION, I16)),
    *((CONTROL, U16), (STATUS, U16), (MODE, I8), (MODE_SHOWN, I8)),
    *((POSITION, I32), (ACTUAL_TORQUE, I16), (WINDOW, U32), (WINDOW_TIME, U16), (VELOCITY, I32)),
    *((TARGET, I32), (HOME_OFFSET, I32), (PROFILE_SPEED, U32), (PROFILE_ACCEL, U32)),
    *((PROFILE_DECEL, U32), (QUICK_DECEL, U32), (HOME_METHOD, I8), (HOME_ACCEL, U32)),
    *((IP_SUBMODE, I16), (FOLLOWING, I32), (INPUTS_402, U32), (TARGET_SPEED, I32), (SUPPORTED, U32)),
)
_VARIABLES_406 = (
    *((ENCODER_MODE, U16), (ENCODER_STEPS, U32), (ENCODER_RANGE, U32), (ENCODER_POSITION, U32)),
    *((ENCODER_RESOLUTION, U32), (ENCODER_TURNS, U16)),
)
_ARRAYS_402 = (
    *((LIMITS, I32, 2), (HOME_SPEEDS, U32, 2), (IP_RECORD, I32, 1), (SECOND_POSITION, I32, 2)),
    *((HOME_METHODS, I8, 16), (MOTOR_TURN, U32, 2), (GEAR, U32, 2), (FEED, U32, 2)),
)
_TIME_PERIOD = ((1, U8, "rw"), (2, I8, "rw"))
_BUFFER = ((1, U32, "rw"), (2, U32, "rw"), (3, U8, "rw"), (4, U16, "rw"), (5, U8, "wo"), (6, U8, "wo"))
_ARRAYS_401 = (
    *((DIGITAL_IN, U8, 8), (DIGITAL_OUT, U8, 8), (ERROR_MODE, U8, 8), (ERROR_VALUE, U8, 8)),
    *((ANALOG_IN, I16, 4), (ANALOG_DELTA, U32, 4)),
)
_EPOS2_MISSING = (
    *(SYNC_PERIOD, ON_ERROR, QUICK_OPTION, WINDOW_TIME, IP_RECORD, FOLLOWING, INPUTS_402),
    *(HOME_METHODS, MOTOR_TURN, GEAR, FEED),
)
_EPOS4_MISSING = (SYNC_PERIOD, HOME_OFFSET, IP_SUBMODE, IP_RECORD, BUFFER, MOTOR_TURN, GEAR, FEED)


def build_drive_dictionary(profile: DriveProfile = CIA402_PROFILE) -> ObjectDictionary:
    """Build the dictionary of a drive that has no EDS file, from the standard objects of its family."""
    found = _dictionary((*_VARIABLES_301, *_VARIABLES_402), (*_ARRAYS_301, *_ARRAYS_402))
    found.add_object(_record(IP_TIME, _TIME_PERIOD))
    found.add_object(_record(BUFFER, _BUFFER))
    for index in {"epos2": _EPOS2_MISSING, "epos4": _EPOS4_MISSING}.get(profile.name, ()):
        del found[index]
    if profile.product_name_words:  # The maxon drives have no timeout for received PDOs.
        for number in range(4):
            record = found[COMMANDED + number]
            assert isinstance(record, ODRecord)
            del record.subindices[5]
    for index, _, _ in profile.unit_objects:
        found.add_object(_variable(index, 0, U32))
    if profile.home_offset_object not in found:
        found.add_object(_variable(profile.home_offset_object, 0, I32))
    if profile.digital_input_entry.object_index not in found:
        found.add_object(
            _record(
                profile.digital_input_entry.object_index,
                ((profile.digital_input_entry.object_subindex, U16, "ro"),),
            )
        )
    if profile.record_queue is not None:
        order = _variable(profile.record_queue.object_index, 0, U64)
        order.access_type = "wo"
        found.add_object(order)
    return found


def build_module_dictionary() -> ObjectDictionary:
    """Build the dictionary of an I/O module that has no EDS file."""
    return _dictionary((*_VARIABLES_301, (ANALOG_EVENTS, U8)), (*_ARRAYS_301, *_ARRAYS_401))


def build_encoder_dictionary() -> ObjectDictionary:
    """Build the dictionary of an encoder that has no EDS file."""
    return _dictionary((*_VARIABLES_301, *_VARIABLES_406), _ARRAYS_301)


def load_drive_dictionary(node: CanNode) -> tuple[ObjectDictionary, DriveProfile]:
    """Return the object dictionary of a drive and the profile of its drive family.

    Raises DriverError if the EDS file of the drive is unreadable or incomplete.
    """
    if not node.eds:
        profile = find_drive_profile(node.drive, None, None)
        return build_drive_dictionary(profile), profile
    found = load_object_dictionary(node.name, node.eds, build_drive_dictionary)
    device_info = found.device_information
    return found, find_drive_profile(node.drive, device_info.vendor_number, device_info.product_name)


def load_object_dictionary(
    name: str, eds: str, build_standard: Callable[[], ObjectDictionary]
) -> ObjectDictionary:
    """Load the dictionary from the EDS file, or build the standard dictionary if ``eds`` is empty.

    Raises DriverError with the node and the file if the file is unreadable or incomplete.
    """
    if not eds:
        return build_standard()
    try:
        found = _read_eds(Path(eds))
    except (OSError, ValueError, KeyError, configparser.Error) as error:
        reason = str(error).splitlines()[0]
        raise DriverError(
            Message("{name}: the EDS file {eds} cannot be read: {reason}", name=name, eds=eds, reason=reason)
        ) from error
    if DEVICE_TYPE not in found:
        raise DriverError(
            "{name}: the EDS file {eds} does not contain object 1000h, which every device has",
            name=name,
            eds=eds,
        )
    return found


def _read_eds(path: Path) -> ObjectDictionary:
    """Read an EDS or DCF file; objects without a type are omitted."""
    text = read_input_text(path, _MAX_EDS_SIZE, "latin-1")
    for _ in range(_MAX_EDS_ERRORS):
        stream = io.StringIO(text)
        stream.name = str(path)  # The library evaluates the file extension.
        try:
            found: ObjectDictionary = import_od(stream)
        except configparser.NoOptionError as error:
            less = re.sub(rf"(?ims)^\[{re.escape(error.section)}\].*?(?=^\[|\Z)", "", text)
            if less == text:
                raise
            _log.warning("%s: object %s is left out: %s", path, error.section, error.message)
            text = less
            continue
        return found
    raise ValueError(f"more than {_MAX_EDS_ERRORS} objects without a type")


def _dictionary(
    variables: tuple[tuple[int, int], ...], arrays: tuple[tuple[int, int, int], ...]
) -> ObjectDictionary:
    found = ObjectDictionary()
    for index, data_type in variables:
        found.add_object(_variable(index, 0, data_type))
    for index, data_type, length in arrays:
        array = ODArray(f"{index:04X}", index)
        array.add_member(_variable(index, 0, U8, length))
        for sub in range(1, length + 1):
            array.add_member(_variable(index, sub, data_type))
        found.add_object(array)
    for number in range(4):
        for base in (0x1400, 0x1800):
            found.add_object(_communication(base + number))
        for base in (0x1600, 0x1A00):
            found.add_object(_mapping(base + number))
    return found


def _variable(index: int, sub: int, data_type: int, value: int = 0) -> ODVariable:
    variable = ODVariable(f"{index:04X}:{sub}", index, sub)
    variable.data_type = data_type
    variable.access_type = "rw"
    variable.default = value
    return variable


def _record(index: int, members: tuple[tuple[int, int, str], ...]) -> ODRecord:
    record = ODRecord(f"{index:04X}", index)
    record.add_member(_variable(index, 0, U8, max(sub for sub, _, _ in members)))
    for sub, data_type, access in members:
        member = _variable(index, sub, data_type)
        member.access_type = access
        record.add_member(member)
    return record


def _communication(index: int) -> ODRecord:
    record = ODRecord(f"{index:04X}", index)
    for sub, data_type in ((0, U8), (1, U32), (2, U8), (3, U16), (5, U16)):
        record.add_member(_variable(index, sub, data_type))
    return record


def _mapping(index: int) -> ODArray:
    array = ODArray(f"{index:04X}", index)
    for sub in range(9):
        array.add_member(_variable(index, sub, U32 if sub else U8))
    return array


# --- State machine of CiA 402: the meaning of status words, and the next control word toward a goal.


class DriveState(StrEnum):
    """State of a drive, with the name that CiA 402 uses."""

    NOT_READY_TO_SWITCH_ON = "not ready to switch on"
    SWITCH_ON_DISABLED = "switch on disabled"
    READY_TO_SWITCH_ON = "ready to switch on"
    SWITCHED_ON = "switched on"
    OPERATION_ENABLED = "operation enabled"
    QUICK_STOP_ACTIVE = "quick stop active"
    FAULT_REACTION_ACTIVE = "fault reaction active"
    FAULT = "fault"


_STATE_MASKS = (
    (0x4F, 0x00, DriveState.NOT_READY_TO_SWITCH_ON),
    (0x4F, 0x40, DriveState.SWITCH_ON_DISABLED),
    (0x6F, 0x21, DriveState.READY_TO_SWITCH_ON),
    (0x6F, 0x23, DriveState.SWITCHED_ON),
    (0x6F, 0x27, DriveState.OPERATION_ENABLED),
    (0x6F, 0x07, DriveState.QUICK_STOP_ACTIVE),
    (0x4F, 0x0F, DriveState.FAULT_REACTION_ACTIVE),
    (0x4F, 0x08, DriveState.FAULT),
)
SHUTDOWN, SWITCH_ON, ENABLE, DISABLE, QUICK, RESET = 0x06, 0x07, 0x0F, 0x00, 0x02, 0x80
# Bit 4: new setpoint, homing start or interpolation active; bits 5 and 8.
NEW, AT_ONCE, HALT = 0x10, 0x20, 0x100
REACHED, LIMITED, BIT_12, BIT_13 = 0x400, 0x800, 0x1000, 0x2000
PP, PV, HM, IP, CSP = 1, 3, 6, 7, 8
MODE_BITS = {PP: 0x01, PV: 0x04, HM: 0x20, IP: 0x40, CSP: 0x80}  # Bits of 0x6502.

_NEXT_CONTROL_WORDS = {
    DriveState.SWITCH_ON_DISABLED: SHUTDOWN,
    DriveState.READY_TO_SWITCH_ON: SWITCH_ON,
    DriveState.SWITCHED_ON: ENABLE,
    DriveState.OPERATION_ENABLED: ENABLE,
    # Leaving this state upward would restart the drive after an emergency.
    DriveState.QUICK_STOP_ACTIVE: DISABLE,
}


def decode_drive_state(status_word: int) -> DriveState:
    """Return the drive state that a status word encodes.

    If the status word matches no mask, return "not ready to switch on".
    """
    for mask, bits, state in _STATE_MASKS:
        if status_word & mask == bits:
            return state
    return DriveState.NOT_READY_TO_SWITCH_ON


def get_enabling_control_word(state: DriveState) -> int:
    """Return the control word for the next step from ``state`` toward "operation enabled".

    The control word never clears a fault.
    """
    return _NEXT_CONTROL_WORDS.get(state, DISABLE)


def get_reset_control_word(state: DriveState, last_word: int) -> int:
    """Return the control word that clears a fault by a rising edge of bit 7.

    The control word does not switch the power on.
    """
    if state is DriveState.FAULT and last_word != RESET:
        return RESET
    return DISABLE
