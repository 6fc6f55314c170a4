"""Feed words G94, G95, F, G00 and G01, checks of feed moves, and the coarse feeds G35, G35F2 and G36.

A coarse feed reduces the position resolution, so the position must be programmed again (G92) at each
change.
"""

from __future__ import annotations

from collections.abc import Sequence

from core.interpreter.omniturn.codes.code_entry import MAX_FEEDS_PER_REV, RejectionCondition, WordLimit
from core.interpreter.omniturn.codes.code_rules import check_conditions, get_limit, number
from core.interpreter.omniturn.codes.code_table import G_CODES, LETTER_ENTRIES
from core.interpreter.omniturn.omniturn_state import HIGH_FEED_MM_PER_REV, FloatOrArray, State
from core.interpreter.omniturn.omniturn_statement import ExecutableLine, Statement
from core.interpreter.omniturn.setup.spindle_and_dwell import warn_about_short_dwell
from core.interpreter.shared import units
from core.interpreter.shared.elementary_blocks import replace_feed
from core.interpreter.shared.modal_state import ModalState
from core.language.diagnostics import make_program_error
from core.language.omniturn import Word
from core.message import Message

_MIN_FEED = LETTER_ENTRIES["F"].word_rules["F"].minimum * units.MM_PER_INCH  # per minute or per revolution
SLOW_MOVE_TIME_S = 30.0  # s; a longer move is probably a mistake
_TAPPING_LINES = 6  # number of lines within which tapping reverses the spindle
_ROUNDING = 1 + 1e-9


def execute_feed_words(state: State, statement: Statement, *, is_first_line: bool) -> None:
    """Execute G94, G95, G00, G01 and F of a line.

    ``is_first_line`` means that the line is the first line of the program.
    """
    modes = {0, 1, 94, 95}.intersection(statement.modal_codes)
    word = statement.words.get("F") if statement.is_f_feed_rate else None
    if not modes and word is None:
        return
    if 0 in modes and not is_first_line:
        check_conditions(state, statement, G_CODES[0])
    if modes:
        _modes(state, statement, modes, has_feed=word is not None)
    if word is not None and word.value is not None:
        _feed(state, statement, word, first=is_first_line)
    if 0 in modes:
        _rapid(state, statement)


def _modes(state: State, statement: Statement, modes: set[int], *, has_feed: bool) -> None:
    modal = state.modal
    per_rev, feed = modal.per_rev, modal.feed
    if 1 in modes and not modes & {94, 95}:
        if modal.last_cutting_feed is not None:
            per_rev, feed = modal.is_cutting_feed_per_rev, modal.last_cutting_feed
        elif not has_feed:
            state.set_modal(state.modal._replace(rapid=False))
            check_conditions(state, statement, G_CODES[1])
    elif modes & {94, 95} and per_rev != (95 in modes):
        per_rev = 95 in modes
        feed = modal.last_cutting_feed if 1 in modes and modal.is_cutting_feed_per_rev == per_rev else None
    if modes - {0}:
        state.title_rapid = 0
        state.reported.discard("feed-missing")
    if modes - {0} and (modal.rapid, modal.per_rev, modal.feed) != (False, per_rev, feed):
        state.set_modal(state.modal._replace(rapid=False, per_rev=per_rev, feed=feed))


def _rapid(state: State, statement: Statement) -> None:
    modal = state.modal
    if modal.rapid:
        state.title_rapid = 0 if statement.has_x_or_z_move else state.title_rapid
        return
    titled = statement.comment is not None and not statement.has_x_or_z_move
    cutting = state.cut and modal.feed is not None
    state.title_rapid = statement.line if titled and cutting else 0
    state.set_modal(state.modal._replace(rapid=True))


def _feed(state: State, statement: Statement, word: Word, *, first: bool) -> None:
    modal = state.modal
    feed = state.convert_feed(word.value or 0.0)
    most = get_limit(state, WordLimit.ACTIVE_FEED)
    state.title_rapid = 0
    state.reported.discard("feed-missing")
    least = _MIN_FEED if modal.per_rev else _MIN_FEED / 60
    # The feed is also set after an error, so that later lines can be checked.
    within = min(max(feed, least), most)
    if first and not modal.per_rev:
        state.first_feed = within
        state.set_modal(state.modal._replace(feed=within, rapid=False, rapid_rate=within))
        state.update_derived_values()
    elif first:
        state.set_modal(modal._replace(feed=within, rapid=False))
    elif (
        modal.rapid
        or not modal.feed == modal.last_cutting_feed == within
        or modal.is_cutting_feed_per_rev is not modal.per_rev
    ):
        state.set_modal(
            modal._replace(
                feed=within, rapid=False, last_cutting_feed=within, is_cutting_feed_per_rev=modal.per_rev
            )
        )
    if not least / _ROUNDING <= feed <= most * _ROUNDING:
        raise statement.make_error(word, *describe_feed_error(modal, feed, least, most))


def set_plain_move_feed(state: State, f: float) -> bool:
    """Set the feed of a move that changes only the cutting feed, and return whether it was set.

    The result is False, and nothing is changed, if the line must be executed as a full statement. This is
    the case after a rapid, within a contour, during compensation, under G35 and G36, and for a feed that
    causes an error or a warning.
    """
    feed = state.convert_feed(f)
    if state.modal.coarse or state.contour.is_buffering or not _is_usual(state, feed):
        return False
    state.title_rapid = 0
    state.reported.discard("feed-missing")
    state.set_modal(replace_feed(state.modal, feed))
    return True


def _is_usual(state: State, feed: float) -> bool:
    """Return whether a cutting feed in mm/s or mm/rev causes neither an error nor a warning."""
    per_rev = state.modal.per_rev
    most = get_limit(state, WordLimit.ACTIVE_FEED)
    least, most = (_MIN_FEED, min(most, HIGH_FEED_MM_PER_REV)) if per_rev else (_MIN_FEED / 60, most)
    return state.steady_feed is not None and least <= feed <= most


def is_feed_accepted(state: State, feed: float) -> bool:
    """Return whether a move at another feed would pass all checks except that of its length.

    The feed is in mm/s or mm/rev. The function requires ``state.fast``, which means that a move at the
    active feed has passed the checks.
    """
    if not (state.cut and _is_usual(state, feed)) or state.is_first_line_feed(feed):
        return False
    return (
        not state.modal.per_rev
        or compute_feed_speed(state, feed) <= state.setup.limits.max_feed_mm_s * _ROUNDING
    )


def compute_feed_speed(state: State, feed: FloatOrArray) -> FloatOrArray:
    """Convert programmed feeds to mm/s at a constant spindle speed."""
    return feed * abs(state.rpm) / 60 if state.modal.per_rev else feed


def set_series_feed(state: State, feed: float) -> None:
    """Set the feed to that of the last move of a series, so that the next plain move needs no checks."""
    state.set_modal(replace_feed(state.modal, feed))
    state.slow_length_mm = compute_feed_speed(state, feed) * SLOW_MOVE_TIME_S
    state.fast = True


def describe_feed_error(
    modal: ModalState, feed: float, minimum: float, maximum: float
) -> tuple[str, str, str]:
    """Return the code, message and remedy for an invalid feed under G94 or G95."""
    rule = LETTER_ENTRIES["F"].word_rules["F"]
    refusal = rule.too_large_error if feed > maximum else rule.invalid_error
    assert refusal is not None
    low, high, shown = (
        modal.format_feed(each, is_per_rev=modal.per_rev) for each in (minimum, maximum, feed)
    )
    hint = (
        "Look for a missing decimal point, or for G95 where G94 is intended."
        if modal.per_rev
        else refusal.hint
    )
    return refusal.diagnostic_code, Message(refusal.text, value=shown, least=low, most=high), hint


def warn_about_high_feed(
    state: State, statement: Statement, following_lines: Sequence[ExecutableLine]
) -> None:
    """Log a warning for a G95 feed above 0.05 in/rev, such as F003 instead of F.003.

    The warning is omitted if the spindle soon reverses, because the program is then tapping.
    """
    modal, word = state.modal, statement.words.get("F")
    if (
        word is None
        or not statement.is_f_feed_rate
        or not modal.per_rev
        or modal.coarse
        or modal.feed is None
    ):
        return
    if modal.feed <= HIGH_FEED_MM_PER_REV or _taps(modal.spindle, following_lines):
        return
    shown = modal.format_feed(modal.feed, is_per_rev=True)
    text = "Feed {value} is very high for cutting."
    hint = "Look for a missing decimal point."
    state.log.add_warning(statement.line, word.column, "feed-high", text, hint, value=shown)


def _taps(spindle: int, ahead: Sequence[ExecutableLine]) -> bool:
    back = {1: 4, -1: 3}.get(spindle)
    return back is not None and any(
        isinstance(step, Statement) and step.m_number == back for step in ahead[:_TAPPING_LINES]
    )


def check_move_feed(state: State, line: int, x0: float, x: float, length: float) -> None:
    """Check the feed of a straight move or arc from radius ``x0`` to ``x``, with ``length`` in mm.

    Raises ProgramError with the code ``feed-missing``, ``spindle-stopped``, ``surface-speed-missing`` or
    ``feed-over-speed``. ``feed-missing`` and ``spindle-stopped`` are raised once until the feed or the
    spindle is programmed again, and ``surface-speed-missing`` is raised only once. A slow move causes a
    warning.
    """
    if state.turning is not None:
        warn_about_short_dwell(state)
    modal = state.modal
    if modal.rapid:
        return
    if modal.feed is None:
        _raise_once(
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
        _raise_once(state, line, "surface-speed-missing", text, "Program S together with G96.")
        return
    rpm = max(abs(state.compute_rpm_at(x0)), abs(state.compute_rpm_at(x)))
    if x0 * x < 0:  # across the spindle centerline
        rpm = max(rpm, abs(state.compute_rpm_at(0.0)))
    if not rpm:
        text = (
            "The spindle is stopped, but the move uses feed per revolution."
            if modal.per_rev
            else "The spindle is stopped, but the move uses constant surface speed."
        )
        _raise_once(state, line, "spindle-stopped", text, "Start the spindle with M03 or M04, or use G94.")
        return
    speed = modal.feed * rpm / 60 if modal.per_rev else modal.feed
    most = state.setup.limits.max_feed_mm_s
    if speed > most * _ROUNDING:
        limit = modal.format_feed(most, is_per_rev=False)
        if modal.per_rev:
            shown = modal.format_feed(modal.feed, is_per_rev=True)
            most_per_rev = modal.format_feed(most * 60 / rpm, is_per_rev=True)
            message = Message(
                "Feed {value} exceeds the maximum of {most_per_rev} at {rpm} rpm ({limit}).",
                value=shown,
                most_per_rev=most_per_rev,
                rpm=f"{rpm:.0f}",
                limit=limit,
            )
        else:
            shown = modal.format_feed(speed, is_per_rev=False)
            message = Message("Feed {value} exceeds the maximum of {limit}.", value=shown, limit=limit)
        raise make_program_error(line, 0, "feed-over-speed", message, "Lower F or S.")
    _warn_slow(state, line, length, speed)


def _raise_once(state: State, line: int, code: str, message: str, hint: str) -> None:
    """Raise ProgramError for a move, but only once for each error code."""
    if code not in state.reported:
        state.reported.add(code)
        raise make_program_error(line, 0, code, message, hint)


def _warn_slow(state: State, line: int, length: float, speed: float) -> None:
    state.slow_length_mm = speed * SLOW_MOVE_TIME_S
    if length > state.slow_length_mm:
        seconds = length / speed
        modal = state.modal
        shown = modal.format_feed(modal.feed or 0.0, is_per_rev=modal.per_rev)
        text = "This move takes {seconds} s at {value}."
        hint = "Check F and G94/G95."
        state.log.add_warning(line, 0, "feed-low", text, hint, seconds=f"{seconds:.0f}", value=shown)


COARSE_FEED_CODES = frozenset({35, 36})
_COARSE_STEP = 0.0005 * units.MM_PER_INCH * (1 + 1e-9)  # mm; the coarsest resolution


def needs_following_lines(statement: Statement) -> bool:
    """Return whether the following lines must be known to execute a line.

    G35 and G36 need a G92 on the next line. F needs to know whether tapping follows.
    """
    return "F" in statement.words or not COARSE_FEED_CODES.isdisjoint(statement.modal_codes)


def execute_coarse_feed(
    state: State, statement: Statement, following_lines: Sequence[ExecutableLine]
) -> bool:
    """Execute a line with G35 or G36, or return False for any other line.

    T is an error while G35 is active. Raises ProgramError for an invalid line.
    """
    if COARSE_FEED_CODES.isdisjoint(statement.modal_codes):
        if "T" in statement.words:
            check_conditions(state, statement, LETTER_ENTRIES["T"])
        return False
    _change(state, statement, following_lines)
    return True


def _change(state: State, statement: Statement, following_lines: Sequence[ExecutableLine]) -> None:
    """Execute G35, which starts the coarse feed, or G36, which ends it."""
    code = 35 if 35 in statement.modal_codes else 36
    before = state.modal.coarse
    entry = G_CODES[code]
    check_conditions(state, statement, entry, RejectionCondition.WITH_OTHER_WORDS)
    if "F" in statement.words:
        number(state, statement, "F", entry)
    check_conditions(state, statement, entry)
    _check_position(state, statement, code)
    state.coarse_start_point = (state.x + state.offset_x, state.z + state.offset_z) if code == 35 else None
    modal = state.modal._replace(coarse=0 if code == 36 else 2 if "F" in statement.words else 1)
    if before and code == 36 and modal.per_rev and (modal.feed or 0.0) > MAX_FEEDS_PER_REV[0] * (1 + 1e-9):
        modal = modal._replace(feed=None, last_cutting_feed=None)
    state.set_modal(modal)
    _check_preset(state, statement, code, following_lines)


def _check_position(state: State, statement: Statement, code: int) -> None:
    """Raise ProgramError if G36 is programmed at another position than the preceding G35."""
    if code == 35 or state.coarse_start_point is None:
        return
    x, z = state.coarse_start_point
    if max(abs(state.x + state.offset_x - x), abs(state.z + state.offset_z - z)) > _COARSE_STEP:
        place = (
            state.modal.format_length(x - state.offset_x),
            state.modal.format_length(z - state.offset_z),
        )
        # G36 takes effect, so that later lines are checked as intended.
        state.set_modal(state.modal._replace(coarse=0))
        text = "G36 is not at the same position as G35, which was at radius {place}, Z {place2}."
        hint = "Move back to the G35 position before G36."
        raise statement.make_error(1, "coarse-place", text, hint, place=place[0], place2=place[1])


def _check_preset(
    state: State, statement: Statement, code: int, following_lines: Sequence[ExecutableLine]
) -> None:
    """Raise ProgramError unless the next line is a G92 that programs the current coordinates."""
    line = next((step for step in following_lines if step is not None), None)
    hint = "Write G92 with the current X and Z on the next line."
    if not isinstance(line, Statement) or line.one_shot_code != 92 or not {"X", "Z"}.issubset(line.words):
        text = "G{code} is not followed by a G92 with X and Z."
        raise statement.make_error(1, "coarse-preset", text, hint, code=code)
    x, z = (
        (line.get_value("X") or 0.0) * state.mm_per_x_unit,
        (line.get_value("Z") or 0.0) * state.mm_per_z_unit,
    )
    if max(abs(x - state.px), abs(z - state.pz)) > _COARSE_STEP or line.modal_codes:
        here = state.modal.format_length(state.px), state.modal.format_length(state.pz)
        text = (
            "The G92 after G{code} does not match the current position, which is radius {position}, Z "
            "{position2}."
        )
        raise line.make_error(
            "X", "coarse-preset", text, hint, code=code, position=here[0], position2=here[1]
        )
