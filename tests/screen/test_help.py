"""The help that ``?`` opens: its content on every page, and the keys that it must leave to the page."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from PySide6.QtCore import QUrl
from PySide6.QtGui import QDesktopServices
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from app.desk.pages import guide_text
from app.desk.pages.guide_text import BlockKind
from app.editor.editor_model import EditorStage
from app.editor.editor_view import EditorPage
from app.screen import page_table
from app.screen.window import documentation_browser
from app.screen.window.help_panel import wrap_words
from app.screen.window.key_table import HELP_KEY
from core.executor.commands import CycleStart, FeedHold, SetSwitch
from core.executor.snapshot import Alarm, LogEvent, MachineState
from tests.screen.hands import Hands, Key
from tests.screen.lathe import Operator
from tests.screen.test_text_sizes import PAGES

EVERYWHERE = "Turn the drives on"  # a row of the table of the keys that act on every page
FIRST_ROWS = {
    page_table.MENU: "F5 JOG",
    page_table.AUTOMATIC: "F6 SEARCHTO",
    page_table.SEARCHTO_PAGE: "F4 RETRACT",
    page_table.JOG: "F3 SPEED",
    page_table.MDI: "F8 SPN STOP",
    page_table.PROGRAMS: "F2 SORT",
    page_table.TOOLS: "F3 MASTER",
    page_table.SECCMP: "C Clear all 32 offsets",
    page_table.ZERO: "F2 SET POS.",
    page_table.PART: "CHECK OFF",
    page_table.SPECIAL: "MAXIMUM SPINDLE SPEED",
    page_table.EDITOR: "F10 DISCARD",
}


def ask(hands: Hands) -> None:
    """Type the help key."""
    hands.type(HELP_KEY)


def is_open(hands: Hands | Operator) -> bool:
    return not hands.frame.help_panel.isHidden()


@pytest.mark.parametrize("page", PAGES)
def test_help_explains_every_page_and_common_keys(operator: Operator, page: str) -> None:
    operator.stage.make_ready()
    assert operator.frame.open_page(page)
    operator.window.press_key(HELP_KEY)
    shown = operator.frame.help_panel.shown_text
    assert is_open(operator)
    assert FIRST_ROWS[page] in shown
    assert EVERYWHERE in shown


@pytest.mark.parametrize("language", ["en", "es"])
@pytest.mark.parametrize("page", [entry.name for entry in page_table.ALL_PAGES])
def test_guide_has_a_section_for_every_page(page: str, language: str) -> None:
    assert guide_text.read_page_help(page, language)


@pytest.mark.parametrize("key", [Key.Key_Down, Key.Key_Right, Key.Key_PageDown, Key.Key_End])
def test_arrow_and_page_keys_scroll_the_help(hands: Hands, key: Key) -> None:
    ask(hands)
    hands.frame.help_panel.grab()
    hands.key(key)
    assert is_open(hands)
    assert hands.frame.help_panel.first_row > 0
    hands.key(Key.Key_Home)
    assert hands.frame.help_panel.first_row == 0


@pytest.mark.parametrize("key", [Key.Key_S, Key.Key_Return, Key.Key_F2, Key.Key_F11, Key.Key_Escape])
def test_any_other_key_only_closes_the_help(hands: Hands, key: Key) -> None:
    ask(hands)
    before = len(hands.machine.posted)
    hands.key(key)
    assert not is_open(hands)
    assert hands.frame.title_line.page_title == page_table.AUTOMATIC
    assert hands.page.file_prompt.isHidden()
    assert not [each for each in hands.machine.posted[before:] if isinstance(each, SetSwitch | CycleStart)]


def test_shift_alone_does_not_close_the_help(hands: Hands) -> None:
    ask(hands)
    hands.key(Key.Key_Shift)
    assert is_open(hands)


def test_help_key_pages_through_the_help_and_then_closes_it(hands: Hands) -> None:
    ask(hands)
    panel = hands.frame.help_panel
    panel.grab()
    screenfuls = -(-len(panel._rows) // panel.rows)
    for _ in range(screenfuls - 1):
        ask(hands)
        panel.grab()
        assert is_open(hands)
    ask(hands)
    assert not is_open(hands)


@pytest.mark.parametrize("key", [Key.Key_Space, Key.Key_H, Key.Key_Pause])
def test_feed_hold_works_while_help_covers_an_input_field(hands: Hands, key: Key) -> None:
    assert hands.frame.open_page(page_table.TOOLS)
    hands.window.press_key(HELP_KEY)
    assert is_open(hands)
    before = len(hands.machine.posted)
    QTest.keyClick(hands.window.windowHandle(), key)
    assert any(isinstance(each, FeedHold) for each in hands.machine.posted[before:])
    assert not is_open(hands)


def test_estop_works_while_help_is_open(operator: Operator) -> None:
    operator.stage.make_ready()
    operator.type(HELP_KEY)
    assert is_open(operator)
    operator.window.press_estop()
    operator.reaches(MachineState.ESTOP)
    assert not is_open(operator)


def test_question_mark_is_text_in_a_text_field(operator: Operator) -> None:
    operator.stage.make_ready()
    assert operator.frame.open_page(page_table.MDI)
    operator.type("G4?")
    assert operator.mdi.mdi_input.text == "G4?"
    assert not is_open(operator)


def test_question_mark_is_text_in_the_file_prompt(hands: Hands) -> None:
    hands.key(Key.Key_F2)
    hands.sees(hands.page.file_prompt.isVisible)
    hands.type("a?")
    assert not is_open(hands)
    assert hands.page.file_prompt.isVisible()


def test_help_returns_the_keyboard_to_the_text_field(operator: Operator) -> None:
    operator.stage.make_ready()
    assert operator.frame.open_page(page_table.EDITOR)
    operator.window.press_key(HELP_KEY)
    QTest.keyClick(operator.window, Key.Key_A)
    assert not is_open(operator)
    assert operator.window.has_text_field()


@pytest.mark.parametrize("cover", ["help", "alarm log"])
@pytest.mark.parametrize("late", [False, True], ids=["Tab", "late focus"])
def test_covered_program_text_does_not_get_the_keyboard(
    operator: Operator, qtbot: QtBot, cover: str, late: bool
) -> None:
    operator.stage.make_ready()
    assert operator.frame.open_page(page_table.EDITOR)
    operator.window.activateWindow()
    page = operator.frame.current_page
    assert isinstance(page, EditorPage)

    def is_loaded() -> bool:
        operator.window.refresh()
        return page.editor.stage is EditorStage.OPEN

    qtbot.waitUntil(is_loaded, timeout=60_000)
    text = page.text_field.toPlainText()
    assert text
    if cover == "help":
        operator.window.press_key(HELP_KEY)
    else:
        operator.frame.toggle_alarm_log()
    if late:
        page.text_field.setFocus()
    else:
        QTest.keyClick(operator.window.windowHandle(), Key.Key_Tab)
    assert QApplication.focusWidget() is operator.window
    if cover == "alarm log":
        QTest.keyClick(operator.window.windowHandle(), Key.Key_A)
        assert page.text_field.toPlainText() == text
        operator.frame.alarm_list.close_list()
    else:
        operator.frame.help_panel.close_help()
    assert QApplication.focusWidget() is page.text_field


def test_help_does_not_cover_an_alarm(hands: Hands) -> None:
    ask(hands)
    hands.machine.fault(Alarm(102, "following", "FOLLOWING ERROR", "cause", "remedy"))
    hands.window.refresh()
    notice, panel = hands.frame.alarm_notice, hands.frame.help_panel
    assert notice.isVisible()
    assert not panel.geometry().intersects(notice.geometry())
    assert not panel.geometry().intersects(hands.frame.prompt_line.geometry())


def test_another_page_closes_the_help(hands: Hands) -> None:
    ask(hands)
    assert hands.frame.open_page(page_table.JOG)
    assert not is_open(hands)


def test_help_about_the_alarm_log(hands: Hands) -> None:
    hands.key(Key.Key_F7)
    ask(hands)
    assert "Scroll the list" in hands.frame.help_panel.shown_text


def test_help_explains_the_selected_alarm_of_the_log(hands: Hands) -> None:
    older = Alarm(102, "following", "FOLLOWING ERROR", "cause", "remedy")
    newer = Alarm(103, "in-position", "NOT IN POSITION", "cause", "remedy")
    for alarm in (older, newer):
        hands.desk.alarm_log.hear(LogEvent(0.0, "alarm", alarm.text, alarm=alarm))
    hands.window.refresh()
    hands.key(Key.Key_F7)
    hands.window.press_key("Pan down")  # The log shows the newest entry first, so this is the older one.
    ask(hands)
    assert hands.frame.help_panel.shown_text.startswith("102  ·  FOLLOWING ERROR\ndocs/alarms.html#102")


@pytest.mark.parametrize("page", [page_table.AUTOMATIC, page_table.TOOLS])
def test_help_begins_with_the_active_alarm(hands: Hands, page: str) -> None:
    assert hands.frame.open_page(page)
    hands.machine.fault(Alarm(102, "following", "FOLLOWING ERROR", "cause", "remedy"))
    hands.window.refresh()
    hands.window.press_key(HELP_KEY)
    assert hands.frame.help_panel.addresses[0] == "docs/alarms.html#102"
    assert "cause" in hands.frame.help_panel.shown_text


def test_help_without_an_alarm_has_no_alarm_address(hands: Hands) -> None:
    hands.key(Key.Key_F7)
    ask(hands)
    assert hands.frame.help_panel.addresses == ("docs/guide/screen.html#alarms-and-stops-f7",)


@pytest.fixture
def opened(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> list[QUrl]:
    """The addresses that were opened in the browser of a desktop on which the site is installed."""
    found: list[QUrl] = []
    site = tmp_path / "documents"
    (site / "docs" / "guide").mkdir(parents=True)
    for name in ("index.html", "docs/guide/screen.html"):
        (site / name).touch()
    monkeypatch.setattr(documentation_browser, "get_documents_folder", lambda: site)
    monkeypatch.setattr(documentation_browser, "has_browser", lambda: True)

    def open_url(url: QUrl) -> bool:
        found.append(url)
        return True

    monkeypatch.setattr(QDesktopServices, "openUrl", open_url)
    return found


def test_b_opens_the_section_in_the_browser(hands: Hands, opened: list[QUrl]) -> None:
    ask(hands)
    shown = " ".join(row.text for row in hands.frame.help_panel._rows)
    assert "documents/docs/guide/screen.html#automatic · B: OPEN IN THE BROWSER" in shown
    hands.type("b")
    assert not is_open(hands)
    assert [url.fragment() for url in opened] == ["automatic"]
    assert opened[0].toLocalFile().endswith("documents/docs/guide/screen.html")


def test_b_only_closes_the_help_on_a_kiosk(hands: Hands, opened: list[QUrl]) -> None:
    hands.frame.help_panel.browser = documentation_browser.DocumentationBrowser(hands.desk, is_kiosk=True)
    ask(hands)
    assert not any("BROWSER" in row.text for row in hands.frame.help_panel._rows)
    hands.type("b")
    assert not is_open(hands)
    assert opened == []


def test_b_only_closes_the_help_without_an_installed_site(
    hands: Hands, opened: list[QUrl], tmp_path: Path
) -> None:
    (tmp_path / "documents" / "index.html").unlink()
    ask(hands)
    hands.type("b")
    assert not is_open(hands)
    assert opened == []


def shown_addresses(hands: Hands) -> list[str]:
    ask(hands)
    rows = hands.frame.help_panel._rows
    return [row.text for row in rows if row.kind is BlockKind.ADDRESS]


def test_help_in_a_clone_shows_the_address_of_the_page_in_markdown(hands: Hands) -> None:
    assert shown_addresses(hands) == ["IN THE DOCUMENTATION: docs/guide/screen.md#automatic"]


def test_help_shows_no_address_without_site_and_pages(
    hands: Hands, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(documentation_browser, "_PROJECT_FOLDER", tmp_path)
    assert shown_addresses(hands) == []


def test_the_browser_is_not_opened_while_a_program_is_stopped_in_a_cycle(
    hands: Hands, opened: list[QUrl]
) -> None:
    hands.machine.now = replace(hands.machine.now, state=MachineState.HOLD)
    ask(hands)
    hands.type("b")
    assert opened == []
    assert hands.desk.prompt_notice


@pytest.mark.parametrize("address", ["docs/missing.html#a", "", "../../etc/passwd"])
def test_a_section_that_is_not_installed_is_reported(hands: Hands, opened: list[QUrl], address: str) -> None:
    browser = hands.frame.help_panel.browser
    assert browser is not None
    assert not browser.open_section(address)
    assert opened == []
    assert hands.desk.prompt_notice


def test_a_browser_that_does_not_start_is_reported(
    hands: Hands, opened: list[QUrl], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(QDesktopServices, "openUrl", lambda _url: False)
    ask(hands)
    hands.type("b")
    assert hands.desk.prompt_notice


def test_missing_guide_is_reported(hands: Hands, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("app.screen.page_help.read_page_help", lambda _topic, _language: ())
    ask(hands)
    assert not is_open(hands)
    assert hands.prompt() == "THE GUIDE IS NOT INSTALLED"


def test_help_begins_with_the_selected_field(operator: Operator) -> None:
    operator.stage.make_ready()
    assert operator.frame.open_page(page_table.TOOLS)
    operator.key(Key.Key_Right, Key.Key_Right)  # X, Z, NOSE RADIUS
    operator.type(HELP_KEY)
    heading, text, *_ = operator.frame.help_panel.shown_text.splitlines()
    assert heading.startswith("T1  NOSE RADIUS")
    assert text.startswith("Radius of the rounded tool tip.")


def test_help_begins_with_the_codes_of_the_line(operator: Operator) -> None:
    operator.stage.make_ready()
    assert operator.frame.open_page(page_table.MDI)
    operator.type("G04 F2")
    operator.window.press_key(HELP_KEY)
    assert operator.frame.help_panel.shown_text.startswith("G04")


def test_help_of_a_special_function_is_the_guides_section(operator: Operator) -> None:
    operator.stage.make_ready()
    assert operator.frame.open_page(page_table.SPECIAL)
    operator.key(Key.Key_Down, Key.Key_Down)
    operator.type(HELP_KEY)
    shown = operator.frame.help_panel.shown_text
    assert shown.startswith("INPUTS AND OUTPUTS")
    assert shown.index("outputs.png") < shown.index("SPECIAL FUNCTIONS")


def test_words_are_wrapped_to_the_width(operator: Operator) -> None:
    font = operator.window.theme.make_font(2.0)
    assert wrap_words("", font, 100.0) == [""]
    assert wrap_words("one two", font, 10_000.0) == ["one two"]
    assert wrap_words("one two", font, 1.0) == ["one", "two"]  # A word is never broken.
