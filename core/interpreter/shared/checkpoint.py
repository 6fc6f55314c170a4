"""State from which a pass can start: the first line, or a state saved by another pass.

MDI, restart and block search start from a saved state. Each part of an interpreter contains its own portion
of the state. A saved pass copies all parts completely, so that no part of the state is missing.
"""

from __future__ import annotations

import os
from copy import deepcopy
from itertools import count
from typing import Any, Generic, NamedTuple, Protocol, TypeVar, runtime_checkable

from core.interpreter.shared.actions import Action
from core.interpreter.shared.modal_state import ModalState

PartsType = TypeVar("PartsType")
# The name of a checkpoint must be unique in all processes, because checkpoints are sent between them.
_process = os.urandom(8).hex()
_numbers = count(1)


class ModalStateLine(NamedTuple):
    """One line of the modal state as displayed; ``key`` identifies its group of functions."""

    key: str
    value: str


@runtime_checkable
class ReplacedWhenSaved(Protocol):
    """A shared object, such as a log, that is replaced by a stand-in when a pass is saved."""

    def make_stand_in(self) -> object:
        """Return an object that another process can use until the next pass replaces it."""


class SavedPass(Generic[PartsType]):
    """The state of an interpreter between two blocks.

    Each saved pass has a name that is unique in all processes. A saved pass is equal only to itself and to
    its copies in other processes. ``shared`` contains the objects that are not copied, such as the setup,
    the log and program texts. The setup is saved without inputs and start, and the log without findings.
    Another process cannot use these data, and the next pass replaces both objects.
    """

    def __init__(
        self, parts: PartsType, shared: tuple[object, ...], state_lines: tuple[ModalStateLine, ...] = ()
    ) -> None:
        self._shared = tuple(_make_stand_in(each) for each in shared)
        self._parts = deepcopy(parts, {id(old): new for old, new in zip(shared, self._shared, strict=True)})
        self._name = f"{_process}-{next(_numbers)}"
        self.state_lines = state_lines

    def __repr__(self) -> str:
        return f"KeptPass {self._name}"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, SavedPass) and self._name == other._name

    def __hash__(self) -> int:
        return hash(self._name)

    def copy_parts(self, *instead: object) -> PartsType:
        """Return a copy of the saved parts, in which the objects ``instead`` replace shared objects.

        The first object in ``instead`` replaces the first shared object, and so on.
        """
        places = (*instead, *self._shared[len(instead) :])
        return deepcopy(self._parts, {id(old): new for old, new in zip(self._shared, places, strict=True)})


def _make_stand_in(shared: object) -> object:
    """Return the stand-in of a shared object for saving, or the object itself if it has none."""
    return shared.make_stand_in() if isinstance(shared, ReplacedWhenSaved) else shared


class CallLevel(NamedTuple):
    """The main program or one active subroutine, with lines as indices from 0.

    ``return_index`` is the line at which execution continues after a subroutine that this level has called.
    If no call is active, it is the next line. ``remaining_repeats`` contains a pair for each active loop,
    from the outermost to the innermost. The pair is the line of LS and the number of remaining repeats.
    """

    return_index: int
    end_index: int
    remaining_repeats: tuple[tuple[int, int], ...] = ()


FlowPosition = tuple[CallLevel, ...]
"""Flow levels from the main program to the active call.

An empty tuple means the main program outside any loop.
"""


class Checkpoint(NamedTuple):
    """The complete state that a line inherits from earlier lines.

    Lengths are in mm in the program frame, with X as a radius. Angles are in degrees. ``x``, ``z`` and
    ``c`` are the current position. ``px`` and ``pz`` are the programmed position without the secondary
    offset.
    """

    modal: ModalState
    x: float = 0.0
    z: float = 0.0
    c: float = 0.0
    px: float = 0.0
    pz: float = 0.0
    # F of the program's first line under G94, in mm/s; this F counts as a rapid
    first_feed: float | None = None
    tool_line: int = 0  # line of a T that no move of X and Z has followed yet; -1 for a line of MDI
    title_rapid: int = 0  # line of a G00 (TITLE) that no F has followed yet
    coarse_start_point: tuple[float, float] | None = None  # machine point of the G35 in force
    blocks: int = 0  # number of elementary blocks before this point
    flow: FlowPosition = ()  # active loops and calls
    kept: SavedPass[Any] | None = None  # complete state of a Klartext or SINUMERIK interpreter
    at: tuple[float, ...] = ()  # machine positions of all axes of a mill

    @property
    def machine(self) -> tuple[float, float]:
        """Return machine X (as a radius) and Z of the current position, in mm."""
        return self.x + self.modal.offset_x, self.z + self.modal.offset_z


class StraightLeg(NamedTuple):
    """A straight move to a machine position in mm; an axis that does not move is None."""

    x: float | None
    z: float | None
    feed_mm_s: float
    is_rapid: bool
    text: str


class MultiAxisLeg(NamedTuple):
    """A straight move of some axes of a mill to machine positions, in mm and degrees.

    ``feed`` is in mm/s or degrees/s, or None for a rapid.
    """

    target_positions: tuple[tuple[str, float], ...]
    feed: float | None
    text: str


class CAxisMove(NamedTuple):
    """A move of only the C axis to a machine angle in degrees, at ``speed`` in degrees/s."""

    angle_deg: float
    speed: float
    text: str


class FunctionStep(NamedTuple):
    """A step of the approach that executes an M function, such as spindle, coolant or an output."""

    action: Action
    text: str


ApproachStep = StraightLeg | MultiAxisLeg | CAxisMove | FunctionStep
"""Step of the approach from the current axis positions to the restart point."""


class PassStart(NamedTuple):
    """The start of a pass: the checkpoint, and the approach to it.

    - ``is_mdi_line`` means that the text is one MDI line instead of a program.
    - The moves of ``approach_steps`` precede the line and must end at the position of the checkpoint.
    - With ``skips_cuts``, the part is not counted, because earlier cuts are incomplete.
    """

    checkpoint: Checkpoint
    line_number: int = 1
    is_mdi_line: bool = False
    approach_steps: tuple[ApproachStep, ...] = ()
    skips_cuts: bool = False

    @property
    def key(self) -> str:
        """Return a string that is the same for two starts only if the starts are equal."""
        modal = self.checkpoint.modal
        whole = self._replace(checkpoint=self.checkpoint._replace(modal=modal._replace(outputs=frozenset())))
        return repr((whole, sorted(modal.outputs)))
