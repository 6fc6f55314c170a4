"""The cycles G70, G71 and G72 of LinuxCNC, whose contour is a subprogram."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import sqrt

from core.extras.convert.conversion_messages import make_error
from core.extras.convert.cycles.contour_offset import OffsetError, Segment, offset_contour
from core.extras.convert.cycles.contour_pieces import ContourPiece
from core.extras.convert.cycles.cycle_limits import allow_letters, limit_pass_count, require_positive
from core.extras.convert.path_steps import StepKind
from core.extras.convert.source_lines import SourceStatement, SourceWord
from core.extras.convert.source_state import SourceState

LINUXCNC_CONTOUR_CODES = frozenset({70, 71, 71.1, 72, 72.1})
_SAME = 1e-6  # mm
_BACKWARD = 0.001  # program units


@dataclass(frozen=True, slots=True)
class _Frame:
    """Coordinate system of a cycle, in which facing is the same as turning.

    X and Z are exchanged for facing, and both directions are reversed as needed.
    """

    is_facing: bool = False
    flips_real: bool = False
    flips_imaginary: bool = False

    def to_frame(self, point: complex) -> complex:
        """Convert a complex number (Z as real part, X as imaginary part) to the frame of the cycle."""
        found = point * -1j if self.is_facing else point
        return complex(
            -found.real if self.flips_real else found.real,
            -found.imag if self.flips_imaginary else found.imag,
        )

    def from_frame(self, point: complex) -> complex:
        """Convert a point in the frame of the cycle to Z (real part) and X (imaginary part)."""
        found = complex(
            -point.real if self.flips_real else point.real,
            -point.imag if self.flips_imaginary else point.imag,
        )
        return found * 1j if self.is_facing else found

    @property
    def is_mirrored(self) -> bool:
        """Return whether the frame reverses the direction of arcs."""
        return self.flips_real != self.flips_imaginary

    def convert(self, segment: Segment) -> Segment:
        """Convert a segment in Z (real part) and X (imaginary part) to the frame of the cycle."""
        center = None if segment.center is None else self.to_frame(segment.center)
        ccw = segment.is_ccw != self.is_mirrored
        return Segment(self.to_frame(segment.start), self.to_frame(segment.end), center, ccw)


class LinuxcncContourCycle:
    """One call of G70, G71 or G72 with its words and its contour."""

    def __init__(self, state: SourceState, statement: SourceStatement, code: SourceWord) -> None:
        """Read the words of the call. Raises ProgramError if LinuxCNC or this conversion rejects them."""
        letters = "XZDEP" if code.value == 70 else "XZDIR"
        allow_letters(statement, f"GMNSTFQ{letters}")
        if not state.is_absolute:
            raise make_error(code.line_number, code.column, "cycle-incremental", word=code.text)
        if state.nose_code != 40:
            raise make_error(code.line_number, code.column, "comp-cycle", word=f"G{state.nose_code}")
        if state.plane_code != 18:
            plane = f"G{state.plane_code:g}"
            raise make_error(code.line_number, code.column, "plane", word=code.text, plane=plane)
        self._state, self._statement, self._code = state, statement, code
        x, z = state.find_target(statement)
        if x is None or z is None:
            state.get_position(code)
        assert x is not None
        assert z is not None
        self._begin = complex(z, x)
        self._unit = state.get_unit_mm(code)

    def _length(self, letter: str, default: float) -> float:
        """Return a word in mm, or the default in program units."""
        word = self._statement.find_word(letter)
        if word is None:
            return default * self._unit
        if word.value < 0 or (letter == "I" and not word.value):
            require_positive(word, word.value)
        return self._state.convert_length(word)

    def append_moves(self, contour: Sequence[SourceStatement]) -> None:
        """Append the moves of the cycle. Raises ProgramError if the contour is not possible here."""
        state = self._state
        segments = self._read_contour(contour)
        if len(segments) < 2:
            raise make_error(self._code.line_number, self._code.column, "cycle-empty")
        state.append_rapid(self._code.line_number, self._begin.imag, self._begin.real)
        is_facing = int(self._code.value) == 72
        if self._code.value != 70:
            self._add_way_out(segments, is_facing=is_facing)
        frame = _find_frame(segments, is_facing=is_facing)
        segments = [frame.convert(each) for each in segments]
        self._check_direction(segments, frame)
        try:
            if self._code.value == 70:
                self._finish(segments, frame)
            else:
                self._rough(segments, frame)
        except OffsetError as error:
            word = self._statement.find_word("D") or self._code
            raise make_error(word.line_number, word.column, "cycle-offset", word=word.text) from error
        state.motion_code = -1

    # --- the contour

    def _read_contour(self, statements: Sequence[SourceStatement]) -> list[Segment]:
        """Return the contour with Z and X as the parts of its points; the first segment is the approach."""
        found: list[Segment] = []
        at, motion = self._begin, 0.0
        for statement in statements:
            self._check_words(statement)
            motion = next((each.value for each in reversed(statement.find_words("G"))), motion)
            x, z = statement.find_word("X"), statement.find_word("Z")
            end = complex(
                at.real if z is None else self._state.convert_length(z),
                at.imag if x is None else self._state.convert_x(x),
            )
            if end == at:
                continue
            center = self._find_center(statement, at, end, motion) if motion in {2, 3} else None
            found.append(Segment(at, end, center, motion == 3))
            at = end
        return found

    def _add_way_out(self, segments: list[Segment], *, is_facing: bool) -> None:
        """Add a straight retract at the end of the contour if it has none, as newer LinuxCNC versions do."""
        first, last = (each.end - each.start for each in (segments[0], segments[-1]))
        begin, end = self._begin, segments[-1].end
        if is_facing:
            is_missing = abs(last.imag) > 0.0 and first.real * (begin.real - end.real) < 0.0
            out = complex(begin.real, end.imag)
        else:
            is_missing = abs(last.real) > 0.0 and first.imag * (begin.imag - end.imag) < 0.0
            out = complex(end.real, begin.imag)
        if is_missing:
            self._state.add_warning(self._code, "cycle-version", word=self._code.text)
            segments.append(Segment(end, out))

    def _check_words(self, statement: SourceStatement) -> None:
        for word in statement.words:
            if word.letter == "F":
                self._state.add_warning(word, "left-out", word=word.text)
            elif word.letter not in "GXZIKR" or (word.letter == "G" and word.value not in {0, 1, 2, 3}):
                raise make_error(word.line_number, word.column, "code-unknown", word=word.text)

    def _find_center(self, statement: SourceStatement, at: complex, end: complex, motion: float) -> complex:
        r, i, k = (statement.find_word(letter) for letter in "RIK")
        if r is None:
            if i is None and k is None:
                raise make_error(statement.line_number, 1, "arc-centre")
            center = at + complex(
                0.0 if k is None else self._state.convert_length(k),
                0.0 if i is None else self._state.convert_length(i),
            )
            first, last = abs(at - center), abs(end - center)
            if abs(first - last) > 0.0005 * 25.4 or first < _SAME:
                raise make_error(
                    statement.line_number, 1, "arc-radius", first=f"{first:.4f}", last=f"{last:.4f}"
                )
            return center
        radius, chord = self._state.convert_length(r), abs(end - at)
        if radius <= 0 or chord / 2 > radius:
            raise make_error(r.line_number, r.column, "arc-too-small", radius=f"{r.value:g}")
        height = 1j * sqrt(radius * radius - chord * chord / 4) * (end - at) / chord
        return (at + end) / 2 + (height if motion == 3 else -height)

    def _check_direction(self, segments: Sequence[Segment], frame: _Frame) -> None:
        """Move the start of the approach if needed, as LinuxCNC does, and check the direction.

        Raises ProgramError if the contour moves back.
        """
        approach, *contour = segments
        if approach.end.real > approach.start.real:
            approach.start = complex(approach.end.real, approach.start.imag)
        axis = "X" if frame.is_facing else "Z"
        for each in contour:
            farthest = max(_list_extremes(each, 1), default=each.end.real)
            if max(farthest, each.end.real) - each.start.real > _BACKWARD * self._unit:
                raise make_error(self._code.line_number, self._code.column, "cycle-undercut", axis=axis)

    # --- the moves

    def _finish(self, segments: Sequence[Segment], frame: _Frame) -> None:
        """Append the passes of G70, whose distance from the contour decreases from D to E."""
        first, last = self._length("D", 0.0), self._length("E", 0.0)
        word = self._statement.find_word("P")
        count = 1 if word is None else int(word.value)
        if word is not None:
            require_positive(word, word.value)
            limit_pass_count(word, count, 1.0)
        for number in range(count - 1, -1, -1):
            distance = number * (first - last) / count + last
            approach, contour = self._offset(segments, distance)
            self._rapid(frame, approach.start)
            self._rapid(frame, approach.end)
            for each in contour:
                self._cut(frame, each)

    def _rough(self, segments: Sequence[Segment], frame: _Frame) -> None:
        """Append the passes of G71 or G72 and the pass along the contour."""
        distance, infeed, retract = self._length("D", 0.0), self._length("I", 1.0), self._length("R", 0.5)
        approach, contour = self._offset(segments, distance)
        if approach.start.imag <= approach.end.imag + _SAME:
            raise make_error(self._code.line_number, self._code.column, "cycle-start")
        if contour[-1].end.imag < approach.start.imag:
            last = contour[-1].end
            contour.append(Segment(last, complex(last.real, approach.start.imag)))
        self._check_climb(contour, frame)
        limit_pass_count(self._code, approach.start.imag - approach.end.imag, infeed)
        self._rapid(frame, approach.start)
        level = approach.start.imag
        while level > approach.end.imag + _SAME:
            self._cut_level(frame, approach, contour, level, retract)
            level -= infeed
        self._rapid(frame, approach.end)
        for each in contour:
            self._cut(frame, each)

    def _cut_level(
        self, frame: _Frame, approach: Segment, contour: Sequence[Segment], level: float, retract: float
    ) -> None:
        """Append one pass, which ends at the contour and retracts at 45 degrees."""
        share = (level - approach.start.imag) / (approach.end.imag - approach.start.imag)
        enter = approach.start + share * (approach.end - approach.start)
        self._rapid(frame, enter)
        place = _find_crossing(contour, level)
        if place is None or enter.real - place < _SAME:
            return
        out = min(retract, (enter.real - place) / 2.0)
        self._cut(frame, Segment(enter, complex(place, level)))
        self._rapid(frame, complex(place + out, level + out))
        self._rapid(frame, enter + complex(-out, out))
        self._rapid(frame, enter)

    def _check_climb(self, contour: Sequence[Segment], frame: _Frame) -> None:
        """Raise ProgramError if the contour has a pocket."""
        for each in contour:
            deepest = min([each.end.imag, *_list_extremes(each, 0)])
            if (
                deepest < each.start.imag - _SAME
                or max([each.end.imag, *_list_extremes(each, 0)]) > each.end.imag + _SAME
            ):
                axis = "Z" if frame.is_facing else "X"
                raise make_error(self._code.line_number, self._code.column, "cycle-undercut", axis=axis)

    def _offset(self, segments: Sequence[Segment], distance: float) -> tuple[Segment, list[Segment]]:
        approach, *contour = segments
        angle = (approach.end - approach.start) / (contour[-1].start - approach.start)
        found = offset_contour(contour, -distance if angle.imag < 0.0 else distance, self._unit)
        return Segment(approach.start, found[0].start), found

    def _rapid(self, frame: _Frame, point: complex) -> None:
        found = frame.from_frame(point)
        self._state.append_rapid(self._code.line_number, found.imag, found.real)

    def _cut(self, frame: _Frame, segment: Segment) -> None:
        end = frame.from_frame(segment.end)
        if segment.center is None:
            self._state.append_cut(self._code, end.imag, end.real)
            return
        center, state = frame.from_frame(segment.center), self._state
        if state.feed is None:
            raise make_error(self._code.line_number, self._code.column, "feed-missing")
        # OmniTurn sees X+ downward, so that a counterclockwise arc is clockwise.
        clockwise = segment.is_ccw != frame.is_mirrored
        state.append_move(
            StepKind.ARC, self._code.line_number, end.imag, end.real, cx=center.imag, cz=center.real,
            clockwise=clockwise, feed=state.feed, per_rev=state.is_feed_per_rev,
        )  # fmt: skip


def _find_frame(segments: Sequence[Segment], *, is_facing: bool) -> _Frame:
    plain = _Frame(is_facing=is_facing)
    travel = plain.to_frame(segments[0].end) - plain.to_frame(segments[-1].end)
    return _Frame(is_facing=is_facing, flips_real=travel.real < 0.0, flips_imaginary=travel.imag > 0.0)


def _to_piece(segment: Segment) -> ContourPiece:
    center = None if segment.center is None else (segment.center.imag, segment.center.real)
    return ContourPiece(
        (segment.start.imag, segment.start.real),
        (segment.end.imag, segment.end.real),
        center,
        segment.is_ccw,
    )


def _list_extremes(segment: Segment, axis: int) -> list[float]:
    return _to_piece(segment).find_extremes(axis)


def _find_crossing(contour: Sequence[Segment], level: float) -> float | None:
    """Return the real part at which the contour first has the imaginary part ``level``, or None."""
    for each in contour:
        low, high = each.start.imag, each.end.imag
        if not low - _SAME <= level <= high + _SAME:
            continue
        if abs(level - low) <= _SAME:
            return each.start.real
        if abs(level - high) <= _SAME:
            return each.end.real
        piece = _to_piece(each)
        return piece.get_point(piece.find_crossing_fractions(level)[0])[1]
    return None
