"""The book of codes: complete, proved example by example, and the page in docs written from it."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.compose.machine_setup import setup_for
from core.interpreter.job_setup import SecondaryOffset, ToolOffset
from core.interpreter.omniturn import code_table
from core.interpreter.omniturn.code_table import CHAPTERS, Entry
from core.interpreter.omniturn.language_page import page
from core.language.diagnostics import Severity
from core.language.source import Source
from core.machine.machine_file import load_machine
from core.proving.prove_program import prove

ENTRIES = [entry for _, entries in CHAPTERS for entry in entries]
PAGE = Path(__file__).parents[2] / "docs" / "language.md"
NOSE = 0.015 * 25.4


def test_every_code_of_the_tables_has_its_entry_and_none_has_two() -> None:
    known = {f"G{number:02d}" for number in (*code_table.MODAL_GROUPS, *code_table.ONE_SHOT)}
    known |= {f"M{number:02d}" for number in code_table.M_KNOWN}
    known |= {name for name in code_table.FLOW_WORDS if not name.startswith("M")}
    known |= {"C", "CA", "CI", "R", "T", "D", "F", "S", "/", "()", "~PLXC", "~PLZC"}
    written = [entry.code for entry in ENTRIES]
    assert sorted(written) == sorted(known)


@pytest.mark.parametrize("entry", ENTRIES, ids=lambda entry: entry.code)
def test_the_example_proves_and_uses_its_code(entry: Entry) -> None:
    machine = load_machine(None)
    secondary = {
        1: SecondaryOffset(-NOSE, -NOSE, NOSE),
        2: SecondaryOffset(x=-0.0127),
        3: SecondaryOffset(-NOSE, -NOSE, NOSE),
    }
    setup = setup_for(machine, tools={n: ToolOffset() for n in range(1, 9)}, secondary=secondary)
    report = prove(Source(entry.code, entry.program), setup, machine)
    assert [d.shown("") for d in report.diagnostics if d.severity is Severity.ERROR] == []
    assert report.elementary > 0
    used = entry.example + entry.subroutine
    assert entry.code.strip("()") in used


def test_the_page_is_written_from_the_book() -> None:
    assert PAGE.read_text(encoding="utf-8") == page(), (
        "python -m core.interpreter.omniturn.language_page > docs/language.md"
    )
