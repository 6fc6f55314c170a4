"""Keys of the axis tables [axis.…] of a machine file, with their ranges in the units of the machine model."""

from __future__ import annotations

import math
from typing import Any

from core.key_declaration import FileUnit, KeyRange, Pair, declare_key

THIRD_AXIS_NAMES = (*"ABCUVWY", *(f"{letter}{digit}" for letter in "ABCQUVWY" for digit in range(1, 10)))
_STILL_MS: Any = declare_key(
    KeyRange(0.05, 2.0, FileUnit.MILLISECONDS),
    default=0.2,
    meaning="Time after the last setpoint before `still_window` applies.",
)
_METHOD: Any = declare_key(
    KeyRange(-128, 37),
    default=0,
    meaning="Homing method of CiA 402, such as 1 or 2 (limit switch and index), 5 (home switch and "
    "index) or 37 (present position). 0: not specified; the simulated machine needs no method.",
)
_THIRD_NAME: Any = declare_key(
    default="C",
    choices=THIRD_AXIS_NAMES,
    meaning="Name of the third axis in SINUMERIK programs, on the screen and on its keys: A, B, C, U, "
    "V, W or Y, or one of A, B, C, Q, U, V, W and Y with a digit from 1 to 9.",
)


class LinearAxisKeys:
    """The keys of a linear axis."""

    travel: Pair = declare_key(
        KeyRange(-5000.0, 5000.0, FileUnit.LENGTH),
        meaning="Lowest and highest position, measured from home (X: a radius). 0 must be within it.",
    )
    fixed_points: tuple[float, ...] = declare_key(
        KeyRange(-5000.0, 5000.0, FileUnit.LENGTH),
        default=(),
        meaning="Positions measured from home (X: a radius). Lathe: up to four points to which G75 moves, "
        "FP=1 to FP=4. Mill: one point, the second datum of M92. Default: none, and G75 or M92 is rejected.",
    )
    vmax: float = declare_key(KeyRange(1.0, 1000.0, FileUnit.FEED), meaning="Highest speed of the axis.")
    amax: float = declare_key(
        KeyRange(10.0, 30000.0, FileUnit.ACCELERATION), meaning="Acceleration and deceleration of the axis."
    )
    count: float = declare_key(
        KeyRange(1e-5, 0.02, FileUnit.LENGTH),
        meaning="Travel of one encoder count or step (X: on the radius): lead ÷ (lines × 4 × gear ratio) "
        "for an encoder on the motor.",
    )
    fe_window: float = declare_key(
        KeyRange(0.005, 10.0, FileUnit.LENGTH),
        is_derived=True,
        meaning="Largest following error at `vmax`; at lower speeds the limit falls to `still_window`. "
        "Default: the value of the first linear axis that specifies it, or `vmax` × 15.9 ms.",
    )
    fe_time_ms: float = declare_key(
        KeyRange(0.001, 0.5, FileUnit.MILLISECONDS),
        default=0.02,
        meaning="Time for which the following error may exceed its limit before an alarm stops the axes.",
    )
    in_pos: float = declare_key(
        KeyRange(1e-5, 0.5, FileUnit.LENGTH),
        is_derived=True,
        meaning="Distance from the target within which the axis is in position. Default: the value of the "
        "first linear axis that specifies it, or 4 × `count`.",
    )
    still_window: float = declare_key(
        KeyRange(0.005, 5.0, FileUnit.LENGTH),
        is_derived=True,
        meaning="Largest position error while the axis is at rest. Default: the value of the first linear "
        "axis that specifies it, or 0.2 mm (at least 4 × `in_pos`, at most `fe_window`).",
    )
    still_ms: float = _STILL_MS
    absolute: bool = declare_key(
        default=False,
        meaning="true: the position is known at power-on, so the axis needs no homing. false: the axis "
        "needs a `home` table.",
    )


class HomingKeys:
    """The keys for homing of a linear axis."""

    order: int = declare_key(
        KeyRange(1, 9),
        meaning="Position in the homing sequence. The axes home one after the other, the lowest number "
        "first.",
    )
    speed: float = declare_key(
        KeyRange(0.1, 200.0, FileUnit.FEED), meaning="Speed of the search for the switch."
    )
    method: int = _METHOD
    latch: float = declare_key(
        KeyRange(0.01, 100.0, FileUnit.FEED),
        default=0.0,
        meaning="Slow speed at which the switch edge is found. Default: a tenth of `speed`.",
    )
    offset: float = declare_key(
        KeyRange(-1000.0, 1000.0, FileUnit.LENGTH),
        default=0.0,
        meaning="Position of home, measured from the reference mark (switch edge or index pulse).",
    )


class RotaryHomingKeys:
    """The keys for homing of a rotary axis."""

    order: int = HomingKeys.order
    speed: float = declare_key(
        KeyRange(0.1, 200.0, FileUnit.DEGREES_PER_MINUTE), meaning="Speed of the search for the switch."
    )
    method: int = _METHOD
    latch: float = declare_key(
        KeyRange(0.1, 200.0, FileUnit.DEGREES_PER_MINUTE),
        default=0.0,
        meaning="Slow speed at which the switch edge is found. Default: a tenth of `speed`.",
    )
    offset: float = declare_key(
        KeyRange(-360.0, 360.0, FileUnit.DEGREES),
        default=0.0,
        meaning="Position of home, measured from the reference mark (switch edge or index pulse).",
    )


class LatheCAxisKeys:
    """The keys of the C axis of a lathe."""

    enabled: bool = declare_key(
        default=False, meaning="true: the machine has a C axis. `vmax` and `count` are then required."
    )
    vmax: float = declare_key(
        KeyRange(6.0, 6000.0, FileUnit.C_AXIS_RPM),
        is_derived=True,
        meaning="Highest speed of C. Required if C is enabled.",
    )
    amax: float = declare_key(
        KeyRange(36.0, 360000.0, FileUnit.C_AXIS_RPM_PER_SECOND),
        is_derived=True,
        meaning="Acceleration of C. Default: 3 × `vmax` per second, but not more than `accel_rpm_s` of the "
        "spindle.",
    )
    count: float = declare_key(
        KeyRange(0.0001, 1.0, FileUnit.DEGREES),
        is_derived=True,
        meaning="Angle of one encoder count. Required if C is enabled.",
    )
    fe_window: float = declare_key(
        KeyRange(0.05, 90.0, FileUnit.DEGREES),
        default=5.0,
        meaning="Largest following error at `vmax`; at lower speeds the limit falls to `still_window`.",
    )
    fe_time_ms: float = declare_key(
        KeyRange(0.001, 0.5, FileUnit.MILLISECONDS),
        default=0.02,
        meaning="Time for which the following error may exceed its limit before an alarm stops the axes.",
    )
    in_pos: float = declare_key(
        KeyRange(0.0001, 5.0, FileUnit.DEGREES),
        is_derived=True,
        meaning="Angle from the target within which C is in position. Default: 5 × `count`.",
    )
    still_window: float = declare_key(
        KeyRange(0.001, 45.0, FileUnit.DEGREES),
        is_derived=True,
        meaning="Largest position error while the axis is at rest. Default: 1° (at least 4 × `in_pos`, at "
        "most `fe_window`).",
    )
    still_ms: float = _STILL_MS
    absolute: bool = declare_key(
        default=False, meaning="true: the angle of C is known at power-on. false: M19 finds it."
    )
    modulo: bool = declare_key(
        default=True,
        meaning="SINUMERIK: true counts C from 0° to below 360° without limits; false counts from −360° to "
        "+360°, which are the limits of travel.",
    )
    name: str = _THIRD_NAME
    own_drive: bool = declare_key(
        default=False,
        meaning="true: C has its own drive, and the spindle can turn while C moves. false: the spindle "
        "drive moves C, so the spindle cannot turn while C moves.",
    )
    linear: bool = declare_key(
        default=False, meaning="true: the third axis is linear. It then has the keys of the next table."
    )


class LinearThirdAxisKeys:
    """The keys of a linear third axis of a lathe, which are in mm instead of degrees."""

    travel: Pair = LinearAxisKeys.travel
    vmax: float = LinearAxisKeys.vmax
    amax: float = LinearAxisKeys.amax
    count: float = LinearAxisKeys.count
    fe_window: float = declare_key(
        KeyRange(0.005, 10.0, FileUnit.LENGTH),
        is_derived=True,
        meaning="Largest following error at `vmax`; at lower speeds the limit falls to `still_window`. "
        "Default: `vmax` × 15.9 ms.",
    )
    fe_time_ms: float = LinearAxisKeys.fe_time_ms
    in_pos: float = declare_key(
        KeyRange(1e-5, 0.5, FileUnit.LENGTH),
        is_derived=True,
        meaning="Distance from the target within which the axis is in position. Default: 5 × `count`.",
    )
    still_window: float = declare_key(
        KeyRange(0.005, 5.0, FileUnit.LENGTH),
        is_derived=True,
        meaning="Largest position error while the axis is at rest. Default: 1 mm (at least 4 × `in_pos`, "
        "at most `fe_window`).",
    )
    still_ms: float = LinearAxisKeys.still_ms
    absolute: bool = LinearAxisKeys.absolute
    enabled: bool = declare_key(default=False, meaning="true: the machine has this axis.")
    modulo: bool = declare_key(default=False, meaning="Has no effect on a linear axis.")
    name: str = _THIRD_NAME
    own_drive: bool = declare_key(
        default=True, meaning="Has no effect: a linear axis always has its own drive."
    )
    linear: bool = declare_key(default=False, meaning="true: the third axis is linear.")


class RotaryAxisKeys:
    """The keys of a rotary axis of a mill."""

    travel: Pair = declare_key(
        KeyRange(-36000.0, 36000.0, FileUnit.DEGREES),
        default=(-math.inf, math.inf),
        meaning="Lowest and highest position, measured from home. 0 must be within it. Default: no limits.",
    )
    vmax: float = declare_key(
        KeyRange(0.1, 36000.0, FileUnit.DEGREES_PER_MINUTE), meaning="Highest speed of the axis."
    )
    amax: float = declare_key(
        KeyRange(1.0, 360000.0, FileUnit.DEGREES_PER_SECOND_SQUARED),
        meaning="Acceleration and deceleration of the axis.",
    )
    count: float = declare_key(KeyRange(1e-6, 1.0, FileUnit.DEGREES), meaning="Angle of one encoder count.")
    fe_window: float = declare_key(
        KeyRange(0.001, 90.0, FileUnit.DEGREES),
        is_derived=True,
        meaning="Largest following error at `vmax`; at lower speeds the limit falls to `still_window`. "
        "Default: `vmax` × 15.9 ms.",
    )
    fe_time_ms: float = declare_key(
        KeyRange(0.001, 0.5, FileUnit.MILLISECONDS),
        default=0.02,
        meaning="Time for which the following error may exceed its limit before an alarm stops the axes.",
    )
    in_pos: float = declare_key(
        KeyRange(1e-6, 5.0, FileUnit.DEGREES),
        is_derived=True,
        meaning="Angle from the target within which the axis is in position. Default: 5 × `count`.",
    )
    still_window: float = declare_key(
        KeyRange(0.0005, 45.0, FileUnit.DEGREES),
        is_derived=True,
        meaning="Largest position error while the axis is at rest. Default: 1° (at least 4 × `in_pos`, at "
        "most `fe_window`).",
    )
    still_ms: float = _STILL_MS
    absolute: bool = declare_key(
        default=False,
        meaning="true: the position is known at power-on, so the axis needs no homing. false: the axis "
        "needs a `home` table.",
    )
