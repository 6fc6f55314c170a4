"""Feed words G94, G95, F, G00 and G01, checks of feed moves, and the coarse feeds G35, G35F2 and G36.

A coarse feed has a coarser resolution, so the position must be programmed again (G92) at each change.
"""

from __future__ import annotations

from collections.abc import Sequence

from core.interpreter.omniturn.codes.code_entry import MOST_PER_REV, Limit, When
from core.interpreter.omniturn.codes.code_rules import check_when, limit, number
from core.interpreter.omniturn.codes.code_table import G_CODES, LETTERS
from core.interpreter.omniturn.omniturn_state import HIGH_FEED, Numbers, State
from core.interpreter.omniturn.omniturn_statement import ReadyLine, Statement
from core.interpreter.omniturn.setup.spindle_and_dwell import warn_of_short_dwell
from core.interpreter.shared import units
from core.interpreter.shared.elementary_blocks import with_feed
from core.interpreter.shared.modal_state import Modal
from core.language.diagnostics import program_error
from core.language.omniturn import Word
from core.message import Message

_LEAST = LETTERS["F"].rules["F"].least * units.MM_PER_INCH  # per minute or per revolution
SLOW_MOVE = 30.0  # s; a longer move is probably a mistake
_TAPPING_LINES = 6  # number of lines within which tapping reverses the spindle
_ROUNDING = 1 + 1e-9


def feed_words(state: State, statement: Statement, *, first: bool) -> None:
    """Execute G94, G95, G00, G01 and F of a line; ``first`` means the first line of the program."""
    modes = {0, 1, 94, 95}.intersection(statement.modal)
    word = statement.words.get("F") if statement.f_is_feed else None
    if not modes and word is None:
        return
    if 0 in modes and not first:
        check_when(state, statement, G_CODES[0])
    if modes:
        _modes(state, statement, modes, has_feed=word is not None)
    if word is not None and word.value is not None:
        _feed(state, statement, word, first=first)
    if 0 in modes:
        _rapid(state, statement)


def _modes(state: State, statement: Statement, modes: set[int], *, has_feed: bool) -> None:
    modal = state.modal
    per_rev, feed = modal.per_rev, modal.feed
    if 1 in modes and not modes & {94, 95}:
        if modal.cut_feed is not None:
            per_rev, feed = modal.cut_per_rev, modal.cut_feed
        elif not has_feed:
            state.adopt(state.modal._replace(rapid=False))
            check_when(state, statement, G_CODES[1])
    elif modes & {94, 95} and per_rev != (95 in modes):
        per_rev = 95 in modes
        feed = modal.cut_feed if 1 in modes and modal.cut_per_rev == per_rev else None
    if modes - {0}:
        state.title_rapid = 0
        state.reported.discard("feed-missing")
    if modes - {0} and (modal.rapid, modal.per_rev, modal.feed) != (False, per_rev, feed):
        state.adopt(state.modal._replace(rapid=False, per_rev=per_rev, feed=feed))


def _rapid(state: State, statement: Statement) -> None:
    modal = state.modal
    if modal.rapid:
        state.title_rapid = 0 if statement.moves else state.title_rapid
        return
    titled = statement.comment is not None and not statement.moves
    cutting = state.cut and modal.feed is not None
    state.title_rapid = statement.line if titled and cutting else 0
    state.adopt(state.modal._replace(rapid=True))


def _feed(state: State, statement: Statement, word: Word, *, first: bool) -> None:
    modal = state.modal
    feed = state.feed_word(word.value or 0.0)
    most = limit(state, Limit.FEED_IN_FORCE)
    state.title_rapid = 0
    state.reported.discard("feed-missing")
    least = _LEAST if modal.per_rev else _LEAST / 60
    # The feed is also set after an error, so that later lines can be checked.
    within = min(max(feed, least), most)
    if first and not modal.per_rev:
        state.first_feed = within
        state.adopt(state.modal._replace(feed=within, rapid=False, rapid_rate=within))
        state.derive()
    elif first:
        state.adopt(modal._replace(feed=within, rapid=False))
    elif modal.rapid or not modal.feed == modal.cut_feed == within or modal.cut_per_rev is not modal.per_rev:
        state.adopt(modal._replace(feed=within, rapid=False, cut_feed=within, cut_per_rev=modal.per_rev))
    if not least / _ROUNDING <= feed <= most * _ROUNDING:
        raise statement.refuse(word, *out_of_range(modal, feed, least, most))


def another_feed(state: State, f: float) -> bool:
    """Set the feed of a plain move if a new cutting feed is its only change; return whether it was set.

    Returns False, without a change, if the full statement is needed: after a rapid, during a contour or
    compensation, under G35 and G36, and for a feed that causes an error or a warning.
    """
    feed = state.feed_word(f)
    if state.modal.coarse or state.contour.active or not _is_usual(state, feed):
        return False
    state.title_rapid = 0
    state.reported.discard("feed-missing")
    state.adopt(with_feed(state.modal, feed))
    return True


def _is_usual(state: State, feed: float) -> bool:
    """Return whether this cutting feed (mm/s or mm/rev) causes neither an error nor a warning."""
    per_rev = state.modal.per_rev
    most = limit(state, Limit.FEED_IN_FORCE)
    least, most = (_LEAST, min(most, HIGH_FEED)) if per_rev else (_LEAST / 60, most)
    return state.steady_feed is not None and least <= feed <= most


def is_free(state: State, feed: float) -> bool:
    """Return whether a move at another feed (mm/s or mm/rev) passes all checks except that of its length.

    Requires ``state.fast``: a move at the active feed must have passed the checks.
    """
    if not (state.cut and _is_usual(state, feed)) or state.is_first_feed(feed):
        return False
    return not state.modal.per_rev or speed_of(state, feed) <= state.setup.limits.max_feed * _ROUNDING


def speed_of(state: State, feed: Numbers) -> Numbers:
    """Return programmed feeds in mm/s at a constant spindle speed."""
    return feed * abs(state.rpm) / 60 if state.modal.per_rev else feed


def set_feed(state: State, feed: float) -> None:
    """Set the feed of the last move of a series, so that the next plain move needs no checks."""
    state.adopt(with_feed(state.modal, feed))
    state.slow_length = speed_of(state, feed) * SLOW_MOVE
    state.fast = True


def out_of_range(modal: Modal, feed: float, least: float, most: float) -> tuple[str, str, str]:
    """Return code, message and remedy for an invalid feed under G94 or G95."""
    rule = LETTERS["F"].rules["F"]
    refusal = rule.too_great if feed > most else rule.wrong
    assert refusal is not None
    low, high, shown = (modal.feed_text(each, per_rev=modal.per_rev) for each in (least, most, feed))
    hint = (
        "Look for a missing decimal point, or for G95 where G94 is intended."
        if modal.per_rev
        else refusal.hint
    )
    return refusal.code, Message(refusal.text, value=shown, least=low, most=high), hint


def warn_of_crash_feed(state: State, statement: Statement, ahead: Sequence[ReadyLine]) -> None:
    """Warn of F003 for F.003: a G95 feed above 0.05 in/rev, unless the spindle reverses soon (tapping)."""
    modal, word = state.modal, statement.words.get("F")
    if word is None or not statement.f_is_feed or not modal.per_rev or modal.coarse or modal.feed is None:
        return
    if modal.feed <= HIGH_FEED or _taps(modal.spindle, ahead):
        return
    shown = modal.feed_text(modal.feed, per_rev=True)
    text = "Feed {value} is very high for cutting."
    hint = "Look for a missing decimal point."
    state.log.warn(statement.line, word.column, "feed-high", text, hint, value=shown)


def _taps(spindle: int, ahead: Sequence[ReadyLine]) -> bool:
    back = {1: 4, -1: 3}.get(spindle)
    return back is not None and any(
        isinstance(step, Statement) and step.m == back for step in ahead[:_TAPPING_LINES]
    )


def check_move(state: State, line: int, x0: float, x: float, length: float) -> None:
    """Check the feed of a straight move or arc from radius ``x0`` to ``x``, with ``length`` in mm.

    Raises ProgramError with the code feed-missing, spindle-stopped, surface-speed-missing or feed-over-speed.
    """
    if state.turning is not None:
        warn_of_short_dwell(state)
    modal = state.modal
    if modal.rapid:
        return
    if modal.feed is None:
        _once(
            state,
            line,
            "feed-missing",
            "No feed is programmed for this move.",
            "Write F on this line or an earlier line.",
        )
        return
    if not (modal.per_rev or (modal.css and state.cut)):
        _warn_slow(state, line, length, modal.feed)
        return
    if modal.css and modal.spindle and not modal.surface_speed:
        text = "G96 is active, but no surface speed is programmed with S."
        _once(state, line, "surface-speed-missing", text, "Program S together with G96.")
        return
    rpm = max(abs(state.rpm_at(x0)), abs(state.rpm_at(x)))
    if x0 * x < 0:  # across the spindle centerline
        rpm = max(rpm, abs(state.rpm_at(0.0)))
    if not rpm:
        text = (
            "The spindle is stopped, but the move uses feed per revolution."
            if modal.per_rev
            else "The spindle is stopped, but the move uses constant surface speed."
        )
        _once(state, line, "spindle-stopped", text, "Start the spindle with M03 or M04, or use G94.")
        return
    speed = modal.feed * rpm / 60 if modal.per_rev else modal.feed
    most = state.setup.limits.max_feed
    if speed > most * _ROUNDING:
        limit = modal.feed_text(most, per_rev=False)
        if modal.per_rev:
            shown = modal.feed_text(modal.feed, per_rev=True)
            most_per_rev = modal.feed_text(most * 60 / rpm, per_rev=True)
            message = Message(
                "Feed {value} exceeds the maximum of {most_per_rev} at {rpm} rpm ({limit}).",
                value=shown,
                most_per_rev=most_per_rev,
                rpm=f"{rpm:.0f}",
                limit=limit,
            )
        else:
            shown = modal.feed_text(speed, per_rev=False)
            message = Message("Feed {value} exceeds the maximum of {limit}.", value=shown, limit=limit)
        raise program_error(line, 0, "feed-over-speed", message, "Lower F or S.")
    _warn_slow(state, line, length, speed)


def _once(state: State, line: int, code: str, message: str, hint: str) -> None:
    """Raise ProgramError for a move, but only once for each code."""
    if code not in state.reported:
        state.reported.add(code)
        raise program_error(line, 0, code, message, hint)


def _warn_slow(state: State, line: int, length: float, speed: float) -> None:
    state.slow_length = speed * SLOW_MOVE
    if length > state.slow_length:
        seconds = length / speed
        modal = state.modal
        shown = modal.feed_text(modal.feed or 0.0, per_rev=modal.per_rev)
        text = "This move takes {seconds} s at {value}."
        hint = "Check F and G94/G95."
        state.log.warn(line, 0, "feed-low", text, hint, seconds=f"{seconds:.0f}", value=shown)


COARSE = frozenset({35, 36})
_COARSE_STEP = 0.0005 * units.MM_PER_INCH * (1 + 1e-9)  # mm; the coarsest resolution


def looks_ahead(statement: Statement) -> bool:
    """Return whether a line needs the following lines: G92 after G35 and G36, or tapping after F."""
    return "F" in statement.words or not COARSE.isdisjoint(statement.modal)


def coarse_line(state: State, statement: Statement, ahead: Sequence[ReadyLine]) -> bool:
    """Execute a line with G35 or G36; return False for any other line. Raises ProgramError.

    T is an error while G35 is active.
    """
    if COARSE.isdisjoint(statement.modal):
        if "T" in statement.words:
            check_when(state, statement, LETTERS["T"])
        return False
    _change(state, statement, ahead)
    return True


def _change(state: State, statement: Statement, ahead: Sequence[ReadyLine]) -> None:
    """Start or end the coarse feed; ``ahead`` are the following lines."""
    code = 35 if 35 in statement.modal else 36
    before = state.modal.coarse
    entry = G_CODES[code]
    check_when(state, statement, entry, When.WITH_OTHERS)
    if "F" in statement.words:
        number(state, statement, "F", entry)
    check_when(state, statement, entry)
    _check_place(state, statement, code)
    state.coarse_at = (state.x + state.offset_x, state.z + state.offset_z) if code == 35 else None
    modal = state.modal._replace(coarse=0 if code == 36 else 2 if "F" in statement.words else 1)
    if before and code == 36 and modal.per_rev and (modal.feed or 0.0) > MOST_PER_REV[0] * (1 + 1e-9):
        modal = modal._replace(feed=None, cut_feed=None)
    state.adopt(modal)
    _check_preset(state, statement, code, ahead)


def _check_place(state: State, statement: Statement, code: int) -> None:
    """Check that G36 is at the position of its G35. Raises ProgramError."""
    if code == 35 or state.coarse_at is None:
        return
    x, z = state.coarse_at
    if max(abs(state.x + state.offset_x - x), abs(state.z + state.offset_z - z)) > _COARSE_STEP:
        place = (
            state.modal.length_text(x - state.offset_x),
            state.modal.length_text(z - state.offset_z),
        )
        # G36 takes effect, so that later lines are checked as intended.
        state.adopt(state.modal._replace(coarse=0))
        text = "G36 is not at the same position as G35, which was at radius {place}, Z {place2}."
        hint = "Move back to the G35 position before G36."
        raise statement.refuse(1, "coarse-place", text, hint, place=place[0], place2=place[1])


def _check_preset(state: State, statement: Statement, code: int, ahead: Sequence[ReadyLine]) -> None:
    """Check that the next line is G92 with the present coordinates. Raises ProgramError."""
    line = next((step for step in ahead if step is not None), None)
    hint = "Write G92 with the current X and Z on the next line."
    if not isinstance(line, Statement) or line.one_shot != 92 or not {"X", "Z"}.issubset(line.words):
        text = "G{code} is not followed by a G92 with X and Z."
        raise statement.refuse(1, "coarse-preset", text, hint, code=code)
    x, z = (line.value("X") or 0.0) * state.scale_x, (line.value("Z") or 0.0) * state.scale_z
    if max(abs(x - state.px), abs(z - state.pz)) > _COARSE_STEP or line.modal:
        here = state.modal.length_text(state.px), state.modal.length_text(state.pz)
        text = (
            "The G92 after G{code} does not match the current position, which is radius {position}, Z "
            "{position2}."
        )
        raise line.refuse("X", "coarse-preset", text, hint, code=code, position=here[0], position2=here[1])
