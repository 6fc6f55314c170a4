"""What stands on every page until somebody does something: rows that move no target under a finger."""

from __future__ import annotations

from dataclasses import replace

import pytest
from PySide6.QtGui import QPainter
from PySide6.QtWidgets import QApplication

from app.desk.status.interrupted_notice import NoticeRow, _uncertain
from app.desk.translation import tr
from app.screen import page_table
from app.screen.look import DARK, Look, load_fonts, speak_in
from app.screen.window.window_bars import NoticeRows
from app.screen.window_layout import FINGER
from core.executor.snapshot import CONTROL_LOST, State
from core.ports import ALL_UNKNOWN, Unknown
from tests.interrupted import broken_off
from tests.screen.hands import Hands, Key
from tests.texts import Pattern, begins, text


@pytest.mark.parametrize(
    "page",
    [
        page_table.AUTOMATIC,
        page_table.MENU,
        page_table.JOG,
        page_table.PROGRAMS,
        page_table.TOOLS,
        page_table.SPECIAL,
        page_table.ZERO,
    ],
)
def test_an_interrupted_job_and_a_full_disk_stand_on_every_page(hands: Hands, page: str) -> None:
    hands.machine.now = replace(hands.machine.now, interrupted=broken_off())
    hands.desk.storage.follow_store(lambda: "the disk is full", lambda: "20 parts")
    hands.frame.go(page)
    hands.window.refresh()
    rows = hands.frame.notices
    assert rows.isVisible()
    assert [row.text.split(" LINE")[0] for row in rows.rows] == [
        "INTERRUPTED: PIN.NC",
        text("screen.not-kept", why="the disk is full"),
    ]
    assert rows.rows[1].figures.startswith("NOT SAVED YET: 20 parts.")
    assert not rows.geometry().intersects(hands.frame.page.geometry())
    assert "NOT SAVED" in [lamp.word for lamp in hands.frame.strip.lamps]
    hands.machine.now = replace(hands.machine.now, interrupted=None)
    hands.desk.storage.follow_store()
    hands.window.refresh()
    assert not rows.isVisible()


def test_no_target_slips_away_under_a_finger_that_jogs(hands: Hands) -> None:
    time = [100.0]
    hands.desk.hands.clock = lambda: time[0]
    hands.frame.go(page_table.JOG)
    now = hands.desk.snapshot()
    hands.desk.control.snapshot = lambda: replace(now, state=State.JOG)
    hands.window.refresh()
    stands = hands.frame.page.geometry()
    hands.desk.storage.follow_store(lambda: "the disk is full")
    hands.desk.control.snapshot = lambda: replace(now, state=State.IDLE)  # between two steps
    time[0] += 1.0
    hands.window.refresh()
    assert hands.frame.page.geometry() == stands
    assert "NOT SAVED" in [lamp.word for lamp in hands.frame.strip.lamps]  # the lamp says it at once
    time[0] += 3.0
    hands.window.refresh()
    assert hands.frame.page.geometry() != stands
    assert hands.frame.notices.isVisible()


def test_what_was_done_of_an_interrupted_program_stays_drawn(hands: Hands) -> None:
    hands.load("pin")
    job = hands.desk.session.now.job
    assert job is not None
    found = broken_off(program="pin.nc", text=job.text_digest, tool=1, block=9, line=8)
    hands.machine.now = replace(hands.machine.now, interrupted=found)
    hands.window.refresh()
    tip = hands.page.path._tip
    assert tip is not None
    tool = job.setup.tools[1]
    assert (tip.block, tip.stood) == (9, (found.where[1] - tool.z, found.where[0] - tool.x))
    hands.machine.now = replace(hands.machine.now, interrupted=replace(found, text="changed"))
    hands.window.refresh()
    assert hands.page.path._tip is not None
    assert hands.page.path._tip.block == 0


def test_a_finger_on_the_row_answers_as_the_key_does(hands: Hands) -> None:
    hands.load("pin")
    hands.machine.now = replace(hands.machine.now, interrupted=broken_off(program="pin.nc"), state=State.IDLE)
    hands.window.refresh()
    rows = hands.frame.notices
    assert [key for key, _label in rows.rows[0].keys] == ["F6", "Y"]
    hands.frame.go(page_table.JOG)
    hands.window.refresh()
    assert rows.rows[0].keys == ()  # there these keys mean other things
    hands.key(Key.Key_F1)


@pytest.mark.parametrize("page", [page_table.AUTOMATIC, page_table.JOG, page_table.SPECIAL, page_table.TOOLS])
def test_a_machine_that_is_not_heard_says_so_on_every_page(hands: Hands, page: str) -> None:
    hands.frame.go(page)
    hands.machine.now = replace(hands.machine.now, unknown=ALL_UNKNOWN)
    hands.window.refresh()
    (row,) = hands.frame.notices.rows
    assert (row.text, row.tone) == (text("screen.spindle-may-turn"), "alarm")
    assert begins(row.figures, "screen.not-known", what=Pattern("POSITIONS, SPINDLE, OUTPUTS, INPUTS.*"))
    assert text("screen.spindle-unknown") in [lamp.word for lamp in hands.frame.strip.lamps]
    hands.machine.now = replace(hands.machine.now, unknown=frozenset({Unknown.OUTPUTS}))
    hands.window.refresh()
    (row,) = hands.frame.notices.rows
    assert row.text == text("screen.machine-not-heard", what="OUTPUTS")


def test_a_row_with_a_key_stays_a_fingertip_high(hands: Hands, monkeypatch: pytest.MonkeyPatch) -> None:
    told = (NoticeRow("INTERRUPTED", "T1", (("F6", "SEARCHTO"),)), NoticeRow("NOT SAVED", "20 parts"))
    monkeypatch.setattr(hands.frame, "_notices_of", lambda *_what, **_more: told)
    hands.window.refresh()
    rows = hands.frame.notices
    rows.grab()
    assert len(rows.rows) == 2
    assert rows._places
    for box, *_ in rows._places:
        assert box.height() >= FINGER
        assert rows.area().contains(box)
    with_key, read = rows._high_of(rows.rows[0]), rows._high_of(rows.rows[1])
    assert read < with_key
    assert rows.height() == with_key + read


@pytest.mark.parametrize("language", ["en", "es"])
@pytest.mark.parametrize(("unit", "wide"), [(6.4, 858), (8.0, 1070), (10.8, 1610)])
def test_what_is_not_certain_behind_a_power_cut_is_whole_beside_its_keys(
    qapp: QApplication, monkeypatch: pytest.MonkeyPatch, unit: float, wide: int, language: str
) -> None:
    """At 1024x600 and 1280x800 its last words, to look at tool and part, were cut off."""
    assert qapp is not None
    load_fonts()
    speak_in(language)
    drawn: list[str] = []
    real = QPainter.drawText

    def spy(painter: QPainter, *what: object) -> object:
        drawn.extend(each for each in what if isinstance(each, str))
        return real(painter, *what)  # type: ignore[call-overload]

    place = "X R−0.12500 Z −3.12130"
    stood = tr("WAS AT {stood}, NOW AT {now} FROM HOME").format(stood=place, now=place)
    unsure = _uncertain(broken_off(why=CONTROL_LOST))
    rows = NoticeRows(Look(DARK, unit), lambda _key: None)
    keys = (("F6", "SEARCHTO"), ("Y", tr("FROM LINE 1")))
    rows.rows = (NoticeRow("INTERRUPTED", f"{stood}{unsure}", keys),)
    rows.resize(wide, rows.high)
    rows.resize(wide, rows.high)  # as the window does, which asks in every frame
    monkeypatch.setattr(QPainter, "drawText", spy)
    rows.grab()
    speak_in("en")
    lines = len(drawn) - 1 - 2 * len(keys)
    assert " ".join(drawn[1 : 1 + lines]) == rows.rows[0].figures
    rows.rows = (NoticeRow("INTERRUPTED", "T1", keys),)
    drawn.clear()
    rows.grab()
    assert drawn[:2] == ["INTERRUPTED", "T1"]  # what fits has one line
