"""The notice of an alarm on every panel: its cause and remedy are readable and cover nothing."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import pytest
from PySide6.QtCore import QRectF
from PySide6.QtWidgets import QWidget

from app.desk.status.alarm_log import LoggedStop
from app.desk.translation import tr
from app.screen import page_table
from app.screen.color_palettes import DARK_PALETTE
from app.screen.screen_theme import MIN_TEXT_SIZE, ScreenTheme, ThemedPainter
from app.screen.text_sizes import ScreenResolution, make_screen_resolution
from app.screen.window.alarm_panels import AlarmList, AlarmNotice
from core.alarms import CATALOG
from core.alarms.alarm_entry import AlarmCode
from core.executor.snapshot import Alarm
from tests.interrupted import broken_off
from tests.screen.hands import Hands, Key
from tests.screen.test_leafing import above
from tests.screen.test_text_sizes import PANELS

__all__ = ["above"]  # a fixture of this module too


class Wrapped(NamedTuple):
    """One wrapped text: its room, the space that it takes, and the height of its letters."""

    room: QRectF
    space: QRectF
    text: str
    em_px: int


@pytest.fixture
def texts(monkeypatch: pytest.MonkeyPatch) -> list[Wrapped]:
    """The wrapped texts that are drawn."""
    found: list[Wrapped] = []

    def draw(painter: ThemedPainter, rect: QRectF, flags: int, text: str) -> None:
        space = painter.boundingRect(rect, flags, text)
        found.append(Wrapped(QRectF(rect), space, text, painter.font().pixelSize()))

    monkeypatch.setattr(ThemedPainter, "draw_wrapped_text", draw)
    return found


def catalog_alarm(code: AlarmCode) -> Alarm:
    """An alarm with all causes of the catalog."""
    entry = CATALOG[code]
    return Alarm(entry.number, code, entry.text, entry.causes[0], entry.remedy, 12, 0.0, entry.causes)


def show_panel(hands: Hands, name: str) -> None:
    """Show the window on a panel."""
    hands.window.resize(*PANELS[name][:2])
    hands.window.theme.screen = make_screen_resolution(*PANELS[name])
    hands.frame.arrange_parts()


@pytest.mark.parametrize("language", ["en", "es"])
@pytest.mark.parametrize("name", PANELS)
def test_cause_and_remedy_of_every_alarm_fit_below_an_interrupted_notice(
    hands: Hands, texts: list[Wrapped], name: str, language: str
) -> None:
    hands.desk.settings_store.choose("language", language)
    show_panel(hands, name)
    notice, least = hands.frame.alarm_notice, MIN_TEXT_SIZE * hands.window.theme.unit_px
    for code in CATALOG:
        alarm = catalog_alarm(code)
        hands.machine.fault(alarm)
        hands.machine.now = replace(hands.machine.now, alarms=(alarm,), interrupted=broken_off())
        hands.window.refresh()
        texts.clear()
        notice.grab()
        assert hands.frame.notice_rows.height() > 0
        causes, remedy = texts
        for each in texts:
            assert QRectF(notice.rect()).contains(each.room)
            assert each.room.contains(each.space.adjusted(0, 0, -1, -1)), each.text
            assert each.em_px >= int(least)
        assert not causes.room.intersects(remedy.room)
        assert causes.text.startswith(tr(alarm.causes[0])), code
        assert remedy.text == tr(alarm.remedy), code


def test_alarm_on_low_panel_has_as_much_room_as_with_smaller_rows(hands: Hands) -> None:
    """The notice was 521 x 257 pixels before the rows followed the size of the screen."""
    show_panel(hands, "10")
    hands.machine.fault(catalog_alarm("following"))
    hands.window.refresh()
    notice = hands.frame.alarm_notice
    assert notice.width() * notice.height() > 521 * 257
    assert not notice.geometry().intersects(hands.frame.strip.geometry())
    assert not notice.geometry().intersects(hands.frame.prompt_line.geometry())
    assert hands.frame.readout_line.isVisible()
    assert not hands.frame.position_panel.isVisible()
    hands.machine.now = replace(hands.machine.now, alarms=())
    hands.window.refresh()
    assert not notice.isVisible()
    assert hands.frame.position_panel.isVisible()


@pytest.mark.parametrize("page", [page_table.JOG, page_table.PROGRAMS])
def test_alarm_does_not_change_the_layout_of_another_page(hands: Hands, page: str) -> None:
    show_panel(hands, "10")
    hands.machine.now = replace(hands.machine.now, interrupted=broken_off())
    hands.frame.open_page(page)
    hands.window.refresh()
    before = (hands.frame.current_page.geometry(), hands.frame.notice_rows.geometry())
    hands.machine.now = replace(hands.machine.now, alarms=(catalog_alarm("following"),))
    hands.window.refresh()
    assert not hands.frame.alarm_notice.isVisible()
    assert (hands.frame.current_page.geometry(), hands.frame.notice_rows.geometry()) == before


def test_alarm_covers_the_page_again_after_the_help_closes(hands: Hands) -> None:
    show_panel(hands, "10")
    hands.machine.fault(catalog_alarm("following"))
    hands.window.refresh()
    whole = hands.frame.alarm_notice.geometry()
    hands.frame.show_help()
    hands.window.refresh()
    help_area = hands.frame.help_panel.geometry()
    assert help_area.width() > 0
    assert not help_area.intersects(hands.frame.alarm_notice.geometry())
    hands.frame.help_panel.close_help()
    hands.window.refresh()
    assert hands.frame.alarm_notice.geometry() == whole


def test_program_stop_does_not_cover_listing(hands: Hands) -> None:
    show_panel(hands, "10")
    hands.frame.alarm_notice.show_notice("GAUGE THE OUTSIDE", "CYCLE START TO CONTINUE")
    hands.frame.arrange_parts()
    left = hands.page.program_listing.geometry().translated(hands.page.pos())
    assert not hands.frame.alarm_notice.geometry().intersects(left)


def test_text_without_room_ends_with_key_of_help(texts: list[Wrapped]) -> None:
    notice = AlarmNotice(ScreenTheme(DARK_PALETTE, 6.4))
    notice.theme.screen = ScreenResolution(4.6)
    notice.resize(521, 86)
    notice.show_notice("", "", (catalog_alarm("following"),))
    texts.clear()
    notice.grab()
    causes = texts[0]
    assert causes.text.endswith("…  ?: MORE")
    assert causes.text.startswith("the axis is blocked")
    for each in texts:
        assert each.room.contains(each.space.adjusted(0, 0, -1, -1))
        assert each.space.top() == pytest.approx(each.room.top(), abs=1)


def test_text_is_cut_between_words(texts: list[Wrapped]) -> None:
    notice = AlarmNotice(ScreenTheme(DARK_PALETTE, 6.4))
    notice.resize(300, 110)
    words = [f"WORD{number}" for number in range(200)]
    notice.show_notice(" ".join(words), "CYCLE START TO CONTINUE")
    texts.clear()
    notice.grab()
    *shown, ending = texts[0].text.split(" ")
    assert ending == "…"
    assert 1 <= len(shown) < 200
    assert shown == words[: len(shown)]


def log_of(count: int, above_panel: QWidget) -> AlarmList:
    """A log of this many stops, with room for four rows and the keys below them."""
    panel = AlarmList(ScreenTheme(DARK_PALETTE, 6.4), lambda _name: None, above_panel)
    panel.resize(521, 253)
    panel.show_entries([LoggedStop(str(n), catalog_alarm("following"), "") for n in range(count)])
    panel.grab()
    return panel


def test_alarm_log_shows_how_many_entries_are_newer_and_older(above: QWidget) -> None:
    panel = log_of(30, above)
    assert panel.rows == 4
    assert key_labels(panel) == ["OLDER: 26"]
    panel.scroll_by(10)
    assert key_labels(panel) == ["NEWER: 10", "OLDER: 16"]


def test_alarm_log_without_further_entries_uses_height_of_keys(above: QWidget) -> None:
    panel = log_of(5, above)
    assert panel.rows >= 5
    assert key_labels(panel) == []


def key_labels(panel: AlarmList) -> list[str]:
    """The texts of the touch keys of the log."""
    panel.read_painted_texts()  # From now on, painted texts are recorded.
    panel.grab()
    return [panel.describe_target(each) for each in panel.list_targets() if each.kind == "key"]


def test_alarm_log_covers_the_whole_page(hands: Hands) -> None:
    show_panel(hands, "10")
    hands.key(Key.Key_F7)
    assert hands.frame.alarm_list.geometry() == hands.page.geometry()


def test_alarm_closes_the_file_prompt_that_its_notice_covers(hands: Hands) -> None:
    hands.key(Key.Key_F2)
    hands.sees(hands.page.file_prompt.isVisible)
    hands.machine.fault(catalog_alarm("following"))
    hands.window.refresh()
    assert not hands.page.file_prompt.isVisible()
    assert not hands.frame.has_text_field()
    hands.key(Key.Key_F2)
    assert hands.frame.current_page.NAME == page_table.PROGRAMS
