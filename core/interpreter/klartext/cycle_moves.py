"""What cycles are made of: the tool above a place of the working plane, its ways, dwells, the spindle."""

from __future__ import annotations

from collections.abc import Callable

from core.geometry.lines_and_arcs import Arc, Point
from core.geometry.plane_arcs import HelixMove
from core.interpreter.actions import Dwell, SpindleRun, SpindleStop
from core.interpreter.elementary_blocks import Block, Kind
from core.interpreter.klartext.klartext_state import SLIDES, State
from core.language.diagnostics import ProgramError, Severity
from core.language.klartext.klartext_faults import CYCLE_MISSING, INPUT_VALUE
from core.language.klartext.q_parameters import MAX_FEED, TOOL_FEED


class CycleTool:
    """The tool in a cycle that was called at ``column`` of a block; mm, in the program's coordinates.

    ``value`` gives a parameter of the cycle by the number of its Q, as written.
    """

    def __init__(self, state: State, number: int, value: Callable[[int], float | None], column: int) -> None:
        self._state = state
        self._number = number
        self._value = value
        self._column = column

    # --- what the cycle was told --------------------------------------------------------------------------

    def plain(self, q: int, default: float | None = None) -> float:
        """A parameter as written. Raises ProgramError where it is missing and has no ``default``."""
        found = self._value(q)
        if found is None:
            found = default
        if found is None:
            text = f"Cycle {self._number} needs Q{q}."
            raise self._state.refuse(self._column, CYCLE_MISSING, text, "Write it behind CYCL DEF.")
        return found

    def length(self, q: int, default: float | None = None) -> float:
        """A length, mm."""
        return self.plain(q, default) * self._state.scale

    def feed(self, q: int) -> float | None:
        """A feed as programmed; None where it is a rapid."""
        found = self.plain(q)
        if found == TOOL_FEED and self._state.tool_feed is not None:
            return self._state.tool_feed
        if found <= 0.0:
            text = f"Q{q} of cycle {self._number} is no feed."
            raise self._state.refuse(self._column, INPUT_VALUE, text, "Write a feed above zero.")
        return None if found >= MAX_FEED else found

    def refuse(self, text: str, hint: str) -> ProgramError:
        """An error of this cycle, to be raised."""
        return self._state.refuse(self._column, INPUT_VALUE, text, hint)

    @property
    def radius(self) -> float:
        """Of the tool, mm."""
        return self._state.tool_radius / self._state.figure.factor

    @property
    def here(self) -> Point:
        """X and Y where the tool stands."""
        x, y, _ = self._state.programmed
        return x, y

    @property
    def height(self) -> float:
        """Z where the tool stands."""
        return self._state.programmed[2]

    @property
    def rpm(self) -> float:
        """Speed of the spindle, signed. Raises ProgramError where it stands."""
        found = self._state.modal.rpm * self._state.modal.spindle
        if not found:
            raise self.refuse(f"Cycle {self._number} needs the spindle to turn.", "Start it with M3 before.")
        return found

    def warn_uncoupled(self) -> None:
        """Nothing couples the spindle of a mill to its Z here: a rigid tap would break."""
        text = f"Cycle {self._number} moves at pitch times speed: nothing couples the spindle to Z here."
        hint = "Use a floating holder."
        self._state.tell_once(self._column, Severity.WARNING, "tapping-uncoupled", text, hint)

    # --- what it does -------------------------------------------------------------------------------------

    def to(self, z: float, feed: float | None = None) -> Block:
        """Up or down to ``z``; without a feed in rapid."""
        return self.across(self.here, z, feed)

    def across(self, at: Point, z: float | None = None, feed: float | None = None) -> Block:
        """Straight to a point; without a feed in rapid."""
        state = self._state
        goal = state.machine((*at, self.height if z is None else z))
        rate = None if feed is None else state.path_feed(feed)
        return state.move(
            Kind.RAPID if rate is None else Kind.FEED, dict(zip(SLIDES, goal, strict=True)), rate
        )

    def round(self, arc: Arc, z: float, feed: float) -> Block:
        """Along an arc, with Z to ``z``."""
        state = self._state
        levels = [state.figure.plane((0.0, 0.0, at))[2] for at in (self.height, z)]
        names = state.names
        columns = names.index("X"), names.index("Y"), names.index("Z")
        way = HelixMove(state.place, state.figure.arc(arc), levels[0], levels[1], state.there, columns)
        goal = dict(zip(SLIDES, state.machine((*arc.end, z)), strict=True))
        return state.move(Kind.PLANE_ARC, goal, state.path_feed(feed), way)

    def dwell(self, seconds: float) -> list[Block]:
        """Rest; nothing where there is no time."""
        return [self._state.action(Dwell(seconds))] if seconds > 0.0 else []

    def turn(self, rpm: float) -> Block:
        """The spindle at this speed and in this direction."""
        state = self._state
        state.modal = state.modal._replace(spindle=1 if rpm > 0.0 else -1)
        return state.action(SpindleRun(rpm))

    def stop(self) -> Block:
        """The spindle at rest."""
        state = self._state
        state.modal = state.modal._replace(spindle=0)
        return state.action(SpindleStop())
