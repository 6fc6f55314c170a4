"""Files that are dropped where the pointer is, on each page and over each text field."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from PySide6.QtCore import QCoreApplication, QMimeData, QPoint, QPointF, Qt, QUrl
from PySide6.QtGui import QDragEnterEvent, QDropEvent
from PySide6.QtWidgets import QLineEdit, QWidget
from pytestqt.qtbot import QtBot

from app.compose.runs.journal import Journal
from app.desk.page_description import LATHES
from app.desk.programs.program_loading import LoadingPhase
from app.editor.editor_model import EditorModel, EditorStage
from app.editor.editor_view import EditorPage
from app.screen import page_table
from app.screen.text_area.text_area import TextArea
from app.screen.window.file_opening import FileOpener
from app.screen.window.key_table import HELP_KEY
from core.executor.snapshot import MachineState
from tests.attached import attached
from tests.screen.desks import SAMPLES, desk_on
from tests.screen.fake import FakeMachine
from tests.screen.hands import Hands, Key, window_on
from tests.screen.lathe import Operator
from tests.screen.pictures import LOADING

BUTTON, NONE = Qt.MouseButton.NoButton, Qt.KeyboardModifier.NoModifier
COPY = Qt.DropAction.CopyAction


@pytest.fixture
def desk_hands(qtbot: QtBot, machine: FakeMachine, journal: Journal, tmp_path: Path) -> Iterator[Hands]:
    own = tmp_path / "programs"
    own.mkdir()
    shutil.copy(SAMPLES / "pin.nc", own / "alpha.nc")
    desk = desk_on(machine, own, SAMPLES, keep=journal)
    with window_on(qtbot, desk, machine) as window:
        opener = FileOpener(window)
        assert opener.parent() is window
        hands = Hands(qtbot, window, desk, machine)
        assert desk.program_choice.load_by_name("alpha.nc")
        hands.sees(lambda: desk.program_loader.loaded_program.phase is LoadingPhase.READY)
        yield hands


def drop_at(hands: Hands | Operator, spot: QPoint, *paths: Path) -> bool:
    """Drag files to a place in the window as the platform does, and return whether the drop was accepted."""
    window = hands.window.windowHandle()
    assert window is not None
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(path)) for path in paths])
    data.setText("".join(f"{path}\n" for path in paths))  # File managers also offer the paths as text.
    entered = QDragEnterEvent(spot, COPY, data, BUTTON, NONE)
    QCoreApplication.sendEvent(window, entered)
    dropped = QDropEvent(QPointF(spot), COPY, data, BUTTON, NONE)
    QCoreApplication.sendEvent(window, dropped)
    return entered.isAccepted() and dropped.isAccepted()


def middle_of(hands: Hands, widget: QWidget) -> QPoint:
    return widget.mapTo(hands.window, widget.rect().center())


def text_fields(hands: Hands) -> list[QLineEdit | TextArea]:
    """Return the text fields that are visible."""
    lines, texts = hands.window.findChildren(QLineEdit), hands.window.findChildren(TextArea)
    return [
        *(field for field in lines if field.isVisible()),
        *(field for field in texts if field.isVisible()),
    ]


def read_text(field: QLineEdit | TextArea) -> str:
    return field.text() if isinstance(field, QLineEdit) else field.toPlainText()


@pytest.fixture
def visitor(tmp_path: Path) -> Path:
    """A program that is not in a program folder."""
    return Path(shutil.copy(SAMPLES / "bushing.nc", tmp_path / "visitor.nc"))


def open_page(hands: Hands, name: str) -> None:
    if name == page_table.EDITOR:
        attached(hands.desk, EditorModel).pending_name = "alpha.nc"
    assert hands.frame.open_page(name), hands.desk.prompt_notice
    if name == page_table.EDITOR:
        hands.sees(lambda: attached(hands.desk, EditorModel).stage is EditorStage.OPEN)
    hands.window.refresh()


# The models of these pages need the simulated lathe.
LATHE_PAGES = [page_table.MDI, page_table.PART, page_table.SEARCHTO_PAGE]
PAGES = [
    page.name
    for page in page_table.ALL_PAGES
    if page.program_languages & LATHES and page.name not in LATHE_PAGES
]


@pytest.mark.parametrize("page", LATHE_PAGES)
def test_files_dropped_on_pages_of_the_lathe_are_opened_or_rejected(
    operator: Operator, page: str, visitor: Path, tmp_path: Path
) -> None:
    operator.stage.make_ready()
    FileOpener(operator.window)
    assert operator.frame.open_page(page), operator.prompt()
    picture = tmp_path / "photo.png"
    picture.touch()
    middle = operator.window.rect().center()
    drop_at(operator, middle, picture)
    assert "photo.png" in operator.frame.desk.prompt_notice
    assert page == operator.frame.current_page.NAME
    drop_at(operator, middle, visitor)
    assert operator.frame.current_page.NAME == page_table.AUTOMATIC
    assert operator.frame.desk.program_loader.wait_until_loaded(LOADING).path == visitor


@pytest.mark.parametrize("page", PAGES)
def test_a_program_dropped_on_any_page_is_loaded(desk_hands: Hands, page: str, visitor: Path) -> None:
    open_page(desk_hands, page)
    assert drop_at(desk_hands, middle_of(desk_hands, desk_hands.window), visitor)
    desk_hands.sees(lambda: desk_hands.desk.program_loader.loaded_program.path == visitor)
    assert desk_hands.frame.current_page.NAME == page_table.AUTOMATIC


@pytest.mark.parametrize("page", PAGES)
def test_a_file_that_no_page_opens_is_rejected_on_any_page(
    desk_hands: Hands, page: str, tmp_path: Path
) -> None:
    picture = tmp_path / "photo.png"
    picture.write_bytes(b"\x89PNG\r\n")
    open_page(desk_hands, page)
    shown = desk_hands.frame.current_page.NAME
    before = desk_hands.desk.program_loader.loaded_program.path
    drop_at(desk_hands, middle_of(desk_hands, desk_hands.window), picture)
    assert "photo.png" in desk_hands.desk.prompt_notice
    assert ".png" in desk_hands.desk.prompt_notice
    assert shown == desk_hands.frame.current_page.NAME
    assert desk_hands.desk.program_loader.loaded_program.path == before


def check_drop_over_fields(hands: Hands, visitor: Path) -> None:
    """Drop a program over each visible text field, and check that no field changes."""
    fields = text_fields(hands)
    assert fields
    for field in fields:
        before = read_text(field)
        drop_at(hands, middle_of(hands, field), visitor)
        assert read_text(field) == before
    hands.sees(lambda: hands.desk.program_loader.loaded_program.path == visitor)


def test_a_drop_over_the_file_prompt_opens_the_file(desk_hands: Hands, visitor: Path) -> None:
    desk_hands.key(Key.Key_F2)
    desk_hands.sees(desk_hands.page.file_prompt.isVisible)
    check_drop_over_fields(desk_hands, visitor)
    assert not desk_hands.page.file_prompt.isVisible()
    assert not desk_hands.frame.has_text_field()


@pytest.mark.parametrize("key", ["F7", HELP_KEY])
def test_a_drop_over_the_alarm_log_or_the_help_shows_the_new_program(
    desk_hands: Hands, visitor: Path, key: str
) -> None:
    desk_hands.window.press_key(key)
    covers = desk_hands.frame.alarm_list, desk_hands.frame.help_panel
    assert any(cover.isVisible() for cover in covers)
    drop_at(desk_hands, middle_of(desk_hands, desk_hands.window), visitor)
    assert not any(cover.isVisible() for cover in covers)
    desk_hands.sees(lambda: desk_hands.desk.program_loader.loaded_program.path == visitor)


def test_a_rejected_drop_leaves_the_file_prompt_open(desk_hands: Hands, tmp_path: Path) -> None:
    desk_hands.key(Key.Key_F2)
    desk_hands.sees(desk_hands.page.file_prompt.isVisible)
    drop_at(desk_hands, middle_of(desk_hands, desk_hands.window), tmp_path)
    assert desk_hands.page.file_prompt.isVisible()


def test_a_drop_over_the_text_of_the_editor_opens_the_file(desk_hands: Hands, visitor: Path) -> None:
    open_page(desk_hands, page_table.EDITOR)
    check_drop_over_fields(desk_hands, visitor)


def test_a_drop_over_the_search_field_of_the_editor_opens_the_file(desk_hands: Hands, visitor: Path) -> None:
    open_page(desk_hands, page_table.EDITOR)
    editor = desk_hands.frame.current_page
    assert isinstance(editor, EditorPage)
    editor.question_line.show_question("FIND?", "REPLACE?")
    assert len(text_fields(desk_hands)) == 3
    check_drop_over_fields(desk_hands, visitor)


def test_a_changed_text_is_saved_before_the_file_is_dropped_again(desk_hands: Hands, visitor: Path) -> None:
    open_page(desk_hands, page_table.EDITOR)
    desk_hands.type("G04F1 ")
    drop_at(desk_hands, middle_of(desk_hands, desk_hands.window), visitor)
    assert "visitor.nc" in desk_hands.desk.prompt_notice
    assert desk_hands.desk.program_loader.loaded_program.path != visitor
    desk_hands.sees(lambda: desk_hands.frame.current_page.NAME == page_table.AUTOMATIC)
    drop_at(desk_hands, middle_of(desk_hands, desk_hands.window), visitor)
    desk_hands.sees(lambda: desk_hands.desk.program_loader.loaded_program.path == visitor)


@pytest.mark.parametrize("ending", [".dxf", ".SVG"])
@pytest.mark.parametrize("page", [page_table.AUTOMATIC, page_table.PROGRAMS, page_table.EDITOR])
def test_a_dropped_drawing_opens_the_form_that_makes_a_program(
    desk_hands: Hands, tmp_path: Path, ending: str, page: str
) -> None:
    if not desk_hands.desk.program_choice.program_folders.is_drawing_name(f"a{ending}"):
        pytest.skip("the optional feature for drawings is not installed")
    drawing = tmp_path / f"shaft{ending}"
    drawing.write_text("0\nEOF\n")
    open_page(desk_hands, page)
    drop_at(desk_hands, middle_of(desk_hands, desk_hands.window), drawing)
    editor = attached(desk_hands.desk, EditorModel)
    desk_hands.sees(lambda: editor.stage is EditorStage.OFFERED)
    assert desk_hands.frame.current_page.NAME == page_table.EDITOR
    assert editor.source_drawing == drawing
    assert editor._offered == "shaft.nc"


def test_a_drawing_is_not_opened_while_axes_move(desk_hands: Hands, tmp_path: Path) -> None:
    drawing = tmp_path / "shaft.dxf"
    drawing.write_text("0\nEOF\n")
    machine = desk_hands.machine
    machine.now = replace(machine.now, state=MachineState.JOG)
    drop_at(desk_hands, middle_of(desk_hands, desk_hands.window), drawing)
    assert desk_hands.frame.current_page.NAME == page_table.AUTOMATIC
    assert attached(desk_hands.desk, EditorModel).source_drawing is None
    assert desk_hands.desk.prompt_notice


@pytest.mark.parametrize("name", ["machine.toml", "part.pdf", "tools.csv", "setup.zip", "part.nc.bak"])
def test_a_file_of_another_kind_is_rejected_by_name(desk_hands: Hands, tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_text("G90\n")
    before = desk_hands.desk.program_loader.loaded_program.path
    drop_at(desk_hands, middle_of(desk_hands, desk_hands.window), tmp_path / name)
    assert name in desk_hands.desk.prompt_notice
    assert desk_hands.desk.program_loader.loaded_program.path == before


def test_a_program_of_another_control_is_loaded(desk_hands: Hands, tmp_path: Path) -> None:
    path = tmp_path / "fixture.ngc"
    path.write_text("G21 G90\nM30\n")
    drop_at(desk_hands, middle_of(desk_hands, desk_hands.window), path)
    desk_hands.sees(lambda: desk_hands.desk.program_loader.loaded_program.path == path)
