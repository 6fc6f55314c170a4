"""State that changes during a pass, with direct attributes for fast access; and its checkpoint."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple, TypeVar

from core.interpreter.shared.actions import Action, Dwell
from core.interpreter.shared.checkpoint import Begin, Checkpoint
from core.interpreter.shared.diagnostic_log import Log
from core.interpreter.shared.elementary_blocks import Block, Floats, Kind
from core.interpreter.shared.job_setup import Setup
from core.interpreter.shared.modal_state import Modal
from core.interpreter.shared.units import MM_PER_INCH

if TYPE_CHECKING:
    from core.geometry.virtual_mill import PlaneMove


Numbers = TypeVar("Numbers", float, Floats)


class Corner(NamedTuple):
    """A corner (C or R) between a straight move and the next one; ``size`` is in mm."""

    letter: str
    size: float
    column: int


class CompensationSwitch(NamedTuple):
    """Mark for G41, G42 or G40 among the blocks.

    ``dx dz`` is the secondary offset that is included in the point reached.
    """

    code: int
    line: int
    dx: float
    dz: float

    @property
    def name(self) -> str:
        """The code for messages, such as G41."""
        return f"G{self.code}"


Item = Block | CompensationSwitch


@dataclass(slots=True)
class ContourState:
    """Open corners and active nose compensation between the lines and the generated blocks."""

    active: bool = False  # blocks are buffered, so each block must pass through the contour modifier
    corner: Corner | None = None  # corner after the present move
    approach: int = 0  # line of a G41 or G42 that no approach has followed yet
    d_line: int = 0  # last line with a D


HIGH_FEED = 0.05 * MM_PER_INCH * (1 + 1e-9)
"""Feed, mm/rev, above which F003 was hardly meant and F.003 was."""


class State:
    """Position and modal state in mm, with X as a radius.

    ``x z`` is the point reached. ``px pz`` is the programmed point, which does not include the secondary
    offset. The other values are derived from ``modal``.
    """

    __slots__ = (
        "absolute",
        "blocks",
        "c",
        "coarse_at",
        "contour",
        "cut",
        "dx",
        "dz",
        "fast",
        "feed",
        "first_feed",
        "kind",
        "log",
        "modal",
        "offset_x",
        "offset_z",
        "pending_shift",
        "per_rev",
        "px",
        "pz",
        "reported",
        "rpm",
        "scale_x",
        "scale_z",
        "setup",
        "slow_length",
        "steady_feed",
        "title_rapid",
        "tool_line",
        "turning",
        "x",
        "z",
    )  # fmt: skip

    def __init__(self, setup: Setup, log: Log) -> None:
        self.setup = setup
        self.log = log
        self.blocks = 0
        self.x, self.z, self.c = setup.start
        self.px, self.pz = self.x, self.z
        self.first_feed: float | None = None  # F of the first line under G94, mm/s
        self.tool_line = 0  # line of a T that no move of X and Z has followed yet
        self.title_rapid = 0  # line of a G00 (TITLE) that no F has followed yet
        self.pending_shift: dict[int, bool] = {}  # line of a G10 → whether a T has followed
        self.coarse_at: tuple[float, float] | None = None  # machine point of the G35 in force
        self.turning: tuple[int, int, float] | None = None  # line, column, s that C still needs to arrive
        self.contour = ContourState()
        self.reported: set[str] = set()  # errors that would otherwise be repeated for every move
        self.modal = Modal(metric=setup.metric, rapid_rate=setup.last_rapid)
        self.derive()

    def adopt(self, modal: Modal) -> None:
        """Set the modal state; if it is equal to the present one, blocks continue to share that object."""
        if modal != self.modal:
            self.modal = modal
            self.derive()

    def derive(self) -> None:
        """Calculate the values that every move needs from the modal state."""
        modal = self.modal
        self.absolute = modal.absolute is not False
        self.scale_z = 1.0 if modal.metric else MM_PER_INCH
        self.scale_x = self.scale_z / 2 if modal.diameter else self.scale_z
        self.offset_x, self.offset_z = modal.offset_x, modal.offset_z
        self.dx, self.dz = modal.secondary_x, modal.secondary_z
        self.cut = not modal.rapid and (modal.feed is None or not self.is_first_feed(modal.feed))
        self.kind = Kind.FEED if self.cut else Kind.RAPID
        self.feed = modal.rapid_rate if modal.rapid else (modal.feed or 0.0)
        self.per_rev = modal.per_rev and not modal.rapid
        self.rpm = modal.rpm * modal.spindle
        steady = not modal.rapid and (modal.feed, modal.per_rev) == (modal.cut_feed, modal.cut_per_rev)
        # each such feed causes a warning
        steady = steady and not (modal.per_rev and (modal.feed or 0.0) > HIGH_FEED)
        self.steady_feed = modal.feed if steady else None  # feed that G01 with the same F would not change
        self.slow_length = 0.0  # length in mm above which a move at this feed is too slow
        # the next plain move needs no check, because a move with this state passed all checks
        self.fast = False

    def is_first_feed(self, feed: float) -> bool:
        """Return whether this is the first line's F, at which programs without G00 make rapids."""
        if self.modal.per_rev or self.first_feed is None:
            return False
        return abs(feed - self.first_feed) <= 1e-9 * self.first_feed

    def feed_word(self, value: Numbers) -> Numbers:
        """Return F in mm/s under G94, or in mm/rev under G95."""
        return value * self.scale_z / (1 if self.modal.per_rev else 60)

    def stay(self, modal: Modal) -> None:
        """Set a modal state with another frame; the machine position remains the same."""
        x, z = self.x + self.offset_x, self.z + self.offset_z
        self.adopt(modal)
        self.x, self.z = x - self.offset_x, z - self.offset_z
        self.px, self.pz = self.x - self.dx, self.z - self.dz

    def rpm_at(self, x: float) -> float:
        """Return the commanded signed speed in rpm with the tip at radius ``x`` (mm); 0 if stopped."""
        modal = self.modal
        if not modal.css or not modal.spindle:
            return self.rpm
        return modal.surface_rpm_at(x, self.setup.limits.max_rpm)

    def action(self, line: int, text: str, action: Action) -> Block:
        """Return a block without motion."""
        self.blocks += 1
        kind = Kind.DWELL if isinstance(action, Dwell) else Kind.ACTION
        x, z, c, modal = self.x, self.z, self.c, self.modal
        return Block(
            self.blocks, line, kind, text, x, z, c, x, z, c, self.offset_x, self.offset_z, modal,
            rpm=self.rpm_at(x), css=modal.css_speed, action=action,
        )  # fmt: skip

    def move(
        self, kind: Kind, line: int, text: str, start: tuple[float, float, float], feed: float,
        *, per_rev: bool = False, rpm: float = 0.0, css: float | None = None,
        centre: tuple[float, float] = (0.0, 0.0), clockwise: bool = False, plane: PlaneMove | None = None,
    ) -> Block:  # fmt: skip
        """Return the block of a move from ``start`` (x, z, c) to the present position of the state."""
        self.blocks += 1
        return Block(
            self.blocks, line, kind, text, *start, self.x, self.z, self.c, self.offset_x, self.offset_z,
            self.modal, feed, per_rev, rpm, css, *centre, clockwise, plane=plane,
        )  # fmt: skip


# ``flow`` belongs to the interpreter, the others belong to other dialects
_NOT_OF_THE_STATE = ("flow", "kept", "at")
_KEPT = tuple(name for name in Checkpoint._fields if name not in _NOT_OF_THE_STATE)


def checkpoint_of(state: State) -> Checkpoint:
    """Return the state in which the next line begins; another pass can continue from it."""
    return Checkpoint(*(getattr(state, name) for name in _KEPT))


def restore(state: State, begin: Begin) -> None:
    """Restore the state that the line of ``begin`` inherits.

    A line of MDI begins at the present position. A restart begins at its checkpoint, which its approach
    reaches. C remains at its position unless it is locked.
    """
    point = begin.checkpoint
    for name in _KEPT:
        setattr(state, name, getattr(point, name))
    state.derive()
    start_x, start_z, start_c = state.setup.start[:3]
    if begin.single:
        state.x, state.z = start_x - state.offset_x, start_z - state.offset_z
        state.px, state.pz = state.x - state.dx, state.z - state.dz
    if begin.single or not point.modal.c_locked:
        state.c = start_c - point.modal.offset_c
