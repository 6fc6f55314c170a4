"""What the part and each of its checks cost in the proof of a program of 200 blocks, warm.

Run with ``python -m tests.benchmarks.bench_checks``.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from unittest import mock

from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import create_power_up_setup
from app.compose.part_data import make_part_settings
from core.interpreter.shared.job_setup import ToolOffset
from core.language.source import ProgramSource
from core.part.cutter import Cutter
from core.part.stock import Clamping
from core.part.tool_shape import ToolKind, ToolShape
from core.part.turned_part import NO_CUT, Cut
from core.proving.checks.cut_checks import AirCutChecks
from core.proving.checks.edge_checks import EdgeChecks
from core.proving.checks.part_findings import PartFindings
from core.proving.checks.thread_checks import ThreadChecks
from core.proving.part_proof import prove_program_and_part
from core.proving.program_tools import PartSettings
from core.proving.prove_program import prove

ROUNDS = 15
SHAPES = {
    1: ToolShape(ToolKind.TURNING, tip=3, nose_radius=0.4, insert="DCMT11T304", holder="16x16"),
    2: ToolShape(ToolKind.PARTING, tip=3, width=2.0, stick_out=30.0),
    3: ToolShape(ToolKind.DRILL, diameter=6.0, point=118.0, length=40.0),
}


def _none(*_args: object, **_words: object) -> tuple[()]:
    return ()


def _no_metal(*_args: object) -> Cut:
    return NO_CUT


# What is left out, by the name of the row; a holder is that of each move.
CHECKS: dict[str, tuple[tuple[type, str, object], ...]] = {
    "slips: what meets no metal": ((AirCutChecks, "feed", _none), (AirCutChecks, "rapid", _none)),
    "edge: side, feed, direction": ((EdgeChecks, "look", _none),),
    "threads and taps": ((ThreadChecks, "look", _none), (ThreadChecks, "before", _none)),
    "holder into metal": ((Cutter, "strikes", _no_metal),),
    "chuck, its speed, whirling": ((PartFindings, "_clamped", _none),),
}


def program() -> str:
    """200 blocks: passes of one tool, as they are most of every program."""
    lines, x = ["G90G94F300G72", "T1", "M03S1500"], 1.0
    while len(lines) < 199:
        x -= 0.01
        lines += [f"X{x:.3f}Z.05", "G95F.005Z-.9", f"X{x + 0.1:.3f}", "G94F300Z.05"]
    return "\n".join([*lines[:199], "M30", ""])


def spent(work: Callable[[], object]) -> float:
    """The least of some rounds, ms of processor time."""
    best = float("inf")
    for _ in range(ROUNDS):
        began = time.process_time()
        work()
        best = min(best, time.process_time() - began)
    return best * 1e3


@contextmanager
def without(parts: tuple[tuple[type, str, object], ...]) -> Iterator[None]:
    """These functions do nothing."""
    if not parts:
        yield
        return
    kind, name, instead = parts[0]
    with mock.patch.object(kind, name, instead), without(parts[1:]):
        yield


def main() -> int:
    """Prints the table."""
    machine = load_machine(None)
    tools = {n: ToolOffset(-12.7 - 60.0 * (n - 1), -50.8) for n in SHAPES}
    setup = create_power_up_setup(machine, tool_offsets=tools, secondary_offsets={})
    known = make_part_settings(machine, tools, SHAPES)
    setting = replace(known, clamping=Clamping(100.0, 40.0, 10.0, 60.0, 5000.0))
    text = ProgramSource("CHECKS", program())

    def proved(by: PartSettings) -> float:
        return spent(lambda: prove_program_and_part(text, setup, machine, by))

    plain, whole = spent(lambda: prove(text, setup, machine)), proved(setting)
    rows = [("the proof without the part", plain), ("with the part and all checks", whole)]
    rows.append(("of it the neighbours on the plate", whole - proved(replace(setting, gang={}))))
    for name, parts in CHECKS.items():
        with without(parts):
            rows.append((f"of it {name}", whole - proved(setting)))
    for name, milliseconds in rows:
        sys.stdout.write(f"{name:42} {milliseconds:6.2f} ms\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
