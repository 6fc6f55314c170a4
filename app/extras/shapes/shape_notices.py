"""Notices about shapes whose program lines were edited by hand, and the key prompt of a form."""

from __future__ import annotations

from collections.abc import Sequence

from app.desk.translation import tr
from app.extras.shapes.shape_form import ShapeForm
from core.extras.shapes.shape_pieces import ProgramShape, find_damaged_comment
from core.language.source import Dialect
from core.message import Message


def describe_damaged_comment(program_lines: Sequence[str], line: int, dialect: Dialect) -> str:
    """Return a notice if the form comment of the shape at a line is unreadable.

    Otherwise, return an empty string.
    """
    found = find_damaged_comment(program_lines, line, dialect)
    if found is None or line >= len(program_lines):
        return ""
    at, shape = found
    text = tr("LINE {line}: EDITED {shape} COMMENT CANNOT BE READ. UNDO THE EDIT")
    return tr(Message(text, line=at + 1, shape=tr(shape.name)))


def describe_manual_edits(piece: ProgramShape) -> str:
    """Return a notice if the lines of a shape were edited by hand, or else an empty string."""
    if piece.adopted_field_names:
        words = ", ".join(
            each.label
            for each in piece.shape_instance.applicable_fields
            if each.name in piece.adopted_field_names
        )
        return tr(Message("THE FORM USES THESE VALUES EDITED BY HAND IN THE TEXT: {fields}", fields=words))
    if piece.edited_line >= 0:
        text = tr("LINE {line} EDITED BY HAND. FORM SHOWS VALUES STORED IN COMMENT")
        return tr(Message(text, line=piece.edited_line + 1))
    return ""


def describe_unchanged_shapes(count: int) -> str:
    """Return the notice that ``count`` hand-edited shapes are unchanged, or an empty string for 0."""
    if count == 1:
        return tr("1 SHAPE EDITED BY HAND WAS NOT CHANGED")
    return tr(Message("{count} SHAPES EDITED BY HAND WERE NOT CHANGED", count=count)) if count else ""


def describe_form_keys(form: ShapeForm) -> str:
    """Return the prompt that explains the keys of a form."""
    if form.selected_point >= 0:
        return tr("X Z C R A: GO TO COLUMN   ENTER: NEXT POINT   F2: WRITE")
    return tr("TYPE A NUMBER OR EXPRESSION   ENTER: NEXT FIELD   F2: WRITE")
