"""Where a Klartext program goes next: calls of subprograms, repeats of sections."""

from __future__ import annotations

from dataclasses import dataclass, field

from core.interpreter.klartext.program import Program, shown
from core.language.klartext import faults
from core.language.klartext.nodes import Call, Label

DEEPEST_CALL = 19


@dataclass(slots=True)
class _Level:
    """One subprogram under way: where to go on, and the repeats still to do by the line of their call."""

    back: int
    left: dict[int, int] = field(default_factory=dict)


class Flow:
    """``at`` is the index of the line to execute next, ``end`` that of END PGM."""

    def __init__(self, program: Program) -> None:
        self.at = 0
        self.end = program.end
        self._labels = program.labels
        self._levels = [_Level(back=program.end)]

    def call(self, line: int, node: Call) -> None:
        """CALL LBL. Raises ProgramError for calls nested too deep."""
        target = self._labels.get(node.name)
        if target is None:
            return  # told when the program was read
        if node.repeat is not None:
            self._repeat(line, target, node.repeat)
            return
        if len(self._levels) > DEEPEST_CALL:
            text = f"Calls are nested more than {DEEPEST_CALL} deep at LBL {shown(node.name)}."
            hint = "A subprogram must not call itself."
            raise faults.fault(line, node.column, faults.NESTING, text, hint)
        self._levels.append(_Level(back=self.at))
        self.at = target + 1

    def label(self, node: Label) -> None:
        """LBL: 0 ends the subprogram under way, others mark a place."""
        if node.name == 0 and len(self._levels) > 1:
            self.at = self._levels.pop().back

    def _repeat(self, line: int, target: int, times: int) -> None:
        left = self._levels[-1].left
        still = left.get(line, times)
        if still > 0:
            left[line] = still - 1
            self.at = target + 1
        else:
            left.pop(line, None)
