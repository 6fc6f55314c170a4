"""Model of the shapes in the editor without Qt: the list, the form, and the text with its lines."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from app.desk.background_work import Latest
from app.desk.pages.editor_panel import PanelModel
from app.desk.pages.sheet import STEPS, Key
from app.desk.translation import tr
from app.extras.shapes.shape_form import AddedForm, ShapeForm
from core.extras.shapes.pieces import (
    Piece,
    begins_subroutine,
    begun,
    ends_program,
    pieces,
    renewed,
    setting_at,
    unreadable,
    with_shape,
)
from core.extras.shapes.shape import Shape
from core.extras.shapes.shape_fields import Setting, Shop
from core.extras.shapes.shape_table import HELPERS_OF, SHAPES, SHAPES_OF
from core.extras.shapes.templates import HEAD
from core.language.source import dialect_of
from core.message import Message


def written_in(name: str) -> bool:
    """Return whether shapes can be written into a program of this name: OmniTurn and SINUMERIK only."""
    return dialect_of(name) in SHAPES_OF


@dataclass(slots=True)
class Shapes(PanelModel):
    """Model of the shapes panel. ``fetch`` reads machine and tool data from the store on a worker.

    ``text`` is the program with the lines of the form. ``at`` is the line, from 0, before which a new shape
    is written. ``number`` counts the texts to prove.
    """

    fetch: Callable[[], Shop] = Shop
    new: Setting = field(default_factory=Setting)
    worker: Latest = field(default_factory=lambda: Latest("editing-shapes"))
    added: tuple[AddedForm, ...] = ()  # forms of other features, at the end of the list
    table: Mapping[str, Shape] = field(default_factory=lambda: SHAPES)  # shapes or calculators of the list
    wanted: Path | None = None  # file that the next added form opens
    shop: Shop = field(default_factory=Shop)
    lines: list[str] = field(default_factory=list)
    at: int = 0
    pieces: list[Piece] = field(default_factory=list)
    form: ShapeForm | None = None
    marked: int = 0
    notice: str = ""
    asked: Callable[[], None] | None = None
    text: str = ""
    number: int = 0
    written: int = 0  # counts the texts to put into the editor
    padded: bool = False  # the number pad is shown
    _typed: dict[str, dict[str, str]] = field(default_factory=dict)

    def close(self) -> None:
        """Stop the workers."""
        self.worker.close()
        for each in self.added:
            each.close()

    def look(self) -> None:
        """Process the results of the workers; called once per frame."""
        self.worker.poll()
        for each in self.added:
            each.poll()

    # --- opening -------------------------------------------------------------------------------------

    def open(self, name: str, text: str, line: int, *, helpers: bool = False) -> str:
        """Open the shapes for a text with the cursor on ``line``, from 1.

        Returns a reason if that is not possible, or an empty string. ``helpers`` lists calculators and
        templates instead, and does not open a piece of the text.
        """
        if not written_in(name):
            return tr("SHAPES WORK ONLY IN OMNITURN AND SINUMERIK PROGRAMS")
        dialect = dialect_of(name)
        forms = {**SHAPES_OF[dialect], **{each.key: each.shape for each in self.added}}
        self.new = replace(self.new, dialect=dialect)
        self.worker.ask(lambda _request: self.fetch(), self._have_shop, self._no_shop)
        self.notice, self.asked, self.form = "", None, None
        self.table = HELPERS_OF[dialect] if helpers else forms
        self._take(text)
        here = self.piece_at(line - 1)
        self.at = self._place(line - 1)
        if here is not None and self.of_shapes:
            self._open_piece(here)
        else:
            self.marked = 0 if not self.listed else max(1, self.marked)
            self._tell_unreadable(line - 1)
        return ""

    def _tell_unreadable(self, line: int) -> None:
        """Report lines of a form that can no longer be read."""
        found = unreadable(self.lines, line, self.new.dialect) if self.of_shapes else None
        if found is not None and line < len(self.lines):
            at, shape = found
            text = tr("LINE {line}: EDITED {shape} COMMENT CANNOT BE READ. UNDO THE EDIT")
            self.notice = tr(Message(text, line=at + 1, shape=tr(shape.name)))

    @property
    def of_shapes(self) -> bool:
        """Whether the list contains shapes instead of calculators and templates."""
        return all(self.table is not each for each in HELPERS_OF.values())

    @property
    def keys_of_list(self) -> tuple[str, ...]:
        """Keys that open the forms of the list."""
        return tuple(self.table)

    @property
    def listed(self) -> list[Piece]:
        """Pieces of the program that follow the forms in the list."""
        return self.pieces if self.of_shapes else []

    def _take(self, text: str) -> None:
        self.lines = text.split("\n")
        while self.lines and not self.lines[-1].strip():
            self.lines.pop()
        self.pieces = pieces(self.lines, self.shop, self.new)
        self._show("\n".join(self.lines) + "\n" if self.lines else "")

    def _have_shop(self, shop: Shop) -> None:
        self.shop = shop
        if self.form is not None and self.form.instead is None:
            form = self.form
            form.use_setting(setting_at(self.lines, self.at, shop, self.new))
            self._preview()

    def _no_shop(self, why: str) -> None:
        self.notice = tr(Message("TOOL DATA CANNOT BE READ: {why}", why=why))

    def piece_at(self, line: int) -> Piece | None:
        """Return the piece that contains a line, counted from 0, or None."""
        return next((each for each in self.pieces if each.first <= line < each.behind), None)

    def _place(self, line: int) -> int:
        """Return the line for a new shape.

        The line is after the piece at the cursor and before the end of the program.
        """
        here = self.piece_at(line)
        at = here.behind if here is not None else min(line + 1, len(self.lines))
        ends = [n for n, each in enumerate(self.lines) if ends_program(each, self.new.dialect)]
        started = [n for n, each in enumerate(self.lines) if begins_subroutine(each)]
        for end in ends:
            begin = max((n for n in started if n < end), default=-1)
            if at <= end or end == ends[-1]:
                return max(min(at, end), begin + 1)
        return at

    # --- list ----------------------------------------------------------------------------------------

    @property
    def listing(self) -> bool:
        """Whether the list is shown."""
        return self.form is None

    def choose(self, place: int) -> None:
        """Select a shape of the list or a piece of the program."""
        self.marked = max(0, min(place, len(self.table) + len(self.listed) - 1))

    def open_marked(self) -> None:
        """Open the form of the selected shape or piece."""
        keys = self.keys_of_list
        if self.marked < len(keys):
            self.open_shape(keys[self.marked])
        elif self.listed:
            self._open_piece(self.listed[self.marked - len(keys)])

    def open_shape(self, key: str) -> None:
        """Open the form of a new shape."""
        self.notice = ""
        shape = self.table[key]
        self.marked = self.keys_of_list.index(key)
        if shape.name == HEAD.name:
            self.at = 0
            head = next((each for each in self.pieces if each.filled.shape is shape), None)
            if head is not None:
                self._open_piece(head)
                return
        elif not shape.noted:
            pass  # a calculator, which does not need a head
        elif self._adder_of(shape) is not None and not self.lines:
            self.at = 0  # the form writes a head
        elif not begun(self.lines, self.new.dialect):
            self.notice = tr("FIRST PRESS N AND FILL IN THE PROGRAM HEADER (HEAD)")
            return
        setting = setting_at(self.lines, self.at, self.shop, self.new)
        adder = self._adder_of(shape)
        if adder is None:
            self.form = ShapeForm(shape, setting)
        else:
            # The drawing is used for selection; on a small screen the pad would cover it.
            self.padded = False
            wanted, self.wanted = self.wanted, None
            self.form = adder.open_form(setting, tuple(self.lines[: self.at]), wanted)
        self._preview()

    def open_file(self, file: Path) -> None:
        """Open the form of the feature that makes a program from this file."""
        for each in self.added:
            if each.makes_of(file.name):
                self.wanted = file
                self.open_shape(each.key)

    def _adder_of(self, shape: Shape) -> AddedForm | None:
        return next((each for each in self.added if each.shape is shape), None)

    @property
    def _adder(self) -> AddedForm | None:
        """Form object that the open form belongs to, or None for a shape."""
        return self._adder_of(self.form.shape) if self.form is not None else None

    def _open_piece(self, piece: Piece) -> None:
        """Open the form of a piece, and report changes made by hand."""
        self.notice, self.asked = "", None
        if piece.taken:
            words = ", ".join(each.label for each in piece.filled.fields if each.word in piece.taken)
            self.notice = tr(
                Message("THE FORM USES THESE VALUES EDITED BY HAND IN THE TEXT: {fields}", fields=words)
            )
        elif piece.foreign >= 0:
            text = tr("LINE {line} EDITED BY HAND. FORM SHOWS VALUES STORED IN COMMENT")
            self.notice = tr(Message(text, line=piece.foreign + 1))
        self.form = ShapeForm(piece.filled.shape, piece.setting, piece)
        self._preview()

    # --- form ----------------------------------------------------------------------------------------

    def keys(self) -> dict[int, Key]:
        """Return the function keys."""
        pad = Key("KEYPAD", self.turn_pad)
        if self.form is None:
            return {2: Key("OPEN", self.open_marked), 9: pad}
        found = {2: Key("WRITE", self.write), 8: Key("LIST", self.to_list), 9: pad}
        if self.asked is not None:
            found[6] = Key("YES", self.answer)
        elif self._adder is not None:
            found |= self._adder.keys(self.form, self._shown_of)
        if self.form.instead is not None:
            found[5] = Key("DELETE", self.delete)
        if self.form.shape.contour:
            found |= {3: Key("POINT +", self.insert_point), 4: Key("POINT -", self.drop_point)}
        return found

    def turn_pad(self) -> None:
        """Show or hide the number pad."""
        self.padded = not self.padded

    def typed(self, key: str) -> bool:
        """Handle a key. Return False if it has no function here."""
        if self.form is not None:
            return self._typed_in_form(self.form, key)
        if key.upper() in self.table:
            self.open_shape(key.upper())
        elif key == "Enter":
            self.open_marked()
        elif key in STEPS:
            self.choose(self.marked + STEPS[key])
        elif key in {"Left", "Right"}:
            self.choose(len(self.table) if key == "Right" and self.listed else 0)
        else:
            return False
        return True

    def _typed_in_form(self, form: ShapeForm, key: str) -> bool:
        if not form.typed_key(key):
            return False
        if self.asked is not None:
            self.asked, self.notice = None, ""
        self._preview()
        return True

    def takes(self, key: str) -> bool:
        """Return whether a character is part of an entry."""
        if self.form is not None:
            return self.form.takes(key)
        return len(key) == 1 and key.upper() in self.table

    def touch(self, word: str) -> None:
        """Select the touched field, point or dimension. A second touch selects the next choice."""
        form = self.form
        if form is None:
            return
        if form.word == word and form.field is not None and form.choices(form.field):
            form.typed_key("Right")
        else:
            form.go_to(word)
        self._preview()

    def touch_at(self, point: tuple[float, float]) -> None:
        """Handle a touch on the drawing outside its dimensions."""
        if self.form is not None:
            self.form.touch_at(point)
            self._preview()

    def touch_cell(self, number: int, column: int) -> None:
        """Select the touched cell of a point."""
        if self.form is not None:
            self.form.go(len(self.form.fields) + number, column)

    def insert_point(self) -> None:
        """Insert a point (F3)."""
        if self.form is not None:
            self.form.insert_point()
            self._preview()

    def drop_point(self) -> None:
        """Delete the selected point (F4)."""
        if self.form is not None:
            self.form.drop_point()
            self._preview()

    def escape(self) -> bool:
        """Cancel the question or the form. Return False on the list."""
        if self.asked is not None:
            self.asked, self.notice = None, ""
        elif self.notice:
            self.notice = ""
        elif self.form is not None and self.form.waits and self._adder is not None:
            self._adder.cancel(self.form)
        elif self.form is not None:
            self.to_list()
        else:
            return False
        return True

    def to_list(self) -> None:
        """Return to the list and discard unwritten entries."""
        self.asked, self.notice, self.form = None, "", None
        self._show("\n".join(self.lines) + "\n" if self.lines else "")

    def write(self) -> None:
        """Write the form into the text (F2). Replacing lines edited by hand requires confirmation."""
        form = self.form
        if form is None:
            return
        if form.waits:
            return  # the prompt gives the reason
        if form.troubles:
            self.notice = ""
            self._to_trouble(form)
        elif form.instead is not None and form.instead.foreign >= 0 and self.asked is None:
            count = form.instead.count
            text = tr("F6: REPLACE {count} EDITED LINES STARTING AT LINE {line}   ESC: KEEP")
            self.notice = tr(Message(text, count=count, line=form.instead.first + 1))
            self.asked = self._write
        else:
            self._write()

    def answer(self) -> None:
        """Confirm the pending question (F6)."""
        asked, self.asked = self.asked, None
        if asked is not None:
            asked()

    def _to_trouble(self, form: ShapeForm) -> None:
        word = next(iter(form.troubles))
        form.go_to(word)

    def _write(self) -> None:
        form = self.form
        assert form is not None
        text, behind = with_shape(self.lines, self.at, form.one, form.setting, form.instead)
        said = ""
        if form.shape.name == HEAD.name and form.instead is not None:
            grown = len(form.lines) - form.instead.count
            moved = [_moved(each, grown) for each in self.pieces if each.filled.shape is not form.shape]
            text, stay = renewed(text, self.shop, moved)
            if stay == 1:
                said = tr("1 SHAPE EDITED BY HAND WAS NOT CHANGED")
            elif stay:
                said = tr(Message("{count} SHAPES EDITED BY HAND WERE NOT CHANGED", count=stay))
        self.form, self.notice, self.asked = None, said, None
        self._take("\n".join(text) + "\n")
        self.at = behind
        self.written += 1
        self.marked = 0 if not self.pieces else max(1, self.marked)

    def delete(self) -> None:
        """Delete the piece from the text after confirmation (F5)."""
        form = self.form
        if form is None or form.instead is None:
            return
        self.notice = tr(
            Message(
                "F6: DELETE THE {count} LINES OF THIS SHAPE   ESC: KEEP THEM",
                count=form.instead.count,
            )
        )
        self.asked = self._delete

    def _delete(self) -> None:
        form = self.form
        assert form is not None
        assert form.instead is not None
        piece = form.instead
        self.form, self.notice = None, ""
        self._take("\n".join([*self.lines[: piece.first], *self.lines[piece.behind :]]) + "\n")
        self.at = piece.first
        self.written += 1

    @property
    def line(self) -> int:
        """Line, from 1, up to which the path is shown: the end of the form, or the insertion line."""
        form = self.form
        if form is None:
            return self.at
        return (form.instead.first if form.instead is not None else self.at) + len(form.lines)

    def _preview(self) -> None:
        """Show the text with the lines of the form, or the unchanged text while the form is incomplete."""
        form = self.form
        if form is None:
            return
        if self._adder is not None:
            self._adder.work(form, self._shown_of, self._tell)
        if form.troubles or not form.lines:
            self._show("\n".join(self.lines) + "\n" if self.lines else "")
            return
        text, _ = with_shape(self.lines, self.at, form.one, form.setting, form.instead)
        self._show("\n".join(text) + "\n")

    def _shown_of(self, form: ShapeForm) -> str | None:
        """Show a calculated form and return the text, or None if the form is closed."""
        if self.form is not form:
            return None
        self._preview()
        return self.text

    def _tell(self, words: str) -> None:
        self.notice = words

    def _show(self, text: str) -> None:
        if text != self.text:
            self.text = text
            self.number += 1

    def prompt(self) -> str:
        """Return the prompt for the present keys."""
        if self.notice:
            return self.notice
        if self.form is None and not self.of_shapes:
            return tr("LETTER: OPEN CALCULATOR OR TEMPLATE   F10: GO TO TEXT")
        if self.form is None:
            return tr("LETTER: OPEN SHAPE   RIGHT: SHAPES IN PROGRAM   F10: TEXT")
        if self._adder is not None:
            return self._adder.prompt(self.form)
        return tr(self.form.trouble or _keys_of(self.form))


def _keys_of(form: ShapeForm) -> str:
    if form.point >= 0:
        return tr("X Z C R A: GO TO COLUMN   ENTER: NEXT POINT   F2: WRITE")
    return tr("TYPE A NUMBER OR EXPRESSION   ENTER: NEXT FIELD   F2: WRITE")


def _moved(piece: Piece, by: int) -> Piece:
    return replace(piece, first=piece.first + by, foreign=piece.foreign + by if piece.foreign >= 0 else -1)
