"""Warnings before a start: a waiting spindle, findings of the proof, and a risky first move."""

from __future__ import annotations

from collections.abc import Iterator

from core.executor import start_conditions
from core.executor.control_status import ControlStatus, Counters
from core.executor.machine_context import MachineContext
from core.executor.snapshot import MANUAL_STATES, MDI_ACTIONS, STOPPED_STATES, MachineState
from core.executor.start_conditions import SPINDLE_FUNCTION, AnnouncedFunction
from core.message import Message

_REST_STATES = frozenset({MachineState.IDLE, MachineState.DISABLED})


class StartWarnings:
    """Warnings that the operator must read before the next start."""

    def __init__(self, context: MachineContext, status: ControlStatus, counters: Counters) -> None:
        self._context, self._status, self._counters = context, status, counters

    def iter_spindle_starts(self) -> Iterator[AnnouncedFunction]:
        """Yield the announcement of a waiting spindle that the next start will turn on.

        In a cycle, only Cycle Start turns the spindle on. If no cycle is active, turning the spindle switch
        to AUTO also does.
        """
        spindle = self._context.spindle
        rpm, by_hand = spindle.waiting_start_rpm, self._status.state in MANUAL_STATES
        if rpm and (by_hand or (self._status.state in STOPPED_STATES and not spindle.start_inhibit_reason)):
            direction = "FORWARD" if rpm > 0.0 else "REVERSE"
            text = Message(
                "SPINDLE STARTS AT {rpm} RPM {direction}", rpm=f"{abs(rpm):.0f}", direction=direction
            )
            yield AnnouncedFunction(
                SPINDLE_FUNCTION,
                text if spindle.is_auto else Message("SET SPINDLE SWITCH TO AUTO: {start}", start=text),
                spindle.permit_start,
                rpm,
            )

    def iter_proof_warnings(self) -> Iterator[AnnouncedFunction]:
        """Yield the warnings of the proof, which the operator must read before the program starts."""
        status = self._status
        job, proof = status.job, status.proof
        if (
            status.state not in _REST_STATES
            or status.start_action in MDI_ACTIONS
            or job is None
            or proof is None
        ):
            return
        # otherwise the start is refused anyway
        if proof.digest == job.digest and proof.warnings and not proof.errors:
            first, more = proof.warnings[0], len(proof.warnings) - 1
            said = Message("{first_error} ({more} MORE)", first_error=first, more=more) if more else first
            yield AnnouncedFunction(
                "warned" + job.digest, Message("WARNING: {warned}", warned=said), lambda: None
            )

    def iter_first_move_warnings(self) -> Iterator[AnnouncedFunction]:
        """Yield the warning that the first move may hit a part whose shape is unknown or only assumed."""
        if self._status.state not in _REST_STATES or not self._status.requires_start_clearance:
            return
        found = start_conditions.find_first_move_clearance(
            self._context, self._status, self._counters.started_run_count
        )
        if found is not None and found.warned:
            yield AnnouncedFunction(
                "first-move" + found.job, Message("WARNING: {warned}", warned=found.warned), lambda: None
            )
