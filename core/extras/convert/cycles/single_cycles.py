"""Single turning and facing cycles (G90 and G94 of system A), and peck cycles (G74 and G75)."""

from __future__ import annotations

from math import copysign

from core.extras.convert.conversion_messages import make_error
from core.extras.convert.cycles.cycle_limits import limit_pass_count, require_words
from core.extras.convert.path_steps import StepKind
from core.extras.convert.source_lines import SourceStatement, SourceWord
from core.extras.convert.source_options import SourceControl
from core.extras.convert.source_state import SourceState

_CLEARANCE = 0.25  # mm
_SAME = 1e-6  # mm


def read_cycle_target(
    state: SourceState, statement: SourceStatement, code: SourceWord
) -> tuple[float, float]:
    """Return X and Z of a single cycle. A missing word keeps its value from the previous line.

    Raises ProgramError if a coordinate is unknown.
    """
    x0, z0 = state.get_position(code)
    x, z = state.find_target(statement)
    before = state.cycle_end_point if state.cycle_code == state.motion_code else None
    given = {each.letter for each in statement.words}
    if before is not None and not given & {"X", "U"}:
        x = before[0]
    if before is not None and not given & {"Z", "W"}:
        z = before[1]
    state.cycle_code = state.motion_code
    state.cycle_end_point = (x if x is not None else x0, z if z is not None else z0)
    return state.cycle_end_point


def read_taper(state: SourceState, statement: SourceStatement, letters: str = "RI") -> float:
    """Return the taper of a single cycle in mm. The taper remains active on further lines of the cycle."""
    word = next((each for letter in letters if (each := statement.find_word(letter))), None)
    if word is not None:
        state.cycle_taper = state.convert_length(word)
    elif state.cycle_code != state.motion_code:
        state.cycle_taper = 0.0
    return state.cycle_taper


def append_turning_cycle(state: SourceState, statement: SourceStatement, code: SourceWord) -> None:
    """Append the four moves of a turning cycle (G90 of system A).

    Raises ProgramError if a required value is missing.
    """
    x0, z0 = state.get_position(code)
    taper = read_taper(state, statement)
    x, z = read_cycle_target(state, statement, code)
    state.append_rapid(statement.line_number, x + taper, z0)
    state.append_cut(code, x, z)
    state.append_cut(code, x0, z)
    state.append_rapid(statement.line_number, x0, z0)


def append_facing_cycle(state: SourceState, statement: SourceStatement, code: SourceWord) -> None:
    """Append the four moves of a facing cycle (G94 of system A).

    Raises ProgramError if a required value is missing.
    """
    x0, z0 = state.get_position(code)
    taper = read_taper(state, statement, "RK")
    x, z = read_cycle_target(state, statement, code)
    state.append_rapid(statement.line_number, x0, z + taper)
    state.append_cut(code, x, z)
    state.append_cut(code, x, z0)
    state.append_rapid(statement.line_number, x0, z0)


class PeckValues:
    """Value from the first line of a two-line G74 or G75 cycle: the retract after each peck, in mm."""

    def __init__(self) -> None:
        self.retract: float | None = None


def append_peck_cycle(
    state: SourceState, statement: SourceStatement, code: SourceWord, peck: PeckValues
) -> None:
    """Append the moves of the peck cycle G74 (along Z) or G75 (along X).

    Raises ProgramError if a word is invalid.
    """
    if not any(each.letter in "XZUW" for each in statement.words):
        require_words(statement, code, "R")
        r = statement.find_word("R")
        peck.retract = state.convert_length(r) if r is not None else None
        return
    along_z = code.value == 74
    start = state.get_position(code)
    x, z = state.find_target(statement)
    assert x is not None
    assert z is not None
    depth, shift, relief = _sizes(state, statement, along_z=along_z)
    back = peck.retract
    if back is None:
        back = _CLEARANCE
        if depth:
            state.add_warning(code, "peck-clearance", value=back)
    main, cross = (start[1], start[0]) if along_z else (start[0], start[1])
    end, last = (z, x) if along_z else (x, z)
    require_words(statement, code, "ZW" if along_z else "XU")
    if shift and abs(last - cross) <= _SAME:
        word = _find_shift_word(state, statement, along_z=along_z)
        state.add_note(word or code, "no-change", word=(word or code).text)
        shift = 0.0
    _check_sizes(code, (end - main, last - cross), (depth, shift, relief))
    at = cross
    while True:
        _plunge(state, code, at, (main, end), depth, back, along_z=along_z)
        if relief and abs(last - cross) > _SAME:
            _go(state, code, StepKind.RAPID, end, at - copysign(relief, last - cross), along_z=along_z)
        _go(state, code, StepKind.RAPID, main, _cross(state, along_z=along_z), along_z=along_z)
        if abs(last - at) < _SAME or not shift:
            break
        at = last if abs(last - at) <= shift + _SAME else at + copysign(shift, last - cross)
        _go(state, code, StepKind.RAPID, main, at, along_z=along_z)
    _go(state, code, StepKind.RAPID, main, cross, along_z=along_z)


def _check_sizes(
    code: SourceWord,
    distances: tuple[float, float],
    sizes: tuple[float, float, float],
) -> None:
    """Raise ProgramError for a distance or a relief without a step size, or for too many steps."""
    (main, cross), (depth, shift, relief) = distances, sizes
    if not shift and (relief or abs(cross) > _SAME):
        raise make_error(code.line_number, code.column, "cycle-sideways", word=code.text)
    for distance, infeed in ((main, depth), (cross, shift)):
        if infeed:
            limit_pass_count(code, abs(distance), infeed)


def _sizes(state: SourceState, statement: SourceStatement, *, along_z: bool) -> tuple[float, float, float]:
    """Return the depth of a peck, the shift between plunges, and the relief at the bottom, in mm."""
    p, q, r, i, k, d = (statement.find_word(letter) for letter in "PQRIKD")
    side = _find_shift_word(state, statement, along_z=along_z)
    if _has_lengths(state, statement):
        sizes = [abs(state.convert_length(each)) if each else 0.0 for each in (k if along_z else i, side, d)]
        return sizes[0], sizes[1], sizes[2]
    deep = q if along_z else p
    return (
        abs(state.convert_increment(deep)) if deep else 0.0,
        abs(state.convert_increment(side)) if side else 0.0,
        abs(state.convert_length(r)) if r else 0.0,
    )


def _has_lengths(state: SourceState, statement: SourceStatement) -> bool:
    """Return whether the step sizes are lengths in I, K and D, not increments in P and Q."""
    return state.source_control is SourceControl.HAAS or not any(map(statement.find_word, "PQ"))


def _find_shift_word(state: SourceState, statement: SourceStatement, *, along_z: bool) -> SourceWord | None:
    """Return the word with the shift between plunges."""
    letters = "IK" if _has_lengths(state, statement) else "PQ"
    return statement.find_word(letters[0] if along_z else letters[1])


def _plunge(
    state: SourceState,
    code: SourceWord,
    at: float,
    depths: tuple[float, float],
    step: float,
    back: float,
    *,
    along_z: bool,
) -> None:
    """Append the pecks of one plunge, between the two coordinates in ``depths``."""
    begin, end = depths
    toward = copysign(1.0, end - begin)
    reached = begin
    while step and abs(end - reached) > step + _SAME:
        reached += toward * step
        _go(state, code, StepKind.FEED, reached, at, along_z=along_z)
        _go(state, code, StepKind.RAPID, reached - toward * back, at, along_z=along_z)
    _go(state, code, StepKind.FEED, end, at, along_z=along_z)


def _go(
    state: SourceState, code: SourceWord, kind: StepKind, main: float, cross: float, *, along_z: bool
) -> None:
    x, z = (cross, main) if along_z else (main, cross)
    if kind is StepKind.RAPID:
        state.append_rapid(code.line_number, x, z)
    else:
        state.append_cut(code, x, z)


def _cross(state: SourceState, *, along_z: bool) -> float:
    found = state.x if along_z else state.z
    assert found is not None
    return found


def require_end_point(statement: SourceStatement, code: SourceWord, letters: str = "XZUW") -> None:
    """Raise ProgramError if a cycle line has no end point."""
    if not any(each.letter in letters for each in statement.words):
        raise make_error(code.line_number, code.column, "cycle-word", word="X Z")
