"""The modal state between two programs: what the last one left, and what the machine really does."""

from __future__ import annotations

from collections.abc import Mapping

from core.executor.bench import Bench
from core.interpreter.job_setup import SecondaryOffset, ToolOffset
from core.interpreter.modal_state import Modal
from core.interpreter.omniturn.carry_over import after_end


def at_power_up(bench: Bench) -> Modal:
    """The state that the control is switched on with: it counts in what the machine's builder counts in."""
    machine = bench.machine
    return as_it_is(Modal(metric=not machine.inch, rapid_rate=machine.manual_rapid), bench)


def given_up(modal: Modal) -> Modal:
    """A program that was reset, or ended by an alarm or the E-stop, leaves what M30 would have left."""
    return after_end(modal, modal.rpm, reset=True)


def interrupted(modal: Modal) -> Modal:
    """A line of MDI that was reset, or ended by an alarm, leaves its modes; nothing holds C any more."""
    return modal._replace(c_locked=False, c_rpm=None)


def as_it_is(modal: Modal, bench: Bench) -> Modal:
    """M functions as they are at the machine: an alarm, a reset or a hand may have switched them since.

    A stopped spindle releases C; nose compensation and plane switching never outlive their program.
    """
    on = {name for name, lit in bench.ports.io.outputs().items() if lit}
    assigned = {name for name, _ in bench.machine.m_codes.values()}
    asked = bench.spindle.asked
    return modal._replace(
        spindle=modal.spindle if asked else 0,
        c_locked=modal.c_locked and not asked,
        coolant="coolant" in on,
        collet_closed="collet" in on if "collet" in bench.machine.outputs else modal.collet_closed,
        outputs=frozenset(on & assigned),
        nose_comp=40,
        mill=None,
    )


def with_offsets(
    modal: Modal, tools: Mapping[int, ToolOffset], secondary: Mapping[int, SecondaryOffset]
) -> Modal:
    """The same state with the offsets of the loaded tool and of the D in force read from these tables."""
    tool = tools.get(modal.tool, ToolOffset()) if modal.tool else ToolOffset()
    pair = secondary.get(modal.secondary, SecondaryOffset()) if modal.secondary else SecondaryOffset()
    return modal._replace(tool_x=tool.x, tool_z=tool.z, secondary_x=pair.x, secondary_z=pair.z)
