"""Where a pass begins: at the first line, or going on from a pass that was kept (MDI, restart, block search).

What a language has in force lies in the parts of its interpreter. They are copied whole, so that nothing that
a family of codes adds can be forgotten here.
"""

from __future__ import annotations

import os
from copy import deepcopy
from itertools import count
from typing import Any, Generic, NamedTuple, TypeVar

from core.interpreter.shared.actions import Action
from core.interpreter.shared.modal_state import Modal

Parts = TypeVar("Parts")
_process = os.urandom(8).hex()  # a checkpoint may go to another process
_numbers = count(1)


class StateLine(NamedTuple):
    """One group of what is in force, in the words of the control; ``key`` names it for whoever shows it."""

    key: str
    value: str


class KeptPass(Generic[Parts]):
    """The parts of an interpreter between two blocks. Its text tells it from others, in all processes.

    It is equal to itself alone, and to what another process makes of it.

    ``shared`` are objects that are not copied: the circumstances, the log, texts that have been read.
    """

    def __init__(self, parts: Parts, shared: tuple[object, ...], lines: tuple[StateLine, ...] = ()) -> None:
        self._shared = shared
        self._parts = deepcopy(parts, {id(each): each for each in self._shared})
        self._name = f"{_process}-{next(_numbers)}"
        self.lines = lines

    def __repr__(self) -> str:
        return f"KeptPass {self._name}"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, KeptPass) and self._name == other._name

    def __hash__(self) -> int:
        return hash(self._name)

    def parts(self, *instead: object) -> Parts:
        """A copy to go on with, in which ``instead`` take the places of the first shared objects."""
        places = (*instead, *self._shared[len(instead) :])
        return deepcopy(self._parts, {id(old): new for old, new in zip(self._shared, places, strict=True)})


class FlowLevel(NamedTuple):
    """The main program or a subroutine being executed. Positions are indices of lines, from 0.

    ``back`` is where it goes on after a call, or the line that comes next; ``loops`` are the LS of each loop
    under way, outermost first, and how often its LF will yet go back.
    """

    back: int
    end: int
    loops: tuple[tuple[int, int], ...] = ()


FlowPlace = tuple[FlowLevel, ...]
"""The main program, then each call in it that is under way; empty: the main program, and no loop."""


class Checkpoint(NamedTuple):
    """Everything that a line inherits from the lines before it. mm, X a radius, degrees; program frame.

    ``x z c`` is the point reached, ``px pz`` the one programmed, which lacks the secondary offset.
    """

    modal: Modal
    x: float = 0.0
    z: float = 0.0
    c: float = 0.0
    px: float = 0.0
    pz: float = 0.0
    first_feed: float | None = None  # F of the program's first line under G94, mm/s: it counts as a rapid
    tool_line: int = 0  # line of a T whose move to X and Z is still to come; -1: it was an MDI line
    title_rapid: int = 0  # line of a G00 (TITLE) after which no F has come
    coarse_at: tuple[float, float] | None = None  # machine point of the G35 in force
    blocks: int = 0  # elementary blocks before it
    flow: FlowPlace = ()  # the loops and calls in which it stands
    kept: KeptPass[Any] | None = None  # of Klartext and SINUMERIK: all that they have in force
    at: tuple[float, ...] = ()  # of a mill: machine positions of all axes

    @property
    def machine(self) -> tuple[float, float]:
        """Machine X and Z of the point reached, mm."""
        return self.x + self.modal.offset_x, self.z + self.modal.offset_z


class Leg(NamedTuple):
    """A straight way to a machine point, mm; None: that axis stays. ``feed`` mm/s."""

    x: float | None
    z: float | None
    feed: float
    rapid: bool
    text: str


class AxesLeg(NamedTuple):
    """A straight way of a mill to machine positions of some of its axes, mm and degrees; ``feed`` mm/s or
    degrees/s, None in rapid."""

    goal: tuple[tuple[str, float], ...]
    feed: float | None
    text: str


class CTurn(NamedTuple):
    """C alone turns to this machine angle, degrees, at ``speed`` degrees/s."""

    c: float
    speed: float
    text: str


class FunctionStep(NamedTuple):
    """An M function of the approach: spindle, coolant, an output."""

    action: Action
    text: str


ApproachStep = Leg | AxesLeg | CTurn | FunctionStep
"""What leads from where the slides stand to where a program goes on."""


class Begin(NamedTuple):
    """Where and with what a pass begins. ``single``: the text is one line of MDI, not a program.

    ``approach`` comes before the line; it must end where the checkpoint stands. ``skips_cuts``: earlier cuts
    of the part are incomplete, so the part is not counted.
    """

    checkpoint: Checkpoint
    line: int = 1
    single: bool = False
    approach: tuple[ApproachStep, ...] = ()
    skips_cuts: bool = False

    @property
    def key(self) -> str:
        """Text that is the same for two beginnings only if they are."""
        modal = self.checkpoint.modal
        whole = self._replace(checkpoint=self.checkpoint._replace(modal=modal._replace(outputs=frozenset())))
        return repr((whole, sorted(modal.outputs)))
