"""Every key that a machine file may hold, with its range. Ranges are in the model's units: mm, s, degrees."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from core.machine.driver_tables import tables_of
from core.table_schema import Driver, Field, Kind, Unit

KINDS = ("lathe", "mill")
LANGUAGES = {"lathe": ("omniturn", "sinumerik"), "mill": ("klartext",)}  # the first one is the default
SLIDES = {"lathe": ("X", "Z"), "mill": ("X", "Y", "Z")}
ROTARY = {"lathe": (), "mill": ("A", "B", "C")}  # those a machine may have; a lathe's C is its spindle

_NUMBER, _WHOLE, _FLAG, _TEXT, _CHOICE = Kind.NUMBER, Kind.WHOLE, Kind.FLAG, Kind.TEXT, Kind.CHOICE

_MACHINE = (
    Field("name", _TEXT, meaning="Name of the machine, shown on the screen and in reports."),
    Field(
        "units",
        _CHOICE,
        choices=("inch", "mm"),
        meaning="Unit of every length, feed and acceleration in this file.",
    ),
    Field(
        "kind",
        _CHOICE,
        choices=KINDS,
        default="lathe",
        meaning="Kind of machine. It determines which axes, tables and languages the machine can have.",
    ),
    Field(
        "language",
        _CHOICE,
        choices=("omniturn", "sinumerik", "klartext"),
        default="",
        meaning=(
            'Language of MDI blocks. Default: "omniturn" on a lathe, "klartext" on a mill. A lathe '
            'accepts "omniturn" and "sinumerik", a mill only "klartext".'
        ),
    ),
    Field(
        "control",
        _CHOICE,
        choices=("802d", "808d", "828d", "840d"),
        default="840d",
        meaning=(
            "SINUMERIK control for which the programs were written. It determines how TurnDesk "
            "reads codes that differ between these controls."
        ),
    ),
    Field(
        "feeder",
        _FLAG,
        default=False,
        meaning=(
            'true: the drivers run in a separate process, the driver host. "canopen" and "hal" '
            'always use it, "grblhal" never.'
        ),
    ),
    Field(
        "x_is",
        _CHOICE,
        choices=("radius", "diameter"),
        default="diameter",
        meaning=(
            "Not used by this version. X is a radius everywhere in this file, and each language "
            "defines X in its programs."
        ),
    ),
    Field(
        "commit_ms",
        _NUMBER,
        Unit.MILLISECONDS,
        0.001,
        0.2,
        meaning=(
            "Remaining time before its execution below which a queued setpoint can no longer be "
            "changed. A feed hold and the end of a jog take effect after this time."
        ),
    ),
    Field(
        "lookahead_ms",
        _NUMBER,
        Unit.MILLISECONDS,
        0.1,
        10.0,
        meaning="Time for which setpoints are queued ahead of the motion.",
    ),
    Field(
        "low_water_ms",
        _NUMBER,
        Unit.MILLISECONDS,
        0.005,
        2.0,
        meaning="If less than this time is queued during a cycle, TurnDesk starts a feed hold.",
    ),
    Field(
        "lease_ms",
        _NUMBER,
        Unit.MILLISECONDS,
        0.05,
        0.5,
        meaning="Time after which a jog stops if it is not renewed.",
    ),
    Field(
        "setpoint_ms",
        _NUMBER,
        Unit.MILLISECONDS,
        0.0001,
        0.02,
        default=0.001,
        meaning="Duration of a setpoint. At a corner the velocity of an axis may change by `amax` × "
        "this time.",
    ),
)
LIMITS = (
    Field(
        "max_feed",
        _NUMBER,
        Unit.FEED,
        0.1,
        1000.0,
        derived=True,
        meaning=(
            "Highest feed that F may command, along the path. Default: `vmax` of the slowest linear axis."
        ),
    ),
    Field(
        "manual_rapid",
        _NUMBER,
        Unit.FEED,
        0.1,
        500.0,
        derived=True,
        meaning="Rapid speed of a jog. Default: 100 in/min, or `vmax` of the slowest linear axis if "
        "that is lower.",
    ),
    Field(
        "resolution",
        _NUMBER,
        Unit.LENGTH,
        1e-5,
        0.02,
        derived=True,
        meaning=(
            "Smallest programmable distance (X: on the radius). Default: the largest `count` of the "
            "linear axes."
        ),
    ),
    Field(
        "clearance",
        _NUMBER,
        Unit.LENGTH,
        0.1,
        100.0,
        default=31.75,
        meaning=(
            "Distance that an axis jogging at `vmax` may travel after the last renewal of the "
            "jog. TurnDesk checks `lease_ms` against this distance."
        ),
    ),
    Field(
        "corner_tolerance",
        _NUMBER,
        Unit.LENGTH,
        0.0,
        0.1,
        default=0.0,
        meaning=(
            "Largest deviation of the tool tip where a curve was split into short chords. With 0, "
            "each joint moves by at most one `count` per axis."
        ),
    ),
)
_STILL = Field(
    "still_ms",
    _NUMBER,
    Unit.MILLISECONDS,
    0.05,
    2.0,
    default=0.2,
    meaning="Time after the last setpoint before `still_window` applies.",
)
SLIDE = (
    Field(
        "travel",
        Kind.PAIR,
        Unit.LENGTH,
        -5000.0,
        5000.0,
        meaning="Lowest and highest position, measured from home (X: a radius). 0 must be within it.",
    ),
    Field(
        "fixed_points",
        Kind.NUMBERS,
        Unit.LENGTH,
        -5000.0,
        5000.0,
        default=(),
        meaning=(
            "Positions measured from home (X: a radius). Lathe: up to four points to which G75 "
            "moves, FP=1 to FP=4. Mill: one point, the second datum of M92. Default: none, and "
            "G75 or M92 is rejected."
        ),
    ),
    Field("vmax", _NUMBER, Unit.FEED, 1.0, 1000.0, meaning="Highest speed of the axis."),
    Field("amax", _NUMBER, Unit.ACCEL, 10.0, 30000.0, meaning="Acceleration and deceleration of the axis."),
    Field(
        "count",
        _NUMBER,
        Unit.LENGTH,
        1e-5,
        0.02,
        meaning=(
            "Travel of one encoder count or step (X: on the radius): lead ÷ (lines × 4 × gear "
            "ratio) for an encoder on the motor."
        ),
    ),
    Field(
        "fe_window",
        _NUMBER,
        Unit.LENGTH,
        0.005,
        10.0,
        derived=True,
        meaning=(
            "Largest following error at `vmax`; at lower speeds the limit falls to `still_window`. "
            "Default: the value of the first linear axis that specifies it, or `vmax` × 15.9 ms."
        ),
    ),
    Field(
        "fe_time_ms",
        _NUMBER,
        Unit.MILLISECONDS,
        0.001,
        0.5,
        default=0.02,
        meaning="Time for which the following error may exceed its limit before an alarm stops the axes.",
    ),
    Field(
        "in_pos",
        _NUMBER,
        Unit.LENGTH,
        1e-5,
        0.5,
        derived=True,
        meaning=(
            "Distance from the target within which the axis is in position. Default: the value of "
            "the first linear axis that specifies it, or 4 × `count`."
        ),
    ),
    Field(
        "still_window",
        _NUMBER,
        Unit.LENGTH,
        0.005,
        5.0,
        derived=True,
        meaning=(
            "Largest position error while the axis is at rest. Default: the value of the first "
            "linear axis that specifies it, or 0.2 mm (at least 4 × `in_pos`, at most "
            "`fe_window`)."
        ),
    ),
    _STILL,
    Field(
        "absolute",
        _FLAG,
        default=False,
        meaning=(
            "true: the position is known at power-on, so the axis needs no homing. false: the axis "
            "needs a `home` table."
        ),
    ),
)
_METHOD = Field(
    "method",
    _WHOLE,
    low=-128,
    high=37,
    default=0,
    meaning=(
        "Homing method of CiA 402, such as 1 or 2 (limit switch and index), 5 (home switch and "
        "index) or 37 (present position). 0: not specified; the simulated machine needs no method."
    ),
)
HOME = (
    Field(
        "order",
        _WHOLE,
        low=1,
        high=9,
        meaning=(
            "Position in the homing sequence. The axes home one after the other, the lowest number first."
        ),
    ),
    Field("speed", _NUMBER, Unit.FEED, 0.1, 200.0, meaning="Speed of the search for the switch."),
    _METHOD,
    Field(
        "latch",
        _NUMBER,
        Unit.FEED,
        0.01,
        100.0,
        default=0.0,
        meaning="Slow speed at which the switch edge is found. Default: a tenth of `speed`.",
    ),
    Field(
        "offset",
        _NUMBER,
        Unit.LENGTH,
        -1000.0,
        1000.0,
        default=0.0,
        meaning="Position of home, measured from the reference mark (switch edge or index pulse).",
    ),
)
ROTARY_HOME = (
    Field(
        "order",
        _WHOLE,
        low=1,
        high=9,
        meaning=(
            "Position in the homing sequence. The axes home one after the other, the lowest number first."
        ),
    ),
    Field(
        "speed", _NUMBER, Unit.DEGREES_PER_MINUTE, 0.1, 200.0, meaning="Speed of the search for the switch."
    ),
    _METHOD,
    Field(
        "latch",
        _NUMBER,
        Unit.DEGREES_PER_MINUTE,
        0.1,
        200.0,
        default=0.0,
        meaning="Slow speed at which the switch edge is found. Default: a tenth of `speed`.",
    ),
    Field(
        "offset",
        _NUMBER,
        Unit.DEGREES,
        -360.0,
        360.0,
        default=0.0,
        meaning="Position of home, measured from the reference mark (switch edge or index pulse).",
    ),
)
THIRD_AXIS_NAMES = (*"ABCUVWY", *(f"{letter}{digit}" for letter in "ABCQUVWY" for digit in range(1, 10)))
_THIRD_NAME = (
    "Name of the third axis in SINUMERIK programs, on the screen and on its keys: A, B, C, U, V, W or Y, or "
    "one of A, B, C, Q, U, V, W and Y with a digit from 1 to 9."
)
C_AXIS = (
    Field(
        "enabled",
        _FLAG,
        default=False,
        meaning="true: the machine has a C axis. `vmax` and `count` are then required.",
    ),
    Field(
        "vmax",
        _NUMBER,
        Unit.TURNS_PER_MINUTE,
        6.0,
        6000.0,
        derived=True,
        meaning="Highest speed of C. Required if C is enabled.",
    ),
    Field(
        "amax",
        _NUMBER,
        Unit.TURNS_PER_MINUTE_SECOND,
        36.0,
        360000.0,
        derived=True,
        meaning=(
            "Acceleration of C. Default: 3 × `vmax` per second, but not more than `accel_rpm_s` of "
            "the spindle."
        ),
    ),
    Field(
        "count",
        _NUMBER,
        Unit.DEGREES,
        0.0001,
        1.0,
        derived=True,
        meaning="Angle of one encoder count. Required if C is enabled.",
    ),
    Field(
        "fe_window",
        _NUMBER,
        Unit.DEGREES,
        0.05,
        90.0,
        default=5.0,
        meaning="Largest following error at `vmax`; at lower speeds the limit falls to `still_window`.",
    ),
    Field(
        "fe_time_ms",
        _NUMBER,
        Unit.MILLISECONDS,
        0.001,
        0.5,
        default=0.02,
        meaning="Time for which the following error may exceed its limit before an alarm stops the axes.",
    ),
    Field(
        "in_pos",
        _NUMBER,
        Unit.DEGREES,
        0.0001,
        5.0,
        derived=True,
        meaning="Angle from the target within which C is in position. Default: 5 × `count`.",
    ),
    Field(
        "still_window",
        _NUMBER,
        Unit.DEGREES,
        0.001,
        45.0,
        derived=True,
        meaning="Largest position error while the axis is at rest. Default: 1° (at least 4 × "
        "`in_pos`, at most `fe_window`).",
    ),
    _STILL,
    Field(
        "absolute",
        _FLAG,
        default=False,
        meaning="true: the angle of C is known at power-on. false: M19 finds it.",
    ),
    Field(
        "modulo",
        _FLAG,
        default=True,
        meaning=(
            "SINUMERIK: true counts C from 0° to below 360° without limits; false counts from −360° "
            "to +360°, which are the limits of travel."
        ),
    ),
    Field(
        "name",
        _CHOICE,
        choices=THIRD_AXIS_NAMES,
        default="C",
        meaning=_THIRD_NAME,
    ),
    Field(
        "own_drive",
        _FLAG,
        default=False,
        meaning=(
            "true: C has its own drive, and the spindle can turn while C moves. false: the "
            "spindle drive moves C, so the spindle cannot turn while C moves."
        ),
    ),
    Field(
        "linear",
        _FLAG,
        default=False,
        meaning="true: the third axis is linear. It then has the keys of the next table.",
    ),
)
_OF_THIRD_SLIDE = {
    "fe_window": (
        "Largest following error at `vmax`; at lower speeds the limit falls to `still_window`. Default: "
        "`vmax` × 15.9 ms."
    ),
    "in_pos": "Distance from the target within which the axis is in position. Default: 5 × `count`.",
    "still_window": (
        "Largest position error while the axis is at rest. Default: 1 mm (at least 4 × "
        "`in_pos`, at most `fe_window`)."
    ),
}
THIRD_SLIDE = (
    *(
        replace(each, meaning=_OF_THIRD_SLIDE.get(each.key, each.meaning))
        for each in SLIDE
        if each.key != "fixed_points"
    ),
    Field("enabled", _FLAG, default=False, meaning="true: the machine has this axis."),
    Field("modulo", _FLAG, default=False, meaning="Has no effect on a linear axis."),
    Field(
        "name",
        _CHOICE,
        choices=THIRD_AXIS_NAMES,
        default="C",
        meaning=_THIRD_NAME,
    ),
    Field("own_drive", _FLAG, default=True, meaning="Has no effect: a linear axis always has its own drive."),
    Field("linear", _FLAG, default=False, meaning="true: the third axis is linear."),
)
"""The third axis of a lathe where it is linear: mm where C has degrees."""
ROTARY_AXIS = (
    Field(
        "travel",
        Kind.PAIR,
        Unit.DEGREES,
        -36000.0,
        36000.0,
        default=(-math.inf, math.inf),
        meaning="Lowest and highest position, measured from home. 0 must be within it. Default: no limits.",
    ),
    Field("vmax", _NUMBER, Unit.DEGREES_PER_MINUTE, 0.1, 36000.0, meaning="Highest speed of the axis."),
    Field(
        "amax",
        _NUMBER,
        Unit.DEGREES_PER_SECOND_SQUARED,
        1.0,
        360000.0,
        meaning="Acceleration and deceleration of the axis.",
    ),
    Field("count", _NUMBER, Unit.DEGREES, 1e-6, 1.0, meaning="Angle of one encoder count."),
    Field(
        "fe_window",
        _NUMBER,
        Unit.DEGREES,
        0.001,
        90.0,
        derived=True,
        meaning=(
            "Largest following error at `vmax`; at lower speeds the limit falls to `still_window`. "
            "Default: `vmax` × 15.9 ms."
        ),
    ),
    Field(
        "fe_time_ms",
        _NUMBER,
        Unit.MILLISECONDS,
        0.001,
        0.5,
        default=0.02,
        meaning="Time for which the following error may exceed its limit before an alarm stops the axes.",
    ),
    Field(
        "in_pos",
        _NUMBER,
        Unit.DEGREES,
        1e-6,
        5.0,
        derived=True,
        meaning="Angle from the target within which the axis is in position. Default: 5 × `count`.",
    ),
    Field(
        "still_window",
        _NUMBER,
        Unit.DEGREES,
        0.0005,
        45.0,
        derived=True,
        meaning="Largest position error while the axis is at rest. Default: 1° (at least 4 × "
        "`in_pos`, at most `fe_window`).",
    ),
    _STILL,
    Field(
        "absolute",
        _FLAG,
        default=False,
        meaning=(
            "true: the position is known at power-on, so the axis needs no homing. false: the axis "
            "needs a `home` table."
        ),
    ),
)
C_OPTION = (
    Field(
        "feedback",
        _FLAG,
        default=False,
        meaning=(
            "true: the drive reports that C has reached its angle. false: TurnDesk calculates when "
            "C arrives and warns if a dwell is too short."
        ),
    ),
)
_SPINDLE = (
    Field("rpm", Kind.PAIR, Unit.RPM, 1.0, 20000.0, meaning="Lowest and highest speed."),
    Field("accel_rpm_s", _NUMBER, Unit.RPM_PER_SECOND, 10.0, 50000.0, meaning="Acceleration of the spindle."),
    Field(
        "decel_rpm_s",
        _NUMBER,
        Unit.RPM_PER_SECOND,
        10.0,
        50000.0,
        derived=True,
        meaning="Deceleration of the spindle. Default: `accel_rpm_s`.",
    ),
    Field(
        "at_speed_pct",
        _NUMBER,
        Unit.PERCENT,
        0.005,
        0.25,
        meaning=(
            "Largest difference between the measured and the commanded speed, in percent of the "
            "commanded speed, at which the spindle is at speed."
        ),
    ),
    Field(
        "at_speed_s",
        _NUMBER,
        Unit.SECONDS,
        0.05,
        5.0,
        meaning="Time for which the speed must be within `at_speed_pct` before the spindle is at speed.",
    ),
    Field(
        "timeout_s",
        _NUMBER,
        Unit.SECONDS,
        0.5,
        60.0,
        meaning=(
            "Time within which the spindle must reach its speed or stop. If it does not, an "
            "alarm stops the cycle. It must be longer than the time to accelerate to the highest "
            "speed."
        ),
    ),
    Field(
        "stop_below",
        _NUMBER,
        Unit.RPM,
        0.5,
        50.0,
        meaning="Speed below which the spindle counts as stopped. It must be below the lowest speed.",
    ),
    Field(
        "encoder_ppr",
        _WHOLE,
        low=0,
        high=100000,
        meaning=(
            "Lines per revolution of the spindle encoder, four counts each. 0: no encoder. For a "
            "CANopen spindle drive, `counts_per_rev` of its node applies instead."
        ),
    ),
    Field(
        "controlled",
        _FLAG,
        default=True,
        meaning=(
            "false: the spindle has one fixed speed, the highest of `rpm`. SINUMERIK programs with "
            "S, G96 or G4 S are then rejected."
        ),
    ),
    Field(
        "oriented",
        _FLAG,
        default=False,
        meaning=(
            "true: the drive can stop the spindle at an angle. false: SPOS, M19 and cycle 204 are "
            "rejected, and cycle 202 stops so that the operator can turn the spindle."
        ),
    ),
    Field(
        "orient_rpm",
        _NUMBER,
        Unit.RPM,
        1.0,
        1000.0,
        default=60.0,
        meaning=(
            "Speed at which the oriented spindle turns to its angle. The proof uses this value, "
            "and a faster spindle raises alarm 203."
        ),
    ),
    Field(
        "power_kw",
        _NUMBER,
        Unit.KILOWATTS,
        50.0,
        100000.0,
        default=0.0,
        meaning=(
            "Power of the spindle drive at the highest speed. Shapes uses it to suggest the "
            "depth of cut. Default: 1.5 kW is assumed."
        ),
    ),
)
COLLET = (
    Field(
        "open_s",
        _NUMBER,
        Unit.SECONDS,
        0.01,
        10.0,
        default=0.5,
        meaning=(
            "Time that the collet takes to open. The proof uses it, and so does a cycle if no input "
            "`collet_closed` is wired."
        ),
    ),
    Field(
        "close_s",
        _NUMBER,
        Unit.SECONDS,
        0.01,
        10.0,
        derived=True,
        meaning=(
            "Time that the collet takes to close, used like `open_s`. Default: 0.5 s if the input "
            "`collet_closed` is wired; otherwise the key is required."
        ),
    ),
)
INTERLOCKS = (
    Field(
        "spindle_with_collet_open",
        _FLAG,
        default=False,
        meaning="true: the spindle may turn with the collet open. false needs the input `collet_closed`.",
    ),
    Field(
        "unclamp_while_turning",
        _FLAG,
        default=True,
        meaning=(
            "true: the collet may open while the spindle turns, as bar work needs. false: the "
            "collet opens only when the spindle has stopped."
        ),
    ),
    Field(
        "two_hand_start",
        _FLAG,
        default=True,
        meaning=(
            "true: a cycle starts only by the input `start`, the output of the two-hand relay, "
            "or by both palm buttons of the operator station on the screen. false: Cycle Start "
            "on the screen is enough. The simulated machine always accepts Cycle Start on the "
            "screen."
        ),
    ),
    Field(
        "guard_stops",
        _FLAG,
        default=False,
        meaning=(
            "true: while the input `guard` is off, the cycle is in feed hold, the spindle stops, "
            "and no cycle starts."
        ),
    ),
)
CLAMPING = (
    Field(
        "diameter",
        _NUMBER,
        Unit.LENGTH,
        0.0,
        2000.0,
        default=0.0,
        meaning="Diameter of the chuck or collet. 0: not specified, and not checked.",
    ),
    Field(
        "stick_out",
        _NUMBER,
        Unit.LENGTH,
        0.0,
        2000.0,
        default=0.0,
        meaning=(
            "Distance from the front of the jaws or collet to part zero. 0: not specified, and not checked."
        ),
    ),
    Field(
        "jaws",
        _NUMBER,
        Unit.LENGTH,
        0.0,
        500.0,
        default=0.0,
        meaning="Length by which the jaws or the collet nose protrude from the body.",
    ),
    Field(
        "jaw_diameter",
        _NUMBER,
        Unit.LENGTH,
        0.0,
        2000.0,
        default=0.0,
        meaning="Outside diameter of the jaws. 0: the same as `diameter`.",
    ),
    Field(
        "max_rpm",
        _NUMBER,
        Unit.RPM,
        0.0,
        50000.0,
        default=0.0,
        meaning="Highest permitted speed of the chuck. 0: not specified, and not checked.",
    ),
    Field(
        "quill_diameter",
        _NUMBER,
        Unit.LENGTH,
        0.0,
        500.0,
        default=0.0,
        meaning="Diameter of the tailstock quill. 0: no tailstock.",
    ),
    Field(
        "centre_point",
        _NUMBER,
        Unit.DEGREES,
        10.0,
        170.0,
        default=60.0,
        meaning="Included angle of the tailstock center.",
    ),
    Field(
        "centre_at",
        _NUMBER,
        Unit.LENGTH,
        -2000.0,
        2000.0,
        default=0.0,
        meaning="Z position of the tip of the tailstock center, measured from part zero.",
    ),
)
TOOLING = (
    Field(
        "kind",
        _CHOICE,
        choices=("single", "gang", "turret"),
        default="single",
        meaning=(
            '"gang": all tools are on one plate, and the proof also checks the neighboring tools. '
            '"single": one tool at a time. "turret" is rejected because TurnDesk does not index turrets.'
        ),
    ),
)
CHECKS = (
    Field(
        "silenced",
        Kind.WORDS,
        default="",
        meaning=(
            "IDs of the checks of the part whose findings are only notes on this machine, such as "
            "`chip-load`; they are listed in [checks.md](../checks.md)."
        ),
    ),
)
OUTPUT = (
    Field(
        "at",
        _TEXT,
        meaning=(
            'Terminal of the output, written as the backend requires. "none": the machine does not '
            "have this output."
        ),
    ),
    Field(
        "safe",
        _CHOICE,
        choices=(True, False, "keep"),
        meaning=(
            "State of the output after an E-stop and, where the backend supports it, if TurnDesk "
            'stops responding. "keep" leaves the output unchanged.'
        ),
    ),
    Field(
        "refresh_ms",
        _NUMBER,
        Unit.MILLISECONDS,
        0.05,
        10.0,
        default=0.0,
        meaning=(
            "Time after which the output switches off if TurnDesk does not refresh it; needs `safe "
            "= false`. Default: no refresh is necessary."
        ),
    ),
)
INPUT = (
    Field(
        "at",
        _TEXT,
        meaning=(
            "Terminal of the input, written as the backend requires, or `pendant.…` for a button of "
            "the pendant."
        ),
    ),
    Field(
        "active",
        _CHOICE,
        choices=("high", "low"),
        default="high",
        meaning='"low": the input is on when it has no voltage, so a broken wire reads as on.',
    ),
)
M_CODE = (
    Field("output", _TEXT, meaning="Name of the output in [io.out] that the code switches."),
    Field("on", _FLAG, meaning="State to which the code switches the output."),
    Field(
        "enabled",
        _FLAG,
        default=True,
        meaning="false: the code is defined, but programs that use it are rejected.",
    ),
)
M_IGNORED = (
    Field(
        "ignored",
        _CHOICE,
        choices=(True,),
        meaning="true: programs may contain this code of another machine, and it does nothing.",
    ),
    Field("enabled", _FLAG, default=True, meaning="false: programs that use the code are rejected."),
)
"""An M code of another machine of which this one's owner says that it does nothing here."""


def machine_fields(drivers: Sequence[Driver]) -> tuple[Field, ...]:
    """[machine]: which backends there are is the drivers' word."""
    backends = tuple(driver.backend for driver in drivers if driver.backend)
    return (
        *_MACHINE[:3],
        Field(
            "backend",
            _CHOICE,
            choices=backends,
            default="sim",
            meaning=(
                "Connection to the machine. Each backend other than the simulated machine needs the "
                "table with the same name."
            ),
        ),
        *_MACHINE[3:],
    )


def plain_tables(drivers: Sequence[Driver]) -> tuple[tuple[str, tuple[Field, ...]], ...]:
    """Path and keys; axis, io and m_codes hold tables, some under names of the owner's choice.

    What turns the spindle is the drivers' word.
    """
    words = tuple(driver.spindle for driver in drivers if driver.spindle)
    return (
        ("limits", LIMITS),
        ("c_axis", C_OPTION),
        (
            "spindle",
            (
                *_SPINDLE,
                Field(
                    "driver",
                    _CHOICE,
                    choices=words,
                    default="sim",
                    meaning=(
                        'Driver of the spindle: that of the backend ("cia402" for CANopen), or '
                        '"vfd" for an inverter on a serial line, which needs [spindle.vfd].'
                    ),
                ),
            ),
        ),
        ("collet", COLLET),
        ("interlocks", INTERLOCKS),
        ("clamping", CLAMPING),
        ("tooling", TOOLING),
        ("checks", CHECKS),
    )


def top_tables(drivers: Sequence[Driver]) -> tuple[str, ...]:
    """Every table that a file may have, in the order in which its owner is told of them."""
    own = [table for table in tables_of(drivers) if "." not in table.path]
    return (
        *(
            "machine",
            "limits",
            "axis",
            "c_axis",
            "spindle",
            "collet",
            "clamping",
            "tooling",
            "checks",
            "interlocks",
            "io",
            "m_codes",
        ),
        *(table.path for table in own if table.always),
        "kinematics",
        *(table.path for table in own if not table.always),
    )


# A mill has none of these; its model holds what stands here.
TABLES_OF_A_LATHE: dict[str, tuple[Field, ...]] = {
    "c_axis": C_OPTION,
    "collet": (
        Field("open_s", _NUMBER, Unit.SECONDS, 0.0, 10.0, default=0.0, meaning="A mill has no collet."),
        Field("close_s", _NUMBER, Unit.SECONDS, 0.0, 10.0, default=0.0, meaning="A mill has no collet."),
    ),
}
MAY_BE_MISSING = ("limits", "collet", "clamping", "tooling", "checks", "c_axis", "interlocks", "m_codes")

# M codes with a meaning of their own in the machine's language; the machine file cannot assign them.
FIXED_M_CODES = {
    "omniturn": frozenset((0, 1, 2, 3, 4, 5, 8, 9, 12, 13, 19, 30, 31, 89, *range(91, 100))),
    "sinumerik": frozenset((0, 1, 2, 3, 4, 5, 7, 8, 9, 17, 19, 30, 70, 98, 99)),
    "klartext": frozenset((0, 1, 2, 3, 4, 5, 8, 9, 13, 14, 19, 30, 31, 89, *range(91, 100))),
}
