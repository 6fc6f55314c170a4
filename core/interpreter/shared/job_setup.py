"""What the interpreter must be told besides the program: offsets, limits, switches, inputs."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from core.geometry.rotary_axes import DatumPreset, Kinematics
    from core.interpreter.shared.checkpoint import Begin


@dataclass(frozen=True, slots=True)
class ToolOffset:
    """Machine position at which the tip stands on part zero; mm, X a radius."""

    x: float = 0.0
    z: float = 0.0
    nose_radius: float = 0.0
    quadrant: int = 0  # where the tip lies as seen from the nose centre, 0…9
    name: str = ""


@dataclass(frozen=True, slots=True)
class MillTool:
    """A row of a mill's tool table: L, R, R2 and what they are off by, mm; degrees, minutes (0: none)."""

    length: float = 0.0
    radius: float = 0.0
    corner: float = 0.0
    dl: float = 0.0
    dr: float = 0.0
    dr2: float = 0.0
    teeth: int = 0
    point: float = 0.0  # T-ANGLE
    life: float = 0.0  # TIME2


@dataclass(frozen=True, slots=True)
class SecondaryOffset:
    """D offset as stored; mm, X a radius, R the nose radius."""

    x: float = 0.0
    z: float = 0.0
    r: float = 0.0


@dataclass(frozen=True, slots=True)
class ZeroOffset:
    """A settable offset, G54 to G59: machine position of the program's zero; mm, X a radius, degrees."""

    x: float = 0.0
    z: float = 0.0
    c: float = 0.0


@dataclass(frozen=True, slots=True)
class ControlLimits:
    """What words may ask for; from the machine file."""

    max_feed: float = 300 * 25.4 / 60  # mm/s
    max_rpm: float = 3500.0
    resolution: float = 0.00005 * 25.4  # mm, radius
    slide_accel: float = 120 * 25.4  # mm/s², Z: how much run-up a thread needs
    unclamp_while_turning: bool = True
    start_with_collet_open: bool = False
    m_outputs: Mapping[int, tuple[str, bool]] = field(default_factory=dict)  # M code → output, state
    m_disabled: frozenset[int] = frozenset()  # M codes that the machine file defines and does not switch on
    m_ignored: frozenset[int] = frozenset()  # M codes of which it says that they do nothing on this machine
    c_enabled: bool = True  # the spindle can be positioned
    c_feedback: bool = False  # its drive tells when it has arrived
    c_max_rpm: float = 200.0
    c_accel: float = 3600.0  # degrees/s²
    c_step: float = 0.02  # degrees
    c_modulo: bool = True  # SINUMERIK counts C 0..<360, else -360..+360
    c_linear: bool = False  # the third axis is a slide: mm where C has degrees
    c_travel: tuple[float, float] | None = None  # of such a slide, mm of the machine
    spindle_is_c: bool = True  # C is a second use of the spindle
    live_output: str = ""  # the output that turns the live tool, as spindle 2 of SINUMERIK
    third_axis: str = "C"  # what SINUMERIK programs call C on this machine
    control: str = "840d"  # whose words SINUMERIK programs may hold: 802d, 808d, 828d or 840d
    spindle_controlled: bool = True  # S is obeyed, and the control knows the speed
    spindle_oriented: bool = False  # its drive stops it at an angle
    fixed_points: Mapping[str, tuple[float, ...]] = field(default_factory=dict)  # of slides: mm, X a radius
    speeds: tuple[float, float, float] = (127.0, 127.0, 1200.0)  # of X, Z and C at most: mm/s, degrees/s


def _no_inputs(_terminal: str) -> bool:
    return False


@dataclass(frozen=True, slots=True)
class Setup:
    """One set of circumstances for one pass through a program.

    ``start`` is the machine position of all axes (on a lathe x, z, c) before the first block; ``metric`` and
    ``last_rapid`` what the job before has left, or power-up; ``inputs`` answers for a terminal such as
    ``"TB2-5"`` or a PLC input ``"10"``. ``begin`` is there where a pass does not begin with the first line
    of a program.
    """

    tools: Mapping[int, ToolOffset] = field(default_factory=dict)  # by T; edges by ``tool_edges.edge_key``
    secondary: Mapping[int, SecondaryOffset] = field(default_factory=dict)
    zero: Mapping[int, ZeroOffset] = field(default_factory=dict)  # 54 to 59; one that is missing is all 0
    r: Mapping[int, float] = field(default_factory=dict)  # of SINUMERIK, as the operator set them
    limits: ControlLimits = field(default_factory=ControlLimits)
    block_delete: bool = False
    strict: bool = False
    start: tuple[float, ...] = (0.0, 0.0, 0.0)
    metric: bool = False
    last_rapid: float = 100 * 25.4 / 60  # mm/s
    inputs: Callable[[str], bool] = _no_inputs
    kinematics: Kinematics | None = None  # of a mill, with the preset that is in force
    tool_names: Mapping[str, int] = field(default_factory=dict)  # of the tool table, in capitals
    mill_tools: Mapping[int, MillTool] = field(default_factory=dict)  # rows of the tool table
    presets: Mapping[int, DatumPreset] = field(default_factory=dict)  # by number; 0: of the machine file
    preset: int = 0  # the one in force
    begin: Begin | None = None
