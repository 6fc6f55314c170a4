"""What the Jog page tells on the prompt line."""

from __future__ import annotations

from app.desk import prompts
from app.desk.jogging.speeds import CONTINUOUS
from app.desk.words import tr
from core.executor.snapshot import State


def bars(state: State) -> str:
    """Why nothing is moved by hand in this state; empty when it may be."""
    words = {
        State.DISABLED: tr("THE DRIVES ARE OFF: PRESS D FOR DRIVES ON"),
        State.ESTOP: tr("THE E-STOP IS PRESSED: NOTHING MOVES"),
        State.FAULT: tr("AN ALARM STANDS: PUT ITS CAUSE RIGHT, THEN PRESS R"),
        State.HOME: tr("THE SLIDES ARE LOOKING FOR HOME: H STOPS THEM"),
    }
    if state in prompts.INTERRUPTED | {State.RUN, State.WAIT, State.HOLDING}:
        return tr("A PROGRAM IS UNDER WAY: LET IT END, OR GIVE IT UP WITH R, BEFORE JOGGING")
    return words.get(state, "")


def prompt(state: State, lost: list[str], wheel: str, step: int) -> str:
    """What may be done now. ``lost`` axes are not homed, ``wheel`` is the axis of the handwheel."""
    why = bars(state)
    if why:
        return why
    if lost:
        return tr("{axes} NOT HOMED: JOG SLOWLY, THERE ARE NO SOFT LIMITS; PRESS HOME").format(
            axes=tr(" AND ").join(sorted(lost))
        )
    if wheel:
        return tr("THE HANDWHEEL MOVES {axis}: ONE CLICK IS ONE STEP; V FOR THE NEXT AXIS").format(axis=wheel)
    if step != CONTINUOUS:
        return tr("EACH PRESS OF AN ARROW IS ONE STEP; F2 CHANGES ITS LENGTH")
    return tr("HOLD AN ARROW TO MOVE, WITH SHIFT FOR RAPID; T CHOOSES A TOOL, X AND Z TOUCH IT OFF")
