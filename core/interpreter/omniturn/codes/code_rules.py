"""Rules of the code table applied to a line: ranges of words and conditions that reject a code.

The entry (``code_table``) has the messages and remedies. The function that executes a code calls these checks
when it needs a word.
"""

from __future__ import annotations

from collections.abc import Callable

from core.interpreter.omniturn.codes.code_entry import MOST_PER_REV, Code, Limit, Refusal, When, WordRule
from core.interpreter.omniturn.omniturn_state import State
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.shared.units import METRES_PER_MINUTE
from core.language.diagnostics import ProgramError
from core.language.omniturn import Word
from core.message import Message

_ROUNDING = 1 + 1e-9


def refused(
    statement: Statement, code: Code, refusal: Refusal, at: Word | None = None, **told: object
) -> ProgramError:
    """Return the error to raise for a refusal; ``told`` has the values of further placeholders."""
    told = {
        "code": code.name,
        "number": code.name[1:],
        "name": code.name.lstrip("~"),
        "word": "" if at is None else at.text,
        "letter": "" if at is None else at.letter,
        **told,
    }
    return statement.refuse(
        refusal.at if at is None else at,
        refusal.code,
        Message(refusal.text, **told),
        Message(refusal.hint, **told),
    )


def number(state: State, statement: Statement, letter: str, code: Code | None = None) -> float | None:
    """Return the number of a word as written, checked by the rule of the line's code; None without the word.

    Raises ProgramError if the rule rejects the number.
    """
    code = code or statement.entry
    rule, word = code.rules[letter], statement.words.get(letter)
    if word is not None and word.value is None and rule.bare is not None:
        return rule.bare
    return checked(state, statement, letter, None if word is None else word.value, code)


def checked(
    state: State,
    statement: Statement,
    letter: str,
    value: float | None,
    code: Code | None = None,
    *,
    more: str = "",
) -> float | None:
    """Return a converted number (mm, rounded, unsigned) after checking it by the rule of the line's code.

    ``more`` is another remedy for a number above the limit. Raises ProgramError if the rule rejects the
    number.
    """
    code = code or statement.entry
    rule, word = code.rules[letter], statement.words.get(letter)
    refusal = _wrong(state, rule, word, value)
    if refusal is None:
        return value
    if more and value is not None and value > rule.least:
        refusal = refusal._replace(hint=more)
    at = None if refusal.at or word is None else word
    if word is None and not refusal.at:
        refusal = refusal._replace(at=letter)
    most = shown(state, rule.most) if isinstance(rule.most, Limit) else ""
    told = {"letter": letter, "what": rule.what, "value": f"{value or 0.0:g}", "most": most}
    raise refused(statement, code, refusal, at, **{"word": word.text if word else "", **told})


def _wrong(state: State, rule: WordRule, word: Word | None, value: float | None) -> Refusal | None:
    if word is not None and (word.value is None or rule.numbered is not None):
        refusal = rule.numberless if word.value is None else rule.numbered
        if refusal is not None:
            return refusal
    if value is None:
        return rule.missing
    most = limit(state, rule.most) * _ROUNDING if isinstance(rule.most, Limit) else rule.most
    return rule.refusal_of(value, most)


def limit(state: State, most: Limit) -> float:
    """Return the present value of a limit: mm/s or mm/rev for feeds, rpm for speeds."""
    return _LIMITS[most](state)


def shown(state: State, most: Limit) -> str:
    """Return the present value of a limit as text in the unit of the program."""
    value = limit(state, most)
    if most not in {Limit.FEED, Limit.FEED_IN_FORCE, Limit.LEAD}:
        return f"{value:g}"
    per_rev = most is Limit.LEAD or (most is Limit.FEED_IN_FORCE and state.modal.per_rev)
    return state.modal.feed_text(value, per_rev=per_rev)


def _feed_in_force(state: State) -> float:
    return MOST_PER_REV[state.modal.coarse] if state.modal.per_rev else state.setup.limits.max_feed


_LIMITS: dict[Limit, Callable[[State], float]] = {
    Limit.FEED: lambda state: state.setup.limits.max_feed,
    Limit.FEED_IN_FORCE: _feed_in_force,
    Limit.LEAD: lambda state: MOST_PER_REV[state.modal.coarse],
    Limit.SURFACE: lambda _: 6000 * METRES_PER_MINUTE,
    Limit.RPM: lambda state: state.setup.limits.max_rpm,
    Limit.C_RPM: lambda state: state.setup.limits.c_max_rpm,
}


def check_together(statement: Statement, code: Code) -> None:
    """Raise ProgramError if a line has none of the required words, or two that exclude each other."""
    if code.one_of is not None and statement.words.keys().isdisjoint(code.one_of.letters):
        raise refused(statement, code, code.one_of.refusal)
    for letters, refusal in code.apart:
        found = [statement.words[letter] for letter in letters if letter in statement.words]
        if len(found) > 1:
            raise refused(statement, code, refusal, found[1], first=found[0].text)


def check_when(state: State, statement: Statement, code: Code, *only: When, word: Word | None = None) -> None:
    """Raise ProgramError for the first condition that rejects a code; ``only`` restricts the conditions.

    ``word`` is the location of the error if it is not the code itself.
    """
    for when, refusal in code.not_when.items():
        if (not only or when in only) and _IS[when](state, statement, code):
            line = state.tool_line
            if when is When.TOOL_NOT_MOVED:
                state.tool_line = 0  # The error is reported only once.
            raise refused(statement, code, refusal, word, line=line, on=state.modal.nose_comp)


def _with_others(_state: State, statement: Statement, code: Code) -> bool:
    others = statement.words.keys() - code.words or statement.one_shot is not None or statement.m is not None
    return bool(others) or len(statement.modal) > 1


def _no_feed(state: State, statement: Statement, _code: Code) -> bool:
    return "F" not in statement.words and (not state.cut or state.modal.feed is None)


def _no_speed(state: State, _made: Statement, _code: Code) -> bool:
    return not (state.modal.surface_speed if state.modal.css else state.modal.rpm)


def _turning(state: State, _made: Statement, _code: Code) -> bool:
    return bool(state.modal.spindle) and not state.setup.limits.unclamp_while_turning


def _collet_open(state: State, _made: Statement, _code: Code) -> bool:
    return not state.modal.collet_closed and not state.setup.limits.start_with_collet_open


_IS: dict[When, Callable[[State, Statement, Code], bool]] = {
    When.WITH_OTHERS: _with_others,
    When.WITH_FEED: lambda _, statement, _code: (
        (statement.f_is_feed and "F" in statement.words) or 94 in statement.modal or 95 in statement.modal
    ),
    When.WITH_M: lambda _, statement, _code: statement.m is not None,
    When.NOSE_COMPENSATION: lambda state, _, _code: state.modal.nose_comp != 40,
    When.COARSE: lambda state, _, _code: bool(state.modal.coarse),
    When.NOT_COARSE: lambda state, _, _code: not state.modal.coarse,
    When.INCREMENTAL_DIAMETERS: lambda state, _, _code: state.modal.diameter and not state.absolute,
    When.SURFACE_SPEED: lambda state, _, _code: state.modal.css,
    When.PER_REV: lambda state, _, _code: state.modal.per_rev,
    When.NO_FEED: _no_feed,
    When.NO_CUT_FEED: lambda state, _, _code: state.modal.cut_feed is None,
    When.TOOL_NOT_MOVED: lambda state, _, _code: bool(state.tool_line),
    When.NO_SPEED: _no_speed,
    When.STANDING: lambda state, _, _code: not state.rpm_at(state.x),
    When.TURNING: _turning,
    When.COLLET_OPEN: _collet_open,
    When.C_LOCKED: lambda state, _, _code: state.modal.c_locked,
    When.C_FREE: lambda state, _, _code: not state.modal.c_locked,
    When.NO_C: lambda state, _, _code: not state.setup.limits.c_enabled,
    # This condition is checked only for lines without a straight move.
    When.NO_STRAIGHT_MOVE: lambda *_: True,
}
