"""Every key that a machine file may hold, with its range. Ranges are in the model's units: mm, s, degrees."""

from __future__ import annotations

import math
from collections.abc import Sequence

from core.machine.driver_tables import tables_of
from core.table_schema import Driver, Field, Kind, Unit

KINDS = ("lathe", "mill")
LANGUAGES = {"lathe": ("omniturn", "sinumerik"), "mill": ("klartext",)}  # the first one is the default
SLIDES = {"lathe": ("X", "Z"), "mill": ("X", "Y", "Z")}
ROTARY = {"lathe": (), "mill": ("A", "B", "C")}  # those a machine may have; a lathe's C is its spindle

_NUMBER, _WHOLE, _FLAG, _TEXT, _CHOICE = Kind.NUMBER, Kind.WHOLE, Kind.FLAG, Kind.TEXT, Kind.CHOICE

_MACHINE = (
    Field("name", _TEXT),
    Field("units", _CHOICE, choices=("inch", "mm")),
    Field("kind", _CHOICE, choices=KINDS, default="lathe"),
    Field("language", _CHOICE, choices=("omniturn", "sinumerik", "klartext"), default=""),
    Field("control", _CHOICE, choices=("802d", "808d", "828d", "840d"), default="840d"),  # SINUMERIK's words
    Field("feeder", _FLAG, default=False),
    Field("x_is", _CHOICE, choices=("radius", "diameter"), default="diameter"),
    Field("commit_ms", _NUMBER, Unit.MILLISECONDS, 0.001, 0.2),
    Field("lookahead_ms", _NUMBER, Unit.MILLISECONDS, 0.1, 10.0),
    Field("low_water_ms", _NUMBER, Unit.MILLISECONDS, 0.005, 2.0),
    Field("lease_ms", _NUMBER, Unit.MILLISECONDS, 0.05, 0.5),
    Field("setpoint_ms", _NUMBER, Unit.MILLISECONDS, 0.0001, 0.02, default=0.001),
)
LIMITS = (
    Field("max_feed", _NUMBER, Unit.FEED, 0.1, 1000.0, derived=True),
    Field("manual_rapid", _NUMBER, Unit.FEED, 0.1, 500.0, derived=True),
    Field("resolution", _NUMBER, Unit.LENGTH, 1e-5, 0.02, derived=True),
    Field("clearance", _NUMBER, Unit.LENGTH, 0.1, 100.0, default=31.75),
    Field("corner_tolerance", _NUMBER, Unit.LENGTH, 0.0, 0.1, default=0.0),
)
_STILL = Field("still_ms", _NUMBER, Unit.MILLISECONDS, 0.05, 2.0, default=0.2)  # a servo settles in less
SLIDE = (
    Field("travel", Kind.PAIR, Unit.LENGTH, -5000.0, 5000.0),
    Field("fixed_points", Kind.NUMBERS, Unit.LENGTH, -5000.0, 5000.0, default=()),  # G75, M92
    Field("vmax", _NUMBER, Unit.FEED, 1.0, 1000.0),
    Field("amax", _NUMBER, Unit.ACCEL, 10.0, 30000.0),
    Field("count", _NUMBER, Unit.LENGTH, 1e-5, 0.02),
    Field("fe_window", _NUMBER, Unit.LENGTH, 0.005, 10.0, derived=True),
    Field("fe_time_ms", _NUMBER, Unit.MILLISECONDS, 0.001, 0.5, default=0.02),
    Field("in_pos", _NUMBER, Unit.LENGTH, 1e-5, 0.5, derived=True),
    Field("still_window", _NUMBER, Unit.LENGTH, 0.005, 5.0, derived=True),
    _STILL,
    Field("absolute", _FLAG, default=False),
)
_METHOD = Field("method", _WHOLE, low=-128, high=37, default=0)  # of CiA 402; the simulation needs none
HOME = (
    Field("order", _WHOLE, low=1, high=9),
    Field("speed", _NUMBER, Unit.FEED, 0.1, 200.0),
    _METHOD,
    Field("latch", _NUMBER, Unit.FEED, 0.01, 100.0, default=0.0),
    Field("offset", _NUMBER, Unit.LENGTH, -1000.0, 1000.0, default=0.0),
)
ROTARY_HOME = (
    Field("order", _WHOLE, low=1, high=9),
    Field("speed", _NUMBER, Unit.DEGREES_PER_MINUTE, 0.1, 200.0),
    _METHOD,
    Field("latch", _NUMBER, Unit.DEGREES_PER_MINUTE, 0.1, 200.0, default=0.0),
    Field("offset", _NUMBER, Unit.DEGREES, -360.0, 360.0, default=0.0),
)
THIRD_AXIS_NAMES = (*"ABCUVWY", *(f"{letter}{digit}" for letter in "ABCQUVWY" for digit in range(1, 10)))
C_AXIS = (
    Field("enabled", _FLAG, default=False),
    Field("vmax", _NUMBER, Unit.TURNS_PER_MINUTE, 6.0, 6000.0, derived=True),
    Field("amax", _NUMBER, Unit.TURNS_PER_MINUTE_SECOND, 36.0, 360000.0, derived=True),
    Field("count", _NUMBER, Unit.DEGREES, 0.0001, 1.0, derived=True),
    Field("fe_window", _NUMBER, Unit.DEGREES, 0.05, 90.0, default=5.0),
    Field("fe_time_ms", _NUMBER, Unit.MILLISECONDS, 0.001, 0.5, default=0.02),
    Field("in_pos", _NUMBER, Unit.DEGREES, 0.0001, 5.0, derived=True),
    Field("still_window", _NUMBER, Unit.DEGREES, 0.001, 45.0, derived=True),
    _STILL,
    Field("absolute", _FLAG, default=False),
    Field("modulo", _FLAG, default=True),  # SINUMERIK: 0..<360; false: -360..+360
    Field("name", _CHOICE, choices=THIRD_AXIS_NAMES, default="C"),  # SINUMERIK: what programs call it
    Field("own_drive", _FLAG, default=False),  # false: the spindle is C, and cannot turn meanwhile
    Field("linear", _FLAG, default=False),  # true: a slide beside X and Z; its keys are those of THIRD_SLIDE
)
THIRD_SLIDE = (
    *(each for each in SLIDE if each.key != "fixed_points"),
    Field("enabled", _FLAG, default=False),
    Field("modulo", _FLAG, default=False),
    Field("name", _CHOICE, choices=THIRD_AXIS_NAMES, default="C"),
    Field("own_drive", _FLAG, default=True),
    Field("linear", _FLAG, default=False),
)
"""The third axis of a lathe where it is linear: mm where C has degrees."""
ROTARY_AXIS = (
    Field("travel", Kind.PAIR, Unit.DEGREES, -36000.0, 36000.0, default=(-math.inf, math.inf)),
    Field("vmax", _NUMBER, Unit.DEGREES_PER_MINUTE, 0.1, 36000.0),
    Field("amax", _NUMBER, Unit.DEGREES_PER_SECOND_SQUARED, 1.0, 360000.0),
    Field("count", _NUMBER, Unit.DEGREES, 1e-6, 1.0),
    Field("fe_window", _NUMBER, Unit.DEGREES, 0.001, 90.0, derived=True),
    Field("fe_time_ms", _NUMBER, Unit.MILLISECONDS, 0.001, 0.5, default=0.02),
    Field("in_pos", _NUMBER, Unit.DEGREES, 1e-6, 5.0, derived=True),
    Field("still_window", _NUMBER, Unit.DEGREES, 0.0005, 45.0, derived=True),
    _STILL,
    Field("absolute", _FLAG, default=False),
)
C_OPTION = (Field("feedback", _FLAG, default=False),)
_SPINDLE = (
    Field("rpm", Kind.PAIR, Unit.RPM, 1.0, 20000.0),
    Field("accel_rpm_s", _NUMBER, Unit.RPM_PER_SECOND, 10.0, 50000.0),
    Field("decel_rpm_s", _NUMBER, Unit.RPM_PER_SECOND, 10.0, 50000.0, derived=True),
    Field("at_speed_pct", _NUMBER, Unit.PERCENT, 0.005, 0.25),
    Field("at_speed_s", _NUMBER, Unit.SECONDS, 0.05, 5.0),
    Field("timeout_s", _NUMBER, Unit.SECONDS, 0.5, 60.0),
    Field("stop_below", _NUMBER, Unit.RPM, 0.5, 50.0),
    Field("encoder_ppr", _WHOLE, low=0, high=100000),
    Field("controlled", _FLAG, default=True),  # false: it has one speed, and S none to set
    Field("oriented", _FLAG, default=False),  # its drive stops it at an angle, for M19, SPOS and back boring
    Field("orient_rpm", _NUMBER, Unit.RPM, 1.0, 1000.0, default=60.0),  # at which it turns to that
    Field("power_kw", _NUMBER, Unit.KILOWATTS, 50.0, 100000.0, default=0.0),  # at the highest speed
)
COLLET = (
    Field("open_s", _NUMBER, Unit.SECONDS, 0.01, 10.0, default=0.5),
    Field("close_s", _NUMBER, Unit.SECONDS, 0.01, 10.0, derived=True),
)
INTERLOCKS = (
    Field("spindle_with_collet_open", _FLAG, default=False),
    Field("unclamp_while_turning", _FLAG, default=True),
    Field("two_hand_start", _FLAG, default=True),
    Field("guard_stops", _FLAG, default=False),
)
CLAMPING = (  # 0: not said, and not checked
    Field("diameter", _NUMBER, Unit.LENGTH, 0.0, 2000.0, default=0.0),
    Field("stick_out", _NUMBER, Unit.LENGTH, 0.0, 2000.0, default=0.0),
    Field("jaws", _NUMBER, Unit.LENGTH, 0.0, 500.0, default=0.0),
    Field("jaw_diameter", _NUMBER, Unit.LENGTH, 0.0, 2000.0, default=0.0),
    Field("max_rpm", _NUMBER, Unit.RPM, 0.0, 50000.0, default=0.0),
    Field("quill_diameter", _NUMBER, Unit.LENGTH, 0.0, 500.0, default=0.0),
    Field("centre_point", _NUMBER, Unit.DEGREES, 10.0, 170.0, default=60.0),
    Field("centre_at", _NUMBER, Unit.LENGTH, -2000.0, 2000.0, default=0.0),
)
TOOLING = (Field("kind", _CHOICE, choices=("single", "gang", "turret"), default="single"),)
CHECKS = (Field("silenced", Kind.WORDS, default=""),)  # of the part, by their ids
OUTPUT = (
    Field("at", _TEXT),
    Field("safe", _CHOICE, choices=(True, False, "keep")),
    Field("refresh_ms", _NUMBER, Unit.MILLISECONDS, 0.05, 10.0, default=0.0),
)
INPUT = (
    Field("at", _TEXT),
    Field("active", _CHOICE, choices=("high", "low"), default="high"),
)
M_CODE = (
    Field("output", _TEXT),
    Field("on", _FLAG),
    Field("enabled", _FLAG, default=True),
)
M_IGNORED = (Field("ignored", _CHOICE, choices=(True,)), Field("enabled", _FLAG, default=True))
"""An M code of another machine of which this one's owner says that it does nothing here."""


def machine_fields(drivers: Sequence[Driver]) -> tuple[Field, ...]:
    """[machine]: which backends there are is the drivers' word."""
    backends = tuple(driver.backend for driver in drivers if driver.backend)
    return (*_MACHINE[:3], Field("backend", _CHOICE, choices=backends, default="sim"), *_MACHINE[3:])


def plain_tables(drivers: Sequence[Driver]) -> tuple[tuple[str, tuple[Field, ...]], ...]:
    """Path and keys; axis, io and m_codes hold tables, some under names of the owner's choice.

    What turns the spindle is the drivers' word.
    """
    words = tuple(driver.spindle for driver in drivers if driver.spindle)
    return (
        ("limits", LIMITS),
        ("c_axis", C_OPTION),
        ("spindle", (*_SPINDLE, Field("driver", _CHOICE, choices=words, default="sim"))),
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
        Field("open_s", _NUMBER, Unit.SECONDS, 0.0, 10.0, default=0.0),
        Field("close_s", _NUMBER, Unit.SECONDS, 0.0, 10.0, default=0.0),
    ),
}
MAY_BE_MISSING = ("limits", "collet", "clamping", "tooling", "checks", "c_axis", "interlocks", "m_codes")

# M codes with a meaning of their own in the machine's language; the machine file cannot assign them.
FIXED_M_CODES = {
    "omniturn": frozenset((0, 1, 2, 3, 4, 5, 8, 9, 12, 13, 19, 30, 31, 89, *range(91, 100))),
    "sinumerik": frozenset((0, 1, 2, 3, 4, 5, 7, 8, 9, 17, 19, 30, 70, 98, 99)),
    "klartext": frozenset((0, 1, 2, 3, 4, 5, 8, 9, 13, 14, 19, 30, 31, 89, *range(91, 100))),
}
