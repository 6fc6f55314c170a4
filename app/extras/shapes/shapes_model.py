"""Model of the shapes panel, independent of Qt: list of shapes, open form and program text."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from app.desk.background_work import LatestRequestWorker
from app.desk.pages.editor_panel import EditorPanelModel
from app.desk.pages.table_content import ROW_STEPS, FunctionKey
from app.desk.translation import tr
from app.extras.shapes.shape_form import AdditionalForm, ShapeForm
from app.extras.shapes.shape_notices import (
    describe_damaged_comment,
    describe_form_keys,
    describe_manual_edits,
    describe_unchanged_shapes,
)
from app.extras.shapes.shape_places import (
    find_insertion_line,
    find_piece_at_line,
    move_piece_down,
    supports_shapes,
)
from core.extras.shapes.editor_shape import Shape
from core.extras.shapes.shape_fields import ProgramSettings, ShopData
from core.extras.shapes.shape_pieces import (
    ProgramShape,
    find_active_settings,
    find_program_shapes,
    has_units,
    insert_shape,
    rewrite_program_shapes,
)
from core.extras.shapes.shape_table import CALCULATORS_BY_DIALECT, SHAPES_BY_DIALECT, SHAPES_BY_KEY
from core.extras.shapes.templates import HEAD_SHAPE
from core.language.source import guess_dialect
from core.message import Message


@dataclass(slots=True)
class ShapesModel(EditorPanelModel):
    """Model of the shapes panel.

    - ``read_shop_data`` reads machine and tool data from the store on a worker.
    - ``text`` is the program including the lines of the open form.
    - ``text_number`` increases with each text to prove.
    - ``cursor_line``, counted from 0, is the line before which a new shape is inserted.
    """

    read_shop_data: Callable[[], ShopData] = ShopData
    initial_settings: ProgramSettings = field(default_factory=ProgramSettings)
    worker: LatestRequestWorker = field(default_factory=lambda: LatestRequestWorker("editing-shapes"))
    additional_forms: tuple[AdditionalForm, ...] = ()  # forms of other features, at the end of the list
    shape_table: Mapping[str, Shape] = field(
        default_factory=lambda: SHAPES_BY_KEY
    )  # shapes or calculators of the list
    requested_file: Path | None = None  # file that the next added form opens
    shop_data: ShopData = field(default_factory=ShopData)
    program_lines: list[str] = field(default_factory=list)
    cursor_line: int = 0
    shape_pieces: list[ProgramShape] = field(default_factory=list)
    form: ShapeForm | None = None
    selected_row: int = 0
    notice_text: str = ""
    pending_action: Callable[[], None] | None = None
    text: str = ""
    text_number: int = 0
    write_count: int = 0  # counts the texts to put into the editor
    is_number_pad_visible: bool = False  # the number pad is shown
    _typed: dict[str, dict[str, str]] = field(default_factory=dict)

    def close(self) -> None:
        """Stop the workers."""
        self.worker.close()
        for each in self.additional_forms:
            each.close()

    def process_results(self) -> None:
        """Process the results of the workers.

        This method is called once per frame.
        """
        self.worker.deliver_results()
        for each in self.additional_forms:
            each.poll()

    # --- opening -------------------------------------------------------------------------------------

    def open_program_text(
        self, name: str, text: str, cursor_line: int, *, lists_helpers: bool = False
    ) -> str:
        """Open the shapes panel for a program text.

        ``cursor_line`` is the line of the cursor, counted from 1.

        If ``lists_helpers`` is True, the list contains calculators and templates instead of shapes, and the
        shape at the cursor is not opened. Returns an empty string, or the reason if the panel cannot be
        opened.
        """
        if not supports_shapes(name):
            return tr("SHAPES WORK ONLY IN OMNITURN AND SINUMERIK PROGRAMS")
        dialect = guess_dialect(name)
        forms = {**SHAPES_BY_DIALECT[dialect], **{each.key: each.shape for each in self.additional_forms}}
        self.initial_settings = replace(self.initial_settings, dialect=dialect)
        self.worker.request_work(lambda _request: self.read_shop_data(), self._have_shop, self._no_shop)
        self.notice_text, self.pending_action, self.form = "", None, None
        self.shape_table = CALCULATORS_BY_DIALECT[dialect] if lists_helpers else forms
        self._take(text)
        here = find_piece_at_line(self.shape_pieces, cursor_line - 1)
        self.cursor_line = find_insertion_line(
            self.program_lines, self.shape_pieces, cursor_line - 1, self.initial_settings.dialect
        )
        if here is not None and self.is_listing_shapes:
            self._open_piece(here)
        else:
            self.selected_row = 0 if not self.listed_pieces else max(1, self.selected_row)
            if self.is_listing_shapes:
                self.notice_text = describe_damaged_comment(self.program_lines, cursor_line - 1, dialect)
        return ""

    @property
    def is_listing_shapes(self) -> bool:
        """Return whether the list contains shapes. Otherwise it contains calculators and templates."""
        return all(self.shape_table is not each for each in CALCULATORS_BY_DIALECT.values())

    @property
    def form_keys(self) -> tuple[str, ...]:
        """Return the keys that open the forms in the list of shapes."""
        return tuple(self.shape_table)

    @property
    def listed_pieces(self) -> list[ProgramShape]:
        """Return the existing shapes of the program, which are listed after the forms for new shapes."""
        return self.shape_pieces if self.is_listing_shapes else []

    def _take(self, text: str) -> None:
        self.program_lines = text.split("\n")
        while self.program_lines and not self.program_lines[-1].strip():
            self.program_lines.pop()
        self.shape_pieces = find_program_shapes(self.program_lines, self.shop_data, self.initial_settings)
        self._show("\n".join(self.program_lines) + "\n" if self.program_lines else "")

    def _have_shop(self, shop: ShopData) -> None:
        self.shop_data = shop
        if self.form is not None and self.form.replaced_piece is None:
            form = self.form
            form.apply_settings(
                find_active_settings(self.program_lines, self.cursor_line, shop, self.initial_settings)
            )
            self._preview()

    def _no_shop(self, why: str) -> None:
        self.notice_text = tr(Message("TOOL DATA CANNOT BE READ: {why}", why=why))

    # --- list ----------------------------------------------------------------------------------------

    @property
    def is_list_shown(self) -> bool:
        """Return whether the list is shown instead of a form."""
        return self.form is None

    def select_row(self, row: int) -> None:
        """Select a row of the list: a form for a new shape, or an existing shape of the program."""
        self.selected_row = max(0, min(row, len(self.shape_table) + len(self.listed_pieces) - 1))

    def open_selected_row(self) -> None:
        """Open the form of the selected row, for a new shape or for an existing shape."""
        keys = self.form_keys
        if self.selected_row < len(keys):
            self.open_shape_form(keys[self.selected_row])
        elif self.listed_pieces:
            self._open_piece(self.listed_pieces[self.selected_row - len(keys)])

    def open_shape_form(self, key: str) -> None:
        """Open the form of a new shape."""
        self.notice_text = ""
        shape = self.shape_table[key]
        self.selected_row = self.form_keys.index(key)
        if shape.name == HEAD_SHAPE.name:
            self.cursor_line = 0
            head = next((each for each in self.shape_pieces if each.shape_instance.shape is shape), None)
            if head is not None:
                self._open_piece(head)
                return
        elif not shape.has_comment:
            pass  # a calculator, which does not need a head
        elif self._adder_of(shape) is not None and not self.program_lines:
            self.cursor_line = 0  # the form writes a head
        elif not has_units(self.program_lines, self.initial_settings.dialect):
            self.notice_text = tr("FIRST PRESS N AND FILL IN THE PROGRAM HEADER (HEAD)")
            return
        setting = find_active_settings(
            self.program_lines, self.cursor_line, self.shop_data, self.initial_settings
        )
        adder = self._adder_of(shape)
        if adder is None:
            self.form = ShapeForm(shape, setting)
        else:
            # The drawing is used for selection; on a small screen the pad would cover it.
            self.is_number_pad_visible = False
            wanted, self.requested_file = self.requested_file, None
            self.form = adder.open_form(setting, tuple(self.program_lines[: self.cursor_line]), wanted)
        self._preview()

    def open_file(self, file: Path) -> None:
        """Open the form that makes a program from a file, such as a drawing."""
        for each in self.additional_forms:
            if each.accepts_file(file.name):
                self.requested_file = file
                self.open_shape_form(each.key)

    def _adder_of(self, shape: Shape) -> AdditionalForm | None:
        return next((each for each in self.additional_forms if each.shape is shape), None)

    @property
    def _adder(self) -> AdditionalForm | None:
        """Return the additional form that is open, or None.

        The result is None if no form is open, or if the open form belongs to a shape.
        """
        return self._adder_of(self.form.shape) if self.form is not None else None

    def _open_piece(self, piece: ProgramShape) -> None:
        """Open the form of an existing shape, and show a notice if its lines were edited by hand."""
        self.notice_text, self.pending_action = describe_manual_edits(piece), None
        self.form = ShapeForm(piece.shape_instance.shape, piece.settings, piece)
        self._preview()

    # --- form ----------------------------------------------------------------------------------------

    def make_function_keys(self) -> dict[int, FunctionKey]:
        """Return the function keys of the open form, or of the list if no form is open."""
        pad = FunctionKey("KEYPAD", self.toggle_number_pad)
        if self.form is None:
            return {2: FunctionKey("OPEN", self.open_selected_row), 9: pad}
        found = {
            2: FunctionKey("WRITE", self.write_form),
            8: FunctionKey("LIST", self.return_to_list),
            9: pad,
        }
        if self.pending_action is not None:
            found[6] = FunctionKey("YES", self.confirm_question)
        elif self._adder is not None:
            found |= self._adder.make_function_keys(self.form, self._show_calculated)
        if self.form.replaced_piece is not None:
            found[5] = FunctionKey("DELETE", self.delete_piece)
        if self.form.shape.has_point_table:
            found |= {
                3: FunctionKey("POINT +", self.insert_point),
                4: FunctionKey("POINT -", self.delete_point),
            }
        return found

    def toggle_number_pad(self) -> None:
        """Show or hide the number pad on the screen."""
        self.is_number_pad_visible = not self.is_number_pad_visible

    def handle_key(self, key: str) -> bool:
        """Handle a key, and return False if the key has no function in the form or the list."""
        if self.form is not None:
            return self._typed_in_form(self.form, key)
        if key.upper() in self.shape_table:
            self.open_shape_form(key.upper())
        elif key == "Enter":
            self.open_selected_row()
        elif key in ROW_STEPS:
            self.select_row(self.selected_row + ROW_STEPS[key])
        elif key in {"Left", "Right"}:
            self.select_row(len(self.shape_table) if key == "Right" and self.listed_pieces else 0)
        else:
            return False
        return True

    def _typed_in_form(self, form: ShapeForm, key: str) -> bool:
        if not form.handle_key(key):
            return False
        if self.pending_action is not None:
            self.pending_action, self.notice_text = None, ""
        self._preview()
        return True

    def accepts_key(self, key: str) -> bool:
        """Return whether a character can be entered in the open form, or opens a form from the list."""
        if self.form is not None:
            return self.form.accepts_key(key)
        return len(key) == 1 and key.upper() in self.shape_table

    def select_touched_field(self, word: str) -> None:
        """Select the touched field, point or dimension.

        A second touch on a field with choices selects the next choice.
        """
        form = self.form
        if form is None:
            return
        if (
            form.selected_field_name == word
            and form.selected_field is not None
            and form.list_choices(form.selected_field)
        ):
            form.handle_key("Right")
        else:
            form.select_field_by_name(word)
        self._preview()

    def handle_touch(self, point: tuple[float, float]) -> None:
        """Handle a touch on the sketch outside its dimensions."""
        if self.form is not None:
            self.form.handle_touch(point)
            self._preview()

    def select_touched_cell(self, point_index: int, column: int) -> None:
        """Select the touched cell in the table of contour points."""
        if self.form is not None:
            self.form.select_row(len(self.form.fields) + point_index, column)

    def insert_point(self) -> None:
        """Insert a point before the selected point (F3)."""
        if self.form is not None:
            self.form.insert_point()
            self._preview()

    def delete_point(self) -> None:
        """Delete the selected point (F4)."""
        if self.form is not None:
            self.form.delete_point()
            self._preview()

    def handle_escape(self) -> bool:
        """Cancel the question, the calculation or the form, and return False if only the list is shown."""
        if self.pending_action is not None:
            self.pending_action, self.notice_text = None, ""
        elif self.notice_text:
            self.notice_text = ""
        elif self.form is not None and self.form.is_calculating and self._adder is not None:
            self._adder.cancel(self.form)
        elif self.form is not None:
            self.return_to_list()
        else:
            return False
        return True

    def return_to_list(self) -> None:
        """Return to the list of shapes, and discard entries that were not written to the program."""
        self.pending_action, self.notice_text, self.form = None, "", None
        self._show("\n".join(self.program_lines) + "\n" if self.program_lines else "")

    def write_form(self) -> None:
        """Write the form into the program text (F2).

        Replacing lines that were edited by hand requires confirmation.
        """
        form = self.form
        if form is None:
            return
        if form.is_calculating:
            return  # the prompt gives the reason
        if form.error_texts:
            self.notice_text = ""
            self._to_trouble(form)
        elif (
            form.replaced_piece is not None
            and form.replaced_piece.edited_line >= 0
            and self.pending_action is None
        ):
            count = form.replaced_piece.line_count
            text = tr("F6: REPLACE {count} EDITED LINES STARTING AT LINE {line}   ESC: KEEP")
            self.notice_text = tr(Message(text, count=count, line=form.replaced_piece.first_line + 1))
            self.pending_action = self._write
        else:
            self._write()

    def confirm_question(self) -> None:
        """Confirm the pending question (F6)."""
        asked, self.pending_action = self.pending_action, None
        if asked is not None:
            asked()

    def _to_trouble(self, form: ShapeForm) -> None:
        word = next(iter(form.error_texts))
        form.select_field_by_name(word)

    def _write(self) -> None:
        form = self.form
        assert form is not None
        text, next_line = insert_shape(
            self.program_lines, self.cursor_line, form.filled_shape, form.settings, form.replaced_piece
        )
        said = ""
        if form.shape.name == HEAD_SHAPE.name and form.replaced_piece is not None:
            grown = len(form.program_lines) - form.replaced_piece.line_count
            moved = [
                move_piece_down(each, grown)
                for each in self.shape_pieces
                if each.shape_instance.shape is not form.shape
            ]
            text, stay = rewrite_program_shapes(text, self.shop_data, moved)
            said = describe_unchanged_shapes(stay)
        self.form, self.notice_text, self.pending_action = None, said, None
        self._take("\n".join(text) + "\n")
        self.cursor_line = next_line
        self.write_count += 1
        self.selected_row = 0 if not self.shape_pieces else max(1, self.selected_row)

    def delete_piece(self) -> None:
        """Delete the lines of the shape from the program text (F5), after confirmation."""
        form = self.form
        if form is None or form.replaced_piece is None:
            return
        self.notice_text = tr(
            Message(
                "F6: DELETE THE {count} LINES OF THIS SHAPE   ESC: KEEP THEM",
                count=form.replaced_piece.line_count,
            )
        )
        self.pending_action = self._delete

    def _delete(self) -> None:
        form = self.form
        assert form is not None
        assert form.replaced_piece is not None
        piece = form.replaced_piece
        self.form, self.notice_text = None, ""
        self._take(
            "\n".join([*self.program_lines[: piece.first_line], *self.program_lines[piece.next_line :]])
            + "\n"
        )
        self.cursor_line = piece.first_line
        self.write_count += 1

    @property
    def path_end_line(self) -> int:
        """Return the line number up to which the tool path is shown, counted from 1.

        This is the last line that the form writes, or the insertion line if no form is open.
        """
        form = self.form
        if form is None:
            return self.cursor_line
        return (
            form.replaced_piece.first_line if form.replaced_piece is not None else self.cursor_line
        ) + len(form.program_lines)

    def _preview(self) -> None:
        """Show the program text with the lines of the form, or the old text if the form is incomplete."""
        form = self.form
        if form is None:
            return
        if self._adder is not None:
            self._adder.calculate(form, self._show_calculated, self._tell)
        if form.error_texts or not form.program_lines:
            self._show("\n".join(self.program_lines) + "\n" if self.program_lines else "")
            return
        text, _ = insert_shape(
            self.program_lines, self.cursor_line, form.filled_shape, form.settings, form.replaced_piece
        )
        self._show("\n".join(text) + "\n")

    def _show_calculated(self, form: ShapeForm) -> str | None:
        """Show a calculated form and return the program text. Return None if the form was closed."""
        if self.form is not form:
            return None
        self._preview()
        return self.text

    def _tell(self, words: str) -> None:
        self.notice_text = words

    def _show(self, text: str) -> None:
        if text != self.text:
            self.text = text
            self.text_number += 1

    def prompt_text(self) -> str:
        """Return the prompt that explains the current keys."""
        if self.notice_text:
            return self.notice_text
        if self.form is None and not self.is_listing_shapes:
            return tr("LETTER: OPEN CALCULATOR OR TEMPLATE   F10: GO TO TEXT")
        if self.form is None:
            return tr("LETTER: OPEN SHAPE   RIGHT: SHAPES IN PROGRAM   F10: TEXT")
        if self._adder is not None:
            return self._adder.prompt_text(self.form)
        return tr(self.form.current_error or describe_form_keys(self.form))
