"""Conversion of axis letters in a transformed plane, and rejection of words not allowed there."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from core.interpreter.sinumerik.sinumerik_state import (
    ARC_MOTIONS,
    TAP_MOTIONS,
    THREAD_MOTIONS,
    SinumerikState,
)
from core.interpreter.sinumerik.sinumerik_statement import Statement
from core.language.sinumerik.sinumerik_words import POSITION_WORDS
from core.language.sinumerik.word_table import MOTION_GROUP, NON_MODAL_GROUP, SUPPRESSION_GROUP


class LetterMap(NamedTuple):
    """Mapping of the axis letters of a transformed plane to the letters of the ZX plane of the lathe.

    The abscissa is mapped to Z, the ordinate to X, and the depth to C.
    """

    transformation_word: str
    plane_code: int
    axis_letters: Mapping[str, str]  # X, Z, or C for the depth
    center_letters: Mapping[str, str]


FACE_LETTERS = LetterMap("TRANSMIT", 17, {"X": "Z", "Y": "X", "Z": "C"}, {"I": "K", "J": "I"})
SIDE_LETTERS = LetterMap("TRACYL", 19, {"Y": "Z", "Z": "X", "X": "C"}, {"J": "K", "K": "I"})


def check_statement(
    state: SinumerikState, names: LetterMap, statement: Statement, *, has_moved_in_contour: bool
) -> None:
    """Raise ProgramError for a statement that is not allowed in the plane.

    If ``has_moved_in_contour`` is True, the tool or the zero has changed in an unfinished corner or contour.
    """
    if has_moved_in_contour:
        text = "the tool or the zero point changes between two moves of a corner or a contour."
        hint = "Change the tool or the zero point before the corner or after G40."
        raise statement.make_error(None, "comp-with", text, hint)
    if (code := statement.get_g_code(NON_MODAL_GROUP)) in {
        25,
        26,
        74,
        75,
    } or SUPPRESSION_GROUP in statement.g_words:
        word = statement.g_words.get(SUPPRESSION_GROUP) or statement.g_words[NON_MODAL_GROUP]
        if code not in {25, 26} or {"X", "Y", "Z"} & statement.words.keys():
            text = "{word} moves the machine axes and cannot be used while {word2} is active."
            hint = "Write TRAFOOF before this block."
            raise statement.make_error(
                word, "transformation", text, hint, word=word.text, word2=names.transformation_word
            )
    if not POSITION_WORDS & statement.words.keys():
        return
    word = statement.g_words.get(MOTION_GROUP) or next(iter(statement.words.values()))
    if state.motion in THREAD_MOTIONS | TAP_MOTIONS:
        text = "a thread along Z needs the spindle running, but {word} uses the spindle as C."
        hint = "Write TRAFOOF before this block."
        raise statement.make_error(word, "transformation", text, hint, word=names.transformation_word)
    needs = (
        state.motion in ARC_MOTIONS
        or state.modal.compensation_code != 40
        or statement.corner_word
        or "ANG" in statement.words
    )
    if needs and state.plane != names.plane_code:
        text = "arcs, corners and radius compensation in {word} need G{plane}."
        hint = "Write G{plane} before this block."
        raise statement.make_error(
            word, "arc-plane", text, hint, word=names.transformation_word, plane=names.plane_code
        )
