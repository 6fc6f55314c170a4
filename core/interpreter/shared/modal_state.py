"""The modal state of the control: everything that a line inherits from the lines before it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from core.geometry.surface_speed import surface_rpm
from core.interpreter.shared import units

if TYPE_CHECKING:
    from core.geometry.virtual_mill import Face, Side


class Mill(NamedTuple):
    """The frame and the point reached in it; mm, Z a radius on the side of the part. ``theta`` (radians) is
    the polar angle of the point, counted on; ``fresh`` holds until a move or an F: H may still be set."""

    frame: Face | Side
    x: float
    y: float
    z: float
    theta: float = 0.0
    fresh: bool = True


class Modal(NamedTuple):
    """State between two blocks. Lengths in mm, X as a radius, speeds in mm/s or rpm; see omniturn section 3.

    A new state is made with ``_replace``; blocks share a state until a word changes it, so that
    carrying a checkpoint in every block costs one reference.
    """

    absolute: bool | None = None  # G90 True, G91 False; None until the program says
    per_rev: bool = False  # G95
    rapid: bool = False  # the G00 flag
    metric: bool = False  # G71
    diameter: bool = False  # G72
    css: bool = False  # G96
    nose_comp: int = 40  # 40, 41 or 42
    coarse: int = 0  # 0 G36, 1 G35, 2 G35F2
    feed: float | None = None  # F in force: mm/s under G94, mm/rev under G95
    cut_feed: float | None = None  # what G01 goes back to
    cut_per_rev: bool = False
    rapid_rate: float = 100 * 25.4 / 60  # mm/s
    tool: int = 0  # T, 0 none
    secondary: int = 0  # D, 0 none
    spindle: int = 0  # +1 M03, 0 stopped, -1 M04
    rpm: float = 0.0  # S under G97, unsigned
    surface_speed: float = 0.0  # S under G96, mm/s
    css_min: float = 0.0  # G76, rpm
    css_max: float | None = None  # G77, rpm
    coolant: bool = False
    collet_closed: bool = True
    outputs: frozenset[str] = frozenset()  # M functions of the machine file that are on
    shift_x: float = 0.0  # G10 in force since the last T
    shift_z: float = 0.0
    pending_shift_x: float = 0.0  # G10 summed up, in force at the next T
    pending_shift_z: float = 0.0
    tool_x: float = 0.0  # offset of the active tool, machine mm
    tool_z: float = 0.0
    preset_x: float = 0.0  # G92
    preset_z: float = 0.0
    secondary_x: float = 0.0  # offset D in force, mm
    secondary_z: float = 0.0
    comment: str = ""
    c_locked: bool = False  # M19 or M89: C is an axis, and a C word turns it
    oriented: float | None = None  # degrees from its index at which the spindle is held; None: it is not
    c_rpm: float | None = None  # S beside M19 or a C word, unsigned
    offset_c: float = 0.0  # machine C minus program C, whole turns: M19 begins to count again at 0
    edge: int | None = None  # SINUMERIK: D in force, 0 without a tool offset; ``tool`` is then the edge's row
    settable: int = 0  # SINUMERIK: 54 to 59, 0 under G500
    settable_x: float = 0.0  # of it, mm; those of C are in offset_c
    settable_z: float = 0.0
    zero_x: float = 0.0  # SINUMERIK: TRANS and ATRANS, mm
    zero_z: float = 0.0
    linear_c: bool = False  # the third axis counts mm
    wraps_c: bool = False  # C counts 0..<360 in this program: its display does too
    mill: Mill | None = None  # between (~PLXC) or (~PLZC) and (END)

    def length_text(self, mm: float) -> str:
        """A length as the program's reader knows it, in the unit in force."""
        return units.length(mm, metric=self.metric)

    def feed_text(self, value: float, *, per_rev: bool) -> str:
        """A feed, mm/s or mm/rev, as the program's reader knows it, in the unit in force."""
        return units.feed(value, per_rev=per_rev, metric=self.metric)

    @property
    def css_speed(self) -> float | None:
        """The constant surface speed in force, mm/s; None under G97."""
        return self.surface_speed if self.css else None

    def surface_rpm_at(self, x: float, highest: float) -> float:
        """Signed speed, rpm, at radius ``x`` (mm) under constant surface speed, within its limits.

        ``highest`` is the spindle's own.
        """
        if self.css_max is not None:
            highest = min(highest, self.css_max)
        return self.spindle * surface_rpm(self.surface_speed, x, self.css_min, highest)

    @property
    def offset_x(self) -> float:
        """Machine X minus program X, mm."""
        return self.base_x + self.shift_x + self.preset_x + self.zero_x

    @property
    def offset_z(self) -> float:
        """Machine Z minus program Z, mm."""
        return self.base_z + self.shift_z + self.preset_z + self.zero_z

    @property
    def base_x(self) -> float:
        """Machine X of the zero that is drawn from: tool offset and settable offset together, mm."""
        return self.settable_x if self.edge == 0 else self.tool_x + self.settable_x

    @property
    def base_z(self) -> float:
        """Machine Z of it."""
        return self.settable_z if self.edge == 0 else self.tool_z + self.settable_z
