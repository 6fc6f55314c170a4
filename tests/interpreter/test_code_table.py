"""One entry is all there is of a code: whole, proved by its example, and enough to add one."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from math import inf
from pathlib import Path

import pytest

from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import create_power_up_setup
from core.interpreter.omniturn.codes.code_entry import (
    EXAMPLE_HEAD,
    EXAMPLE_TAIL,
    ActionKind,
    CodeEntry,
    CodeEntryError,
    ErrorTemplate,
    FMeaning,
    WordLimit,
    WordRule,
    names,
)
from core.interpreter.omniturn.codes.code_table import (
    CODE_CHAPTERS,
    FLOW_CODES,
    G_CODES,
    LETTER_ENTRIES,
    M_CODES,
    load_handler,
)
from core.interpreter.omniturn.codes.language_page import render_language_reference
from core.interpreter.omniturn.omniturn_state import State
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.omniturn.setup import spindle_and_dwell
from core.interpreter.shared.actions import Dwell
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.job_setup import SecondaryOffset, ToolOffset
from core.language.diagnostics import Severity
from core.language.omniturn.omniturn_words import VALUE_RANGES
from core.language.source import ProgramSource
from core.proving.prove_program import prove
from tests.coded import raises_code
from tests.interpreter.programs import passed

CODES = [code for _, codes in CODE_CHAPTERS for code in codes]
PAGE = Path(__file__).parents[2] / "docs" / "language.md"
ROOM = Path(__file__).parents[2] / "core" / "interpreter" / "omniturn"
SHARED = ROOM.parent / "shared" / "centerline_rotation.py"  # what all languages say alike
REFUSAL = re.compile(r'"([a-z0-9]+(?:-[a-z0-9]+)+)"')
NOSE = 0.015 * 25.4

OF_NO_CODE = names("m-disabled m-unknown no-effect")  # of codes that only the machine file could know
FAMILIES = sorted(
    {code.handler.partition(":")[0].replace(".", "/") for code in CODES} - {"omniturn_statement"}
)


def test_codes_have_a_single_entry() -> None:
    written = [code.name for code in CODES]
    assert sorted(written) == sorted(set(written))
    assert len(G_CODES) + len(M_CODES) + len(FLOW_CODES) + len(LETTER_ENTRIES) == len(CODES)


@pytest.mark.parametrize("code", CODES, ids=lambda code: code.name)
def test_code_entry_is_complete(code: CodeEntry) -> None:
    assert code.syntax
    assert code.description.endswith(".")
    assert code.name.strip("()") in code.example + code.example_subroutine
    assert callable(load_handler(code))
    assert code.action_kind is ActionKind.WORD or not code.word_rules.keys() - code.allowed_words
    # Either it may stand alone, or something says why not: nothing falls through in MDI.
    assert bool(code.mdi_error_text) or code.action_kind not in {ActionKind.FLOW, ActionKind.CONTOUR}


@pytest.mark.parametrize("code", CODES, ids=lambda code: code.name)
def test_code_example_proves_without_errors(code: CodeEntry) -> None:
    machine = load_machine(None)
    secondary = {
        1: SecondaryOffset(-NOSE, -NOSE, NOSE),
        2: SecondaryOffset(x=-0.0127),
        3: SecondaryOffset(-NOSE, -NOSE, NOSE),
    }
    setup = create_power_up_setup(
        machine, tool_offsets={n: ToolOffset() for n in range(1, 9)}, secondary_offsets=secondary
    )
    report = prove(ProgramSource(code.name, code.example_program), setup, machine)
    assert [d.format_one_line("") for d in report.diagnostics if d.severity is Severity.ERROR] == []
    assert report.elementary_block_count > 0


@pytest.mark.parametrize("family", FAMILIES)
def test_every_refusal_of_a_family_is_in_an_entry(family: str) -> None:
    told = set(REFUSAL.findall((ROOM / f"{family}.py").read_text(encoding="utf-8")))
    assert told - OF_NO_CODE - frozenset().union(*(code.diagnostic_codes for code in CODES)) == set()


def test_entries_list_only_existing_refusals() -> None:
    tables = {"move_codes.py", "cycle_codes.py", "flow_codes.py"}
    files = [*(file for file in ROOM.rglob("*.py") if file.name not in tables), SHARED]
    text = "".join(file.read_text(encoding="utf-8") for file in files)
    further = frozenset().union(*(code.other_diagnostic_codes for code in CODES))
    stated = {each.diagnostic_code for code in CODES for each in code.entry_errors}
    assert [code for code in sorted(further - stated) if f'"{code}"' not in text] == []


def spoilt(letter: str, rule: WordRule) -> Iterator[tuple[str | None, ErrorTemplate | None]]:
    """What to write behind the letter (None: leave the word out) for each refusal of a rule."""
    yield None, rule.missing_error
    yield "", rule.no_number_error
    yield "1", rule.unwanted_number_error
    if rule.minimum > -inf:
        yield f"{rule.minimum if rule.excludes_minimum else rule.minimum / 2 or -1:f}", rule.invalid_error
    if rule.requires_nonzero:
        yield "0", rule.invalid_error
    if rule.requires_whole_number:
        yield f"{max(rule.minimum, 0) + 0.5:g}", rule.invalid_error
    most = VALUE_RANGES[letter][1] if isinstance(rule.maximum, WordLimit) else rule.maximum + 1
    if most < inf:
        yield f"{most:g}", rule.too_large_error or rule.invalid_error


REFUSED = [
    pytest.param(code, letter, number, refusal, id=f"{code.name}-{letter}{number}-{refusal.diagnostic_code}")
    for code in CODES
    for letter, rule in code.word_rules.items()
    for number, refusal in spoilt(letter, rule)
    if refusal is not None and not (code.action_kind is ActionKind.WORD and number == "")
]


@pytest.mark.parametrize(("code", "letter", "number", "refusal"), REFUSED)
def test_rule_rejects_a_missing_or_invalid_word(
    code: CodeEntry, letter: str, number: str | None, refusal: ErrorTemplate
) -> None:
    """The example, its word left out or written with a number that the rule does not take."""
    lines = code.example.splitlines()
    at = next(k for k, line in enumerate(lines) if code.name.strip("()") in line)
    word = re.compile(rf"(?<![A-Z]){letter}(?:[-+.\d]+|(?![A-Z]))")
    others = {each for letters, _ in code.exclusive_words if letter in letters for each in letters} - {letter}
    for other in sorted(others):
        lines[at] = re.sub(rf"{other}[-+.\d]+", "", lines[at])
    bare = word.sub("", lines[at], count=1)
    lines[at] = bare if number is None else f"{bare}{letter}{number}"
    text = EXAMPLE_HEAD + "\n".join(lines) + "\n" + EXAMPLE_TAIL + code.example_subroutine
    assert refusal.diagnostic_code in [found for _, _, found in passed(text).errors], text


def test_rule_in_the_entry_is_applied(monkeypatch: pytest.MonkeyPatch) -> None:
    strict = replace(G_CODES[4], word_rules={"F": replace(G_CODES[4].word_rules["F"], maximum=1.0)})
    assert passed(program("G04F2")).errors == []
    monkeypatch.setitem(G_CODES, 4, strict)
    assert [code for _, _, code in passed(program("G04F2")).errors] == ["dwell-range"]


def test_reference_page_matches_the_code_table() -> None:
    assert PAGE.read_text(encoding="utf-8") == render_language_reference(), (
        "python -m core.interpreter.omniturn.codes.language_page > docs/language.md"
    )


# --- a trial code, added by one entry and the function that it names


def wait_in_turns(state: State, made: Statement) -> Iterator[Block]:
    """G05F2: waits for two turns of the spindle."""
    seconds = (made.get_value("F") or 0.0) * 60.0 / state.modal.rpm
    yield state.action(made.line, made.get_block_text("move"), Dwell(seconds))


TRIAL = CodeEntry(
    "G05",
    "G05Fn",
    "Waits for n turns.",
    "G05F2",
    action_kind=ActionKind.MOTION,
    handler="setup.spindle_and_dwell:wait_in_turns",
    allowed_words=names("F S T D"),
    f_meaning=FMeaning.SECONDS,
    min_block_count=1,
    mdi_error_text="{code} is a trial.",
)


def program(*lines: str) -> str:
    return EXAMPLE_HEAD + "\n".join(lines) + "\nM30\n"


def test_code_without_an_entry_is_rejected() -> None:
    assert [code for _, _, code in passed(program("G05F2")).errors] == ["g-unknown"]


def test_single_entry_defines_a_code(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(G_CODES, 5, TRIAL)
    monkeypatch.setattr(spindle_and_dwell, "wait_in_turns", wait_in_turns, raising=False)
    result = passed(program("Z0", "G05F2", "Z-.1"))
    assert result.errors == []
    waits, cut = result.blocks[-3], result.blocks[-2]
    assert waits.action == Dwell(0.12)
    assert (cut.feed, cut.per_rev) == (pytest.approx(0.004 * 25.4), True)  # its F is no feed
    for refused in ("G05F2X1", "G05F2M03G04", "X.7C.02\nG05F2\nZ-.5"):
        assert passed(program(refused)).errors != []


def test_invalid_code_entry_is_rejected() -> None:
    with raises_code(CodeEntryError, "f-word", "G05"):
        replace(TRIAL, f_meaning=FMeaning.NONE)
    with raises_code(CodeEntryError, "f-word", "G05"):
        replace(TRIAL, allowed_words=names("S T D"))
    with pytest.raises(TypeError):
        CodeEntry(
            "G05",
            "G05Fn",
            "Waits.",
            "G05F2",
            action_kind=ActionKind.MOTION,
            handler="setup.spindle_and_dwell:execute_dwell",
        )  # type: ignore[call-arg]
    with raises_code(CodeEntryError, "rule-without-word", "G05"):
        replace(TRIAL, word_rules={"K": WordRule("a lead")})
    with raises_code(CodeEntryError, "no-group", "G05"):
        replace(TRIAL, action_kind=ActionKind.MODE)


def test_unknown_handler_raises_an_error() -> None:
    with pytest.raises(AttributeError):
        load_handler(replace(TRIAL, handler="setup.spindle_and_dwell:nowhere"))
