"""Threading in a source program: single passes, and threading cycles that are expanded to passes."""

from __future__ import annotations

from collections.abc import Mapping
from math import copysign, hypot, radians, sqrt, tan

from core.extras.convert.conversion_messages import make_error
from core.extras.convert.cycles.cycle_limits import MAX_PASS_COUNT, MIN_INFEED_MM, require_positive
from core.extras.convert.cycles.single_cycles import read_cycle_target, read_taper
from core.extras.convert.path_steps import StepKind
from core.extras.convert.source_lines import SourceStatement, SourceWord
from core.extras.convert.source_options import SourceControl
from core.extras.convert.source_state import SourceState


def append_thread_pass(state: SourceState, statement: SourceStatement, code: SourceWord) -> None:
    """Append the thread pass of G32 or G33. Raises ProgramError if lead or position is missing."""
    state.get_position(code)
    lead = read_lead(state, statement, code)
    x, z = state.find_target(statement)
    append_thread(state, statement.line_number, x, z, lead)


def append_thread(
    state: SourceState, line_number: int, x: float | None, z: float | None, lead_mm: float
) -> None:
    """Append a thread pass with its lead along Z.

    The programmed lead ``lead_mm`` of LinuxCNC is measured along the path of the tool. On Fanuc controls, it
    is measured along the axis with the longer travel, with X as a radius.
    """
    if x is not None and z is not None and state.x is not None and state.z is not None:
        dx, dz = abs(x - state.x), abs(z - state.z)
        along_path = state.source_control is SourceControl.LINUXCNC
        longest = hypot(dx, dz) if along_path else max(dx, dz)
        if dz and longest > dz:
            lead_mm *= dz / longest
    state.append_move(StepKind.THREAD, line_number, x, z, feed=lead_mm, per_rev=True)


def read_lead(state: SourceState, statement: SourceStatement, code: SourceWord) -> float:
    """Return the lead in mm/rev, which remains active for later passes.

    Raises ProgramError if no lead is programmed.
    """
    letters = "FE" if state.source_control.is_fanuc else "KP"
    both = [each for each in statement.words if each.letter in "FE"] if state.source_control.is_fanuc else []
    if len(both) > 1:
        raise make_error(
            both[1].line_number, both[1].column, "word-twice", word=both[0].text, other=both[1].text
        )
    word = next((each for letter in letters if (each := statement.find_word(letter))), None)
    if word is not None:
        if not word.has_decimal_point and state.source_control.is_fanuc and state.options.no_point != 1:
            raise make_error(word.line_number, word.column, "feed-no-point", word=word.text)
        state.last_lead_mm = abs(word.value) * state.get_unit_mm(word)
        if word.letter == "F" and state.source_control.is_fanuc:
            state.feed = state.last_lead_mm if state.is_feed_per_rev else None
    if not state.last_lead_mm:
        raise make_error(code.line_number, code.column, "thread-lead")
    return state.last_lead_mm


def append_single_thread_cycle(state: SourceState, statement: SourceStatement, code: SourceWord) -> None:
    """Append the four moves of the threading cycle G92 (G78 of system B).

    Raises ProgramError if a value is missing.
    """
    x0, z0 = state.get_position(code)
    lead = read_lead(state, statement, code)
    taper = read_taper(state, statement)
    x, z = read_cycle_target(state, statement, code)
    line = statement.line_number
    state.append_rapid(line, x + taper, z0)
    append_thread(state, line, x, z, lead)
    state.append_rapid(line, x0, z)
    state.append_rapid(line, x0, z0)


class FanucThreadValues:
    """Values from the first line of a two-line G76 cycle.

    They are the number of finishing passes, the thread angle, the minimum depth and the finishing depth.
    """

    def __init__(self) -> None:
        self.finishing, self.chamfer, self.angle = 1, 0, 60.0
        self.least, self.allowance = 0.0, 0.0

    def store_words(self, state: SourceState, statement: SourceStatement) -> None:
        """Store the words of the first line of the cycle. Raises ProgramError if the lead is invalid."""
        p, q, r = (statement.find_word(letter) for letter in "PQR")
        if any(each.letter in "FE" for each in statement.words):
            read_lead(state, statement, statement.words[0])
        if p is not None:
            passes, rest = divmod(round(p.value), 10000)
            self.finishing = max(passes, 1)
            self.chamfer, self.angle = rest // 100, float(rest % 100)
        self.least = state.convert_increment(q) if q is not None else self.least
        self.allowance = state.convert_increment(r) if r is not None else self.allowance


def is_first_of_two_lines(statement: SourceStatement) -> bool:
    """Return whether a G76 line is the first of two lines; such a line has no end point."""
    return not any(each.letter in "XZUW" for each in statement.words)


def append_thread_cycle(
    state: SourceState, statement: SourceStatement, code: SourceWord, first_line_values: FanucThreadValues
) -> None:
    """Append the passes of G76. Raises ProgramError if a required word is missing or invalid."""
    x0, z0 = state.get_position(code)
    lead = read_lead(state, statement, code)
    x, z = state.find_target(statement)
    assert x is not None
    assert z is not None
    depth, first, least, allowance, finishing, angle = _depths(state, statement, code, first_line_values)
    taper = -_taper_of_cycle(state, statement)
    if first_line_values.chamfer:
        state.add_warning(code, "thread-pull-out")
    out = copysign(1.0, x0 - x)
    crest = x + out * depth
    cuts = _cut_depths(code, depth - allowance, first, least)
    cuts += (
        [depth - allowance * (finishing - k) / finishing for k in range(1, finishing + 1)]
        if allowance
        else [depth] * (finishing - 1)
    )
    along = copysign(1.0, z - z0)
    for cut in cuts:
        begin = z0 + along * (cut - first) * tan(radians(angle / 2))
        end = crest - out * cut
        if state.z != begin:
            state.append_rapid(statement.line_number, x0, begin)
        state.append_rapid(statement.line_number, end - taper, begin)
        append_thread(state, statement.line_number, end, z, lead)
        state.append_rapid(statement.line_number, x0, z)
        state.append_rapid(statement.line_number, x0, begin)
    state.append_rapid(statement.line_number, x0, z0)


def _depths(
    state: SourceState, statement: SourceStatement, code: SourceWord, set_up: FanucThreadValues
) -> tuple[float, float, float, float, int, float]:
    """Return the depths of a G76 cycle in mm, the number of finishing passes, and the thread angle.

    The depths are the total depth, the first depth, the minimum depth and the finishing allowance.
    """
    p, q, k, d, a = (statement.find_word(letter) for letter in "PQKDA")
    if k is not None and d is not None:  # the form of one line
        angle = a.value if a is not None else 0.0
        if p is not None and p.value != 1:
            raise make_error(p.line_number, p.column, "code-unknown", word=p.text)
        depth = require_positive(k, state.convert_length(k))
        return depth, require_positive(d, state.convert_increment(d)), 0.0, 0.0, 1, angle
    if p is None or q is None:
        raise make_error(code.line_number, code.column, "cycle-word", word="P" if p is None else "Q")
    depth = require_positive(p, state.convert_increment(p))
    first = require_positive(q, state.convert_increment(q))
    return depth, first, set_up.least, set_up.allowance, set_up.finishing, set_up.angle


def _taper_of_cycle(state: SourceState, statement: SourceStatement) -> float:
    word = next((each for letter in "RI" if (each := statement.find_word(letter))), None)
    return 0.0 if word is None else state.convert_length(word)


def _cut_depths(code: SourceWord, depth: float, first: float, least: float) -> list[float]:
    """Return the depths of the passes: pass n has the depth first·√n.

    The depth increases by at least ``least`` from pass to pass. Raises ProgramError for too many passes.
    """
    cuts = [min(first, depth)]
    count = 1
    while cuts[-1] < depth - MIN_INFEED_MM:
        count += 1
        if count > MAX_PASS_COUNT:
            raise make_error(code.line_number, code.column, "too-many-passes", word=code.text)
        cuts.append(min(max(first * sqrt(count), cuts[-1] + least), depth))
    return cuts


def append_linuxcnc_thread_cycle(state: SourceState, statement: SourceStatement, code: SourceWord) -> None:
    """Append the passes of the LinuxCNC G76. Raises ProgramError if a word is missing or invalid."""
    x0, z0 = state.get_position(code)
    words = {letter: statement.find_word(letter) for letter in "PZIJKRQHEL"}
    for letter in "PZIJK":
        if words[letter] is None:
            raise make_error(code.line_number, code.column, "cycle-word", word=letter)
    taper, length = words["L"], words["E"]
    if length is not None and (taper is None or not taper.value):
        state.add_warning(length, "left-out", word=length.text)
    if taper is not None and taper.value == 2:
        state.add_warning(code, "thread-pull-out")
    elif taper is not None and taper.value:
        raise make_error(taper.line_number, taper.column, "thread-ends", word=taper.text)
    _, z = state.find_target(statement)
    assert z is not None
    peak, first, full = (_half(state, words[letter]) for letter in "IJK")
    _check_linuxcnc_words(words, first, full)
    power = 1.0 if words["R"] is None else words["R"].value
    angle = 0.0 if words["Q"] is None else words["Q"].value
    springs = 0 if words["H"] is None else round(words["H"].value)
    lead = read_lead(state, statement, code)
    cuts = []
    depth, count = first, 1
    while depth < full:
        cuts.append(depth)
        count += 1
        if count > MAX_PASS_COUNT:
            raise make_error(code.line_number, code.column, "too-many-passes", word=code.text)
        depth = first * count ** (1.0 / power)
    cuts += [full] * (springs + 1)
    side = copysign(1.0, peak)
    along = copysign(1.0, z - z0)
    for cut in cuts:
        # Each pass is shifted along the flank, and so is its retract, away from the part.
        left = full - cut
        x, clear = x0 + side * (abs(peak) + cut), x0 - side * left
        begin = z0 + along * cut * tan(radians(angle))
        end = z - along * left * tan(radians(angle))
        state.append_rapid(statement.line_number, clear, begin)
        state.append_rapid(statement.line_number, x, begin)
        append_thread(state, statement.line_number, x, end, lead)
        state.append_rapid(statement.line_number, clear, end)
    state.append_rapid(statement.line_number, x0, z)


def _check_linuxcnc_words(words: Mapping[str, SourceWord | None], first: float, full: float) -> None:
    """Raise ProgramError for a value of G76 that LinuxCNC rejects too."""
    for letter, value in (("J", first), ("K", full)):
        word = words[letter]
        assert word is not None
        require_positive(word, value)
    power, springs = words["R"], words["H"]
    if power is not None and power.value < 1.0:
        raise make_error(power.line_number, power.column, "thread-degression", word=power.text)
    if springs is not None and not 0 <= springs.value <= MAX_PASS_COUNT:
        raise make_error(springs.line_number, springs.column, "too-many-passes", word=springs.text)


def _half(state: SourceState, word: SourceWord | None) -> float:
    assert word is not None
    return state.convert_x(word)
