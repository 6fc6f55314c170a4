"""Modal G functions (motion, plane, units, G90 and G91) and the offsets of program zero."""

from __future__ import annotations

from dataclasses import replace

from core.interpreter.sinumerik.sinumerik_state import (
    IDENTITY_FRAME,
    ZERO_SETTABLE_OFFSET,
    MotionKind,
    SinumerikState,
)
from core.interpreter.sinumerik.sinumerik_statement import Statement
from core.language.diagnostics import Severity
from core.language.sinumerik import word_table as table
from core.language.sinumerik.sinumerik_words import PositionMode, Word
from core.message import Message

_NAMED_MOTION = {"CIP": MotionKind.ARC_BY_POINT, "CT": MotionKind.TANGENTIAL_ARC}
_FIFTH = {505: 58, 506: 59}  # the settable offsets that these codes select


def activate_settable_offset(state: SinumerikState, statement: Statement) -> None:
    """Activate the settable offset of G54 to G59, G505 or G506, or cancel it with G500."""
    code = statement.get_g_code(table.SETTABLE_OFFSET_GROUP)
    if code is None:
        return
    code = _FIFTH.get(code, code)
    state.settable = state.setup.zero.get(code, ZERO_SETTABLE_OFFSET) if code != 500 else ZERO_SETTABLE_OFFSET
    state.set_modal_state(state.modal._replace(settable=0 if code == 500 else code))
    state.derive_offsets()


def execute_frame_words(state: SinumerikState, statement: Statement) -> None:
    """Execute TRANS, ROT, SCALE and MIRROR, or their additive forms such as ATRANS.

    TRANS, ROT, SCALE and MIRROR replace the frame, and the additive forms add to the frame. A block without
    axis words resets the frame. Raises ProgramError for invalid words.
    """
    key = statement.frame_word
    if key is None:
        return
    check_c_word(state, statement)
    name = key.name.removeprefix("A")
    if name == "ROT":
        _refuse_axes(statement, key)
    elif word := statement.words.get("RPL"):
        raise statement.make_error(
            word,
            "word-unused",
            Message("{word} can be used only with ROT.", word=word.text),
            "Remove this text from the program.",
        )
    frame = state.programmed_frame if key.name[0] == "A" else IDENTITY_FRAME
    if name == "TRANS":
        frame = frame.add_shift(*(_shift(state, statement, axis) for axis in "XZC"))
    elif name == "ROT":
        angle = statement.words.get("RPL")
        frame = frame.add_rotation(0.0 if angle is None else state.number(statement, angle))
    elif name == "SCALE":
        frame = frame.add_scaling(_factor(state, statement, "X"), _factor(state, statement, "Z"))
    else:
        frame = frame.add_scaling(*(-1.0 if axis in statement.words else 1.0 for axis in "XZ"))
    if name in {"SCALE", "MIRROR"} and (word := statement.words.get("C")):
        raise statement.make_error(
            word, "offset-form", Message("{word} can be used only with X and Z.", word=key.name), "Remove C."
        )
    state.programmed_frame = frame
    state.derive_offsets()


def reset_offsets(state: SinumerikState) -> None:
    """Reset all offsets at the end of a program, so that they do not affect later programs.

    G71 and DIAMON become active, as the next MDI line expects.
    """
    state.settable, state.programmed_frame = ZERO_SETTABLE_OFFSET, IDENTITY_FRAME
    state.set_modal_state(state.modal._replace(settable=0, metric=True, diameter=True))
    state.derive_offsets()


def check_c_word(state: SinumerikState, statement: Statement) -> None:
    """Raise ProgramError for a C word if the machine has no third axis."""
    word = statement.words.get("C")
    if word is not None and not state.setup.limits.is_c_enabled:
        text = "unknown axis: this machine has no third axis."
        raise statement.make_error(
            word, "unknown-axis", text, "Remove this axis, or select a machine file that has this axis."
        )


def check_y_word(state: SinumerikState, statement: Statement) -> None:
    """Raise ProgramError for a Y or J word outside TRANSMIT and TRACYL."""
    word = statement.words.get("Y") or statement.words.get("J")
    if word is None or state.transformation is not None:
        return
    text: str = Message("{word}: this lathe has no Y axis.", word=word.name)
    if word.name == "J":
        text = "J: an arc in G18 uses I and K."
    hint = "Remove this word; TRANSMIT and TRACYL create Y from X and C."
    raise statement.make_error(word, "not-in-subset", text, hint)


def _refuse_axes(statement: Statement, key: Word) -> None:
    for axis in statement.axis_names:
        word = statement.words[axis]
        text = Message(
            "{word}: on a lathe, {key} rotates the plane with RPL=, not with axis words.",
            word=word.text,
            key=key.name,
        )
        raise statement.make_error(word, "offset-form", text, Message("Write {key} RPL=…", key=key.name))


def _shift(state: SinumerikState, statement: Statement, name: str) -> float:
    """Return the shift of one axis in TRANS or ATRANS, in mm or degrees.

    X is a radius, independent of DIAMON.
    """
    word = _plain(statement, name)
    if word is None:
        return 0.0
    return state.third(statement, word) if name == "C" else state.length(statement, word)


def _factor(state: SinumerikState, statement: Statement, name: str) -> float:
    word = _plain(statement, name)
    value = 1.0 if word is None else state.number(statement, word)
    if word is not None and not 0.001 <= value <= 1000.0:
        text = Message("{word}: a factor must be between 0.001 and 1000.", word=word.text)
        raise statement.make_error(
            word, "offset-form", text, "Correct the factor; to reverse an axis, use MIRROR."
        )
    return value


def _plain(statement: Statement, name: str) -> Word | None:
    word = statement.words.get(name)
    if word is not None and word.position_mode is not PositionMode.PLAIN:
        text = Message("{word}: an offset must be a plain number.", word=word.text)
        raise statement.make_error(
            word, "offset-form", text, Message("Write {word} with a plain number.", word=word.name)
        )
    return word


def set_modal_functions(state: SinumerikState, statement: Statement) -> None:
    """Set the modal functions of a block. Raises ProgramError for an invalid function."""
    modal = state.modal
    _motion_and_plane(state, statement)
    metric, absolute = statement.get_g_code(table.UNIT_GROUP), statement.get_g_code(table.DISTANCE_MODE_GROUP)
    if transverse := statement.get_named_function(table.DIAMETER_GROUP):
        modal = modal._replace(diameter=transverse != "DIAMOF")
        state.distance_is_radius = transverse == "DIAM90"
    if metric is not None:
        modal = modal._replace(metric=metric in {71, 710})
        state.feed_in_inches = metric == 700
    if absolute is not None:
        modal = modal._replace(absolute=absolute == 90)
    if modal.rapid != (state.motion is MotionKind.RAPID):
        modal = modal._replace(rapid=state.motion is MotionKind.RAPID)
    state.set_modal_state(modal)
    _path_modes(state, statement)
    activate_settable_offset(state, statement)


def _motion_and_plane(state: SinumerikState, statement: Statement) -> None:
    motion, plane = statement.get_g_code(table.MOTION_GROUP), statement.get_g_code(table.PLANE_GROUP)
    if motion is not None:
        state.motion = MotionKind(motion)
    elif name := statement.get_named_function(table.MOTION_GROUP):
        state.motion = _NAMED_MOTION[name]
    if plane is not None and plane != state.plane and state.modal.compensation_code != 40:
        text = Message(
            "G{plane} cannot change the plane while G{nose_comp} is active.",
            plane=plane,
            nose_comp=state.modal.compensation_code,
        )
        raise statement.make_error(
            statement.g_words[table.PLANE_GROUP], "comp-plane", text, "Write G40 before this line."
        )
    state.plane = plane or state.plane


def _path_modes(state: SinumerikState, statement: Statement) -> None:
    """Set the modes for exact stop, outside corners, approach and working area limits."""
    exact, corner = statement.get_g_code(table.EXACT_STOP_GROUP), statement.get_g_code(table.CORNER_GROUP)
    if exact is not None:
        state.exact = exact == 60
    if corner is not None:
        state.rounded = corner == 450
    if approach := statement.get_named_function(table.APPROACH_GROUP):
        state.round_ends = approach == "KONT"
    if (code := statement.get_g_code(table.COMPENSATION_GROUP)) is not None:
        plane = 18 if state.transformation is None else state.transformation.plane_code
        if code != 40 and state.plane != plane:
            of = "X and Z" if state.transformation is None else state.transformation.name
            word, text = (
                statement.g_words[table.COMPENSATION_GROUP],
                (Message("radius compensation in {total} needs G{plane}.", total=of, plane=plane)),
            )
            raise statement.make_error(
                word, "comp-plane", text, Message("Write G{plane} before this block.", plane=plane)
            )
        state.set_modal_state(state.modal._replace(compensation_code=code))
    if area := statement.get_named_function(table.WORKING_AREA_GROUP):
        state.is_working_area_active = area == "WALIMON"


def log_ineffective_words(state: SinumerikState, statement: Statement) -> None:
    """Log one note for each word that has no effect."""
    for word in statement.g_words.values():
        name = word.name if word.value is None else f"G{int(word.value)}"
        log_ineffective_word(state, statement, word, name, table.INEFFECTIVE_WORDS.get(name, ""))
    for name, word in statement.words.items():
        log_ineffective_word(state, statement, word, name, table.INEFFECTIVE_WORDS.get(name, ""))


def log_ineffective_word(
    state: SinumerikState, statement: Statement, word: Word, name: str, reason: str
) -> None:
    """Log a note, only once, that a function has no effect because of ``reason``."""
    if reason and name not in state.logged_functions:
        state.logged_functions.add(name)
        found = statement.make_warning(
            word, "no-effect", Message("{name} has no effect because {why}.", name=name, why=reason), ""
        )
        state.log_finding(replace(found, severity=Severity.NOTE))


def execute_pole_and_limits(state: SinumerikState, statement: Statement) -> bool:
    """Execute a block with G110 to G112 (pole) or with G25 or G26 (limits).

    Returns whether the block contains one of these codes. Raises ProgramError for invalid words.
    """
    word = statement.g_words.get(table.NON_MODAL_GROUP)
    code = statement.get_g_code(table.NON_MODAL_GROUP)
    if word is None or code not in {110, 111, 112, 25, 26}:
        return False
    if "C" in statement.words:
        text = Message("{word} can be used only with X and Z.", word=word.text)
        raise statement.make_error(statement.words["C"], "own-block", text, "Remove C.")
    if code in {25, 26}:
        _limits(state, statement, upper=code == 26)
    else:
        _pole(state, statement, code)
    return True


def _pole(state: SinumerikState, statement: Statement, code: int) -> None:
    base = (0.0, 0.0)
    if code == 112:
        base = state.pole
    elif code == 110:
        x, z = state.x - state.modal.offset_x, state.z - state.modal.offset_z
        base = state.programmed_frame.convert_to_program_distance(x, z)
    state.pole = base[0] + _place(state, statement, "X"), base[1] + _place(state, statement, "Z")


def _place(state: SinumerikState, statement: Statement, name: str) -> float:
    word = _plain(statement, name)
    if word is None:
        return 0.0
    return state.length(statement, word) / (2.0 if name == "X" and state.modal.diameter else 1.0)


def _limits(state: SinumerikState, statement: Statement, *, upper: bool) -> None:
    """Set the working area limits of G25 and G26.

    The spindle speed limits of G25 and G26 are set when the spindle words are executed.
    """
    for name in ("X", "Z"):
        if name in statement.words:
            state.area[name, upper] = _place(state, statement, name)


def check_working_area(state: SinumerikState, statement: Statement, x: float, z: float) -> None:
    """Raise ProgramError if the tool tip would leave the working area of G25 and G26.

    ``x`` and ``z`` are machine positions in mm.
    """
    if not state.is_working_area_active or not state.area:
        return
    modal = state.modal
    edge = (0.0, 0.0) if modal.edge == 0 else (modal.tool_offset_x, modal.tool_offset_z)
    for name, value in (("X", x - edge[0]), ("Z", z - edge[1])):
        for upper in (False, True):
            limit = state.area.get((name, upper))
            if limit is not None and (value > limit + 1e-6 if upper else value < limit - 1e-6):
                text = Message(
                    "{name} moves past the working area limit that G{value} sets at {limit} mm.",
                    name=name,
                    value=26 if upper else 25,
                    limit=f"{limit:g}",
                )
                hint = "Correct the move, or write WALIMOF."
                raise statement.make_error(statement.words.get(name), "working-area", text, hint)
