"""Feed words F, FB and OVR. The codes G94 to G97 determine the meaning of F."""

from __future__ import annotations

from core.interpreter.shared.units import MM_PER_INCH
from core.interpreter.sinumerik.sinumerik_state import SinumerikState, require_positive_number
from core.interpreter.sinumerik.sinumerik_statement import Statement
from core.language.sinumerik.sinumerik_words import Word
from core.language.sinumerik.word_table import DWELL_GROUP, FEED_TYPE_GROUP, MOTION_GROUP

MISSING_FEED = 10860

_PER_REV_BY_CODE = {94: False, 95: True, 96: True, 961: False, 97: True, 971: False, 973: True}
"""Whether each code of the feed type group sets feed per revolution. G962 and G972 do not change it."""


_LEAD_MOTIONS = frozenset({34, 35})
"""G codes of motions for which F is the change in lead."""


def execute_feed_words(state: SinumerikState, statement: Statement) -> None:
    """Execute the feed type, F, OVR, FRCM and RNDM of a block.

    A change between feed per minute and feed per revolution deletes F. Raises ProgramError for an invalid
    value.
    """
    per_rev = _PER_REV_BY_CODE.get(statement.get_g_code(FEED_TYPE_GROUP) or 0, state.modal.per_rev)
    if per_rev != state.modal.per_rev:
        state.set_modal_state(state.modal._replace(per_rev=per_rev, feed=None))
        state.corner_feed = None
    if word := statement.words.get("OVR"):
        state.override = state.number(statement, word) / 100.0
    if word := statement.words.get("FRCM"):
        value = state.number(statement, word)
        state.corner_feed = convert_feed(state, statement, word) if value else None
    if word := statement.words.get("RNDM"):
        state.rounding = state.length(statement, word)
    word = statement.words.get("F")
    motion = statement.get_g_code(MOTION_GROUP)
    leads = (state.motion if motion is None else motion) in _LEAD_MOTIONS
    if word is not None and statement.get_g_code(DWELL_GROUP) is None and not leads:
        state.set_modal_state(state.modal._replace(feed=convert_feed(state, statement, word)))


def convert_feed(state: SinumerikState, statement: Statement, word: Word) -> float:
    """Return a feed in mm (or degrees) per second or per revolution.

    Raises ProgramError if the feed is not above 0.
    """
    value = require_positive_number(statement, word, state.number(statement, word), "the feed")
    value *= MM_PER_INCH if state.feed_in_inches else 1.0
    # The unit is mm/min and degrees/min, or mm and degrees per revolution, depending on the kind of block.
    return value if state.modal.per_rev else value / 60.0


def check_block_feed(
    state: SinumerikState, statement: Statement, x0: float, x1: float, *, is_in_degrees: bool = False
) -> float:
    """Return the feed of a block from radius ``x0`` to ``x1``.

    The feed is in mm (or degrees) per second or per revolution, and includes the factor of OVR. A feed per
    revolution of the live tool is converted to a feed per second, because the live tool has a constant
    speed. Raises ProgramError with alarm 10860 if no feed is active. Raises ProgramError with a TurnDesk
    code if FB is not above 0, if G96 is active without a surface speed, or if the spindle or the live tool
    that determines a feed per revolution is stopped.
    """
    modal = state.modal
    word = statement.words.get("FB")
    feed = modal.feed if word is None else convert_feed(state, statement, word)
    if feed is None:
        hint = "Program F. A change between G94 and G95 deletes F; G96 and G97 have the same effect as G95."
        raise statement.make_error(
            _first_axis_word(statement), MISSING_FEED, "no feedrate is programmed.", hint
        )
    if modal.css and modal.spindle and not modal.surface_speed:
        text = "G96 is active, but no surface speed is programmed with S."
        hint = "Program S together with G96."
        raise statement.make_error(statement.words.get("S"), "surface-speed-missing", text, hint)
    by_tool = modal.per_rev and state.master != 1
    if by_tool and not state.live_rpm:
        text = "G95 needs the live tool speed because SETMS(2) is active, but the live tool is stopped."
        hint = "Start the live tool with S and M3."
        raise statement.make_error(_first_axis_word(statement), "g95-spindle-stopped", text, hint)
    if (
        modal.per_rev
        and not by_tool
        and not (state.compute_rpm_at_radius(x0) and state.compute_rpm_at_radius(x1))
    ):
        text = "G95 needs a spindle speed, but the spindle is stopped."
        hint = "Start the spindle with S and M3 or M4, or use G94."
        raise statement.make_error(_first_axis_word(statement), "g95-spindle-stopped", text, hint)
    feed *= abs(state.live_rpm) / 60.0 if by_tool else 1.0
    return feed * state.override / (MM_PER_INCH if is_in_degrees and state.feed_in_inches else 1.0)


def _first_axis_word(statement: Statement) -> Word | None:
    """Return the first axis word of the block, or None if the block has no axis words."""
    return next((statement.words[name] for name in statement.axis_names), None)
