"""G41, G42 and G40 as words: where they may stand, and what may not stand under them."""

from __future__ import annotations

from core.interpreter import codes
from core.interpreter.blocks import Block
from core.interpreter.corners import STRAIGHT
from core.interpreter.log import refusal
from core.interpreter.shaping import Mark
from core.interpreter.state import State
from core.interpreter.statement import Statement
from core.language.diagnostics import ProgramError

NOSE = frozenset({40, 41, 42})
_NOT_UNDER_NOSE = codes.THREADS | codes.CYCLES | {89, 92}
_TURNS_C = frozenset({"CA", "CI"})


def nose_code(made: Statement) -> int:
    """The G40, G41 or G42 of a line, 0 where there is none."""
    return next((code for code in made.modal if code in NOSE), 0)


def switch(state: State, made: Statement, code: int, *, called: bool) -> Mark | None:
    """G41, G42 or G40; None for a G40 with nothing to end. ``called``: the line is in a subroutine.

    Raises ProgramError where the code may not stand.
    """
    on = state.modal.nose_comp
    if code == 40 and on == 40:
        return None
    if made.words or made.code or made.m_word or len(made.modal) > 1:
        text = f"G{code} does not stand alone on its line."
        raise _refused(made, "not-alone", text, "Put the rest on a line of its own.")
    if code != 40 and on != 40:
        text = f"G{code} comes while G{on} is on."
        raise _refused(made, "comp-on", text, f"End G{on} first: a move off the part, then G40.")
    if called:
        text = f"G{code} stands in a subroutine."
        raise _refused(made, "comp-subroutine", text, "Write the compensated contour in the main program.")
    state.adopt(state.modal._replace(nose_comp=code))
    state.shape.approach = 0 if code == 40 else made.line
    state.shape.active, state.fast = True, False
    return Mark(code, made.line, state.x - state.px, state.z - state.pz)


def check_under_nose(state: State, made: Statement) -> None:
    """Refuse what nose compensation cannot follow. Raises ProgramError."""
    on = state.modal.nose_comp
    if on == 40:
        return
    if made.m in codes.ENDS:
        text = f"The program ends while G{on} is on."
        raise _refused(made, "comp-open", text, "Move off the part and write G40 before it.")
    if made.flow and made.flow not in codes.FLOW_WORDS:
        raise _refused(
            made, "comp-with", f"Plane switching stands while G{on} is on.", "Write G40 before it."
        )
    if made.flow in codes.CALLS:
        text = f"A subroutine is called while G{on} is on."
        raise _refused(made, "comp-subroutine", text, "Write the compensated contour in the main program.")
    if made.one_shot in _NOT_UNDER_NOSE or made.m in codes.M_POSITIONING or _TURNS_C & made.words.keys():
        word = made.code or made.m_word
        what = word.text if word is not None else "C"
        raise _refused(made, "comp-with", f"{what} stands while G{on} is on.", "Write G40 before it.")
    other = made.value("D") not in {None, state.modal.secondary}
    if other and "T" not in made.words and not state.shape.approach:
        text = f"D changes while G{on} is on."
        hint = "D belongs on the first move after G41 or G42 alone."
        raise ProgramError(refusal(made.line, made.column("D"), "comp-d", text, hint))


def check_approach(state: State, block: Block) -> None:
    """The first move after G41 or G42: a straight line with D. Raises ProgramError."""
    line, state.shape.approach = state.shape.approach, 0
    if not line:
        return
    on = state.modal.nose_comp
    if block.kind not in STRAIGHT:
        text = f"The first move after G{on} on line {line} is no straight line."
        raise _of(block, "comp-approach", text, "Approach on a straight line with D.")
    if state.shape.d_line != block.line or not state.modal.secondary:
        text = f"The first move after G{on} on line {line} names no D."
        raise _of(block, "comp-approach", text, "Write Dn: its R is the nose radius.")
    radius = state.setup.secondary[state.modal.secondary].r if _known(state) else 0.0
    if radius < 0:
        text = f"R of D{state.modal.secondary} is negative."
        raise _of(
            block, "comp-radius", text, "Enter the nose radius without a sign; G41 and G42 say the side."
        )
    if not radius:
        text = f"R of D{state.modal.secondary} is 0: G{on} compensates nothing."
        state.log.warn(block.line, 0, "comp-no-radius", text, "Enter the nose radius among the offsets.")


def nose_radius(state: State) -> float:
    """R of the secondary offset in force, mm."""
    return max(state.setup.secondary[state.modal.secondary].r, 0.0) if _known(state) else 0.0


def _known(state: State) -> bool:
    return state.modal.secondary in state.setup.secondary


def _refused(made: Statement, code: str, text: str, hint: str) -> ProgramError:
    return ProgramError(refusal(made.line, 1, code, text, hint))


def _of(block: Block, code: str, text: str, hint: str) -> ProgramError:
    return ProgramError(refusal(block.line, 0, code, text, hint))
