"""State that changes during a pass, and its conversion to a checkpoint.

The state has direct attributes for fast access.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple, TypeVar

from core.interpreter.shared.actions import Action, Dwell
from core.interpreter.shared.checkpoint import Checkpoint, PassStart
from core.interpreter.shared.diagnostic_log import DiagnosticLog
from core.interpreter.shared.elementary_blocks import Block, BlockKind, FloatArray
from core.interpreter.shared.job_setup import InterpreterSetup
from core.interpreter.shared.modal_state import ModalState
from core.interpreter.shared.units import MM_PER_INCH

if TYPE_CHECKING:
    from core.geometry.virtual_mill import PlaneMove


FloatOrArray = TypeVar("FloatOrArray", float, FloatArray)


class Corner(NamedTuple):
    """A chamfer (C) or rounding (R) between two consecutive straight moves, with its size in mm."""

    letter: str
    size_mm: float
    column: int


class CompensationSwitch(NamedTuple):
    """Marker between blocks at which G41, G42 or G40 switches nose compensation.

    ``secondary_x`` and ``secondary_z`` are the secondary offset in mm that the current position includes.
    """

    g_code: int
    line: int
    secondary_offset_x: float
    secondary_offset_z: float

    @property
    def name(self) -> str:
        """Return the code as text for messages, such as G41."""
        return f"G{self.g_code}"


StageItem = Block | CompensationSwitch


@dataclass(slots=True)
class ContourState:
    """State of a corner whose second move is still missing, and of the active nose compensation."""

    is_buffering: bool = False  # blocks are buffered, so each block must pass through the contour modifier
    pending_corner: Corner | None = None  # corner after the present move
    approach_line: int = 0  # line of a G41 or G42 that no approach has followed yet
    secondary_offset_line: int = 0  # last line with a D


HIGH_FEED_MM_PER_REV = 0.05 * MM_PER_INCH * (1 + 1e-9)
"""Feed in mm/rev above which F003 was probably a mistake for F.003."""


class State:
    """The position and the modal state of a pass, in mm with X as a radius.

    ``x`` and ``z`` are the current position. ``px`` and ``pz`` are the programmed position without the
    secondary offset. The other values are derived from ``modal``.
    """

    __slots__ = (
        "absolute",
        "blocks",
        "c",
        "coarse_start_point",
        "contour",
        "cut",
        "fast",
        "feed",
        "first_feed",
        "kind",
        "log",
        "mm_per_x_unit",
        "mm_per_z_unit",
        "modal",
        "offset_x",
        "offset_z",
        "pending_shift",
        "per_rev",
        "px",
        "pz",
        "reported",
        "rpm",
        "secondary_x",
        "secondary_z",
        "setup",
        "slow_length_mm",
        "steady_feed",
        "title_rapid",
        "tool_line",
        "turning",
        "x",
        "z",
    )  # fmt: skip

    def __init__(self, setup: InterpreterSetup, log: DiagnosticLog) -> None:
        self.setup = setup
        self.log = log
        self.blocks = 0
        self.x, self.z, self.c = setup.start
        self.px, self.pz = self.x, self.z
        self.first_feed: float | None = None  # F of the first line under G94, mm/s
        self.tool_line = 0  # line of a T that no move of X and Z has followed yet
        self.title_rapid = 0  # line of a G00 (TITLE) that no F has followed yet
        self.pending_shift: dict[int, bool] = {}  # line of a G10 → whether a T has followed
        self.coarse_start_point: tuple[float, float] | None = None  # machine point of the G35 in force
        self.turning: tuple[int, int, float] | None = None  # line, column, s that C still needs to arrive
        self.contour = ContourState()
        self.reported: set[str] = set()  # errors that would otherwise be repeated for every move
        self.modal = ModalState(metric=setup.metric, rapid_rate=setup.last_rapid)
        self.update_derived_values()

    def set_modal(self, modal: ModalState) -> None:
        """Set the modal state unless it equals the current state.

        Consecutive blocks with equal states therefore share one object.
        """
        if modal != self.modal:
            self.modal = modal
            self.update_derived_values()

    def update_derived_values(self) -> None:
        """Derive the values that every move needs from the modal state."""
        modal = self.modal
        self.absolute = modal.absolute is not False
        self.mm_per_z_unit = 1.0 if modal.metric else MM_PER_INCH
        self.mm_per_x_unit = self.mm_per_z_unit / 2 if modal.diameter else self.mm_per_z_unit
        self.offset_x, self.offset_z = modal.offset_x, modal.offset_z
        self.secondary_x, self.secondary_z = modal.secondary_offset_x, modal.secondary_offset_z
        self.cut = not modal.rapid and (modal.feed is None or not self.is_first_line_feed(modal.feed))
        self.kind = BlockKind.FEED if self.cut else BlockKind.RAPID
        self.feed = modal.rapid_rate if modal.rapid else (modal.feed or 0.0)
        self.per_rev = modal.per_rev and not modal.rapid
        self.rpm = modal.rpm * modal.spindle
        steady = not modal.rapid and (modal.feed, modal.per_rev) == (
            modal.last_cutting_feed,
            modal.is_cutting_feed_per_rev,
        )
        # each such feed causes a warning
        steady = steady and not (modal.per_rev and (modal.feed or 0.0) > HIGH_FEED_MM_PER_REV)
        self.steady_feed = modal.feed if steady else None  # feed that G01 with the same F would not change
        self.slow_length_mm = 0.0  # length in mm above which a move at this feed is too slow
        # the next plain move needs no check, because a move with this state passed all checks
        self.fast = False

    def is_first_line_feed(self, feed: float) -> bool:
        """Return whether a feed is the F of the first line, which is the rapid rate without G00."""
        if self.modal.per_rev or self.first_feed is None:
            return False
        return abs(feed - self.first_feed) <= 1e-9 * self.first_feed

    def convert_feed(self, value: FloatOrArray) -> FloatOrArray:
        """Convert F to mm/s under G94, or to mm/rev under G95."""
        return value * self.mm_per_z_unit / (1 if self.modal.per_rev else 60)

    def stay(self, modal: ModalState) -> None:
        """Set a modal state with other offsets, without changing the machine position."""
        x, z = self.x + self.offset_x, self.z + self.offset_z
        self.set_modal(modal)
        self.x, self.z = x - self.offset_x, z - self.offset_z
        self.px, self.pz = self.x - self.secondary_x, self.z - self.secondary_z

    def compute_rpm_at(self, x: float) -> float:
        """Return the commanded signed speed in rpm with the tip at radius ``x`` in mm.

        The speed is 0 if the spindle is stopped.
        """
        modal = self.modal
        if not modal.css or not modal.spindle:
            return self.rpm
        return modal.compute_surface_rpm(x, self.setup.limits.max_rpm)

    def action(self, line: int, text: str, action: Action) -> Block:
        """Return a block that executes an action without motion."""
        self.blocks += 1
        kind = BlockKind.DWELL if isinstance(action, Dwell) else BlockKind.ACTION
        x, z, c, modal = self.x, self.z, self.c, self.modal
        return Block(
            self.blocks, line, kind, text, x, z, c, x, z, c, self.offset_x, self.offset_z, modal,
            rpm=self.compute_rpm_at(x), css=modal.active_surface_speed, action=action,
        )  # fmt: skip

    def move(
        self, kind: BlockKind, line: int, text: str, start: tuple[float, float, float], feed: float,
        *, is_feed_per_rev: bool = False, rpm: float = 0.0, surface_speed: float | None = None,
        center: tuple[float, float] = (0.0, 0.0), is_clockwise: bool = False, plane: PlaneMove | None = None,
    ) -> Block:  # fmt: skip
        """Return the block of a move from ``start`` (x, z, c) to the current position of the state."""
        self.blocks += 1
        return Block(
            self.blocks, line, kind, text, *start, self.x, self.z, self.c, self.offset_x, self.offset_z,
            self.modal, feed, is_feed_per_rev, rpm, surface_speed, *center, is_clockwise, plane=plane,
        )  # fmt: skip


# ``flow`` belongs to the interpreter, the others belong to other dialects
_OTHER_FIELDS = ("flow", "kept", "at")
_STATE_FIELDS = tuple(name for name in Checkpoint._fields if name not in _OTHER_FIELDS)


def make_checkpoint(state: State) -> Checkpoint:
    """Return a checkpoint at the start of the next line, from which another pass can continue."""
    return Checkpoint(*(getattr(state, name) for name in _STATE_FIELDS))


def restore_state(state: State, pass_start: PassStart) -> None:
    """Restore the state that the pass inherits at its start line.

    An MDI line starts at the current position. A restart starts at its checkpoint, to which the approach
    leads. C remains at its position unless it is locked.
    """
    point = pass_start.checkpoint
    for name in _STATE_FIELDS:
        setattr(state, name, getattr(point, name))
    state.update_derived_values()
    start_x, start_z, start_c = state.setup.start[:3]
    if pass_start.is_mdi_line:
        state.x, state.z = start_x - state.offset_x, start_z - state.offset_z
        state.px, state.pz = state.x - state.secondary_x, state.z - state.secondary_z
    if pass_start.is_mdi_line or not point.modal.c_locked:
        state.c = start_c - point.modal.offset_c
