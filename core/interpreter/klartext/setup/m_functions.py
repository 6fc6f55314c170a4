"""Execution of M functions, before or after the motion of their block."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from core.geometry.working_plane import ProgramTransform
from core.interpreter.klartext.cycles.cycle_moves import (
    CANNOT_ORIENT_HINT,
    CANNOT_ORIENT_TEXT,
    make_orientation_block,
)
from core.interpreter.klartext.flow import word_values
from core.interpreter.klartext.klartext_state import State
from core.interpreter.klartext.motion.plane_functions import (
    compute_retract_length,
    make_retract_block,
    set_tcpm_active,
)
from core.interpreter.klartext.setup.tool_call import format_tool
from core.interpreter.shared import actions
from core.interpreter.shared.elementary_blocks import Block
from core.language.diagnostics import Severity
from core.language.klartext.klartext_faults import (
    CONTRADICTION,
    M_FUNCTION_UNDEFINED,
    NOT_ALLOWED_WITH_M128,
    WRONG_RPM,
    make_syntax_error,
    make_unsupported_error,
)
from core.language.klartext.klartext_words import MFunction
from core.message import Message

M19, M89, M91, M92, M99 = 19, 89, 91, 92, 99
FEED_CODES = frozenset({103, 136, 137})  # executed in ``feed_rates``, before the other words
INEFFECTIVE_CODES = frozenset({102, 115, 145})  # they end functions that TurnDesk does not have
SISTER_TOOL_CODE = 101
CODES_BEFORE_MOTION = (
    frozenset({3, 4, 8, 13, 14, SISTER_TOOL_CODE, 116, 117, 126, 127, 128, 129, 140})
    | FEED_CODES
    | INEFFECTIVE_CODES
)
PROGRAM_END_CODES = frozenset({2, 30})
_CODES_AFTER_MOTION = frozenset({0, 1, 2, 5, 6, 9, M19, 30})
_BLOCKWISE_CODES = frozenset({M89, M91, M99})
_SECOND_DATUM = frozenset({M92})  # requires a second datum in the machine file

# These functions have no effect, because TurnDesk performs their tasks differently: smoothing and look-ahead
# (90, 112, 113, 120, 124), small contour steps and open corners (97, 98), feed at arcs (109, 110, 111),
# messages (107, 108), display of rotary axes (94), superimposed handwheel (118), exact stops (134, 135),
# retract at a stop (148), loop gains (105, 106), touch probe monitoring (141).
IGNORED_CODES = frozenset(
    {90, 94, 97, 98, 105, 106, 107, 108, 109, 110, 111, 112, 113, 118, 120, 124, 134, 135, 141, 148}
)

# Functions of the control that are not supported: previous datum (104), older tip control (114, 144),
# positions in the untilted system (130, 138), cleared programs and rotations (142, 143), travel past limits
# (150).
_UNSUPPORTED_CODES = frozenset({104, 114, 130, 138, 142, 143, 144, 150})
_TURNS = {3: 1, 4: -1, 13: 1, 14: -1}
_MACHINE_CODE_HINT = "Assign an output to this machine-builder code under [m_codes], or remove the code."
_ADVICE = {
    M92: (
        "Define the second machine datum as fixed_points under [axis.X], [axis.Y] and "
        "[axis.Z], or use M91 to measure from machine zero."
    )
}


def check(state: State, codes: Sequence[MFunction]) -> None:
    """Raise ProgramError for M functions that are unavailable or must not be combined.

    Some M functions must not be in the same block, and some are not permitted while M128 is active.
    """
    limits = state.setup.limits
    known = (
        CODES_BEFORE_MOTION
        | _CODES_AFTER_MOTION
        | _BLOCKWISE_CODES
        | IGNORED_CODES
        | limits.m_code_outputs.keys()
        | limits.ignored_m_codes
    )
    known |= _SECOND_DATUM if limits.fixed_points else frozenset()
    for position, code in enumerate(codes):
        if code.number in {M91, M92}:
            _check_datum(state, code, codes)
        if code.number == M19 and not limits.can_orient_spindle:
            raise state.make_error(
                code.column,
                M_FUNCTION_UNDEFINED,
                "M19 stops the spindle at an angle, but {unoriented}.",
                "{how_oriented}, or remove M19.",
                unoriented=CANNOT_ORIENT_TEXT,
                how_oriented=CANNOT_ORIENT_HINT.capitalize(),
            )
        if code.number in _UNSUPPORTED_CODES - known:
            raise make_unsupported_error(state.line_number, code.column, f"M{code.number}")
        if code.number not in known:
            text = "M{number} is not defined in the machine file."
            raise state.make_error(
                code.column,
                M_FUNCTION_UNDEFINED,
                text,
                _ADVICE.get(code.number, _MACHINE_CODE_HINT),
                number=code.number,
            )
        if code.number in IGNORED_CODES | limits.ignored_m_codes:
            state.log_ignored_function(f"M{code.number}", code.column)
        if code.number == SISTER_TOOL_CODE:
            text = (
                "On this control, M101 does not change to a replacement tool, so the called tool remains in "
                "use."
            )
            hint = "Check the tool life before you start the program."
            state.log_finding_once(code.column, Severity.WARNING, "no-replacement-tool", text, hint)
        if any(other.number == code.number for other in codes[:position]):
            text = Message("M{number} is programmed twice in the block.", number=code.number)
            raise make_syntax_error(state.line_number, code.column, text, "Remove one of the two.")
    turning = [code for code in codes if code.number in {*_TURNS, 5, M19}]
    if len(turning) > 1:
        text = "More than one M function in the block controls the spindle."
        raise state.make_error(turning[1].column, CONTRADICTION, text, "Remove one of the two.")


def _check_datum(state: State, code: MFunction, codes: Sequence[MFunction]) -> None:
    """Raise ProgramError for M91 or M92 while M128 is active, or for M91 and M92 in one block."""
    text = "M{number} is not allowed while M128 is active."
    hint = "Switch M128 off with M129 before this block."
    state.check_condition(
        not state.is_tcpm_active, code.column, NOT_ALLOWED_WITH_M128, text, hint, number=code.number
    )
    if {M91, M92} <= {other.number for other in codes}:
        text = "M91 and M92 cannot be in the same block because they measure from different datums."
        raise state.make_error(code.column, CONTRADICTION, text, "Remove one of the two.")


def read_machine_datum(state: State, codes: Sequence[MFunction]) -> Mapping[str, float] | None:
    """Return the machine positions to which M91 or M92 refers, by axis.

    Returns None if the words of the block refer to the workpiece zero.
    """
    numbers = {code.number for code in codes}
    if M92 in numbers:
        return {axis: points[0] for axis, points in state.setup.limits.fixed_points.items() if points}
    return {} if M91 in numbers else None


def execute_before_motion(state: State, m_functions: Sequence[MFunction]) -> Iterator[Block]:
    """Yield the blocks of the M functions that act before the motion."""
    for code in m_functions:
        output = state.setup.limits.m_code_outputs.get(code.number)
        if code.number in _TURNS:
            yield _start(state, code)
        if code.number in {8, 13, 14}:
            yield _coolant(state, on=True)
        if code.number in {126, 127}:
            state.uses_shorter_rotation = code.number == 126
        if code.number in {116, 117}:
            state.is_rotary_feed_at_tip = code.number == 116
        if code.number in {128, 129}:
            set_tcpm_active(state, is_active=code.number == 128)
        if code.number == 140:
            yield from _retract(state, code)
        if output is not None and output[1]:
            yield _output(state, *output)


def execute_after_motion(state: State, m_functions: Sequence[MFunction], comment: str) -> Iterator[Block]:
    """Yield the blocks of the M functions that act after the motion."""
    for code in m_functions:
        output = state.setup.limits.m_code_outputs.get(code.number)
        if code.number in {0, 5, 6} and state.modal.spindle:
            yield _stop(state)
        if code.number == M19:
            yield make_orientation_block(state, state.spindle_angle_deg)
        if code.number == 9 or (code.number == 0 and state.modal.coolant):
            yield _coolant(state, on=False)
        if output is not None and not output[1]:
            yield _output(state, *output)
        if code.number in {0, 1}:
            yield state.make_action_block(actions.ProgramStop(optional=code.number == 1, message=comment))
        if code.number == 6:
            yield state.make_action_block(
                actions.ProgramStop(
                    optional=False, message=Message("TOOL {tool}", tool=format_tool(state.modal.tool))
                )
            )
        if code.number in {2, 30}:
            yield execute_program_end(state)


def execute_program_end(state: State) -> Block:
    """Return the block of M2, M30 or END PGM.

    The block resets the plane without moving the rotary axes.
    """
    state.is_tcpm_active = False
    state.transformation = ProgramTransform()
    state.uses_shorter_rotation = True
    state.is_feed_per_revolution, state.plunging_feed_factor, state.is_rotary_feed_at_tip = False, None, False
    state.set_plane(None)
    state.modal = state.modal._replace(spindle=0, oriented=None, coolant=False, outputs=frozenset())
    return state.make_action_block(actions.ProgramEnd(reset=True))


def _start(state: State, code: MFunction) -> Block:
    text = "M{number} starts the spindle, but no TOOL CALL sets S."
    state.check_condition(
        state.modal.rpm, code.column, WRONG_RPM, text, "Program S in TOOL CALL.", number=code.number
    )
    state.modal = state.modal._replace(spindle=_TURNS[code.number], oriented=None)
    return state.make_action_block(actions.SpindleRun(state.modal.rpm * state.modal.spindle))


def _stop(state: State) -> Block:
    state.modal = state.modal._replace(spindle=0, oriented=None)
    return state.make_action_block(actions.SpindleStop())


def _coolant(state: State, *, on: bool) -> Block:
    state.modal = state.modal._replace(coolant=on)
    return state.make_action_block(actions.CoolantSwitch(on))


def _output(state: State, name: str, on: bool) -> Block:
    outputs = state.modal.outputs | {name} if on else state.modal.outputs - {name}
    state.modal = state.modal._replace(outputs=outputs)
    return state.make_action_block(actions.OutputSwitch(name, on))


def _retract(state: State, code: MFunction) -> Iterator[Block]:
    """Yield the retract that M140 programs along the tool axis, at feed rate or at rapid."""
    assert code.retract is not None
    up = compute_retract_length(state, code.retract)
    feed = word_values.evaluate_feed(state, code.feed, code.column) if code.feed is not None else None
    if up > 0.0:
        yield make_retract_block(state, up, feed)
