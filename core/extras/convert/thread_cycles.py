"""Threads of a source program: single passes, and thread cycles that are expanded into passes."""

from __future__ import annotations

from math import copysign, radians, sqrt, tan

from core.extras.convert.path_steps import Kind
from core.extras.convert.reasons import refuse
from core.extras.convert.single_cycles import cycle_target, taper_of
from core.extras.convert.source_lines import Statement, Word
from core.extras.convert.source_state import SourceState

_LEAST_INFEED = 1e-6  # mm
_MOST_PASSES = 1000


def single_pass(state: SourceState, statement: Statement, code: Word) -> None:
    """Append the thread pass of G32 or G33. Raises ProgramError."""
    state.here(code)
    lead = lead_of(state, statement, code)
    x, z = state.target(statement)
    state.go(Kind.THREAD, statement.line, x, z, feed=lead, per_rev=True)


def lead_of(state: SourceState, statement: Statement, code: Word) -> float:
    """Return the lead in mm/rev, which remains active for further passes.

    Raises ProgramError if there is no lead.
    """
    letters = "FE" if state.control.is_fanuc else "KP"
    word = next((each for letter in letters if (each := statement.word(letter))), None)
    if word is not None:
        if not word.has_point and state.control.is_fanuc and state.options.no_point != 1:
            raise refuse(word.line, word.column, "feed-no-point", word=word.text)
        state.lead = abs(word.value) * state.unit(word)
    if not state.lead:
        raise refuse(code.line, code.column, "thread-lead")
    return state.lead


def thread_box(state: SourceState, statement: Statement, code: Word) -> None:
    """Append the four moves of the single thread cycle G92 (G78 of system B). Raises ProgramError."""
    x0, z0 = state.here(code)
    lead = lead_of(state, statement, code)
    taper = taper_of(state, statement)
    x, z = cycle_target(state, statement, code)
    line = statement.line
    state.rapid(line, x + taper, z0)
    state.go(Kind.THREAD, line, x, z, feed=lead, per_rev=True)
    state.rapid(line, x0, z)
    state.rapid(line, x0, z0)


class FanucThread:
    """Values of the first line of a two-line G76 cycle.

    The values are the number of finishing passes, the angle, the minimum depth and the finishing depth.
    """

    def __init__(self) -> None:
        self.finishing, self.chamfer, self.angle = 1, 0, 60.0
        self.least, self.allowance = 0.0, 0.0

    def set(self, state: SourceState, statement: Statement) -> None:
        """Store the words of the first line of the cycle."""
        p, q, r = (statement.word(letter) for letter in "PQR")
        if p is not None:
            passes, rest = divmod(round(p.value), 10000)
            self.finishing = max(passes, 1)
            self.chamfer, self.angle = rest // 100, float(rest % 100)
        self.least = state.increment(q) if q is not None else self.least
        self.allowance = state.increment(r) if r is not None else self.allowance


def is_first_line(statement: Statement) -> bool:
    """Return whether a G76 line is the first of two lines, which has no end point."""
    return not any(each.letter in "XZUW" for each in statement.words)


def thread_cycle(state: SourceState, statement: Statement, code: Word, set_up: FanucThread) -> None:
    """Append the passes of G76. Raises ProgramError."""
    x0, z0 = state.here(code)
    lead = lead_of(state, statement, code)
    x, z = state.target(statement)
    assert x is not None
    assert z is not None
    depth, first, least, allowance, finishing, angle = _depths(state, statement, code, set_up)
    taper = -_taper_of_cycle(state, statement)
    if set_up.chamfer:
        state.warn(code, "thread-pull-out")
    out = copysign(1.0, x0 - x)
    crest = x + out * depth
    cuts = _cut_depths(depth - allowance, first, least)
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
            state.rapid(statement.line, x0, begin)
        state.rapid(statement.line, end - taper, begin)
        state.go(Kind.THREAD, statement.line, end, z, feed=lead, per_rev=True)
        state.rapid(statement.line, x0, z)
        state.rapid(statement.line, x0, begin)
    state.rapid(statement.line, x0, z0)


def _depths(
    state: SourceState, statement: Statement, code: Word, set_up: FanucThread
) -> tuple[float, float, float, float, int, float]:
    """Return the depths of a G76 cycle in mm, the number of finishing passes, and the angle.

    The depths are the total depth, the first depth, the minimum depth and the finishing allowance.
    """
    p, q, k, d, a = (statement.word(letter) for letter in "PQKDA")
    if k is not None and d is not None:  # the form of one line
        angle = a.value if a is not None else 0.0
        return state.length(k), state.increment(d), 0.0, 0.0, 1, angle
    if p is None or q is None:
        raise refuse(code.line, code.column, "cycle-word", word="P" if p is None else "Q")
    depth, first = state.increment(p), state.increment(q)
    return depth, first, set_up.least, set_up.allowance, set_up.finishing, set_up.angle


def _taper_of_cycle(state: SourceState, statement: Statement) -> float:
    word = next((each for letter in "RI" if (each := statement.word(letter))), None)
    return 0.0 if word is None else state.length(word)


def _cut_depths(depth: float, first: float, least: float) -> list[float]:
    """Return the depths of the passes, which are first·√n.

    Each pass is at least ``least`` deeper than the previous pass.
    """
    cuts = [min(first, depth)]
    count = 1
    while cuts[-1] < depth - _LEAST_INFEED and count < _MOST_PASSES:
        count += 1
        cuts.append(min(max(first * sqrt(count), cuts[-1] + least), depth))
    return cuts


def linuxcnc_thread_cycle(state: SourceState, statement: Statement, code: Word) -> None:
    """Append the passes of the LinuxCNC cycle G76. Raises ProgramError."""
    x0, z0 = state.here(code)
    words = {letter: statement.word(letter) for letter in "PZIJKRQHEL"}
    for letter in "PZIJK":
        if words[letter] is None:
            raise refuse(code.line, code.column, "cycle-word", word=letter)
    taper = words["L"]
    if taper is not None and taper.value == 2:
        state.warn(code, "thread-pull-out")
    elif taper is not None and taper.value:
        raise refuse(taper.line, taper.column, "thread-ends", word=taper.text)
    _, z = state.target(statement)
    assert z is not None
    peak, first, full = (_half(state, words[letter]) for letter in "IJK")
    power = 1.0 if words["R"] is None else words["R"].value
    angle = 0.0 if words["Q"] is None else words["Q"].value
    springs = 0 if words["H"] is None else round(words["H"].value)
    lead = lead_of(state, statement, code)
    cuts = []
    depth, count = abs(first), 1
    while depth < abs(full) and count < _MOST_PASSES:
        cuts.append(depth)
        count += 1
        depth = abs(first) * count ** (1.0 / power)
    cuts += [abs(full)] * (springs + 1)
    side = copysign(1.0, peak)
    along = copysign(1.0, z - z0)
    for cut in cuts:
        # Each pass is shifted along the flank, and so is its retract, away from the part.
        left = abs(full) - cut
        x, clear = x0 + side * (abs(peak) + cut), x0 - side * left
        begin = z0 + along * cut * tan(radians(angle))
        end = z - along * left * tan(radians(angle))
        state.rapid(statement.line, clear, begin)
        state.rapid(statement.line, x, begin)
        state.go(Kind.THREAD, statement.line, x, end, feed=lead, per_rev=True)
        state.rapid(statement.line, clear, end)
    state.rapid(statement.line, x0, z)


def _half(state: SourceState, word: Word | None) -> float:
    assert word is not None
    return state.across(word)
