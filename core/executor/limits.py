"""What a block must hold before it may move: checked once more when it is read for running."""

from __future__ import annotations

from core.executor.alarms import TroubleError
from core.interpreter.elementary_blocks import Block, Kind
from core.machine.model import Axis, Machine

_ROUNDING = 1e-6  # mm


def check_block(block: Block, machine: Machine) -> None:
    """Raises TroubleError for a move out of the travel, one fed by the turns of a spindle that stands, and
    one of C while the spindle that is C turns.
    """
    if not block.moves:
        return
    if block.per_rev and block.kind is not Kind.RAPID and block.rpm == 0.0 and block.c == block.c0:
        raise TroubleError("spindle-still", f"line {block.line} feeds by the revolution", block.line)
    if block.c != block.c0 and block.modal.spindle and machine.spindle_is_c:
        raise TroubleError("c-is-spindle", f"line {block.line} moves C while the spindle turns", block.line)
    for axis, (low, high) in zip(machine.axes, block.machine_reach(), strict=True):
        _check(block, axis, low, high)


def _check(block: Block, axis: Axis, low: float, high: float) -> None:
    if axis.travel is None:
        return
    if low < axis.travel[0] - _ROUNDING or high > axis.travel[1] + _ROUNDING:
        unit = "degrees" if axis.rotary else "mm"
        far = low if low < axis.travel[0] else high
        raise TroubleError(
            "travel", f"line {block.line} moves {axis.name} to {far:.3f} {unit} from home", block.line
        )
