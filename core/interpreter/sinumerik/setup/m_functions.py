"""M functions for coolant, tool change, gears and outputs; spindle and program end are elsewhere."""

from __future__ import annotations

from collections.abc import Iterator

from core.interpreter.shared.actions import ColletSwitch, CoolantSwitch, OutputSwitch
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.machine_requirements import (
    BUILDER_M_PREFIX,
    MachineRequirement,
    format_m_code_instruction,
)
from core.interpreter.sinumerik.setup.modes_and_offsets import log_ineffective_word
from core.interpreter.sinumerik.sinumerik_state import SinumerikState
from core.interpreter.sinumerik.sinumerik_statement import Statement
from core.language.diagnostics import ProgramError
from core.language.sinumerik.sinumerik_words import Word
from core.language.sinumerik.word_table import INEFFECTIVE_WORDS, M_FUNCTIONS
from core.message import Message

COLLET_OUTPUT = "collet"  # the output of the chuck for any M code of the builder
_ISO_CODES = frozenset({98, 99})  # M98 and M99 of the ISO dialect, which call and end subprograms


def check_m_functions(
    state: SinumerikState, statement: Statement, missing_functions: list[MachineRequirement]
) -> None:
    """Check the M functions of a block, and add the missing functions to ``missing_functions``.

    A missing function is a machine-builder function that this machine lacks. The original control passes
    such a code to the builder's PLC without an alarm. Raises ProgramError in the following cases:
    - The machine file disables the code, or the code is M98 or M99 of the ISO dialect.
    - The code opens the chuck while the spindle turns.
    """
    limits = state.setup.limits
    for code, word in statement.m_words.items():
        if code in limits.ignored_m_codes:
            log_ineffective_word(
                state,
                statement,
                word,
                f"M{code}",
                "the machine file contains ignored = true for this M code",
            )
        elif code in M_FUNCTIONS:
            log_ineffective_word(state, statement, word, f"M{code}", _idle(state, code))
        elif code in limits.m_code_outputs:
            _check_chuck(state, statement, word, *limits.m_code_outputs[code])
        elif code in limits.disabled_m_codes or code in _ISO_CODES:
            raise _refused(state, statement, code, word)
        else:
            missing_functions.append(
                MachineRequirement(f"{BUILDER_M_PREFIX}{code}", statement.lexed_block.line_number)
            )
            _warn_missing_function(state, statement, code, word)


def _check_chuck(state: SinumerikState, statement: Statement, word: Word, name: str, on: bool) -> None:
    """Raise ProgramError if a code opens the chuck while the spindle turns, as for M13 in OmniTurn.

    The code is allowed if M5 is in the same block, or if the machine file permits unclamping while the
    spindle turns.
    """
    turns = state.modal.spindle and 5 not in statement.m_words
    if name == COLLET_OUTPUT and not on and turns and not state.setup.limits.can_unclamp_while_turning:
        text = Message("{word} cannot open the chuck while the spindle turns.", word=word.text)
        raise statement.make_error(word, "unclamp-turning", text, "Write M5 before this block.")


def _idle(state: SinumerikState, code: int) -> str:
    if code == 6 and 6 not in state.setup.limits.m_code_outputs:
        return "T changes the tool automatically on this machine"
    return INEFFECTIVE_WORDS.get(f"M{code}", "")


def _refused(state: SinumerikState, statement: Statement, code: int, word: Word) -> ProgramError:
    if code in state.setup.limits.disabled_m_codes:
        text = Message("M{code} is defined but not enabled in the machine file.", code=code)
        return statement.make_error(
            word, "m-disabled", text, Message("Set enabled = true for {code} under [m_codes].", code=code)
        )
    text = Message("M{code} belongs to the ISO dialect of this control.", code=code)
    return statement.make_error(
        word, "m-unknown", text, "Call a subprogram by its name, and end it with M17."
    )


def _warn_missing_function(state: SinumerikState, statement: Statement, code: int, word: Word) -> None:
    """Log a warning, only once, that this machine lacks a machine-builder function.

    A program that needs a missing function cannot be started.
    """
    if f"M{code}" in state.logged_functions:
        return
    state.logged_functions.add(f"M{code}")
    what = Message("M{code} is a machine-builder code that has no function on this machine", code=code)
    text = Message("{what}, so the machine will not start.", what=what)
    hint = format_m_code_instruction(code)
    state.log_finding(
        statement.make_warning(
            word, "m-unanswered", text, Message("{hint}.", hint=hint.capitalize_first_letter())
        )
    )


def turn_outputs_on(state: SinumerikState, statement: Statement) -> Iterator[Block]:
    """Yield the blocks that turn coolant and outputs on before the motion."""
    yield from _outputs(state, statement, on=True)
    yield from _coolant(state, statement, {7, 8})


def turn_outputs_off(state: SinumerikState, statement: Statement) -> Iterator[Block]:
    """Yield the blocks that turn coolant and outputs off after the motion."""
    yield from _coolant(state, statement, {9})
    yield from _outputs(state, statement, on=False)


def _outputs(state: SinumerikState, statement: Statement, *, on: bool) -> Iterator[Block]:
    for code in statement.m_words:
        name, wanted = state.setup.limits.m_code_outputs.get(code, ("", not on))
        if name == COLLET_OUTPUT and wanted is on:
            state.set_modal_state(state.modal._replace(collet_closed=on))
            yield state.action(statement.lexed_block.line_number, f"M{code}", ColletSwitch(closed=on))
        elif name and wanted is on:
            outputs = state.modal.outputs | {name} if on else state.modal.outputs - {name}
            state.set_modal_state(state.modal._replace(outputs=outputs))
            yield state.action(statement.lexed_block.line_number, f"M{code}", OutputSwitch(name, on))


def _coolant(state: SinumerikState, statement: Statement, codes: set[int]) -> Iterator[Block]:
    code = next((code for code in sorted(codes) if code in statement.m_words), None)
    if code is not None:
        state.set_modal_state(state.modal._replace(coolant=code != 9))
        yield state.action(statement.lexed_block.line_number, f"M{code}", CoolantSwitch(code != 9))
