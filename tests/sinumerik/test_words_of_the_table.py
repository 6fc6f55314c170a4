"""Every word of the table: its example runs, what is refused is refused by its name."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.compose.machine.machine_files import load_shipped_machine
from core.interpreter.dialects import get_code_book
from core.interpreter.shared.elementary_blocks import BlockKind
from core.interpreter.shared.job_setup import InterpreterSetup, ToolOffset, ZeroOffset
from core.language.diagnostics import Severity
from core.language.sinumerik.unsupported_words import UNSUPPORTED_WORDS
from core.language.sinumerik.word_table import GROUP_BY_FUNCTION, INEFFECTIVE_WORDS, M_FUNCTIONS, VALUE_WORDS
from core.language.source import Dialect
from core.machine.machine_model import Machine
from tests.sinumerik.lathe import MODULO, refused, run, setup

NAMES = frozenset({*GROUP_BY_FUNCTION, *VALUE_WORDS, *(f"M{code}" for code in M_FUNCTIONS)})
EXAMPLES = {
    entry.head: entry.example for entry in get_code_book(Dialect.SINUMERIK).entries if entry.head in NAMES
}

LIVE = load_shipped_machine("sinumerik-live")
"""Its spindle is C."""

NEED_C = frozenset({"G331", "G332", "SPOS", "SPOSA", "M19", "M70"})


def around(machine: Machine = MODULO) -> InterpreterSetup:
    tools = {1: ToolOffset(1.0, 2.0, 0.4, 3, "ROUGHER")}
    return replace(setup(machine), tools=tools, start=(60.0, 80.0, 0.0))


@pytest.mark.parametrize("name", EXAMPLES)
def test_example_of_each_word_runs(name: str) -> None:
    text = EXAMPLES[name]
    passed = run(text, around(LIVE if name in NEED_C else MODULO))
    assert [each for each in passed.found if each.severity is not Severity.NOTE] == []
    assert (name in INEFFECTIVE_WORDS) is any(
        each.code == "no-effect" for each in passed.found
    ) or "M6" in text


PATH = "G1 X40 Z-5 F200\n{}X30 Z-20\nX50"
_TAKEN = """
    G601 G602 G603 G641 G642 G643 G644 G645 COMPOF CFTCP CPRECOF CUT2D CUT2DF FNORM G71 G710 WALIMON WALIMOF
    G40 NORM KONT G450 G451 G500 G290 TRAFOOF DISPLON DISPLOF SBLON SBLOF M7 M8 M9 M40 M41 M42 M43 M44 M45
"""
SWITCHES_NOTHING = (
    *(name for name in GROUP_BY_FUNCTION if name in INEFFECTIVE_WORDS),
    *_TAKEN.split(),
    *("ADIS=0.5", "ADISPOS=0.5", "DITS=2", "DITE=2"),
    *("CYCLE832(0.01,1,1)", "CYCLE832()", "CYCLE800()"),
)


@pytest.mark.parametrize("name", SWITCHES_NOTHING)
def test_ineffective_words_do_not_change_the_path(name: str) -> None:
    """Where the word stands alone in a block, and where it is left out: the same ways at the same feeds."""
    without = [(b.x, b.z, b.kind, b.feed) for b in run(PATH.format(""), around()).moves]
    passed = run(PATH.format(f"{name}\n"), around())
    assert passed.errors == []
    assert [(b.x, b.z, b.kind, b.feed) for b in passed.moves] == without


ROWS = {**{f"G{row}": row for row in range(54, 60)}, "G505": 58, "G506": 59}


@pytest.mark.parametrize(("name", "row"), ROWS.items())
def test_settable_offset_uses_its_table_row(name: str, row: int) -> None:
    """X as a radius: 40 across, 7 mm of the row; Z -5 and 30 of it."""
    shifted = replace(around(), zero={row: ZeroOffset(7.0, 30.0, 0.0)})
    assert [b.machine_end[:2] for b in run(f"{name} G0 X40 Z-5", shifted).moves] == [(27.0, 25.0)]
    assert [b.machine_end[:2] for b in run(f"{name}\nG153 G0 X40 Z-5", shifted).moves] == [(20.0, -5.0)]


def test_ascale_multiplies_the_active_scale() -> None:
    """Twice, then by half again: three times the Z of the program."""
    assert [b.z for b in run("SCALE Z2\nASCALE Z1.5\nG0 X20 Z5", around()).moves] == [pytest.approx(15.0)]


def test_gotos_jumps_to_the_first_block() -> None:
    text = "IF $P_TOOLNO==1 GOTOF DONE\nG0 Z1\nT1\nGOTOS\nG0 Z9\nDONE: G0 Z=2"
    ways = [(b.line, b.kind) for b in run(text, around()).moves]
    assert ways == [(2, BlockKind.RAPID), (6, BlockKind.RAPID)]


def test_cycle89_dwells_and_feeds_out() -> None:
    passed = run("S1000 M3 G94 F120 G17\nG0 X0 Z5\nCYCLE89(4,0,1,-9,,1)", around())
    assert [(b.z, b.kind) for b in passed.moves[2:]] == [
        (-9, BlockKind.FEED),
        (1, BlockKind.FEED),
        (4, BlockKind.RAPID),
    ]


@pytest.mark.parametrize("name", UNSUPPORTED_WORDS)
def test_unsupported_words_are_rejected_by_name(name: str) -> None:
    error = refused(f"N30 {name}", around())
    assert error.code == "not-in-subset"
    assert f"{name}: {UNSUPPORTED_WORDS[name]}" in error.message
