"""Immutable model of the machine that a machine file describes.

Values are in mm, seconds and degrees, with X as a radius.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass, field
from math import inf

from core.key_declaration import FileUnit, KeyRange, Pair, declare_key, make_key_table
from core.machine.hardware_model import LAMP_NAMES, Hardware
from core.machine.mill_kinematics import KinematicsModel

_ROUNDING = 1e-6  # mm or degrees; less than the resolution of the control


@dataclass(frozen=True, slots=True)
class Axis:
    """One axis, in mm and mm/s, or in degrees and degrees/s for a rotary axis."""

    name: str
    travel: tuple[float, float] | None  # from home; None: no limits
    max_speed: float
    max_acceleration: float
    count_size: float  # encoder and command step
    following_error_window: float
    following_error_time_s: float
    in_position_tolerance: float
    is_position_absolute: bool  # the position is known at power-up, so no homing is needed
    home_order: int = 0
    home_speed: float = 0.0
    is_rotary: bool = False
    # positions from home, X as a radius: targets of G75, or the zero of M92 on a mill
    fixed_points: tuple[float, ...] = ()
    standstill_tolerance: float = 0.2  # permitted position error at rest
    # s after a motion before ``standstill_tolerance`` applies, and s for which it must be exceeded
    standstill_time_s: float = 0.2

    @property
    def travel_with_margin(self) -> tuple[float, float]:
        """Return the travel plus a rounding margin, so that a position exactly at the limit is accepted."""
        low, high = self.travel or (-inf, inf)
        return low - _ROUNDING, high + _ROUNDING

    def compute_max_following_error(self, speed: float) -> float:
        """Return the permitted following error at a commanded speed.

        The limit increases linearly from the standstill tolerance to ``following_error_window`` at
        ``max_speed``.
        """
        share = min(abs(speed) / self.max_speed, 1.0)
        return self.standstill_tolerance + (self.following_error_window - self.standstill_tolerance) * share


@make_key_table
class SpindleModel:
    """The main spindle, with values in rpm, rpm/s and W."""

    _: KW_ONLY
    rpm: Pair = declare_key(KeyRange(1.0, 20000.0, FileUnit.RPM), meaning="Lowest and highest speed.")
    acceleration_rpm_s: float = declare_key(
        KeyRange(10.0, 50000.0, FileUnit.RPM_PER_SECOND),
        name="accel_rpm_s",
        meaning="Acceleration of the spindle.",
    )
    deceleration_rpm_s: float = declare_key(
        KeyRange(10.0, 50000.0, FileUnit.RPM_PER_SECOND),
        name="decel_rpm_s",
        is_derived=True,
        meaning="Deceleration of the spindle. Default: `accel_rpm_s`.",
    )
    at_speed_tolerance: float = declare_key(
        KeyRange(0.005, 0.25, FileUnit.PERCENT),
        name="at_speed_pct",
        meaning="Largest difference between the measured and the commanded speed, in percent of the "
        "commanded speed, at which the spindle is at speed.",
    )
    at_speed_time_s: float = declare_key(
        KeyRange(0.05, 5.0, FileUnit.SECONDS),
        name="at_speed_s",
        meaning="Time for which the speed must be within `at_speed_pct` before the spindle is at speed.",
    )
    timeout_s: float = declare_key(
        KeyRange(0.5, 60.0, FileUnit.SECONDS),
        name="timeout_s",
        meaning="Time within which the spindle must reach its speed or stop. If it does not, an alarm "
        "stops the cycle. It must be longer than the time to accelerate to the highest speed.",
    )
    stop_below: float = declare_key(
        KeyRange(0.5, 50.0, FileUnit.RPM),
        meaning="Speed below which the spindle counts as stopped. It must be below the lowest speed.",
    )
    encoder_ppr: int = declare_key(
        KeyRange(0, 100000),
        meaning="Lines per revolution of the spindle encoder, four counts each. 0: no encoder. For a "
        "CANopen spindle drive, `counts_per_rev` of its node applies instead.",
    )
    controlled: bool = declare_key(
        default=True,
        meaning="false: the spindle has one fixed speed, the highest of `rpm`. SINUMERIK programs with S, "
        "G96 or G4 S are then rejected.",
    )
    oriented: bool = declare_key(
        default=False,
        meaning="true: the drive can stop the spindle at an angle. false: SPOS, M19 and cycle 204 are "
        "rejected, and cycle 202 stops so that the operator can turn the spindle.",
    )
    orient_rpm: float = declare_key(
        KeyRange(1.0, 1000.0, FileUnit.RPM),
        default=60.0,
        meaning="Speed at which the oriented spindle turns to its angle. The proof uses this value, and a "
        "faster spindle raises alarm 203.",
    )
    power_w: float = declare_key(
        KeyRange(50.0, 100000.0, FileUnit.KILOWATTS),
        name="power_kw",
        default=0.0,
        meaning="Power of the spindle drive at the highest speed. Shapes uses it to suggest the depth of "
        "cut. Default: 1.5 kW is assumed.",
    )

    @property
    def min_rpm(self) -> float:
        """Return the lowest speed in rpm."""
        return self.rpm[0]

    @property
    def max_rpm(self) -> float:
        """Return the highest speed in rpm.

        A spindle that is not ``controlled`` runs only at this speed.
        """
        return self.rpm[1]


@make_key_table
class OutputModel:
    """An output, with its terminal and its safe state."""

    name: str
    terminal: str = declare_key(
        name="at",
        meaning='Terminal of the output, written as the backend requires. "none": the machine does not '
        "have this output.",
    )
    configured_safe_state: bool | str = declare_key(
        name="safe",
        choices=(True, False, "keep"),
        meaning="State of the output after an E-stop and, where the backend supports it, if TurnDesk stops "
        'responding. "keep" leaves the output unchanged.',
    )
    refresh_timeout_s: float = declare_key(
        KeyRange(0.05, 10.0, FileUnit.MILLISECONDS),
        name="refresh_ms",
        default=0.0,
        meaning="Time after which the output switches off if TurnDesk does not refresh it; needs `safe = "
        "false`. Default: no refresh is necessary.",
    )

    @property
    def safe_state(self) -> bool | None:
        """Return the state of the output after an E-stop, or None if an E-stop does not change it."""
        return None if self.configured_safe_state == "keep" else self.configured_safe_state is True


@make_key_table
class InputModel:
    """An input, with the name that programs and interlocks use."""

    name: str
    terminal: str = declare_key(
        name="at",
        meaning="Terminal of the input, written as the backend requires, or `pendant.…` for a button of "
        "the pendant.",
    )
    active: str = declare_key(
        default="high",
        choices=("high", "low"),
        meaning='"low": the input is on when it has no voltage, so a broken wire reads as on.',
    )

    @property
    def is_active_low(self) -> bool:
        """Return whether the input is on when it has no voltage."""
        return self.active == "low"


@make_key_table
class Timing:
    """Times of the control in seconds, such as its look-ahead time and the duration of a setpoint."""

    commit_time_s: float = declare_key(
        KeyRange(0.001, 0.2, FileUnit.MILLISECONDS),
        name="commit_ms",
        meaning="Remaining time before its execution below which a queued setpoint can no longer be "
        "changed. A feed hold and the end of a jog take effect after this time.",
    )
    lookahead_time_s: float = declare_key(
        KeyRange(0.1, 10.0, FileUnit.MILLISECONDS),
        name="lookahead_ms",
        meaning="Time for which setpoints are queued ahead of the motion.",
    )
    low_water_time_s: float = declare_key(
        KeyRange(0.005, 2.0, FileUnit.MILLISECONDS),
        name="low_water_ms",
        meaning="If less than this time is queued during a cycle, TurnDesk starts a feed hold.",
    )
    motion_lease_s: float = declare_key(
        KeyRange(0.05, 0.5, FileUnit.MILLISECONDS),
        name="lease_ms",
        meaning="Time after which a jog stops if it is not renewed.",
    )
    setpoint_duration_s: float = declare_key(
        KeyRange(0.0001, 0.02, FileUnit.MILLISECONDS),
        name="setpoint_ms",
        default=0.001,
        meaning="Duration of a setpoint. At a corner the velocity of an axis may change by `amax` × this "
        "time.",
    )


@make_key_table
class Interlocks:
    """The interlocks of section 10 of the OmniTurn manual, and the two-hand start."""

    spindle_with_collet_open: bool = declare_key(
        default=False,
        meaning="true: the spindle may turn with the collet open. false needs the input `collet_closed`.",
    )
    unclamp_while_turning: bool = declare_key(
        default=True,
        meaning="true: the collet may open while the spindle turns, as bar work needs. false: the collet "
        "opens only when the spindle has stopped.",
    )
    two_hand_start: bool = declare_key(
        default=True,
        meaning="true: a cycle starts only by the input `start`, the output of the two-hand relay, or by "
        "both palm buttons of the operator station on the screen. false: Cycle Start on the screen is "
        "enough. The simulated machine always accepts Cycle Start on the screen.",
    )
    guard_stops: bool = declare_key(
        default=False,
        meaning="true: while the input `guard` is off, the cycle is in feed hold, the spindle stops, and "
        "no cycle starts.",
    )


@make_key_table
class ClampingModel:
    """The chuck or collet and the tailstock, in mm and rpm; a value of 0 means not specified.

    ``stick_out`` is the distance from the front of the chuck or collet to part zero. ``centre_at`` is the Z
    position of the tip of the tailstock center, and ``centre_point`` is its included angle in degrees.
    """

    diameter: float = declare_key(
        KeyRange(0.0, 2000.0, FileUnit.LENGTH),
        default=0.0,
        meaning="Diameter of the chuck or collet. 0: not specified, and not checked.",
    )
    stick_out: float = declare_key(
        KeyRange(0.0, 2000.0, FileUnit.LENGTH),
        default=0.0,
        meaning="Distance from the front of the jaws or collet to part zero. 0: not specified, and not "
        "checked.",
    )
    jaws: float = declare_key(
        KeyRange(0.0, 500.0, FileUnit.LENGTH),
        default=0.0,
        meaning="Length by which the jaws or the collet nose protrude from the body.",
    )
    jaw_diameter: float = declare_key(
        KeyRange(0.0, 2000.0, FileUnit.LENGTH),
        default=0.0,
        meaning="Outside diameter of the jaws. 0: the same as `diameter`.",
    )
    max_rpm: float = declare_key(
        KeyRange(0.0, 50000.0, FileUnit.RPM),
        default=0.0,
        meaning="Highest permitted speed of the chuck. 0: not specified, and not checked.",
    )
    quill_diameter: float = declare_key(
        KeyRange(0.0, 500.0, FileUnit.LENGTH),
        default=0.0,
        meaning="Diameter of the tailstock quill. 0: no tailstock.",
    )
    centre_point: float = declare_key(
        KeyRange(10.0, 170.0, FileUnit.DEGREES),
        default=60.0,
        meaning="Included angle of the tailstock center.",
    )
    centre_at: float = declare_key(
        KeyRange(-2000.0, 2000.0, FileUnit.LENGTH),
        default=0.0,
        meaning="Z position of the tip of the tailstock center, measured from part zero.",
    )


@make_key_table
class LimitsModel:
    """The limits that apply to all axes, in mm and mm/s. The resolution of X is a radius."""

    max_feed: float = declare_key(
        KeyRange(0.1, 1000.0, FileUnit.FEED),
        is_derived=True,
        meaning="Highest feed that F may command, along the path. Default: `vmax` of the slowest linear "
        "axis.",
    )
    manual_rapid: float = declare_key(
        KeyRange(0.1, 500.0, FileUnit.FEED),
        is_derived=True,
        meaning="Rapid speed of a jog. Default: 100 in/min, or `vmax` of the slowest linear axis if that "
        "is lower.",
    )
    resolution: float = declare_key(
        KeyRange(1e-5, 0.02, FileUnit.LENGTH),
        is_derived=True,
        meaning="Smallest programmable distance (X: on the radius). Default: the largest `count` of the "
        "linear axes.",
    )
    clearance: float = declare_key(
        KeyRange(0.1, 100.0, FileUnit.LENGTH),
        default=31.75,
        meaning="Distance that an axis jogging at `vmax` may travel after the last renewal of the jog. "
        "TurnDesk checks `lease_ms` against this distance.",
    )
    corner_tolerance: float = declare_key(
        KeyRange(0.0, 0.1, FileUnit.LENGTH),
        default=0.0,
        meaning="Largest deviation of the tool tip where a curve was split into short chords. With 0, each "
        "joint moves by at most one `count` per axis.",
    )


@make_key_table
class ColletModel:
    """The opening and closing times of the collet in seconds."""

    _: KW_ONLY
    open_time_s: float = declare_key(
        KeyRange(0.01, 10.0, FileUnit.SECONDS),
        name="open_s",
        default=0.5,
        meaning="Time that the collet takes to open. The proof uses it, and so does a cycle if no input "
        "`collet_closed` is wired.",
    )
    close_time_s: float = declare_key(
        KeyRange(0.01, 10.0, FileUnit.SECONDS),
        name="close_s",
        is_derived=True,
        meaning="Time that the collet takes to close, used like `open_s`. Default: 0.5 s if the input "
        "`collet_closed` is wired; otherwise the key is required.",
    )


@dataclass(frozen=True, slots=True)
class Machine:
    """The complete model of the machine.

    ``axes`` contains the linear axes followed by the rotary axes. On a lathe, the order is X, Z, C.
    """

    name: str
    backend: str
    axes: tuple[Axis, ...]
    is_c_enabled: bool
    has_c_feedback: bool
    spindle: SpindleModel
    timing: Timing
    interlocks: Interlocks
    limits: LimitsModel
    collet: ColletModel
    outputs: Mapping[str, OutputModel]
    inputs: Mapping[str, InputModel]
    m_code_outputs: Mapping[int, tuple[str, bool]]  # M code → output, state
    disabled_m_codes: frozenset[int] = frozenset()  # defined with enabled = false
    ignored_m_codes: frozenset[int] = frozenset()  # codes of other machines, which have no effect on this one
    missing_outputs: frozenset[str] = (
        frozenset()
    )  # outputs that the machine does not have, such as a manual collet
    source: str = ""  # name of the machine file
    is_inch: bool = True  # units of the machine file
    clamping: ClampingModel = field(default_factory=ClampingModel)
    tooling_kind: str = "single"  # "gang": all tools are on one plate; "single": one tool at a time
    silenced_checks: tuple[str, ...] = ()  # checks of the part whose findings are only notes on this machine
    kind: str = "lathe"  # or "mill"
    mdi_language: str = "omniturn"  # language of MDI: omniturn, sinumerik or klartext
    control_model: str = "840d"  # SINUMERIK control for which the programs were written
    third_axis_name: str = "C"  # name of C in SINUMERIK programs, on the position display and on keys
    is_c_axis_modulo: bool = (
        True  # C counts from 0 to below 360 degrees; otherwise its travel is -360 to +360
    )
    has_separate_c_drive: bool = False  # C has its own drive and is not the spindle
    is_third_axis_linear: bool = False  # the third axis is linear, in mm instead of degrees
    hardware: Hardware = field(default_factory=Hardware)  # wiring of the machine
    kinematics: KinematicsModel | None = None  # kinematics of a mill with rotary axes
    text: str = field(default="", compare=False, repr=False)  # text of the machine file

    @property
    def live_tool_output(self) -> str:
        """Return the output that turns on the live tool, or an empty string if no output does."""
        return min((name for name in self.outputs if name.startswith("live")), default="")

    @property
    def is_spindle_c_axis(self) -> bool:
        """Return whether the spindle is also the C axis, so that C cannot move while the spindle turns."""
        return self.kind == "lathe" and not self.has_separate_c_drive

    def get_displayed_axis_name(self, name: str) -> str:
        """Return the name of an axis as displayed to the operator.

        The C axis of a lathe may have another name.
        """
        return self.third_axis_name if self.kind == "lathe" and name == "C" else name

    @property
    def has_rotary_table(self) -> bool:
        """Return whether at least one rotary axis of a mill turns its table, instead of the head."""
        chain = self.kinematics.chain if self.kinematics is not None else ()
        return not chain or any(axis.is_table for axis in chain)

    @property
    def lamp_outputs(self) -> tuple[str, ...]:
        """Return the outputs that are lamps of the signal tower, which the control switches automatically."""
        return tuple(name for name in LAMP_NAMES if name in self.outputs)

    def find_axis(self, name: str) -> Axis:
        """Return the axis with this name. Raises KeyError if the machine does not have this axis."""
        for axis in self.axes:
            if axis.name == name:
                return axis
        raise KeyError(name)
