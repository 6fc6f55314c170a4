"""Modal state of the control, which each line inherits from earlier lines."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from core.geometry.surface_speed import find_surface_rpm
from core.interpreter.shared import units

if TYPE_CHECKING:
    from core.geometry.virtual_mill import FacePlane, SidePlane


class VirtualMill(NamedTuple):
    """The frame of the virtual mill, and the current position in this frame, in mm.

    On the side of the part, Z is a radius. ``polar_angle_rad`` is the polar angle of the position in
    radians, continuous over several revolutions. ``is_newly_active`` is True until the first move or F; H
    is allowed only until then.
    """

    frame: FacePlane | SidePlane
    x: float
    y: float
    z: float
    polar_angle_rad: float = 0.0
    is_newly_active: bool = True


class ModalState(NamedTuple):
    """The modal state between two blocks, with lengths in mm, X as a radius, and speeds in mm/s or rpm.

    ``_replace`` creates a new state. Blocks share one state until a word changes it, so that each block
    stores only a reference.
    """

    absolute: bool | None = None  # True under G90, False under G91; None until the program selects one
    per_rev: bool = False  # G95
    rapid: bool = False  # the G00 flag
    metric: bool = False  # G71
    diameter: bool = False  # G72
    css: bool = False  # G96
    compensation_code: int = 40  # 40, 41 or 42
    coarse: int = 0  # 0 G36, 1 G35, 2 G35F2
    feed: float | None = None  # F in force: mm/s under G94, mm/rev under G95
    last_cutting_feed: float | None = None  # feed that G01 restores
    is_cutting_feed_per_rev: bool = False
    rapid_rate: float = 100 * 25.4 / 60  # mm/s
    tool: int = 0  # T, 0 none
    secondary: int = 0  # D, 0 none
    spindle: int = 0  # +1 M03, 0 stopped, -1 M04
    rpm: float = 0.0  # S under G97, unsigned
    surface_speed: float = 0.0  # S under G96, mm/s
    min_css_rpm: float = 0.0  # G76, rpm
    max_css_rpm: float | None = None  # G77, rpm
    coolant: bool = False
    collet_closed: bool = True
    outputs: frozenset[str] = frozenset()  # M functions of the machine file that are on
    shift_x: float = 0.0  # G10 in force since the last T
    shift_z: float = 0.0
    pending_shift_x: float = 0.0  # sum of G10, active from the next T
    pending_shift_z: float = 0.0
    tool_offset_x: float = 0.0  # offset of the active tool, machine mm
    tool_offset_z: float = 0.0
    preset_x: float = 0.0  # G92
    preset_z: float = 0.0
    secondary_offset_x: float = 0.0  # offset D in force, mm
    secondary_offset_z: float = 0.0
    comment: str = ""
    c_locked: bool = False  # M19 or M89: C is an axis, and a C word turns it
    # oriented angle of the spindle from its index, degrees; None if the spindle is not oriented
    oriented: float | None = None
    c_rpm: float | None = None  # S in a line with M19 or a C word, unsigned
    offset_c: float = 0.0  # machine C minus program C, whole revolutions; M19 starts again at 0
    # SINUMERIK: active D, 0 without a tool offset; ``tool`` is then the row of the cutting edge
    edge: int | None = None
    settable: int = 0  # SINUMERIK: 54 to 59, 0 under G500
    zero_offset_x: float = 0.0  # settable offset, mm; the offset of C is in offset_c
    zero_offset_z: float = 0.0
    frame_shift_x: float = 0.0  # SINUMERIK: TRANS and ATRANS, mm
    frame_shift_z: float = 0.0
    is_c_linear: bool = False  # the third axis is in mm
    is_c_axis_modulo: bool = False  # C is shown from 0 to below 360 in this program
    mill: VirtualMill | None = None  # between (~PLXC) or (~PLZC) and (END)

    def format_length(self, length_mm: float) -> str:
        """Return a length (mm) as text in the active unit of the program."""
        return units.format_length(length_mm, is_metric=self.metric)

    def format_feed(self, value: float, *, is_per_rev: bool) -> str:
        """Return a feed (mm/s or mm/rev) as text in the active unit of the program."""
        return units.format_feed(value, is_per_rev=is_per_rev, is_metric=self.metric)

    @property
    def active_surface_speed(self) -> float | None:
        """Return the active constant surface speed in mm/s, or None under G97."""
        return self.surface_speed if self.css else None

    def compute_surface_rpm(self, x: float, max_rpm: float) -> float:
        """Return the signed spindle speed in rpm at radius ``x`` (mm) under constant surface speed.

        The speed is within the programmed limits and does not exceed ``max_rpm``, the limit of the spindle
        in rpm.
        """
        if self.max_css_rpm is not None:
            max_rpm = min(max_rpm, self.max_css_rpm)
        return self.spindle * find_surface_rpm(self.surface_speed, x, self.min_css_rpm, max_rpm)

    @property
    def offset_x(self) -> float:
        """Return machine X minus program X as a radius, in mm."""
        return self.drawing_zero_x + self.shift_x + self.preset_x + self.frame_shift_x

    @property
    def offset_z(self) -> float:
        """Return machine Z minus program Z in mm."""
        return self.drawing_zero_z + self.shift_z + self.preset_z + self.frame_shift_z

    @property
    def drawing_zero_x(self) -> float:
        """Return machine X of the drawing's zero point in mm: tool offset plus settable offset."""
        return self.zero_offset_x if self.edge == 0 else self.tool_offset_x + self.zero_offset_x

    @property
    def drawing_zero_z(self) -> float:
        """Return machine Z of the drawing's zero point in mm: tool offset plus settable offset."""
        return self.zero_offset_z if self.edge == 0 else self.tool_offset_z + self.zero_offset_z
