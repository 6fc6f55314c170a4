"""Block port of a grblHAL controller: sends blocks, feed holds, overrides and jogs."""

from __future__ import annotations

import math
from collections.abc import Callable

from core.block_ports import BlockOperation, BlockState, ThreadOperation
from core.faults import get_fault_code
from core.ports import DriverError
from drivers.grblhal import grblhal_codes, grblhal_scripts
from drivers.grblhal.grblhal_codes import format_block, get_ticket_line_number
from drivers.grblhal.grblhal_config import GrblAxis
from drivers.grblhal.grblhal_controller import GrblController
from drivers.grblhal.grblhal_operator import FeedHoldControl, GrblJogSender, GrblOverrides
from drivers.grblhal.grblhal_report import StatusReport
from drivers.port_checks import require_drive_power

QUEUED_TIME_S = 0.4  # Seconds of motion beyond the present block, which continue if the host is lost.
_ABORT_PURPOSE = "abort"


class GrblBlocks:
    """``core.block_ports.BlockController`` of one grblHAL controller.

    Only the thread of the executor may call the methods.
    """

    max_queued_motion_s = QUEUED_TIME_S

    def __init__(self, controller: GrblController) -> None:
        self._c = controller
        self.overrides = GrblOverrides(
            lambda data: controller.send_realtime_bytes(*data), controller.set_fault
        )
        self._jogs = GrblJogSender(controller)
        self._holds = FeedHoldControl(controller)
        self.is_motion_enabled = False  # Motion is permitted; set by ``GrblAxes``.
        self._last = 0  # ticket
        self._done = 0
        self._active = 0
        self._threads: set[int] = set()  # Tickets of thread passes that are not complete.
        self._settled = False  # A report after the last line shows that all blocks are complete.
        self._target: tuple[float, float] | None = None
        self.max_css_rpm = 0.0  # Highest rpm for constant surface speed; 0: constant rpm.
        self.css_max_rpm = 0.0 if controller.config.has_own_spindle else math.inf  # Set by ``GrblSpindle``.
        self.last_block_end: tuple[float, float] | None = None  # Exact end of the last block in X and Z.
        self.list_terminals: Callable[[], frozenset[str]] = (
            frozenset  # Capabilities of the inputs and outputs.
        )
        controller.on_status_report, controller.on_discard = self._reported, self._discard_tickets
        controller.are_blocks_settled = lambda: self._settled

    @property
    def can_accept_lines(self) -> bool:
        """Return whether the controller reads and executes lines.

        It does not read lines during a jog or a feed hold.
        """
        return self._c.is_ready and not self._jogs.is_active and self._c.state_name not in {"Jog", "Hold"}

    @property
    def capabilities(self) -> frozenset[str]:
        """Return the names of the ``machine_requirements`` that the controller meets.

        Threading needs an encoder at the controller, whose speed is the third speed in the reports.
        Constant surface speed needs a spindle with variable speed, or a spindle that the controller does
        not drive. Constant surface speed during threading needs a spindle that the controller does not
        drive, because the controller fixes its spindle override at 100 % during a threading pass.
        """
        report, own = self._c.report, self._c.config.has_own_spindle
        able = {"arc"} if report is None or report.measured is None else {"arc", "thread"}
        able |= set() if own else {"surface-thread"}
        return (
            self.list_terminals()
            | able
            | ({"surface-speed"} if not own or self._c.has_variable_speed else set())
        )

    def get_max_directional_speed(self, x_component: float, z_component: float) -> float:
        """Return the maximum speed in mm/s along a direction.

        The limit of each axis is the lower value of the machine file and the controller.
        """
        return self._directional_limit(
            x_component,
            z_component,
            lambda axis: min(axis.max_velocity, self._c.get_max_axis_speed(axis.name) or axis.max_velocity),
        )

    def announce_css_max_rpm(self, max_rpm: float) -> None:
        """Store the highest spindle speed in rpm for constant surface speed.

        If the value is 0, the spindle speed is constant instead.
        """
        self.max_css_rpm = max_rpm

    @property
    def is_at_standstill(self) -> bool:
        """Return whether the axes are at rest and no command is pending.

        In this state, lines that require a standstill can be sent.
        """
        return self._settled and not self._c.is_script_running

    def submit_block(self, block: BlockOperation) -> int | None:
        """Send one block and return its ticket number, or None if the block cannot be sent yet.

        The block must wait while the buffer of the controller is full. A threading block must also wait
        until the reported overrides are 100 %, because a feed override would change the lead. Raises
        DriverError if the controller is not ready or motion is not permitted.
        """
        c = self._c
        self._demand_ready()
        self.overrides.is_thread_active = isinstance(block, ThreadOperation)
        if self.overrides.is_thread_active and not self.overrides.are_overrides_confirmed(c.overrides):
            return None
        ticket = self._last + 1
        line = format_block(
            block,
            ticket,
            self._rapid_rate(block),
            self.overrides.commanded_override_percents[0] / 100.0,
            c.home_origin,
        )
        if not c.line_sender.can_send_now(line):
            return None
        c.send_line(line, ticket)
        self._last, self._settled, self._target = ticket, False, (block.x, block.z)
        self.last_block_end = None
        if isinstance(block, ThreadOperation):
            self._threads.add(ticket)
            c.waits_for_index = True
        return ticket

    def state(self) -> BlockState:
        """Return the execution state of the blocks.

        It is derived from the last report and from the lines that were sent after that report.
        """
        c = self._c
        resting = self.is_at_standstill or c.is_lost or (c.fault != "" and self._is_motion_ended())
        return BlockState(
            self._done, self._active, resting, self._holds.is_in_feed_hold, self.get_start_refusal_reason()
        )

    def get_start_refusal_reason(self) -> str:
        """Return the reason why no block can start, or an empty string if a block can start."""
        return self._c.motion_refusal_reason

    def stop_on_path(self) -> None:
        """Start a feed hold immediately (byte 82h).

        This method must not be called during a threading pass, because the axes would stop in the cut.
        """
        self._holds.start_feed_hold()

    def resume(self) -> None:
        """End the feed hold (byte 81h), even if it was started at the controller."""
        self._holds.end_feed_hold()

    def abort_blocks(self) -> None:
        """Stop the motion and discard all tickets."""
        self._holds.clear_hold_request()
        if not self._c.is_lost and not (
            self._c.is_script_running and self._c.script_purpose == _ABORT_PURPOSE
        ):
            self._c.start_script(grblhal_scripts.abort_and_verify_modes(self._c), _ABORT_PURPOSE)

    def set_overrides(self, feed_fraction: float, rapid_fraction: float) -> None:
        """Set the feed and rapid overrides as fractions.

        ``send_pending_commands`` later sends the overrides to the controller and verifies the reported
        values.
        """
        self.overrides.set_motion_overrides(feed_fraction, rapid_fraction)

    def start_jog(
        self, axis: str, velocity: float, lease_s: float, limits: tuple[float, float] | None
    ) -> bool:
        """Start or renew a jog, and return False if the axis is at the end of its travel.

        When a jog is started, raises DriverError if the controller is not ready or motion is not permitted.
        Renewing an active jog does not check this.
        """
        if not self._jogs.is_active:
            self._demand_ready()
        moves = self._jogs.start_or_renew_jog(axis, velocity, lease_s, limits)
        if moves:
            self._settled, self.last_block_end = False, None
        return moves

    def move_to_target(self, axis: str, target: float, speed: float) -> None:
        """Jog the axis to ``target`` in one step.

        Raises DriverError if the controller is not ready or motion is not permitted.
        """
        self._demand_ready()
        place = self.last_block_end or (self._c.position.get("X", 0.0), self._c.position.get("Z", 0.0))
        self._jogs.start_step_jog(axis, target, speed)
        self._settled, self.last_block_end = False, None
        self._target = (target, place[1]) if axis == "X" else (place[0], target)

    def stop_jog(self) -> None:
        """Stop the jog (byte 85h), and wait for the replies to lines that the controller has discarded."""
        if self._jogs.is_active or not self._settled:
            self._jogs.clear_jog()
            self._settled = False
            self._c.send_realtime_bytes(grblhal_codes.JOG_CANCEL)
            if self._c.line_sender.is_idle:
                self._c.request_report()
            else:
                self._c.start_script(grblhal_scripts.finish_canceled_jog(self._c))

    def start_homing(self, axis: str) -> None:
        """Start to home an axis, which the controller does on its own."""
        self._settled, self.last_block_end = False, None
        self._c.start_script(grblhal_scripts.home_axis(self._c, axis))

    def send_pending_commands(self) -> None:
        """Send jogs and overrides; call this method once per tick after the cycle of the controller."""
        c = self._c
        self._jogs.send_remaining_travel()
        steady = self._threads or c.is_script_running or not c.is_ready
        c.set_override_reports_enabled(not self.overrides.are_overrides_confirmed(c.overrides) and not steady)
        if not steady:
            self.overrides.send_override_steps(c.overrides, c.override_report_count, c.clock.now())

    def require_motion_enabled(self) -> None:
        """Raise DriverError unless motion is permitted."""
        require_drive_power("", self.is_motion_enabled)

    # --- inside -------------------------------------------------------------------------------------------

    def _rapid_rate(self, op: BlockOperation) -> float:
        """Return the speed in mm/s at which G0 would move to the end of a block.

        The axis limits of the controller determine this speed, as in ``planner.c`` of grblHAL.
        """
        at = self._c.position
        x, z = self._target or self.last_block_end or (at.get("X", 0.0), at.get("Z", 0.0))
        return self._directional_limit(
            op.x - x, op.z - z, lambda axis: self._c.get_max_axis_speed(axis.name) or axis.max_velocity
        )

    def _directional_limit(self, dx: float, dz: float, max_speed: Callable[[GrblAxis], float]) -> float:
        """Return the highest speed in mm/s along a direction at which no axis exceeds its ``max_speed``.

        Return inf for a move of zero length.
        """
        distance_mm = math.hypot(dx, dz)
        shares = {"X": abs(dx), "Z": abs(dz)}
        axis_limits = ((max_speed(axis), shares.get(axis.name, 0.0)) for axis in self._c.wired_axes)
        return min((speed * distance_mm / share for speed, share in axis_limits if share), default=math.inf)

    def _demand_ready(self) -> None:
        why = self.get_start_refusal_reason()
        if self._c.fault:
            raise DriverError(why, get_fault_code(why, "controller-refuses"))  # Report only the cause.
        if why:
            raise DriverError(
                "the controller does not accept blocks: {why}",
                get_fault_code(why, "controller-refuses"),
                why=why,
            )
        self.require_motion_enabled()

    def _is_motion_ended(self) -> bool:
        """Return whether an alarm has stopped all motion, or the last report shows no motion."""
        c = self._c
        return not c.is_script_running and (c.alarm_number != 0 or c.report is None or not c.report.moves)

    def _reported(self, report: StatusReport) -> None:
        c = self._c
        empty = report.free is None or report.free >= c.max_free_blocks
        if report.state in {"Idle", "Alarm"} and c.line_sender.is_idle and empty:
            self._update_tickets(report)
        elif report.line is not None and report.line and self._last:
            self._active = self._last - (get_ticket_line_number(self._last) - report.line) % 9_000_000
            self._done = max(self._done, self._active - 1)
            self._threads = {ticket for ticket in self._threads if ticket > self._done}
            c.waits_for_index = bool(self._threads)
        self._holds.process_report(report)

    def _update_tickets(self, report: StatusReport) -> None:
        """Mark all tickets as complete after a report of state Idle or Alarm with an empty queue."""
        if self._target is not None and report.state == "Idle":
            self.last_block_end = self._target
        self._target = None
        self._done, self._active, self._settled = self._last, 0, True
        self._threads.clear()
        self._c.waits_for_index = False
        self._jogs.handle_standstill()

    def _discard_tickets(self) -> None:
        """Discard all tickets after a stop, reset or alarm; then only the reported position is valid."""
        self._done, self._active, self._target, self.last_block_end = self._last, 0, None, None
        self._threads.clear()
        self._settled = False
        self._jogs.clear_jog()
