"""Why a cycle may not start: every reason, in the order in which an operator has to remove them."""

from __future__ import annotations

from core.executor.bench import Bench
from core.executor.job import Job, Proof
from core.executor.snapshot import State
from core.interpreter.machine_requirements import THREAD

_BUSY = {
    State.ESTOP: "E-stop is pressed: release it",
    State.FAULT: "an alarm stands: clear its cause and press Reset",
    State.DISABLED: "the drives are off: switch them on",
    State.JOG: "the machine is being jogged",
    State.HOME: "the machine is homing",
}


def guard_open(bench: Bench) -> bool:
    """Whether the guard is open at a machine whose file says that it stops the cycle; off is open."""
    return bench.machine.interlocks.guard_stops and not bench.inputs.get("guard", False)


def busy(bench: Bench) -> str:
    """What at the station keeps a cycle from going on."""
    if bench.heard.hold:
        return "feed hold is pressed"
    if guard_open(bench):
        return "the guard is open: close it"
    return bench.heard.trouble.lower()


def unclamped(bench: Bench) -> str:
    """Why the spindle may not be started as the collet is; empty when it may."""
    if bench.machine.interlocks.spindle_with_collet_open or bench.inputs.get("collet_closed", True):
        return ""
    return "the spindle is not started with the collet open: close it first"


def hindrance(bench: Bench, state: State) -> str:
    """What keeps any cycle from being started at this machine now."""
    if state in _BUSY:
        return _BUSY[state]
    if busy(bench):
        return busy(bench)
    if bench.ports.blocks is not None and bench.ports.blocks.state().hindrance:
        return bench.ports.blocks.state().hindrance
    away = [a.name for a, homed in zip(bench.machine.axes, bench.sample.homed, strict=True) if not homed]
    if away:
        return f"{', '.join(away)} must be homed first"
    return ""


def refusal(bench: Bench, state: State, job: Job | None, proof: Proof | None) -> str:
    """Why this job may not be started now; empty when it may."""
    return hindrance(bench, state) or unproved(job, proof) or beyond(bench, proof)


def beyond(bench: Bench, proof: Proof | None) -> str:
    """What the program asks for and this machine cannot do; empty when nothing."""
    blocks = bench.ports.blocks
    for need in proof.needs if proof is not None else ():
        if blocks is not None and need.what not in blocks.caps:
            return f"line {need.line}: this controller cannot do {need.words}"
        if blocks is None and need.what == THREAD and bench.ports.spindle.angle() is None:
            return f"line {need.line}: a thread needs an encoder on the spindle, and there is none"
    return ""


def unproved(job: Job | None, proof: Proof | None) -> str:
    """What proving leaves to be done before this job may be started; empty when nothing."""
    if job is None:
        return "no program is loaded"
    if proof is None:
        return "the program is not proved yet"
    if proof.digest != job.digest:
        return "the proof belongs to another program or to other offsets: load it again"
    if proof.errors:
        return f"the program has errors: {proof.errors[0]}"
    missing = sorted(set(proof.tools) - job.tools_set)
    if missing:
        return f"tool offset {', '.join(f'T{number}' for number in missing)} has never been set"
    return ""
