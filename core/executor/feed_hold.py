"""Feed hold: a cycle comes to rest on its path, in a thread behind the pull-out; Cycle Start goes on.

The operator asks for it, or what must not go on: a lost spindle, an open guard, an output that is not as it
was commanded, a queue that runs dry. Going on waits for the spindle before the slides move.
"""

from __future__ import annotations

from core.alarms import CATALOGUE, Code
from core.executor.controller_motion import ControllerMotion
from core.executor.machine_context import MachineContext
from core.executor.raised_alarm import AlarmError, code_of_hold
from core.executor.setpoint_motion import SetpointMotion
from core.executor.snapshot import State
from core.executor.standstill import Standstill, Wait, at_speed
from core.interpreter.elementary_blocks import Block

PathMotion = SetpointMotion | ControllerMotion
"""What moves the blocks from rest to rest: our own setpoints, or a controller that plans by itself."""


class FeedHold:
    """Stops what a cycle has under way and lets it go on. On the executor's thread alone."""

    def __init__(self, context: MachineContext, motion: PathMotion, still: Standstill) -> None:
        self._context = context
        self._motion = motion
        self._still = still
        self.reason = ""  # in the words of the catalogue; empty where the button was pressed
        self._since = 0.0
        self._spin_up: Wait | None = None  # before motion that was stopped goes on
        self._behind: Block | None = None  # single block goes on behind this one
        self._retracting = False  # out of a thread whose spindle is lost

    @property
    def within_section(self) -> bool:
        """Whether motion goes on within a path section, and not with the next one."""
        return self._motion.active and not self._motion.complete

    @property
    def retracting(self) -> bool:
        """Whether the tool is on its way out of a thread that has lost its spindle."""
        return self._retracting

    @property
    def spins_up(self) -> bool:
        """Whether going on still waits for the spindle."""
        return self._spin_up is not None

    @property
    def label(self) -> str:
        """In words, what going on waits for; empty where it waits for nothing."""
        return self._spin_up.label() if self._spin_up is not None else ""

    def begin(self, reason: str = "", by: str = "", code: Code | None = None) -> State:
        """Come to rest; returns the state of the machine from now on.

        ``reason`` in the words of the catalogue or with its ``code``; empty where it was pressed, ``by``
        whom.
        """
        self.reason, self._since = reason, self._context.now
        self._context.show_stop(*(code_of_hold(reason, by) if code is None else (code, reason.lower())))
        if self._motion.moving:
            self._motion.hold()
            return State.HOLDING
        self._motion.let_stop()  # of a plan whose queue has run out meanwhile nothing holds any more
        return State.HOLD

    def starve(self, code: Code, detail: str) -> None:
        """The queue was not refilled in time and stops the slides: keep and show why."""
        self.reason, self._since = CATALOGUE[code].text.upper(), self._context.now
        self._context.show_stop(code, detail)

    def retract(self, block: Block) -> None:
        """The spindle is lost in a thread: brake along it, then draw X back."""
        self._context.log("thread", "spindle speed lost during threading")
        self._motion.retract(block)
        self._retracting = True

    def stopped(self) -> bool:
        """Called every tick while the slides come to rest; returns whether they are at rest.

        Raises AlarmError("thread-lost") once a lost thread is left.
        """
        self._motion.keep_up()
        if self._motion.moving:
            return False
        if self._retracting:
            self._motion.retracted()
        return not self._retracting

    def go_on(self, behind: Block | None, *, starts_spindle: bool) -> None:
        """Cycle Start after a stop, with single block ``behind`` the block that was the last one.

        A spindle that is to turn is waited for first.
        """
        self.reason = ""
        within = self.within_section
        self._still.done = within
        self._still.shift_for_hold(self._context.now - self._since)
        self._behind = behind
        self._spin_up = self._slow_spindle() if within or starts_spindle else None
        self._since = self._context.now
        if within and self._spin_up is None:
            self._motion.go_on(behind)

    def spin_up(self) -> State:
        """Every tick while the spindle speeds up; returns the state of the machine from now on.

        One that does not come to its speed is a hold again: the program is not lost with it.
        """
        if self._spin_up is None:
            return State.RUN
        try:
            over = self._spin_up.over(self._context.now)
        except AlarmError:
            self._spin_up = None
            return self.begin("SPINDLE DID NOT RETURN TO SPEED")
        if not over:
            return State.WAIT
        self._spin_up = None
        self._still.shift_for_hold(self._context.now - self._since)
        if self.within_section:
            self._motion.go_on(self._behind)
        return State.RUN

    def _slow_spindle(self) -> Wait | None:
        """What motion waits for that goes on: the spindle, when the program has it turning."""
        spindle = self._context.spindle
        if not spindle.asked or spindle.at_speed(self._context.now):
            return None
        return at_speed(self._context)
