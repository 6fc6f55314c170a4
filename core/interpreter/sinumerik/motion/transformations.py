"""Activation and cancellation of the transformations TRANSMIT and TRACYL, with their conditions."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from core.geometry.virtual_mill import FacePlane, SidePlane
from core.interpreter.shared.actions import SpindleLock
from core.interpreter.shared.diagnostic_log import DiagnosticLog
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.sinumerik.motion.transformed_plane import ActiveTransformation
from core.interpreter.sinumerik.sinumerik_state import IDENTITY_FRAME, SinumerikState
from core.interpreter.sinumerik.sinumerik_statement import Statement
from core.language.sinumerik.sinumerik_words import POSITION_WORDS, Word
from core.language.sinumerik.word_table import TRANSFORMATION_GROUP
from core.message import Message

COMPENSATION_ACTIVE = 14400
"""Alarm number if radius compensation is active at the start or end of a transformation."""
TRANSFORMATION_MISSING = 14401
"""Alarm number if the transformation is not available."""
_SAME = 1e-9


def switch_transformation(state: SinumerikState, log: DiagnosticLog, statement: Statement) -> Iterator[Block]:
    """Yield the blocks of TRANSMIT, TRACYL or TRAFOOF. Raises ProgramError if the function is not allowed."""
    word = statement.g_words[TRANSFORMATION_GROUP]
    if (POSITION_WORDS & statement.words.keys()) or statement.assignments or statement.m_words:
        text: str = Message("{word} must be in a separate block.", word=word.text)
        raise statement.make_error(word, "own-block", text, "Split the block into two or more blocks.")
    if state.modal.compensation_code != 40:
        text = Message(
            "{what} is not allowed while G{state} is active.",
            what=word.text,
            state=state.modal.compensation_code,
        )
        raise statement.make_error(word, COMPENSATION_ACTIVE, text, "Write G40 and a move before this block.")
    if word.name == "TRAFOOF":
        _end_transformation(state)
        return
    frame = _frame(state, statement, word)
    _check_machine(state, statement, word)
    if not state.modal.c_locked and state.setup.limits.is_spindle_c_axis:
        state.set_modal_state(state.modal._replace(c_locked=True))
        yield state.action(statement.lexed_block.line_number, word.text, SpindleLock(orient=False))
    _end_transformation(state)
    if state.modal.diameter and word.name == "TRANSMIT" and "DIAMON" not in state.logged_functions:
        state.logged_functions.add("DIAMON")
        text = "DIAMON is active: in TRANSMIT, X is a diameter, but Y is not."
        state.log_finding(
            statement.make_warning(word, "transmit-diameter", text, "Write DIAMOF before this block.")
        )
    state.transformation = ActiveTransformation(state, log, frame)


def _end_transformation(state: SinumerikState) -> None:
    """Cancel the transformation and reset the programmed frame.

    This is also done before a new transformation is activated.
    """
    state.transformation = None
    state.programmed_frame = IDENTITY_FRAME
    state.pole, state.last_polar_point, state.direction = (0.0, 0.0), None, None
    state.derive_offsets()
    if state.modal.mill is not None:
        state.set_modal_state(state.modal._replace(mill=None))


def _check_machine(state: SinumerikState, statement: Statement, word: Word) -> None:
    modal, limits = state.modal, state.setup.limits
    if limits.third_axis_name == "Y":
        text = Message(
            "{word} creates a Y axis from X and the spindle, but the third axis of this machine is Y.",
            word=word.text,
        )
        raise statement.make_error(
            word, TRANSFORMATION_MISSING, text, "Program the part with the Y axis of this machine."
        )
    if not limits.is_c_enabled:
        text = Message("{word} rotates the part with C, but this machine has no third axis.", word=word.text)
        raise statement.make_error(
            word, TRANSFORMATION_MISSING, text, "Select a machine file that has a C axis."
        )
    if limits.is_c_linear:
        text = Message(
            "{word} rotates the part with C, but the third axis of this machine is linear.", word=word.text
        )
        raise statement.make_error(
            word, TRANSFORMATION_MISSING, text, "Select a machine file that has a C axis."
        )
    if modal.spindle:
        text = Message("{word}: the spindle is turning, but it must be locked as the C axis.", word=word.text)
        raise statement.make_error(word, "transformation", text, "Write M5 or SPOS=0 before this block.")
    if modal.zero_offset_x:
        text = Message(
            "{word}: G{settable} shifts X, but the part rotates about X0.",
            word=word.text,
            settable=modal.settable,
        )
        raise statement.make_error(
            word,
            "transformation",
            text,
            Message("Set X of G{settable} to 0, or write G500.", settable=modal.settable),
        )


def _frame(state: SinumerikState, statement: Statement, word: Word) -> FacePlane | SidePlane:
    """Return the coordinate frame of the transformation, for the side of the axis where the tool is.

    The frame is relative to the spindle axis. Raises ProgramError if the word selects groove walls or a
    data set other than the first, or if TRACYL has no diameter above 0.
    """
    refuse = partial(statement.make_error, word)
    values = [
        0.0 if each.formula is None else state.evaluate_formula(each.formula, refuse)
        for each in word.arguments
    ]
    sets = values[1:] if word.name == "TRACYL" else values
    if any(value not in {0.0, 1.0} for value in sets[:1]) or any(sets[1:]):
        text: str = Message(
            "{word} selects groove walls or a data set other than the first, but only one data "
            "set, without groove walls, is available.",
            word=word.text,
        )
        raise statement.make_error(
            word,
            TRANSFORMATION_MISSING,
            text,
            Message(
                "Write {word} without a data set number or groove walls, and program the groove "
                "walls as contours.",
                word=word.name,
            ),
        )
    far = state.x - state.modal.drawing_zero_x > -_SAME
    if word.name == "TRANSMIT":
        return FacePlane(0.0, is_far_side=far)
    diameter = values[0] * (1.0 if state.modal.metric else 25.4) if values else 0.0
    if diameter <= 0.0:
        text = "TRACYL needs the diameter on which Y is measured."
        raise statement.make_error(
            word, TRANSFORMATION_MISSING, text, "Write the diameter, as in TRACYL(40)."
        )
    return SidePlane(0.0, 0.0, diameter, is_far_side=far)
