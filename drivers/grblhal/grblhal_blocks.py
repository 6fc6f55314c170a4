"""The block-level port: tickets, holds and overrides on the conversation; ``core.ports.BlockSink``."""

from __future__ import annotations

import math
from collections.abc import Callable

from core.faults import code_of
from core.ports import BlockOp, BlockState, DriverError, ThreadOp
from drivers.grblhal import grblhal_codes, grblhal_scripts
from drivers.grblhal.grblhal_codes import line_number, line_of
from drivers.grblhal.grblhal_config import GrblAxis
from drivers.grblhal.grblhal_controller import Controller
from drivers.grblhal.grblhal_operator import Holds, Jogs, Overrides
from drivers.grblhal.grblhal_report import Report
from drivers.port_parts import demand_power

AHEAD = 0.4  # s of motion beyond the block under way: so long it runs on when the host is lost
_ABORT = "abort"


class GrblBlocks:
    """Blocks of one controller. Called by the executor's thread alone."""

    ahead = AHEAD

    def __init__(self, controller: Controller) -> None:
        self._c = controller
        self.overrides = Overrides(lambda data: controller.realtime(*data), controller.fail)
        self._jogs = Jogs(controller)
        self._holds = Holds(controller)
        self.powered = False  # leave to move, given and taken by ``GrblAxes``
        self._last = 0  # ticket
        self._done = 0
        self._active = 0
        self._threads: set[int] = set()  # tickets of passes that are not done
        self._settled = False  # a report since the last line has said that all is done
        self._target: tuple[float, float] | None = None
        self.highest = 0.0  # rpm that the spindle may have to follow the radius up to; 0: it is constant
        self.reach = 0.0 if controller.config.own_spindle else math.inf  # and can; ``GrblSpindle`` knows
        self.rest: tuple[float, float] | None = None  # X and Z where the last block has exactly ended
        self.terminals: Callable[[], frozenset[str]] = frozenset  # what the inputs and outputs can do
        controller.on_report, controller.on_void = self._reported, self._voided
        controller.settled = lambda: self._settled

    @property
    def listens(self) -> bool:
        """Whether lines are read and carried out: in a jog they are refused, in a hold they wait."""
        return self._c.ready and not self._jogs.active and self._c.state not in {"Jog", "Hold"}

    @property
    def caps(self) -> frozenset[str]:
        """Threads need the controller's own encoder, which a third speed in its reports tells of; a surface
        speed needs a spindle of variable speed, or another than the controller's. A thread would put the
        override of the controller's spindle, by which that follows the radius, to 100 %.
        """
        report, own = self._c.report, self._c.config.own_spindle
        able = {"arc"} if report is None or report.measured is None else {"arc", "thread"}
        able |= set() if own else {"surface-thread"}
        return self.terminals() | able | ({"surface-speed"} if not own or self._c.varies else set())

    def fastest(self, dx: float, dz: float) -> float:
        """By the machine file, or by the controller's settings where these are less."""
        return self._along(dx, dz, lambda axis: min(axis.vmax, self._c.speed_of(axis.name) or axis.vmax))

    def lay_out(self, highest: float) -> None:
        """The spindle reads it when it is told its speed."""
        self.highest = highest

    @property
    def quiet(self) -> bool:
        """Whether nothing moves and nothing is left: lines that wait for a standstill may go."""
        return self._settled and not self._c.busy

    def submit(self, op: BlockOp) -> int | None:
        """Hand one block over; None while the controller's buffer is full. Raises DriverError.

        A thread also waits until the overrides are at 100 % and told so: under one of feed it would lag
        behind its lead.
        """
        c = self._c
        self._demand_ready()
        self.overrides.level = isinstance(op, ThreadOp)
        if self.overrides.level and not self.overrides.true_to(c.overrides):
            return None
        ticket = self._last + 1
        line = line_of(op, ticket, self._rapid(op), self.overrides.commanded[0] / 100.0, c.origin)
        if not c.stream.fits(line):
            return None
        c.send(line, ticket)
        self._last, self._settled, self._target = ticket, False, (op.x, op.z)
        self.rest = None
        if isinstance(op, ThreadOp):
            self._threads.add(ticket)
            c.index_wait = True
        return ticket

    def state(self) -> BlockState:
        """From the last report and what has been sent since."""
        c = self._c
        resting = self.quiet or c.lost or (c.fault != "" and self._dead())
        return BlockState(self._done, self._active, resting, self._holds.stands, self.hindrance())

    def hindrance(self) -> str:
        """Why nothing may be begun now."""
        return self._c.hindrance

    def hold(self) -> None:
        """0x82, at once: nobody may ask it in a thread pass, which the controller would leave half cut."""
        self._holds.begin()

    def resume(self) -> None:
        """0x81; the operator's word ends any hold."""
        self._holds.end()

    def abort(self) -> None:
        """To rest; the tickets are void."""
        self._holds.forget()
        if not self._c.lost and not (self._c.busy and self._c.doing == _ABORT):
            self._c.run(grblhal_scripts.abort(self._c), _ABORT)

    def override(self, feed: float, rapid: float) -> None:
        """Wanted from now on; sent and verified by ``pump``."""
        self.overrides.want(feed, rapid)

    def jog(self, axis: str, velocity: float, lease: float, limits: tuple[float, float] | None) -> bool:
        """Begin or renew."""
        if not self._jogs.active:
            self._demand_ready()
        moves = self._jogs.move(axis, velocity, lease, limits)
        if moves:
            self._settled, self.rest = False, None
        return moves

    def jog_to(self, axis: str, target: float, speed: float) -> None:
        """One step."""
        self._demand_ready()
        place = self.rest or (self._c.position.get("X", 0.0), self._c.position.get("Z", 0.0))
        self._jogs.step(axis, target, speed)
        self._settled, self.rest = False, None
        self._target = (target, place[1]) if axis == "X" else (place[0], target)

    def jog_stop(self) -> None:
        """0x85, and lines that it swallowed are settled."""
        if self._jogs.active or not self._settled:
            self._jogs.forget()
            self._settled = False
            self._c.realtime(grblhal_codes.JOG_CANCEL)
            if self._c.stream.quiet:
                self._c.question()
            else:
                self._c.run(grblhal_scripts.jog_end(self._c))

    def home(self, axis: str) -> None:
        """Look for its switch."""
        self._settled, self.rest = False, None
        self._c.run(grblhal_scripts.home(self._c, axis))

    def pump(self) -> None:
        """Once a tick, behind the conversation's own."""
        c = self._c
        self._jogs.pump()
        steady = self._threads or c.busy or not c.ready
        c.see_overrides(not self.overrides.true_to(c.overrides) and not steady)
        if not steady:
            self.overrides.correct(c.overrides, c.overrides_told, c.clock.now())

    def demand_power(self) -> None:
        """Raises DriverError while there is no leave to move."""
        demand_power("", self.powered)

    # --- inside -------------------------------------------------------------------------------------------

    def _rapid(self, op: BlockOp) -> float:
        """What G0 does on the way to there, mm/s: by the controller's limit of each slide (``planner.c``)."""
        at = self._c.position
        x, z = self._target or self.rest or (at.get("X", 0.0), at.get("Z", 0.0))
        return self._along(op.x - x, op.z - z, lambda axis: self._c.speed_of(axis.name) or axis.vmax)

    def _along(self, dx: float, dz: float, most: Callable[[GrblAxis], float]) -> float:
        """mm/s of a way on which no slide exceeds its ``most``; endless on one without length."""
        way = math.hypot(dx, dz)
        shares = {"X": abs(dx), "Z": abs(dz)}
        told = ((most(axis), shares.get(axis.name, 0.0)) for axis in self._c.wired)
        return min((speed * way / share for speed, share in told if share), default=math.inf)

    def _demand_ready(self) -> None:
        why = self.hindrance()
        if self._c.fault:
            raise DriverError(why, code_of(why, "controller-refuses"))  # the cause, and no more than that
        if why:
            raise DriverError(
                "the controller does not accept blocks: {why}", code_of(why, "controller-refuses"), why=why
            )
        self.demand_power()

    def _dead(self) -> bool:
        """An alarm has stopped everything, or the last report says that nothing moves."""
        c = self._c
        return not c.busy and (c.alarm != 0 or c.report is None or not c.report.moves)

    def _reported(self, report: Report) -> None:
        c = self._c
        empty = report.free is None or report.free >= c.most_free
        if report.state in {"Idle", "Alarm"} and c.stream.quiet and empty:
            self._finished(report)
        elif report.line is not None and report.line and self._last:
            self._active = self._last - (line_number(self._last) - report.line) % 9_000_000
            self._done = max(self._done, self._active - 1)
            self._threads = {ticket for ticket in self._threads if ticket > self._done}
            c.index_wait = bool(self._threads)
        self._holds.reported(report)

    def _finished(self, report: Report) -> None:
        """Everything has been moved to its end."""
        if self._target is not None and report.state == "Idle":
            self.rest = self._target
        self._target = None
        self._done, self._active, self._settled = self._last, 0, True
        self._threads.clear()
        self._c.index_wait = False
        self._jogs.rested()

    def _voided(self) -> None:
        """Stop, reset, alarm: no ticket holds any more, and where the slides stand is what is reported."""
        self._done, self._active, self._target, self.rest = self._last, 0, None, None
        self._threads.clear()
        self._settled = False
        self._jogs.forget()
