"""Parser of one Klartext line, with its number, skip character, block and comment."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable

from core.language.diagnostics import ProgramError
from core.language.klartext import cycle_blocks, path_block, plane_block, q_parameters, structure_blocks
from core.language.klartext.klartext_faults import (
    CONTOUR_FORMULAS,
    STRING_FUNCTIONS,
    UnsupportedCodes,
    make_syntax_error,
)
from core.language.klartext.klartext_nodes import HeadingLine, KlartextLine, Node, PathFunction, StopBlock
from core.language.klartext.klartext_words import AxisWord, FeedWord, Value
from core.language.klartext.line_cursor import LineCursor
from core.language.line_reading import find_comment_start
from core.message import Message

# --- L moves with plain numbers: nearly all lines of a long program, read by two patterns


_NUMBER = r"[+-]?[0-9]{1,6}(?:\.[0-9]{1,9})?"
_MOVE = re.compile(
    rf"([0-9]{{1,9}} )?L((?: I?[XYZABC]{_NUMBER}){{1,6}})(?: R([0LR]))?"
    r"(?: F(MAX|[0-9]{1,6}(?:\.[0-9]{1,6})?))?"
)
_WORD = re.compile(rf"(I?)([XYZABC])({_NUMBER})")


def parse_plain_move(number: int, text: str) -> KlartextLine | None:
    """Return the line if it contains only an L move with plain numbers, or None for any other line."""
    match = _MOVE.fullmatch(text)
    if match is None:
        return None
    block, _, radius, speed = match.groups()
    axes = []
    seen = set()
    for word in _WORD.finditer(text, match.start(2), match.end(2)):
        sign, axis, digits = word.groups()
        seen.add(axis)
        value = Value(float(digits) + 0.0, column=word.start(3) + 1)
        axes.append(AxisWord(axis, value, sign == "I", word.start() + 1))
    if len(seen) < len(axes):
        return None
    feed = None if speed is None else _feed(speed, match.start(4))
    move = PathFunction(tuple(axes), radius or "", feed, column=match.start(2))
    return KlartextLine(number, move, None if block is None else int(block))


def _feed(speed: str, at: int) -> FeedWord:
    if speed == "MAX":
        return FeedWord("max", None, at)
    return FeedWord("value", Value(float(speed), column=at + 1), at)


MAX_LINE_LENGTH = 8192
_HEAD = re.compile(r"\s*(/?)\s*([0-9]+)?\s*(/?)\s*")
_M = re.compile(r"M(?=\s*[0-9])")
_Q = re.compile(r"Q[LR]?(?=\s*[0-9])")
_ONE_AXIS = re.compile(r"I?[XYZABCUVW](?=\s*[+\-.,]?\s*[0-9Q])")
_FN = re.compile(r"FN\s*([0-9]+)\s*")


def _any_of(names: Iterable[str], end: str) -> re.Pattern[str]:
    """Return a pattern for the first of these names that precedes ``end``.

    Any number of blanks may separate the words of a name.
    """
    return re.compile("|".join(r"\s+".join(name.split()) + end for name in names))


_PATHS = _any_of(sorted(path_block.PATH_FORMS, key=len, reverse=True), r"(?![A-Z0-9])")

# Blocks of the original control that are not supported. A longer name precedes a shorter name with the same
# start.
_UNSUPPORTED_FUNCTIONS = (
    *("TCH PROBE", "POLARKIN", "LT", "FPOL", "FSELECT", "FLT", "FCT", "FL", "FC"),
    *("SPL", "WHILE", "IF", "STRAIGHT", "SQL", "TABDATA", "CALL SELECTED CYCLE"),
    *("SEL CYCLE", "SEL CORR-TABLE", "PRESET COPY", "PRESET CORR", "OPEN FILE"),
    *("SEL CONTOUR", "DECLARE CONTOUR", "QC", "DECLARE STRING", "QS"),
)
_FREE = UnsupportedCodes("Free contour programming (FK: FPOL, FL, FC, FLT, FCT, FSELECT)", "")
_COMBINED_GROUPS = {
    **dict.fromkeys(("FPOL", "FSELECT", "FLT", "FCT", "FL", "FC"), _FREE),
    **dict.fromkeys(("SEL CONTOUR", "DECLARE CONTOUR", "QC"), CONTOUR_FORMULAS),
    **dict.fromkeys(("DECLARE STRING", "QS"), STRING_FUNCTIONS),
}  # reported together
_UNSUPPORTED_STARTS = _any_of(_UNSUPPORTED_FUNCTIONS, r"(?![A-Z])")


def parse_line(number: int, text: str) -> KlartextLine:
    """Parse line ``number``, and return it with its syntax error if any.

    The function does not raise exceptions.
    """
    if (plain := parse_plain_move(number, text)) is not None:
        return plain
    if len(text) > MAX_LINE_LENGTH:
        problem = make_syntax_error(
            number,
            1,
            Message("The line is too long ({text_count} characters).", text_count=len(text)),
            "Split the line into shorter lines.",
        )
        return KlartextLine(number, error=problem.diagnostic)
    end = find_comment_start(text)
    code, comment = text[:end], text[end + 1 :].strip() if end < len(text) else None
    head = _HEAD.match(code)
    assert head is not None  # The pattern always matches, because all its parts are optional.
    block, skip = head.group(2), bool(head.group(1) or head.group(3))
    number_of_block = int(block) if block is not None and len(block) <= 9 else None
    code = code.rstrip().removesuffix(CONTINUATION_SIGN).rstrip()
    shown = " ".join(code[head.end() :].split())
    try:
        node = _node(LineCursor(number, code, head.end()))
    except ProgramError as problem:
        return KlartextLine(number, None, number_of_block, skip, comment, problem.diagnostic, shown)
    # A path function is formatted again from its words. Any other block is shown as it was written.
    return KlartextLine(
        number,
        node,
        number_of_block,
        skip,
        comment,
        block_text="" if isinstance(node, PathFunction) else shown,
    )


CONTINUATION_SIGN = "~"
"""Sign that ends a line if its block continues on the next line. It follows any comment."""


def _node(cursor: LineCursor) -> Node | None:
    if cursor.is_at_end:
        return None
    column = cursor.column
    if form := cursor.match_pattern(_PATHS):
        return path_block.read_path_function(cursor, " ".join(form.group().split()), column)
    if cursor.text[cursor.index] == "*":
        return HeadingLine(cursor.read_remaining_text()[1:].strip().removeprefix("-").strip())
    return _by_keyword(cursor) or _by_letter(cursor)


def _by_keyword(cursor: LineCursor) -> Node | None:
    column, match = cursor.column, cursor.match_pattern(_STARTS)
    if match is None:
        return None
    words = " ".join(match.group().split())
    return _KEYWORDS[_SYNONYMS.get(words, words)](cursor, column)


def _stop(cursor: LineCursor, _column: int) -> Node:
    codes = path_block.read_remaining_m_functions(cursor)
    return StopBlock(codes)


_KEYWORDS: dict[str, Callable[[LineCursor, int], Node]] = {
    "CC": path_block.read_pole,
    "RND": lambda cursor, column: path_block.read_corner(cursor, "RND", column),
    "CHF": lambda cursor, column: path_block.read_corner(cursor, "CHF", column),
    "BEGIN PGM": lambda cursor, _: structure_blocks.read_begin(cursor),
    "END PGM": lambda cursor, _: structure_blocks.read_end(cursor),
    "BLK FORM": lambda cursor, _: structure_blocks.read_blank_form(cursor),
    "TOOL CALL": lambda cursor, _: structure_blocks.read_tool_call(cursor),
    "TOOL DEF": structure_blocks.read_tool_definition,
    "PLANE": plane_block.plane,
    "TRANS": structure_blocks.read_transformation,
    "CYCL DEF": cycle_blocks.read_cycle_definition,
    "CYCL CALL": cycle_blocks.call,
    "PATTERN DEF": cycle_blocks.read_pattern_definition,
    "CONTOUR DEF": cycle_blocks.read_contour_definition,
    "GLOBAL DEF": cycle_blocks.read_global_definition,
    "PRESET SELECT": cycle_blocks.read_preset_selection,
    "WMAT": structure_blocks.read_material,
    "CALL LBL": lambda cursor, _: structure_blocks.call(cursor),
    "CALL PGM": structure_blocks.read_program_call,
    "CALL SELECTED": structure_blocks.read_selected_call,
    **{
        Message("SEL {kind}", kind=kind): structure_blocks.make_selection_reader(kind)
        for kind in ("PGM", "TABLE", "PATTERN")
    },
    "LBL": lambda cursor, _: structure_blocks.read_label(cursor),
    "FUNCTION": structure_blocks.read_function_block,
    "STOP": _stop,
}
_SYNONYMS = {"CYCLE DEF": "CYCL DEF", "CYCLE CALL": "CYCL CALL"}  # variants that some postprocessors write
_STARTS = _any_of((*_SYNONYMS, *_KEYWORDS), r"(?![A-Z])")


def _by_letter(cursor: LineCursor) -> Node:
    column = cursor.column
    if _M.match(cursor.uppercase_text, cursor.index):
        return path_block.read_m_function_block(cursor)
    if _ONE_AXIS.match(cursor.uppercase_text, cursor.index):
        return path_block.read_paraxial_move(cursor, column)
    if match := cursor.match_pattern(_FN):
        return q_parameters.read_fn_block(cursor, int(match.group(1)[:4]), column)
    if _Q.match(cursor.uppercase_text, cursor.index):
        return q_parameters.read_assignment(cursor)
    raise _make_start_error(cursor)


def _make_start_error(cursor: LineCursor) -> ProgramError:
    """Return the error for a text that cannot start a block; it names the function if it is known."""
    column = cursor.column
    if match := _UNSUPPORTED_STARTS.match(cursor.uppercase_text, cursor.index):
        name = " ".join(match.group().split())
        if name == "TCH PROBE":
            return structure_blocks.make_touch_probe_error(cursor, column)
        return _COMBINED_GROUPS.get(name, UnsupportedCodes(name, "")).make_error(cursor.line_number, column)
    text = Message("'{next_word}' cannot begin a block.", next_word=cursor.next_word)
    hint = cursor.choose_hint("Begin the block with a word such as L, PLANE, TOOL CALL or LBL.")
    return make_syntax_error(cursor.line_number, column, text, hint)
