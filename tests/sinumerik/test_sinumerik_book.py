"""The code book of SINUMERIK: each construct has an entry, each example proves, each refusal is told."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.compose.machine.machine_files import load_shipped_machine
from app.compose.machine.machine_setup import create_power_up_setup
from core.interpreter.code_book_page import render_code_book
from core.interpreter.dialects import get_code_book
from core.interpreter.shared.job_setup import ToolOffset
from core.language.code_book import CodeBookEntry
from core.language.diagnostics import Diagnostic, Severity
from core.language.sinumerik import sinumerik_words
from core.language.sinumerik.control_statements import ControlKeyword
from core.language.sinumerik.cycle_names import CYCLE_PARAMETERS, UNSUPPORTED_CYCLES
from core.language.sinumerik.word_table import GROUP_BY_FUNCTION, INEFFECTIVE_WORDS, M_FUNCTIONS
from core.language.source import Dialect, ProgramSource
from core.machine.machine_model import Machine
from core.proving.prove_program import prove
from core.tool_edges import make_edge_row_number
from tests.sinumerik.lathe import MODULO

BOOK = get_code_book(Dialect.SINUMERIK)
ENTRIES = {entry.head: entry for entry in BOOK.entries}
LIVE = load_shipped_machine("sinumerik-live")
"""Its spindle is C."""

TOOLS = {1: ToolOffset(name="ROUGHER", quadrant=3), make_edge_row_number(1, 2): ToolOffset(z=-3.0)}


def errors_of(entry: CodeBookEntry, lines: str, machine: Machine = MODULO) -> list[Diagnostic]:
    text = lines if entry.whole else f"{BOOK.head}{lines}\n{BOOK.lines_after_example}{entry.behind}"
    files = tuple(ProgramSource(name, each) for name, each in entry.files)
    setup = create_power_up_setup(machine, tool_offsets=TOOLS, secondary_offsets={})
    report = prove(ProgramSource("EXAMPLE.MPF", text, subprograms=files), setup, machine)
    return [each for each in report.diagnostics if each.severity is Severity.ERROR]


@pytest.mark.parametrize(
    "entry", [each for each in BOOK.entries if each.example], ids=lambda entry: entry.head
)
def test_code_book_example_is_proved_without_findings(entry: CodeBookEntry) -> None:
    found = errors_of(entry, entry.example)
    if any(each.code == "spindle-position" for each in found):
        found = errors_of(entry, entry.example, LIVE)
    assert [each.format_one_line("") for each in found] == []
    assert entry.what.endswith(".")


@pytest.mark.parametrize(
    "entry", [each for each in BOOK.entries if each.refused], ids=lambda entry: entry.head
)
def test_code_book_counterexample_is_rejected(entry: CodeBookEntry) -> None:
    said = [f"{each.message} {each.hint}" for each in errors_of(entry, entry.refused)]
    assert any(entry.why in each for each in said), said


def test_every_construct_has_a_code_book_entry() -> None:
    """What the reader knows, by its own tables."""
    codes = {f"G{n}" for n in sinumerik_words.G_GROUPS} | {f"M{n}" for n in M_FUNCTIONS}
    words = sinumerik_words.VOCABULARY - {"G", "M"}
    assert (
        codes | words | {str(each) for each in ControlKeyword} | set(CYCLE_PARAMETERS)
    ) - ENTRIES.keys() == set()


def test_chapters_are_the_groups_of_the_g_code_table() -> None:
    groups: dict[str, set[str]] = {}
    for name, group in GROUP_BY_FUNCTION.items():
        groups.setdefault(group.capitalize(), set()).add(name)
    chapters = dict(BOOK.chapters)
    assert {title: {entry.head for entry in chapters.get(title, ())} for title in groups} == groups


@pytest.mark.parametrize("name", INEFFECTIVE_WORDS)
def test_entry_of_ineffective_word_gives_same_reason_as_note(name: str) -> None:
    assert f"because {INEFFECTIVE_WORDS[name]}." in ENTRIES[name].what


@pytest.mark.parametrize("name", UNSUPPORTED_CYCLES)
def test_entry_of_rejected_cycle_gives_same_reason_as_error(name: str) -> None:
    assert f": {UNSUPPORTED_CYCLES[name]}." in ENTRIES[name].what


@pytest.mark.parametrize("name", CYCLE_PARAMETERS)
def test_entry_of_cycle_lists_its_parameters_in_order(name: str) -> None:
    assert ENTRIES[name].words == f"({', '.join(CYCLE_PARAMETERS[name])})"


def test_every_construct_has_an_example_and_a_counterexample() -> None:
    """A cycle that is refused by its name has no example; everything else has both."""
    assert [each.head for each in BOOK.entries if not each.example] == list(UNSUPPORTED_CYCLES)
    assert [each.head for each in BOOK.entries if not (each.refused and each.why)] == []


def test_code_page_matches_code_book() -> None:
    written = Path(__file__).parents[2] / "docs" / "sinumerik-codes.md"
    assert written.read_text(encoding="utf-8") == render_code_book(Dialect.SINUMERIK), (
        "print it anew: CONTRIBUTING.md"
    )
