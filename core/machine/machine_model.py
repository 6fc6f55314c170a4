"""The machine as its file describes it: frozen, in mm, seconds, degrees; X a radius."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import inf

from core.machine.hardware_model import Hardware
from core.machine.mill_kinematics import KinematicsModel
from core.machine.signal_table import LAMPS

_ROUNDING = 1e-6  # mm, degrees: the step of the control is coarser


@dataclass(frozen=True, slots=True)
class Axis:
    """One axis. Lengths mm and mm/s; for a rotary axis degrees and degrees/s."""

    name: str
    travel: tuple[float, float] | None  # from home; None: endless
    vmax: float
    amax: float
    count: float  # encoder and command step
    following_window: float
    following_time: float
    in_position: float
    absolute: bool  # knows its position at power-up: no homing needed
    home_order: int = 0
    home_speed: float = 0.0
    rotary: bool = False
    fixed_points: tuple[float, ...] = ()  # from home, X a radius: where G75 goes; of a mill M92's zero
    still_window: float = 0.2  # how far it may be off where it rests
    still_time: float = 0.2  # s from the end of a motion until that counts, and for which it must be off

    @property
    def reach(self) -> tuple[float, float]:
        """The travel and a rounding more: a word on the limit itself must not fail by an inch in binary."""
        low, high = self.travel or (-inf, inf)
        return low - _ROUNDING, high + _ROUNDING

    def following_limit(self, speed: float) -> float:
        """How far it may be off its setpoint at a commanded speed: as at rest, and what a drive trails."""
        share = min(abs(speed) / self.vmax, 1.0)
        return self.still_window + (self.following_window - self.still_window) * share


@dataclass(frozen=True, slots=True)
class SpindleModel:
    """The main spindle, rpm, rpm/s and W."""

    rpm_min: float
    rpm_max: float
    accel: float
    decel: float
    at_speed: float  # fraction of the command
    at_speed_time: float
    timeout: float
    stop_below: float
    encoder_ppr: int
    controlled: bool = True  # false: one speed, rpm_max, and no S
    oriented: bool = False  # its drive stops it at an angle, to which it turns at
    orient_rpm: float = 60.0
    power: float = 0.0  # at the highest speed; 0: not stated


@dataclass(frozen=True, slots=True)
class OutputModel:
    """One output: ``safe`` is what E-stop makes of it, None keeps."""

    name: str
    safe: bool | None
    terminal: str = ""


@dataclass(frozen=True, slots=True)
class InputModel:
    """One input: the names by which a program or interlock asks for it."""

    name: str
    terminal: str
    active_low: bool = False


@dataclass(frozen=True, slots=True)
class Timing:
    """Times of the control itself, seconds."""

    commit: float
    lookahead: float
    low_water: float
    lease: float
    setpoint: float  # interval in which a corner may change a velocity by amax * interval
    collet_open: float
    collet_close: float


@dataclass(frozen=True, slots=True)
class Interlocks:
    """Omniturn section 10 and the two-hand start."""

    spindle_with_collet_open: bool
    unclamp_while_turning: bool
    two_hand_start: bool
    guard_stops: bool = False  # the input ``guard``, off while open, holds the cycle and stops the spindle


@dataclass(frozen=True, slots=True)
class ClampingModel:
    """Chuck or collet, mm and rpm; 0: not said. ``stick_out`` is from its front to part zero.

    A tailstock has a quill; the tip of its centre, ``centre_point`` degrees, stands at Z ``centre_at``.
    """

    diameter: float = 0.0
    stick_out: float = 0.0
    jaws: float = 0.0  # how far they stand before the body
    jaw_diameter: float = 0.0
    max_rpm: float = 0.0
    quill_diameter: float = 0.0
    centre_point: float = 60.0
    centre_at: float = 0.0


@dataclass(frozen=True, slots=True)
class Machine:
    """The whole machine. ``axes``: slides first, then rotary axes; on a lathe X, Z, C."""

    name: str
    backend: str
    axes: tuple[Axis, ...]
    c_enabled: bool
    c_feedback: bool
    spindle: SpindleModel
    timing: Timing
    interlocks: Interlocks
    max_feed: float  # mm/s, what an F word may ask for
    manual_rapid: float  # mm/s
    resolution: float  # mm of radius
    outputs: Mapping[str, OutputModel]
    inputs: Mapping[str, InputModel]
    m_codes: Mapping[int, tuple[str, bool]]  # M code → output, state
    m_disabled: frozenset[int] = frozenset()  # defined with enabled = false
    m_ignored: frozenset[int] = frozenset()  # of other machines: they do nothing on this one
    absent: frozenset[str] = frozenset()  # outputs that it has not: a collet closed by hand
    source: str = ""  # the file it came from
    clearance: float = 0.0  # mm, how far a slide may run on after the last renewal of a jog
    corner_tolerance: float = 0.0  # mm by which joints of short chords may be moved; 0: by a count alone
    inch: bool = True  # what its builder counts in
    clamping: ClampingModel = field(default_factory=ClampingModel)
    tooling: str = "single"  # "gang": all tools ride one slide; "single": one at a time
    silenced: tuple[str, ...] = ()  # checks of the part that count for nothing on this machine
    kind: str = "lathe"  # or "mill"
    language: str = "omniturn"  # in which MDI is typed: omniturn, sinumerik or klartext
    control: str = "840d"  # which SINUMERIK its programs were written for
    third_axis: str = "C"  # what SINUMERIK programs, positions and keys call C
    c_modulo: bool = True  # C counts 0..<360 where a language asks; else its travel is -360..+360
    c_own_drive: bool = False  # C is no second use of the spindle
    c_linear: bool = False  # the third axis is a slide: mm where C has degrees
    hardware: Hardware = field(default_factory=Hardware)  # what it is wired to
    kinematics: KinematicsModel | None = None  # of a mill with rotary axes
    text: str = field(default="", compare=False, repr=False)  # the file as it was read

    @property
    def live_output(self) -> str:
        """The output that turns the live tool; empty without one."""
        return min((name for name in self.outputs if name.startswith("live")), default="")

    @property
    def spindle_is_c(self) -> bool:
        """Whether C is a second use of the spindle, so that it cannot be positioned while that turns."""
        return self.kind == "lathe" and not self.c_own_drive

    def shown(self, name: str) -> str:
        """What the operator calls an axis: C of a lathe by the name that its builder has given it."""
        return self.third_axis if self.kind == "lathe" and name == "C" else name

    @property
    def table_turns(self) -> bool:
        """Whether a mill's rotary axes turn its table, all or some; False: they turn its head alone."""
        chain = self.kinematics.chain if self.kinematics is not None else ()
        return not chain or any(axis.table for axis in chain)

    @property
    def lamps(self) -> tuple[str, ...]:
        """Its outputs that are lamps of the signal tower, which the control lights by itself."""
        return tuple(name for name in LAMPS if name in self.outputs)

    def axis(self, name: str) -> Axis:
        """The axis of this name. Raises KeyError where the machine has none."""
        for axis in self.axes:
            if axis.name == name:
                return axis
        raise KeyError(name)
