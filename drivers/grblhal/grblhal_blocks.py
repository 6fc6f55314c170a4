"""Block port of a grblHAL controller, with tickets, feed holds, overrides and jogs."""

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

AHEAD = 0.4  # Seconds of motion beyond the present block, which continue if the host is lost.
_ABORT = "abort"


class GrblBlocks:
    """``core.ports.BlockSink`` of one controller, called by the executor's thread only."""

    ahead = AHEAD

    def __init__(self, controller: Controller) -> None:
        self._c = controller
        self.overrides = Overrides(lambda data: controller.realtime(*data), controller.fail)
        self._jogs = Jogs(controller)
        self._holds = Holds(controller)
        self.powered = False  # Motion is permitted; set by ``GrblAxes``.
        self._last = 0  # ticket
        self._done = 0
        self._active = 0
        self._threads: set[int] = set()  # Tickets of thread passes that are not complete.
        self._settled = False  # A report after the last line shows that all blocks are complete.
        self._target: tuple[float, float] | None = None
        self.highest = 0.0  # Highest rpm for constant surface speed; 0: constant rpm.
        self.reach = 0.0 if controller.config.own_spindle else math.inf  # Set by ``GrblSpindle``.
        self.rest: tuple[float, float] | None = None  # Exact end of the last block in X and Z.
        self.terminals: Callable[[], frozenset[str]] = frozenset  # Capabilities of the inputs and outputs.
        controller.on_report, controller.on_void = self._reported, self._voided
        controller.settled = lambda: self._settled

    @property
    def listens(self) -> bool:
        """Whether the controller reads and executes lines, which is not the case in a jog or feed hold."""
        return self._c.ready and not self._jogs.active and self._c.state not in {"Jog", "Hold"}

    @property
    def caps(self) -> frozenset[str]:
        """The requirements that the controller meets, as named in ``machine_requirements``.

        Threads need an encoder at the controller, which appears as a third speed in its reports. A constant
        surface speed needs a variable spindle, or a spindle that the controller does not drive. A thread sets
        the spindle override to 100 %, so that the controller's own spindle cannot follow the radius in a
        thread.
        """
        report, own = self._c.report, self._c.config.own_spindle
        able = {"arc"} if report is None or report.measured is None else {"arc", "thread"}
        able |= set() if own else {"surface-thread"}
        return self.terminals() | able | ({"surface-speed"} if not own or self._c.varies else set())

    def fastest(self, dx: float, dz: float) -> float:
        """Return the speed limit in mm/s along a direction.

        The limit is the lower of the machine file's and the controller's.
        """
        return self._along(dx, dz, lambda axis: min(axis.vmax, self._c.speed_of(axis.name) or axis.vmax))

    def lay_out(self, highest: float) -> None:
        """Store the highest speed in rpm for constant surface speed, or 0 for a constant speed."""
        self.highest = highest

    @property
    def quiet(self) -> bool:
        """Whether nothing moves and nothing is pending, so that lines which need a standstill can be sent."""
        return self._settled and not self._c.busy

    def submit(self, op: BlockOp) -> int | None:
        """Send one block and return its ticket, or None while the controller's buffer is full.

        Raises DriverError if the controller is not ready. A thread also waits until the reported overrides
        are 100 %, because a feed override would change the lead.
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
        """Return the state of the blocks by the last report and the lines sent since then."""
        c = self._c
        resting = self.quiet or c.lost or (c.fault != "" and self._dead())
        return BlockState(self._done, self._active, resting, self._holds.stands, self.hindrance())

    def hindrance(self) -> str:
        """Return the reason why no block can be started, or an empty text."""
        return self._c.hindrance

    def hold(self) -> None:
        """Start a feed hold immediately (0x82).

        The caller must not do so in a thread pass, because the controller would stop within the cut.
        """
        self._holds.begin()

    def resume(self) -> None:
        """End any feed hold (0x81), also one that was started at the controller."""
        self._holds.end()

    def abort(self) -> None:
        """Stop the motion and discard all tickets."""
        self._holds.forget()
        if not self._c.lost and not (self._c.busy and self._c.doing == _ABORT):
            self._c.run(grblhal_scripts.abort(self._c), _ABORT)

    def override(self, feed: float, rapid: float) -> None:
        """Set the feed and rapid overrides as fractions; ``pump`` sends and verifies them."""
        self.overrides.want(feed, rapid)

    def jog(self, axis: str, velocity: float, lease: float, limits: tuple[float, float] | None) -> bool:
        """Start or renew a jog.

        Return False at the end of the travel. Raises DriverError if the controller is not ready.
        """
        if not self._jogs.active:
            self._demand_ready()
        moves = self._jogs.move(axis, velocity, lease, limits)
        if moves:
            self._settled, self.rest = False, None
        return moves

    def jog_to(self, axis: str, target: float, speed: float) -> None:
        """Jog by one step to ``target``. Raises DriverError if the controller is not ready."""
        self._demand_ready()
        place = self.rest or (self._c.position.get("X", 0.0), self._c.position.get("Z", 0.0))
        self._jogs.step(axis, target, speed)
        self._settled, self.rest = False, None
        self._target = (target, place[1]) if axis == "X" else (place[0], target)

    def jog_stop(self) -> None:
        """Stop the jog (0x85), and wait for the replies to lines that the controller has discarded."""
        if self._jogs.active or not self._settled:
            self._jogs.forget()
            self._settled = False
            self._c.realtime(grblhal_codes.JOG_CANCEL)
            if self._c.stream.quiet:
                self._c.question()
            else:
                self._c.run(grblhal_scripts.jog_end(self._c))

    def home(self, axis: str) -> None:
        """Start to home an axis."""
        self._settled, self.rest = False, None
        self._c.run(grblhal_scripts.home(self._c, axis))

    def pump(self) -> None:
        """Send jogs and overrides; called once per tick after the controller's own cycle."""
        c = self._c
        self._jogs.pump()
        steady = self._threads or c.busy or not c.ready
        c.see_overrides(not self.overrides.true_to(c.overrides) and not steady)
        if not steady:
            self.overrides.correct(c.overrides, c.overrides_told, c.clock.now())

    def demand_power(self) -> None:
        """Raise DriverError while motion is not permitted."""
        demand_power("", self.powered)

    # --- inside -------------------------------------------------------------------------------------------

    def _rapid(self, op: BlockOp) -> float:
        """Return the speed of G0 to the end of a block in mm/s.

        The controller's axis limits apply, as in ``planner.c``.
        """
        at = self._c.position
        x, z = self._target or self.rest or (at.get("X", 0.0), at.get("Z", 0.0))
        return self._along(op.x - x, op.z - z, lambda axis: self._c.speed_of(axis.name) or axis.vmax)

    def _along(self, dx: float, dz: float, most: Callable[[GrblAxis], float]) -> float:
        """Return the speed in mm/s at which no axis exceeds ``most``; inf for a move without length."""
        way = math.hypot(dx, dz)
        shares = {"X": abs(dx), "Z": abs(dz)}
        told = ((most(axis), shares.get(axis.name, 0.0)) for axis in self._c.wired)
        return min((speed * way / share for speed, share in told if share), default=math.inf)

    def _demand_ready(self) -> None:
        why = self.hindrance()
        if self._c.fault:
            raise DriverError(why, code_of(why, "controller-refuses"))  # Report only the cause.
        if why:
            raise DriverError(
                "the controller does not accept blocks: {why}", code_of(why, "controller-refuses"), why=why
            )
        self.demand_power()

    def _dead(self) -> bool:
        """Return whether an alarm has stopped all motion, or the last report shows no motion."""
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
        """Mark all blocks as complete."""
        if self._target is not None and report.state == "Idle":
            self.rest = self._target
        self._target = None
        self._done, self._active, self._settled = self._last, 0, True
        self._threads.clear()
        self._c.index_wait = False
        self._jogs.rested()

    def _voided(self) -> None:
        """Discard all tickets after a stop, reset or alarm; the position is the reported one."""
        self._done, self._active, self._target, self.rest = self._last, 0, None, None
        self._threads.clear()
        self._settled = False
        self._jogs.forget()
