"""Whole programs of Klartext and SINUMERIK against tables worked out by hand.

``tests/programs/klartext/NAME.h`` and ``tests/programs/sinumerik/NAME.mpf``, each with ``NAME.expected``: one
row for each elementary block, ``line what …``, in mm, degrees and mm/min, in the program's own system::

    5 feed 15 0 -5 F 300
    6 arc 20 5 -5 way 7.853982 F 300
    5 arc 15 -15 centre 15 -10 F 100

Klartext tells X Y Z of the working plane, and the length of an arc; a corner of RND and CHF is told by the
element behind it. SINUMERIK tells X (a radius) Z and the centre of an arc. With ``# axes`` rotary axes stand
behind; a PLANE block tells these alone. Findings as in ``test_golden.py``.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from app.compose.machine.machine_files import load_shipped_machine
from app.compose.machine.machine_setup import create_power_up_setup
from core.interpreter.dialects import SharedProgram
from core.interpreter.shared.job_setup import ToolOffset
from core.language.diagnostics import Severity
from core.language.source import Dialect, ProgramSource
from tests.dialects.golden_rows import row, same

PROGRAMS = Path(__file__).parents[1] / "programs"
FILES = sorted([*PROGRAMS.glob("klartext/*.h"), *PROGRAMS.glob("sinumerik/*.mpf")])
MACHINE = {Dialect.KLARTEXT: "ac-table-mill", Dialect.SINUMERIK: "sinumerik-modulo"}


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_program_produces_blocks_of_its_table(path: Path) -> None:
    table = path.with_suffix(".expected").read_text("utf-8").splitlines()
    axes = "# axes" in table
    findings = [text for text in table if text.split()[0] in set(Severity)]
    blocks = [text.split() for text in table if text.split()[0].isdigit()]
    assert len(findings) + len(blocks) + axes == len(table), "a row that says nothing"
    source = ProgramSource(path.name, path.read_text("utf-8"))
    machine = load_shipped_machine(MACHINE[source.dialect])
    run = SharedProgram(source).start_pass(
        create_power_up_setup(machine, tool_offsets={1: ToolOffset()}, secondary_offsets={})
    )
    found = [row(block, axes=axes) for block in run.generate_blocks()]
    told = [f"{d.severity} {d.line} {d.column} {d.code}" for d in run.diagnostics]
    if any(text.startswith("error") for text in findings):
        assert [text for text in told if text.startswith("error")] == findings
        return
    assert sorted(told) == sorted(findings)
    for have, want in zip(found, blocks, strict=False):
        assert same(have, want), f"{have}   but the table says   {' '.join(want)}"
    assert len(found) == len(blocks)


def test_every_language_has_programs_with_tables() -> None:
    assert {path.parent.name for path in FILES} == {"klartext", "sinumerik"}
    assert sorted(path.stem for path in PROGRAMS.glob("*/*.expected")) == sorted(path.stem for path in FILES)
