"""Other offsets and the part: what a program makes with them, feature by feature, and what is found then.

Tools stand where the offsets of the proof say that they do; with the others in force the slides bring them
elsewhere, and the part comes out as much larger, smaller, longer or shorter.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

from core.interpreter.dialects import ReadProgram
from core.interpreter.job_setup import Setup
from core.language.diagnostics import Diagnostic
from core.language.source import Source
from core.machine.machine_model import Machine
from core.proving.part_features import Pair, features, matched
from core.proving.part_proof import prove_with_part
from core.proving.part_report import PartReport
from core.proving.part_setting import PartSetting
from core.proving.proof_report import Report
from core.proving.prove_program import Progress

FINE = 0.001
"""Width of a column of the part, mm, where parts are compared: a shoulder is off by .00002 in at most."""

SAME = 0.0012  # mm; less is no difference


@dataclass(frozen=True, slots=True)
class OtherPart:
    """What the other offsets make: its proof and part, the features of both, and findings of one alone."""

    report: Report
    part: PartReport | None
    pairs: tuple[Pair, ...]
    gone: tuple[Diagnostic, ...]
    added: tuple[Diagnostic, ...]

    @property
    def differing(self) -> int:
        """How many features differ, or have none like them."""
        return sum(pair.difference is None or abs(pair.difference) > SAME for pair in self.pairs)


@dataclass(frozen=True, slots=True)
class ThisPart:
    """A program as it was proved: its setup, what was said of its part, and what came of it."""

    setup: Setup
    setting: PartSetting
    report: Report
    part: PartReport | None


def other_part(
    program: Source | ReadProgram, this: ThisPart, there: Setup, machine: Machine,
    watch: Progress | None = None, *, ideal: bool = False,
) -> OtherPart:  # fmt: skip
    """The same program, stock and tools with the offsets of ``there``; ``watch`` may give up."""
    setting = this.setting
    if this.part is not None:
        setting = replace(setting, stock=this.part.stock, tips=_tips(this.setup))
    report, part = prove_with_part(program, there, machine, setting, watch, ideal=ideal, watch=watch)
    pairs: list[Pair] = []
    if this.part is not None and part is not None:
        parts = [each.last for each in (this.part, part)]
        pairs = matched(*([] if each is None else features(each) for each in parts))
    gone, added = _only(this.report.diagnostics, report.diagnostics)
    return OtherPart(report, part, tuple(pairs), gone, added)


def _tips(setup: Setup) -> dict[int, tuple[float, float]]:
    """Where the tips stand on part zero, by T and by G54 to G59."""
    own = {n: (tool.x, tool.z) for n, tool in setup.tools.items()}
    return own | {n: (zero.x, zero.z) for n, zero in setup.zero.items()}


def _only(
    here: Iterable[Diagnostic], there: Iterable[Diagnostic]
) -> tuple[tuple[Diagnostic, ...], tuple[Diagnostic, ...]]:
    """The findings that only one of them has: figures in a sentence may differ, place and code may not."""

    def key(each: Diagnostic) -> tuple[int, str]:
        return each.line, each.code

    ours, theirs = {key(each) for each in here}, {key(each) for each in there}
    return tuple(d for d in here if key(d) not in theirs), tuple(d for d in there if key(d) not in ours)
