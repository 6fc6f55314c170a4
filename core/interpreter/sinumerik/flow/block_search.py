"""Start of a pass from a saved state, for MDI (MDA) and for block search with calculation.

The modal state comes from the saved pass. The axis positions are the current positions.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from core.interpreter.shared.checkpoint import CAxisMove, Checkpoint, ModalStateLine, PassStart, SavedPass
from core.interpreter.shared.job_setup import ToolOffset
from core.interpreter.shared.modal_state import ModalState
from core.interpreter.sinumerik.flow.subprogram_flow import SinumerikProgramFlow
from core.interpreter.sinumerik.motion.chamfers_and_roundings import SinumerikCornerStage
from core.interpreter.sinumerik.sinumerik_state import (
    ZERO_SETTABLE_OFFSET,
    SinumerikState,
    format_motion_word,
)
from core.language.diagnostics import Diagnostic, make_error_diagnostic
from core.language.sinumerik.control_statements import ControlKeyword
from core.language.sinumerik.sinumerik_lexer import lex_line
from core.language.sinumerik.sinumerik_words import CORNER_WORDS, INTERNAL_AXIS_NAME, LexedBlock
from core.language.source import ProgramSource
from core.message import Message
from core.tool_edges import format_edge_name


class InterpreterComponents(NamedTuple):
    """The parts of an interpreter that contain its state and are copied when a pass is saved.

    ``pending_line`` is a block that was read but not yet executed.
    """

    state: SinumerikState
    corner_stage: SinumerikCornerStage
    program_flow: SinumerikProgramFlow
    pending_line: LexedBlock | None = None


def make_checkpoint(parts: InterpreterComponents, shared: tuple[object, ...], blocks: int) -> Checkpoint:
    """Return the state that the next block inherits, from which another pass can continue."""
    state, modal = parts.state, parts.state.modal
    x, z, c = state.x - modal.offset_x, state.z - modal.offset_z, state.c - modal.offset_c
    kept = SavedPass(parts, shared, tuple(_lines(state)))
    return Checkpoint(modal, x, z, c, x, z, blocks=blocks, kept=kept)


def restore_state(state: SinumerikState, pass_start: PassStart) -> None:
    """Update the state with the current axis positions, offsets and machine functions."""
    was, now = state.modal, pass_start.checkpoint.modal
    state.x, state.z, state.c = state.setup.start
    if not pass_start.is_mdi_line:
        state.x, state.z = pass_start.checkpoint.machine
        state.c = next(
            (step.angle_deg for step in pass_start.approach_steps if isinstance(step, CAxisMove)), state.c
        )
    state.modal = was._replace(
        tool=now.tool,
        edge=now.edge,
        spindle=now.spindle,
        rpm=now.rpm,
        coolant=now.coolant,
        collet_closed=now.collet_closed,
        outputs=now.outputs,
        comment=now.comment,
        c_locked=now.c_locked,
        oriented=now.oriented,
    )
    state.settable = state.setup.zero.get(was.settable, ZERO_SETTABLE_OFFSET)
    state.edge = state.setup.tools.get(now.tool, ToolOffset()) if now.tool else ToolOffset()
    state.derive_offsets()


def _lines(state: SinumerikState) -> Iterator[ModalStateLine]:
    """Yield the modal state as text, with one line for each group of functions."""
    modal = state.modal
    yield ModalStateLine("motion", format_motion_word(state.motion))
    yield ModalStateLine("settable", f"G{modal.settable}" if modal.settable else "G500")
    yield ModalStateLine("trans", _trans(modal))
    plane = state.transformation
    yield ModalStateLine("transformation", "" if plane is None else plane.name)
    yield ModalStateLine("units", "G71 MM" if modal.metric else "G70 INCH")
    yield ModalStateLine("x words", "DIAMON Ø" if modal.diameter else "DIAMOF R")
    yield ModalStateLine("distance", "G90" if modal.absolute else "G91")
    yield ModalStateLine("tool", format_edge_name(modal.tool) if modal.tool else "")
    yield ModalStateLine(
        "speed", f"G96 S{modal.surface_speed * 0.06:g}" if modal.css else f"G97 S{modal.rpm:g}"
    )
    held = f"SPOS={modal.oriented:g}" if modal.oriented is not None else "M5"
    yield ModalStateLine("spindle", {1: "M3", 0: held, -1: "M4"}[modal.spindle])
    feed = "" if modal.feed is None else f" F{modal.feed if modal.per_rev else modal.feed * 60.0:g}"
    yield ModalStateLine("feed", f"{'G95' if modal.per_rev else 'G94'}{feed}")
    yield ModalStateLine("coolant", "M8" if modal.coolant else "M9")
    yield ModalStateLine("outputs", " ".join(sorted(name.upper() for name in modal.outputs)))


def _trans(modal: ModalState) -> str:
    if not modal.frame_shift_x and not modal.frame_shift_z:
        return ""
    return f"X{modal.frame_shift_x:+.3f}  Z{modal.frame_shift_z:+.3f}"


_HINT = "Use this command in a program."
_SINGLE_BLOCK_KEYWORDS = frozenset({ControlKeyword.DEFINE, ControlKeyword.MESSAGE})


def check_single_block(source: ProgramSource, third_axis: str = INTERNAL_AXIS_NAME) -> Diagnostic | None:
    """Return the error for a block that is not allowed in MDI, or None if it is allowed."""
    line = lex_line(1, source.lines[0] if source.lines else "", third_axis)
    if line.errors:
        return None  # reported when the block is executed
    if line.skip_level is not None:
        return _refuse(1, "/ skips a program block and has no meaning in MDI")
    if line.called_name or line.is_modal_call:
        return _refuse(
            line.call_column,
            Message("{call} calls another program and cannot be used in MDI", call=line.called_name),
        )
    if line.control_statement is not None and line.control_statement.keyword not in _SINGLE_BLOCK_KEYWORDS:
        return _refuse(
            line.control_statement.column,
            Message(
                "{steering} jumps to another block and cannot be used in MDI",
                steering=line.control_statement.keyword,
            ),
        )
    return _check_words(line)


def _check_words(line: LexedBlock) -> Diagnostic | None:
    """Return the error for a word that depends on later blocks, or None if no word depends on them."""
    for word in line.words:
        if word.name in CORNER_WORDS:
            return _refuse(
                word.column, Message("{word} is allowed only between two blocks of a contour", word=word.text)
            )
    return None


def _refuse(column: int, what: str) -> Diagnostic:
    return make_error_diagnostic(1, column, "not-alone-mdi", Message("{what}.", what=what), _HINT)
