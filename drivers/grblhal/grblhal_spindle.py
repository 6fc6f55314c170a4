"""The controller's spindle: lines at a standstill, override steps while it moves, a toggle in a feed hold."""

from __future__ import annotations

import math
from collections.abc import Callable

from core.ports import DriverError
from drivers.grblhal import grblhal_codes
from drivers.grblhal.grblhal_blocks import GrblBlocks
from drivers.grblhal.grblhal_codes import number
from drivers.grblhal.grblhal_controller import Controller
from drivers.grblhal.grblhal_operator import LEAST, MOST
from drivers.grblhal.grblhal_wire import Ask
from drivers.port_parts import demand_spindle

_OBEYS = 1.0  # s for a spindle that is stopped in a hold to be told as off
_CLIPS = 2.0  # s in which report, override and S word may tell of different moments
_HIGHEST = 30  # setting
_OVER, _UNDER = MOST / 100.0, LEAST / 100.0  # of an S word, by its override
_IN_WAIT = 0.3  # s without an answer to M3 or M4: the controller waits for the speed, and reads no line
_STANDS = 30.0  # rpm, between two reports of a spindle that reverses


class GrblEncoder:
    """The encoder on the controller, of a spindle that something else turns. It tells no direction."""

    def __init__(self, controller: Controller) -> None:
        self._c = controller
        self.way: Callable[[], float] = lambda: 0.0  # signed rpm, as whatever turns it says
        self._sign = 1.0

    @property
    def measures(self) -> bool:
        """Whether the controller measures at all."""
        return self._c.report is not None and self._c.report.measured is not None

    def speed(self) -> float:
        """rpm; one that runs down has the sign that it had. By what turns it while the controller is mute."""
        way, report = self.way(), self._c.report
        if self._c.mute:
            return way
        self._sign = math.copysign(1.0, way) if way else self._sign
        return self._sign * abs(report.measured or 0.0) if report is not None else 0.0

    def angle(self) -> tuple[float, float] | None:
        """The controller keeps it to itself."""
        return None


class _Way:
    """The sign of a speed that is measured without one: reversed when it has come down, and no sooner."""

    def __init__(self) -> None:
        self._sign, self._least = 1.0, math.inf

    def of(self, rpm: float, asked: float) -> float:
        """``rpm`` with its sign, towards that of ``asked``."""
        rpm = abs(rpm)
        if math.copysign(1.0, asked) == self._sign:
            self._least = math.inf
            return self._sign * rpm
        self._least = min(self._least, rpm)
        if rpm < _STANDS or rpm > 1.05 * self._least + _STANDS:
            self._sign, self._least = -self._sign, math.inf
        return self._sign * rpm


class GrblSpindle:
    """``core.ports.Spindle``: M3, M4 and M5 while nothing moves, and else the override of the last S."""

    def __init__(self, controller: Controller, blocks: GrblBlocks) -> None:
        self._c = controller
        self._blocks = blocks
        self._wanted = 0.0
        self._said = 0.0  # of the last M3 or M4, signed
        self._runs = False  # in the controller: a stop or a reset ends that
        self._way = _Way()
        self._paused_at: float | None = None  # stopped in a feed hold, whose lines are not read
        self._word: Ask | None = None  # the last M3 or M4
        self._unlike_since: float | None = None  # it is commanded another speed than that

    def run(self, rpm: float) -> None:
        """Signed rpm, at most the machine's; 0 stops. Raises DriverError above the controller's own limit,
        beyond which it would turn slower than the program has it, and while it takes no lines.
        """
        if rpm:
            demand_spindle(self._blocks.hindrance())
        rpm = math.copysign(min(abs(rpm), self._c.config.rpm_max), rpm)
        highest = self.highest
        if highest and abs(rpm) > 1.001 * highest:
            raise DriverError(
                "spindle: the controller allows {highest} rpm ($30), not {rpm} rpm",
                "spindle-off",
                highest=f"{highest:g}",
                rpm=f"{abs(rpm):.0f}",
            )
        self._wanted = rpm
        self.pump()

    def coast(self) -> None:
        """The controller knows no other stop than M5."""
        self.run(0.0)

    @property
    def highest(self) -> float:
        """The controller's own limit, rpm, beyond which it turns slower than asked; 0 untold."""
        return float(self._c.settings.get(_HIGHEST, "0"))

    def speed(self) -> float:
        """Measured where the controller has an encoder, else what it commands; signed."""
        report = self._c.report
        if report is None or report.speeds is None or len(report.speeds) < 2:
            return 0.0
        if report.measured is None:
            return math.copysign(report.speeds[1], self._said)
        return self._way.of(report.measured, self._said)

    def angle(self) -> tuple[float, float] | None:
        """The controller keeps it to itself."""
        return None

    def fault(self) -> str:
        """Alarms are those of the axes."""
        return ""

    def voided(self) -> None:
        """A stop or a reset has switched it off; nothing switches it on again but the program."""
        self._wanted, self._runs, self._paused_at, self._word = 0.0, False, None, None

    def pump(self) -> None:
        """Bring the controller to what is wanted."""
        c = self._c
        self.speed()  # of each report, or a reversal between two looks would be missed
        if not c.ready:
            return
        if c.state == "Hold":
            self._in_hold()
        elif self._paused_at is not None:
            self._after_hold()
        elif self._wanted == 0.0:
            self._stop()
        elif self._blocks.quiet and self._blocks.listens and (not self._runs or self._base != self._said):
            self._start()
        elif self._runs and not (self._blocks.quiet and not self._blocks.highest):
            self._follow(self._said)
        self._watch_clipping()
        if c.config.own_spindle:
            laid = self._blocks.highest and self._runs and self._base == self._said
            self._blocks.reach = _OVER * abs(self._said) if laid else 0.0

    # --- inside -------------------------------------------------------------------------------------------

    @property
    def _base(self) -> float:
        """The S word, signed. Where it follows the radius: half of the highest speed that it may come to, for
        the override goes from a tenth to the double. So what puts the override back to 100 %, such as a
        pendant's button, makes it no faster than the program allows.
        """
        highest, wanted = self._blocks.highest, abs(self._wanted)
        if not highest:
            return self._wanted
        said = abs(self._said)
        fits = highest <= 1.001 * _OVER * said and said <= 1.001 * highest and _UNDER * said <= 1.001 * wanted
        if self._runs and self._wanted * self._said > 0.0 and fits:
            return self._said
        return math.copysign(max(min(highest / _OVER, wanted / _UNDER), wanted / _OVER), self._wanted)

    def _start(self) -> None:
        """By M3 or M4; one that follows the radius once its override is told, or it would leap."""
        base = self._base
        if self._blocks.highest:
            self._follow(base)
            if not self._blocks.overrides.true_to(self._c.overrides):
                return
        else:
            self._blocks.overrides.want_spindle(100)
        self._runs, self._said = True, base
        self._word = self._c.send(f"M{3 if base > 0.0 else 4}S{number(abs(base))}")

    def _watch_clipping(self) -> None:
        """Firmware that limits a speed does so without a word, and a $30 that was written may count from its
        next start only: what it reports as commanded is what it turns.
        """
        c = self._c
        now, told = c.clock.now(), c.report.speeds if c.report is not None else None
        share = c.overrides[2] / 100.0 if c.overrides is not None and len(c.overrides) > 2 else None
        said = self._runs and self._word is not None and self._word.done and c.state != "Hold"
        if not said or told is None or share is None or len(told) < 2:
            self._unlike_since = None
            return
        expected = abs(self._said) * share
        if abs(told[1] - expected) <= 0.02 * expected + 2.0:
            self._unlike_since = None
        elif self._unlike_since is None:
            self._unlike_since = now
        elif now - self._unlike_since > _CLIPS:
            c.fail(
                "the controller runs the spindle at {details} rpm instead of {expected} rpm "
                "because the controller limits the speed ($30, $31; a changed setting may take "
                "effect only after the controller restarts)",
                "controller-refuses",
                details=f"{told[1]:g}",
                expected=f"{expected:.0f}",
            )

    def _follow(self, base: float) -> None:
        """By the override of the S word."""
        if self._wanted * base > 0.0:
            share = round(100.0 * self._wanted / base)
            self._blocks.overrides.want_spindle(min(max(share, LEAST), MOST))

    def _stop(self) -> None:
        if not self._runs or self._ends_wait():
            return
        if self._blocks.listens:
            self._runs = False
            self._c.send("M5")
        else:
            self._blocks.jog_stop()  # a line would be refused; M5 follows when the slide rests

    def _ends_wait(self) -> bool:
        """Return whether M3 or M4 is unanswered. In the firmware's wait for the speed M5 is not read and the
        toggle of a hold has no effect: what stops the spindle is the end of everything, a reset.
        """
        word = self._word
        if word is None or word.done:
            return False
        if self._c.listened - word.sent_at > _IN_WAIT:
            self._blocks.abort()
        return True

    def _in_hold(self) -> None:
        """A toggle: sent once, and looked at."""
        stops = self._runs and self._wanted == 0.0
        if self._paused_at is None and stops and self._ends_wait():
            return
        if self._paused_at is None and stops:
            self._paused_at = self._c.clock.now()
            self._c.realtime(grblhal_codes.SPINDLE_PAUSE)
        elif self._paused_at is not None and self._runs and self._wanted * self._said > 0.0:
            self._paused_at = None
            self._c.realtime(grblhal_codes.SPINDLE_PAUSE)
        elif self._paused_at is not None and self._c.clock.now() - self._paused_at > _OBEYS and self._turns():
            self._c.fail(
                "the controller does not stop its spindle in feed hold: PRESS E-STOP", "ignores-stop"
            )

    def _after_hold(self) -> None:
        """$63 leaves it off; said again, in case that this controller has restored it."""
        self._paused_at, self._runs = None, False
        self._c.send("M5")

    def _turns(self) -> bool:
        report = self._c.report
        return report is not None and report.speeds is not None and report.speeds[1:2] > (0.0,)
