"""Wear and other offsets changed under a program: proved while it runs, in force from the next part on."""

from __future__ import annotations

from core.executor import start_conditions
from core.executor.commands import Renew
from core.executor.control_status import ControlStatus, modal_with_offsets
from core.executor.job import Job, outdated
from core.executor.machine_context import MachineContext
from core.interpreter.modal_state import Modal


class ChangedOffsets:
    """The program under way with other offsets, at most one; the part under way keeps those that it has.

    What was asked for must be proved before anything of the program moves again: with Cycle Repeat the next
    part waits for it, and a program that does not pass the proof with the new offsets is not repeated.
    """

    def __init__(self, context: MachineContext) -> None:
        self._context = context
        self._asked: Renew | None = None

    @property
    def wanted(self) -> bool:
        """Whether the next part begins with other offsets."""
        return self._asked is not None

    @property
    def pending(self) -> bool:
        """Whether the proof is still to come."""
        return self._asked is not None and self._asked.proof is None and not self._asked.trouble

    def ask(self, asked: Renew, running: Job | None) -> str:
        """Keep them for the end of the part; returns why not, empty when they are kept."""
        job = asked.job
        if job is not None and (running is None or job.source.text != running.source.text):
            return (
                "another program is running; changed offsets apply only to the program for which "
                "they were entered"
            )
        self._asked = asked
        return ""

    def refusal(self, left: Modal) -> str:
        """Why the program is not repeated with what was asked for; empty without a reason."""
        asked = self._asked
        if asked is None:
            return ""
        if asked.trouble or asked.job is None:
            return asked.trouble
        why = start_conditions.unproved(asked.job, asked.proof) or start_conditions.lacking(
            self._context, asked.proof
        )
        return why or outdated(asked.job, left)

    def take_up(self, status: ControlStatus) -> None:
        """Between two parts, or when the program is over: what was asked for is the program now.

        Without its proof nothing can be started: the old offsets are not those of the tables any more.
        """
        asked, self._asked = self._asked, None
        if asked is None:
            return
        status.proof = asked.proof
        if asked.job is not None:
            setup = asked.job.setup
            status.job = asked.job
            status.modal = modal_with_offsets(status.modal, setup.tools, setup.secondary)
            self._context.log("offsets", "the changed offsets are in effect")

    def forget(self) -> None:
        """Another program is loaded: nothing is asked for any more."""
        self._asked = None
