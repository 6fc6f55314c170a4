"""Parts of the page EDITOR: head line, path, findings and keyboard, with their visibility and layout."""

from __future__ import annotations

from collections.abc import Callable
from enum import StrEnum
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

from PySide6.QtCore import QRectF
from PySide6.QtGui import QFontMetricsF, QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk.pages.sheet import Key
from app.desk.status import formats
from app.desk.translation import tr
from app.editor.code_help_view import CodeList, CodeStrip
from app.editor.editor import Editor
from app.editor.live_proof import Findings
from app.editor.question_view import AskLine
from app.editor.text_view import TONES, WORDS, TextField, TypedText
from app.editor.versions_view import VersionList
from app.path.path_aspects import Tip
from app.path.path_view import PathView
from app.screen.code_choices_view import CODE_LINE
from app.screen.entry_panel import LetterPad, strike
from app.screen.look import CENTRE, RIGHT, Look, Painter
from app.screen.page_base import EditorPanel, HeadKey, Page
from app.screen.panel import Panel, Shown
from app.screen.sheet_panel import RowPanel
from app.screen.window_layout import FINGER, Rect
from app.working_plane.plane_instant import at_line, plane_words
from app.working_plane.working_plane_view import WorkingPlaneView
from core.language.diagnostics import Diagnostic, Severity
from core.language.source import dialect_of
from core.message import Message

if TYPE_CHECKING:
    from app.path.part_player import PartPlayer
    from app.path.path_pane_view import Pane, Place
    from app.path.path_picture import Picture


class EditedPath(PathView):
    """Path of the edited text. An adjusted view remains while the text changes.

    ``go_to`` is called with the source line of a touched path.
    """

    title = "PATH TO THE CURSOR"
    keeps = True

    def __init__(
        self, look: Look, go_to: Callable[[int], None], parent: QWidget, player: PartPlayer | None = None
    ) -> None:
        super().__init__(look, parent, self._picked_block, player)
        self._go_to = go_to
        self._followed: tuple[Picture | None, int] = (None, 0)

    @property
    def tip(self) -> Tip:
        """Tip at the end of the cursor line."""
        return self._tip or Tip()

    def follow(self, line: int) -> None:
        """Move the tip to the end of a source line, or of the nearest earlier line with motion."""
        picture = self.picture
        if picture is None or not len(picture.z) or (picture, line) == self._followed:
            return
        self._followed = (picture, line)
        block = picture.block_of_line(line)
        if not block and self.player is not None:
            self.player.want(0.0)  # before the first move
        at = max(0, picture.points_done(block) - 1)
        self.show_tip(Tip(block, float(picture.z[at]), float(picture.x[at])))
        self.mark(picture.blocks_of_line(line))

    def line_here(self) -> str:
        """Go to the source line of the path at the crosshair.

        Return a message if the crosshair is off the path.
        """
        block = self.ruler.block() if self.ruler is not None else 0
        if not block:
            return tr("CROSSHAIR NOT ON THE PATH. PRESS AN ARROW KEY TO MOVE IT")
        self._picked_block(block)
        return ""

    def keys(self) -> dict[int, Key]:
        """Return the function keys while the path has the keyboard."""
        return {
            2: Key("FEED HOLD", self._hold),
            4: Key("VIEW", self.next_view),
            5: Key("FIT", self.fit),
            6: Key("ZOOM IN", partial(self.zoom, 1)),
            7: Key("ZOOM OUT", partial(self.zoom, -1)),
        }

    def _hold(self) -> None:
        """Set a measured point at the crosshair."""
        if self.ruler is not None:
            self.ruler.hold()
            self.update()

    def _picked_block(self, block: int) -> None:
        line = self.picture.line_of_block(block) if self.picture is not None else 0
        if line:
            self._go_to(line)

    def _place_in(self, pane: Pane, tip: Tip) -> Place | None:
        return pane.end_of(tip.block)


FOUND = 5.2  # units: two lines of text, at least a fingertip high


class FindingList(RowPanel):
    """List of findings in the order of lines.

    The finding of the cursor line is marked and remains visible.
    """

    notch = 1

    def __init__(self, look: Look, go_to: Callable[[Diagnostic], None], parent: QWidget) -> None:
        super().__init__(look, parent)
        self._go_to = go_to
        self.findings = Findings()
        self._line = 0

    def show_findings(self, findings: Findings, line: int) -> None:
        """Show the findings and mark the cursor line."""
        if findings is not self.findings or line != self._line:
            self.findings, self._line = findings, line
            self.update()

    @property
    def words(self) -> str:
        """Title line of the list."""
        found = self.findings
        if found.trouble:
            return found.trouble
        if not found.number:
            return "PROVING"
        if not found.diagnostics:
            time = formats.duration(found.cycle_time)
            return Message("PROVED  ·  {blocks} BLOCKS  ·  CYCLE {time}", blocks=found.blocks, time=time)
        return Message(
            "FINDINGS  ·  {errors}  ·  {warnings}",
            errors=_many(found.errors, "ERROR"),
            warnings=_many(found.warnings, "WARNING"),
        )

    def following(self, line: int) -> Diagnostic | None:
        """Return the next error after a line.

        The search continues at the start of the list. Without errors, the next other finding is returned.
        """
        placed = [d for d in self.findings.diagnostics if d.line]
        found = [d for d in placed if d.severity is Severity.ERROR] or placed
        return next((d for d in found if d.line > line), found[0] if found else None)

    def draw(self, painter: Painter) -> None:
        u, high, found = self.look.u, self.look.row(FOUND, 9.0, touch=True), self.findings.diagnostics
        self.frame(painter, self.words)
        room = QRectF(0.6 * u, 2.3 * u, self.width() - 1.2 * u, self.height() - 2.5 * u)
        here = next((n for n, each in enumerate(found) if each.line == self._line), -1)
        room = self.scrolled(painter, room, self.fitting(room, high, len(found)), len(found), here)
        for number, box in self.boxes(room, high):
            self._row(painter, box, found[number])

    def _row(self, painter: Painter, box: QRectF, found: Diagnostic) -> None:
        u = self.look.u
        if found.line == self._line:
            painter.fill(box, "here")
        patch = QRectF(box.x() + 0.4 * u, box.center().y() - 1.6 * u, 3.2 * u, 3.2 * u)
        painter.fill(patch, TONES[found.severity])
        painter.write(patch, tr(WORDS[found.severity])[0], 2.0, "on_state", at=CENTRE)
        line = QRectF(box.x() + 4.4 * u, box.y(), 8 * u, box.height())
        painter.write(line, str(found.line or "FILE"), 1.8, "text")
        room = box.adjusted(10.4 * u, 0.4 * u, -0.4 * u, -box.height() / 2)
        painter.write(room, found.text, 1.8, "text", bold=False, fit=False)
        painter.write(room.translated(0, room.height()), found.hint, 1.6, "soft", bold=False, fit=False)
        self.place(box, lambda: self._go_to(found), kind="row", on=found.line == self._line)


def _many(count: int, word: str) -> str:
    return f"{count} {word}" if count == 1 else f"{count} {word}S"


KEYS = 14.0  # units: width of the key that shows the keyboard and of the keys that open a panel


class Heading(NamedTuple):
    """Content of the head line.

    ``mark`` is CHANGED, SAMPLE, NEW or empty for an unchanged file.
    """

    name: str = ""
    mark: str = ""
    place: str = ""


class HeadLine(Panel):
    """Head line with the edited program, which can differ from the loaded program in the title line."""

    ground = "panel"
    heading = Shown(Heading())
    # keys of optional features that write into this program
    panel_keys: Shown[tuple[HeadKey, ...]] = Shown(())

    def __init__(
        self, look: Look, keys: Callable[[], None], panel: Callable[[str], None], parent: QWidget
    ) -> None:
        """Create the head line.

        ``keys`` shows or hides the keyboard, ``panel`` opens the panel of a key.
        """
        super().__init__(look, parent)
        self._keys, self._panel = keys, panel

    def draw(self, painter: Painter) -> None:
        look, u, high, now = self.look, self.look.u, self.height(), self.heading
        painter.write(QRectF(1.4 * u, 0, 41 * u, high), now.name, 2.3, "text", raw=True, margin=1.0)
        left = 3.0 * u + min(40 * u, QFontMetricsF(painter.font()).horizontalAdvance(now.name))
        if now.mark:
            wide = QFontMetricsF(look.font(1.7, bold=True)).horizontalAdvance(now.mark) + 1.6 * u
            box = QRectF(left, high / 2 - 1.4 * u, wide, 2.8 * u)
            painter.fill(box, "mark")
            painter.write(box, now.mark, 1.7, "on_mark", at=CENTRE, fit=False)
        place = QRectF(self.width() - (40 + 3 * KEYS) * u, 0, 38.0 * u, high)
        painter.write(place, now.place, 1.9, "soft", at=RIGHT, bold=False, fit=False)
        key = QRectF(self.width() - KEYS * u, 0, KEYS * u, high)
        self.key(painter, key, tr("KEYBOARD"), 1.9, self._keys, ink="accent", margin=1.0)
        for label, name in self.panel_keys:
            # a separate variable, because the previous box is stored
            key = key.translated(-(KEYS + 0.6) * u, 0)
            self.key(painter, key, label, 1.9, partial(self._panel, name), ink="accent", margin=1.0)


# --- layout of the page, in the unit of the Automatic page -------------------------------------------------


KEYBOARD = 29.0  # units: height of the drawn keyboard, four rows of a fingertip
NOWHERE = Rect(0, 0, 0, 0)
HEAD_LINE = 6.8  # units: a fingertip, for the key that shows the keyboard


class EditorPlaces(NamedTuple):
    """Areas of the page. ``ask`` is empty without a question, and ``keys`` without the drawn keyboard.

    ``code`` is the line that explains the code at the cursor, and ``codes`` is the list of codes. ``path`` is
    the area of all pictures of the program.
    """

    head: Rect
    text: Rect
    path: Rect
    findings: Rect
    code: Rect
    codes: Rect
    ask: Rect
    keys: Rect
    body: Rect  # text, path and findings together; the history uses this area


def editor_places(width: int, height: int, u: float, *, asking: bool, keys: float = 0.0) -> EditorPlaces:
    """Return the layout of the page in pixels. ``u`` is the unit of the page.

    ``keys`` is the height of the drawn keyboard in units. With the keyboard, the text has the full width
    above it.
    """
    gap = max(4, round(0.7 * u))
    head = Rect(0, 0, width, round(HEAD_LINE * u))
    keys_h = round(keys * u)
    foot = height - keys_h
    ask_h = round(6.2 * u) if asking else 0
    low = foot - gap if keys_h else foot
    ask = Rect(0, low - ask_h, width, ask_h)
    top = head.bottom + gap
    body = Rect(0, top, width, (ask.y - gap if asking else low) - top)
    keyboard = Rect(0, foot, width, keys_h)
    if keys_h:
        return EditorPlaces(head, body, NOWHERE, NOWHERE, NOWHERE, NOWHERE, ask, keyboard, body)
    text = Rect(0, top, round(0.56 * width), body.h)
    x = text.right + gap
    findings_h, code_h = round(min(0.34 * body.h, 24 * u)), max(FINGER, round(CODE_LINE * u))
    path = Rect(x, top, width - x, body.h - findings_h - code_h - 2 * gap)
    findings = Rect(x, path.bottom + gap, path.w, findings_h)
    code = Rect(x, findings.bottom + gap, path.w, code_h)
    codes = Rect(x, top, path.w, body.h)
    return EditorPlaces(head, text, path, findings, code, codes, ask, keyboard, body)


class Mode(StrEnum):
    """Mode of the editor page, which determines the meaning of the keys."""

    TEXT = "text"
    FIND = "find"
    GO_TO = "go to"
    NAME = "name"
    HISTORY = "history"
    OFFER = "offer"
    CODES = "codes"  # the list of codes is open
    LOOK = "look"  # the path has the keyboard, for measuring
    PANEL = "panel"  # a form of an optional feature writes the lines


ASKING = frozenset({Mode.FIND, Mode.GO_TO, Mode.NAME})


class EditorParts(Page):
    """Editor page as a set of parts, which ``EditorPage`` creates.

    ``mode`` determines the visible parts.
    """

    mode: Mode
    editor: Editor
    head: HeadLine
    letters: LetterPad
    field: TextField
    path: EditedPath
    space: WorkingPlaneView
    findings: FindingList
    code: CodeStrip
    codes: CodeList
    versions: VersionList
    ask: AskLine
    panel: EditorPanel
    typed_text: TypedText
    _with_letters = False

    def show_text(self) -> None:
        """Update heading, findings and picture for the present text."""
        editor = self.editor
        line, column, count = self.field.line, self.field.column, self.field.blockCount()
        if self.mode is Mode.PANEL:  # of the text including the lines of the form
            line, count = self.panel.model.line, self.panel.model.text.count("\n") + 1
        place = Message("LINE {line} OF {count}  ·  COL {column}", line=line, count=count, column=column)
        self.head.heading = Heading(editor.name, self.typed_text.mark, place)
        self.head.panel_keys = tuple(self.panel.head_keys(editor.name))
        self.codes.dialect = dialect_of(editor.name)
        findings = editor.proof.now
        self.field.show_findings(findings.by_line)
        self.findings.show_findings(findings, line)
        if self.mode is Mode.TEXT:
            self.code.entry = self.codes.follow()
        self._show_path(findings.picture, line)

    def _show_path(self, picture: Picture | None, line: int) -> None:
        """Show the path up to the cursor line, or on a mill the plane of that line in 3D."""
        scene = picture.scene if picture is not None else None
        self.space.show_scene(scene)
        self.space.setVisible(scene is not None and self.mode is not Mode.OFFER and not self.lettered)
        self.path.show_picture(picture if scene is None else None)
        if scene is not None:
            here = at_line(scene, line)
            self.space.show_instant(here, plane_words(here.swivel))
            return
        self.path.follow(line)
        self.path.advance()

    def show_mode(self) -> None:
        """Show the parts of the present mode."""
        self.path.measure(on=self.mode is Mode.LOOK)
        self.versions.setVisible(self.mode is Mode.HISTORY)
        self.codes.setVisible(self.mode is Mode.CODES)
        self.panel.setVisible(self.mode is Mode.PANEL)
        self.field.setVisible(
            self.mode not in {Mode.OFFER, Mode.PANEL}
        )  # The previous text is not the offered program.
        for part in (self.path, self.findings, self.code):
            part.setVisible(self.mode is not Mode.OFFER and not self.lettered)
        self.letters.setVisible(self.lettered)
        self.letters.write_into(self.ask.first if self.mode in ASKING else self.field)
        self._lay_out()

    # --- drawn keyboard ------------------------------------------------------------------------------

    @property
    def lettered(self) -> bool:
        """Whether the drawn keyboard is visible: the user has requested it, and the mode accepts text."""
        return self._with_letters and self.mode in ASKING | {Mode.TEXT}

    def turn_letters(self) -> None:
        """Show or hide the drawn keyboard."""
        self._with_letters = not self._with_letters
        self.show_mode()

    def _strike(self, key: str) -> None:
        strike(key, self.letters.focusProxy() or self.field)

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Lay out all parts again after a change of size."""
        self._lay_out()
        self.dress()

    def _lay_out(self) -> None:
        keys = KEYBOARD if self.lettered else 0.0
        asking = self.mode in ASKING
        at = editor_places(self.width(), self.height(), self.look.u, asking=asking, keys=keys)
        for part, rect in (
            (self.head, at.head),
            (self.field, at.text),
            (self.path, at.path),
            (self.space, at.path),
            (self.findings, at.findings),
            (self.code, at.code),
            (self.codes, at.codes),
            (self.panel, at.text),
            (self.versions, at.body),
            (self.ask, at.ask),
            (self.letters, at.keys),
        ):
            part.setGeometry(*rect)
            part.update()

    def dress(self) -> None:
        """Apply the present colors and font sizes to all parts."""
        self.field.dress()
        self.ask.dress()
        self.path.restart()
