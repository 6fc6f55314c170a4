"""The code book of Klartext: each construct has an entry, each example proves, each refusal is told."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.compose.machine.machine_files import load_shipped_machine
from app.compose.machine.machine_setup import create_power_up_setup
from core.interpreter.code_book_page import render_code_book
from core.interpreter.dialects import get_code_book
from core.interpreter.klartext.cycles import contour_cycles, cycle_calls, older_cycles
from core.interpreter.klartext.setup import m_functions
from core.interpreter.shared.job_setup import ToolOffset
from core.language.code_book import CodeBookEntry
from core.language.diagnostics import Diagnostic, Severity
from core.language.klartext import klartext_line, path_block, plane_block, q_parameters
from core.language.klartext.klartext_faults import CYCLE_ALTERNATIVES
from core.language.source import Dialect, ProgramSource
from core.proving.prove_program import prove

BOOK = get_code_book(Dialect.KLARTEXT)
END = "END PGM EXAMPLE MM\n"
MILL = load_shipped_machine("ac-table-mill")


def errors_of(entry: CodeBookEntry, lines: str) -> list[Diagnostic]:
    text = lines if entry.whole else f"{BOOK.head}{lines}\n{BOOK.lines_after_example}{entry.behind}{END}"
    files = tuple(ProgramSource(name, each) for name, each in entry.files)
    setup = create_power_up_setup(MILL, tool_offsets={1: ToolOffset()}, secondary_offsets={})
    report = prove(ProgramSource("EXAMPLE.H", text, subprograms=files), setup, MILL)
    return [each for each in report.diagnostics if each.severity is Severity.ERROR]


@pytest.mark.parametrize(
    "entry", [each for each in BOOK.entries if each.example], ids=lambda entry: entry.head
)
def test_example_of_entry_is_accepted(entry: CodeBookEntry) -> None:
    assert [each.format_one_line("") for each in errors_of(entry, entry.example)] == []
    assert any(BOOK.at(line, 1) is not None for line in entry.example.splitlines())
    assert entry.what.endswith(".")


def test_every_construct_has_its_entry() -> None:
    """What the reader and the interpreter know, by their own tables."""
    heads = {entry.head for entry in BOOK.entries}
    blocks = {*klartext_line._KEYWORDS, *path_block.PATH_FORMS} - {
        "PLANE",
        "FUNCTION",
        "CYCL DEF",
        "BLK FORM",
        "TRANS",
    }
    planes = {f"PLANE {form}" for form in plane_block.PLANE_FORMS}
    told = {
        *cycle_calls._MACHINING,
        *contour_cycles.CONTOUR_CYCLES,
        *older_cycles.OLDER_CYCLES,
        *cycle_calls._NON_MACHINING_CYCLES,
    }
    told |= {*cycle_calls._TRANSFORMS, *cycle_calls._IMMEDIATE_CYCLES, 7}
    codes = (
        m_functions.CODES_BEFORE_MOTION
        | m_functions._CODES_AFTER_MOTION
        | m_functions._BLOCKWISE_CODES
        | m_functions.IGNORED_CODES
    )
    known = blocks | planes | {f"CYCL DEF {number}" for number in told} | {f"M{code}" for code in codes}
    jumps_and_sums = {
        *q_parameters._JUMPS,
        *q_parameters._TWO_OPERANDS,
        *q_parameters._ONE_OPERAND,
        0,
        q_parameters._ANGLE,
    }
    known |= {f"FN {n}" for n in (*jumps_and_sums, *q_parameters._READERS, *q_parameters._IGNORED_FUNCTIONS)}
    known |= {f"CYCL DEF {number}" for number in CYCLE_ALTERNATIVES}
    assert known - heads == set()


@pytest.mark.parametrize("number", CYCLE_ALTERNATIVES)
def test_the_entry_of_a_rejected_cycle_has_the_hint_of_the_error(number: int) -> None:
    (entry,) = (each for each in BOOK.entries if each.head == f"CYCL DEF {number}")
    assert entry.what.endswith(CYCLE_ALTERNATIVES[number])


def test_every_entry_that_can_be_invalid_has_invalid_example() -> None:
    """Without one are blocks that take any text, and words that take nothing."""
    free = {each.head for each in BOOK.entries if not each.refused}
    any_text = {"*", "FN 15", "FN 16", "FN 38", "WMAT", "CYCL DEF 32"}
    assert free == any_text | {"R0", "RR", "FUNCTION RESET TCPM"}


@pytest.mark.parametrize(
    "entry", [each for each in BOOK.entries if each.refused], ids=lambda entry: entry.head
)
def test_invalid_example_of_entry_is_rejected(entry: CodeBookEntry) -> None:
    said = [f"{each.message} {each.hint}" for each in errors_of(entry, entry.refused)]
    assert said, entry.refused
    assert any(entry.why in each for each in said), said


def test_documentation_page_matches_code_book() -> None:
    written = Path(__file__).parents[2] / "docs" / "klartext-codes.md"
    assert written.read_text(encoding="utf-8") == render_code_book(Dialect.KLARTEXT), (
        "print it anew: CONTRIBUTING.md"
    )
