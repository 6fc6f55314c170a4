"""A job read and interpreted under the circumstances of its start."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

from core.executor.feed import Pass
from core.executor.job import Job
from core.interpreter.dialects import line_alone
from core.interpreter.job_setup import Setup


def interpret(job: Job, setup: Setup) -> Pass:
    """One pass; its blocks end at the first error, which ``problems`` then tells."""
    if setup.begin is not None and setup.begin.single:
        line = line_alone(job.source, setup)
        return Pass(line.blocks(to_first_error=True), lambda: line.diagnostics, lambda: line.checkpoint)
    interpreter = job.reading.begin(setup)
    return Pass(interpreter.blocks(to_first_error=True), lambda: interpreter.diagnostics)


def circumstances(setup: Setup, start: tuple[float, ...], inputs: Callable[[str], bool]) -> Setup:
    """The job's setup at this machine now: from where the slides stand, with its inputs live."""
    return dataclasses.replace(setup, start=start, inputs=inputs)
