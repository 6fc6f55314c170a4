"""Positions of shapes in a program: the shape at a line, and the line at which to insert a shape."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from core.extras.shapes.shape_pieces import ProgramShape, ends_program, starts_subroutine
from core.extras.shapes.shape_table import SHAPES_BY_DIALECT
from core.language.source import Dialect, guess_dialect


def supports_shapes(name: str) -> bool:
    """Return whether shapes can be written into a program with this name.

    Only OmniTurn and SINUMERIK programs can contain shapes.
    """
    return guess_dialect(name) in SHAPES_BY_DIALECT


def find_piece_at_line(pieces: Sequence[ProgramShape], line: int) -> ProgramShape | None:
    """Return the shape whose lines contain a line (counted from 0), or None if there is none."""
    return next((each for each in pieces if each.first_line <= line < each.next_line), None)


def find_insertion_line(
    program_lines: Sequence[str], pieces: Sequence[ProgramShape], line: int, dialect: Dialect
) -> int:
    """Return the line at which a new shape is inserted.

    The line is after the shape at the cursor and before the end of the program.
    """
    here = find_piece_at_line(pieces, line)
    at = here.next_line if here is not None else min(line + 1, len(program_lines))
    ends = [n for n, each in enumerate(program_lines) if ends_program(each, dialect)]
    started = [n for n, each in enumerate(program_lines) if starts_subroutine(each)]
    for end in ends:
        begin = max((n for n in started if n < end), default=-1)
        if at <= end or end == ends[-1]:
            return max(min(at, end), begin + 1)
    return at


def move_piece_down(piece: ProgramShape, by: int) -> ProgramShape:
    """Return a shape with its line numbers increased by ``by``."""
    return replace(
        piece,
        first_line=piece.first_line + by,
        edited_line=piece.edited_line + by if piece.edited_line >= 0 else -1,
    )
