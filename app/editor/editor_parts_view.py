"""Areas of the editor page and their layout: head line, path, findings and on-screen keyboard."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QFontMetricsF, QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk.pages.table_content import FunctionKey
from app.desk.status import formats
from app.desk.translation import tr
from app.editor.code_help_view import CodeList, CodeStrip
from app.editor.editor_model import EditorModel
from app.editor.editor_modes import ENTRY_MODES, EditorMode
from app.editor.live_proof import ProofFindings
from app.editor.question_view import QuestionLine
from app.editor.text_synchronizer_view import TextSynchronizer
from app.editor.text_view import SEVERITY_COLORS, SEVERITY_NAMES, ProgramTextField
from app.editor.versions_view import VersionList
from app.path.path_aspects import TipPosition
from app.path.path_view import PathView
from app.screen.code_choices_view import CODE_ROW_HEIGHT
from app.screen.entry_panel import LetterPad, send_key
from app.screen.page_base import EditorPanel, HeaderKey, Page
from app.screen.panel import Panel, RedrawingAttribute
from app.screen.screen_theme import ALIGN_CENTER, ALIGN_RIGHT, ScreenTheme, ThemedPainter
from app.screen.table_panel import RowPanel
from app.screen.window_layout import FINGERTIP_PX, Rect
from app.working_plane.plane_instant import describe_plane, make_instant_after_line
from app.working_plane.working_plane_view import WorkingPlaneView
from core.language.diagnostics import Diagnostic, Severity
from core.language.source import guess_dialect
from core.message import Message

if TYPE_CHECKING:
    from app.path.part_player import PartPlayer
    from app.path.path_pane_view import PathPane, PlanePosition
    from app.path.path_picture import ProgramPicture


class EditorPathView(PathView):
    """View of the tool path of the edited text.

    While the text changes, the view retains the zoom and pan that the operator set. When the operator
    touches a path, the function ``jump_to_line`` of the constructor is called with the path's source line.
    """

    title = "PATH TO THE CURSOR"
    preserves_view = True

    def __init__(
        self,
        theme: ScreenTheme,
        jump_to_line: Callable[[int], None],
        parent: QWidget,
        part_player: PartPlayer | None = None,
    ) -> None:
        super().__init__(theme, parent, self._picked_block, part_player)
        self._go_to = jump_to_line
        self._followed: tuple[ProgramPicture | None, int] = (None, 0)

    @property
    def tip_position(self) -> TipPosition:
        """Return the position of the tool tip after the motion of the cursor line."""
        return self._tip or TipPosition()

    def follow_line(self, line: int) -> None:
        """Move the tool tip to the end of a source line's motion.

        If the line contains no motion, the tip moves to the end of the nearest earlier line with motion.
        """
        picture = self.picture
        if picture is None or not len(picture.z) or (picture, line) == self._followed:
            return
        self._followed = (picture, line)
        block = picture.find_block_for_line(line)
        if not block and self.part_player is not None:
            self.part_player.request_part_at_time(0.0)  # before the first move
        at = max(0, picture.count_finished_points(block) - 1)
        self.show_tool_tip(TipPosition(block, float(picture.z[at]), float(picture.x[at])))
        self.mark(picture.find_block_ranges(line))

    def jump_to_path_line(self) -> str:
        """Move the cursor to the source line of the path element at the crosshair.

        Returns a message if the crosshair is not on the path, and otherwise an empty string.
        """
        block = self.measurement.find_block() if self.measurement is not None else 0
        if not block:
            return tr("CROSSHAIR NOT ON THE PATH. PRESS AN ARROW KEY TO MOVE IT")
        self._picked_block(block)
        return ""

    def make_function_keys(self) -> dict[int, FunctionKey]:
        """Return the function keys that apply while the path has the keyboard focus."""
        return {
            2: FunctionKey("FEED HOLD", self._set_measured_point),
            4: FunctionKey("VIEW", self.select_next_view),
            5: FunctionKey("FIT", self.fit_all_panes),
            6: FunctionKey("ZOOM IN", partial(self.zoom_view, 1)),
            7: FunctionKey("ZOOM OUT", partial(self.zoom_view, -1)),
        }

    def make_pan_actions(self) -> dict[int, Callable[[], None]]:
        """Return the actions with which the arrow keys pan the view of the path, by Qt key code."""
        steps = {Qt.Key.Key_Left: (-1, 0), Qt.Key.Key_Right: (1, 0), Qt.Key.Key_Up: (0, -1)}
        steps[Qt.Key.Key_Down] = (0, 1)
        return {key: partial(self.pan_view, *step) for key, step in steps.items()}

    def _set_measured_point(self) -> None:
        """Set one point of the distance measurement to the position of the crosshair."""
        if self.measurement is not None:
            self.measurement.set_measured_point()
            self.update()

    def _picked_block(self, block: int) -> None:
        line = self.picture.find_source_line(block) if self.picture is not None else 0
        if line:
            self._go_to(line)

    def _find_tip_position(self, pane: PathPane, tip: TipPosition) -> PlanePosition | None:
        return pane.find_block_end(tip.active_block_number)


FINDING_ROW_HEIGHT = 5.2  # units: two lines of text, at least a fingertip high


class FindingList(RowPanel):
    """List of the proof's findings, sorted by line.

    The finding in the line of the cursor is highlighted and always visible.
    """

    scroll_step = 1

    def __init__(
        self, theme: ScreenTheme, jump_to_line: Callable[[Diagnostic], None], parent: QWidget
    ) -> None:
        super().__init__(theme, parent)
        self._go_to = jump_to_line
        self.findings = ProofFindings()
        self._line = 0
        self._proved_blocks: int | None = None

    def show_findings(self, findings: ProofFindings, line: int, proved_blocks: int | None = None) -> None:
        """Show the findings, and highlight the finding in the line of the cursor.

        ``proved_blocks`` is the progress of the proof of a long text, or None.
        """
        shown = findings, line, proved_blocks
        if findings is not self.findings or shown[1:] != (self._line, self._proved_blocks):
            self.findings, self._line, self._proved_blocks = shown
            self.update()

    @property
    def words(self) -> str:
        """Return the title of the list of findings."""
        found = self.findings
        if found.error_text:
            return found.error_text
        if self._proved_blocks is not None:
            return Message("PROVING  ·  {blocks} BLOCKS", blocks=self._proved_blocks)
        if not found.number:
            return "PROVING"
        if not found.diagnostics:
            time = formats.format_duration(found.cycle_time_s)
            return Message("PROVED  ·  {blocks} BLOCKS  ·  CYCLE {time}", blocks=found.block_count, time=time)
        return Message(
            "FINDINGS  ·  {errors}  ·  {warnings}",
            errors=_many(found.error_count, "ERROR"),
            warnings=_many(found.warning_count, "WARNING"),
        )

    def find_next_error(self, line: int) -> Diagnostic | None:
        """Return the first error after a line. After the last error, the search continues at line 1.

        If there are no errors, return the next warning or note. If no finding has a line number, return
        None.
        """
        placed = [d for d in self.findings.diagnostics if d.line]
        found = [d for d in placed if d.severity is Severity.ERROR] or placed
        return next((d for d in found if d.line > line), found[0] if found else None)

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the findings, and scroll the list so that the finding of the cursor line is visible."""
        u, high, found = (
            self.theme.unit_px,
            self.theme.find_row_height(FINDING_ROW_HEIGHT, 9.0, is_touchable=True),
            self.findings.diagnostics,
        )
        self.frame(painter, self.words)
        top = (self.theme.title_height + 0.2) * u
        room = QRectF(0.6 * u, top, self.width() - 1.2 * u, self.height() - top - 0.2 * u)
        here = next((n for n, each in enumerate(found) if each.line == self._line), -1)
        room = self.draw_scroll_keys(
            painter, room, self.count_fitting_rows(room, high, len(found)), len(found), here
        )
        for number, box in self.find_row_boxes(room, high):
            self._row(painter, box, found[number])

    def _row(self, painter: ThemedPainter, box: QRectF, found: Diagnostic) -> None:
        u = self.theme.unit_px
        if found.line == self._line:
            painter.fill_rect(box, "here")
        patch = QRectF(box.x() + 0.4 * u, box.center().y() - 1.6 * u, 3.2 * u, 3.2 * u)
        painter.fill_rect(patch, SEVERITY_COLORS[found.severity])
        painter.draw_text_line(patch, tr(SEVERITY_NAMES[found.severity])[0], 2.0, "on_state", at=ALIGN_CENTER)
        more = 1.2 * u * max(0, len(str(found.line)) - 5)  # for long line numbers
        line = QRectF(box.x() + 4.4 * u, box.y(), 8 * u + more, box.height())
        painter.draw_text_line(line, str(found.line or "FILE"), 1.8, "text")
        room = box.adjusted(10.4 * u + more, 0.2 * u, -0.4 * u, -box.height() / 2)
        painter.draw_text_line(room, found.text, 1.8, "text", bold=False)
        painter.draw_text_line(room.translated(0, room.height()), found.hint, 1.6, "soft", bold=False)
        self.add_target(box, lambda: self._go_to(found), kind="row", is_on=found.line == self._line)


def _many(count: int, word: str) -> str:
    return f"{count} {word}" if count == 1 else f"{count} {word}S"


HEAD_KEY_WIDTH = 14.0  # units: width of the key that shows the keyboard and of the keys that open a panel


class EditorHeading(NamedTuple):
    """Content of the editor's head line.

    ``mark`` is CHANGED, SAMPLE or NEW. It is an empty string for an unchanged file.
    """

    name: str = ""
    mark: str = ""
    cursor_position: str = ""


class EditorHeadLine(Panel):
    """Head line with the name of the edited program. The title line shows the loaded program instead."""

    background_color = "panel"
    heading = RedrawingAttribute(EditorHeading())
    # keys of optional features that write into this program
    panel_keys: RedrawingAttribute[tuple[HeaderKey, ...]] = RedrawingAttribute(())

    def __init__(
        self,
        theme: ScreenTheme,
        toggle_keyboard: Callable[[], None],
        open_panel: Callable[[str], None],
        parent: QWidget,
    ) -> None:
        """Create the head line.

        ``toggle_keyboard`` shows or hides the on-screen keyboard. ``open_panel`` opens the feature panel
        with the given key name.
        """
        super().__init__(theme, parent)
        self._keys, self._panel = toggle_keyboard, open_panel

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the program name with its mark, the cursor position and the touch keys."""
        look, u, high, now = self.theme, self.theme.unit_px, self.height(), self.heading
        painter.draw_text_line(QRectF(1.4 * u, 0, 41 * u, high), now.name, 2.3, "text", raw=True, margin=1.0)
        left = 3.0 * u + min(40 * u, QFontMetricsF(painter.font()).horizontalAdvance(now.name))
        if now.mark:
            size, tall = look.find_table_size(1.7), look.find_line_height(2.8)
            wide = QFontMetricsF(look.make_font(size, is_bold=True)).horizontalAdvance(now.mark) + 1.6 * u
            box = QRectF(left, (high - tall) / 2, wide, tall)
            painter.fill_rect(box, "mark")
            painter.draw_text_line(box, now.mark, 1.7, "on_mark", at=ALIGN_CENTER)
        place = QRectF(self.width() - (40 + 3 * HEAD_KEY_WIDTH) * u, 0, 38.0 * u, high)
        painter.draw_text_line(place, now.cursor_position, 1.9, "soft", at=ALIGN_RIGHT, bold=False)
        key = QRectF(self.width() - HEAD_KEY_WIDTH * u, 0, HEAD_KEY_WIDTH * u, high)
        self.key(painter, key, tr("KEYBOARD"), 1.9, self._keys, color="accent", margin=1.0)
        for label, name in self.panel_keys:
            # a separate variable, because the previous box is stored
            key = key.translated(-(HEAD_KEY_WIDTH + 0.6) * u, 0)
            self.key(painter, key, label, 1.9, partial(self._panel, name), color="accent", margin=1.0)


# --- layout of the page, in the unit of the Automatic page -------------------------------------------------


KEYBOARD_HEIGHT = 29.0  # units: height of the drawn keyboard, four rows of a fingertip
EMPTY_RECT = Rect(0, 0, 0, 0)
HEAD_LINE_HEIGHT = 6.8  # units: a fingertip, for the key that shows the keyboard


class EditorLayout(NamedTuple):
    """Rectangles of the areas on the editor page.

    - ``question_line`` is empty if no question is shown.
    - ``keyboard_area`` is empty while the on-screen keyboard is hidden.
    - ``code_strip`` explains the code at the cursor, and ``code_list`` is the list of codes.
    - ``path_area`` contains all pictures of the program.
    """

    head_line: Rect
    text: Rect
    path_area: Rect
    finding_list: Rect
    code_strip: Rect
    code_list: Rect
    question_line: Rect
    keyboard_area: Rect
    body_area: Rect  # text, path and findings together; the history uses this area


def make_editor_layout(
    width: int, height: int, u: float, *, has_question: bool, keyboard_height: float = 0.0
) -> EditorLayout:
    """Return the layout of the page in pixels. ``u`` is the layout unit of the page in pixels.

    ``keyboard_height`` is the height of the on-screen keyboard in layout units, or 0 if it is hidden. If
    the keyboard is shown, the text has the full width above it.
    """
    gap = max(4, round(0.7 * u))
    head = Rect(0, 0, width, round(HEAD_LINE_HEIGHT * u))
    keys_h = round(keyboard_height * u)
    foot = height - keys_h
    ask_h = round(6.2 * u) if has_question else 0
    low = foot - gap if keys_h else foot
    ask = Rect(0, low - ask_h, width, ask_h)
    top = head.bottom + gap
    body = Rect(0, top, width, (ask.y - gap if has_question else low) - top)
    keyboard = Rect(0, foot, width, keys_h)
    if keys_h:
        return EditorLayout(head, body, EMPTY_RECT, EMPTY_RECT, EMPTY_RECT, EMPTY_RECT, ask, keyboard, body)
    text = Rect(0, top, round(0.56 * width), body.h)
    x = text.right + gap
    findings_h, code_h = round(min(0.34 * body.h, 24 * u)), max(FINGERTIP_PX, round(CODE_ROW_HEIGHT * u))
    path = Rect(x, top, width - x, body.h - findings_h - code_h - 2 * gap)
    findings = Rect(x, path.bottom + gap, path.w, findings_h)
    code = Rect(x, findings.bottom + gap, path.w, code_h)
    codes = Rect(x, top, path.w, body.h)
    return EditorLayout(head, text, path, findings, code, codes, ask, keyboard, body)


class EditorParts(Page):
    """Base class of ``EditorPage``, with the areas of the page and their layout.

    ``mode`` determines which areas are visible.
    """

    mode: EditorMode
    editor: EditorModel
    head_line: EditorHeadLine
    letter_pad: LetterPad
    text_field: ProgramTextField
    path_view: EditorPathView
    plane_view: WorkingPlaneView
    finding_list: FindingList
    code_strip: CodeStrip
    code_list: CodeList
    version_list: VersionList
    question_line: QuestionLine
    editor_panel: EditorPanel
    text_synchronizer: TextSynchronizer
    _with_letters = False

    def show_text(self) -> None:
        """Update the heading, the findings and the picture for the current text."""
        editor = self.editor
        line, column, count = (
            self.text_field.cursor_line,
            self.text_field.cursor_column,
            self.text_field.blockCount(),
        )
        if self.mode is EditorMode.PANEL:  # of the text including the lines of the form
            line, count = self.editor_panel.model.path_end_line, self.editor_panel.model.text.count("\n") + 1
        place = Message("LINE {line} OF {count}  ·  COL {column}", line=line, count=count, column=column)
        self.head_line.heading = EditorHeading(editor.name, self.text_synchronizer.mark, place)
        self.head_line.panel_keys = tuple(self.editor_panel.make_header_keys(editor.name))
        self.code_list.dialect = guess_dialect(editor.name)
        findings = editor.live_proof.current_findings
        self.text_field.show_findings(findings.line_findings)
        self.finding_list.show_findings(findings, line, self.text_synchronizer.proved_blocks)
        if self.mode is EditorMode.TEXT:
            self.code_strip.code_entry = self.code_list.update_code()
        self._show_path(findings.picture, line)

    def _show_path(self, picture: ProgramPicture | None, line: int) -> None:
        """Show the path up to the cursor line. On a mill, show the working plane of that line in 3D."""
        scene = picture.mill_scene if picture is not None else None
        self.plane_view.show_scene(scene)
        self.plane_view.setVisible(
            scene is not None and self.mode is not EditorMode.NEW_FILE and not self.is_keyboard_shown
        )
        self.path_view.show_picture(picture if scene is None else None)
        if scene is not None:
            here = make_instant_after_line(scene, line)
            self.plane_view.show_instant(here, describe_plane(here.plane_position))
            return
        self.path_view.follow_line(line)
        self.path_view.continue_drawing()

    def show_mode(self) -> None:
        """Show the areas of the page that belong to the current mode, and hide the others."""
        self.path_view.switch_measuring(is_on=self.mode is EditorMode.PATH)
        self.version_list.setVisible(self.mode is EditorMode.HISTORY)
        self.code_list.setVisible(self.mode is EditorMode.CODES)
        self.editor_panel.setVisible(self.mode is EditorMode.PANEL)
        self.text_field.setVisible(
            self.mode not in {EditorMode.NEW_FILE, EditorMode.PANEL}
        )  # The previous text is not the offered program.
        for part in (self.path_view, self.finding_list, self.code_strip):
            part.setVisible(self.mode is not EditorMode.NEW_FILE and not self.is_keyboard_shown)
        self.letter_pad.setVisible(self.is_keyboard_shown)
        self.letter_pad.set_target_field(
            self.question_line.first_field if self.mode in ENTRY_MODES else self.text_field
        )
        self._lay_out()

    # --- drawn keyboard ------------------------------------------------------------------------------

    @property
    def is_keyboard_shown(self) -> bool:
        """Return whether the on-screen keyboard is visible.

        The keyboard is visible if the operator has requested it and the mode accepts text.
        """
        return self._with_letters and self.mode in ENTRY_MODES | {EditorMode.TEXT}

    def toggle_keyboard(self) -> None:
        """Show or hide the on-screen keyboard."""
        self._with_letters = not self._with_letters
        self.show_mode()

    def _strike(self, key: str) -> None:
        send_key(key, self.letter_pad.focusProxy() or self.text_field)

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Lay out all areas of the page again after it is resized."""
        self._lay_out()
        self.apply_theme()

    def _lay_out(self) -> None:
        keys = KEYBOARD_HEIGHT if self.is_keyboard_shown else 0.0
        asking = self.mode in ENTRY_MODES
        at = make_editor_layout(
            self.width(), self.height(), self.theme.unit_px, has_question=asking, keyboard_height=keys
        )
        for part, rect in (
            (self.head_line, at.head_line),
            (self.text_field, at.text),
            (self.path_view, at.path_area),
            (self.plane_view, at.path_area),
            (self.finding_list, at.finding_list),
            (self.code_strip, at.code_strip),
            (self.code_list, at.code_list),
            (self.editor_panel, at.text),
            (self.version_list, at.body_area),
            (self.question_line, at.question_line),
            (self.letter_pad, at.keyboard_area),
        ):
            part.setGeometry(*rect)
            part.update()

    def apply_theme(self) -> None:
        """Apply the current colors and font sizes to all areas of the page."""
        self.text_field.apply_theme()
        self.question_line.apply_theme()
        self.path_view.redraw()
