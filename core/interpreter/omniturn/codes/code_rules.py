"""Checks of a line by the rules of the code table: word ranges and rejection conditions.

Messages and remedies are in the entries of ``code_table``. The functions that execute codes call these
checks when they need a word.
"""

from __future__ import annotations

from collections.abc import Callable

from core.interpreter.omniturn.codes.code_entry import (
    MAX_FEEDS_PER_REV,
    CodeEntry,
    ErrorTemplate,
    RejectionCondition,
    WordLimit,
    WordRule,
)
from core.interpreter.omniturn.omniturn_state import State
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.shared.units import MM_S_PER_M_MIN
from core.language.diagnostics import ProgramError
from core.language.omniturn import Word
from core.message import Message

_ROUNDING = 1 + 1e-9


def refused(
    statement: Statement, code: CodeEntry, refusal: ErrorTemplate, at: Word | None = None, **values: object
) -> ProgramError:
    """Return the error that an error template defines for a rejected code.

    ``values`` contains the values of further placeholders.
    """
    values = {
        "code": code.name,
        "number": code.name[1:],
        "name": code.name.lstrip("~"),
        "word": "" if at is None else at.text,
        "letter": "" if at is None else at.letter,
        **values,
    }
    return statement.make_error(
        refusal.location if at is None else at,
        refusal.diagnostic_code,
        Message(refusal.text, **values),
        Message(refusal.hint, **values),
    )


def number(state: State, statement: Statement, letter: str, code: CodeEntry | None = None) -> float | None:
    """Return the number of a word as programmed, or None if the line lacks the word.

    For a letter without a number, the ``value_without_number`` of the rule is returned if it exists. The
    rule is that of ``code``, or of the line's code if ``code`` is None. Raises ProgramError if the number
    violates the rule, or if a required word or number is missing.
    """
    code = code or statement.code_entry
    rule, word = code.word_rules[letter], statement.words.get(letter)
    if word is not None and word.value is None and rule.value_without_number is not None:
        return rule.value_without_number
    return check_word_number(state, statement, letter, None if word is None else word.value, code)


def check_word_number(
    state: State,
    statement: Statement,
    letter: str,
    value: float | None,
    code: CodeEntry | None = None,
    *,
    extra_remedy: str = "",
) -> float | None:
    """Check a converted number by the rule of a code, and return the number.

    The rule is that of ``code``, or of the line's code if ``code`` is None. The number may have been
    converted to mm, rounded, or stripped of its sign. ``extra_remedy`` is another remedy for a number above
    the limit. Raises ProgramError if the number violates the rule, or if a required word or number is
    missing.
    """
    code = code or statement.code_entry
    rule, word = code.word_rules[letter], statement.words.get(letter)
    refusal = _wrong(state, rule, word, value)
    if refusal is None:
        return value
    if extra_remedy and value is not None and value > rule.minimum:
        refusal = refusal._replace(hint=extra_remedy)
    at = None if refusal.location or word is None else word
    if word is None and not refusal.location:
        refusal = refusal._replace(location=letter)
    most = format_limit(state, rule.maximum) if isinstance(rule.maximum, WordLimit) else ""
    values = {"letter": letter, "what": rule.description, "value": f"{value or 0.0:g}", "most": most}
    raise refused(statement, code, refusal, at, **{"word": word.text if word else "", **values})


def _wrong(state: State, rule: WordRule, word: Word | None, value: float | None) -> ErrorTemplate | None:
    if word is not None and (word.value is None or rule.unwanted_number_error is not None):
        refusal = rule.no_number_error if word.value is None else rule.unwanted_number_error
        if refusal is not None:
            return refusal
    if value is None:
        return rule.missing_error
    most = get_limit(state, rule.maximum) * _ROUNDING if isinstance(rule.maximum, WordLimit) else rule.maximum
    return rule.find_error(value, most)


def get_limit(state: State, maximum: WordLimit) -> float:
    """Return the current value of a limit, in mm/s or mm/rev for feeds and in rpm for speeds."""
    return _LIMITS[maximum](state)


def format_limit(state: State, maximum: WordLimit) -> str:
    """Return the current value of a limit as text in the unit of the program."""
    value = get_limit(state, maximum)
    if maximum not in {WordLimit.FEED, WordLimit.ACTIVE_FEED, WordLimit.LEAD}:
        return f"{value:g}"
    per_rev = maximum is WordLimit.LEAD or (maximum is WordLimit.ACTIVE_FEED and state.modal.per_rev)
    return state.modal.format_feed(value, is_per_rev=per_rev)


def _feed_in_force(state: State) -> float:
    return MAX_FEEDS_PER_REV[state.modal.coarse] if state.modal.per_rev else state.setup.limits.max_feed_mm_s


_LIMITS: dict[WordLimit, Callable[[State], float]] = {
    WordLimit.FEED: lambda state: state.setup.limits.max_feed_mm_s,
    WordLimit.ACTIVE_FEED: _feed_in_force,
    WordLimit.LEAD: lambda state: MAX_FEEDS_PER_REV[state.modal.coarse],
    WordLimit.SURFACE_SPEED: lambda _: 6000 * MM_S_PER_M_MIN,
    WordLimit.RPM: lambda state: state.setup.limits.max_rpm,
    WordLimit.C_RPM: lambda state: state.setup.limits.max_c_rpm,
}


def check_word_groups(statement: Statement, code: CodeEntry) -> None:
    """Raise ProgramError if a line violates the word groups of its code.

    The line must contain at least one of the required words. It must not contain two words that exclude
    each other.
    """
    if code.required_words is not None and statement.words.keys().isdisjoint(code.required_words.letters):
        raise refused(statement, code, code.required_words.refusal)
    for letters, refusal in code.exclusive_words:
        found = [statement.words[letter] for letter in letters if letter in statement.words]
        if len(found) > 1:
            raise refused(statement, code, refusal, found[1], first=found[0].text)


def check_conditions(
    state: State, statement: Statement, code: CodeEntry, *only: RejectionCondition, word: Word | None = None
) -> None:
    """Raise ProgramError for the first rejection condition of a code that is met.

    If ``only`` is not empty, only its conditions are checked. The error is located at ``word``, or at the
    code if ``word`` is None.
    """
    for when, refusal in code.rejection_conditions.items():
        if (not only or when in only) and _CONDITION_CHECKS[when](state, statement, code):
            line = state.tool_line
            if when is RejectionCondition.TOOL_NOT_MOVED:
                state.tool_line = 0  # The error is reported only once.
            raise refused(statement, code, refusal, word, line=line, on=state.modal.compensation_code)


def _with_others(_state: State, statement: Statement, code: CodeEntry) -> bool:
    others = (
        statement.words.keys() - code.allowed_words
        or statement.one_shot_code is not None
        or statement.m_number is not None
    )
    return bool(others) or len(statement.modal_codes) > 1


def _no_feed(state: State, statement: Statement, _code: CodeEntry) -> bool:
    return "F" not in statement.words and (not state.cut or state.modal.feed is None)


def _no_speed(state: State, _made: Statement, _code: CodeEntry) -> bool:
    return not (state.modal.surface_speed if state.modal.css else state.modal.rpm)


def _turning(state: State, _made: Statement, _code: CodeEntry) -> bool:
    return bool(state.modal.spindle) and not state.setup.limits.can_unclamp_while_turning


def _collet_open(state: State, _made: Statement, _code: CodeEntry) -> bool:
    return not state.modal.collet_closed and not state.setup.limits.can_start_with_collet_open


_CONDITION_CHECKS: dict[RejectionCondition, Callable[[State, Statement, CodeEntry], bool]] = {
    RejectionCondition.WITH_OTHER_WORDS: _with_others,
    RejectionCondition.WITH_FEED: lambda _, statement, _code: (
        (statement.is_f_feed_rate and "F" in statement.words)
        or 94 in statement.modal_codes
        or 95 in statement.modal_codes
    ),
    RejectionCondition.WITH_M: lambda _, statement, _code: statement.m_number is not None,
    RejectionCondition.NOSE_COMPENSATION: lambda state, _, _code: state.modal.compensation_code != 40,
    RejectionCondition.COARSE_FEED: lambda state, _, _code: bool(state.modal.coarse),
    RejectionCondition.NO_COARSE_FEED: lambda state, _, _code: not state.modal.coarse,
    RejectionCondition.INCREMENTAL_DIAMETERS: lambda state, _, _code: (
        state.modal.diameter and not state.absolute
    ),
    RejectionCondition.SURFACE_SPEED: lambda state, _, _code: state.modal.css,
    RejectionCondition.FEED_PER_REV: lambda state, _, _code: state.modal.per_rev,
    RejectionCondition.NO_FEED: _no_feed,
    RejectionCondition.NO_CUT_FEED: lambda state, _, _code: state.modal.last_cutting_feed is None,
    RejectionCondition.TOOL_NOT_MOVED: lambda state, _, _code: bool(state.tool_line),
    RejectionCondition.NO_SPEED: _no_speed,
    RejectionCondition.SPINDLE_STOPPED: lambda state, _, _code: not state.compute_rpm_at(state.x),
    RejectionCondition.SPINDLE_TURNING: _turning,
    RejectionCondition.COLLET_OPEN: _collet_open,
    RejectionCondition.C_LOCKED: lambda state, _, _code: state.modal.c_locked,
    RejectionCondition.C_NOT_LOCKED: lambda state, _, _code: not state.modal.c_locked,
    RejectionCondition.C_DISABLED: lambda state, _, _code: not state.setup.limits.is_c_enabled,
    # This condition is checked only for lines without a straight move.
    RejectionCondition.NO_STRAIGHT_MOVE: lambda *_: True,
}
