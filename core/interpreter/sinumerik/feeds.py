"""F, G94 and G95: one feed word, read by the kind of block; and what a block needs before it may run."""

from __future__ import annotations

from core.interpreter.sinumerik.state import State, positive
from core.interpreter.sinumerik.statement import Statement
from core.language.sinumerik.words import Word

NO_FEED = 10860


def feed_words(state: State, made: Statement) -> None:
    """G94, G95 and F of a block. Changing between the two forgets F. Raises ProgramError."""
    code = made.code("kind of feed")
    if code is not None and (code == 95) != state.modal.per_rev:
        state.adopt(state.modal._replace(per_rev=code == 95, feed=None))
    word = made.words.get("F")
    if word is None or made.code("dwell") is not None:
        return
    value = positive(made, word, state.number(made, word), "the feed")
    # mm/min and degrees/min, or mm and degrees a revolution: the kind of block tells which.
    state.adopt(state.modal._replace(feed=value if state.modal.per_rev else value / 60.0))


def check_feed(state: State, made: Statement, x0: float, x1: float) -> float:
    """The feed in force for a block from radius ``x0`` to ``x1``, mm (degrees) a second or a revolution.

    Raises ProgramError: alarm 10860 where there is none; ours where G95 has no speed to go by.
    """
    modal = state.modal
    if modal.feed is None:
        hint = "Write F. Between G94 and G95 the old value is forgotten."
        raise made.alarm(_mover(made), NO_FEED, "no feedrate is programmed.", hint)
    if modal.css and modal.spindle and not modal.surface_speed:
        text = "G96 is in force and no S has given a surface speed."
        raise made.refuse(made.words.get("S"), "surface-speed-missing", text, "Write S beside G96.")
    if modal.per_rev and not (state.rpm_at(x0) and state.rpm_at(x1)):
        text = "no spindle speed for G95: the spindle stands."
        raise made.refuse(
            _mover(made), "g95-spindle-stopped", text, "Start it with S and M3 or M4, or use G94."
        )
    return modal.feed


def _mover(made: Statement) -> Word | None:
    """The word that wants to move."""
    return next((made.words[name] for name in made.axes), None)
