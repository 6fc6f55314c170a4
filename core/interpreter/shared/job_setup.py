"""Input of the interpreter in addition to the program: offsets, limits, switches and inputs."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from core.geometry.rotary_axes import DatumPreset, Kinematics
    from core.interpreter.shared.checkpoint import PassStart


@dataclass(frozen=True, slots=True)
class ToolOffset:
    """The machine position at which the tip of a tool is at part zero, in mm with X as a radius."""

    x: float = 0.0
    z: float = 0.0
    nose_radius: float = 0.0
    quadrant: int = 0  # direction from the nose center to the tip, 0…9
    name: str = ""


@dataclass(frozen=True, slots=True)
class MillTool:
    """A row of a mill's tool table.

    Lengths, radii and their deltas are in mm, the point angle is in degrees, and the tool life is in
    minutes. A point angle or tool life of 0 means that it is not specified.
    """

    length: float = 0.0
    radius: float = 0.0
    corner_radius: float = 0.0
    delta_length: float = 0.0
    delta_radius: float = 0.0
    delta_corner_radius: float = 0.0
    tooth_count: int = 0
    point_angle_deg: float = 0.0  # T-ANGLE
    tool_life_minutes: float = 0.0  # TIME2


@dataclass(frozen=True, slots=True)
class SecondaryOffset:
    """A stored secondary offset (D) in mm with X as a radius, including the nose radius."""

    x: float = 0.0
    z: float = 0.0
    nose_radius: float = 0.0


@dataclass(frozen=True, slots=True)
class ZeroOffset:
    """A settable zero offset (G54 to G59).

    The offset is the machine position of program zero, in mm and degrees with X as a radius.
    """

    x: float = 0.0
    z: float = 0.0
    c: float = 0.0


@dataclass(frozen=True, slots=True)
class ControlLimits:
    """Limits and capabilities of the machine, as specified in the machine file."""

    max_feed_mm_s: float = 300 * 25.4 / 60  # mm/s
    max_rpm: float = 3500.0
    resolution_mm: float = 0.00005 * 25.4  # mm, radius
    z_acceleration_mm_s2: float = 120 * 25.4  # mm/s² of Z; determines the run-up of a thread
    can_unclamp_while_turning: bool = True
    can_start_with_collet_open: bool = False
    m_code_outputs: Mapping[int, tuple[str, bool]] = field(default_factory=dict)  # M code → output, state
    disabled_m_codes: frozenset[int] = (
        frozenset()
    )  # M codes that the machine file defines but does not enable
    ignored_m_codes: frozenset[int] = frozenset()  # M codes that the machine file ignores
    is_c_enabled: bool = True  # the spindle can be used as the C axis
    has_c_feedback: bool = False  # the drive reports that C is in position
    max_c_rpm: float = 200.0
    c_acceleration_deg_s2: float = 3600.0  # degrees/s²
    c_resolution_deg: float = 0.02  # degrees
    is_c_modulo: bool = True  # SINUMERIK shows C from 0 to below 360, otherwise from -360 to +360
    is_c_linear: bool = False  # the third axis is linear: mm instead of degrees
    c_travel_range: tuple[float, float] | None = None  # travel of the linear third axis, machine mm
    is_spindle_c_axis: bool = True  # the spindle is also the C axis
    live_tool_output: str = ""  # the output that runs the live tool, which is spindle 2 in SINUMERIK
    third_axis_name: str = "C"  # name of the third axis in SINUMERIK programs
    control_model: str = "840d"  # SINUMERIK control whose words are accepted: 802d, 808d, 828d or 840d
    is_spindle_controlled: bool = True  # the control commands the spindle speed
    can_orient_spindle: bool = False  # the spindle drive can stop at an angle
    # machine positions in mm, X as a radius
    fixed_points: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    # maximum speeds of X, Z and C in mm/s and degrees/s
    max_axis_speeds: tuple[float, float, float] = (127.0, 127.0, 1200.0)


def read_no_input(_terminal: str) -> bool:
    """Return False for every input terminal, for a pass that must not read live inputs."""
    return False


@dataclass(frozen=True, slots=True)
class InterpreterSetup:
    """Conditions of one pass through a program.

    - ``start`` is the machine position of all axes (x, z, c on a lathe) before the first block.
    - ``metric`` and ``last_rapid`` come from the previous job or from power-up.
    - ``inputs`` returns the state of a terminal such as ``"TB2-5"`` or of a PLC input such as ``"10"``.
    - ``begin`` is the start of the pass, or None if it starts at the first line.
    """

    tools: Mapping[int, ToolOffset] = field(
        default_factory=dict
    )  # by T; edges by ``tool_edges.make_edge_row_number``
    secondary: Mapping[int, SecondaryOffset] = field(default_factory=dict)
    zero: Mapping[int, ZeroOffset] = field(default_factory=dict)  # 54 to 59; missing offsets are 0
    r: Mapping[int, float] = field(default_factory=dict)  # R parameters of SINUMERIK, as set by the operator
    limits: ControlLimits = field(default_factory=ControlLimits)
    block_delete: bool = False
    strict: bool = False
    start: tuple[float, ...] = (0.0, 0.0, 0.0)
    metric: bool = False
    last_rapid: float = 100 * 25.4 / 60  # mm/s
    inputs: Callable[[str], bool] = read_no_input
    kinematics: Kinematics | None = None  # kinematics of a mill with the active preset
    # tool number by name from the tool table, in capitals
    tool_names: Mapping[str, int] = field(default_factory=dict)
    mill_tools: Mapping[int, MillTool] = field(default_factory=dict)  # rows of the tool table
    presets: Mapping[int, DatumPreset] = field(default_factory=dict)  # by number; 0 is from the machine file
    preset: int = 0  # number of the active preset
    begin: PassStart | None = None

    def make_stand_in(self) -> InterpreterSetup:
        """Return the setup without live inputs and without the state at which the pass starts."""
        return replace(self, inputs=read_no_input, begin=None)
