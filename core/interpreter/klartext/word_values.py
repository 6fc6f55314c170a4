"""From words to numbers: Q parameters, input ranges, lengths in mm."""

from __future__ import annotations

from core.interpreter.klartext.feed_rates import MOST_FEED, REVOLUTION, per_minute
from core.interpreter.klartext.klartext_state import State
from core.interpreter.klartext.q_functions import content
from core.language.diagnostics import ProgramError
from core.language.klartext.klartext_faults import FEED_MISSING, INPUT_VALUE
from core.language.klartext.klartext_nodes import AxisWord, Feed, Value

# Input ranges of the control's manuals.
MOST_ANGLE = 99_999_999.9999999  # of PLANE AXIAL
MOST_POINT = 999_999_999.999999  # of PLANE POINTS
MOST_SPATIAL = 359.9999
MOST_COORDINATE = 99_999.9999
MOST_SPEED = 99_999.999


def number(state: State, value: Value, what: str, most: float, least: float | None = None) -> float:
    """The number, or the content of its Q parameter. Raises ProgramError outside ±most or below ``least``."""
    found = value.number
    if value.q is not None:
        found = content(state, value.kind, value.q, value.column)
        found = -found if value.negative else found
    low = -most if least is None else least
    if not low <= found <= most:
        raise state.refuse(
            value.column,
            INPUT_VALUE,
            "{what} {value} is not between {low} and {maximum}.",
            "Correct the value.",
            what=what,
            value=f"{found:+.12g}",
            low=f"{low:.15g}",
            maximum=f"{most:.15g}",
        )
    return found


def coordinate(state: State, word: AxisWord) -> float:
    """A length of an axis word, mm; degrees of a rotary axis."""
    found = number(state, word.value, word.axis, MOST_COORDINATE)
    return found if word.axis in "ABC" else found * state.scale


def length(state: State, value: Value | None, what: str) -> float:
    """A length that has no sign, mm; 0 where there is none."""
    return 0.0 if value is None else number(state, value, what, MOST_COORDINATE, 0.0) * state.scale


def feed_word(state: State, feed: Feed | None, column: int) -> float | None:
    """F in its unit a minute, None for rapid; without a word the one in force.

    Raises ProgramError where there is none, for one that is not above zero, and for one that counts by a
    spindle that stands.
    """
    found = programmed_feed(state, feed, column)
    return None if found is None else per_minute(state, *found, column if feed is None else feed.column)


def programmed_feed(state: State, feed: Feed | None, column: int) -> tuple[float, str] | None:
    """F as programmed and what it counts by (U a revolution, Z a tooth); None for rapid."""
    if feed is None:
        if state.feed is None:
            raise _missing(state, column, "No feed rate is active.", "Write F or FMAX.")
        return state.feed, state.feed_per
    if feed.kind == "max":
        return None
    if feed.kind == "auto":
        if state.tool_feed is None:
            raise _missing(state, feed.column, "The last TOOL CALL has no F.", "Program F in TOOL CALL.")
        return state.tool_feed, state.tool_feed_per
    assert feed.value is not None
    found = number(state, feed.value, "F", MOST_FEED, 0.0)
    if found <= 0.0:
        raise state.refuse(feed.column, INPUT_VALUE, "F must be above zero.", "Enter a feed rate.")
    return found, feed.per or (REVOLUTION if state.per_revolution else "")


def _missing(state: State, column: int, text: str, hint: str) -> ProgramError:
    return state.refuse(column, FEED_MISSING, text, hint)
